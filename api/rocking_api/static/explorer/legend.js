// The legend of the map: on the page, and in a picture of it.

import { BROUGHT_BACK, colourOfPeak, hatch, onTheme, scaleGradient, themed } from "./colours.js";

const ENTRIES = [
  ["BROUGHT_BACK", "rocks beyond α, comes to rest"],
  ["OVERTURNED_AFTER_IMPACT", "overturns after impacts"],
  ["OVERTURNED_DIRECTLY", "overturns without impact"],
  ["NO_UPLIFT", "never uplifts"],
];

const legend = document.getElementById("legend");

/** Draw the legend into a canvas from `x`, `y` on, `ratio` device pixels per pixel. */
export function drawLegend(context, x, y, ratio) {
  context.font = `${12 * ratio}px system-ui, sans-serif`;
  context.textBaseline = "middle";
  context.textAlign = "left";
  const drawText = (text) => {
    context.fillStyle = themed("ink");
    context.fillText(text, x, y);
    x += context.measureText(text).width + 8 * ratio;
  };
  drawText("peak θ/α   0");
  for (let step = 0; step < 100; step += 1) {
    context.fillStyle = `rgb(${colourOfPeak(step / 100)})`;
    context.fillRect(x + step * ratio, y - 6 * ratio, ratio + 1, 12 * ratio);
  }
  x += 108 * ratio;
  drawText("1");
  for (const [name, words] of ENTRIES) {
    x += 8 * ratio;
    fillSwatch(context, name, x, y - 6 * ratio, 20 * ratio, 12 * ratio, ratio);
    x += 26 * ratio;
    drawText(words);
  }
}

function fillSwatch(context, name, x, y, width, height, ratio) {
  if (name === "BROUGHT_BACK") context.fillStyle = `rgb(${BROUGHT_BACK})`;
  else context.fillStyle = name === "NO_UPLIFT" ? themed("paper") : hatch(context, name, ratio);
  context.fillRect(x, y, width, height);
  context.strokeStyle = themed("muted");
  context.lineWidth = ratio;
  context.strokeRect(x, y, width, height);
}

function show() {
  legend.querySelector(".scale").style.backgroundImage = scaleGradient();
  for (const [name] of ENTRIES) {
    const swatch = legend.querySelector(`[data-outcome=${name}]`);
    const ratio = devicePixelRatio;
    [swatch.width, swatch.height] = [26 * ratio, 16 * ratio];
    fillSwatch(swatch.getContext("2d"), name, 0, 0, swatch.width, swatch.height, ratio);
  }
}

show();
onTheme(show);
