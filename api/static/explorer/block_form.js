// The form for a block in metres, and the answer in plain words.

import { element } from "./page.js";
import { MISSING, split, UNITS } from "./units.js";
import { length, number } from "./words.js";

const GRAVITY = 9.80665;
const QUANTITIES = Object.keys(UNITS);

const form = document.getElementById("block");
const answer = document.getElementById("answer");

/** Wire the form: `submit(parts)` gets what to write into the state. */
export function wireForm(submit) {
  for (const name of QUANTITIES) {
    const units = form.elements[`${name}_unit`];
    for (const unit of Object.keys(UNITS[name])) units.append(element("option", unit));
  }
  form.elements.how.addEventListener("change", showHow);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const parts = { pulse: form.elements.pulse.value };
    for (const name of QUANTITIES) {
      parts[name] = `${form.elements[name].value.trim() || MISSING} ${form.elements[`${name}_unit`].value}`;
    }
    parts.restitution = form.elements.how.value === "housner" ? "housner" : form.elements.eta.value.trim() || MISSING;
    submit(parts);
  });
  showHow();
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
    element("p", found.overturned ? "It falls." : "It stands.", {
      class: `verdict ${found.overturned ? "falls" : "stands"}`,
    }),
    element("p", sentence(found)),
    list(facts(found)),
  );
  if (found.warnings.length) {
    const lines = found.warnings.map((warning) => element("li", warning));
    answer.append(element("p", "Doubt this answer, for:", { class: "doubt" }), element("ul", lines));
  }
}

function sentence(found) {
  if (found.response.outcome === "NO_UPLIFT") return "The ground motion is too weak to lift it off its base.";
  if (found.overturned) return `It ${found.meaning}.`;
  return (
    `It rocks by at most ${number(found.peak_rotation_deg)}°; its top moves ${length(found.top_displacement)} ` +
    "to the side. Then it comes to rest."
  );
}

function facts(found) {
  const said = [["Starts to rock at", acceleration(found.uplift_acceleration)]];
  const safe = found.largest_safe_acceleration;
  const limit = found.thresholds === null ? "not found in time" : "no limit found";
  said.push(["Safe up to, at this period", safe === null ? limit : acceleration(safe)]);
  const margin = marginOf(found);
  if (margin) said.push(margin);
  const changes = (found.thresholds ?? []).map(
    (one) => `${one.overturns_above ? "falls" : "stands"} from ${number(one.peak_acceleration / GRAVITY)} g`,
  );
  if (changes.length > 1) said.push(["At this period it", changes.join(", ")]);
  const friction = found.friction_demand;
  if (found.response.outcome !== "NO_UPLIFT") {
    said.push(["Friction it needs, so as not to slide", friction === null ? "it lifts off" : number(friction, 2)]);
  }
  return said;
}

/** The nearest change of fate, as a share of the acceleration asked about. */
function marginOf(found) {
  const asked = found.query.peak_acceleration;
  const apart = (threshold) => Math.abs(threshold.peak_acceleration / asked - 1);
  const [nearest] = [...(found.thresholds ?? [])].sort((one, other) => apart(one) - apart(other));
  if (!nearest) return null;
  const way = nearest.peak_acceleration > asked ? "more" : "less";
  const share = `${number(100 * apart(nearest), 2)} %`;
  return ["Margin of acceleration", `${found.overturned ? "stands" : "falls"} with ${share} ${way}`];
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
