// The page: from the address to what is looked at, and from there to every view of it.

import { urlOf } from "./api.js";
import { fillForm, showAnswer, wireForm } from "./block_form.js";
import { showControls, wireControls } from "./controls.js";
import { setLinks, wireDownloads } from "./downloads.js";
import { curvesUrl, mapQuestion, showMap } from "./map.js";
import { tellOf, wireMap } from "./map_pointer.js";
import { motionUrl, showMotion } from "./motion.js";
import { forgive, say, settled } from "./page.js";
import { blockQuestion, movedTo, situationOf } from "./situation.js";
import { showSpectrum, spectrumUrl } from "./spectrum.js";
import { change, DEFAULTS, isBlock, onChange, state } from "./state.js";
import { whole, windowOf } from "./view.js";
import { number, PULSES } from "./words.js";

const status = document.getElementById("block-status");

let situation = null;
let view = null;

async function show(wanted) {
  forgive();
  fillForm(wanted);
  if (isBlock(wanted)) say(status, "Asking …");
  const found = await situationOrWhatWasThere(wanted);
  if (!found || wanted !== state()) return;
  situation = found;
  showAnswer(situation.answer);
  showViews(wanted);
}

/** A block that the service refuses leaves the views as they are. */
async function situationOrWhatWasThere(wanted) {
  try {
    const found = await situationOf(wanted);
    if (found) say(status, "");
    return found;
  } catch (problem) {
    say(status, problem);
    return { ...(situation ?? (await situationOf(DEFAULTS))), answer: null };
  }
}

function showViews(wanted) {
  view = windowOf(wanted, situation.point);
  showControls(situation);
  showMap(situation, view);
  settled("views", 120, () => {
    tellOf(situation.point, situation);
    showMotion(situation);
    showSpectrum(situation, view);
    link(wanted);
  });
}

function link(wanted) {
  const map = (format) => urlOf("/v1/map", { ...mapQuestion(), format });
  setLinks("map", { csv: map("csv"), nc: map("nc"), curves: `${curvesUrl()}&format=csv` });
  if (situation.answer) setLinks("block", { json: urlOf("/v1/blocks/response", blockQuestion(wanted)) });
  if (!situation.point) return;
  setLinks("motion", { csv: motionUrl(situation, "csv"), nc: motionUrl(situation, "nc") });
  setLinks("spectrum", { csv: spectrumUrl(situation, view, "csv"), nc: spectrumUrl(situation, view, "nc") });
}

function caption() {
  const { pulse, restitution, alpha_deg, point } = situation;
  const said = [PULSES[pulse] ?? pulse, `η = ${number(restitution, 4)}`];
  said.push(Number(alpha_deg) ? `α = ${number(alpha_deg, 4)}°` : "slender limit");
  if (point) said.push(`ω = ${number(point.frequency_ratio, 5)}`, `1/a = ${number(point.slenderness, 5)}`);
  return said.join(", ");
}

const look = () => ({ state: state(), situation, view });
wireForm((parts) => change({ ...parts, frequency_ratio: "", slenderness: "", alpha_deg: "0" }));
wireControls(look, (parts, keep) => change(parts, { keep }));
wireMap(
  look,
  (point, keep) => change(movedTo(state(), situation, point), { keep }),
  (parts) => change(parts),
);
wireDownloads(caption);
document.getElementById("whole").addEventListener("click", () => change(whole()));
onChange(show);
show(state());
