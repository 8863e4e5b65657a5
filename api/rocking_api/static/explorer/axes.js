// Scales and ticks of an axis, linear or logarithmic.

/** A scale from [low, high] to [from, to]; `log` for logarithmic. */
export function scale(low, high, from, to, log = false) {
  const transform = log ? Math.log : (x) => x;
  const inverse = log ? Math.exp : (x) => x;
  const [a, b] = [transform(low), transform(high)];
  return {
    low,
    high,
    log,
    place: (value) => from + ((transform(value) - a) / (b - a)) * (to - from),
    value: (place) => inverse(a + ((place - from) / (to - from)) * (b - a)),
  };
}

/** Round values between `low` and `high` whose positions lie at least `apart` from each other. */
export function ticks(low, high, place, apart) {
  const wanted = high / low > 4 && low > 0 ? decades(low, high) : even(low, high, place, apart);
  return spread(wanted, place, apart).sort((x, y) => x - y);
}

/** Those of some values, the rounder ones first, whose positions lie at least `apart` from each other. */
export function spread(values, place, apart) {
  const kept = [];
  for (const value of [...values].sort((x, y) => weight(x) - weight(y))) {
    if (kept.every((other) => Math.abs(place(other) - place(value)) >= apart)) kept.push(value);
  }
  return kept;
}

/** The values between `low` and `high` of one digit, or 1.5, times a power of ten. */
export function decades(low, high) {
  const found = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); power += 1) {
    for (const digit of [1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9]) found.push(Number((digit * 10 ** power).toPrecision(3)));
  }
  return found.filter((value) => value >= low && value <= high);
}

function even(low, high, place, apart) {
  const most = Math.max(2, Math.abs(place(high) - place(low)) / (1.6 * apart));
  const rough = (high - low) / most;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((factor) => factor * power >= rough);
  const found = [];
  for (let n = Math.ceil(low / step); n * step <= high; n += 1) found.push(Number((n * step).toPrecision(6)));
  return found;
}

/** Rounder numbers come first: 1, 10, then 5 and 2, then the rest. */
function weight(value) {
  const digits = value.toExponential().split("e")[0];
  return { 1: 0, 5: 1, 2: 1 }[digits] ?? digits.length;
}
