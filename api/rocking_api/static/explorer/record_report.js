// The calculation report of a block under a record.

import { canvasOf } from "./chart.js";
import { length, number } from "./labels.js";
import { doubtOf, marginOf, ofBlock, ofRecord, verdict } from "./record_answer.js";
import { geometryOf, modelSections, warningSection } from "./report_sections.js";

/** The report of a response of /v1/records/response; `changes` says at which factors the outcome changes. */
export function recordReport(found, changes) {
  const { query, record } = found;
  return {
    title: "Rocking of a free-standing block under a record",
    sections: [
      {
        heading: "Block",
        pairs: [
          ...geometryOf(found),
          ...ofBlock(found),
        ],
      },
      {
        heading: "Ground motion",
        pairs: [
          ["Record", record.source],
          ["Factor", number(query.scale, 6)],
          ...ofRecord(record, query.scale),
          ["Baseline correction", query.baseline_order === null ? "none" : `polynomial of degree ${query.baseline_order}`],
          ["sha256 of step and samples", record.digest],
        ],
      },
      { heading: "Result", text: `${verdict(found)} ${resultOf(found)}` },
      { heading: "Margins", text: `${marginOf(found)} ${changes}`.trim() },
      warningSection(found.warnings),
      ...modelSections(found),
      { heading: "To repeat it", text: `POST the file to ${location.origin}/v1/records/response?${new URLSearchParams(given(query))}` },
    ],
    pictures: [
      [canvasOf(document.getElementById("rotation")), "Rotation [°] against time [s]"],
      [canvasOf(document.getElementById("acceleration-chart")), "Ground acceleration [g] against time [s]"],
      [canvasOf(document.getElementById("scales-chart")), "Peak rotation θ/α against the factor of the record; hatched: overturns"],
    ],
  };
}

function resultOf(found) {
  if (found.peak_rotation === null) return `Outcome: ${found.meaning}; ${found.impacts} impacts before.`;
  const top = `displacement of the top ${length(found.displacement)}`;
  return `Outcome: ${found.meaning}. Peak rotation ${number(found.peak_rotation_deg, 4)}° = ${number(found.peak_rotation, 4)} α, ${top}, ${found.impacts} impacts while the ground moves.${doubtOf(found)}`;
}

function given(query) {
  return Object.entries(query).filter(([, value]) => value !== null);
}
