// The legend of the map: on the page, and in a picture of it.

import { BROUGHT_BACK, colourOfPeak, hatch, onTheme, scaleGradient, themed } from "./colours.js";

const ENTRIES = [
  ["BROUGHT_BACK", "exceeds α, survives"],
  ["OVERTURNED_AFTER_IMPACT", "overturns after impacts"],
  ["OVERTURNED_DIRECTLY", "overturns without impact"],
  ["NO_UPLIFT", "no uplift"],
];

const legend = document.getElementById("legend");

/** Draw the legend into a canvas from `x`, `y` on, `ratio` device pixels per pixel. */
export function drawLegend(pen, x, y, ratio) {
  pen.font = `${12 * ratio}px system-ui, sans-serif`;
  pen.textBaseline = "middle";
  pen.textAlign = "left";
  const say = (text) => {
    pen.fillStyle = themed("ink");
    pen.fillText(text, x, y);
    x += pen.measureText(text).width + 8 * ratio;
  };
  say("peak θ/α   0");
  for (let step = 0; step < 100; step += 1) {
    pen.fillStyle = `rgb(${colourOfPeak(step / 100)})`;
    pen.fillRect(x + step * ratio, y - 6 * ratio, ratio + 1, 12 * ratio);
  }
  x += 108 * ratio;
  say("1");
  for (const [name, words] of ENTRIES) {
    x += 8 * ratio;
    fillSwatch(pen, name, x, y - 6 * ratio, 20 * ratio, 12 * ratio, ratio);
    x += 26 * ratio;
    say(words);
  }
}

function fillSwatch(pen, name, x, y, width, height, ratio) {
  if (name === "BROUGHT_BACK") pen.fillStyle = `rgb(${BROUGHT_BACK})`;
  else pen.fillStyle = name === "NO_UPLIFT" ? themed("paper") : hatch(pen, name, ratio);
  pen.fillRect(x, y, width, height);
  pen.strokeStyle = themed("muted");
  pen.lineWidth = ratio;
  pen.strokeRect(x, y, width, height);
}

function show() {
  legend.querySelector(".scale").style.backgroundImage = scaleGradient();
  for (const [name] of ENTRIES) {
    const swatch = legend.querySelector(`[data-fate=${name}]`);
    const ratio = devicePixelRatio;
    [swatch.width, swatch.height] = [26 * ratio, 16 * ratio];
    fillSwatch(swatch.getContext("2d"), name, 0, 0, swatch.width, swatch.height, ratio);
  }
}

show();
onTheme(show);
