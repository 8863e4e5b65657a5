// Fragility of one block: counts with their intervals, the fitted curve, and the counts from the first level on.

import { axis, chart, logAxis } from "./chart.js";
import { themed } from "./colours.js";

/** Draw one limit state of a block of /v1/suites/{name} in `place`. */
export function drawFragility(place, { intensity, quantity, records }, state) {
  const curve = state.curves.find(({ model }) => model === "lognormal");
  const first = state.first_exceedances.map((count) => count / records.length);
  chart(
    place,
    {
      height: 240,
      series: [
        {},
        { stroke: () => themed("ink"), width: 0, points: { show: true, size: 7, fill: () => themed("ink") } },
        { stroke: () => themed("accent"), width: 2, pxAlign: 0, points: { show: false } },
        { stroke: () => themed("muted"), width: 1.5, dash: [2, 4], points: { show: false } },
      ],
      axes: [
        logAxis(quantity, { size: 30 }),
        axis("share of the records"),
      ],
      scales: { x: { time: false, distr: 3, range: (_, low, high) => [low, high] }, y: { range: [0, 1.02] } },
      hooks: { drawClear: [(u) => intervals(u, intensity, state)] },
    },
    [intensity, state.fraction, curve.fitted, first],
  );
}

/** Vertical bars from the lower to the upper end of each interval. */
function intervals(u, intensity, { fraction_lower: low, fraction_upper: high }) {
  const { ctx } = u;
  ctx.save();
  ctx.strokeStyle = themed("muted");
  ctx.lineWidth = devicePixelRatio;
  intensity.forEach((level, at) => {
    const x = u.valToPos(level, "x", true);
    ctx.beginPath();
    ctx.moveTo(x, u.valToPos(low[at], "y", true));
    ctx.lineTo(x, u.valToPos(high[at], "y", true));
    ctx.stroke();
  });
  ctx.restore();
}
