// Pointing at the map, choosing a point of it, moving it by the arrow keys, and zooming.

import { hover, pointAt } from "./map.js";
import { once, pane } from "./pane.js";
import { caveatOf } from "./situation.js";
import { middleOf, pointBeside, zoomed } from "./view.js";
import { answerInWords, number } from "./words.js";

const STEP = 0.01;
const LEAP = 0.1;
const ZOOM = 0.5;
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

const over = document.getElementById("map-marks");
const readout = document.getElementById("map-readout");

let told = null; // point and situation
const numbers = pane({
  box: readout,
  status: document.getElementById("readout-status"),
  delay: 25,
  draw: (found) => {
    const { point, situation } = told;
    const caveat = point === situation.point ? caveatOf(situation) : "";
    const words = [caveat, `${answerInWords(found)}.`].filter(Boolean).join(" ");
    readout.textContent = `${placeInWords(point, situation.size)}: ${words}`;
  },
  clear: () => {
    readout.textContent = "";
  },
});

/** Wire the map: `look()` gives situation and view, `choose(point, keep)` and `frame(parts)` change the state. */
export function wireMap(look, choose, frame) {
  over.addEventListener("pointermove", (event) => {
    const point = pointAt(event.offsetX, event.offsetY);
    hover(point);
    tellOf(point, look().situation);
  });
  over.addEventListener("pointerleave", () => {
    hover(null);
    tellOf(null, look().situation);
  });
  over.addEventListener("click", (event) => {
    const point = pointAt(event.offsetX, event.offsetY);
    if (point && look().situation) choose(rounded(point), true);
  });
  over.addEventListener("keydown", (event) => {
    const { situation, view } = look();
    const about = situation?.point ?? middleOf(view);
    if (event.key in ARROWS && situation) {
      const [across, up] = ARROWS[event.key].map((sign) => sign * (event.shiftKey ? LEAP : STEP));
      choose(rounded(situation.point ? pointBeside(view, about, across, up) : about), false);
    } else if (event.key === "Enter" && situation) choose(rounded(about), true);
    else if (event.key === "+" || event.key === "=") frame(zoomed(view, about, ZOOM));
    else if (event.key === "-") frame(zoomed(view, about, 1 / ZOOM));
    else return;
    event.preventDefault();
  });
  for (const [id, factor] of [["zoom-in", ZOOM], ["zoom-out", 1 / ZOOM]]) {
    document.getElementById(id).addEventListener("click", () => {
      const { situation, view } = look();
      frame(zoomed(view, situation?.point ?? middleOf(view), factor));
    });
  }
}

/** Say what the solver says of a point, or else of the chosen one; null: the situation is not known. */
export function tellOf(point, situation) {
  if (!situation) return numbers.wait();
  told = { point: point ?? situation.point, situation };
  if (!told.point) return numbers.nothing("Point at the map for the numbers there.");
  const { pulse, restitution, alpha_deg, size } = situation;
  const question = { pulse, restitution, alpha_deg, ...rounded(told.point) };
  return numbers.show(JSON.stringify([question, size, point === null]), once("/v1/response", question));
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
