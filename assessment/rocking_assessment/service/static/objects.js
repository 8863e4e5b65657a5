// The page of objects: sends its form and a dropped file to the service, which renders the result; sorts and filters it.

import { page } from "/static/explorer/api.js";
import { onDrop } from "/static/explorer/drop.js";
import { clearErrors, setStatus } from "/static/explorer/page.js";

const STEP = 100; // objects that are shown at first, and more with each press of the button

const form = document.getElementById("objects");
const file = document.getElementById("file");
const status = document.getElementById("status");
const title = document.title;

let control = new AbortController();

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
    form.elements.table.value = found.getElementById("table").value;
    result.replaceWith(found.getElementById("result"));
    setStatus(status, "");
    wireResult();
  } catch (problem) {
    if (!signal.aborted) setStatus(status, problem, show);
  } finally {
    clearInterval(timer);
  }
}

/** Take the table of a file. */
async function take(chosen) {
  setStatus(status, `Reading ${chosen.name} …`);
  document.getElementById("result").replaceChildren(); // that of another table, with the rows that are corrected
  try {
    form.elements.table.value = await page(`/objects/text?name=${encodeURIComponent(chosen.name)}`, chosen, control.signal);
    document.title = `${chosen.name}: ${title}`;
    await show();
  } catch (problem) {
    setStatus(status, problem, () => take(chosen));
  }
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
  show();
});
file.addEventListener("change", () => file.files[0] && take(file.files[0]));
onDrop(take);
if (form.elements.table.value) show();
