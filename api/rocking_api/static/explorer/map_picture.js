// The picture of the map: peaks as colour, fates as hatches, the boundaries as exact curves over both.

import { colourOfPeak, hatch, themed } from "./colours.js";

/** Draw `grid` (an answer of /v1/map, or null) and `curves` (of /v1/overturning, or null) into a frame of a canvas. */
export function drawPicture(pen, frame, scales, grid, curves, ratio) {
  pen.save();
  pen.beginPath();
  pen.rect(frame.left, frame.top, frame.width, frame.height);
  pen.clip();
  if (grid) {
    drawColours(pen, scales, grid);
    for (const fate of ["OVERTURNED_DIRECTLY", "OVERTURNED_AFTER_IMPACT"]) drawFate(pen, scales, grid, fate, ratio);
  }
  for (const curve of curves ?? []) drawCurve(pen, scales, curve, ratio);
  drawLimit(pen, frame, scales, ratio);
  pen.restore();
}

function drawColours(pen, scales, grid) {
  const safe = grid.outcomes.indexOf("SAFE");
  drawCells(pen, scales, grid, (at) => (grid.outcome[at] === safe ? colourOfPeak(grid.peak_rotation[at]) : null));
}

function drawFate(pen, scales, grid, fate, ratio) {
  const code = grid.outcomes.indexOf(fate);
  const mask = new OffscreenCanvas(pen.canvas.width, pen.canvas.height);
  const inner = mask.getContext("2d");
  drawCells(inner, scales, grid, (at) => (grid.outcome[at] === code ? [0, 0, 0] : null));
  inner.globalCompositeOperation = "source-in";
  inner.fillStyle = hatch(inner, fate, ratio);
  inner.fillRect(0, 0, mask.width, mask.height);
  pen.drawImage(mask, 0, 0);
}

/** One rectangle per block asked about: each stands in the middle of its cell. */
function drawCells(pen, scales, grid, colourAt) {
  const [columns, rows] = [grid.frequency_ratio.length, grid.slenderness.length];
  const small = new OffscreenCanvas(columns, rows);
  const inner = small.getContext("2d");
  const image = inner.createImageData(columns, rows);
  for (let row = 0; row < rows; row += 1) {
    for (let column = 0; column < columns; column += 1) {
      const colour = colourAt(row * columns + column);
      // rows of the picture run downwards, slenderness upwards
      if (colour) image.data.set([...colour, 255], 4 * ((rows - 1 - row) * columns + column));
    }
  }
  inner.putImageData(image, 0, 0);
  const left = scales.x.place(grid.frequency_ratio[0]);
  const right = scales.x.place(grid.frequency_ratio[columns - 1]);
  const bottom = scales.y.place(grid.slenderness[0]);
  const top = scales.y.place(grid.slenderness[rows - 1]);
  const [wide, high] = [(right - left) / (columns - 1), (bottom - top) / (rows - 1)];
  pen.imageSmoothingEnabled = false;
  pen.drawImage(small, left - wide / 2, top - high / 2, right - left + wide, bottom - top + high);
}

function drawCurve(pen, scales, curve, ratio) {
  pen.beginPath();
  curve.frequency_ratio.forEach((omega, at) => {
    const [x, y] = [scales.x.place(omega), scales.y.place(curve.slenderness[at])];
    if (at) pen.lineTo(x, y);
    else pen.moveTo(x, y);
  });
  pen.lineJoin = "round";
  for (const [colour, width] of [["paper", 3.6], ["ink", 1.8]]) {
    pen.strokeStyle = themed(colour);
    pen.lineWidth = width * ratio;
    pen.stroke();
  }
}

/** From 1/a = 1 on the block does not uplift. */
function drawLimit(pen, frame, scales, ratio) {
  const y = scales.y.place(1);
  pen.strokeStyle = themed("muted");
  pen.lineWidth = ratio;
  pen.beginPath();
  pen.moveTo(frame.left, y);
  pen.lineTo(frame.left + frame.width, y);
  pen.stroke();
}
