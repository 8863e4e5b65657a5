// A pulse of the reader's own: in the state its samples, separated by blanks, in place of a name.

import { ask, send } from "./api.js";
import { OUTCOMES } from "./labels.js";

export const TRIANGLE = "0 1 0";

/** Text with numbers, one behind or below the other, as the pulse of a state. */
export function samplesOf(text) {
  return text.trim().split(/[\s;,]+/).join(" ");
}

/** The response of one block under samples, in the form of that under a named pulse; friction is not assessed. */
export async function blockUnderSamples(params, signal) {
  const { pulse, restitution, ...block } = params;
  const acceleration = pulse.split(" ").map(Number);
  const body = new Blob([JSON.stringify({ blocks: [block], pulse: { acceleration }, restitution })], { type: "application/json" });
  const found = await send("/v1/blocks/response", {}, body, signal);
  const columns = Object.entries(found).filter(([, value]) => Array.isArray(value) && value.length === 1);
  const row = Object.fromEntries(columns.map(([name, [value]]) => [name, value]));
  const { slenderness, frequency_ratio, alpha_deg, outcome, uplift_acceleration: uplift } = row;
  const changes = await ask("/v1/thresholds", { pulse, frequency_ratio, alpha_deg, restitution: row.restitution }, signal);
  const thresholds = changes.thresholds.map((one) => ({ ...one, peak_acceleration: one.amplitude * uplift }));
  return {
    ...row,
    query: params,
    response: { ...row, query: { slenderness, frequency_ratio } },
    meaning: OUTCOMES[outcome],
    rocking_model_applies: true,
    half_diagonal: Math.hypot(block.width, block.height) / 2,
    frequency_parameter: (2 * Math.PI) / (block.period * frequency_ratio),
    thresholds,
    largest_surviving_acceleration: changes.largest_surviving_amplitude === null ? null : changes.largest_surviving_amplitude * uplift,
    largest_surviving_friction_demand: null,
    friction_demand: null,
    margins: null,
    warnings: ["friction is not assessed under samples"],
    metadata: found.metadata,
    version: found.version,
  };
}
