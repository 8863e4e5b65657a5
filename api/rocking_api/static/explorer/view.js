// The window of the map: the default or that of the address, widened to hold the chosen point, and zoomed.

const WHOLE = { frequency_ratio_min: 0.5, frequency_ratio_max: 12, slenderness_min: 0.01, slenderness_max: 1.05 };
const MOST_SLENDER = 2;
const LEAST_SPAN = 1e-3;

/** The four borders as numbers; `point` (or null) lies inside unless it is far from uplift. */
export function windowOf(state, point) {
  const found = { ...WHOLE };
  if (point && !asked(state)) {
    const { frequency_ratio: omega, slenderness: s } = point;
    if (omega < found.frequency_ratio_min) found.frequency_ratio_min = omega / 1.5;
    if (omega > found.frequency_ratio_max) found.frequency_ratio_max = omega * 1.5;
    if (s < found.slenderness_min * 2) found.slenderness_min = s / 2;
    if (s > found.slenderness_max) found.slenderness_max = Math.min(s * 1.05, MOST_SLENDER);
  }
  for (const name of Object.keys(WHOLE)) if (state[name] !== "") found[name] = Number(state[name]);
  return found;
}

/** The parts of a state that show the whole map. */
export function whole() {
  return Object.fromEntries(Object.keys(WHOLE).map((name) => [name, ""]));
}

/** The parts of a state that show `factor` of the sides of the window about a point. */
export function zoomed(view, about, factor) {
  const transforms = { frequency_ratio: [Math.log, Math.exp], slenderness: [(x) => x, (x) => x] };
  const parts = {};
  for (const [name, [transform, inverse]] of Object.entries(transforms)) {
    const [low, high] = [transform(view[`${name}_min`]), transform(view[`${name}_max`])];
    const at = Math.min(Math.max(transform(about[name]), low), high);
    const span = Math.max((high - low) * factor, LEAST_SPAN);
    const share = (at - low) / (high - low);
    let [from, to] = [at - share * span, at + (1 - share) * span];
    if (name === "slenderness" && from < WHOLE.slenderness_min) from = Math.min(low, WHOLE.slenderness_min);
    if (name === "slenderness") to = Math.min(to, MOST_SLENDER);
    parts[`${name}_min`] = Number(inverse(from).toPrecision(5)).toString();
    parts[`${name}_max`] = Number(inverse(to).toPrecision(5)).toString();
  }
  return parts;
}

/** The parts of a state that show the window moved by some shares of its sides. */
export function panned(view, across, up) {
  const ratio = (view.frequency_ratio_max / view.frequency_ratio_min) ** across;
  const span = view.slenderness_max - view.slenderness_min;
  const room = [Math.min(WHOLE.slenderness_min - view.slenderness_min, 0), Math.max(MOST_SLENDER - view.slenderness_max, 0)];
  const shift = Math.min(Math.max(up * span, room[0]), room[1]);
  const moved = {
    frequency_ratio_min: view.frequency_ratio_min * ratio,
    frequency_ratio_max: view.frequency_ratio_max * ratio,
    slenderness_min: view.slenderness_min + shift,
    slenderness_max: view.slenderness_max + shift,
  };
  return Object.fromEntries(Object.entries(moved).map(([name, value]) => [name, Number(value.toPrecision(5)).toString()]));
}

/** Whether a window holds the whole map. */
export function covers(view) {
  const within = (name, sign) => sign * (Number(view[name]) - WHOLE[name]) >= -1e-9;
  return ["frequency_ratio", "slenderness"].every((name) => within(`${name}_max`, 1) && within(`${name}_min`, -1));
}

/** The point in the middle of the window. */
export function middleOf(view) {
  return pointAt(view, 0.5, 0.5);
}

/** The point that lies some shares of the window's sides away, within the window. */
export function pointBeside(view, { frequency_ratio, slenderness }, across, up) {
  const x = Math.log(frequency_ratio / view.frequency_ratio_min) / Math.log(view.frequency_ratio_max / view.frequency_ratio_min);
  const y = (slenderness - view.slenderness_min) / (view.slenderness_max - view.slenderness_min);
  const within = (share) => Math.min(Math.max(share, 0), 1);
  return pointAt(view, within(x + across), within(y + up));
}

/** The point at some shares of the window's sides. */
function pointAt(view, x, y) {
  return {
    frequency_ratio: view.frequency_ratio_min * (view.frequency_ratio_max / view.frequency_ratio_min) ** x,
    slenderness: view.slenderness_min + y * (view.slenderness_max - view.slenderness_min),
  };
}

function asked(state) {
  return Object.keys(WHOLE).some((name) => state[name] !== "");
}
