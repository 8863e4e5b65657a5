// Labels: outcomes, pulses, numbers and quantities as text.

import { inShown, shown, written } from "./units.js";

export const OUTCOMES = {
  NO_UPLIFT: "never uplifts",
  RECOVERS: "rocks and comes to rest",
  OVERTURNED_DIRECTLY: "overturns without impact",
  OVERTURNED_AFTER_IMPACT: "overturns after one or more impacts",
};

export const PULSES = JSON.parse(document.documentElement.dataset.pulses); // by their names

/** The name of a pulse in words. */
export function pulseName(pulse) {
  return PULSES[pulse.replace(/^-/, "")] ?? (/^[a-z_]/.test(pulse) ? pulse : "Own samples");
}

/** A number to some significant digits, without trailing zeros. */
export function number(value, digits = 3) {
  if (Math.abs(value) < 1e-14) return "0";
  const text = Number(value).toPrecision(digits);
  const plain = text.includes("e") ? Number(text).toString() : text;
  return plain.includes(".") && !plain.includes("e") ? plain.replace(/\.?0+$/, "") : plain;
}

/**
 * A value > 0 at which the outcome changes, on the safe side of itself and of its error of 1e-6: rounded down if the block
 * overturns above it, rounded up if it survives there.
 */
export function threshold(value, overturnsAbove = true, digits = 3) {
  const [mantissa, power] = (value * (overturnsAbove ? 1 - 1e-6 : 1 + 1e-6)).toExponential(20).split("e");
  const figures = Number(mantissa.replace(".", "").slice(0, digits)) + (overturnsAbove ? 0 : 1);
  return number(figures * 10 ** (Number(power) - digits + 1), digits);
}

/** A factor on the motion at which the outcome changes, beside its mark: "+70 %", or "× 0.9" below 1. */
export function factorLabel(factor) {
  return factor > 1 ? `+${percentMore(factor)}` : `× ${threshold(factor)}`;
}

/** By how much a factor exceeds 1: "70 %". */
export function percentMore(factor) {
  return `${threshold(100 * (factor - 1), true, 2)} %`;
}

/** Values at which the outcome changes, [value, overturns above] each, with more digits where neighbours would coincide. */
export function thresholds(changes, digits = 3) {
  for (let more = digits; more < 12; more += 1) {
    const texts = changes.map(([value, above]) => threshold(value, above, more));
    if (new Set(texts).size === changes.length) return texts;
  }
  return changes.map(([value]) => String(value));
}

/** An error bound with one digit: 5e-11 is 5·10⁻¹¹. */
export function bound(value) {
  if (value >= 1e-3 || value === 0) return number(value, 1);
  const [digit, power] = value.toExponential(0).split("e-");
  return `${digit}·10⁻${[...power].map((figure) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[figure]).join("")}`;
}

/** A length in the unit that is shown, metric ones by size; `text` makes a number of digits of a value. */
export function length(metres, text = number) {
  if (["in", "ft"].includes(shown.width)) return `${text(inShown("width", metres), 3)} ${shown.width}`;
  if (Math.abs(metres) < 1e-3) return `${text(metres * 1e3, 2)} mm`;
  return Math.abs(metres) < 1 ? `${text(metres * 100, 3)} cm` : `${text(metres, 3)} m`;
}

/** An acceleration in the unit that is shown; `text` makes three digits of a value. */
export function acceleration(value, text = number) {
  return `${text(inShown("acceleration", value))} ${written(shown.acceleration)}`;
}

/** A velocity in the unit that is shown. */
export function velocity(value) {
  return `${number(inShown("velocity", value))} ${shown.velocity}`;
}

/** A sentence of words that begin in lower case. */
export function sentence(words) {
  return `${words[0].toUpperCase()}${words.slice(1)}.`;
}

/** "1 impact", "3 impacts"; null where a data set does not determine the number. */
export function impacts(count) {
  if (count === null) return "impacts not counted";
  return count === 1 ? "1 impact" : `${count} impacts`;
}

/** The response at one point, in one line. */
export function responseLabel(found) {
  const outcome = OUTCOMES[found.outcome];
  if (found.overturned) return found.impacts > 0 ? `overturns after ${impacts(found.impacts)}` : outcome;
  if (found.outcome === "NO_UPLIFT") return outcome;
  const error = found.error_bound === null ? "" : ` ± ${bound(found.error_bound)}`;
  const beyond = found.exceeded_alpha ? "; beyond α" : "";
  return `${outcome}; peak rotation ${found.peak_rotation.toFixed(4)} α${error}; ${impacts(found.impacts)}${found.impacts === null ? "" : " during the pulse"}${beyond}`;
}
