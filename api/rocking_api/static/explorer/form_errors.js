// Errors of a form, all at once and in the words of its labels, before anything is requested.

import { clearErrors, markField } from "./page.js";

/** Mark the named fields that hold no positive numbers; returns whether there is none. */
export function showErrors(form, names) {
  clearErrors();
  const wrong = problems(form, names);
  for (const [field, problem] of wrong) markField(form.querySelector(`[data-field="${field.id}"]`), `${labelOf(field)} ${problem}`);
  return wrong.length === 0;
}

/** The named fields that hold no positive numbers, and why. */
export function problems(form, names) {
  return names.map((name) => [form.elements[name], problemOf(form.elements[name].value.trim())]).filter(([, problem]) => problem);
}

function problemOf(text) {
  if (text === "") return "is missing.";
  const value = Number(text.replace(",", "."));
  if (Number.isNaN(value)) return `is “${text}”; allowed: a number.`;
  return value > 0 && value < Infinity ? "" : `is ${text}; allowed: a number above 0.`;
}

function labelOf(field) {
  return field.getAttribute("aria-label") ?? field.labels[0].textContent;
}
