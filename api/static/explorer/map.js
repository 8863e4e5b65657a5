// The map of the control space: asks for its grid and its curves, draws them, and marks the chosen point.

import { ask, urlOf } from "./api.js";
import { scale } from "./axes.js";
import { onTheme, themed } from "./colours.js";
import { MARGIN, MARGIN_OF_BLOCK, drawFrame } from "./map_frame.js";
import { drawPicture } from "./map_picture.js";
import { say, settled } from "./page.js";

const COARSE = { columns: 120, rows: 90 };
const FINE = { columns: 400, rows: 240 };

const canvas = document.getElementById("map");
const over = document.getElementById("map-marks");
const status = document.getElementById("map-status");

let scene = null; // what is shown: situation, view, grid, curves
let hovered = null;

/** Show the map of a situation in a window; sharpened, and given its boundaries, once it has settled. */
export function showMap(situation, view) {
  const same = scene && groupsOf(scene.situation) === groupsOf(situation);
  const inView = same && JSON.stringify(scene.view) === JSON.stringify(view);
  scene = { situation, view, grid: inView ? scene.grid : null, curves: same ? scene.curves : null };
  if (inView && scene.grid) draw();
  else load(scene, COARSE, "map");
  settled("fine map", 150, () => load(scene, FINE, "map"));
  if (!scene.curves) settled("curves", 250, () => loadCurves(scene));
}

/** The question that the map answers, for a download. */
export function mapQuestion() {
  return { ...shapeOf(scene.situation), ...scene.view, ...FINE };
}

/** The address of the boundary curves. */
export function curvesUrl() {
  return urlOf("/v1/overturning", shapeOf(scene.situation));
}

/** The point of the control space under a place of the canvas [px], or null outside the frame. */
export function pointAt(x, y) {
  if (!scene) return null;
  const { frame, scales } = layout(1);
  const inside = x >= frame.left && x <= frame.left + frame.width && y >= frame.top && y <= frame.top + frame.height;
  return inside ? { frequency_ratio: scales.x.value(x), slenderness: scales.y.value(y) } : null;
}

/** The point that lies some shares of the window's sides away. */
export function pointBeside(point, across, up) {
  const { frame, scales } = layout(1);
  const x = scales.x.place(point.frequency_ratio) + across * frame.width;
  const y = scales.y.place(point.slenderness) - up * frame.height;
  const within = (value, from, length) => Math.min(Math.max(value, from), from + length);
  return {
    frequency_ratio: scales.x.value(within(x, frame.left, frame.width)),
    slenderness: scales.y.value(within(y, frame.top, frame.height)),
  };
}

/** The point in the middle of the window. */
export function middle() {
  const { frame, scales } = layout(1);
  return {
    frequency_ratio: scales.x.value(frame.left + frame.width / 2),
    slenderness: scales.y.value(frame.top + frame.height / 2),
  };
}

/** Mark a point under the pointer, or none. */
export function hover(point) {
  hovered = point;
  if (scene) drawMarks();
}

function shapeOf({ pulse, restitution, alpha_deg }) {
  return { pulse, restitution, alpha_deg };
}

function groupsOf(situation) {
  return JSON.stringify(shapeOf(situation));
}

async function load(wanted, size, channel) {
  if (wanted !== scene) return;
  if (!wanted.grid) say(status, "Drawing the map …");
  try {
    const grid = await ask(channel, "/v1/map", { ...shapeOf(wanted.situation), ...wanted.view, ...size });
    if (!grid || wanted !== scene) return;
    wanted.grid = grid;
    draw();
    canvas.dataset.drawn = JSON.stringify({ ...grid.query, curves: wanted.curves?.length ?? 0 });
    if (wanted.curves) say(status, "");
  } catch (problem) {
    say(status, problem);
  }
}

async function loadCurves(wanted) {
  if (wanted !== scene) return;
  say(status, "Tracing the boundaries …");
  try {
    const found = await ask("curves", "/v1/overturning", shapeOf(wanted.situation));
    if (!found || groupsOf(wanted.situation) !== groupsOf(scene.situation)) return;
    scene.curves = found.curves;
    draw();
    canvas.dataset.curves = JSON.stringify(found.query);
    say(status, "");
  } catch (problem) {
    say(status, problem);
  }
}

function layout(ratio) {
  const margin = scene.situation.size ? MARGIN_OF_BLOCK : MARGIN;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  const frame = {
    left: margin.left * ratio,
    top: margin.top * ratio,
    width: (width - margin.left - margin.right) * ratio,
    height: (height - margin.top - margin.bottom) * ratio,
  };
  const { view } = scene;
  const scales = {
    x: scale(view.frequency_ratio_min, view.frequency_ratio_max, frame.left, frame.left + frame.width, true),
    y: scale(view.slenderness_min, view.slenderness_max, frame.top + frame.height, frame.top),
  };
  return { frame, scales };
}

function draw() {
  if (!scene || !canvas.clientWidth) return;
  const ratio = devicePixelRatio;
  for (const part of [canvas, over]) {
    part.width = Math.round(canvas.clientWidth * ratio);
    part.height = Math.round(canvas.clientHeight * ratio);
  }
  const { frame, scales } = layout(ratio);
  const pen = canvas.getContext("2d");
  pen.fillStyle = themed("paper");
  pen.fillRect(0, 0, canvas.width, canvas.height);
  drawPicture(pen, frame, scales, scene.grid, scene.curves, ratio);
  drawFrame(pen, frame, scales, scene.situation.size, ratio);
  drawMarks();
}

function drawMarks() {
  const ratio = devicePixelRatio;
  const { frame, scales } = layout(ratio);
  const pen = over.getContext("2d");
  pen.clearRect(0, 0, over.width, over.height);
  if (hovered) drawCross(pen, frame, scales, hovered, ratio);
  const { point } = scene.situation;
  if (point) drawRing(pen, frame, scales, point, ratio);
}

function drawCross(pen, frame, scales, point, ratio) {
  const sharp = (place) => Math.floor(place) + 0.5;
  const [x, y] = [sharp(scales.x.place(point.frequency_ratio)), sharp(scales.y.place(point.slenderness))];
  pen.beginPath();
  pen.moveTo(frame.left, y);
  pen.lineTo(frame.left + frame.width, y);
  pen.moveTo(x, frame.top);
  pen.lineTo(x, frame.top + frame.height);
  for (const [colour, width] of [["#ffffff", 2.5], ["#111111", 1]]) strokeIn(pen, colour, width * ratio);
}

function drawRing(pen, frame, scales, point, ratio) {
  const x = scales.x.place(point.frequency_ratio);
  const y = Math.max(scales.y.place(point.slenderness), frame.top); // above the window: at its upper edge
  if (x < frame.left || x > frame.left + frame.width || y > frame.top + frame.height) return;
  pen.beginPath();
  pen.arc(x, y, 8 * ratio, 0, 2 * Math.PI);
  for (const [colour, width] of [["#ffffff", 6], ["#111111", 2.4]]) strokeIn(pen, colour, width * ratio);
}

/** White under black is seen on every colour of the map. */
function strokeIn(pen, colour, width) {
  pen.strokeStyle = colour;
  pen.lineWidth = width;
  pen.stroke();
}

new ResizeObserver(draw).observe(canvas);
onTheme(draw);
