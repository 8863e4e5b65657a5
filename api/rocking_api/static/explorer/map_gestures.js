// Wheel, drag and pinch on the map: zoom about the pointer, and pan.

import { pointAt, sharesOf } from "./map.js";
import { covers, panned, whole, zoomed } from "./view.js";

const DRAG = 5; // [px] from which a press is a drag and no click
const WHEEL = 300; // [px] of the wheel that zoom by a factor of two
const PAUSE = 400; // [ms] after which turns of the wheel are one step of the history of the browser

const over = document.getElementById("map-marks");

const pointers = new Map(); // positions [px] by pointer
let start = null; // window and positions when the last pointer came or went
let moved = false; // a drag or pinch has begun, whose click is ignored
let timer = null;

/** Wire the gestures: `look()` gives the view, `frame(parts, keep)` changes the window. */
export function wireGestures(look, frame) {
  const begin = () => {
    start = { view: look().view, points: [...pointers.values()] };
  };
  over.addEventListener("pointerdown", (event) => {
    if (pointers.size === 0) moved = false;
    pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
    begin();
  });
  over.addEventListener("pointermove", (event) => {
    if (!pointers.has(event.pointerId)) return;
    pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
    const parts = pointers.size === 2 ? pinched() : dragged();
    if (!parts) return;
    moved = true;
    over.setPointerCapture(event.pointerId);
    frame(parts, false);
  });
  const end = (event) => {
    if (!pointers.delete(event.pointerId)) return;
    begin();
    if (moved && pointers.size === 0) frame({}, true);
  };
  over.addEventListener("pointerup", end);
  over.addEventListener("pointercancel", end);
  over.addEventListener("click", (event) => moved && event.stopImmediatePropagation(), { capture: true });
  over.addEventListener("wheel", (event) => turn(event, look().view, frame), { passive: false });
}

function dragged() {
  const [[x, y]] = pointers.values();
  const [[x0, y0]] = start.points;
  if (!moved && Math.hypot(x - x0, y - y0) < DRAG) return null;
  const shares = sharesOf(x - x0, y - y0);
  return shares && panned(start.view, -shares.across, -shares.down);
}

function pinched() {
  const apart = ([[x1, y1], [x2, y2]]) => Math.max(Math.hypot(x2 - x1, y2 - y1), 1);
  const [[x1, y1], [x2, y2]] = start.points;
  const about = pointAt((x1 + x2) / 2, (y1 + y2) / 2);
  return about && zoomed(start.view, about, apart(start.points) / apart([...pointers.values()]));
}

/** Zooms; at the whole map the wheel scrolls the page. */
function turn(event, view, frame) {
  const about = pointAt(event.offsetX, event.offsetY);
  if (!about || (event.deltaY > 0 && covers(view))) return;
  event.preventDefault();
  const parts = zoomed(view, about, 2 ** (Math.min(Math.max(event.deltaY, -WHEEL), WHEEL) / WHEEL));
  frame(event.deltaY > 0 && covers(parts) ? whole() : parts, false);
  clearTimeout(timer);
  timer = setTimeout(() => frame({}, true), PAUSE);
}
