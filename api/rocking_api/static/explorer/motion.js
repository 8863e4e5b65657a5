// The time history of the chosen block: its request, and its view.

import { ask, urlOf } from "./api.js";
import { chartsReady } from "./chart.js";
import { setLinks } from "./downloads.js";
import { drawMotion } from "./motion_charts.js";
import { pane } from "./pane.js";
import { unload } from "./player.js";
import { validityNote } from "./scenario.js";

const LONGEST = 16; // times the duration of the service for which the motion is followed to rest

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
export async function showMotion(scenario, idle) {
  setLinks("motion", {});
  if (!scenario) return motion.wait({ idle });
  section.classList.toggle("empty", !scenario.point);
  if (!scenario.point) return motion.nothing();
  current = scenario;
  const params = motionParams(scenario);
  const found = await motion.show(JSON.stringify([params, scenario.size]), (signal) => untilRest(params, signal));
  const url = (format) => urlOf("/v1/history", { ...found.query, pulse: params.pulse, format }); // of what is shown, which lasts until rest
  if (found) setLinks("motion", { csv: url("csv"), nc: url("nc") });
  return found;
}

/** The history of a block until it is at rest; how long that takes is asked for first, with few samples. */
async function* untilRest(params, signal) {
  await chartsReady();
  let probe = await ask("/v1/history", { ...params, samples: 2 }, signal);
  for (let times = 2; times <= LONGEST && isMoving(probe); times *= 2) {
    probe = await ask("/v1/history", { ...params, samples: 2, duration: 2 * probe.tau.at(-1) }, signal);
  }
  if (probe.outcome !== "RECOVERS" || isMoving(probe)) {
    yield await ask("/v1/history", params, signal);
    return;
  }
  const quiet = Math.max(probe.impact_time.at(-1) ?? 0, probe.tau[probe.ground_acceleration.findLastIndex((u) => u !== 0)] ?? 0);
  yield await ask("/v1/history", { ...params, duration: Math.max(1.02 * quiet, quiet + 0.5) }, signal);
}

function isMoving({ outcome, rotation }) {
  return outcome === "RECOVERS" && rotation.at(-1) !== 0;
}

function motionParams({ pulse, restitution, alpha_deg, point }) {
  return { pulse, restitution, alpha_deg, ...point, samples: 800 };
}
