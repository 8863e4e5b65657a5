// The response over the scale of a record: peak rotation, and where the block overturns.

import { axis, chart, logAxis, markValue } from "./chart.js";
import { hatch, themed } from "./colours.js";
import { number, threshold, thresholds as rounded } from "./labels.js";

const LISTED = 8; // thresholds named in the caption

const place = document.getElementById("scales-chart");
const caption = document.getElementById("scales-caption");

/** Draw the response of /v1/records/scales; `answer` is the response at the factor of the form. */
export function drawScales(found, answer) {
  const { scale } = answer.query;
  chart(
    place,
    {
      height: 260,
      series: [{}, { stroke: () => themed("accent"), width: 2, spanGaps: false, pxAlign: 0 }],
      axes: [
        logAxis("factor of the record", { size: 30 }),
        axis("peak rotation θ/α"),
      ],
      scales: {
        x: { time: false, distr: 3, range: (_, low, high) => [low, high] },
        y: { range: (_, low, high) => [0, Math.max(1.1, (high ?? 0) * 1.1)] },
      },
      hooks: {
        drawClear: [(u) => shade(u, found)],
        draw: [(u) => markValue(u, scale)],
        setCursor: [({ cursor }) => (caption.textContent = readout(found, answer, cursor.idx))],
      },
    },
    [found.scale, found.peak_rotation],
  );
  caption.textContent = readout(found, answer, null);
}

/** Mark on the bar below the slider, from 0.1 to 10, the factors that overturn the block; null clears it. */
export function markFactors(found) {
  const place = (factor) => `${(50 + 50 * Math.log10(factor)).toFixed(2)}%`;
  const colour = (overturns) => (overturns ? "var(--wrong)" : "transparent");
  const stops = (found?.thresholds ?? []).flatMap((one) => [!one.overturns_above, one.overturns_above].map((on) => `${colour(on)} ${place(one.scale)}`));
  const last = found?.thresholds.at(-1)?.overturns_above ? `, var(--wrong) ${place(found.scale.at(-1))}, transparent 0` : "";
  document.getElementById("factor-marks").style.background = stops.length ? `linear-gradient(to right, ${stops.join()}${last})` : "";
}

function readout(found, answer, at) {
  if (at !== null && at !== undefined) {
    const peak = found.overturned[at] ? "overturns" : `peak ${number(found.peak_rotation[at])} α`;
    return `Factor ${number(found.scale[at])}, ${number(found.peak_acceleration[at] / 9.80665)} g: ${peak}`;
  }
  return `${changes(found)} Hatched: the block overturns; dashed: the factor ${number(answer.query.scale)}. The slider has a red bar below these factors.`;
}

/** Every factor at which the outcome changes, in words. */
export function changes({ thresholds, scale }) {
  if (!thresholds.length) return `No factor up to ${threshold(scale.at(-1))} was found to overturn it.`;
  const first = thresholds.slice(0, LISTED);
  const texts = rounded(first.map((one) => [one.scale, one.overturns_above]), 4);
  const listed = first.map((one, at) => `${one.overturns_above ? "overturns" : "survives"} from ${texts[at]}`);
  const rest = thresholds.length - listed.length;
  return `It ${listed.join(", ")}${rest ? `, and ${rest} more changes` : ""}.`;
}

/** Hatch the factors at which the block overturns. */
function shade(u, { thresholds, scale }) {
  const { ctx, bbox } = u;
  ctx.save();
  ctx.fillStyle = hatch(ctx, "OVERTURNED_AFTER_IMPACT", devicePixelRatio);
  thresholds.forEach((one, at) => {
    if (!one.overturns_above) return;
    const left = u.valToPos(Math.max(one.scale, scale[0]), "x", true);
    const right = u.valToPos(thresholds[at + 1]?.scale ?? scale.at(-1), "x", true);
    ctx.fillRect(left, bbox.top, right - left, bbox.height);
  });
  ctx.restore();
}
