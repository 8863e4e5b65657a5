// The page of the state of the service, requested again every ten seconds.

import { element, facts, setStatus } from "./page.js";

const EVERY = 10_000; // [ms]

const status = document.getElementById("status");
const box = document.getElementById("facts");
const problems = document.getElementById("problems");

async function show() {
  try {
    const found = await (await fetch("/health")).json();
    const names = Object.entries(found.problems);
    setStatus(status, found.status === "ok" ? "The service answers." : "The service answers; data sets have problems.");
    box.replaceChildren(facts([["Version", found.version], ["Data sets", found.datasets], ["Not yet checked", found.unchecked]]));
    problems.hidden = names.length === 0;
    problems.querySelector("ul").replaceChildren(...names.map(([name, words]) => element("li", `${name}: ${words}`)));
  } catch (error) {
    setStatus(status, new Error(`the service does not answer (${error.message})`), show);
  }
}

show();
setInterval(show, EVERY);
