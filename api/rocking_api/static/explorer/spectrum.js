// The rocking spectrum at the chosen slenderness: peak against frequency ratio, other restitutions beside it.

import { ask, urlOf } from "./api.js";
import { axis, chart, chartsReady, logAxis, markValue } from "./chart.js";
import { hatch, themed } from "./colours.js";
import { pane } from "./pane.js";
import { number } from "./labels.js";

const OTHERS = [0.8, 0.88, 0.96];
const DASHES = [["dotted", [1.5, 3]], ["dashed", [6, 4]], ["dashes and dots", [8, 3, 1.5, 3]]]; // of these, and what the caption calls them
const POINTS = 400;

const section = document.getElementById("spectrum");
const caption = document.getElementById("spectrum-caption");
const place = document.getElementById("spectrum-chart");

let current = null; // the scenario
const spectrum = pane({
  box: section.querySelector(".picture"),
  status: document.getElementById("spectrum-status"),
  doing: "Computing the spectrum …",
  delay: 120,
  picture: "spectrum",
  draw: (found) => draw(current, found),
  clear: () => {},
});

/** Show the spectrum at the slenderness of a scenario (null: unknown), over the window of the map. */
export function showSpectrum(scenario, view, idle) {
  if (!scenario) return spectrum.wait({ idle });
  section.classList.toggle("empty", !scenario.point);
  if (!scenario.point) return spectrum.nothing();
  current = scenario;
  const params = spectrumParams(scenario, view);
  const key = JSON.stringify([params, scenario.point.frequency_ratio]);
  return spectrum.show(key, async function* load(signal) {
    await chartsReady();
    const all = [params.restitution, ...OTHERS];
    yield await Promise.all(all.map((restitution) => ask("/v1/spectrum", { ...params, restitution }, signal)));
  });
}

/** The URL of the spectrum in a format. */
export function spectrumUrl(scenario, view, format) {
  return urlOf("/v1/spectrum", { ...spectrumParams(scenario, view), format });
}

function spectrumParams({ pulse, restitution, alpha_deg, point }, view) {
  const { frequency_ratio_min, frequency_ratio_max } = view;
  const { slenderness } = point;
  return { pulse, restitution, alpha_deg, slenderness, frequency_ratio_min, frequency_ratio_max, points: POINTS };
}

function draw(scenario, [chosen, ...others]) {
  const shades = DASHES.map(([, dash]) => ({ stroke: () => themed("ink"), width: 1.2, dash, spanGaps: false, pxAlign: 0 }));
  const series = [{}, ...shades, { stroke: () => themed("accent"), width: 2.5, spanGaps: false, pxAlign: 0 }];
  const tell = ({ cursor }) => {
    caption.textContent = readoutText(scenario, chosen, cursor.idx);
  };
  chart(
    place,
    {
      height: 300,
      series,
      axes: [
        logAxis("frequency ratio ω", { size: 30 }),
        axis("peak rotation θ/α"),
      ],
      scales: { x: { time: false, distr: 3, range: (_, low, high) => [low, high] }, y: { range: (_, low, high) => [0, 1.08 * (high || 1)] } },
      hooks: {
        drawClear: [(u) => shadeOverturning(u, chosen)],
        draw: [(u) => markValue(u, scenario.point.frequency_ratio)],
        setCursor: [tell],
      },
    },
    [chosen.frequency_ratio, ...others.map((one) => one.peak_rotation), chosen.peak_rotation],
  );
  caption.textContent = readoutText(scenario, chosen, null);
}

function readoutText({ restitution, point }, chosen, at) {
  if (at !== null && at !== undefined) {
    const omega = `ω ${number(chosen.frequency_ratio[at])}`;
    return chosen.overturned[at] ? `${omega}: overturns` : `${omega}: peak ${chosen.peak_rotation[at].toFixed(4)} α`;
  }
  const others = OTHERS.map((eta, at) => `${DASHES[at][0]} η = ${number(eta, 2)}`).join(", ");
  return (
    `1/a = ${number(point.slenderness)}; thick η = ${number(restitution)}, ${others}. ` +
    "Hatched: the block overturns; vertical: the chosen frequency ratio."
  );
}

/** Hatch the frequency ratios at which the chosen block overturns. */
function shadeOverturning(u, chosen) {
  const { ctx, bbox } = u;
  const omega = chosen.frequency_ratio;
  ctx.save();
  for (const outcome of ["OVERTURNED_DIRECTLY", "OVERTURNED_AFTER_IMPACT"]) {
    ctx.fillStyle = hatch(ctx, outcome, devicePixelRatio);
    chosen.outcome.forEach((found, at) => {
      if (found !== outcome) return;
      const left = u.valToPos(Math.sqrt(omega[at] * omega[Math.max(at - 1, 0)]), "x", true);
      const right = u.valToPos(Math.sqrt(omega[at] * omega[Math.min(at + 1, omega.length - 1)]), "x", true);
      ctx.fillRect(left, bbox.top, right - left + 1, bbox.height);
    });
  }
  ctx.restore();
}
