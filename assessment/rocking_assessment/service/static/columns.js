// The lists of columns and units beside each quantity, and the argument `columns` that they state, one line a column.

import { fillList } from "/static/explorer/stated.js";

const lists = [...document.querySelectorAll("[data-column]")];
const NOT_MEASURED = "unused";

/** Fill the lists from a response of /objects/preview and from the text of the argument. */
export function fillColumns(found, text) {
  const stated = parsed(text);
  for (const list of lists) {
    const name = list.dataset.column;
    const own = stated.find((one) => one.name === name);
    const named = namedLabel(found, name, stated);
    const isMissing = found.missing.some((group) => group.split(" or ").includes(name));
    const pairs = found.labels.map((label, at) => [label, `${at + 1}: ${label}`]);
    if (name === "depth") pairs.push([NOT_MEASURED, "not measured"]);
    list.value = "";
    fillList(list, named ? `as named: ${named}` : isMissing ? "– choose –" : "none", pairs);
    list.value = own?.label ?? (name === "depth" && leavesDepth(found, stated) ? NOT_MEASURED : "");
    if (own && list.value !== own.label) {
      list.add(new Option(`${own.label} (not in this table)`, own.label));
      list.value = own.label;
    }
    fillUnit(name, found, own?.label ?? named, own?.unit ?? "");
  }
}

function fillUnit(name, found, label, unit) {
  const list = unitList(name);
  if (!list) return;
  const inHeader = found.units[label]?.[list.dataset.si];
  const [first] = list.options;
  first.text = inHeader ? `${inHeader}, as the header says` : label ? "in each cell" : "none";
  list.value = unit === inHeader ? "" : unit;
}

/** The argument that the lists state, after a change of `list`. */
export function statedColumns(found, list) {
  if (list.dataset.column) {
    const unit = unitList(list.dataset.column);
    if (unit) unit.value = ""; // that of another column
  }
  const lines = [];
  const used = new Set();
  for (const { value, dataset } of lists) {
    const name = dataset.column;
    const named = namedLabel(found, name, []);
    const label = value === NOT_MEASURED ? "" : value || named;
    const units = unitList(name);
    const inHeader = found.units[label]?.[units?.dataset.si];
    const unit = units?.value || inHeader;
    const isStated = label && (label !== named || (units?.value && units.value !== inHeader));
    if (isStated) lines.push(`${label}=${name}${unit ? ` [${unit}]` : ""}`);
    if (label) used.add(label);
  }
  const depth = lists.find(({ dataset }) => dataset.column === "depth");
  for (const label of found.labels) {
    const isNamed = label in found.named;
    const isLength = depth.value === NOT_MEASURED && found.units[label]?.m;
    if (!used.has(label) && (isNamed || isLength)) lines.push(`${label}=${NOT_MEASURED}`);
  }
  return lines.join("\n");
}

/** What is read from which column, by its number from 1. */
export function usesOf(found, text) {
  const stated = parsed(text);
  const uses = new Map();
  found.labels.forEach((label, at) => {
    const own = stated.find((one) => one.label === label);
    const name = own ? own.name : found.named[label];
    if (!name || name === NOT_MEASURED) return;
    const unit = own?.unit || found.units[label]?.[unitList(name)?.dataset.si];
    uses.set(at + 1, unit ? `${name} [${unit}]` : name);
  });
  return uses;
}

/** Label, name and unit of each line such as "Breite (cm)=width [cm]". */
function parsed(text) {
  return text.split("\n").filter(Boolean).map((line) => {
    const at = line.lastIndexOf("=");
    const header = line.slice(at + 1).trim();
    const open = header.indexOf("[");
    const name = (open < 0 ? header : header.slice(0, open)).trim();
    return { label: line.slice(0, at).trim(), name, unit: open < 0 ? "" : header.slice(open + 1).replace("]", "").trim() };
  });
}

/** The column whose own header is the name of a quantity, unless another meaning of it is stated. */
function namedLabel(found, name, stated) {
  return Object.keys(found.named).find((label) => found.named[label] === name && !stated.some((one) => one.label === label)) ?? "";
}

function leavesDepth(found, stated) {
  return stated.some(({ label, name }) => name === NOT_MEASURED && found.units[label]?.m && !stated.some((one) => one.name === "depth"));
}

function unitList(name) {
  return document.querySelector(`[data-unit="${name}"]`);
}
