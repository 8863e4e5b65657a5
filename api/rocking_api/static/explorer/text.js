// Text on drawings: its size follows that of the page, which the reader sets.

import { themed } from "./colours.js";

const probe = document.body.appendChild(document.createElement("div"));
probe.className = "text-probe"; // as wide as the text of the page is large

/** Size of the text of the page over the usual 16 px. */
export function textScale() {
  return parseFloat(getComputedStyle(document.documentElement).fontSize) / 16;
}

/** Font of a drawing, for a `size` in px of text that is usually 16 px; `ratio` pixels of the canvas per px. */
export function fontOf(size, ratio = 1) {
  return `${size * textScale() * ratio}px system-ui, sans-serif`;
}

/** Call `redraw` when the text of the page changes its size. */
export function onTextSize(redraw) {
  let drawn = textScale();
  new ResizeObserver(() => {
    if (textScale() === drawn) return;
    drawn = textScale();
    redraw();
  }).observe(probe);
}

/** Write a label on a plate of its own, which is read on every colour; `side` -1 left of x, 1 right of it. */
export function drawLabel(context, text, x, y, side, pixels) {
  const [pad, high] = [4 * pixels, 18 * textScale() * pixels];
  context.font = fontOf(12, pixels);
  const wide = context.measureText(text).width + 2 * pad;
  const left = side < 0 ? x - wide : x;
  context.fillStyle = themed("paper");
  context.strokeStyle = themed("ink");
  context.lineWidth = pixels;
  context.beginPath();
  context.roundRect(left, y - high / 2, wide, high, 3 * pixels);
  context.fill();
  context.stroke();
  context.fillStyle = themed("ink");
  context.textAlign = "left";
  context.textBaseline = "middle";
  context.fillText(text, left + pad, y);
}
