// The time history of the chosen block: its film, its rotation and the ground under it, one clock for all.

import { urlOf } from "./api.js";
import { axis, chart } from "./chart.js";
import { themed } from "./colours.js";
import { DRAWN_ALPHA, filmOf } from "./film.js";
import { once, pane } from "./pane.js";
import { repeat, seek, unwind, wind } from "./player.js";
import { caveatOf } from "./situation.js";
import { showFrame } from "./stage.js";
import { FATES, number } from "./words.js";

const section = document.getElementById("motion");
const caption = document.getElementById("motion-caption");
const clock = document.getElementById("clock");
const places = [document.getElementById("rotation"), document.getElementById("acceleration-chart")];

const SMALL = { space: 22 };

let asked = null; // the situation
let charts = [];
const motion = pane({
  box: section.querySelector(".motion"),
  status: document.getElementById("motion-status"),
  doing: "Computing the time history …",
  delay: 120,
  picture: "motion",
  draw: (history) => show(history, asked),
  clear: unwind,
});

/** Show the motion at the point of a situation; nothing without one; null: the situation is not known. */
export function showMotion(situation, lasting) {
  if (!situation) return motion.wait({ lasting });
  section.classList.toggle("empty", !situation.point);
  if (!situation.point) return motion.nothing();
  asked = situation;
  const question = motionQuestion(situation);
  return motion.show(JSON.stringify([question, situation.size]), once("/v1/history", question));
}

/** The question that the charts answer, for a download. */
export function motionQuestion({ pulse, restitution, alpha_deg, point }) {
  return { pulse, restitution, alpha_deg, ...point, samples: 800 };
}

/** The address of the motion with all its digits, in a form. */
export function motionUrl(situation, format) {
  return urlOf("/v1/history", { ...motionQuestion(situation), format });
}

function show(history, situation) {
  const { size, alpha_deg } = situation;
  const alpha = alpha_deg > 0 ? (alpha_deg * Math.PI) / 180 : DRAWN_ALPHA;
  const film = filmOf(history, alpha);
  const units = size
    ? { time: 1 / size.p, angle: size.alpha * (180 / Math.PI), ground: size.uplift_in_g }
    : { time: 1, angle: 1, ground: 1 };
  drawCharts(history, units, Boolean(size));
  const notes = [caveatOf(situation), `It ${FATES[history.outcome]}.`].filter(Boolean);
  if (!(alpha_deg > 0)) notes.push(`The slender limit has no shape; drawn with α = ${number((alpha * 180) / Math.PI)}°.`);
  if (history.overturned) notes.push("The last part of the fall is drawn by gravity alone.");
  caption.textContent = notes.join(" ");
  const tell = (tau) => {
    showFrame(film, size, tau);
    for (const one of charts) moveCursor(one, tau * units.time);
    clock.textContent = size ? `${(tau * units.time).toFixed(2)} s` : `τ = ${tau.toFixed(2)}`;
    return clock.textContent;
  };
  wind(film.tau.at(-1), size, tell, true);
}

function drawCharts(history, units, dimensional) {
  const time = history.tau.map((tau) => tau * units.time);
  const rotation = history.rotation.map((y) => y * units.angle);
  const acceleration = history.ground_acceleration.map((u) => u * units.ground);
  const landings = history.impact_time.map((tau) => tau * units.time);
  const names = dimensional
    ? ["time t [s]", "rotation θ [°]", "ground [g]"]
    : ["time τ = p t", "rotation θ/α", "ground a f"];
  const marks = { draw: [(u) => drawLines(u, [-units.angle, units.angle]), (u) => drawImpacts(u, landings)] };
  charts = [
    line(places[0], 220, [axis(null, { size: 24 }), axis(names[1], SMALL)], [time, rotation], marks),
    line(places[1], 150, [axis(names[0], { size: 26 }), axis(names[2], SMALL)], [time, acceleration], {
      draw: [(u) => drawLines(u, [-units.ground, units.ground])],
    }),
  ];
  for (const one of charts) {
    one.over.addEventListener("click", (event) => seek(one.posToVal(event.offsetX, "x") / units.time));
    one.hooks.setSize = [repeat];
  }
}

function line(place, height, axes, data, hooks) {
  const series = [{}, { stroke: () => themed("accent"), width: 2, pxAlign: 0 }];
  const made = chart(place, { height, axes, series, hooks, scales: { x: { time: false } } }, data);
  made.over.append(Object.assign(document.createElement("div"), { className: "cursor" }));
  return made;
}

function moveCursor(one, time) {
  const x = Math.min(one.valToPos(time, "x"), one.over.clientWidth);
  one.over.querySelector(".cursor").style.transform = `translateX(${x}px)`;
}

/** Dashed: alpha, beyond which the weight overturns, and the acceleration that lifts the block off. */
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

function drawImpacts(u, landings) {
  const { ctx, bbox } = u;
  const y = u.valToPos(0, "y", true);
  ctx.save();
  ctx.fillStyle = themed("paper");
  ctx.strokeStyle = themed("ink");
  ctx.lineWidth = 1.5 * devicePixelRatio;
  for (const time of landings) {
    const x = u.valToPos(time, "x", true);
    if (x < bbox.left || x > bbox.left + bbox.width) continue;
    ctx.beginPath();
    ctx.arc(x, y, 3.5 * devicePixelRatio, 0, 2 * Math.PI);
    ctx.fill();
    ctx.stroke();
  }
  ctx.restore();
}
