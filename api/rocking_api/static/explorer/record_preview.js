// What a file of a record holds, and the record that would be read from it: lists of columns, first lines, a plot.

import { axis, chart } from "./chart.js";
import { themed } from "./colours.js";
import { acceleration, number } from "./labels.js";
import { showLines } from "./lines.js";
import { inTermsOf, markField } from "./page.js";
import { fillList } from "./stated.js";

const G = 9.80665; // [m/s2]
const LATIN = "The text is not in UTF-8 and is read as Latin-1: numbers are right, names may look wrong. Save the file in UTF-8 to see them.";

/** Show the response of /v1/records/preview: fill the lists of a form, and draw. */
export function drawPreview(found, form, name) {
  fillLists(found, form);
  document.getElementById("preview-title").textContent = titleOf(found, name);
  showLines(document.getElementById("lines"), found.lines, found.names_line, usesOf(found));
  const place = document.getElementById("preview-chart");
  place.hidden = !found.record;
  if (found.record) drawRecord(place, found);
  document.getElementById("preview-caption").textContent = found.record ? captionOf(found.record) : "";
}

/** Mark what is missing, or say what is wrong; what is unusual is a question. */
export function markMissing({ missing, problem }, form) {
  const asks = problem !== null && problem.expected.includes("allow_unusual");
  document.getElementById("unusual").hidden = !asks && !form.elements.allow_unusual.checked;
  for (const name of missing) markField(document.querySelector(`[data-problem=${name}]`), "The file does not say: choose it.");
  if (missing.includes("time")) markField(document.querySelector("[data-problem=time_step]"), "Or state this.");
  if (!problem || missing.length) return;
  const start = problem.line === null ? "Found" : `Line ${problem.line}: found`;
  const words = inTermsOf(form, `${start} ${problem.was}; expected ${problem.expected}`);
  markField(document.getElementById(asks ? "allow_unusual-problem" : "file-problem"), words);
}

function titleOf({ file_format: format, encoding }, name) {
  const read = format === null ? "a format that is not read" : format === "columns" ? "columns" : `the format ${format}`;
  return `${name}: ${read}. ${encoding === "Latin-1" ? LATIN : ""}`;
}

/** The columns of the file in each list; the first entry says what the file itself states. */
function fillLists({ file_format: format, columns, in_file: inFile, encoding, missing }, form) {
  const unique = (name) => columns.indexOf(name) === columns.lastIndexOf(name);
  const valueAt = (name, at) => (name && name.length <= 200 && unique(name) && encoding !== "Latin-1" ? name : String(at + 1));
  const pairs = columns.map((name, at) => [valueAt(name, at), name ? `${at + 1}: ${name}` : `column ${at + 1}`]);
  const rest = format === "columns" ? "none" : "as the file says";
  const unstated = (names) => (names.some((name) => missing.includes(name)) ? "– choose –" : rest);
  const asNamed = (column, name) => (column === null ? unstated([name]) : `as named: ${columns[column - 1]}`);
  fillList(form.elements.acceleration, asNamed(inFile.acceleration, "acceleration"), pairs);
  fillList(form.elements.time, asNamed(inFile.time, "time"), pairs);
  for (const name of ["second", "vertical"]) fillList(form.elements[name], "none", pairs);
  form.elements.unit.options[0].text = inFile.unit ? `${inFile.unit}, as the file says` : unstated(["unit"]);
  form.elements.time_unit.options[0].text = inFile.time_unit ? `${inFile.time_unit}, as the file says` : unstated(["time", "time_unit"]);
}

/** What is read from which column. */
function usesOf({ chosen }) {
  const uses = new Map();
  if (chosen.time) uses.set(chosen.time, `time${chosen.time_unit ? ` [${chosen.time_unit}]` : ""}`);
  if (chosen.acceleration) uses.set(chosen.acceleration, `acceleration${chosen.unit ? ` [${chosen.unit}]` : ""}`);
  return uses;
}

function drawRecord(place, { time, acceleration: values }) {
  chart(
    place,
    {
      height: 180,
      series: [{}, { stroke: () => themed("accent"), width: 1, pxAlign: 0 }],
      axes: [axis("time t [s]", { size: 30 }), axis("ground [g]")],
      scales: { x: { time: false } },
    },
    [time, values.map((value) => value / G)],
  );
}

function captionOf(record) {
  const duration = (record.samples - 1) * record.time_step;
  const vertical = record.peak_vertical_acceleration === null ? "" : ` Vertical: ${acceleration(record.peak_vertical_acceleration)}.`;
  const remarks = record.remarks.map((remark) => ` Remark: ${remark}.`).join("");
  return `Peak ground acceleration ${acceleration(record.peak_acceleration)}, duration ${number(duration)} s: ${record.samples} samples, ${number(record.time_step, 4)} s apart.${vertical}${remarks}`;
}
