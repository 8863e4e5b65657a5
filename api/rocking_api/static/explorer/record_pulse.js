// The pulse fitted to a record, drawn over the velocity of the record, with what it may not be used for.

import { axis, chart } from "./chart.js";
import { themed } from "./colours.js";
import { acceleration, number, PULSES } from "./labels.js";

const place = document.getElementById("pulse-chart");
const caption = document.getElementById("pulse-caption");
const caution = document.getElementById("pulse-caution");

/** Draw the response of /v1/records/pulse. */
export function drawPulse({ pulse, time, record_velocity, pulse_velocity, query, caution: words }) {
  chart(
    place,
    {
      height: 220,
      series: [
        {},
        { stroke: () => themed("muted"), width: 1, pxAlign: 0 },
        { stroke: () => themed("accent"), width: 2.5, pxAlign: 0 },
      ],
      axes: [axis("time t [s]", { size: 30 }), axis("ground velocity [m/s]")],
      scales: { x: { time: false } },
    },
    [time, record_velocity, pulse_velocity],
  );
  const kind = PULSES[pulse.pulse.replace("-", "")] ?? pulse.pulse;
  caption.textContent =
    `Thick: ${kind}, period ${number(pulse.period)} s, peak ${acceleration(query.scale * pulse.peak_acceleration)}; ` +
    `it takes ${number(100 * pulse.explained, 2)} % of the energy of the velocity of the record (thin).`;
  caution.textContent = `${comparison(pulse)} ${words}`;
}

function comparison({ scale_ratio: ratio }) {
  if (ratio === null) return "One of the two does not overturn this block.";
  if (ratio > 1) return `This block overturns under the pulse at ${number(ratio)} times the factor of the record: the pulse is unconservative.`;
  return `This block overturns under the pulse at ${number(ratio)} times the factor of the record.`;
}
