// The form for a block in metres, and the answer in plain words.

import { element } from "./page.js";
import { MISSING, split, UNITS } from "./units.js";
import { length, number } from "./words.js";

const GRAVITY = 9.80665;
const QUANTITIES = Object.keys(UNITS);

const form = document.getElementById("block");
const answer = document.getElementById("answer");

/** Wire the form: `submit(parts)` gets what to write into the state, `edit()` is told of each edit. */
export function wireForm(submit, edit) {
  for (const name of QUANTITIES) {
    const units = form.elements[`${name}_unit`];
    for (const unit of Object.keys(UNITS[name])) units.append(element("option", unit));
  }
  form.elements.how.addEventListener("change", showHow);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    submit(formParts());
  });
  form.addEventListener("input", edit);
  showHow();
}

/** What the form says of a block, as parts of a state. */
export function formParts() {
  const parts = { pulse: form.elements.pulse.value };
  for (const name of QUANTITIES) {
    parts[name] = `${form.elements[name].value.trim() || MISSING} ${form.elements[`${name}_unit`].value}`;
  }
  parts.restitution = form.elements.how.value === "housner" ? "housner" : form.elements.eta.value.trim() || MISSING;
  return parts;
}

/** Fill the form with the block of a state. */
export function fillForm(state) {
  form.elements.pulse.value = state.pulse;
  if (state.width === "") return;
  for (const name of QUANTITIES) {
    const { value, unit } = split(state[name]);
    form.elements[name].value = value === MISSING ? "" : value;
    if (unit in UNITS[name]) form.elements[`${name}_unit`].value = unit;
  }
  form.elements.how.value = state.restitution === "housner" ? "housner" : "number";
  if (state.restitution !== "housner") form.elements.eta.value = state.restitution === MISSING ? "" : state.restitution;
  showHow();
}

/** Show the answer about a block; null clears it. */
export function showAnswer(found) {
  answer.replaceChildren();
  answer.hidden = found === null;
  if (found === null) return;
  answer.append(
    element("p", verdict(found), { class: `verdict ${safe(found) ? "safe" : "unsafe"}` }),
    element("p", sentence(found)),
    list(facts(found)),
  );
  if (found.warnings.length) {
    const lines = found.warnings.map((warning) => element("li", warning));
    answer.append(element("p", "Warnings", { class: "warnings" }), element("ul", lines));
  }
}

function safe(found) {
  return found.rocking_model_applies && !found.overturned;
}

function verdict(found) {
  if (!found.rocking_model_applies) return "The rocking model does not apply.";
  if (found.overturned) return "It overturns.";
  return found.response.outcome === "NO_UPLIFT" ? "It does not uplift." : "It survives (comes to rest).";
}

function sentence(found) {
  if (!safe(found) || found.response.outcome === "NO_UPLIFT") return `It ${found.meaning}.`;
  return (
    `It rocks by at most ${number(found.peak_rotation_deg)}°; its top moves ${length(found.top_displacement)} ` +
    "to the side. Then it comes to rest."
  );
}

function facts(found) {
  const said = [["Uplifts at", acceleration(found.uplift_acceleration)]];
  const { largest_safe_acceleration: largest, friction_demand: friction, rocking_model_applies: applies } = found;
  said.push(["This block does not overturn below, at this period", largest === null ? whyNone(found) : acceleration(largest)]);
  if (largest !== null) said.push(["with a coefficient of friction of", number(found.largest_safe_friction_demand, 2)]);
  const margin = applies && marginOf(found);
  if (margin) said.push(margin);
  const changes = (applies ? (found.thresholds ?? []) : []).map(
    (one) => `${one.overturns_above ? "overturns" : "survives"} from ${number(one.peak_acceleration / GRAVITY)} g`,
  );
  if (changes.length > 1) said.push(["At this period it", changes.join(", ")]);
  said.push(["Coefficient of friction that it needs, so as not to slide", friction === null ? "it lifts off" : number(friction, 2)]);
  return said;
}

/** Why there is no largest safe acceleration. */
function whyNone({ thresholds }) {
  if (thresholds === null) return "not found in time";
  return thresholds.length ? "not known: the rocking model does not apply" : "no limit found";
}

/** The nearest change of outcome, as a share of the acceleration asked about. */
function marginOf(found) {
  const asked = found.query.peak_acceleration;
  const apart = (threshold) => Math.abs(threshold.peak_acceleration / asked - 1);
  const [nearest] = [...(found.thresholds ?? [])].sort((one, other) => apart(one) - apart(other));
  if (!nearest) return null;
  const way = nearest.peak_acceleration > asked ? "more" : "less";
  const share = `${number(100 * apart(nearest), 2)} %`;
  return ["Margin of acceleration", `${found.overturned ? "survives" : "overturns"} with ${share} ${way}`];
}

function acceleration(value) {
  return `${number(value / GRAVITY)} g (${number(value)} m/s²)`;
}

function list(pairs) {
  const made = element("dl");
  for (const [term, value] of pairs) made.append(element("dt", term), element("dd", value));
  return made;
}

function showHow() {
  form.elements.eta.disabled = form.elements.how.value === "housner";
}
