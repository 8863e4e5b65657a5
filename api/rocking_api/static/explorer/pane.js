// One view of the page and its requests: what it shows is what the controls say, or is dimmed, or is cleared.

import { ask, pause, Problem } from "./api.js";
import { say } from "./page.js";
import { refresh } from "./state.js";

const CLEAR_AFTER = 2000; // [ms] that something out of date stays, dimmed
const APART = 100; // [ms] between the starts of two requests, while a slider is dragged
const LIMIT = 75_000; // [ms], longer than the service grants a request

/**
 * A view in `box`, which tells in `status` what it is `doing` or what failed. `draw(answer)` shows an answer, `clear()`
 * takes away what is shown; requests begin `delay` ms after the last change. `picture` names the button that saves it.
 */
export function pane({ box, status, doing = "", delay = 0, picture = "", draw, clear }) {
  let wanted = null; // key of what the controls say; null: not known
  let shown = null; // key of what is on the page
  let complete = null; // the last answer to `shown`; null: more are to come
  let control = null; // of the requests under way
  let running = null; // their promise
  let started = -Infinity; // [ms]
  const timers = [];

  function mark(stale) {
    box.classList.toggle("stale", stale);
    box.setAttribute("aria-busy", String(stale));
    box.dataset.shown = shown ?? "";
    for (const button of document.querySelectorAll(`[data-picture="${picture}"]`)) button.disabled = stale || !shown;
  }

  function stop() {
    control?.abort();
    control = null;
    timers.splice(0).forEach(clearTimeout);
  }

  function blank() {
    shown = complete = null;
    box.classList.add("blank");
    clear();
    mark(control !== null || wanted === null);
  }

  function put(key, answer) {
    shown = key;
    box.classList.remove("blank");
    draw(answer);
    mark(false);
  }

  async function follow(key, load, mine) {
    try {
      await pause(Math.max(delay, started + APART - performance.now()), mine.signal);
      started = performance.now();
      let last = null;
      for await (const answer of load(mine.signal)) {
        if (mine !== control) return null;
        last = answer;
        put(key, answer);
      }
      if (mine !== control) return null;
      complete = last;
      stop();
      say(status, "");
      return last;
    } catch (problem) {
      if (mine !== control) return null;
      stop();
      if (shown !== key) blank();
      mark(false);
      if (!(problem instanceof Problem)) throw problem;
      say(status, problem, refresh);
      return null;
    }
  }

  return {
    /**
     * Show what `load(signal)` yields for a key, one answer after the other, unless it is there or on its way; resolves to
     * the last answer, or to null if it failed or another key was asked for meanwhile.
     */
    async show(key, load) {
      if (key === wanted && control) return running;
      stop();
      wanted = key;
      if (key === shown && complete) {
        mark(false);
        say(status, "");
        return complete;
      }
      control = new AbortController();
      const mine = control;
      mark(shown !== key);
      say(status, doing);
      const overdue = () => {
        if (shown === key) return;
        blank();
        say(status, "Still waiting for the service …");
      };
      timers.push(setTimeout(overdue, CLEAR_AFTER));
      const late = new Problem({ detail: `the service has not answered within ${LIMIT / 1000} s` });
      timers.push(setTimeout(() => mine.abort(late), LIMIT));
      running = follow(key, load, mine);
      return running;
    },

    /** What the controls say is not known: dim what is shown, and clear it if that lasts and `lasting` is false. */
    wait({ lasting = false, words = "" } = {}) {
      stop();
      wanted = null;
      mark(true);
      say(status, words);
      if (!lasting) timers.push(setTimeout(blank, CLEAR_AFTER));
    },

    /** There is nothing to show, for which there may be words. */
    nothing(words = "") {
      stop();
      wanted = null;
      blank();
      mark(false);
      say(status, words);
    },
  };
}

/** A load of one answer of the service. */
export function once(path, question) {
  return async function* load(signal) {
    yield await ask(path, question, signal);
  };
}
