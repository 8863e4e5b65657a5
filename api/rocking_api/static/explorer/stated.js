// What a person states about a file: it is kept in the address, and can be copied as a command.

import { setStatus } from "./page.js";

/** Fill the named fields of a form from the address, a line for each value of a name; returns whether it has one of them. */
export function restore(form, names) {
  const address = new URLSearchParams(location.search);
  for (const name of names) {
    if (!address.has(name)) continue;
    const field = form.elements[name];
    if (field.type === "checkbox") field.checked = address.get(name) === "true";
    else setValue(field, address.getAll(name).join("\n"));
  }
  return names.some((name) => address.has(name));
}

/**
 * Keep the values of the named fields in the address, each line of a value by itself, but for those that are as the page has
 * them at first.
 */
export function remember(form, names) {
  const query = new URLSearchParams();
  for (const name of names) {
    const value = valueOf(form.elements[name]);
    if (value === initialOf(form.elements[name])) continue;
    for (const line of value.split("\n")) query.append(name, line);
  }
  history.replaceState(history.state, "", query.size ? `?${query}` : location.pathname);
}

/** The value of a field as text: of a checkbox "true" or nothing. */
export function valueOf(field) {
  if (field.type === "checkbox") return field.checked ? "true" : "";
  return field.value.trim();
}

function initialOf(field) {
  if (field.type === "checkbox") return "";
  if (field.tagName !== "SELECT") return field.defaultValue;
  return ([...field.options].find((option) => option.defaultSelected) ?? field.options[0]).value;
}

/** Set a field; a list gets the value as an option if it has none. */
export function setValue(field, value) {
  if (field.tagName === "SELECT" && ![...field.options].some((option) => option.value === value)) field.add(new Option(value, value));
  field.value = value;
}

/**
 * The options of a list: the first one stands for no choice, the others are pairs of value and text. A value that was chosen and
 * is no longer among them stays, marked.
 */
export function fillList(list, first, pairs) {
  const chosen = list.value;
  const options = [new Option(first, "", true), ...pairs.map(([value, text]) => new Option(text, value))];
  if (chosen && !pairs.some(([value]) => value === chosen)) options.push(new Option(`${chosen} (not in this file)`, chosen));
  list.replaceChildren(...options);
  list.value = chosen;
}

/** A command of words, quoted as both a Unix shell and that of Windows read it, where that is possible. */
export function commandOf(words) {
  return words.map(quoted).join(" ");
}

function quoted(word) {
  if (/^[\w@%+=:,./-]+$/.test(word)) return word;
  if (!/["$`\\!]/.test(word)) return `"${word}"`;
  return `'${word.replaceAll("'", `'"'"'`)}'`;
}

/** Copy the text of an element by a button, which says so in a status line. */
export function wireCopy(button, source, status) {
  button.addEventListener("click", async () => {
    try {
      await navigator.clipboard.writeText(source.textContent);
      setStatus(status, "Copied.");
    } catch {
      getSelection().selectAllChildren(source);
      setStatus(status, "Selected: copy it with the keyboard.");
    }
  });
}
