// The frame of the map: ticks and titles, in groups, and for a block in metres also in g and seconds.

import { ticks } from "./axes.js";
import { themed } from "./colours.js";
import { number } from "./labels.js";

/** Room around the picture [px]. */
export const MARGIN = { left: 58, right: 58, top: 14, bottom: 44 };
export const MARGIN_OF_BLOCK = { ...MARGIN, top: 44 };

/** Draw ticks and titles; `size` (or null) turns groups into the amplitude and the period of one block. */
export function drawFrame(context, frame, scales, size, ratio) {
  const right = frame.left + frame.width;
  const bottom = frame.top + frame.height;
  context.strokeStyle = themed("muted");
  context.fillStyle = themed("ink");
  context.lineWidth = ratio;
  context.font = `${12 * ratio}px system-ui, sans-serif`;
  context.strokeRect(frame.left, frame.top, frame.width, frame.height);
  const tick = { context, ratio };

  const omegas = ticks(scales.x.low, scales.x.high, scales.x.place, 34 * ratio);
  for (const omega of omegas) markAcross(tick, scales.x.place(omega), bottom, 1, number(omega, 4));
  const slendernesses = ticks(scales.y.low, scales.y.high, scales.y.place, 30 * ratio);
  for (const s of slendernesses) markBeside(tick, frame.left, scales.y.place(s), -1, number(s, 4));

  const unit = size ? size.uplift_in_g : 1;
  const amplitude = (a) => scales.y.place(unit / a);
  for (const a of ticks(unit / scales.y.high, unit / scales.y.low, amplitude, 20 * ratio)) {
    markBeside(tick, right, amplitude(a), 1, number(a, 3));
  }
  if (size) {
    const period = (T) => scales.x.place((2 * Math.PI) / (size.p * T));
    const ends = [scales.x.high, scales.x.low].map((omega) => (2 * Math.PI) / (size.p * omega));
    for (const T of ticks(...ends, period, 40 * ratio)) markAcross(tick, period(T), frame.top, -1, number(T, 3));
    title(tick, frame.left + frame.width / 2, frame.top - 30 * ratio, 0, "period of the pulse T [s]");
  }
  title(tick, frame.left + frame.width / 2, bottom + 34 * ratio, 0, "frequency ratio  ω = ω_g/p");
  title(tick, frame.left - 44 * ratio, frame.top + frame.height / 2, -1, "slenderness  1/a = g tan α/a_g");
  const words = size ? "peak acceleration [g]" : "amplitude  a = a_g/(g tan α)";
  title(tick, right + 46 * ratio, frame.top + frame.height / 2, 1, words);
}

function markAcross({ context, ratio }, x, y, side, text) {
  line(context, x, y, x, y + 4 * ratio * side);
  context.textAlign = "center";
  context.textBaseline = side > 0 ? "top" : "bottom";
  context.fillText(text, x, y + 7 * ratio * side);
}

function markBeside({ context, ratio }, x, y, side, text) {
  line(context, x, y, x + 4 * ratio * side, y);
  context.textAlign = side > 0 ? "left" : "right";
  context.textBaseline = "middle";
  context.fillText(text, x + 7 * ratio * side, y);
}

/** A centred title; the letter after an underscore is a subscript. */
function title({ context, ratio }, x, y, quarters, text) {
  const parts = text.split("_").flatMap((part, at) => (at ? [[part[0], true], [part.slice(1), false]] : [[part, false]]));
  const fontOf = (low) => `${(low ? 9 : 12) * ratio}px system-ui, sans-serif`;
  const widthOf = ([words, low]) => {
    context.font = fontOf(low);
    return context.measureText(words).width;
  };
  context.save();
  context.translate(x, y);
  context.rotate((quarters * Math.PI) / 2);
  context.textAlign = "left";
  context.textBaseline = "middle";
  let at = -parts.map(widthOf).reduce((sum, width) => sum + width) / 2;
  for (const part of parts) {
    const width = widthOf(part);
    context.fillText(part[0], at, part[1] ? 4 * ratio : 0);
    at += width;
  }
  context.restore();
}

function line(context, x1, y1, x2, y2) {
  context.beginPath();
  context.moveTo(x1, y1);
  context.lineTo(x2, y2);
  context.stroke();
}
