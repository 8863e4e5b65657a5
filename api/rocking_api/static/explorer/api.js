// Requests to the service, with a cache of responses. The caller owns the signal that cancels a request.

/** Whether the pulse of a state is given by samples, separated by blanks, and not by its name. */
export function isSampled(pulse) {
  return /^[-+]?[.\d]/.test(pulse);
}

const KEPT = 60;
const ATTEMPTS = 4;
const cache = new Map();

/** An error response (problem+json) with its `parameter`, `value` and `allowed`. */
export class Problem extends Error {
  constructor(given) {
    super(given.detail ?? "the service gave no reason");
    this.parameter = given.parameter;
    this.value = given.value;
    this.allowed = given.allowed;
  }
}

/** Path and query; empty parameters are left out. */
export function urlOf(path, params) {
  const given = Object.entries(params).filter(([, value]) => value !== "" && value !== null && value !== undefined);
  return `${path}?${new URLSearchParams(given)}`;
}

/** The response. Throws Problem, or the reason with which the signal was aborted. */
export async function ask(path, params, signal) {
  const url = urlOf(path, params);
  if (!cache.has(url)) keep(url, await (isSampled(params.pulse ?? "") ? sampled(path, params, signal) : fetched(url, { signal })));
  return cache.get(url);
}

/** The response under a pulse that is given by samples, which are separated by blanks. */
function sampled(path, { pulse, ...params }, signal) {
  const given = Object.entries(params).filter(([, value]) => value !== "" && value !== null && value !== undefined);
  const body = JSON.stringify({ ...Object.fromEntries(given), pulse: { acceleration: pulse.split(" ").map(Number) } });
  return fetched(path, { signal, method: "POST", body, headers: { "Content-Type": "application/json" } });
}

/** The response to a file; it is not cached. Throws as `ask`. */
export async function send(path, params, file, signal) {
  return fetched(urlOf(path, params), { signal, method: "POST", body: file });
}

/** The text of a page of the service to a form or a file. Throws as `ask`. */
export async function page(path, body, signal) {
  return fetched(path, { signal, method: "POST", body, headers: { Accept: "application/json" } }, (response) => response.text());
}

/** A file of the service under another name. Throws as `ask`. */
export async function file(url, name, signal) {
  const content = await fetched(url, { signal }, (response) => response.blob());
  return new File([content], name, { lastModified: 0 });
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

/** A busy service says when to try again (Retry-After). */
async function fetched(url, options, read) {
  for (let attempt = 1; ; attempt += 1) {
    const { ok, found, after } = await exchanged(url, options, read);
    if (ok) return found;
    if (!after || attempt === ATTEMPTS) throw new Problem(found);
    await pause(1000 * after, options.signal);
  }
}

async function exchanged(url, options, read = (response) => response.json()) {
  try {
    const response = await fetch(url, options);
    const found = await (response.ok ? read(response) : response.json());
    return { ok: response.ok, found, after: Number(response.headers.get("Retry-After")) };
  } catch (error) {
    if (options.signal.aborted) throw options.signal.reason;
    throw new Problem({ detail: `the service does not answer (${error.message})` });
  }
}

function keep(url, found) {
  if (cache.size === KEPT) cache.delete(cache.keys().next().value);
  cache.set(url, found);
}
