// The page of the data sets: the catalogue by kind, with filters and links.

import { ask } from "./api.js";
import { number, PULSES } from "./labels.js";
import { element, save, setStatus } from "./page.js";

const SYMBOLS = { slenderness: "1/a", frequency_ratio: "ω", alpha: "α" };
const DEGREES = 180 / Math.PI;

const GROUPS = { spectra: "Rocking spectra", overturning: "Boundaries of overturning", figures: "Plotted data of figures", suites: "Suites of records" };

const groups = document.getElementById("groups");
const status = document.getElementById("status");
const filter = document.getElementById("filter");
const choices = { pulse: document.getElementById("pulse"), restitution: document.getElementById("eta") };
const filters = [filter, ...Object.values(choices)];
const showAll = element("button", "Show all", { type: "button" });

let datasets = []; // of the catalogue, each with its row
let stores = {}; // zarr stores of the cubes of one pulse, by the folder of these

async function show() {
  try {
    const found = await ask("/v1/datasets", {}, new AbortController().signal);
    stores = Object.fromEntries(found.pulses.map((one) => [`spectra/${one.name}`, one]));
    datasets = found.datasets.map((one) => ({ ...one, row: row(one), kind: one.name.split("/")[0] }));
    for (const [name, select] of Object.entries(choices)) {
      const values = [...new Set(datasets.map((one) => one[name]).filter((value) => value !== null))].sort();
      select.append(...values.map((value) => element("option", name === "pulse" ? PULSES[value] ?? value : number(value), { value })));
    }
    const kinds = [...new Set([...Object.keys(GROUPS), ...datasets.map(({ kind }) => kind)])];
    groups.replaceChildren(...kinds.map(group).filter(Boolean));
    recall();
    select();
  } catch (problem) {
    setStatus(status, problem, show);
  }
}

/** The table of one kind: a line for each folder, a pulse or a suite, which opens its data sets. */
function group(kind) {
  const own = datasets.filter((one) => one.kind === kind);
  if (!own.length) return null;
  const heads = ["Title", "η", "Extent", "Get it"].map((text) => element("th", text, { scope: "col" }));
  const title = GROUPS[kind] ?? kind;
  const bodies = [...new Set(own.map(folderOf))].map((folder) => folderBody(folder, own.filter((one) => folderOf(one) === folder), title));
  const table = element("table", [element("thead", [element("tr", heads)]), ...bodies]);
  return element("section", [element("h3", title), element("div", [table], { class: "table", tabindex: "0", role: "group", "aria-label": title })]);
}

function folderOf({ name }) {
  return name.slice(0, name.lastIndexOf("/"));
}

/** The data sets of one folder below the line that opens them, with the store of all restitutions of a pulse. */
function folderBody(folder, own, title) {
  const [, inner] = folder.split("/");
  const open = element("button", PULSES[inner] ?? inner ?? title, { type: "button", class: "open" });
  const copy = stores[folder] ? [element("span", ["all η as one store ", xarrayButton(stores[folder])], { class: "downloads" })] : [];
  const eta = own.map(({ restitution }) => restitution).filter((one) => one !== null);
  const range = [...new Set([Math.min(...eta), Math.max(...eta)])].map((one) => number(one)).join(" to ");
  const facts = [`${own.length} file${own.length > 1 ? "s" : ""}`, ...(eta.length ? [`η ${range}`] : []), sizeOf(own)];
  const head = element("tr", [element("th", [open, element("span", facts.join(", "), { class: "small" }), ...copy], { scope: "rowgroup", colspan: "4" })], { class: "folder" });
  const body = element("tbody", [head, ...own.map((one) => one.row)]);
  open.addEventListener("click", () => {
    body.classList.toggle("opened");
    select();
  });
  return body;
}

function xarrayButton(one) {
  const copy = element("button", "xarray", { type: "button", "aria-label": `copy the line that opens ${one.name} in xarray` });
  copy.addEventListener("click", () => copyLine(one));
  return copy;
}

function row(one) {
  const links = [
    element("a", `netCDF, ${size(one.size)}`, { href: one.netcdf, "aria-label": `netCDF, ${size(one.size)}: ${one.name}` }),
    xarrayButton(one),
    element("a", "about", { href: one.metadata, "aria-label": `about ${one.name}` }),
  ];
  const subset = one.links.find(({ rel }) => rel === "subset");
  if (subset) links.push(element("a", "part", { href: `${subset.href}?${centre(one.extent)}`, "aria-label": `part of ${one.name} as CSV` }));
  const title = element("th", [element("span", one.title), element("code", one.name)], { scope: "row" });
  const cells = [one.restitution === null ? "" : number(one.restitution), extent(one), element("span", links, { class: "downloads" })];
  return element("tr", [title, ...cells.map((cell) => element("td", cell))]);
}

async function copyLine({ name, zarr, netcdf }) {
  const line = zarr ? `xarray.open_zarr("${location.origin}${zarr}")` : `xarray.open_dataset("${location.origin}${netcdf}#mode=bytes", engine="netcdf4")`;
  try {
    await navigator.clipboard.writeText(line);
    setStatus(status, `Copied the line for ${name}.`);
  } catch {
    setStatus(status, line);
  }
}

/** The ranges of a small part in the middle of a cube, as CSV, which the reader can then change in the address. */
function centre({ slenderness: [low, high], frequency_ratio: [from, to] }) {
  const [s, omega] = [(low + high) / 2, Math.sqrt(from * to)];
  const ranges = { slenderness_min: s - 0.02, slenderness_max: s + 0.02, frequency_ratio_min: omega * 0.9, frequency_ratio_max: omega * 1.1 };
  const texts = Object.entries(ranges).map(([name, value]) => [name, number(value)]);
  return new URLSearchParams([...texts, ["format", "csv"]]);
}

/** The ranges of the axes, each in one line. */
function extent({ extent: ranges }) {
  const parts = Object.entries(ranges).filter(([, ends]) => ends).map(([name, ends]) => {
    const texts = new Set(ends.map((end) => (name === "alpha" ? `${number(end * DEGREES)}°` : number(end))));
    return element("span", `${SYMBOLS[name]} ${[...texts].join(" to ")}`);
  });
  return element("span", parts, { class: "extent" });
}

function size(bytes) {
  return bytes < 1e6 ? `${number(bytes / 1e3)} kB` : `${number(bytes / 1e6)} MB`;
}

/** The size of several data sets. */
function sizeOf(several) {
  return size(several.reduce((sum, one) => sum + one.size, 0));
}

/** The data sets that the filters leave. */
function chosen() {
  const words = filter.value.trim().toLowerCase();
  const fits = (one, name) => !choices[name].value || String(one[name]) === choices[name].value;
  return datasets.filter((one) => one.row.cells[0].textContent.toLowerCase().includes(words) && fits(one, "pulse") && fits(one, "restitution"));
}

/** Set the filters to those of the address. */
function recall() {
  const given = new URLSearchParams(location.search);
  for (const field of filters) field.value = given.get(field.id) ?? "";
}

/** Keep the filters in the address, and show what they leave. */
function filtered() {
  const parts = filters.filter(({ value }) => value).map(({ id, value }) => [id, value]);
  history.replaceState(null, "", parts.length ? `?${new URLSearchParams(parts)}` : location.pathname);
  select();
}

function select() {
  const left = chosen();
  const filtered = filters.some(({ value }) => value);
  for (const body of groups.querySelectorAll("tbody")) {
    const open = filtered || body.classList.contains("opened");
    const own = left.filter(({ row }) => row.parentElement === body);
    body.hidden = !own.length;
    body.querySelector(".open").setAttribute("aria-expanded", String(open));
    for (const row of [...body.rows].slice(1)) row.hidden = !open || !own.some((one) => one.row === row);
  }
  for (const part of groups.querySelectorAll("section")) {
    part.hidden = !part.querySelector("tbody:not([hidden])");
    part.querySelector("thead").hidden = !part.querySelector("tbody tr:not([hidden]) > td");
  }
  setStatus(status, datasets.length ? `${left.length} of ${datasets.length} data sets, ${sizeOf(left)}` : "There is no data set here: in a checkout of the sources make reproduce makes them.");
  if (datasets.length && !left.length) status.append(" ", showAll);
}

document.getElementById("sums").addEventListener("click", () => {
  const lines = chosen().filter(({ sha256 }) => sha256).map(({ sha256, netcdf }) => `${sha256}  ${netcdf.replace("/v1/datasets/", "")}\n`);
  save(new Blob(lines), "SHA256SUMS");
  setStatus(status, "The browser saves SHA256SUMS.");
});
for (const field of filters) field.addEventListener("input", filtered);
showAll.addEventListener("click", () => {
  for (const field of filters) field.value = "";
  filtered();
});
show();
