// Questions to the service; answers are kept. Whoever asks owns the signal that ends the question.

const KEPT = 60;
const ATTEMPTS = 4;
const answers = new Map();

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

/** The answer. Throws Problem, or the reason with which the signal was aborted. */
export async function ask(path, question, signal) {
  const url = urlOf(path, question);
  if (!answers.has(url)) keep(url, await fetched(url, signal));
  return answers.get(url);
}

/** Wait some ms, or until the signal is aborted; throws its reason then. */
export function pause(milliseconds, signal) {
  return new Promise((resolve, reject) => {
    const timer = setTimeout(resolve, milliseconds);
    signal.addEventListener("abort", () => {
      clearTimeout(timer);
      reject(signal.reason);
    });
  });
}

/** A busy service says when to ask again. */
async function fetched(url, signal) {
  for (let attempt = 1; ; attempt += 1) {
    const { ok, found, after } = await exchanged(url, signal);
    if (ok) return found;
    if (!after || attempt === ATTEMPTS) throw new Problem(found);
    await pause(1000 * after, signal);
  }
}

async function exchanged(url, signal) {
  try {
    const response = await fetch(url, { signal });
    return { ok: response.ok, found: await response.json(), after: Number(response.headers.get("Retry-After")) };
  } catch (error) {
    if (signal.aborted) throw signal.reason;
    throw new Problem({ detail: `the service does not answer (${error.message})` });
  }
}

function keep(url, found) {
  if (answers.size === KEPT) answers.delete(answers.keys().next().value);
  answers.set(url, found);
}
