// The block on its ground, to scale: one frame of the film on a canvas.

import { onTheme, themed } from "./colours.js";
import { frameAt, reachOf } from "./film.js";
import { length, number } from "./words.js";

const canvas = document.getElementById("stage");
const FARTHEST = 7; // ways of the ground in half diagonals that the picture still holds; beyond, the eye goes along

const MARGIN = 0.6;

let shown = null;

/** Show a film at a time; `size` (or null) gives the half diagonal in metres for the bar. */
export function showFrame(film, size, tau) {
  if (shown?.film !== film) {
    const rides = Math.max(...film.ground) - Math.min(...film.ground) > FARTHEST;
    shown = { film, rides, reach: reachOf(film, rides) };
  }
  Object.assign(shown, { size, tau });
  draw();
}

function draw() {
  if (!shown || !canvas.clientWidth) return;
  const { film, size, tau, rides, reach } = shown;
  const ratio = devicePixelRatio;
  canvas.width = Math.round(canvas.clientWidth * ratio);
  canvas.height = Math.round(canvas.clientHeight * ratio);
  const pen = canvas.getContext("2d");
  pen.fillStyle = themed("paper");
  pen.fillRect(0, 0, canvas.width, canvas.height);
  const { angle, ground } = frameAt(film, tau);
  canvas.dataset.angle = angle.toFixed(6);
  canvas.dataset.ground = ground.toFixed(6);

  // all in half diagonals R from here on: x to the right, y upwards from the ground
  const [left, right] = reach;
  const unit = Math.min(canvas.width / (right - left + MARGIN), (canvas.height - 46 * ratio) / 2.25);
  const base = canvas.height - 40 * ratio;
  const eye = (left + right) / 2 + (rides ? ground : 0);
  pen.setTransform(unit, 0, 0, -unit, canvas.width / 2 - eye * unit, base);
  const half = canvas.width / 2 / unit;
  drawGround(pen, ground, eye, half, ratio / unit);
  drawBlock(pen, film.alpha, angle, ground, ratio / unit);
  pen.setTransform(1, 0, 0, 1, 0, 0);
  drawBar(pen, unit, size, ratio);
}

/** The ground carries marks that move with it; the posts below stand still. */
function drawGround(pen, ground, eye, half, px) {
  const [left, right] = [eye - half, eye + half];
  pen.fillStyle = themed("ground");
  pen.fillRect(left, -9 * px, 2 * half, 9 * px);
  pen.strokeStyle = themed("muted");
  pen.lineWidth = 1.5 * px;
  stroke(pen, [left, 0], [right, 0]);
  pen.lineWidth = px;
  for (let n = Math.ceil((left - ground) / 0.25); ground + n * 0.25 <= right; n += 1) {
    const x = ground + n * 0.25;
    stroke(pen, [x, 0], [x - 7 * px, -9 * px]);
  }
  for (let n = Math.ceil(left); n <= right; n += 1) stroke(pen, [n, -12 * px], [n, -17 * px]);
}

function drawBlock(pen, alpha, angle, ground, px) {
  const [b, h] = [Math.sin(alpha), Math.cos(alpha)];
  const side = angle >= 0 ? 1 : -1; // positive is clockwise: about the right corner
  pen.save();
  pen.translate(ground + side * b, 0);
  pen.rotate(-angle);
  pen.translate(-side * b, 0);
  pen.fillStyle = themed("stone");
  pen.strokeStyle = themed("ink");
  pen.lineWidth = 1.5 * px;
  pen.lineJoin = "round";
  pen.beginPath();
  pen.rect(-b, 0, 2 * b, 2 * h);
  pen.fill();
  pen.stroke();
  // the radius from the corner to the centre of mass: the block is beyond alpha where it leans outwards
  pen.strokeStyle = pen.fillStyle = themed("accent");
  pen.lineWidth = px;
  stroke(pen, [side * b, 0], [0, h]);
  for (const [x, y, size] of [[0, h, 3.5], [side * b, 0, 2.5]]) {
    pen.beginPath();
    pen.arc(x, y, size * px, 0, 2 * Math.PI);
    pen.fill();
  }
  pen.restore();
}

function drawBar(pen, unit, size, ratio) {
  const metres = size ? size.R : 1;
  const bar = roundLength((70 * ratio * metres) / unit);
  const text = size ? length(bar) : `${number(bar)} R`;
  const [x, y] = [12 * ratio, canvas.height - 10 * ratio];
  pen.strokeStyle = pen.fillStyle = themed("ink");
  pen.lineWidth = 2 * ratio;
  stroke(pen, [x, y], [x + (bar * unit) / metres, y]);
  pen.font = `${12 * ratio}px system-ui, sans-serif`;
  pen.textBaseline = "middle";
  pen.fillText(text, x + (bar * unit) / metres + 7 * ratio, y);
}

function roundLength(wanted) {
  const power = 10 ** Math.floor(Math.log10(wanted));
  return power * [5, 2, 1].find((factor) => factor * power <= wanted);
}

function stroke(pen, from, to) {
  pen.beginPath();
  pen.moveTo(...from);
  pen.lineTo(...to);
  pen.stroke();
}

new ResizeObserver(draw).observe(canvas);
onTheme(draw);
