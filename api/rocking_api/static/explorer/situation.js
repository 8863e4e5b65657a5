// What is looked at: the groups in the address, or those of a block in metres, which the service works out.
// A situation is pulse, restitution, alpha_deg and point (or null); of a block also its size and its answer.

import { DEFAULTS } from "./state.js";
import { inUnitOf, toSI } from "./units.js";

const GRAVITY = 9.80665; // [m/s2], the service's own unless it is told otherwise

/** The situation of a state in groups. */
export function situationOf({ pulse, restitution, alpha_deg, frequency_ratio, slenderness }) {
  const chosen = frequency_ratio !== "" && slenderness !== "";
  const point = chosen ? numbers({ frequency_ratio, slenderness }) : null;
  return { pulse, restitution, alpha_deg, point, size: null, answer: null };
}

/** The situation of a state whose block the service does not answer: its pulse, and no block. */
export function situationWithoutAnswer({ pulse }) {
  return situationOf({ ...DEFAULTS, pulse });
}

/** The situation of a block, by the answer of /v1/blocks/response. */
export function situationOfBlock(answer) {
  const { slenderness, frequency_ratio } = answer.response.query;
  return {
    pulse: answer.query.pulse,
    restitution: answer.restitution,
    alpha_deg: answer.alpha_deg,
    point: { frequency_ratio, slenderness },
    size: {
      R: answer.half_diagonal,
      p: answer.frequency_parameter,
      alpha: (answer.alpha_deg * Math.PI) / 180,
      uplift_in_g: answer.uplift_acceleration / GRAVITY,
    },
    answer,
  };
}

/** Said beside the motion of a block that would slide or lift off; empty where the rocking model applies. */
export function caveatOf({ answer }) {
  return answer && !answer.rocking_model_applies ? "The rocking model does not apply; held in place:" : "";
}

/** The question about a block in SI units. */
export function blockQuestion(state) {
  return {
    pulse: state.pulse,
    half_width: toSI("width", state.width, 0.5),
    half_height: toSI("height", state.height, 0.5),
    peak_acceleration: toSI("acceleration", state.acceleration),
    pulse_period: toSI("period", state.period),
    restitution: readable(state.restitution) ? state.restitution : "nan", // the service then tells the range
  };
}

function readable(restitution) {
  return restitution === "housner" || Number.isFinite(Number.parseFloat(restitution));
}

/** What to write into the state to see a point: of a block, the ground motion that puts it there. */
export function movedTo(state, situation, { frequency_ratio, slenderness }) {
  if (!situation.size) return { frequency_ratio, slenderness };
  const { p, uplift_in_g } = situation.size;
  return {
    acceleration: inUnitOf("acceleration", state.acceleration, (uplift_in_g * GRAVITY) / slenderness), // a_g = g tan(alpha)/s
    period: inUnitOf("period", state.period, (2 * Math.PI) / (p * frequency_ratio)), // omega = omega_g/p
  };
}

/** Numbers for drawing; what is none stays as it is, for the service to refuse. */
function numbers(point) {
  const read = Object.entries(point).map(([name, text]) => [name, Number.isFinite(Number(text)) ? Number(text) : text]);
  return Object.fromEntries(read);
}
