// The response to a record in words.

import { assumptions, element, facts } from "./page.js";
import { acceleration, length, number, sentence as asSentence } from "./labels.js";

const answer = document.getElementById("answer");

/** Show the response of a block under a record; null clears it. */
export function showRecordAnswer(found) {
  answer.replaceChildren();
  answer.hidden = found === null;
  if (found === null) return;
  answer.append(
    element("p", verdict(found), { class: `verdict ${survives(found) ? "survives" : "overturns"}` }),
    element("p", marginOf(found), { class: "margin" }),
    element("p", sentence(found)),
    facts([...ofBlock(found), ...ofRecord(found.record, found.query.scale)]),
  );
  if (found.warnings.length) {
    const lines = found.warnings.map((warning) => element("li", warning));
    answer.append(element("p", "Warnings", { class: "warnings" }), element("ul", lines));
  }
  answer.append(assumptions(found.metadata));
}

/** Whether it survives this factor of the record and, as far as it was searched, every smaller one. */
function survives({ rocking_model_applies: applies, overturned, overturning_scale: from, query }) {
  return applies && !overturned && (from ?? Infinity) > query.scale;
}

/** From which factor of the record it overturns, in a sentence. */
export function marginOf({ margin }) {
  return margin ? asSentence(margin) : "";
}

/** The outcome under the second horizontal component, and which of the two overturns it first. */
export function secondOutcome(found, first, name) {
  const [own, other] = [found, first].map(({ overturning_scale: from }) => from ?? Infinity);
  const order = own < other ? " It is the worse of the two." : own > other ? " It is the milder of the two." : "";
  return `Under the second component, ${name}: ${verdict(found)} ${marginOf(found)}${order}`;
}

/** That the record does not determine the peak, in a sentence; empty where it does. */
export function doubtOf({ peak_is_determined: determined, amplification }) {
  const by = amplification === null ? "" : ` (amplification ${number(amplification, 2)})`;
  return determined ? "" : ` The peak is not determined by this record${by}.`;
}

/** The outcome in a few words. */
export function verdict(found) {
  if (!found.rocking_model_applies) return "The rocking model does not apply.";
  if (found.overturned) return "It overturns.";
  return found.outcome === "NO_UPLIFT" ? "It never uplifts." : "It rocks and comes to rest.";
}

function sentence(found) {
  if (!found.rocking_model_applies) return `${found.meaning}.`;
  if (found.overturned || found.outcome === "NO_UPLIFT") return `Under this record it ${found.meaning}.`;
  const beyond = found.exceeded_alpha ? " It rocks beyond α." : "";
  return `It turns at most ${number(found.peak_rotation_deg)}° (${number(found.peak_rotation)} α), and its top moves ${length(found.displacement)}.${doubtOf(found)}${beyond}`;
}

/** Facts about the block: pairs of term and value. */
export function ofBlock(found) {
  const friction = found.friction_demand;
  const { peak_is_determined: determined, amplification } = found;
  const follows = determined && amplification !== null ? [["With 1 % more of the record the rotation changes by", `${number(amplification, 2)} %`]] : [];
  return [
    ...follows,
    ["Uplifts at", acceleration(found.uplift_acceleration)],
    ["Coefficient of restitution", number(found.restitution, 4)],
    ["Friction coefficient required to prevent sliding", friction === null ? "it lifts off" : number(friction, 2)],
  ];
}

/** Facts about the record, times a factor. */
export function ofRecord(record, scale) {
  return [
    ["Peak ground acceleration", acceleration(scale * record.peak_acceleration)],
    ["Peak ground velocity", `${number(scale * record.peak_velocity)} m/s`],
    ["Peak ground displacement", length(scale * record.peak_displacement)],
    ["Arias intensity", `${number(scale ** 2 * record.arias_intensity)} m/s`],
    ["Significant duration, 5 to 95 %", `${number(record.significant_duration)} s`],
    ["Mean period", record.mean_period === null ? "none" : `${number(record.mean_period)} s`],
    ["Samples", `${record.samples}, ${number(record.time_step, 4)} s apart`],
  ];
}
