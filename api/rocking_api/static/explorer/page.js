// Status lines, field errors and elements, shared by all parts of the page.

/** Set a status line to a text, or to an Error with a button that calls `again`. */
export function setStatus(place, what, again) {
  const wrong = what instanceof Error;
  place.classList.toggle("wrong", wrong);
  if (!wrong) place.textContent = what;
  else if (showFieldError(what, document.querySelector("form"))) {
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

/** A list of terms and their values. */
export function facts(pairs) {
  const made = element("dl");
  for (const [term, value] of pairs) made.append(element("dt", term), element("dd", value));
  return made;
}

/** The assumptions of a response in SI units, folded. */
export function assumptions({ assumptions: lines, disclaimer }) {
  const list = element("ul", lines.map((line) => element("li", line)));
  return element("details", [element("summary", "Assumptions"), list, element("p", disclaimer, { class: "small" })]);
}

/** Mark a field of a form as wrong, with the reason beside it. */
export function markField(place, words) {
  place.textContent = words;
  const field = document.getElementById(place.dataset.field);
  field.setAttribute("aria-invalid", "true");
  field.setAttribute("aria-describedby", place.id);
  return field;
}

/** Show an error beside the field of a form that it names; returns whether there is one. */
function showFieldError({ parameter, value, allowed, message }, form) {
  const place = document.querySelector(`[data-problem="${CSS.escape(parameter ?? "")}"]`);
  if (!place) return false;
  const name = parameter.replaceAll("_", " ");
  const words = value === undefined ? `${name} is missing` : `${name} is ${value}; allowed: ${allowed}`;
  markField(place, inTermsOf(form, parameter === "record" ? message : words));
  return true;
}

/** The message of a reader, which names arguments and perhaps their values, with the labels of the fields of a form. */
export function inTermsOf(form, message) {
  return message.replace(/(?:the argument )?`(\w+)(?:=("?)([^`]*)\2)?`/g, (words, name, _, value) => {
    const field = form.elements[name === "format" ? "file_format" : name];
    const label = field?.labels?.[0]?.textContent.trim();
    if (!label) return words;
    const option = [...(field.options ?? [])].find((one) => one.value === value);
    return `the field “${label}”${value && field.type !== "checkbox" ? `: ${option?.text ?? value}` : ""}`;
  });
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

/** Have the browser save a blob. */
export function save(blob, name) {
  const link = element("a", "", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
