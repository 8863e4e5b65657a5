// One object from a mesh: the file and the form go to the service, which renders the result.

import { page } from "/static/explorer/api.js";
import { onDrop } from "/static/explorer/drop.js";
import { clearErrors, markField, setStatus } from "/static/explorer/page.js";

const form = document.getElementById("object");
const file = document.getElementById("file");
const status = document.getElementById("status");

let control = new AbortController();

async function show() {
  const [chosen] = file.files;
  clearErrors();
  if (!chosen) {
    markField(document.getElementById("file-problem"), "Choose a file first.").focus();
    return;
  }
  control.abort();
  control = new AbortController();
  const { signal } = control;
  const result = document.getElementById("result");
  result.classList.add("stale");
  setStatus(status, `Reading ${chosen.name} …`);
  const fields = new URLSearchParams(new FormData(form));
  fields.set("file", chosen.name);
  try {
    const found = new DOMParser().parseFromString(await page(`/object?${fields}`, chosen, signal), "text/html");
    result.replaceWith(found.getElementById("result"));
    setStatus(status, "");
  } catch (problem) {
    if (!signal.aborted) setStatus(status, problem, show);
  }
}

form.addEventListener("submit", (event) => {
  event.preventDefault();
  show();
});
file.addEventListener("change", show);
onDrop(show);
