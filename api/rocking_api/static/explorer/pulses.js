// What is known of the pulses: descriptions by the service, those of own samples, and the period that belongs to a site.

import { ask, isSampled } from "./api.js";
import { toSI } from "./units.js";

const SAMPLES = 65;

/** The description of the pulse of a state; undefined for an unknown one. Throws as `ask`. */
export async function described(pulse) {
  if (isSampled(pulse)) return ownOf(pulse);
  const { pulses } = await ask("/v1/pulses", { samples: SAMPLES }, new AbortController().signal);
  return pulses.find(({ name }) => name === pulse.replace(/^-/, ""));
}

/** The description of samples over one period, scaled to the peak 1. */
function ownOf(samples) {
  const values = samples.split(" ").map(Number);
  const peak = Math.max(...values.map(Math.abs)) || 1;
  return samplesOver(values.map((value) => value / peak));
}

/** The description of accelerations over one period. */
export function samplesOver(acceleration) {
  const step = 1 / Math.max(acceleration.length - 1, 1);
  const time = acceleration.map((_, at) => at * step);
  let [velocity, peak] = [0, 0];
  const add = (part) => {
    velocity += part;
    peak = Math.max(peak, Math.abs(velocity));
  };
  acceleration.slice(1).forEach((after, at) => {
    const before = acceleration[at];
    const zero = before * after < 0 ? before / (before - after) : 1; // share of the step up to which the sign is that before
    add(0.5 * step * zero * (before + (zero < 1 ? 0 : after)));
    add(0.5 * step * (1 - zero) * after);
  });
  const definition = "Linear between the samples. Drag over the picture to draw it.";
  return { time, acceleration, duration: 1, peak_velocity: peak, ends_at_rest: Math.abs(velocity) <= 1e-9 * peak, definition };
}

/** The period at which a pulse has PGA and PGV of a state [s]; null if these are no numbers. */
export function matchingPeriod({ acceleration, velocity }, { peak_velocity: peak }) {
  const period = toSI("velocity", velocity) / (toSI("acceleration", acceleration) * peak);
  return period > 0 && period < Infinity ? Number(period.toPrecision(4)) : null;
}
