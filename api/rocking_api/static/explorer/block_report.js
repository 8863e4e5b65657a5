// The calculation report of a block under a pulse.

import { canvasOf } from "./chart.js";
import { acceleration, length, number, pulseName, threshold, thresholds } from "./labels.js";
import { geometryOf, modelSections, warningSection } from "./report_sections.js";

/** The report of a response of /v1/blocks/response. */
export function blockReport(found) {
  const { query } = found;
  const friction = found.friction_demand;
  return {
    title: "Rocking of a free-standing block under a pulse",
    sections: [
      {
        heading: "Block",
        pairs: [
          ...geometryOf(found),
          ["Uplifts at", acceleration(found.uplift_acceleration)],
          ["Coefficient of restitution", `${number(found.restitution, 4)}${query.restitution === "momentum" ? ", from geometry (2.4)" : ", given"}`],
          ["Friction coefficient required to prevent sliding", friction === null ? "it lifts off" : number(friction, 3)],
        ],
      },
      {
        heading: "Ground motion",
        pairs: [
          ["Shape", pulseName(query.pulse)],
          ["Peak acceleration", acceleration(query.peak_acceleration)],
          ["Period T of the pulse", `${number(query.period, 5)} s`],
        ],
      },
      { heading: "Result", text: resultOf(found) },
      { heading: "Margins", lines: marginsOf(found) },
      warningSection(found.warnings),
      ...modelSections(found),
      { heading: "To repeat it", lines: [location.href, ...(found.url ? [`${location.origin}${found.url}`] : [])] },
    ],
    pictures: [
      [canvasOf(document.getElementById("rotation")), "Rotation [°] against time [s]"],
      [canvasOf(document.getElementById("acceleration-chart")), "Ground acceleration [g] against time [s]"],
    ],
  };
}

function resultOf(found) {
  const { outcome, impacts, error_bound: error, peak_rotation: peak } = found.response;
  const opening = `Outcome: ${found.meaning}.`;
  if (peak === null) return `${opening} Impacts before: ${impacts}.`;
  if (outcome === "NO_UPLIFT") return opening;
  const bound = error === null ? "" : `, error at most ${number(error, 1)} α`;
  const top = `displacement of the top ${length(found.displacement)}`;
  return `${opening} Peak rotation ${number(found.peak_rotation_deg, 4)}° = ${number(peak, 4)} α${bound}; ${top}.`;
}

function marginsOf({ query, overturned, thresholds: found, margins, largest_surviving_acceleration: largest }) {
  const lines = [];
  if (largest !== null) lines.push(`At this period the block does not overturn below ${acceleration(largest, threshold)}.`);
  const all = found ?? [];
  const texts = thresholds(all.map((one) => [one.peak_acceleration, one.overturns_above]), 4);
  all.forEach((one, at) => lines.push(`It ${one.overturns_above ? "overturns" : "survives"} from ${texts[at]} m/s² at this period.`));
  const period = margins?.nearest_period;
  const survivalFrom = margins?.surviving_from_half_diagonal;
  if (period) lines.push(`The nearest period at which the outcome changes: ${threshold(period, period > query.period !== overturned, 4)} s.`);
  if (survivalFrom) lines.push(`Blocks of this shape survive from R = ${length(survivalFrom, (value, digits) => threshold(value, false, digits))}.`);
  return lines.length ? lines : ["None were found."];
}
