// Pulse, restitution and slenderness angle of the map, as a choice and two sliders.

import { element } from "./page.js";
import { isBlock } from "./state.js";
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

/** Show what a situation holds. */
export function showControls({ pulse: name, restitution, alpha_deg }) {
  pulse.value = name;
  sliders.restitution.value = restitution;
  sliders.alpha_deg.value = alpha_deg;
  told.restitution.textContent = Number.isFinite(Number(restitution)) ? number(restitution) : restitution;
  told.alpha_deg.textContent = Number(alpha_deg) === 0 ? "slender limit" : `${number(alpha_deg)}°`;
}

/** Another slenderness angle is another block: the one in metres is let go, its point and restitution stay. */
function withoutBlock({ state, situation }) {
  if (!isBlock(state)) return {};
  const { restitution, point } = situation;
  const [frequency_ratio, slenderness] = [point.frequency_ratio, point.slenderness].map((x) => x.toPrecision(5));
  const eta = Number(restitution.toPrecision(4)).toString();
  return { width: "", height: "", acceleration: "", period: "", restitution: eta, frequency_ratio, slenderness };
}
