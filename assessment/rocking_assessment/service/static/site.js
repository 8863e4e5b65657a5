// The block under pulses of every shape: the verdict at the PGA and PGV of the site, and the chart of those that overturn it.

import { send } from "/static/explorer/api.js";
import { chart, chartsReady, logAxis } from "/static/explorer/chart.js";
import { hatch, themed } from "/static/explorer/colours.js";
import { acceleration, factorLabel, length, number, percentMore, pulseName, threshold, velocity } from "/static/explorer/labels.js";
import { element } from "/static/explorer/page.js";
import { pane } from "/static/explorer/pane.js";
import { drawLabel } from "/static/explorer/text.js";
import { inShown, shown, toSI, written } from "/static/explorer/units.js";

const NODES = 25;
const RATIOS = [0.02, 1.5]; // of PGV to PGA over the chart [s]

const box = document.querySelector("#site .picture");
const answer = document.getElementById("site-answer");
const place = document.getElementById("envelope");
const caption = document.getElementById("envelope-caption");

let site = null; // PGA [m/s2] and PGV [m/s]
let verdict = null; // the row of the block in the assessment

const assessment = pane({
  box,
  status: document.getElementById("site-status"),
  doing: "Assessing the block …",
  delay: 200,
  draw: showVerdict,
  clear: () => {
    answer.replaceChildren();
    answer.dataset.verdict = "";
  },
});
const envelope = pane({
  box: place,
  status: document.getElementById("envelope-status"),
  doing: "Computing the chart …",
  delay: 300,
  draw: drawEnvelope,
  clear: () => {},
});

/** Show the block of a state; null: there is none, or it cannot be read. */
export async function showSite(state) {
  const section = document.getElementById("site");
  if (!state) {
    assessment.wait({ idle: true });
    envelope.wait({ idle: true });
    return;
  }
  section.hidden = state.width === "";
  if (section.hidden) return;
  const [width, height, pga, pgv] = ["width", "height", "acceleration", "velocity"].map((name) => toSI(name, state[name]));
  const momentum = state.restitution === "momentum";
  const object = { width, height, ...(momentum ? {} : { restitution: Number(state.restitution) }) };
  site = { pga, pgv };
  const key = JSON.stringify([object, site, shown]);
  const found = await assessment.show(key, assessed([{ ...object, name: "block" }], true));
  if (found) envelope.show(key, assessed(similar(object), false));
  else envelope.nothing();
}

function assessed(objects, sensitivity) {
  return async function* load(signal) {
    await chartsReady();
    const body = new Blob([JSON.stringify(objects)], { type: "application/json" });
    yield await send("/v1/assess", { ...site, sensitivity }, body, signal);
  };
}

/** Ratios of PGV to PGA [s], that of the site among them. */
function ratios() {
  const [low, high] = RATIOS;
  const even = Array.from({ length: NODES }, (_, at) => low * (high / low) ** (at / (NODES - 1)));
  return [...even, site.pgv / site.pga].sort((one, other) => one - other);
}

/** A block m times as large under pulses of the site is this block under pulses whose periods are 1/sqrt(m) of theirs. */
function similar({ width, height, ...rest }) {
  return ratios().map((ratio, at) => {
    const times = (site.pgv / site.pga / ratio) ** 2;
    return { name: String(at), width: width * times, height: height * times, ...rest };
  });
}

function showVerdict({ rows: [row], motions, highest_factor: highest }) {
  verdict = row;
  const where = `at ${acceleration(site.pga)} and ${velocity(site.pgv)}`;
  const count = Math.round(row.share * motions.length);
  const words = overturningWords(Math.round(row.share_at_full_strength * motions.length), count, motions.length, where);
  const lines = [element("p", words, { class: `headline ${count ? "overturns" : ""}` }), element("p", changeOf(row, highest))];
  if (row.smallest_width) lines.push(element("p", `With a base of ${length(row.smallest_width, upwards)} or more at this height, none of them does.`));
  if (row.warnings) lines.push(element("p", `In doubt: ${row.warnings}.`, { class: "small" }));
  answer.replaceChildren(...lines);
  answer.dataset.verdict = row.verdict;
}

/** Under how many pulses the block overturns at full strength, and under how many only at a lower factor. */
function overturningWords(full, count, total, where) {
  if (count > full) return `At full strength it overturns under ${full} of ${total} pulse shapes ${where}, under ${count - full} more only at a lower factor.`;
  return full ? `It overturns under ${full} of ${total} pulse shapes ${where}.` : `None of ${total} pulse shapes overturns it ${where}.`;
}

const upwards = (value, digits = 3) => threshold(value, false, digits);

/** The nearest change: by how much the motion of the site would have to differ. */
function changeOf({ factor, governing }, highest) {
  if (factor === null) return `No factor up to ${number(highest)} on these motions was found to overturn it.`;
  const name = pulseName(governing);
  return factor > 1 ? `It overturns with ${percentMore(factor)} more (${name}).` : `The lowest factor that overturns it is ${threshold(factor)} (${name}).`;
}

/** PGA against PGV: hatched where a pulse of some shape overturns the block. */
function drawEnvelope({ rows }) {
  const known = ratios();
  const curve = rows
    .filter(({ factor }) => factor !== null)
    .map(({ object, factor }) => [factor * site.pga * known[object], factor * site.pga, known[object]])
    .sort((one, other) => one[2] - other[2])
    .map(([v, a]) => [inShown("velocity", v), inShown("acceleration", a)]);
  const here = [inShown("velocity", site.pgv), inShown("acceleration", site.pga)];
  const change = verdict.factor && here.map((value) => value * verdict.factor);
  const ranges = [0, 1].map((part) => {
    const values = [here, ...(change ? [change] : [])].map((one) => one[part]);
    const all = [...values, ...curve.map((one) => one[part])];
    return [Math.max(Math.min(...all), Math.min(...values) / 30) / 1.5, Math.min(Math.max(...all), 30 * Math.max(...values)) * 1.5];
  });
  const log = (range) => ({ time: false, distr: 3, range });
  chart(
    place,
    {
      height: 300,
      series: [{}, { paths: () => null, points: { show: false } }],
      axes: [
        logAxis(`PGV [${shown.velocity}]`, { size: 30 }),
        logAxis(`PGA [${written(shown.acceleration)}]`),
      ],
      scales: { x: log(ranges[0]), y: log(ranges[1]) },
      hooks: { draw: [(u) => drawRegion(u, curve), (u) => drawMarks(u, here, change)] },
    },
    [ranges[0], ranges[1]],
  );
  place.dataset.curve = JSON.stringify(curve);
  caption.textContent = "Hatched: pulses of at least one shape overturn the block. Ring: the site; diamond: the nearest change along its line.";
}

function drawRegion(u, curve) {
  if (!curve.length) return;
  const { ctx, bbox } = u;
  const points = curve.map(([v, a]) => [u.valToPos(v, "x", true), u.valToPos(a, "y", true)]);
  const [right, top] = [bbox.left + bbox.width, bbox.top];
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  trace(ctx, [...points, [right, points.at(-1)[1]], [right, top], [points[0][0], top]]);
  ctx.fillStyle = hatch(ctx, "OVERTURNED_AFTER_IMPACT", devicePixelRatio);
  ctx.fill();
  trace(ctx, points);
  ctx.strokeStyle = themed("accent");
  ctx.lineWidth = 2.5 * devicePixelRatio;
  ctx.stroke();
  ctx.restore();
}

function trace(ctx, points) {
  ctx.beginPath();
  points.forEach(([x, y], at) => (at ? ctx.lineTo(x, y) : ctx.moveTo(x, y)));
}

function drawMarks(u, here, change) {
  const { ctx } = u;
  const ratio = devicePixelRatio;
  const at = ([v, a]) => [u.valToPos(v, "x", true), u.valToPos(a, "y", true)];
  const [x, y] = at(here);
  ctx.save();
  ctx.strokeStyle = ctx.fillStyle = themed("ink");
  ctx.lineWidth = 2 * ratio;
  if (change) {
    const [cx, cy] = at(change);
    trace(ctx, [[x, y], [cx, cy]]);
    ctx.stroke();
    trace(ctx, [[cx - 6 * ratio, cy], [cx, cy - 6 * ratio], [cx + 6 * ratio, cy], [cx, cy + 6 * ratio]]);
    ctx.fill();
    drawLabel(ctx, factorLabel(verdict.factor), cx - 12 * ratio, cy, -1, ratio);
  }
  ctx.beginPath();
  ctx.arc(x, y, 7 * ratio, 0, 2 * Math.PI);
  ctx.fillStyle = themed("paper");
  ctx.strokeStyle = themed("ink");
  ctx.lineWidth = 2.4 * ratio;
  ctx.fill();
  ctx.stroke();
  ctx.restore();
}
