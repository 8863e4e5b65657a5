// Pulse, restitution and slenderness angle of the map, as a choice and two sliders.

import { element } from "./page.js";
import { DEFAULTS, isBlock } from "./state.js";
import { number, PULSES } from "./labels.js";

const pulse = document.getElementById("pulse");
const sliders = { restitution: document.getElementById("eta"), alpha_deg: document.getElementById("alpha") };
const outputs = { restitution: document.getElementById("eta-value"), alpha_deg: document.getElementById("alpha-value") };

/** Wire the controls: `set(parts, keep)` changes the state; `look()` gives state and scenario. */
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

/** Show a state and its scenario (null: not known yet). */
export function showControls(state, scenario) {
  pulse.value = state.pulse;
  const { restitution, alpha_deg } = scenario ?? { restitution: state.restitution, alpha_deg: null };
  outputs.restitution.textContent = Number.isFinite(Number(restitution)) ? number(restitution) : "…";
  if (outputs.restitution.textContent !== "…") sliders.restitution.value = restitution;
  outputs.alpha_deg.textContent = alpha_deg === null ? "…" : Number(alpha_deg) === 0 ? "slender limit" : `${number(alpha_deg)}°`;
  if (alpha_deg !== null) sliders.alpha_deg.value = alpha_deg;
}

/** The state for another slenderness angle: no longer a block in metres; its point and restitution stay if known. */
function withoutBlock({ state, scenario }) {
  if (!isBlock(state)) return {};
  const left = { width: "", height: "", acceleration: "", period: "" };
  if (!scenario?.point) return { ...left, restitution: DEFAULTS.restitution };
  const { restitution, point } = scenario;
  const [frequency_ratio, slenderness] = [point.frequency_ratio, point.slenderness].map((x) => x.toPrecision(5));
  const eta = Number(restitution.toPrecision(4)).toString();
  return { ...left, restitution: eta, frequency_ratio, slenderness };
}
