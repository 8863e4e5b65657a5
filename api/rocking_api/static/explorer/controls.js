// Pulse, restitution and slenderness angle of the map, as a choice and two sliders.

import { element } from "./page.js";
import { DEFAULTS, isBlock } from "./state.js";
import { number, PULSES } from "./words.js";

const pulse = document.getElementById("pulse");
const sliders = { restitution: document.getElementById("eta"), alpha_deg: document.getElementById("alpha") };
const told = { restitution: document.getElementById("eta-value"), alpha_deg: document.getElementById("alpha-value") };

/** Wire the controls: `set(parts, keep)` changes the state; `look()` gives state and situation. */
export function wireControls(look, set) {
  for (const select of document.querySelectorAll("select[name=pulse]")) {
    for (const [name, words] of Object.entries(PULSES)) select.append(element("option", words, { value: name }));
  }
  pulse.addEventListener("change", () => set({ pulse: pulse.value }, true));
  for (const [name, slider] of Object.entries(sliders)) {
    const moved = () => ({ ...(name === "alpha_deg" ? withoutBlock(look()) : {}), [name]: slider.value });
    slider.addEventListener("input", () => set(moved(), false));
    slider.addEventListener("change", () => set(moved(), true));
  }
}

/** Show what a state says, and what its situation (null: not known yet) adds. */
export function showControls(state, situation) {
  pulse.value = state.pulse;
  const { restitution, alpha_deg } = situation ?? { restitution: state.restitution, alpha_deg: null };
  told.restitution.textContent = Number.isFinite(Number(restitution)) ? number(restitution) : "…";
  if (told.restitution.textContent !== "…") sliders.restitution.value = restitution;
  told.alpha_deg.textContent = alpha_deg === null ? "…" : Number(alpha_deg) === 0 ? "slender limit" : `${number(alpha_deg)}°`;
  if (alpha_deg !== null) sliders.alpha_deg.value = alpha_deg;
}

/** Another slenderness angle is another block: the one in metres is left, its point and restitution stay if known. */
function withoutBlock({ state, situation }) {
  if (!isBlock(state)) return {};
  const left = { width: "", height: "", acceleration: "", period: "" };
  if (!situation?.point) return { ...left, restitution: DEFAULTS.restitution };
  const { restitution, point } = situation;
  const [frequency_ratio, slenderness] = [point.frequency_ratio, point.slenderness].map((x) => x.toPrecision(5));
  const eta = Number(restitution.toPrecision(4)).toString();
  return { ...left, restitution: eta, frequency_ratio, slenderness };
}
