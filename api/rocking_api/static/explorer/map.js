// The map of the control space: asks for its grid and its curves, draws them, and marks the chosen point.

import { ask, pause, urlOf } from "./api.js";
import { scale } from "./axes.js";
import { onTheme, themed } from "./colours.js";
import { MARGIN, MARGIN_OF_BLOCK, drawFrame } from "./map_frame.js";
import { drawPicture } from "./map_picture.js";
import { once, pane } from "./pane.js";

const COARSE = { columns: 120, rows: 90 };
const FINE = { columns: 400, rows: 240 };

const canvas = document.getElementById("map");
const over = document.getElementById("map-marks");

let wanted = null; // what the controls say: key, situation, view
let scene = null; // what is drawn: the same, and the grid
let traced = null; // boundaries, and the key of the groups that they belong to
let hovered = null;

const grid = pane({
  box: document.querySelector(".map"),
  status: document.getElementById("map-status"),
  doing: "Computing the map …",
  picture: "map",
  draw: (found) => {
    scene = { ...wanted, grid: found };
    draw();
    canvas.dataset.drawn = JSON.stringify(found.query);
  },
  clear: () => {
    scene = null;
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
    traced = { key: groupsOf(wanted.situation), curves: found.curves };
    draw();
    canvas.dataset.curves = JSON.stringify(found.query);
  },
  clear: () => {
    traced = null;
    draw();
    delete canvas.dataset.curves;
  },
});

/** Show the map of a situation in a window, coarse at first, and its boundaries; null: the situation is not known. */
export function showMap(situation, view, lasting) {
  if (!situation) {
    grid.wait({ lasting });
    boundaries.wait({ lasting });
    return;
  }
  const shape = shapeOf(situation);
  wanted = { key: JSON.stringify([shape, view, situation.size]), situation, view };
  if (scene?.key === wanted.key) {
    scene.situation = situation; // another point of the same map
    drawMarks();
  }
  grid.show(wanted.key, async function* load(signal) {
    yield await ask("/v1/map", { ...shape, ...view, ...COARSE }, signal);
    await pause(150, signal);
    yield await ask("/v1/map", { ...shape, ...view, ...FINE }, signal);
  });
  boundaries.show(groupsOf(situation), once("/v1/overturning", shape));
}

/** The question that the map answers, for a download. */
export function mapQuestion() {
  return { ...shapeOf(wanted.situation), ...wanted.view, ...FINE };
}

/** The address of the boundary curves. */
export function curvesUrl() {
  return urlOf("/v1/overturning", shapeOf(wanted.situation));
}

/** The point of the control space under a place of the canvas [px], or null outside the frame. */
export function pointAt(x, y) {
  if (!scene) return null;
  const { frame, scales } = layout(1);
  const inside = x >= frame.left && x <= frame.left + frame.width && y >= frame.top && y <= frame.top + frame.height;
  return inside ? { frequency_ratio: scales.x.value(x), slenderness: scales.y.value(y) } : null;
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
  const curves = traced?.key === groupsOf(scene.situation) ? traced.curves : null;
  drawPicture(pen, frame, scales, scene.grid, curves, ratio);
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
