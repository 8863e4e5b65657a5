// The page: the state is what the controls say; from it to what is looked at, and from there to every view.

import { urlOf } from "./api.js";
import { fillForm, formParts, showAnswer, wireForm } from "./block_form.js";
import { showControls, wireControls } from "./controls.js";
import { setLinks, wireDownloads } from "./downloads.js";
import { curvesUrl, mapQuestion, showMap } from "./map.js";
import { tellOf, wireMap } from "./map_pointer.js";
import { motionUrl, showMotion } from "./motion.js";
import { forgive } from "./page.js";
import { once, pane } from "./pane.js";
import { blockQuestion, movedTo, situationOf, situationOfBlock, situationWithoutAnswer } from "./situation.js";
import { showSpectrum, spectrumUrl } from "./spectrum.js";
import { change, isBlock, onChange, state } from "./state.js";
import { whole, windowOf } from "./view.js";
import { number, PULSES } from "./words.js";

const ASK = "“Does it overturn?”";
const EDITED = `The block has been edited: ${ASK} gives its answer.`;
const LEFT = `The map no longer shows the block of this form: ${ASK} shows it again.`;

const block = pane({
  box: document.getElementById("answer"),
  status: document.getElementById("block-status"),
  doing: "Computing …",
  draw: showAnswer,
  clear: () => showAnswer(null),
});

let situation = null; // of the state; null while it is not known
let view = null; // window of the map
let turn = 0; // counts what changes the situation
let edited = false; // the form holds another block than the state
let left = false; // a block was shown before

/** Show the state. */
function show() {
  forgive();
  fillForm(state());
  resolve();
}

async function resolve() {
  const wanted = state();
  const mine = ++turn;
  edited = false;
  situation = null;
  if (isBlock(wanted)) {
    left = true;
    lookAt(null);
    const question = blockQuestion(wanted);
    const answer = await block.show(JSON.stringify(question), once("/v1/blocks/response", question));
    if (mine !== turn) return;
    situation = answer ? situationOfBlock(answer) : situationWithoutAnswer(wanted);
  } else {
    block.nothing(left ? LEFT : "");
    situation = situationOf(wanted);
  }
  lookAt(situation);
}

/** Show a situation in every view; null: it is not known, and unless that may be `lasting` the views are cleared soon. */
function lookAt(found, lasting = false) {
  if (found || !view) view = windowOf(state(), found?.point);
  showControls(state(), found);
  showMap(found, view, lasting);
  tellOf(null, found);
  showMotion(found, lasting);
  showSpectrum(found, view, lasting);
  link(found);
}

/** What was typed is not asked yet: nothing that is shown of the block in the state belongs to the form. */
function edit() {
  if (!isBlock(state()) || (situation && !situation.answer)) return;
  const question = (parts) => JSON.stringify(blockQuestion({ ...state(), ...parts }));
  if (question(formParts()) === question({})) {
    resolve();
    return;
  }
  turn += 1;
  edited = true;
  situation = null;
  block.wait({ lasting: true, words: EDITED });
  lookAt(null, true);
}

/** Change the state, to the block in the form if that was edited. */
function set(parts, keep = true) {
  change({ ...(edited ? formParts() : {}), ...parts }, { keep });
}

function link(found) {
  const map = (format) => urlOf("/v1/map", { ...mapQuestion(), format });
  const motion = (format) => motionUrl(found, format);
  const spectrum = (format) => spectrumUrl(found, view, format);
  setLinks("map", found ? { csv: map("csv"), nc: map("nc"), curves: `${curvesUrl()}&format=csv` } : {});
  setLinks("block", found?.answer ? { json: urlOf("/v1/blocks/response", blockQuestion(state())) } : {});
  setLinks("motion", found?.point ? { csv: motion("csv"), nc: motion("nc") } : {});
  setLinks("spectrum", found?.point ? { csv: spectrum("csv"), nc: spectrum("nc") } : {});
}

function caption() {
  const { pulse, restitution, alpha_deg, point } = situation;
  const said = [PULSES[pulse] ?? pulse, `η = ${number(restitution, 4)}`];
  said.push(Number(alpha_deg) ? `α = ${number(alpha_deg, 4)}°` : "slender limit");
  if (point) said.push(`ω = ${number(point.frequency_ratio, 5)}`, `1/a = ${number(point.slenderness, 5)}`);
  return said.join(", ");
}

const look = () => ({ state: state(), situation, view });
wireForm((parts) => change({ ...parts, frequency_ratio: "", slenderness: "", alpha_deg: "0" }), edit);
wireControls(look, set);
wireMap(look, (point, keep) => set(movedTo(state(), situation, point), keep), set);
wireDownloads(caption);
document.getElementById("whole").addEventListener("click", () => set(whole()));
onChange(show);
show();
