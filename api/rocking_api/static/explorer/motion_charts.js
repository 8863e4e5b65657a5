// Animation and charts of a time history: rotation and ground acceleration against one time.

import { axis, chart } from "./chart.js";
import { themed } from "./colours.js";
import { DRAWN_ALPHA, trajectoryOf } from "./trajectory.js";
import { repeat, seek, load } from "./player.js";
import { showFrame } from "./canvas.js";
import { OUTCOMES, number } from "./labels.js";
import { inShown, shown, written } from "./units.js";

const caption = document.getElementById("motion-caption");
const chartsCaption = document.getElementById("charts-caption");
const clock = document.getElementById("clock");
const containers = [document.getElementById("rotation"), document.getElementById("acceleration-chart")];

const SMALL = { space: 22 };

let charts = [];

/**
 * Show a time history: `history` in groups, as /v1/history gives it; `size` (or null) of a block in metres; `alpha_deg`;
 * `note`, a sentence before the outcome.
 */
export function drawMotion(history, { size, alpha_deg, note = "" }) {
  const alpha = alpha_deg > 0 ? (alpha_deg * Math.PI) / 180 : DRAWN_ALPHA;
  const trajectory = trajectoryOf(history, alpha);
  const units = size
    ? { time: 1 / size.p, angle: size.alpha * (180 / Math.PI), ground: inShown("acceleration", size.uplift) }
    : { time: 1, angle: 1, ground: 1 };
  drawCharts(history, units, Boolean(size));
  const notes = [note, `It ${OUTCOMES[history.outcome]}.`].filter(Boolean);
  if (!(alpha_deg > 0)) notes.push(`The slender limit has no shape; drawn with α = ${number((alpha * 180) / Math.PI)}°.`);
  if (history.outcome === "RECOVERS" && history.rotation.at(-1) !== 0) notes.push("The time history ends before it is at rest.");
  if (history.overturned) notes.push("The end of the overturning is drawn without ground motion.");
  caption.textContent = notes.join(" ");
  const tell = (tau) => {
    showFrame(trajectory, size, tau);
    for (const one of charts) moveCursor(one, tau * units.time);
    clock.textContent = size ? `${(tau * units.time).toFixed(2)} s` : `τ = ${tau.toFixed(2)}`;
    return clock.textContent;
  };
  load(trajectory.tau.at(-1), size, tell, true);
}

function drawCharts(history, units, dimensional) {
  const time = history.tau.map((tau) => tau * units.time);
  const rotation = history.rotation.map((y) => y * units.angle);
  const acceleration = history.ground_acceleration.map((u) => u * units.ground);
  const impacts = history.impact_time.map((tau) => tau * units.time);
  const names = dimensional
    ? ["time t [s]", "rotation θ [°]", `ground [${written(shown.acceleration)}]`]
    : ["time τ = p t", "rotation θ/α", "ground a f"];
  const marks = { draw: [(u) => drawLines(u, [-units.angle, units.angle]), (u) => drawImpacts(u, impacts)] };
  const lines = [(u) => drawLines(u, [-units.ground, units.ground]), () => (chartsCaption.textContent = lineNames(units))];
  charts = [];
  line(0, 220, [axis(null, { size: 24 }), axis(names[1], SMALL)], [time, rotation], units, marks);
  line(1, 150, [axis(names[0], { size: 26 }), axis(names[2], SMALL)], [time, acceleration], units, { draw: lines });
}

/** What the marks of the charts are; only those within the axes. */
function lineNames(units) {
  const visible = (one, height) => one && (one.scales.y.max >= height || one.scales.y.min <= -height);
  const dashed = [
    ...(visible(charts[0], units.angle) ? ["α, past which its weight turns it over"] : []),
    ...(visible(charts[1], units.ground) ? ["the acceleration that lifts it off"] : []),
  ];
  return `Circles: impacts. ${dashed.length ? `Dashed: ${dashed.join(", and ")}. ` : ""}Click a chart to go to that time.`;
}

function line(at, height, axes, data, units, drawn) {
  const series = [{}, { stroke: () => themed("accent"), width: 2, pxAlign: 0 }];
  const ready = (u) => {
    charts[at] = u;
    u.over.append(Object.assign(document.createElement("div"), { className: "cursor" }));
    u.over.addEventListener("click", (event) => seek(u.posToVal(event.offsetX, "x") / units.time));
    u.hooks.setSize = [repeat];
  };
  chart(containers[at], { height, axes, series, hooks: { ...drawn, ready: [ready] }, scales: { x: { time: false } } }, data);
}

function moveCursor(one, time) {
  const x = Math.min(one.valToPos(time, "x"), one.over.clientWidth);
  one.over.querySelector(".cursor").style.transform = `translateX(${x}px)`;
}

/** Dashed lines: alpha, beyond which the weight is destabilising, and the acceleration at which the block uplifts. */
function drawLines(u, heights) {
  const { ctx, bbox } = u;
  ctx.save();
  ctx.strokeStyle = themed("muted");
  ctx.lineWidth = devicePixelRatio;
  ctx.setLineDash([5 * devicePixelRatio, 4 * devicePixelRatio]);
  for (const height of heights) {
    const y = u.valToPos(height, "y", true);
    if (y < bbox.top || y > bbox.top + bbox.height) continue;
    ctx.beginPath();
    ctx.moveTo(bbox.left, y);
    ctx.lineTo(bbox.left + bbox.width, y);
    ctx.stroke();
  }
  ctx.restore();
}

function drawImpacts(u, impacts) {
  const { ctx, bbox } = u;
  const y = u.valToPos(0, "y", true);
  ctx.save();
  ctx.fillStyle = themed("paper");
  ctx.strokeStyle = themed("ink");
  ctx.lineWidth = 1.5 * devicePixelRatio;
  for (const time of impacts) {
    const x = u.valToPos(time, "x", true);
    if (x < bbox.left || x > bbox.left + bbox.width) continue;
    ctx.beginPath();
    ctx.arc(x, y, 3.5 * devicePixelRatio, 0, 2 * Math.PI);
    ctx.fill();
    ctx.stroke();
  }
  ctx.restore();
}
