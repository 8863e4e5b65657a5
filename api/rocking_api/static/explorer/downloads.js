// Downloads: data from the service, pictures of the page, and the link to the page.

import { isSampled } from "./api.js";
import { canvasOf } from "./chart.js";
import { themed } from "./colours.js";
import { drawLegend } from "./legend.js";
import { save, setStatus } from "./page.js";
import { fontOf, textScale } from "./text.js";

const FOOT = 34; // [px] of text that is usually 16 px

/** Set the links of one part of the page, `urls` by format; a link without one, or under samples, is removed. */
export function setLinks(part, urls) {
  for (const link of document.querySelectorAll(`[data-links=${part}] a`)) {
    const url = urls[link.dataset.form];
    if (url && !isSampled(new URL(url, location).searchParams.get("pulse") ?? "")) link.href = url;
    else link.removeAttribute("href");
  }
}

/** Wire the picture buttons and the link button; `caption()` describes what is shown. */
export function wireDownloads(caption) {
  const layers = {
    map: () => [["map", "map-marks"].map((id) => document.getElementById(id))],
    motion: () => ["rotation", "acceleration-chart"].map((id) => [canvasOf(document.getElementById(id))]),
    spectrum: () => [[canvasOf(document.getElementById("spectrum-chart"))]],
  };
  for (const button of document.querySelectorAll("[data-picture]")) {
    button.addEventListener("click", () => {
      const part = button.dataset.picture;
      savePicture(part, layers[part](), caption());
    });
  }
  document.getElementById("copy").addEventListener("click", copyAddress);
}

/** One picture: rows of canvases below each other, those of a row on top of each other, the caption at the foot. */
function savePicture(part, rows, caption) {
  const ratio = devicePixelRatio * textScale();
  const legend = part === "map" ? 24 : 0;
  const made = document.createElement("canvas");
  made.width = Math.max(...rows.map(([first]) => first.width));
  made.height = rows.reduce((sum, [first]) => sum + first.height, (FOOT + legend) * ratio);
  const context = made.getContext("2d");
  context.fillStyle = themed("paper");
  context.fillRect(0, 0, made.width, made.height);
  let y = 0;
  for (const row of rows) {
    for (const layer of row) context.drawImage(layer, 0, y);
    y += row[0].height;
  }
  if (legend) drawLegend(context, 12 * ratio, y + 8 * ratio, Math.min(ratio, made.width / 820));
  context.fillStyle = themed("ink");
  context.font = fontOf(12, devicePixelRatio);
  context.textBaseline = "middle";
  context.fillText(caption, 12 * ratio, made.height - (FOOT / 2) * ratio, made.width - 24 * ratio);
  made.toBlob((blob) => save(blob, `${part}.png`));
}

async function copyAddress() {
  const place = document.getElementById("copied");
  try {
    await navigator.clipboard.writeText(location.href);
    setStatus(place, "Copied.");
  } catch {
    setStatus(place, "Copy it from the address bar.");
  }
}

