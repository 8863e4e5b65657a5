// The response of a block to the single pulse, in words.

import { assumptions, element, facts } from "./page.js";
import { acceleration, length, number, pulseName, threshold, thresholds, velocity } from "./labels.js";
import { inShown, shown, toSI, written } from "./units.js";

const answer = document.getElementById("answer");
const title = document.getElementById("single-title");
const relation = document.getElementById("single-relation");

/** Show the response of a block; null clears it. */
export function showAnswer(found) {
  answer.replaceChildren();
  answer.hidden = found === null;
  if (found === null) {
    relation.replaceChildren();
    return;
  }
  const { pulse, period, peak_acceleration: peak } = found.query;
  title.textContent = `Under one pulse: ${pulseName(pulse)}, ${number(period)} s, ${acceleration(peak)}`;
  answer.append(
    element("p", verdict(found), { class: `verdict ${survives(found) ? "survives" : "overturns"}` }),
    element("p", sentence(found)),
    facts(factsOf(found)),
  );
  if (found.warnings.length) {
    const lines = found.warnings.map((warning) => element("li", warning));
    answer.append(element("p", "Warnings", { class: "warnings" }), element("ul", lines));
  }
  answer.append(assumptions(found.metadata));
}

/** Say how the pulse of a response is related to those of every shape, and what to press for the one that belongs to them. */
export function showRelation({ query }, { period, velocity: text }, pulse, match) {
  const [asked, own] = [toSI("velocity", text), query.peak_acceleration * query.period * pulse.peak_velocity];
  if (period === "" || Math.abs(own / asked - 1) < 0.01) {
    relation.textContent = pulse.ends_at_rest
      ? "One of the shapes above, at the period that gives it this peak velocity. The answer above is that of the shape that overturns the block first."
      : "Not one of the shapes above: with this one the ground moves on when the shaking ends. So the two answers may differ.";
    return;
  }
  const words = `With this period the ground reaches ${velocity(own)}, not the ${velocity(asked)} of the sentence: the answer above is for another ground motion. `;
  if (relation.textContent.startsWith(words)) return; // the button may be being pressed
  const button = element("button", "Take the period that belongs to the sentence", { type: "button" });
  button.addEventListener("click", match);
  relation.replaceChildren(words, button);
}

function survives(found) {
  return found.rocking_model_applies && !found.overturned;
}

function verdict(found) {
  if (!found.rocking_model_applies) return "The rocking model does not apply.";
  if (found.overturned) return "It overturns.";
  return found.response.outcome === "NO_UPLIFT" ? "It never uplifts." : "It rocks and comes to rest.";
}

function sentence(found) {
  if (!survives(found) || found.response.outcome === "NO_UPLIFT") return `It ${found.meaning}.`;
  return (
    `Under this one pulse it rocks by at most ${number(found.peak_rotation_deg)}°; its top moves ${length(found.displacement)} ` +
    "to the side. Then it comes to rest."
  );
}

function factsOf(found) {
  const pairs = [["Uplifts at", acceleration(found.uplift_acceleration)]];
  const { largest_surviving_acceleration: largest, friction_demand: friction, rocking_model_applies: applies } = found;
  pairs.push(["This block does not overturn below, at this period", largest === null ? reasonForNone(found) : acceleration(largest, threshold)]);
  if (found.url && largest !== null) pairs.push(["Friction coefficient required at that acceleration", number(found.largest_surviving_friction_demand, 2)]);
  const margin = applies && marginOf(found);
  if (margin) pairs.push(margin);
  const all = applies ? (found.thresholds ?? []) : [];
  const texts = thresholds(all.map((one) => [inShown("acceleration", one.peak_acceleration), one.overturns_above]));
  const unit = written(shown.acceleration);
  const changes = all.map((one, at) => `${one.overturns_above ? "overturns" : "survives"} from ${texts[at]} ${unit}`);
  if (changes.length > 1) pairs.push(["At this period it", changes.join(", ")]);
  if (found.url) pairs.push(["Friction coefficient required to prevent sliding", friction === null ? "it lifts off" : number(friction, 2)]);
  return pairs;
}

/** Why there is no largest surviving acceleration. */
function reasonForNone({ thresholds }) {
  if (thresholds === null) return "not found in time";
  return thresholds.length ? "not known: the rocking model does not apply" : "no limit found";
}

/** The peak acceleration of the nearest change of outcome at this period [m/s2]; undefined if none is known. */
export function nearestChange({ query, thresholds: found, rocking_model_applies: applies }) {
  const apart = (value) => Math.abs(value / query.peak_acceleration - 1);
  return applies ? (found ?? []).map((one) => one.peak_acceleration).sort((one, other) => apart(one) - apart(other))[0] : undefined;
}

/** The nearest change of outcome, relative to the peak acceleration. */
function marginOf(found) {
  const [given, nearest] = [found.query.peak_acceleration, nearestChange(found)];
  if (!nearest) return null;
  const way = nearest > given ? "more" : "less";
  const share = `${threshold(100 * Math.abs(nearest / given - 1), !found.overturned, 2)} %`;
  return ["Margin of acceleration", `${found.overturned ? "survives" : "overturns"} with ${share} ${way}`];
}
