// A calculation report: sections of text, terms and lists, to print or to save as PDF from the browser.

import { length, number } from "./labels.js";
import { element, facts } from "./page.js";

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

/** A section of a report: `heading`, and `pairs`, `lines` or `text`. */
export function section({ heading, pairs, lines, text }) {
  const parts = [element("h2", heading)];
  if (text) parts.push(element("p", text));
  if (pairs) parts.push(facts(pairs));
  if (lines) parts.push(element("ul", lines.map((line) => element("li", line))));
  return element("section", parts);
}

function figure([canvas, words]) {
  const copy = element("canvas", "", { width: canvas.width, height: canvas.height, role: "img", "aria-label": words });
  copy.getContext("2d").drawImage(canvas, 0, 0);
  return element("figure", [copy, element("figcaption", words)]);
}

/** Size and shape of the block of a response in SI units: pairs of term and value. */
export function geometryOf(found) {
  return [
    ["Width of the base", length(2 * found.query.half_width)],
    ["Height", length(2 * found.query.half_height)],
    ["Half diagonal R", length(found.half_diagonal)],
    ["Slenderness angle α", `${number(found.alpha_deg, 4)}°`],
    ["Frequency parameter p", `${number(found.frequency_parameter, 4)} rad/s`],
  ];
}

/** Sections that every report has: model, equations, assumptions, limits of use. */
export function modelSections({ metadata, version }) {
  return [
    { heading: "Model", text: `${metadata.model[0].toUpperCase()}${metadata.model.slice(1)}. ${metadata.reference}.` },
    { heading: "Equations", pairs: metadata.equations.map(({ number, formula, meaning }) => [`(${number}) ${meaning}`, formula]) },
    { heading: "Assumptions", lines: metadata.assumptions },
    { heading: "Limits of use", text: metadata.disclaimer },
    { heading: "Program", text: `rocking ${version}` },
  ];
}

/** The section of warnings. */
export function warningSection(warnings) {
  return warnings.length ? { heading: "Warnings", lines: warnings } : { heading: "Warnings", text: "None." };
}
