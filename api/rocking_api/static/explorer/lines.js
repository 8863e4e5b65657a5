// The first lines of a file as a table: the number of each line, its cells, and what is read from which column.

import { element } from "./page.js";

/**
 * Fill a table with lines, each with its number, text and cells; `names` is the number of the line of names, and `uses` says
 * what is read from a column, by its number from 1.
 */
export function showLines(table, lines, names, uses) {
  const width = Math.max(1, ...lines.map(({ cells }) => cells.length));
  const heads = Array.from({ length: width }, (_, at) => headOf(at + 1, uses));
  const rows = [];
  let last = 0;
  for (const line of lines) {
    if (line.number > last + 1) rows.push(element("tr", [element("th", "…", { scope: "row" }), element("td", "", { colspan: width })]));
    rows.push(rowOf(line, width, line.number === names, uses));
    last = line.number;
  }
  const head = lines.some(({ cells }) => cells.length) ? [element("thead", element("tr", [element("th", "Line", { scope: "col" }), ...heads]))] : [];
  table.replaceChildren(...head, element("tbody", rows));
}

function headOf(number, uses) {
  const use = uses.get(number);
  return element("th", use ? `${number}: ${use}` : String(number), { scope: "col", ...(use && { class: "used" }) });
}

function rowOf({ number, text, cells }, width, isNames, uses) {
  const head = element("th", String(number), { scope: "row" });
  if (!cells.length) return element("tr", [head, element("td", text, { colspan: width, class: "passed", dir: "auto" })]);
  const made = Array.from({ length: width }, (_, at) => {
    const attributes = uses.has(at + 1) ? { class: "used" } : {};
    return element("td", cells[at] ?? "", { ...attributes, dir: "auto" });
  });
  return element("tr", [head, ...made], isNames ? { class: "names" } : {});
}
