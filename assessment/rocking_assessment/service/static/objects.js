// The page of objects: sends its form and a dropped file to the service, which renders the result; sorts and filters it.

import { page, Problem } from "/static/explorer/api.js";
import { onDrop } from "/static/explorer/drop.js";
import { length } from "/static/explorer/labels.js";
import { showLines } from "/static/explorer/lines.js";
import { clearErrors, element, inTermsOf, markField, setStatus } from "/static/explorer/page.js";
import { pane } from "/static/explorer/pane.js";
import { onChange } from "/static/explorer/state.js";
import { commandOf, remember, restore, wireCopy } from "/static/explorer/stated.js";

import { fillColumns, statedColumns, usesOf } from "./columns.js";

const STEP = 100; // objects that are shown at first, and more with each press of the button
const LAYOUT = ["columns", "decimal", "delimiter", "skip", "encoding", "sheet", "allow_unusual"];
const SITE = ["pga", "pga_unit", "pgv", "pgv_unit", "period_min", "period_max", "floor_periods", "floor_participation"];

const form = document.getElementById("objects");
const file = document.getElementById("file");
const status = document.getElementById("status");
const title = document.title;

let control = new AbortController();
let chosen = null; // the file of the table; null: the example, or text that was typed
let edits = 0; // changes of the table and of its layout; the last one counts
let held = null; // what the table holds

const preview = pane({
  box: document.getElementById("preview"),
  status: document.getElementById("preview-status"),
  doing: "Reading the table …",
  draw: drawPreview,
  clear: () => {},
});

/** Show what the table holds and what would be read of it; resolves to that, or to null. */
async function look() {
  clearErrors();
  remember(form, [...LAYOUT, ...SITE]);
  if (!form.elements.table.value.trim()) return null;
  const own = edits;
  const key = JSON.stringify([own, ...SITE.map((name) => form.elements[name].value)]); // the command has the site
  const found = await preview.show(key, async function* load(signal) {
    yield JSON.parse(await page("/objects/preview", new URLSearchParams(new FormData(form)), signal));
  });
  if (own !== edits) return null;
  if (found) mark(found);
  return found;
}

/** The table or its layout is another one: its result is not shown any more. */
function changed() {
  control.abort();
  edits += 1;
  setStatus(status, "");
  document.getElementById("result").classList.add("stale");
  return look();
}

function drawPreview(found) {
  held = found;
  const text = form.elements.columns.value;
  fillColumns(found, text);
  document.getElementById("preview-title").textContent = `${chosen?.name ?? "The table"}: the first lines`;
  showLines(document.getElementById("lines"), found.lines, found.names_line, usesOf(found, text));
  const unread = found.bad_rows ? `, ${found.bad_rows} not` : "";
  const [caption, list] = ["preview-caption", "preview-list"].map((id) => document.getElementById(id));
  caption.textContent = found.problem ? "" : `${found.objects} row${found.objects === 1 ? "" : "s"} would be read${unread}.`;
  const kept = found.skipped.length && !found.problem ? [`Kept as they stand: ${found.skipped.join(", ")}`] : [];
  list.replaceChildren(...[...found.first.map(sentenceOf), ...found.reasons.map((reason) => inTermsOf(form, reason)), ...found.remarks, ...kept].map((line) => element("li", line)));
  document.getElementById("command").textContent = commandOf(found.command);
  const isOther = !["", "windows-1252"].includes(form.elements.encoding.value);
  document.getElementById("command-note").textContent = isOther ? "The command reads text in UTF-8: save the table in this encoding first." : "";
}

function sentenceOf({ name, bases, height }) {
  const sides = Object.entries(bases).map(([direction, base]) => `${direction === "any" ? "diameter" : direction} ${length(base)}`);
  return `${name}: ${sides.join(", ")}, height ${length(height)}`;
}

/** Mark what is missing, or say what is wrong; what is unusual is a question. */
function mark({ missing, problem, reasons }) {
  const asks = reasons.some((reason) => reason.includes("allow_unusual"));
  document.getElementById("unusual").hidden = !asks && !form.elements.allow_unusual.checked;
  for (const group of missing) {
    const [name] = group.split(" or ");
    markField(document.getElementById(`column-${name}-problem`), `The header does not say: choose ${group}.`);
  }
  if (!problem || missing.length) return;
  const start = problem.line === null ? "Found" : `Line ${problem.line}: found`;
  markField(document.getElementById("file-problem"), inTermsOf(form, `${start} ${problem.was}; expected ${problem.expected}`));
}

/** Assess what would be read; where something is not stated, go to its field. */
async function ask() {
  const found = await look();
  const wrong = document.querySelector("#your-table [aria-invalid]");
  if (wrong) wrong.focus();
  else if (found || !form.elements.table.value.trim()) show();
}

/** Show the page that the service makes of the form. */
async function show() {
  control.abort();
  control = new AbortController();
  const { signal } = control;
  const result = document.getElementById("result");
  clearErrors();
  result.classList.add("stale");
  result.setAttribute("aria-busy", "true");
  setStatus(status, "Computing …");
  const started = performance.now();
  const timer = setInterval(() => setStatus(status, `Computing … ${Math.round((performance.now() - started) / 1000)} s`), 1000);
  try {
    const text = await page("/objects", new URLSearchParams(new FormData(form)), signal);
    const found = new DOMParser().parseFromString(text, "text/html");
    mend(found.getElementById("table").value);
    result.replaceWith(found.getElementById("result"));
    setStatus(status, "");
    wireResult();
  } catch (problem) {
    if (!signal.aborted) setStatus(status, problem, show);
  } finally {
    clearInterval(timer);
  }
}

/** The table with the cells that were corrected in its result. */
function mend(text) {
  if (text === form.elements.table.value) return;
  form.elements.table.value = text;
  edits += 1;
  look();
}

/** Take the table of a file; it is assessed when its reading has been looked at. */
async function take(next) {
  chosen = next;
  form.elements.table_name.value = chosen.name;
  document.getElementById("dropped").textContent = `${chosen.name}; drop another one anywhere on this page`;
  document.getElementById("result").replaceChildren(); // that of another table, with the rows that are corrected
  await read();
}

/** Read the file that was chosen, as its encoding, its sheet and the decimal sign say. */
async function read() {
  control.abort();
  control = new AbortController();
  clearErrors();
  remember(form, [...LAYOUT, ...SITE]);
  setStatus(status, `Reading ${chosen.name} …`);
  const own = chosen;
  try {
    const text = isWorkbook() ? await sheetText() : await decoded();
    if (own !== chosen) return;
    form.elements.table.value = text;
    document.title = `${chosen.name}: ${title}`;
    setStatus(status, "");
    const found = await changed();
    if (found && !found.problem) setStatus(status, "Look at the table, then press “Which overturn?”.");
  } catch (problem) {
    form.elements.table.value = "";
    preview.nothing();
    if (problem instanceof Problem && problem.parameter === "encoding") markField(document.getElementById("encoding-problem"), problem.message);
    else setStatus(status, problem, read);
  }
}

function isWorkbook() {
  return /\.(xlsx|ods)$/i.test(chosen.name);
}

function sheetText() {
  const stated = new URLSearchParams({ name: chosen.name, sheet: form.elements.sheet.value.trim(), decimal: form.elements.decimal.value });
  return page(`/objects/text?${stated}`, chosen, control.signal);
}

/** The text of the file: UTF-16 by its mark, else UTF-8, else as stated. */
async function decoded() {
  const content = new Uint8Array(await chosen.arrayBuffer());
  const mark = content[0] + 256 * content[1];
  const marked = { 0xfeff: "utf-16le", 0xfffe: "utf-16be" }[mark];
  if (!marked && content.includes(0)) {
    throw new Problem({ parameter: "table", value: "binary content", allowed: "text, or a workbook whose name ends in .xlsx or .ods" });
  }
  const stated = form.elements.encoding.value;
  try {
    return new TextDecoder(marked ?? (stated || "utf-8"), { fatal: true }).decode(content);
  } catch {
    throw new Problem({ parameter: "encoding", detail: stated ? "The text is not in this encoding: choose another one." : "The text is not in UTF-8: choose its encoding." });
  }
}

function clear() {
  for (const name of LAYOUT) {
    const field = form.elements[name];
    if (field.type === "checkbox") field.checked = false;
    else field.value = "";
  }
  if (chosen) read();
  else changed();
}

/** Filter, sort and show by steps the rows of the result. */
function wireResult() {
  const table = document.getElementById("ranking");
  if (!table) return;
  const body = table.tBodies[0];
  const rows = [...body.rows].map((row) => ({ row, text: row.textContent.toLowerCase(), verdict: row.dataset.verdict }));
  const filter = document.getElementById("filter");
  const verdict = document.getElementById("verdict");
  const more = document.getElementById("more");
  let shown = STEP;
  const draw = () => {
    const words = filter.value.trim().toLowerCase();
    const kept = rows.filter((one) => one.text.includes(words) && (!verdict.value || one.verdict === verdict.value));
    body.replaceChildren(...kept.slice(0, shown).map(({ row }) => row));
    more.hidden = kept.length <= shown;
    document.getElementById("count").textContent = `${Math.min(kept.length, shown)} of ${rows.length} objects`;
  };
  const restart = () => {
    shown = STEP;
    draw();
  };
  for (const head of table.tHead.rows[0].cells) head.querySelector("button")?.addEventListener("click", () => sort(rows, head, draw));
  filter.addEventListener("input", restart);
  verdict.addEventListener("change", restart);
  more.addEventListener("click", () => {
    shown += STEP;
    draw();
  });
  draw();
}

/** Sort by a column, and the other way at the second press. */
function sort(rows, head, draw) {
  const way = head.getAttribute("aria-sort") === "ascending" ? -1 : 1;
  for (const other of head.parentElement.cells) other.removeAttribute("aria-sort");
  head.setAttribute("aria-sort", way > 0 ? "ascending" : "descending");
  const valueOf = ({ row }) => row.cells[head.cellIndex].dataset.value ?? row.cells[head.cellIndex].textContent;
  const { compare } = new Intl.Collator("en", { numeric: true });
  const number = (one) => Number(valueOf(one));
  const numeric = rows.length && rows[0].row.cells[head.cellIndex].dataset.value !== undefined;
  rows.sort((one, other) => way * (numeric ? number(one) - number(other) : compare(valueOf(one), valueOf(other))));
  draw();
}

form.addEventListener("submit", (event) => {
  if (event.submitter?.dataset.told) {
    setStatus(status, event.submitter.dataset.told);
    return;
  }
  event.preventDefault();
  ask();
});
document.getElementById("your-table").addEventListener("change", ({ target }) => {
  const { column, unit } = target.dataset;
  if (column || unit) form.elements.columns.value = statedColumns(held, target);
  const isOfFile = target.name === "encoding" || ["sheet", "decimal"].includes(target.name) && chosen && isWorkbook();
  if (target === file) {
    if (file.files[0]) take(file.files[0]);
  } else if (chosen && isOfFile) read();
  else changed();
});
form.addEventListener("change", look);
document.getElementById("clear").addEventListener("click", clear);
wireCopy(document.getElementById("copy-command"), document.getElementById("command"), document.getElementById("copied"));
onDrop(take);
onChange(look);
restore(form, SITE);
if (restore(form, LAYOUT)) {
  form.elements.table.value = "";
  setStatus(document.getElementById("preview-status"), "The address says how a table is read: choose the file.");
} else ask();
