// Colours: the peak on viridis (even in lightness, safe for colour-blind eyes), outcomes as neutral hatches.

// viridis at 17 even steps (CC0), between which we interpolate; reversed, as `rocking plot map` has it
const STEPS = [
  "440154", "481a6c", "472f7d", "414487", "39568c", "31688e", "2a788e", "23888e", "1f988b",
  "22a884", "35b779", "54c568", "7ad151", "a5db36", "d2e21b", "ece51b", "fde725",
].map((hex) => [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16))).reverse();

/** Peak beyond alpha, block survives: past the end of the scale. */
export const BROUGHT_BACK = [236, 112, 74];

/** [red, green, blue] of a peak rotation theta/alpha. */
export function colourOfPeak(peak) {
  if (peak > 1) return BROUGHT_BACK;
  const place = Math.max(peak, 0) * (STEPS.length - 1);
  const low = Math.min(Math.floor(place), STEPS.length - 2);
  return STEPS[low].map((from, part) => Math.round(from + (place - low) * (STEPS[low + 1][part] - from)));
}

/** The scale from 0 to 1 for a style sheet. */
export function scaleGradient() {
  return `linear-gradient(to right, ${STEPS.map((rgb) => `rgb(${rgb})`).join(", ")})`;
}

/** A colour of the style sheet, for the light or dark theme. */
export function themed(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** Hatch of an outcome, `scale` device pixels per pixel: parallel lines after impacts, crossed without. */
export function hatch(context, outcome, scale) {
  const size = Math.round(8 * scale);
  const tile = new OffscreenCanvas(size, size);
  const pen = tile.getContext("2d");
  const direct = outcome === "OVERTURNED_DIRECTLY";
  pen.fillStyle = themed(direct ? "fallen-directly" : "fallen");
  pen.fillRect(0, 0, size, size);
  pen.strokeStyle = themed("hatch");
  pen.lineWidth = scale;
  pen.beginPath();
  for (const shift of [-size, 0, size]) {
    pen.moveTo(shift, size);
    pen.lineTo(shift + size, 0);
    if (direct) {
      pen.moveTo(shift, 0);
      pen.lineTo(shift + size, size);
    }
  }
  pen.stroke();
  return context.createPattern(tile, "repeat");
}

/** Call `redraw` when the reader's system turns light or dark. */
export function onTheme(redraw) {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
}
