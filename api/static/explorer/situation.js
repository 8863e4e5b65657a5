// What is looked at: the groups in the address, or those of a block in metres, which the service works out.

import { ask } from "./api.js";
import { isBlock } from "./state.js";
import { inUnitOf, toSI } from "./units.js";

const GRAVITY = 9.80665; // [m/s2], the service's own unless it is told otherwise

/**
 * The situation of a state: pulse, restitution, alpha_deg, point (or null); of a block also its size and its answer.
 * Null if a newer block was asked about meanwhile. Throws Problem.
 */
export async function situationOf(state) {
  if (!isBlock(state)) return { ...groupsOf(state), size: null, answer: null };
  const answer = await ask("block", "/v1/blocks/response", blockQuestion(state));
  if (!answer) return null;
  const { slenderness, frequency_ratio } = answer.response.query;
  return {
    pulse: state.pulse,
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

function groupsOf({ pulse, restitution, alpha_deg, frequency_ratio, slenderness }) {
  const chosen = frequency_ratio !== "" && slenderness !== "";
  return { pulse, restitution, alpha_deg, point: chosen ? numbers({ frequency_ratio, slenderness }) : null };
}

/** Numbers for drawing; what is none stays as it is, for the service to refuse. */
function numbers(point) {
  const read = Object.entries(point).map(([name, text]) => [name, Number.isFinite(Number(text)) ? Number(text) : text]);
  return Object.fromEntries(read);
}
