// The picture of the map: peaks as colour, outcomes as hatches, boundary curves over both.

import { colourOfPeak, hatch, themed } from "./colours.js";

/** Draw `grid` (an answer of /v1/map, or null) and `curves` (of /v1/overturning, or null) into a frame of a canvas. */
export function drawPicture(context, frame, scales, grid, curves, ratio) {
  context.save();
  context.beginPath();
  context.rect(frame.left, frame.top, frame.width, frame.height);
  context.clip();
  if (grid) {
    drawColours(context, scales, grid);
    for (const outcome of ["OVERTURNED_DIRECTLY", "OVERTURNED_AFTER_IMPACT"]) drawOutcome(context, scales, grid, outcome, ratio);
  }
  for (const curve of curves ?? []) drawCurve(context, scales, curve, ratio);
  drawLimit(context, frame, scales, ratio);
  context.restore();
}

function drawColours(context, scales, grid) {
  const recovers = grid.outcomes.indexOf("RECOVERS");
  drawCells(context, scales, grid, (at) => (grid.outcome[at] === recovers ? colourOfPeak(grid.peak_rotation[at]) : null));
}

function drawOutcome(context, scales, grid, outcome, ratio) {
  const code = grid.outcomes.indexOf(outcome);
  const mask = new OffscreenCanvas(context.canvas.width, context.canvas.height);
  const inner = mask.getContext("2d");
  drawCells(inner, scales, grid, (at) => (grid.outcome[at] === code ? [0, 0, 0] : null));
  inner.globalCompositeOperation = "source-in";
  inner.fillStyle = hatch(inner, outcome, ratio);
  inner.fillRect(0, 0, mask.width, mask.height);
  context.drawImage(mask, 0, 0);
}

/** One rectangle per point of the grid, which is its centre. */
function drawCells(context, scales, grid, colourAt) {
  const [columns, rows] = [grid.frequency_ratio.length, grid.slenderness.length];
  const small = new OffscreenCanvas(columns, rows);
  const inner = small.getContext("2d");
  const image = inner.createImageData(columns, rows);
  for (let row = 0; row < rows; row += 1) {
    for (let column = 0; column < columns; column += 1) {
      const colour = colourAt(row * columns + column);
      if (colour) image.data.set([...colour, 255], 4 * (row * columns + column)); // slenderness runs downwards
    }
  }
  inner.putImageData(image, 0, 0);
  const left = scales.x.place(grid.frequency_ratio[0]);
  const right = scales.x.place(grid.frequency_ratio[columns - 1]);
  const top = scales.y.place(grid.slenderness[0]);
  const bottom = scales.y.place(grid.slenderness[rows - 1]);
  const [wide, high] = [(right - left) / (columns - 1), (bottom - top) / (rows - 1)];
  context.imageSmoothingEnabled = false;
  context.drawImage(small, left - wide / 2, top - high / 2, right - left + wide, bottom - top + high);
}

function drawCurve(context, scales, curve, ratio) {
  context.beginPath();
  curve.frequency_ratio.forEach((omega, at) => {
    const [x, y] = [scales.x.place(omega), scales.y.place(curve.slenderness[at])];
    if (at) context.lineTo(x, y);
    else context.moveTo(x, y);
  });
  context.lineJoin = "round";
  for (const [colour, width] of [["paper", 3.6], ["ink", 1.8]]) {
    context.strokeStyle = themed(colour);
    context.lineWidth = width * ratio;
    context.stroke();
  }
}

/** From 1/a = 1 on the block does not uplift. */
function drawLimit(context, frame, scales, ratio) {
  const y = scales.y.place(1);
  context.strokeStyle = themed("muted");
  context.lineWidth = ratio;
  context.beginPath();
  context.moveTo(frame.left, y);
  context.lineTo(frame.left + frame.width, y);
  context.stroke();
}
