// Errors of a form, all at once and in the words of its labels, before anything is requested.

import { clearErrors, markField } from "./page.js";

/**
 * Check that the named fields hold numbers: positive ones, or from 0 to 1 for `eta`. Marks all that do not and focuses the
 * first; returns whether there is none.
 */
export function showErrors(form, names) {
  clearErrors();
  const wrong = names
    .map((name) => [form.elements[name], problemOf(name, form.elements[name].value.trim())])
    .filter(([, problem]) => problem)
    .map(([field, problem]) => markField(form.querySelector(`[data-field="${field.id}"]`), `${labelOf(field)} ${problem}`));
  wrong[0]?.focus();
  return wrong.length === 0;
}

function problemOf(name, text) {
  if (text === "") return "is missing.";
  const value = Number(text.replace(",", "."));
  if (Number.isNaN(value)) return `is “${text}”; allowed: a number.`;
  if (name === "eta") return value >= 0 && value <= 1 ? "" : `is ${text}; allowed: 0 to 1.`;
  return value > 0 && value < Infinity ? "" : `is ${text}; allowed: a number above 0.`;
}

function labelOf(field) {
  return field.getAttribute("aria-label") ?? field.labels[0].textContent;
}
