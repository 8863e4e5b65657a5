// Labels: outcomes, pulses, numbers and lengths as text.

export const OUTCOMES = {
  NO_UPLIFT: "does not uplift",
  SAFE: "survives (comes to rest)",
  OVERTURNED_DIRECTLY: "overturns without an impact",
  OVERTURNED_AFTER_IMPACT: "overturns after impacts",
};

export const PULSES = {
  sine: "One full sine",
  cosine: "One full cosine",
  half_sine: "Half a sine",
  rectangular: "Rectangular",
  c1: "Type C1, 1.5 cycles",
  c2: "Type C2, 2.5 cycles",
  ricker: "Ricker wavelet",
  ricker_antisymmetric: "Ricker wavelet, antisymmetric",
  mavroeidis_papageorgiou: "Mavroeidis and Papageorgiou",
};

/** A number to some significant digits, without trailing zeros. */
export function number(value, digits = 3) {
  if (Math.abs(value) < 1e-14) return "0";
  const text = Number(value).toPrecision(digits);
  const plain = text.includes("e") ? Number(text).toString() : text;
  return plain.includes(".") && !plain.includes("e") ? plain.replace(/\.?0+$/, "") : plain;
}

/** Ascending numbers as text, with more digits where neighbours would coincide. */
export function distinct(values, digits = 3) {
  for (let more = digits; more < 12; more += 1) {
    const texts = values.map((value) => number(value, more));
    if (new Set(texts).size === new Set(values).size) return texts;
  }
  return values.map(String);
}

/** An error bound with one digit: 5e-11 is 5·10⁻¹¹. */
export function bound(value) {
  if (value >= 1e-3 || value === 0) return number(value, 1);
  const [digit, power] = value.toExponential(0).split("e-");
  return `${digit}·10⁻${[...power].map((figure) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[figure]).join("")}`;
}

/** A length in mm, cm or m. */
export function length(metres) {
  if (Math.abs(metres) < 1e-3) return `${number(metres * 1e3, 2)} mm`;
  return Math.abs(metres) < 1 ? `${number(metres * 100, 3)} cm` : `${number(metres, 3)} m`;
}

/** An acceleration in g and in m/s2. */
export function inG(value) {
  return `${number(value / 9.80665)} g (${number(value)} m/s²)`;
}

/** "1 impact", "3 impacts". */
export function impacts(count) {
  return count === 1 ? "1 impact" : `${count} impacts`;
}

/** The response at one point, in one line. */
export function responseLabel(found) {
  const outcome = OUTCOMES[found.outcome];
  if (found.overturned) return found.impacts > 0 ? `overturns after ${impacts(found.impacts)}` : outcome;
  if (found.outcome === "NO_UPLIFT") return outcome;
  const error = found.error_bound === null ? "" : ` ± ${bound(found.error_bound)}`;
  const beyond = found.exceeded_alpha ? "; it exceeds α" : "";
  return `${outcome}; peak rotation ${found.peak_rotation.toFixed(4)} α${error}; ${impacts(found.impacts)} during the pulse${beyond}`;
}
