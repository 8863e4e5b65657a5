// The sentence and the settings: quantities, pulse, restitution, slenderness angle, units. They are the state.

import { isSampled } from "./api.js";
import { samplesOf, TRIANGLE } from "./own_pulse.js";
import { element } from "./page.js";
import { problems, showErrors } from "./form_errors.js";
import { number, PULSES } from "./labels.js";
import { wireDrawing } from "./pulse_preview.js";
import { isBlock } from "./state.js";
import { inUnit, MISSING, shown, split, SYSTEMS, toSI, UNITS, written } from "./units.js";

const QUANTITIES = Object.keys(UNITS);

const OWN = "own";

const form = document.getElementById("block");
const { pulse } = form.elements;
const samples = document.getElementById("samples");
const how = document.getElementById("how");
const eta = document.getElementById("eta");
const alpha = document.getElementById("alpha");
const units = document.getElementById("units");
const outputs = { eta: document.getElementById("eta-value"), alpha: document.getElementById("alpha-value") };

let derived = true; // the period is that of the sentence

/** Wire the form: `set(parts, keep)` changes the state, `edit()` says that it cannot be read; `look()` gives state and scenario. */
export function wireForm(look, set, edit) {
  for (const [name, words] of Object.entries(PULSES)) pulse.append(element("option", words, { value: name }));
  pulse.append(element("option", "Own samples", { value: OWN }));
  units.append(element("option", "as given", { value: "", hidden: "" }), ...Object.keys(SYSTEMS).map((name) => element("option", name)));
  for (const name of QUANTITIES) {
    const field = form.elements[name];
    const read = () => (name === "period" ? { ...block(), period: stated("period") } : block());
    field.addEventListener("input", () => (problems(form, needed(name)).length ? edit() : set(read(), false)));
    field.addEventListener("change", () => {
      if (name === "period" && !field.value.trim()) set({ ...block(), period: "" }, true);
      else if (showErrors(form, needed(name))) set(read(), true);
    });
  }
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    if (showErrors(form, needed())) set(block(), true);
  });
  pulse.addEventListener("change", () => set({ pulse: pulse.value === OWN ? samplesOf(samples.value || TRIANGLE) : pulse.value }, true));
  samples.addEventListener("change", () => set({ pulse: samplesOf(samples.value) || TRIANGLE }, true));
  wireDrawing((drawn) => set({ pulse: drawn }, true));
  how.addEventListener("change", () => set({ restitution: how.value === "momentum" ? "momentum" : eta.value }, true));
  units.addEventListener("change", () => set({ ...block(SYSTEMS[units.value]), ...(isBlock(look().state) ? {} : EMPTY) }, true));
  for (const [name, keep] of [["input", false], ["change", true]]) {
    eta.addEventListener(name, () => set({ restitution: eta.value }, keep));
    alpha.addEventListener(name, () => set(isBlock(look().state) ? leaning() : { alpha_deg: alpha.value }, keep));
  }
}

const EMPTY = { width: "", height: "", acceleration: "", period: "" };

/** The fields that must have a number when one is edited: not the period if it is derived. */
function needed(edited) {
  return QUANTITIES.filter((name) => name !== "period" || edited === name || !derived);
}

function stated(name) {
  return `${form.elements[name].value.trim() || MISSING} ${shown[name]}`;
}

/** The block of the form as parts of a state, in the units that are shown, or converted to others; a derived period is left out. */
function block(others = shown) {
  const found = { frequency_ratio: "", slenderness: "", alpha_deg: "0" };
  for (const name of needed()) {
    const text = stated(name);
    found[name] = others[name] === shown[name] ? text : inUnit(name, toSI(name, text), others[name]);
  }
  Object.assign(shown, others);
  return found;
}

/** The width with which a block of this height has the angle of the slider. */
function leaning() {
  const height = toSI("height", `${form.elements.height.value} ${shown.height}`);
  return { width: inUnit("width", height * Math.tan((Math.max(alpha.value, 1) * Math.PI) / 180)) };
}

/** Fill the form with a state, and with what its scenario (null: not known yet) derives from it. */
export function fillForm(state, scenario) {
  const own = isSampled(state.pulse);
  pulse.value = own ? OWN : state.pulse;
  samples.parentElement.hidden = !own;
  if (own && document.activeElement !== samples) samples.value = state.pulse; // not while it is typed
  derived = state.period === "";
  const given = { ...state, ...(derived && scenario?.answer && { period: inUnit("period", scenario.answer.query.period) }) };
  for (const name of QUANTITIES) {
    if (given[name] === "") continue;
    const { value, unit } = split(given[name]);
    const field = form.elements[name];
    if (unit in UNITS[name]) shown[name] = unit;
    if (field.value.trim() !== value) field.value = value === MISSING ? "" : value; // not while it is typed
  }
  for (const name of QUANTITIES) document.getElementById(`${name}-unit`).textContent = written(shown[name]);
  const system = Object.entries(SYSTEMS).find(([, own]) => QUANTITIES.every((name) => own[name] === shown[name]));
  units.value = system?.[0] ?? "";
  const { restitution, alpha_deg } = scenario ?? { restitution: state.restitution, alpha_deg: null };
  how.value = state.restitution === "momentum" ? "momentum" : "number";
  const known = Number.isFinite(Number(restitution));
  outputs.eta.textContent = known ? number(restitution) : "…";
  if (known) eta.value = restitution;
  outputs.alpha.textContent = alpha_deg === null ? "…" : Number(alpha_deg) === 0 ? "slender limit" : `${number(alpha_deg)}°`;
  if (alpha_deg !== null) alpha.value = alpha_deg;
}
