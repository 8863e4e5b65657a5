// Pointer and keyboard on the map: readout, choice of a point, zoom.

import { isSampled } from "./api.js";
import { hover, pointAt } from "./map.js";
import { once, pane } from "./pane.js";
import { validityNote } from "./scenario.js";
import { middleOf, pointBeside, zoomed } from "./view.js";
import { acceleration, responseLabel, number } from "./labels.js";
import { inShown, shown } from "./units.js";

const STEP = 0.01;
const LARGE_STEP = 0.1;
const ZOOM = 0.5;
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }; // in frequency ratio and slenderness: up is stronger

const over = document.getElementById("map-marks");
const readout = document.getElementById("map-readout");

let current = null; // point and scenario of the readout
const numbers = pane({
  box: readout,
  status: document.getElementById("readout-status"),
  delay: 25,
  draw: (found) => {
    const { point, scenario } = current;
    const note = point === scenario.point ? validityNote(scenario) : "";
    const words = [note, `${responseLabel(found)}.`].filter(Boolean).join(" ");
    readout.textContent = `${pointLabel(point, scenario.size)}: ${words}`;
  },
  clear: () => {
    readout.textContent = "";
  },
});

/** Wire the map: `look()` gives scenario and view, `choose(point, keep)` and `frame(parts)` change the state, `undo()` the last change. */
export function wireMap(look, choose, frame, undo) {
  over.addEventListener("pointermove", (event) => {
    const point = pointAt(event.offsetX, event.offsetY);
    hover(point);
    showReadout(point, look().scenario);
  });
  over.addEventListener("pointerleave", () => {
    hover(null);
    showReadout(null, look().scenario);
  });
  over.addEventListener("click", (event) => {
    const point = pointAt(event.offsetX, event.offsetY);
    if (point && look().scenario) choose(rounded(point), true);
  });
  over.addEventListener("keydown", (event) => {
    const { scenario, view } = look();
    const about = scenario?.point ?? middleOf(view);
    if (event.key in ARROWS && scenario) {
      const [across, up] = ARROWS[event.key].map((sign) => sign * (event.shiftKey ? LARGE_STEP : STEP));
      choose(rounded(scenario.point ? pointBeside(view, about, across, up) : about), false);
    } else if (event.key === "Enter" && scenario) choose(rounded(about), true);
    else if (event.key === "z" && (event.ctrlKey || event.metaKey)) undo();
    else if (event.key === "+" || event.key === "=") frame(zoomed(view, about, ZOOM));
    else if (event.key === "-") frame(zoomed(view, about, 1 / ZOOM));
    else return;
    event.preventDefault();
  });
  over.addEventListener("keyup", (event) => event.key in ARROWS && frame({})); // one step to undo
  for (const [id, factor] of [["zoom-in", ZOOM], ["zoom-out", 1 / ZOOM]]) {
    document.getElementById(id).addEventListener("click", () => {
      const { scenario, view } = look();
      frame(zoomed(view, scenario?.point ?? middleOf(view), factor));
    });
  }
}

/** Show the response at a point, or else at the chosen one; null: the scenario is unknown. */
export function showReadout(point, scenario, idle = false) {
  if (!scenario) return numbers.wait({ idle });
  current = { point: point ?? scenario.point, scenario };
  if (!current.point) return numbers.nothing("Hover over the map to read values.");
  const { pulse, restitution, alpha_deg, size } = scenario;
  if (isSampled(pulse)) return numbers.nothing(pointLabel(current.point, size));
  const params = { pulse, restitution, alpha_deg, ...rounded(current.point) };
  return numbers.show(JSON.stringify([params, size, point === null]), once("/v1/response", params));
}

function pointLabel({ frequency_ratio, slenderness }, size) {
  const groups = `ω ${number(frequency_ratio)}, 1/a ${number(slenderness)}`;
  if (!size) return groups;
  const period = (2 * Math.PI) / (size.p * frequency_ratio);
  return `${acceleration(size.uplift / slenderness)}, ${number(inShown("period", period))} ${shown.period} (${groups})`;
}

function rounded({ frequency_ratio, slenderness }) {
  const cut = (value) => Number(value.toPrecision(5)).toString();
  return { frequency_ratio: cut(frequency_ratio), slenderness: cut(slenderness) };
}
