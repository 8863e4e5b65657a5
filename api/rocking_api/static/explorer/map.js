// The map of the control space: requests its grid and its curves, draws them, and marks the chosen point.

import { ask, pause, urlOf } from "./api.js";
import { scale } from "./axes.js";
import { onTheme, themed } from "./colours.js";
import { factorLabel } from "./labels.js";
import { drawFrame, marginOf } from "./map_frame.js";
import { drawPicture } from "./map_picture.js";
import { once, pane } from "./pane.js";
import { drawLabel, onTextSize } from "./text.js";
import { shown } from "./units.js";

const COARSE = { columns: 120, rows: 90 };
const FINE = { columns: 400, rows: 240 };

const canvas = document.getElementById("map");
const over = document.getElementById("map-marks");

let wanted = null; // what the controls show: key, scenario, view
let drawn = null; // the same for what is drawn, and its grid
let traced = null; // boundary curves, and the key of their groups
let hovered = null;

const grid = pane({
  box: document.querySelector(".map"),
  status: document.getElementById("map-status"),
  doing: "Computing the map …",
  picture: "map",
  draw: (found) => {
    drawn = { ...wanted, grid: found };
    draw();
    canvas.dataset.drawn = JSON.stringify(found.query);
  },
  clear: () => {
    drawn = null;
    canvas.width = over.width = 0;
    delete canvas.dataset.drawn;
  },
});
const boundaries = pane({
  box: document.getElementById("curves-status"),
  status: document.getElementById("curves-status"),
  doing: "Tracing the boundaries …",
  delay: 250,
  draw: (found) => {
    traced = { key: groupsOf(wanted.scenario), curves: found.curves };
    draw();
    canvas.dataset.curves = JSON.stringify(found.query);
  },
  clear: () => {
    traced = null;
    draw();
    delete canvas.dataset.curves;
  },
});

/** Show the map of a scenario in a window, coarse first, and its boundary curves; null: the scenario is unknown. */
export function showMap(scenario, view, idle) {
  if (!scenario) {
    grid.wait({ idle });
    boundaries.wait({ idle });
    return;
  }
  const shape = shapeOf(scenario);
  wanted = { key: JSON.stringify([shape, view, scenario.size, shown]), scenario, view };
  if (drawn?.key === wanted.key) {
    drawn.scenario = scenario; // another point of the same map
    drawMarks();
  }
  grid.show(wanted.key, async function* load(signal) {
    yield await ask("/v1/map", { ...shape, ...view, ...COARSE }, signal);
    await pause(150, signal);
    yield await ask("/v1/map", { ...shape, ...view, ...FINE }, signal);
  });
  boundaries.show(groupsOf(scenario), once("/v1/overturning", shape));
}

/** Parameters of the map, for a download. */
export function mapParams() {
  return { ...shapeOf(wanted.scenario), ...wanted.view, ...FINE };
}

/** The URL of the boundary curves. */
export function curvesUrl() {
  return urlOf("/v1/overturning", shapeOf(wanted.scenario));
}

/** The point of the control space at a position on the canvas [px], or null outside the frame. */
export function pointAt(x, y) {
  if (!drawn) return null;
  const { frame, scales } = layout(1);
  const inside = x >= frame.left && x <= frame.left + frame.width && y >= frame.top && y <= frame.top + frame.height;
  return inside ? { frequency_ratio: scales.x.value(x), slenderness: scales.y.value(y) } : null;
}

/** Distances on the canvas [px] as shares of the sides of the frame, to the right and down; null without a map. */
export function sharesOf(dx, dy) {
  if (!drawn) return null;
  const { frame } = layout(1);
  return { across: dx / frame.width, down: dy / frame.height };
}

/** Mark a point under the pointer, or none. */
export function hover(point) {
  hovered = point;
  if (drawn) drawMarks();
}

function shapeOf({ pulse, restitution, alpha_deg }) {
  return { pulse, restitution, alpha_deg };
}

function groupsOf(scenario) {
  return JSON.stringify(shapeOf(scenario));
}

function layout(ratio) {
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  const margin = marginOf(drawn.scenario.size, width);
  const frame = {
    left: margin.left * ratio,
    top: margin.top * ratio,
    width: (width - margin.left - margin.right) * ratio,
    height: (height - margin.top - margin.bottom) * ratio,
  };
  const { view } = drawn;
  const scales = {
    x: scale(view.frequency_ratio_min, view.frequency_ratio_max, frame.left, frame.left + frame.width, true),
    y: scale(view.slenderness_min, view.slenderness_max, frame.top, frame.top + frame.height), // the amplitude 1/s upwards
  };
  return { frame, scales };
}

function draw() {
  if (!drawn || !canvas.clientWidth) return;
  const ratio = devicePixelRatio;
  for (const part of [canvas, over]) {
    part.width = Math.round(canvas.clientWidth * ratio);
    part.height = Math.round(canvas.clientHeight * ratio);
  }
  const { frame, scales } = layout(ratio);
  const context = canvas.getContext("2d");
  context.fillStyle = themed("paper");
  context.fillRect(0, 0, canvas.width, canvas.height);
  const curves = traced?.key === groupsOf(drawn.scenario) ? traced.curves : null;
  drawPicture(context, frame, scales, drawn.grid, curves, ratio);
  drawFrame(context, frame, scales, drawn.scenario.size, ratio);
  drawMarks();
}

function drawMarks() {
  const ratio = devicePixelRatio;
  const { frame, scales } = layout(ratio);
  const context = over.getContext("2d");
  context.clearRect(0, 0, over.width, over.height);
  if (hovered) drawCross(context, frame, scales, hovered, ratio);
  const { point, change } = drawn.scenario;
  if (change) drawDiamond(context, frame, scales, point, change, ratio);
  if (point) drawRing(context, frame, scales, point, ratio);
}

function drawCross(context, frame, scales, point, ratio) {
  const sharp = (place) => Math.floor(place) + 0.5;
  const [x, y] = [sharp(scales.x.place(point.frequency_ratio)), sharp(scales.y.place(point.slenderness))];
  context.beginPath();
  context.moveTo(frame.left, y);
  context.lineTo(frame.left + frame.width, y);
  context.moveTo(x, frame.top);
  context.lineTo(x, frame.top + frame.height);
  for (const [colour, width] of [["#ffffff", 2.5], ["#111111", 1]]) strokeIn(context, colour, width * ratio);
}

function drawRing(context, frame, scales, point, ratio) {
  const x = scales.x.place(point.frequency_ratio);
  const y = Math.min(scales.y.place(point.slenderness), frame.top + frame.height); // weaker than the window: at its lower edge
  if (x < frame.left || x > frame.left + frame.width || y < frame.top) return;
  context.beginPath();
  context.arc(x, y, 8 * ratio, 0, 2 * Math.PI);
  for (const [colour, width] of [["#ffffff", 6], ["#111111", 2.4]]) strokeIn(context, colour, width * ratio);
}

/** The nearest change of the outcome at the period of the point, with the factor on its acceleration. */
function drawDiamond(context, frame, scales, { frequency_ratio, slenderness }, change, ratio) {
  const [x, y] = [scales.x.place(frequency_ratio), scales.y.place(change)];
  if (x < frame.left || x > frame.left + frame.width || y < frame.top || y > frame.top + frame.height) return;
  const half = 7 * ratio;
  context.beginPath();
  context.moveTo(x - half, y);
  for (const [dx, dy] of [[0, -half], [half, 0], [0, half]]) context.lineTo(x + dx, y + dy);
  context.closePath();
  for (const [colour, width] of [["#ffffff", 5], ["#111111", 2]]) strokeIn(context, colour, width * ratio);
  const onRight = x < frame.left + frame.width / 2;
  const side = onRight ? 1 : -1;
  drawLabel(context, factorLabel(slenderness / change), x + 2 * side * half, y, side, ratio);
}

/** White under black is visible on every colour of the map. */
function strokeIn(context, colour, width) {
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.stroke();
}

new ResizeObserver(draw).observe(canvas);
onTheme(draw);
onTextSize(draw);
