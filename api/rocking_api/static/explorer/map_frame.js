// The frame of the map: ticks and titles, in groups, and for a block in metres in its acceleration and period.

import { ticks } from "./axes.js";
import { themed } from "./colours.js";
import { number } from "./labels.js";
import { fontOf, textScale } from "./text.js";
import { inShown, shown, written } from "./units.js";

const MARGIN = { left: 58, right: 58, top: 14, bottom: 44 }; // [px] of text that is usually 16 px
const [NARROW, EDGE] = [0.55, 14]; // share of the width that margins may take, else there is no second scale on the right

/** Room around the picture [px] on a canvas of a width, for a block of a `size` or none. */
export function marginOf(size, width) {
  const scale = textScale();
  const right = (MARGIN.left + MARGIN.right) * scale > NARROW * width ? EDGE : MARGIN.right;
  const top = size ? MARGIN.bottom : MARGIN.top;
  return { left: MARGIN.left * scale, right: right * scale, top: top * scale, bottom: MARGIN.bottom * scale };
}

/** Draw ticks and titles; for a block of a `size` period and peak acceleration, with the groups as the second scale. */
export function drawFrame(context, frame, scales, size, pixels) {
  const ratio = pixels * textScale();
  const right = frame.left + frame.width;
  const bottom = frame.top + frame.height;
  const [middle, centre] = [frame.left + frame.width / 2, frame.top + frame.height / 2];
  context.strokeStyle = themed("muted");
  context.fillStyle = themed("ink");
  context.lineWidth = pixels;
  context.font = fontOf(12, pixels);
  context.strokeRect(frame.left, frame.top, frame.width, frame.height);
  const tick = { context, ratio, pixels };

  const below = { at: bottom, side: 1, title: bottom + 34 * ratio };
  const above = { at: frame.top, side: -1, title: frame.top - 30 * ratio };
  const across = (axis, place, low, high, words) => {
    for (const value of ticks(low, high, place, 40 * ratio)) markAcross(tick, place(value), axis.at, axis.side, number(value, 4));
    title(tick, middle, axis.title, 0, words);
  };
  across(size ? above : below, scales.x.place, scales.x.low, scales.x.high, "frequency ratio  ω = ω_g/p");
  if (size) {
    const unit = inShown("period", 1);
    const period = (T) => scales.x.place((2 * Math.PI * unit) / (size.p * T));
    const [low, high] = [scales.x.high, scales.x.low].map((omega) => (2 * Math.PI * unit) / (size.p * omega));
    across(below, period, low, high, `period of the pulse T [${shown.period}]`);
  }

  const left = { at: frame.left, side: -1, title: frame.left - 44 * ratio };
  const beside = { at: right, side: 1, title: right + 46 * ratio };
  const upwards = (axis, place, low, high, words) => {
    for (const value of ticks(low, high, place, 24 * ratio)) markBeside(tick, axis.at, place(value), axis.side, number(value, 3));
    title(tick, axis.title, centre, axis.side, words);
  };
  const unit = size ? inShown("acceleration", size.uplift) : 1;
  const words = size ? `peak acceleration [${written(shown.acceleration)}]` : "amplitude  a = a_g/(g tan α)";
  const narrow = context.canvas.width - right < (MARGIN.right * ratio) / 2;
  const both = (axis, ...of) => (axis === left || !narrow) && upwards(axis, ...of);
  both(size ? beside : left, scales.y.place, scales.y.low, scales.y.high, "slenderness  1/a = g tan α/a_g");
  both(size ? left : beside, (a) => scales.y.place(unit / a), unit / scales.y.high, unit / scales.y.low, words);
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

/** A title, centred where that fits on the canvas, smaller if it is longer; the letter after an underscore is a subscript. */
function title({ context, ratio, pixels }, x, y, quarters, text) {
  const parts = text.split("_").flatMap((part, at) => (at ? [[part[0], true], [part.slice(1), false]] : [[part, false]]));
  const widthOf = ([words, low]) => {
    context.font = fontOf(low ? 9 : 12, pixels);
    return context.measureText(words).width;
  };
  const whole = parts.map(widthOf).reduce((sum, width) => sum + width);
  const room = quarters ? context.canvas.height : context.canvas.width;
  const [shrink, middle] = [Math.min(1, room / whole), quarters ? y : x];
  const half = (shrink * whole) / 2;
  const inside = Math.min(Math.max(middle, half), room - half);
  context.save();
  context.translate(quarters ? x : inside, quarters ? inside : y);
  context.rotate((quarters * Math.PI) / 2);
  context.scale(shrink, shrink);
  context.textAlign = "left";
  context.textBaseline = "middle";
  let at = -whole / 2;
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
