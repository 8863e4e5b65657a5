// The chosen ground motion in the form: its acceleration against time, and what its period T is. Own samples can be drawn.

import { isSampled } from "./api.js";
import { onTheme, themed } from "./colours.js";
import { number } from "./labels.js";
import { samplesOver } from "./pulses.js";
import { fontOf, onTextSize, textScale } from "./text.js";

const ROOM = 14; // [px] of text that is usually 16 px: around the curve, and for the mark of the period

const DRAWN = 17; // samples of a pulse that is drawn; their values are rounded to 1/20 of the peak

const canvas = document.getElementById("pulse-preview");
const note = document.getElementById("pulse-note");

let chosen = null; // name or samples
let known = null; // their description
let drawn = null; // the samples while they are drawn

/** Show a pulse, with its description; without one the preview is cleared. */
export function showPreview(pulse, description) {
  chosen = pulse;
  known = description;
  draw();
}

/** Let a drag over the picture of own samples change them; `take` is given them as text when it ends. */
export function wireDrawing(take) {
  let last = null;
  const move = (event) => {
    if (!drawn) return;
    const box = canvas.getBoundingClientRect();
    const { room, middle, high } = frame(box.width, box.height);
    const bounded = (value, from, to) => Math.min(Math.max(value, from), to);
    const at = Math.round(bounded((event.clientX - box.left - room) / (box.width - 2 * room), 0, 1) * (DRAWN - 1));
    const value = Math.round(bounded((middle - (event.clientY - box.top)) / high, -1, 1) * 20) / 20;
    last ??= { at, value };
    for (let k = Math.min(at, last.at); k <= Math.max(at, last.at); k++) { // a fast drag leaves samples out
      const part = at === last.at ? 1 : (k - last.at) / (at - last.at);
      drawn[k] = Number((last.value + part * (value - last.value)).toFixed(3));
    }
    last = { at, value };
    draw();
  };
  canvas.addEventListener("pointerdown", (event) => {
    if (!isSampled(chosen)) return;
    const { time, acceleration } = known;
    drawn = Array.from({ length: DRAWN }, (_, k) => Number(linear(time, acceleration, k / (DRAWN - 1)).toFixed(3)));
    canvas.setPointerCapture(event.pointerId);
    move(event);
  });
  canvas.addEventListener("pointermove", move);
  for (const end of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(end, () => {
      if (drawn) take(drawn.join(" "));
      drawn = last = null;
    });
  }
}

/** Value at a time of what is linear between its samples. */
function linear(time, values, at) {
  const after = Math.max(time.findIndex((one) => one >= at), 1);
  if (values.length === 1) return values[0];
  const part = (at - time[after - 1]) / (time[after] - time[after - 1]);
  return values[after - 1] + part * (values[after] - values[after - 1]);
}

/** Room around the curve, the height of zero, and the height of the peak above it [px]. */
function frame(width, height) {
  const room = ROOM * textScale();
  const middle = (height - room) / 2;
  return { room, middle, high: middle - 5 };
}

function draw() {
  canvas.classList.toggle("own", isSampled(chosen));
  const pulse = drawn ? samplesOver(drawn) : known;
  canvas.hidden = !pulse;
  note.textContent = pulse ? `It lasts ${number(pulse.duration)} T. ${pulse.definition}` : "";
  if (!pulse || !canvas.clientWidth) return;
  const ratio = devicePixelRatio;
  canvas.width = Math.round(canvas.clientWidth * ratio);
  canvas.height = Math.round(canvas.clientHeight * ratio);
  const context = canvas.getContext("2d");
  context.scale(ratio, ratio);
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  const span = Math.max(pulse.duration, 1);
  const sign = chosen.startsWith("-") && !isSampled(chosen) ? -1 : 1;
  const { room, middle, high } = frame(width, height);
  const x = (time) => room + (time / span) * (width - 2 * room);
  const y = (value) => middle - sign * value * high;
  line(context, [[0, middle], [width, middle]], themed("line"), 1);
  const points = pulse.time.map((time, at) => [x(time), y(pulse.acceleration[at])]);
  const ends = [points[0][0], points.at(-1)[0]].map((place) => [place, middle]);
  line(context, [[0, middle], ends[0], ...points, ends[1], [width, middle]], themed("accent"), 2);
  const start = Math.max((pulse.duration - 1) / 2, 0); // the period is marked in the middle of a long pulse
  drawPeriod(context, x(start), x(start + 1), height - 6 * textScale());
}

function drawPeriod(context, from, to, y) {
  const ink = themed("muted");
  line(context, [[from, y], [to, y]], ink, 1);
  for (const end of [from, to]) line(context, [[end, y - 4], [end, y + 4]], ink, 1);
  context.font = fontOf(12);
  context.textAlign = "center";
  context.textBaseline = "middle";
  const middle = (from + to) / 2;
  context.fillStyle = themed("paper");
  const [wide, high] = [16 * textScale(), 12 * textScale()];
  context.fillRect(middle - wide / 2, y - high / 2, wide, high);
  context.fillStyle = themed("ink");
  context.fillText("T", middle, y);
}

function line(context, points, colour, width) {
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.beginPath();
  points.forEach(([x, y], at) => (at ? context.lineTo(x, y) : context.moveTo(x, y)));
  context.stroke();
}

new ResizeObserver(() => known && draw()).observe(canvas);
for (const on of [onTheme, onTextSize]) on(() => known && draw());
