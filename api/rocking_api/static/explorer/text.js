// Text on drawings: its size follows that of the page, which the reader sets.

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
