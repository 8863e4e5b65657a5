// The page: from the state (the address) to the scenario, and from there to every view.

import { ask, isSampled, urlOf } from "./api.js";
import { showAnswer, showRelation } from "./block_answer.js";
import { fillForm, wireForm } from "./block_form.js";
import { setLinks, wireDownloads } from "./downloads.js";
import { curvesUrl, mapParams, showMap } from "./map.js";
import { wireGestures } from "./map_gestures.js";
import { showReadout, wireMap } from "./map_pointer.js";
import { showMotion } from "./motion.js";
import { blockUnderSamples } from "./own_pulse.js";
import { clearErrors } from "./page.js";
import { pane } from "./pane.js";
import { showPreview } from "./pulse_preview.js";
import { described, matchingPeriod } from "./pulses.js";
import { blockParams, blockQuery, movedTo, scenarioOf, scenarioOfBlock, scenarioWithoutResponse } from "./scenario.js";
import { showSpectrum, spectrumUrl } from "./spectrum.js";
import { change, isBlock, onChange, state, stepsBack } from "./state.js";
import { whole, windowOf } from "./view.js";
import { number, pulseName } from "./labels.js";
import { toSI } from "./units.js";

// A package that extends the service may show the block under all motions of a site.
const siteModule = document.getElementById("site")?.dataset.module;
const { showSite } = siteModule ? await import(siteModule) : { showSite() {} };

const EDITED = "A number of the sentence cannot be read.";
const GROUPS = "The map shows a block without a size, by the groups of the paper. Change a number of the sentence to ask about one in metres.";

const block = pane({
  box: document.getElementById("answer"),
  status: document.getElementById("block-status"),
  doing: "Computing …",
  draw: showAnswer,
  clear: () => showAnswer(null),
});

const undo = document.getElementById("undo");

let scenario = null; // of the state; null while it is unknown
let view = null; // window of the map
let turn = 0; // number of changes of the scenario, by which a late response is recognised

/** Show the state. */
function show() {
  undo.disabled = !stepsBack();
  clearErrors();
  preview();
  resolve();
}

async function preview() {
  const { pulse } = state();
  const description = await described(pulse).catch(() => null); // the form works without a preview
  if (pulse === state().pulse) showPreview(pulse, description);
}

async function resolve() {
  const wanted = state();
  const mine = ++turn;
  scenario = null;
  fillForm(wanted, null);
  showSite(wanted);
  if (isBlock(wanted)) {
    showScenario(null);
    const answer = await block.show(keyOf(wanted), responseOf(wanted));
    if (mine !== turn) return;
    if (answer) showRelation(answer, wanted, await described(wanted.pulse), () => set({ period: "" }));
    scenario = answer ? scenarioOfBlock(answer) : scenarioWithoutResponse(wanted);
  } else {
    block.nothing(GROUPS);
    scenario = scenarioOf(wanted);
  }
  showScenario(scenario);
}

/** What the response to a state depends on: a period that is not stated is that of its PGV. */
function keyOf(wanted) {
  return JSON.stringify([blockParams(wanted), wanted.period === "" && toSI("velocity", wanted.velocity)]);
}

function responseOf(wanted) {
  return async function* load(signal) {
    const params = blockParams(wanted);
    if (wanted.period === "") params.period = matchingPeriod(wanted, await described(wanted.pulse)) ?? "";
    yield await (isSampled(params.pulse) ? blockUnderSamples(params, signal) : ask("/v1/blocks/response", blockQuery(params), signal));
  };
}

/** Show a scenario in every view; null: it is unknown, `idle` until the reader acts. */
function showScenario(found, idle = false) {
  if (found || !view) view = windowOf(state(), found?.point);
  if (!idle) fillForm(state(), found);
  showMap(found, view, idle);
  showReadout(null, found, idle);
  showMotion(found, idle);
  showSpectrum(found, view, idle);
  link(found);
}

/** The form cannot be read: dim what is shown, which belongs to the block of the state. */
function edit() {
  turn += 1;
  scenario = null;
  block.wait({ idle: true, words: EDITED });
  showSite(null);
  showScenario(null, true);
}

/** Change the state. */
function set(parts, keep = true) {
  change(parts, { keep });
}

function link(found) {
  const map = (format) => urlOf("/v1/map", { ...mapParams(), format });
  const spectrum = (format) => spectrumUrl(found, view, format);
  setLinks("map", found ? { csv: map("csv"), nc: map("nc"), curves: `${curvesUrl()}&format=csv` } : {});
  const params = found?.answer && { ...blockParams(state()), period: found.answer.query.period };
  setLinks("block", params ? { json: urlOf("/v1/blocks/response", blockQuery(params)) } : {});
  document.getElementById("open-report").disabled = !found?.answer;
  setLinks("spectrum", found?.point ? { csv: spectrum("csv"), nc: spectrum("nc") } : {});
}

document.getElementById("open-report").addEventListener("click", async () => {
  const [{ showReport }, { blockReport }] = await Promise.all([import("./report.js"), import("./block_report.js")]);
  showReport(blockReport(scenario.answer));
});

function caption() {
  const { pulse, restitution, alpha_deg, point } = scenario;
  const parts = [pulseName(pulse), `η = ${number(restitution, 4)}`];
  parts.push(Number(alpha_deg) ? `α = ${number(alpha_deg, 4)}°` : "slender limit");
  if (point) parts.push(`ω = ${number(point.frequency_ratio, 5)}`, `1/a = ${number(point.slenderness, 5)}`);
  return parts.join(", ");
}

const look = () => ({ state: state(), scenario, view });
wireForm(look, set, edit);
wireGestures(look, set);
wireMap(look, (point, keep) => set(movedTo(state(), scenario, point), keep), set, () => undo.click());
wireDownloads(caption);
document.getElementById("whole").addEventListener("click", () => set(whole()));
undo.addEventListener("click", () => history.back());
onChange(show);
show();
