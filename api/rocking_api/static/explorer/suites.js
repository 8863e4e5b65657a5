// The page of suites of records: a report of one suite, one limit state, and one block or all of them, to print.

import { ask } from "./api.js";
import { chartsReady } from "./chart.js";
import { length, number, threshold } from "./labels.js";
import { element, setStatus } from "./page.js";
import { modelSections, section } from "./report_sections.js";
import { drawFragility } from "./suite_chart.js";

const form = document.getElementById("suite");
const status = document.getElementById("status");
const report = document.getElementById("suite-report");
const files = document.getElementById("files");
const print = document.getElementById("print");

const UNITS = { "m s-2": "m/s²", "m s-1": "m/s", 1: "" };
const LIMITS = { overturning: "overturns", alpha: "passes α at some time" };

let asked = new AbortController();

async function start() {
  try {
    const { suites } = await ask("/v1/suites", {}, new AbortController().signal);
    form.hidden = !suites.length;
    if (!suites.length) {
      setStatus(status, "There is no suite here: in a checkout of the sources make reproduce CONFIG=workflow/config/suite.yaml makes one.");
      return;
    }
    const given = new URLSearchParams(location.search);
    form.elements.name.replaceChildren(...suites.map(({ name }) => element("option", name, { value: name })));
    if (suites.some(({ name }) => name === given.get("name"))) form.elements.name.value = given.get("name");
    await show(given.get("demand"), given.get("block"));
  } catch (problem) {
    setStatus(status, problem, start);
  }
}

/** Show the suite of the form, at a limit state and for a block, if it has these. */
async function show(demand, block) {
  asked.abort();
  asked = new AbortController();
  const { signal } = asked;
  const name = form.elements.name.value;
  setStatus(status, "Reading the suite …");
  try {
    const found = await ask(`/v1/suites/${encodeURIComponent(name)}`, {}, signal);
    await chartsReady();
    if (signal.aborted) return;
    const demands = found.blocks[0].limit_states.map((one) => one.demand);
    form.elements.demand.replaceChildren(...demands.map((one) => element("option", limit(one), { value: one })));
    if (demands.includes(demand)) form.elements.demand.value = demand;
    const blocks = found.blocks.map((one, at) => element("option", nameOf(one), { value: String(at + 1) }));
    form.elements.block.replaceChildren(element("option", "All", { value: "" }), ...blocks);
    if (found.blocks[Number(block) - 1]) form.elements.block.value = block;
    draw(found);
  } catch (problem) {
    if (!signal.aborted) setStatus(status, problem, () => show(demand, block));
  }
}

function draw(found) {
  const demand = form.elements.demand.value;
  const block = form.elements.block.value;
  history.replaceState(null, "", `?${new URLSearchParams({ name: found.name, demand, ...(block && { block }) })}`);
  const unit = UNITS[found.unit] ?? found.unit;
  const view = { ...found, unit, quantity: unit ? `${found.measure_meaning} [${unit}]` : found.measure_meaning, demand };
  const parts = found.blocks.filter((_, at) => !block || at + 1 === Number(block)).map((one) => ofBlock(view, one));
  report.replaceChildren(
    section({ heading: found.title, pairs: about(view) }),
    ...parts.map(({ place }) => place),
    records(view),
    ...modelSections(found).map(section),
  );
  for (const { chart, state } of parts) drawFragility(chart, view, state);
  files.replaceChildren("netCDF: ", ...filesOf(found));
  print.disabled = false;
  setStatus(status, `${found.records.length} records, ${found.blocks.length} blocks, ${found.intensity.length} levels.`);
}

/** Links to the files of the suite itself; those of its records and figures are among the data sets. */
function filesOf({ name, links }) {
  const folder = `/v1/datasets/suites/${name}/`;
  const own = links.filter(({ href }) => href.startsWith(folder) && !href.slice(folder.length).includes("/"));
  const shown = own.flatMap(({ href }) => [element("a", href.slice(folder.length), { href }), ", "]);
  return [...shown, element("a", "all", { href: "/datasets", "aria-label": "all data sets" })];
}

function about({ name, records: all, quantity, unit, intensity, confidence, demand }) {
  return [
    ["Suite", name],
    ["Records, equally likely and independent", String(all.length)],
    ["Limit state", `the block ${limit(demand)}`],
    ["Measure of intensity", quantity],
    ["Levels", `${intensity.length} from ${number(intensity[0])} to ${number(intensity.at(-1))} ${unit}`.trim()],
    ["Confidence of the intervals", `${number(100 * confidence)} %`],
    ["Address", location.href],
  ];
}

function ofBlock(view, block) {
  const state = block.limit_states.find(({ demand }) => demand === view.demand);
  const name = `Block of ${nameOf(block)}`;
  const chart = element("div", "", { class: "chart" });
  const words = `Share of ${view.records.length} records with which the block ${limit(view.demand)}, against ${view.quantity}`;
  const figure = element("figure", [chart, element("figcaption", caption(view, words))]);
  const place = section({ heading: name, pairs: [...geometry(block), ...curves(view, state)] });
  place.append(figure, element("h3", "Records at each level"), levels(view, block, state));
  if (view.demand === "overturning") place.append(element("h3", "Margin of each record"), margins(view, block));
  if (block.sensitivity.length) place.append(element("h3", "Friction, restitution and sampling"), ...sensitivity(view, block));
  const named = state.records_surviving_above_first;
  if (named.length) place.append(element("p", `Not monotone: it does not, at a level above the first at which it does, with ${named.join(", ")}.`, { class: "small" }));
  return { place, chart, state };
}

function nameOf(block) {
  return `${length(block.width)} by ${length(block.height)}`;
}

function geometry(block) {
  return [
    ["Half diagonal R", length(block.half_diagonal)],
    ["Slenderness angle α", `${number(block.alpha_deg, 4)}°`],
    ["Frequency parameter p", `${number(block.frequency_parameter, 4)} rad/s`],
    ["Coefficient of restitution", number(block.restitution, 4)],
    ["Uplifts from a peak ground acceleration of", `${number(block.uplift_acceleration)} m/s² (${number(block.uplift_acceleration / 9.80665)} g)`],
  ];
}

function curves({ unit }, state) {
  return state.curves.flatMap((one) => {
    const name = { lognormal: "Lognormal", logistic: "Log-logistic" }[one.model] ?? one.model;
    const median = [one.median_intensity, one.median_intensity_lower, one.median_intensity_upper];
    const spread = [one.dispersion, one.dispersion_lower, one.dispersion_upper];
    const pairs = [[`${name}: median`, `${interval(median)} ${unit}`.trim()]];
    if (one.fit_status === "FITTED") pairs.push([`${name}: dispersion`, interval(spread)]);
    else pairs.push([`${name}: no curve`, one.fit_meaning]);
    return pairs;
  });
}

/** A value with its interval; an end that the data do not bound is open. */
function interval([value, low, high]) {
  const middle = value === null ? "none" : number(value);
  return `${middle} (${low === null ? "0" : number(low)} to ${high === null ? "unbounded" : number(high)})`;
}

function caption({ confidence }, words) {
  return `${words}. Points: k of N, with the Clopper-Pearson interval of ${number(100 * confidence)} %; line: lognormal curve; dotted: counts from the first level on, for comparison.`;
}

/** k of N at the levels where some records reach the limit state and others do not, with one level on either side. */
function levels({ intensity, records: all, quantity }, block, state) {
  const count = all.length;
  const between = intensity.map((_, at) => at).filter((at) => state.exceedances[at] > 0 && state.exceedances[at] < count);
  const from = Math.max((between[0] ?? state.exceedances.findIndex((k) => k > 0)) - 1, 0);
  const to = Math.min((between.at(-1) ?? from) + 1, intensity.length - 1);
  const quantiles = block.rotation_quantiles;
  const heads = [quantity, "k of N", "k/N", "interval", ...quantiles.map(({ quantile }) => `θ/α, ${number(100 * quantile)} %`)];
  const rows = [];
  for (let at = from; at <= to; at += 1) {
    const ends = [state.fraction_lower[at], state.fraction_upper[at]].map((end) => number(end)).join(" to ");
    const peaks = quantiles.map(({ peak_rotation: peak }) => (peak[at] === null ? "overturns" : number(peak[at])));
    rows.push([number(intensity[at]), `${state.exceedances[at]} of ${count}`, number(state.fraction[at]), ends, ...peaks]);
  }
  return table(heads, rows);
}

function margins({ quantity, measure }, block) {
  const falls = measure === "frequency_ratio"; // of which the largest value is the mildest, and records keep their factor
  const factor = falls ? number : threshold;
  const heads = ["Record", `overturns from, ${quantity}`, "factor of the record", "stronger levels survived"];
  const rows = block.margins.map((one) => {
    if (one.overturning_intensity === null) return [one.record, "survives all", "", ""];
    return [one.record, threshold(one.overturning_intensity, !falls), factor(one.overturning_scale), String(one.levels_survived_above)];
  });
  return table(heads, rows);
}

/** Overturning with other restitution and sampling, and the friction that rocking needs, at the levels of the suite. */
function sensitivity({ quantity, unit, records: all }, block) {
  const share = (fraction) => `${Math.round(fraction * all.length)} of ${all.length}`;
  const friction = (demand) => (demand === null ? "lifts off" : number(demand));
  const [{ restitution_low: low, restitution_high: high }] = block.sensitivity;
  const heads = [
    quantity, "overturn", `with η = ${number(low)}`, `with η = ${number(high)}`, "with band-limited samples",
    "friction for half of the records", "friction for all records",
  ];
  const rows = block.sensitivity.map((one) => [
    number(one.intensity), share(one.fraction), share(one.fraction_low_restitution), share(one.fraction_high_restitution),
    share(one.fraction_resampled), friction(one.friction_demand_median), friction(one.friction_demand_largest),
  ]);
  const changed = block.sensitivity.filter(({ records_changed_by_sampling: names }) => names.length);
  const named = changed.map((one) => `${one.records_changed_by_sampling.join(", ")} at ${`${number(one.intensity)} ${unit}`.trim()}`);
  const notes = [
    `η: coefficient of restitution, ${number(block.restitution)} otherwise. Band-limited: each record interpolated at half its step, instead of linear between its samples.`,
    "Friction: coefficient that keeps the block from sliding during the whole motion, impacts excluded.",
    ...(named.length ? [`The sampling decides the outcome under ${named.join("; ")}.`] : []),
  ];
  return [table(heads, rows), element("p", notes.join(" "), { class: "small" })];
}

function records({ records: all }) {
  const heads = ["Record", "PGA [m/s²]", "PGV [m/s]", "mean period [s]", "step [s]"];
  const rows = all.map((one) => {
    const period = one.mean_period === null ? "" : number(one.mean_period);
    return [one.name, number(one.peak_acceleration), number(one.peak_velocity), period, number(one.time_step)];
  });
  const place = section({ heading: "Records, as recorded" });
  place.append(table(heads, rows));
  return place;
}

function table(heads, rows) {
  const head = element("tr", heads.map((text) => element("th", text, { scope: "col" })));
  const body = rows.map(([first, ...rest]) => element("tr", [element("th", first, { scope: "row" }), ...rest.map((text) => element("td", text))]));
  return element("div", [element("table", [element("thead", [head]), element("tbody", body)])], { class: "table", tabindex: "0", role: "group", "aria-label": heads[0] });
}

function limit(demand) {
  return LIMITS[demand] ?? `rocks beyond ${demand.replace(" alpha", " α")}`;
}

form.elements.name.addEventListener("change", () => show(form.elements.demand.value, null));
for (const name of ["demand", "block"]) {
  form.elements[name].addEventListener("change", () => show(form.elements.demand.value, form.elements.block.value));
}
form.addEventListener("submit", (event) => event.preventDefault());
print.addEventListener("click", () => window.print());
start();
