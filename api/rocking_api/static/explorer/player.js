// Play, pause, speed and time of the animation.

const button = document.getElementById("play");
const slider = document.getElementById("time");
const speed = document.getElementById("speed");
const still = matchMedia("(prefers-reduced-motion: reduce)");

/** Seconds per unit of tau without a block in metres: those of a block with p = 2 rad/s, R = 1.8 m. */
const SECONDS = 0.5;

let animation = null; // { end, seconds, show }
let tau = 0;
let last = null; // clock of the frame before, null while paused

/** Load an animation that ends at `end` [tau]; `size` gives real time, `show(tau)` draws. Starts it if `atOnce`. */
export function load(end, size, show, atOnce) {
  animation = { end, seconds: size ? 1 / size.p : SECONDS, show };
  slider.max = end;
  slider.step = end / 1000;
  seek(0);
  if (atOnce && !still.matches) play();
  else pause();
}

/** Remove the animation. */
export function unload() {
  pause();
  animation = null;
}

/** Go to a time. */
export function seek(to) {
  if (!animation) return;
  tau = Math.min(Math.max(to, 0), animation.end);
  slider.value = tau;
  slider.setAttribute("aria-valuetext", animation.show(tau));
}

/** Draw the current time again. */
export function repeat() {
  seek(tau);
}

function play() {
  if (!animation) return;
  if (tau >= animation.end) seek(0);
  const running = last !== null;
  last = performance.now();
  button.textContent = "Pause";
  button.setAttribute("aria-pressed", "true");
  if (!running) requestAnimationFrame(step);
}

function pause() {
  last = null;
  button.textContent = "Play";
  button.setAttribute("aria-pressed", "false");
}

function step(now) {
  if (last === null) return;
  seek(tau + (Math.max(now - last, 0) / 1000 / animation.seconds) * Number(speed.value));
  last = now;
  if (tau >= animation.end) pause();
  else requestAnimationFrame(step);
}

button.addEventListener("click", () => (last === null ? play() : pause()));
slider.addEventListener("input", () => {
  pause();
  seek(Number(slider.value));
});
