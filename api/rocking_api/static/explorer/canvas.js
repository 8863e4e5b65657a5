// The block on the ground, to scale: one frame of the trajectory on the canvas.

import { onTheme, themed } from "./colours.js";
import { frameAt, horizontalExtent } from "./trajectory.js";
import { length, number } from "./labels.js";
import { fontOf, onTextSize, textScale } from "./text.js";

const canvas = document.getElementById("stage");
const MAX_GROUND_TRAVEL = 7; // half diagonals; for a larger ground displacement the view moves with the ground

const MARGIN = 0.6;
const FOOT = 40; // [px] below the ground, of text that is usually 16 px

let shown = null;

/** Show a trajectory at a time; `size` (or null) gives the half diagonal in metres for the scale bar. */
export function showFrame(trajectory, size, tau) {
  if (shown?.trajectory !== trajectory) {
    const followsGround = Math.max(...trajectory.ground) - Math.min(...trajectory.ground) > MAX_GROUND_TRAVEL;
    shown = { trajectory, followsGround, extent: horizontalExtent(trajectory, followsGround) };
  }
  Object.assign(shown, { size, tau });
  draw();
}

function draw() {
  if (!shown || !canvas.clientWidth) return;
  const { trajectory, size, tau, followsGround, extent } = shown;
  const ratio = devicePixelRatio;
  canvas.width = Math.round(canvas.clientWidth * ratio);
  canvas.height = Math.round(canvas.clientHeight * ratio);
  const context = canvas.getContext("2d");
  context.fillStyle = themed("paper");
  context.fillRect(0, 0, canvas.width, canvas.height);
  const { angle, ground } = frameAt(trajectory, tau);
  canvas.dataset.angle = angle.toFixed(6);
  canvas.dataset.ground = ground.toFixed(6);

  // all in half diagonals R from here on: x to the right, y upwards from the ground
  const [left, right] = extent;
  const unit = Math.min(canvas.width / (right - left + MARGIN), (canvas.height - (FOOT * textScale() + 6) * ratio) / 2.25);
  const base = canvas.height - FOOT * textScale() * ratio;
  const centre = (left + right) / 2 + (followsGround ? ground : 0);
  context.setTransform(unit, 0, 0, -unit, canvas.width / 2 - centre * unit, base);
  const half = canvas.width / 2 / unit;
  drawGround(context, ground, centre, half, ratio / unit);
  drawBlock(context, trajectory.alpha, angle, ground, ratio / unit);
  context.setTransform(1, 0, 0, 1, 0, 0);
  drawBar(context, unit, size, ratio);
}

/** Marks on the ground move with it; the ticks below are fixed in space. */
function drawGround(context, ground, centre, half, px) {
  const [left, right] = [centre - half, centre + half];
  context.fillStyle = themed("ground");
  context.fillRect(left, -9 * px, 2 * half, 9 * px);
  context.strokeStyle = themed("muted");
  context.lineWidth = 1.5 * px;
  stroke(context, [left, 0], [right, 0]);
  context.lineWidth = px;
  for (let n = Math.ceil((left - ground) / 0.25); ground + n * 0.25 <= right; n += 1) {
    const x = ground + n * 0.25;
    stroke(context, [x, 0], [x - 7 * px, -9 * px]);
  }
  for (let n = Math.ceil(left); n <= right; n += 1) stroke(context, [n, -12 * px], [n, -17 * px]);
}

function drawBlock(context, alpha, angle, ground, px) {
  const [b, h] = [Math.sin(alpha), Math.cos(alpha)];
  const side = angle >= 0 ? 1 : -1; // positive is clockwise: about the right corner
  context.save();
  context.translate(ground + side * b, 0);
  context.rotate(-angle);
  context.translate(-side * b, 0);
  context.fillStyle = themed("stone");
  context.strokeStyle = themed("ink");
  context.lineWidth = 1.5 * px;
  context.lineJoin = "round";
  context.beginPath();
  context.rect(-b, 0, 2 * b, 2 * h);
  context.fill();
  context.stroke();
  // the radius from the corner to the centre of mass: the block is beyond alpha where it leans outwards
  context.strokeStyle = context.fillStyle = themed("accent");
  context.lineWidth = px;
  stroke(context, [side * b, 0], [0, h]);
  for (const [x, y, size] of [[0, h, 3.5], [side * b, 0, 2.5]]) {
    context.beginPath();
    context.arc(x, y, size * px, 0, 2 * Math.PI);
    context.fill();
  }
  context.restore();
}

function drawBar(context, unit, size, ratio) {
  const metres = size ? size.R : 1;
  const bar = roundLength((70 * ratio * metres) / unit);
  const text = size ? length(bar) : `${number(bar)} R`;
  const [x, y] = [12 * ratio, canvas.height - 10 * textScale() * ratio];
  context.strokeStyle = context.fillStyle = themed("ink");
  context.lineWidth = 2 * ratio;
  stroke(context, [x, y], [x + (bar * unit) / metres, y]);
  context.font = fontOf(12, ratio);
  context.textBaseline = "middle";
  context.fillText(text, x + (bar * unit) / metres + 7 * ratio, y);
}

function roundLength(wanted) {
  const power = 10 ** Math.floor(Math.log10(wanted));
  return power * [5, 2, 1].find((factor) => factor * power <= wanted);
}

function stroke(context, from, to) {
  context.beginPath();
  context.moveTo(...from);
  context.lineTo(...to);
  context.stroke();
}

new ResizeObserver(draw).observe(canvas);
onTheme(draw);
onTextSize(draw);
