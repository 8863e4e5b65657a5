// The page: from the state (the address) to the scenario, and from there to every view.

import { urlOf } from "./api.js";
import { fillForm, formParts, showAnswer, wireForm } from "./block_form.js";
import { showControls, wireControls } from "./controls.js";
import { setLinks, wireDownloads } from "./downloads.js";
import { curvesUrl, mapParams, showMap } from "./map.js";
import { wireGestures } from "./map_gestures.js";
import { showReadout, wireMap } from "./map_pointer.js";
import { showMotion } from "./motion.js";
import { clearErrors } from "./page.js";
import { once, pane } from "./pane.js";
import { showPreview } from "./pulse_preview.js";
import { blockParams, movedTo, scenarioOf, scenarioOfBlock, scenarioWithoutResponse } from "./scenario.js";
import { showSpectrum, spectrumUrl } from "./spectrum.js";
import { change, isBlock, onChange, state } from "./state.js";
import { whole, windowOf } from "./view.js";
import { number, PULSES } from "./labels.js";

const BUTTON = "“Does it overturn?”";
const EDITED = `The block has been edited: press ${BUTTON} for its response.`;
const LEFT = `The map no longer shows the block of this form: press ${BUTTON} to show it again.`;

const block = pane({
  box: document.getElementById("answer"),
  status: document.getElementById("block-status"),
  doing: "Computing …",
  draw: showAnswer,
  clear: () => showAnswer(null),
});

let scenario = null; // of the state; null while it is unknown
let view = null; // window of the map
let turn = 0; // number of changes of the scenario, by which a late response is recognised
let edited = false; // the form differs from the state
let left = false; // a block was shown before the current scenario

/** Show the state. */
function show() {
  clearErrors();
  fillForm(state());
  showPreview(state().pulse);
  resolve();
}

async function resolve() {
  const wanted = state();
  const mine = ++turn;
  edited = false;
  scenario = null;
  if (isBlock(wanted)) {
    left = true;
    showScenario(null);
    const params = blockParams(wanted);
    const answer = await block.show(JSON.stringify(params), once("/v1/blocks/response", params));
    if (mine !== turn) return;
    scenario = answer ? scenarioOfBlock(answer) : scenarioWithoutResponse(wanted);
  } else {
    block.nothing(left ? LEFT : "");
    scenario = scenarioOf(wanted);
  }
  showScenario(scenario);
}

/** Show a scenario in every view; null: it is unknown, and the views are cleared after a while unless `lasting`. */
function showScenario(found, lasting = false) {
  if (found || !view) view = windowOf(state(), found?.point);
  showControls(state(), found);
  showMap(found, view, lasting);
  showReadout(null, found);
  showMotion(found, lasting);
  showSpectrum(found, view, lasting);
  link(found);
}

/** The form was edited and not submitted: dim what is shown, which belongs to the block of the state. */
function edit() {
  if (!isBlock(state()) || (scenario && !scenario.answer)) return;
  const params = (parts) => JSON.stringify(blockParams({ ...state(), ...parts }));
  if (params(formParts()) === params({})) {
    resolve();
    return;
  }
  turn += 1;
  edited = true;
  scenario = null;
  block.wait({ lasting: true, words: EDITED });
  showScenario(null, true);
}

/** Change the state; a form that was edited is taken over. */
function set(parts, keep = true) {
  change({ ...(edited ? formParts() : {}), ...parts }, { keep });
}

function link(found) {
  const map = (format) => urlOf("/v1/map", { ...mapParams(), format });
  const spectrum = (format) => spectrumUrl(found, view, format);
  setLinks("map", found ? { csv: map("csv"), nc: map("nc"), curves: `${curvesUrl()}&format=csv` } : {});
  setLinks("block", found?.answer ? { json: urlOf("/v1/blocks/response", blockParams(state())) } : {});
  document.getElementById("open-report").disabled = !found?.answer;
  setLinks("spectrum", found?.point ? { csv: spectrum("csv"), nc: spectrum("nc") } : {});
}

document.getElementById("open-report").addEventListener("click", async () => {
  const [{ showReport }, { blockReport }] = await Promise.all([import("./report.js"), import("./block_report.js")]);
  showReport(blockReport(scenario.answer));
});

function caption() {
  const { pulse, restitution, alpha_deg, point } = scenario;
  const parts = [PULSES[pulse] ?? pulse, `η = ${number(restitution, 4)}`];
  parts.push(Number(alpha_deg) ? `α = ${number(alpha_deg, 4)}°` : "slender limit");
  if (point) parts.push(`ω = ${number(point.frequency_ratio, 5)}`, `1/a = ${number(point.slenderness, 5)}`);
  return parts.join(", ");
}

const look = () => ({ state: state(), scenario, view });
wireForm((parts) => change({ ...parts, frequency_ratio: "", slenderness: "", alpha_deg: "0" }), edit);
wireControls(look, set);
wireGestures(look, set);
wireMap(look, (point, keep) => set(movedTo(state(), scenario, point), keep), set);
wireDownloads(caption);
document.getElementById("whole").addEventListener("click", () => set(whole()));
document.getElementById("block-pulse").addEventListener("change", ({ target }) => showPreview(target.value));
onChange(show);
show();
