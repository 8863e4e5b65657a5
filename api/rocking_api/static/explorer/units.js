// Quantities as text with a unit, "0.4 m", and in the SI units of the service; the units that are shown everywhere.

export const UNITS = {
  width: { m: 1, cm: 0.01, mm: 0.001, ft: 0.3048, in: 0.0254 },
  height: { m: 1, cm: 0.01, mm: 0.001, ft: 0.3048, in: 0.0254 },
  acceleration: { g: 9.80665, "m/s2": 1, "cm/s2": 0.01 },
  velocity: { "m/s": 1, "cm/s": 0.01, "in/s": 0.0254 },
  period: { s: 1, ms: 0.001 },
};

/** Units that are chosen together, by the name of the choice. */
export const SYSTEMS = {
  "cm, g, cm/s": { width: "cm", height: "cm", acceleration: "g", velocity: "cm/s", period: "s" },
  "m, m/s², m/s": { width: "m", height: "m", acceleration: "m/s2", velocity: "m/s", period: "s" },
  "in, g, in/s": { width: "in", height: "in", acceleration: "g", velocity: "in/s", period: "s" },
  "ft, g, in/s": { width: "ft", height: "ft", acceleration: "g", velocity: "in/s", period: "s" },
};

/** The units in which everything is shown; those of the state. */
export const shown = { ...SYSTEMS["cm, g, cm/s"] };

/** Placeholder for a missing number. */
export const MISSING = "?";

/** Number and unit of a quantity, both as text. */
export function split(text) {
  const [value = "", unit = ""] = text.trim().split(/\s+/);
  return { value, unit };
}

/** A quantity in SI units; other text is passed on, for the service to refuse. */
export function toSI(name, text) {
  const { value, unit } = split(text);
  const read = Number(value.replace(",", "."));
  const factor = UNITS[name][unit];
  if (value === MISSING) return "";
  if (!Number.isFinite(read)) return value;
  if (factor === undefined) return text.trim();
  return Number((read * factor).toPrecision(15));
}

/** A value in SI units as a number of the unit that is shown. */
export function inShown(name, value) {
  return value / UNITS[name][shown[name]];
}

/** A unit as it is written. */
export function written(unit) {
  return unit.replace("s2", "s²");
}

/** A quantity of SI units as text in a unit, to four digits. */
export function inUnit(name, value, unit = shown[name]) {
  return `${Number((value / UNITS[name][unit]).toPrecision(4))} ${unit}`;
}
