// Quantities as text with a unit, "0.4 m", and in the SI units of the service.

export const UNITS = {
  width: { m: 1, cm: 0.01, mm: 0.001, ft: 0.3048, in: 0.0254 },
  height: { m: 1, cm: 0.01, mm: 0.001, ft: 0.3048, in: 0.0254 },
  acceleration: { g: 9.80665, "m/s2": 1, "cm/s2": 0.01 },
  period: { s: 1, ms: 0.001 },
};

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

/** A quantity of SI units in the unit of another text, to four digits. */
export function inUnitOf(name, text, value) {
  const { unit } = split(text);
  return `${Number((value / UNITS[name][unit]).toPrecision(4))} ${unit}`;
}
