// Status lines, field errors and elements, shared by all parts of the page.

/** Set a status line to a text, or to an Error with a button that calls `again`. */
export function setStatus(place, what, again) {
  const wrong = what instanceof Error;
  place.classList.toggle("wrong", wrong);
  if (!wrong) place.textContent = what;
  else if (showFieldError(what, place.closest("form") ?? document.getElementById("controls"))) {
    place.textContent = "No answer: see the field marked in red.";
  } else {
    const button = element("button", "Try again", { type: "button" });
    button.addEventListener("click", again);
    place.replaceChildren(`No answer: ${what.message}. `, button);
  }
}

/** An element with text or children in it. */
export function element(tag, content = "", attributes = {}) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...[content].flat());
  return made;
}

/** Show an error beside the field of a form that it names; returns whether there is one. */
function showFieldError({ parameter, value, allowed }, form) {
  const place = form.querySelector(`[data-problem="${CSS.escape(parameter ?? "")}"]`);
  if (!place) return false;
  const name = parameter.replaceAll("_", " ");
  place.textContent = value === undefined ? `${name} is missing` : `${name} is ${value}; allowed: ${allowed}`;
  const field = document.getElementById(place.dataset.field);
  field.setAttribute("aria-invalid", "true");
  field.setAttribute("aria-describedby", place.id);
  return true;
}

/** Clear all field errors. */
export function clearErrors() {
  for (const place of document.querySelectorAll("[data-problem]")) {
    place.textContent = "";
    const field = document.getElementById(place.dataset.field);
    field.removeAttribute("aria-invalid");
    field.removeAttribute("aria-describedby");
  }
}
