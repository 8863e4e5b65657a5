// A calculation report: sections of text, terms and lists, to print or to save as PDF from the browser.

import { element } from "./page.js";
import { section } from "./report_sections.js";

const report = document.getElementById("report");

/**
 * Show a report in place of the page: `title`; `sections`, each with `heading` and `pairs`, `lines` or `text`; `pictures`,
 * canvases of the page with their captions.
 */
export function showReport({ title, sections, pictures = [] }) {
  const print = element("button", "Print, or save as PDF", { type: "button", class: "main" });
  const back = element("button", "Back", { type: "button" });
  print.addEventListener("click", () => window.print());
  back.addEventListener("click", hide);
  report.replaceChildren(
    element("p", [print, back], { class: "tools" }),
    element("h1", title),
    ...sections.map(section),
    ...pictures.filter(([canvas]) => canvas?.width).map(figure),
    element("p", `Made on ${new Date().toISOString().slice(0, 16).replace("T", " ")} UTC.`, { class: "small" }),
  );
  report.hidden = false;
  document.body.classList.add("reporting");
  scrollTo(0, 0);
  report.querySelector("button").focus();
}

function hide() {
  report.hidden = true;
  document.body.classList.remove("reporting");
}

function figure([canvas, words]) {
  const copy = element("canvas", "", { width: canvas.width, height: canvas.height, role: "img", "aria-label": words });
  copy.getContext("2d").drawImage(canvas, 0, 0);
  return element("figure", [copy, element("figcaption", words)]);
}
