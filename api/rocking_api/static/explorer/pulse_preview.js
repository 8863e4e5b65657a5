// The chosen ground motion in the form: its acceleration against time, and what its period T is.

import { ask, isSampled } from "./api.js";
import { onTheme, themed } from "./colours.js";
import { number } from "./labels.js";
import { fontOf, onTextSize, textScale } from "./text.js";

const SAMPLES = 65;
const ROOM = 14; // [px] of text that is usually 16 px: around the curve, and for the mark of the period

const canvas = document.getElementById("pulse-preview");
const note = document.getElementById("pulse-note");

let known = null; // descriptions of the pulses by name
let chosen = null;

/** Show a pulse by its name; an unknown one clears the preview. */
export async function showPreview(name) {
  chosen = name;
  try {
    known ??= await load();
  } catch {
    return; // the form works without a preview
  }
  draw();
}

async function load() {
  const { pulses } = await ask("/v1/pulses", { samples: SAMPLES }, new AbortController().signal);
  return new Map(pulses.map((one) => [one.name, one]));
}

function draw() {
  const pulse = isSampled(chosen) ? ownOf(chosen) : known?.get(chosen.replace(/^-/, ""));
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
  const room = ROOM * textScale();
  const x = (time) => room + (time / span) * (width - 2 * room);
  const middle = (height - room) / 2;
  const y = (value) => middle - sign * value * (middle - 5);
  line(context, [[0, middle], [width, middle]], themed("line"), 1);
  const points = pulse.time.map((time, at) => [x(time), y(pulse.acceleration[at])]);
  const ends = [points[0][0], points.at(-1)[0]].map((place) => [place, middle]);
  line(context, [[0, middle], ends[0], ...points, ends[1], [width, middle]], themed("accent"), 2);
  const start = Math.max((pulse.duration - 1) / 2, 0); // the period is marked in the middle of a long pulse
  drawPeriod(context, x(start), x(start + 1), height - 6 * textScale());
}

/** The description of samples over one period, scaled to the peak 1. */
function ownOf(samples) {
  const values = samples.split(" ").map(Number);
  const peak = Math.max(...values.map(Math.abs)) || 1;
  const time = values.map((_, at) => at / Math.max(values.length - 1, 1));
  return { time, acceleration: values.map((value) => value / peak), duration: 1, definition: "Linear between the samples." };
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
