// Sections of reports: text, terms, lists; what every report says of the block, the model and the warnings.

import { length, number } from "./labels.js";
import { element, facts } from "./page.js";

/** A section of a report: `heading`, and `pairs`, `lines` or `text`. */
export function section({ heading, pairs, lines, text }) {
  const parts = [element("h2", heading)];
  if (text) parts.push(element("p", text));
  if (pairs) parts.push(facts(pairs));
  if (lines) parts.push(element("ul", lines.map((line) => element("li", line))));
  return element("section", parts);
}

/** Size and shape of the block of a response in SI units: pairs of term and value. */
export function geometryOf(found) {
  return [
    ["Width of the base", length(found.query.width)],
    ["Height", length(found.query.height)],
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
