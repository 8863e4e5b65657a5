// Questions to the service: a newer one on the same channel takes the place of the older, and answers are kept.

const KEPT = 60;
const answers = new Map();
const running = new Map();

/** A refusal of the service (problem+json): `parameter`, `value` and `allowed` as it names them. */
export class Problem extends Error {
  constructor(told) {
    super(told.detail ?? "the service gave no reason");
    this.parameter = told.parameter;
    this.value = told.value;
    this.allowed = told.allowed;
  }
}

/** Path and query of a question; empty parts are left out. */
export function urlOf(path, question) {
  const told = Object.entries(question).filter(([, value]) => value !== "" && value !== null && value !== undefined);
  return `${path}?${new URLSearchParams(told)}`;
}

/** The answer, or null if a newer question on the channel took its place. Throws Problem. */
export async function ask(channel, path, question) {
  running.get(channel)?.abort();
  running.delete(channel);
  const url = urlOf(path, question);
  if (answers.has(url)) return answers.get(url);
  const control = new AbortController();
  running.set(channel, control);
  try {
    const response = await fetch(url, { signal: control.signal });
    const found = await response.json();
    if (!response.ok) throw new Problem(found);
    keep(url, found);
    return found;
  } catch (error) {
    if (error.name === "AbortError") return null;
    if (error instanceof Problem) throw error;
    throw new Problem({ detail: `the service does not answer (${error.message})` });
  } finally {
    if (running.get(channel) === control) running.delete(channel);
  }
}

function keep(url, found) {
  answers.set(url, found);
  if (answers.size > KEPT) answers.delete(answers.keys().next().value);
}
