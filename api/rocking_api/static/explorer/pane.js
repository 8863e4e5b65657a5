// One view of the page and its requests. What it shows belongs to the current controls, or is dimmed: the last answer.

import { ask, pause, Problem } from "./api.js";
import { setStatus } from "./page.js";
import { refresh } from "./state.js";

const SLOW = 1000; // [ms] after which the page says that the service is slow
const MIN_INTERVAL = 100; // [ms] between the starts of two requests, while a slider is dragged
const TIMEOUT = 75_000; // [ms], longer than the time limit of the service

/**
 * A view in `box`. The element `status` shows `doing` while a request runs, or the error. `draw(answer)` shows a response,
 * `clear()` removes it; requests start `delay` ms after the last change. `picture` names the button that saves the view.
 */
export function pane({ box, status, doing = "", delay = 0, picture = "", draw, clear }) {
  let wanted = null; // key of what the controls ask for; null: unknown
  let shown = null; // key of what is on the page
  let complete = null; // the last response for `shown`; null: more are expected
  let control = null; // AbortController of the running requests
  let running = null; // their promise
  let started = -Infinity; // [ms]
  const timers = [];

  function mark(stale, idle = false) {
    box.inert = idle;
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
      await pause(Math.max(delay, started + MIN_INTERVAL - performance.now()), mine.signal);
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
      setStatus(status, "");
      return last;
    } catch (problem) {
      if (mine !== control) return null;
      stop();
      if (shown !== key && problem.parameter !== undefined) blank(); // refused; without an answer the last one stays
      mark(shown !== null && shown !== key);
      if (!(problem instanceof Problem)) throw problem;
      setStatus(status, problem, refresh);
      return null;
    }
  }

  return {
    /**
     * Show what `load(signal)` yields for a key, one response after the other, unless it is shown or requested already.
     * Resolves to the last response, or to null if it failed or another key was requested meanwhile.
     */
    async show(key, load) {
      if (key === wanted && control) return running;
      stop();
      wanted = key;
      if (key === shown && complete) {
        mark(false);
        setStatus(status, "");
        return complete;
      }
      control = new AbortController();
      const mine = control;
      mark(shown !== key);
      setStatus(status, doing);
      const overdue = () => shown !== key && setStatus(status, `${doing} Still waiting for the service${shown ? "; dimmed: the last answer" : ""} …`);
      timers.push(setTimeout(overdue, SLOW));
      const late = new Problem({ detail: `the service has not answered within ${TIMEOUT / 1000} s` });
      timers.push(setTimeout(() => mine.abort(late), TIMEOUT));
      running = follow(key, load, mine);
      return running;
    },

    /** It is unknown what to show: dim what is shown; `idle` if nothing is asked for until the reader acts. */
    wait({ idle = false, words = "" } = {}) {
      stop();
      wanted = null;
      mark(true, idle);
      setStatus(status, words);
    },

    /** There is nothing to show; `words` says why. */
    nothing(words = "") {
      stop();
      wanted = null;
      blank();
      mark(false);
      setStatus(status, words);
    },
  };
}

/** A load that yields one response. */
export function once(path, params) {
  return async function* load(signal) {
    yield await ask(path, params, signal);
  };
}
