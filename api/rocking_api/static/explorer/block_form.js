// The form for a block in metres, and its response in words.

import { assumptions, element, facts } from "./page.js";
import { showErrors } from "./form_errors.js";
import { MISSING, split, UNITS } from "./units.js";
import { inG, length, number, threshold, thresholds } from "./labels.js";

const GRAVITY = 9.80665;
const QUANTITIES = Object.keys(UNITS);

const form = document.getElementById("block");
const answer = document.getElementById("answer");

/** Wire the form: `submit(parts)` gets the new parts of the state, `edit()` is called after each edit. */
export function wireForm(submit, edit) {
  form.elements.how.addEventListener("change", showHow);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    if (showErrors(form, form.elements.how.value === "momentum" ? QUANTITIES : [...QUANTITIES, "eta"])) submit(formParts());
  });
  form.addEventListener("input", edit);
  showHow();
}

/** The block of the form, as parts of a state. */
export function formParts() {
  const parts = { pulse: form.elements.pulse.value };
  for (const name of QUANTITIES) {
    parts[name] = `${form.elements[name].value.trim() || MISSING} ${form.elements[`${name}_unit`].value}`;
  }
  parts.restitution = form.elements.how.value === "momentum" ? "momentum" : form.elements.eta.value.trim() || MISSING;
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
  form.elements.how.value = state.restitution === "momentum" ? "momentum" : "number";
  if (state.restitution !== "momentum") form.elements.eta.value = state.restitution === MISSING ? "" : state.restitution;
  showHow();
}

/** Show the response of a block; null clears it. */
export function showAnswer(found) {
  answer.replaceChildren();
  answer.hidden = found === null;
  if (found === null) return;
  answer.append(
    element("p", verdict(found), { class: `verdict ${safe(found) ? "safe" : "unsafe"}` }),
    element("p", sentence(found)),
    facts(factsOf(found)),
  );
  if (found.warnings.length) {
    const lines = found.warnings.map((warning) => element("li", warning));
    answer.append(element("p", "Warnings", { class: "warnings" }), element("ul", lines));
  }
  answer.append(assumptions(found.metadata));
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

function factsOf(found) {
  const pairs = [["Uplifts at", inG(found.uplift_acceleration)]];
  const { largest_safe_acceleration: largest, friction_demand: friction, rocking_model_applies: applies } = found;
  pairs.push(["This block does not overturn below, at this period", largest === null ? reasonForNone(found) : inG(largest, threshold)]);
  if (largest !== null) pairs.push(["with a coefficient of friction of", number(found.largest_safe_friction_demand, 2)]);
  const margin = applies && marginOf(found);
  if (margin) pairs.push(margin);
  const all = applies ? (found.thresholds ?? []) : [];
  const texts = thresholds(all.map((one) => [one.peak_acceleration / GRAVITY, one.overturns_above]));
  const changes = all.map((one, at) => `${one.overturns_above ? "overturns" : "survives"} from ${texts[at]} g`);
  if (changes.length > 1) pairs.push(["At this period it", changes.join(", ")]);
  pairs.push(["Friction coefficient required to prevent sliding", friction === null ? "it lifts off" : number(friction, 2)]);
  return pairs;
}

/** Why there is no largest safe acceleration. */
function reasonForNone({ thresholds }) {
  if (thresholds === null) return "not found in time";
  return thresholds.length ? "not known: the rocking model does not apply" : "no limit found";
}

/** The nearest change of outcome, relative to the peak acceleration. */
function marginOf(found) {
  const given = found.query.peak_acceleration;
  const apart = (threshold) => Math.abs(threshold.peak_acceleration / given - 1);
  const [nearest] = [...(found.thresholds ?? [])].sort((one, other) => apart(one) - apart(other));
  if (!nearest) return null;
  const way = nearest.peak_acceleration > given ? "more" : "less";
  const share = `${threshold(100 * apart(nearest), !found.overturned, 2)} %`;
  return ["Margin of acceleration", `${found.overturned ? "survives" : "overturns"} with ${share} ${way}`];
}

function showHow() {
  form.elements.eta.disabled = form.elements.how.value === "momentum";
}
