// Pointing at the map, choosing a point of it, moving it by the arrow keys, and zooming.

import { ask } from "./api.js";
import { hover, middle, pointAt, pointBeside } from "./map.js";
import { settled } from "./page.js";
import { zoomed } from "./view.js";
import { answerInWords, number } from "./words.js";

const STEP = 0.01;
const LEAP = 0.1;
const ZOOM = 0.5;
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

const over = document.getElementById("map-marks");
const readout = document.getElementById("map-readout");

/** Wire the map: `look()` gives situation and view, `choose(point, keep)` and `frame(parts)` change the state. */
export function wireMap(look, choose, frame) {
  over.addEventListener("pointermove", (event) => {
    const point = pointAt(event.offsetX, event.offsetY);
    hover(point);
    settled("readout", 25, () => tellOf(point ?? look().situation.point, look().situation));
  });
  over.addEventListener("pointerleave", () => {
    hover(null);
    settled("readout", 25, () => tellOf(look().situation.point, look().situation));
  });
  over.addEventListener("click", (event) => {
    const point = pointAt(event.offsetX, event.offsetY);
    if (point) choose(rounded(point), true);
  });
  over.addEventListener("keydown", (event) => {
    const { situation, view } = look();
    const about = situation.point ?? middle();
    if (event.key in ARROWS) {
      const [across, up] = ARROWS[event.key].map((sign) => sign * (event.shiftKey ? LEAP : STEP));
      choose(rounded(situation.point ? pointBeside(about, across, up) : about), false);
    } else if (event.key === "Enter") choose(rounded(about), true);
    else if (event.key === "+" || event.key === "=") frame(zoomed(view, about, ZOOM));
    else if (event.key === "-") frame(zoomed(view, about, 1 / ZOOM));
    else return;
    event.preventDefault();
  });
  for (const [id, factor] of [["zoom-in", ZOOM], ["zoom-out", 1 / ZOOM]]) {
    document.getElementById(id).addEventListener("click", () => {
      const { situation, view } = look();
      frame(zoomed(view, situation.point ?? middle(), factor));
    });
  }
}

/** Say what the solver says of a point, its groups first. */
export async function tellOf(point, situation) {
  if (!point) {
    readout.textContent = "Point at the map for the numbers there.";
    return;
  }
  const { pulse, restitution, alpha_deg } = situation;
  try {
    const found = await ask("readout", "/v1/response", { pulse, restitution, alpha_deg, ...rounded(point) });
    if (found) readout.textContent = `${placeInWords(point, situation.size)}: ${answerInWords(found)}.`;
  } catch (problem) {
    readout.textContent = problem.message;
  }
}

function placeInWords({ frequency_ratio, slenderness }, size) {
  const groups = `ω ${number(frequency_ratio)}, 1/a ${number(slenderness)}`;
  if (!size) return groups;
  const period = (2 * Math.PI) / (size.p * frequency_ratio);
  return `${groups} (${number(size.uplift_in_g / slenderness)} g, ${number(period)} s)`;
}

function rounded({ frequency_ratio, slenderness }) {
  const cut = (value) => Number(value.toPrecision(5)).toString();
  return { frequency_ratio: cut(frequency_ratio), slenderness: cut(slenderness) };
}
