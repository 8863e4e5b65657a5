// The page of a record: what is read from a file is stated and looked at; then file and block go to every view.

import { file as fileOf, send } from "./api.js";
import { chartsReady } from "./chart.js";
import { onDrop } from "./drop.js";
import { drawMotion } from "./motion_charts.js";
import { number } from "./labels.js";
import { clearErrors, setStatus } from "./page.js";
import { pane } from "./pane.js";
import { unload } from "./player.js";
import { secondOutcome, showRecordAnswer } from "./record_answer.js";
import { drawPreview, markMissing } from "./record_preview.js";
import { drawPulse } from "./record_pulse.js";
import { changes, drawScales, markFactors } from "./record_scales.js";
import { commandOf, remember, restore, valueOf, wireCopy } from "./stated.js";
import { onChange, refresh } from "./state.js";
import { toSI } from "./units.js";

const SAMPLES = 4000;
const LAYOUT = ["file_format", "acceleration", "unit", "time", "time_unit", "time_step", "skip", "delimiter", "decimal", "wrapped", "vertical", "allow_unusual", "baseline_order"];
const BLOCK = ["width", "width_unit", "height", "height_unit", "scale", "restitution"];
const REMEMBERED = [...LAYOUT, "second", ...BLOCK];

const form = document.getElementById("record");
const input = document.getElementById("file");
const factor = document.getElementById("factor");
const report = document.getElementById("open-report");

let file = null;
let takes = 0; // number of times that files were taken; the last one counts
let previewed = ""; // file and layout that the page shows
let confirmed = ""; // those that the reader has looked at and confirmed
let answer = null; // the response, from which the views take the size of the block
let margins = "Not computed."; // factors at which the outcome changes, in words

const preview = view("preview", "preview-status", "Reading the file …", (found) => found && drawPreview(found, form, file.name));
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
  document.querySelector("#second-answer p").textContent = found ? secondOutcome(found, answer, nameOfSecond()) : "";
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
  remember(form, REMEMBERED);
  document.getElementById("command").textContent = command();
  if (!file) return;
  const power = Math.log10(Number(form.elements.scale.value.replace(",", ".")));
  if (Number.isFinite(power)) factor.value = power;
  const layout = layoutOf();
  const own = file; // another one may be chosen while this waits; its answers would have the name of this one
  const read = keyOf(layout);
  for (const one of [result, motion, scales, pulse, other]) one.wait();
  const held = await preview.show(read, upload("preview", layout, own));
  if (own !== file) return;
  previewed = held ? read : "";
  if (held) markMissing(held, form);
  if (!held?.record || held.problem || confirmed !== read) {
    for (const one of [motion, scales, pulse, other]) one.nothing();
    result.nothing(held?.record && !held.problem ? "Look at the record, then press “Does it overturn?”." : "");
    return;
  }
  const params = { ...layout, ...blockOf() };
  const key = (more) => JSON.stringify([read, params, more]);
  const found = await result.show(key("response"), upload("response", params, own));
  if (own !== file) return;
  if (!found) {
    for (const one of [motion, scales, pulse, other]) one.nothing();
    return;
  }
  const { scale, ...unscaled } = params;
  await motion.show(key("history"), upload("history", { ...params, samples: SAMPLES }, own));
  if (own !== file) return;
  if (nameOfSecond()) await other.show(key(nameOfSecond()), second(params, own));
  else other.nothing();
  if (!all || own !== file) return;
  await scales.show(key("scales"), upload("scales", { ...unscaled, ...windowOf(found) }, own));
  if (own !== file) return;
  await pulse.show(key("pulse"), upload("pulse", params, own));
}

/** A load of a route for a file; a vertical component in a file of its own goes with it as JSON. */
function upload(route, params, chosen) {
  return async function* load(signal) {
    await chartsReady();
    const upwards = form.elements.vertical_file.files[0];
    if (!upwards) {
      yield await send(`/v1/records/${route}`, params, chosen, signal);
      return;
    }
    const stated = Object.fromEntries(Object.entries(params).filter(([, value]) => value !== ""));
    const body = { ...stated, record: await textOf(chosen), vertical_record: await textOf(upwards) };
    yield await send(`/v1/records/${route}`, {}, new Blob([JSON.stringify(body)], { type: "application/json" }), signal);
  };
}

/** The text of a file in UTF-8, or else in Latin-1, as the service reads it. */
async function textOf(chosen) {
  const content = await chosen.arrayBuffer();
  try {
    return new TextDecoder("utf-8", { fatal: true }).decode(content);
  } catch {
    return new TextDecoder("latin1").decode(content);
  }
}

/** The second horizontal component: a file of its own, or a column. */
function second(params, chosen) {
  const own = form.elements.second_file.files[0];
  return own ? upload("response", params, own) : upload("response", { ...params, acceleration: form.elements.second.value }, chosen);
}

function nameOfSecond() {
  return form.elements.second_file.files[0]?.name ?? form.elements.second.value;
}

/** Parameters that say how the file is read. */
function layoutOf() {
  return { name: file.name.slice(0, 200), ...Object.fromEntries(LAYOUT.map((name) => [name, stated(name)])) };
}

/** What is stated about a file; a decimal comma of the time step is a dot. */
function stated(name) {
  const value = valueOf(form.elements[name]);
  return name === "time_step" ? value.replace(",", ".") : value;
}

/** The files and how they are read, as text. */
function keyOf(layout) {
  const files = [file, form.elements.vertical_file.files[0]].map((one) => one && [one.name, one.size, one.lastModified]);
  return JSON.stringify([layout, files]);
}

/** Parameters of the block, in SI units. */
function blockOf() {
  const text = (name) => form.elements[name].value.trim();
  const quantity = (name) => toSI(name, `${text(name) || "?"} ${form.elements[`${name}_unit`].value}`);
  const [scale, restitution] = ["scale", "restitution"].map((name) => text(name).replace(",", "."));
  return { width: quantity("width"), height: quantity("height"), scale: scale || "?", restitution: restitution.toLowerCase() || "?" };
}

/** The command that reads this file in this way. */
function command() {
  const words = ["rocking", "record", file?.name ?? "FILE"];
  const text = (name) => form.elements[name].value.trim().replace(",", ".");
  for (const name of ["width", "height"]) words.push(`--${name}`, text(name) + form.elements[`${name}_unit`].value);
  if (text("scale") !== "1") words.push("--scale", text("scale"));
  if (text("restitution") !== "momentum") words.push("--restitution", text("restitution"));
  for (const name of LAYOUT) {
    const value = stated(name);
    if (!value) continue;
    words.push(`--${name.replaceAll("_", "-")}`);
    if (name === "time_step") words.push(`${value}s`);
    else if (form.elements[name].type !== "checkbox") words.push(value);
  }
  const upwards = form.elements.vertical_file.files[0];
  if (upwards) words.push("--vertical", upwards.name);
  return commandOf(words);
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

/** Until a file is chosen, a part of a record is shown, whose header states everything. */
async function example() {
  const found = await fileOf("/static/example-record.csv", "South Napa 2014, CE.68150, east, part.csv", new AbortController().signal);
  if (takes) return;
  take(found);
  confirmed = keyOf(layoutOf());
}

function take(chosen) {
  if (!chosen) return;
  takes += 1;
  file = chosen;
  document.getElementById("dropped").textContent = `${file.name}; drop another one anywhere on this page`;
  refresh();
}

/** Compute what is shown; where something is not stated, go to its field. */
function confirm() {
  if (!file) return;
  if (previewed === keyOf(layoutOf())) confirmed = previewed;
  const wrong = [...form.elements].find((field) => field.getAttribute("aria-invalid"));
  if (wrong) wrong.focus();
  else refresh();
}

function clear() {
  for (const name of [...LAYOUT, "second", "second_file", "vertical_file"]) {
    const field = form.elements[name];
    if (field.type === "checkbox") field.checked = false;
    else field.value = "";
  }
  refresh();
}

input.addEventListener("change", () => take(input.files[0]));
form.addEventListener("submit", (event) => {
  event.preventDefault();
  confirm();
});
onDrop(take);
report.addEventListener("click", async () => {
  const { showReport } = await import("./report.js");
  const { recordReport } = await import("./record_report.js");
  showReport(recordReport(answer, margins));
});
document.querySelector("main").addEventListener("change", ({ target }) => target.form === form && target !== input && target !== factor && refresh());
factor.addEventListener("input", () => {
  form.elements.scale.value = number(10 ** factor.value);
  show(null, false);
});
factor.addEventListener("change", refresh);
document.getElementById("clear").addEventListener("click", clear);
wireCopy(document.getElementById("copy-command"), document.getElementById("command"), document.getElementById("copied"));
onChange(show);
if (restore(form, REMEMBERED)) {
  setStatus(document.getElementById("preview-status"), "The address says how a file is read: choose the file.");
  show();
} else example();
