// The state of the page is its address: names and numbers as text, as in the URL.

export const DEFAULTS = {
  pulse: "sine",
  restitution: "0.85",
  alpha_deg: "0",
  frequency_ratio: "",
  slenderness: "",
  frequency_ratio_min: "",
  frequency_ratio_max: "",
  slenderness_min: "",
  slenderness_max: "",
  // a block in metres, each with its unit, as "0.4 m"; it takes the place of alpha_deg and of the point above
  width: "",
  height: "",
  acceleration: "",
  period: "", // at which the pulse has this acceleration and velocity, unless it is stated
  velocity: "30 cm/s", // of the ground at its peak, for pulses of every shape
};

/** What is shown at first: a block that rocks and comes to rest. */
const EXAMPLE = {
  ...{ width: "40 cm", height: "160 cm", acceleration: "0.4 g", velocity: "40 cm/s", restitution: "momentum" },
  pulse: "cosine", // the first one that overturns it: both answers are the same
};

const listeners = [];
let current = read();
let step = addressOf(current);

function read() {
  const given = new URLSearchParams(location.search);
  const found = location.search ? { ...DEFAULTS } : { ...DEFAULTS, ...EXAMPLE };
  for (const name of Object.keys(DEFAULTS)) if (given.has(name)) found[name] = given.get(name);
  return found;
}

/** The state now. */
export function state() {
  return current;
}

/** The address that shows a state. */
export function addressOf(wanted) {
  const told = Object.entries(wanted).filter(([name, value]) => value !== DEFAULTS[name]);
  if (!told.length) told.push(["pulse", wanted.pulse]); // without a query the example is shown
  return `?${new URLSearchParams(told)}`;
}

/** Whether the state holds a block in metres rather than a point of the map. */
export function isBlock(wanted) {
  return wanted.width !== "" || wanted.height !== "";
}

/**
 * Change some of the state. `keep` adds an entry to the history of the browser; intermediate states, while a slider is
 * dragged, add none.
 */
export function change(parts, { keep = true } = {}) {
  current = { ...current, ...parts };
  const address = addressOf(current);
  if (keep && address !== step) {
    history.replaceState(history.state, "", step);
    history.pushState({ steps: stepsBack() + 1 }, "", address);
    step = address;
  } else history.replaceState(history.state, "", address);
  refresh();
}

/** Number of entries in the history of the browser that this page added before the present one. */
export function stepsBack() {
  return history.state?.steps ?? 0;
}

/** Call `listener(state)` after every change, the back and forward buttons among them. */
export function onChange(listener) {
  listeners.push(listener);
}

/** Call all listeners again, so that failed requests are repeated. */
export function refresh() {
  for (const listener of listeners) listener(current);
}

addEventListener("popstate", () => {
  current = read();
  step = addressOf(current);
  refresh();
});
