// The time history of the chosen block: its request, and its view.

import { urlOf } from "./api.js";
import { drawMotion } from "./motion_charts.js";
import { once, pane } from "./pane.js";
import { unload } from "./player.js";
import { validityNote } from "./scenario.js";

const section = document.getElementById("motion");

let current = null; // the scenario
const motion = pane({
  box: section.querySelector(".motion"),
  status: document.getElementById("motion-status"),
  doing: "Computing the time history …",
  delay: 120,
  picture: "motion",
  draw: (history) => drawMotion(history, { ...current, note: validityNote(current) }),
  clear: unload,
});

/** Show the motion at the point of a scenario; nothing without a point; null: the scenario is unknown. */
export function showMotion(scenario, lasting) {
  if (!scenario) return motion.wait({ lasting });
  section.classList.toggle("empty", !scenario.point);
  if (!scenario.point) return motion.nothing();
  current = scenario;
  const params = motionParams(scenario);
  return motion.show(JSON.stringify([params, scenario.size]), once("/v1/history", params));
}

/** Parameters of the charts, for a download. */
export function motionParams({ pulse, restitution, alpha_deg, point }) {
  return { pulse, restitution, alpha_deg, ...point, samples: 800 };
}

/** The URL of the time history in a format. */
export function motionUrl(scenario, format) {
  return urlOf("/v1/history", { ...motionParams(scenario), format });
}
