// Small things that all parts of the page share.

/** Say a sentence, or what went wrong (an Error) with a way to try `again`, where people and screen readers find it. */
export function say(place, what, again) {
  const wrong = what instanceof Error;
  place.classList.toggle("wrong", wrong);
  if (!wrong) place.textContent = what;
  else if (blame(what, place.closest("form") ?? document.getElementById("controls"))) {
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

/** Say what is wrong beside the field of a form that the problem names; whether there is one. */
function blame({ parameter, value, allowed }, form) {
  const place = form.querySelector(`[data-problem="${CSS.escape(parameter ?? "")}"]`);
  if (!place) return false;
  const name = parameter.replaceAll("_", " ");
  place.textContent = value === undefined ? `${name} is missing` : `${name} is ${value}; allowed: ${allowed}`;
  const field = document.getElementById(place.dataset.field);
  field.setAttribute("aria-invalid", "true");
  field.setAttribute("aria-describedby", place.id);
  return true;
}

/** Take back all of that. */
export function forgive() {
  for (const place of document.querySelectorAll("[data-problem]")) {
    place.textContent = "";
    const field = document.getElementById(place.dataset.field);
    field.removeAttribute("aria-invalid");
    field.removeAttribute("aria-describedby");
  }
}
