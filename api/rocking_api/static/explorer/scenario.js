// The scenario that all views show: dimensionless groups from the address, or those of a block in metres.
// It holds pulse, restitution, alpha_deg and point (or null); for a block also its size and the response of the service.

import { nearestChange } from "./block_answer.js";
import { DEFAULTS } from "./state.js";
import { inUnit, toSI } from "./units.js";

/** The scenario of a state in groups. */
export function scenarioOf({ pulse, restitution, alpha_deg, frequency_ratio, slenderness }) {
  const chosen = frequency_ratio !== "" && slenderness !== "";
  const point = chosen ? numbers({ frequency_ratio, slenderness }) : null;
  return { pulse, restitution, alpha_deg, point, size: null, answer: null };
}

/** The scenario of a block for which the request failed: its pulse, and no point. */
export function scenarioWithoutResponse({ pulse }) {
  return scenarioOf({ ...DEFAULTS, pulse });
}

/** The scenario of a block, from the response of /v1/blocks/response. */
export function scenarioOfBlock(answer) {
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
      uplift: answer.uplift_acceleration,
    },
    change: answer.uplift_acceleration / nearestChange(answer), // slenderness of it, nan without one
    answer,
  };
}

/** Note beside the motion of a block that would slide or lift off; empty where the rocking model applies. */
export function validityNote({ answer }) {
  return answer && !answer.rocking_model_applies ? "The rocking model does not apply; held in place:" : "";
}

/** Parameters of /v1/blocks/response, in SI units. */
export function blockParams(state) {
  return {
    pulse: state.pulse,
    width: toSI("width", state.width),
    height: toSI("height", state.height),
    peak_acceleration: toSI("acceleration", state.acceleration),
    period: state.period === "" ? "" : toSI("period", state.period),
    restitution: readable(state.restitution) ? state.restitution : "nan", // the service then refuses it and names the range
  };
}

/** These parameters in a query, where the unit says that the acceleration is not meant in g. */
export function blockQuery(params) {
  const { peak_acceleration: peak } = params;
  return { ...params, peak_acceleration: typeof peak === "number" ? `${peak} m/s2` : peak };
}

function readable(restitution) {
  return restitution === "momentum" || Number.isFinite(Number.parseFloat(restitution));
}

/** The parts of a state that show a point: for a block, the ground motion with these groups. */
export function movedTo(state, scenario, { frequency_ratio, slenderness }) {
  if (!scenario.size) return { frequency_ratio, slenderness };
  const { p, uplift } = scenario.size;
  return {
    acceleration: inUnit("acceleration", (uplift) / slenderness), // a_g = g tan(alpha)/s
    period: inUnit("period", (2 * Math.PI) / (p * frequency_ratio)), // omega = omega_g/p
  };
}

/** Numbers for drawing; other text is passed on, for the service to refuse. */
function numbers(point) {
  const read = Object.entries(point).map(([name, text]) => [name, Number.isFinite(Number(text)) ? Number(text) : text]);
  return Object.fromEntries(read);
}
