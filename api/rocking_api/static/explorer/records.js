// The page of a record: file and block from the form, and from there to every view.

import { file as fileOf, send } from "./api.js";
import { chartsReady } from "./chart.js";
import { joined } from "./components.js";
import { onDrop } from "./drop.js";
import { drawMotion } from "./motion_charts.js";
import { number } from "./labels.js";
import { clearErrors, element, setStatus } from "./page.js";
import { pane } from "./pane.js";
import { unload } from "./player.js";
import { secondOutcome, showRecordAnswer } from "./record_answer.js";
import { drawPulse } from "./record_pulse.js";
import { changes, drawScales, markFactors } from "./record_scales.js";
import { onChange, refresh } from "./state.js";
import { toSI } from "./units.js";

const SAMPLES = 4000;
const STATED = ["file_format", "acceleration", "vertical", "time", "time_unit", "time_step", "unit", "skip", "delimiter", "decimal", "baseline_order"];
const FLAGS = ["wrapped", "allow_unusual"];

const form = document.getElementById("record");
const input = document.getElementById("file");
const factor = document.getElementById("factor");
const report = document.getElementById("open-report");

let file = null;
let takes = 0; // number of times that files were taken; the last ones count
let answer = null; // the response, from which the views take the size of the block
let margins = "Not computed."; // factors at which the outcome changes, in words

const result = view("answer", "record-status", "Computing …", (found) => {
  answer = found;
  showRecordAnswer(found);
  report.disabled = found === null;
});
const motion = view("motion", "motion-status", "Computing the time history …", (history) => {
  if (history) drawMotion(inGroups(history), { size: sizeOf(answer), alpha_deg: answer.alpha_deg, note: noteOf(answer) });
  else unload();
});
const other = view("second-answer", "second-status", "Computing the second component …", (found) => {
  document.querySelector("#second-answer p").textContent = found ? secondOutcome(found, answer) : "";
});
const scales = view("scales", "scales-status", "Computing other factors …", (found) => {
  margins = found ? changes(found) : "Not computed.";
  if (found) drawScales(found, answer);
  markFactors(found);
});
const pulse = view("pulse", "pulse-status", "Fitting a pulse …", (found) => found && drawPulse(found));

function view(id, status, doing, draw) {
  const section = document.getElementById(id);
  const box = section.querySelector(".motion, .picture") ?? section;
  return pane({ box, status: document.getElementById(status), doing, draw, clear: () => draw(null) });
}

/** Show what the form holds; without `all` only the response and the motion, while the slider of the factor moves. */
async function show(_, all = true) {
  clearErrors();
  if (!file) return;
  const power = Math.log10(Number(form.elements.scale.value.replace(",", ".")));
  if (Number.isFinite(power)) factor.value = power;
  const params = paramsOf();
  const own = file; // another one may be chosen while this waits; its answers would have the name of this one
  const key = (more) => JSON.stringify([params, more, own.name, own.size, own.lastModified]);
  const second = form.elements.second.value.trim();
  for (const one of [motion, scales, pulse, other]) one.wait();
  const found = await result.show(key("response"), upload("response", params, own));
  if (own !== file) return;
  if (!found) {
    openDetails();
    for (const one of [motion, scales, pulse, other]) one.nothing();
    return;
  }
  const { scale, ...unscaled } = params;
  await motion.show(key("history"), upload("history", { ...params, samples: SAMPLES }, own));
  if (own !== file) return;
  if (second) await other.show(key(second), upload("response", { ...params, acceleration: second }, own));
  else other.nothing();
  if (!all || own !== file) return;
  await scales.show(key("scales"), upload("scales", { ...unscaled, ...windowOf(found) }, own));
  if (own !== file) return;
  await pulse.show(key("pulse"), upload("pulse", params, own));
}

function upload(route, params, file) {
  return async function* load(signal) {
    await chartsReady();
    yield await send(`/v1/records/${route}`, params, file, signal);
  };
}

/** Parameters of the routes, in SI units. */
function paramsOf() {
  const text = (name) => form.elements[name].value.trim();
  const quantity = (name) => toSI(name, `${text(name) || "?"} ${form.elements[`${name}_unit`].value}`);
  const [scale, restitution] = ["scale", "restitution"].map((name) => text(name).replace(",", "."));
  return {
    name: file.name.slice(0, 200),
    ...Object.fromEntries(STATED.map((name) => [name, text(name)])),
    ...Object.fromEntries(FLAGS.filter((name) => form.elements[name].checked).map((name) => [name, "true"])),
    width: quantity("width"),
    height: quantity("height"),
    scale: scale || "?",
    restitution: restitution.toLowerCase() || "?",
  };
}

/** Factors from uplift to ten times that, and to twice the factor of the form. */
function windowOf({ uplift_acceleration, record, query }) {
  const uplift = uplift_acceleration / record.peak_acceleration;
  return { scale_min: Math.min(uplift, query.scale), scale_max: Math.max(10 * uplift, 2 * query.scale) };
}

function sizeOf(found) {
  return {
    R: found.half_diagonal,
    p: found.frequency_parameter,
    alpha: (found.alpha_deg * Math.PI) / 180,
    uplift: found.uplift_acceleration,
  };
}

/** A history whose variable of time is tau = p t. */
function inGroups(history) {
  const p = answer.frequency_parameter;
  const [tau, impact_time] = [history.time, history.impact_time].map((times) => times.map((time) => p * time));
  return { ...history, tau, impact_time };
}

function noteOf(found) {
  return found.rocking_model_applies ? "" : "The rocking model does not apply; held in place:";
}

/** What the file does not state is stated there. */
function openDetails() {
  if (document.getElementById("file-problem").textContent) document.getElementById("more").open = true;
}

/** Until a file is chosen, a part of a record is shown. */
async function example() {
  const found = await fileOf("/static/example-record.csv", "South Napa 2014, CE.68150, east, part.csv", new AbortController().signal);
  if (!takes) take([found]);
}

async function take(files) {
  if (!files.length) return;
  const mine = ++takes;
  try {
    const { chosen, columns, file: found } = await joined(files);
    if (mine !== takes) return;
    file = found;
    for (const name of ["acceleration", "second", "vertical"]) form.elements[name].value = chosen[name] ?? "";
    document.getElementById("columns").replaceChildren(...columns.map((value) => element("option", "", { value })));
    document.getElementById("more").open ||= files.length > 1;
    document.getElementById("dropped").textContent = `${file.name}; drop another one anywhere on this page`;
    refresh();
  } catch (problem) {
    setStatus(document.getElementById("record-status"), problem, () => take(files));
  }
}

for (const unit of ["g", "m/s2", "cm/s2", "gal", "mm/s2", "mg", "%g", "g/10", "in/s2", "ft/s2"]) form.elements.unit.append(element("option", unit));
input.addEventListener("change", () => take(input.files));
form.addEventListener("submit", (event) => {
  event.preventDefault();
  if (file) refresh();
});
onDrop((_, files) => take(files));
report.addEventListener("click", async () => {
  const { showReport } = await import("./report.js");
  const { recordReport } = await import("./record_report.js");
  showReport(recordReport(answer, margins));
});
form.addEventListener("change", ({ target }) => target !== input && target !== factor && refresh());
factor.addEventListener("input", () => {
  form.elements.scale.value = number(10 ** factor.value);
  show(null, false);
});
factor.addEventListener("change", refresh);
onChange(show);
example();
