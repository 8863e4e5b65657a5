// The page of the data sets: the catalogue as a table with links.

import { ask } from "./api.js";
import { number } from "./labels.js";
import { element, setStatus } from "./page.js";

const SYMBOLS = { slenderness: "1/a", frequency_ratio: "ω", alpha: "α" };
const DEGREES = 180 / Math.PI;

const rows = document.getElementById("rows");
const status = document.getElementById("status");
const filter = document.getElementById("filter");

async function show() {
  try {
    const { datasets } = await ask("/v1/datasets", {}, new AbortController().signal);
    rows.replaceChildren(...datasets.map(row));
    select();
  } catch (problem) {
    setStatus(status, problem, show);
  }
}

function row(one) {
  const links = [
    element("a", "nc", { href: one.netcdf, "aria-label": `${one.name} as netCDF` }),
    element("a", "about", { href: one.metadata, "aria-label": `description of ${one.name}` }),
  ];
  const subset = one.links.find(({ rel }) => rel === "subset");
  if (subset) links.push(element("a", "part", { href: `${subset.href}?${centre(one.extent)}`, "aria-label": `part of ${one.name} as CSV` }));
  const spaced = links.flatMap((link, at) => (at ? [" ", link] : [link]));
  const title = element("th", [element("span", one.title), element("code", one.name)], { scope: "row" });
  const cells = [one.restitution === null ? "" : number(one.restitution), extent(one), size(one.size), spaced];
  return element("tr", [title, ...cells.map((cell) => element("td", cell))]);
}

/** The ranges of a small part in the middle of a cube, as CSV, which the reader can then change in the address. */
function centre({ slenderness: [low, high], frequency_ratio: [from, to] }) {
  const [s, omega] = [(low + high) / 2, Math.sqrt(from * to)];
  const ranges = { slenderness_min: s - 0.02, slenderness_max: s + 0.02, frequency_ratio_min: omega * 0.9, frequency_ratio_max: omega * 1.1 };
  const texts = Object.entries(ranges).map(([name, value]) => [name, number(value)]);
  return new URLSearchParams([...texts, ["format", "csv"]]);
}

function extent({ extent: ranges }) {
  return Object.entries(ranges)
    .map(([name, ends]) => {
      const texts = ends.map((end) => (name === "alpha" ? `${number(end * DEGREES)}°` : number(end)));
      return `${SYMBOLS[name]} ${texts.join(" to ")}`;
    })
    .join("; ");
}

function size(bytes) {
  return bytes < 1e6 ? `${number(bytes / 1e3)} kB` : `${number(bytes / 1e6)} MB`;
}

function select() {
  const wanted = filter.value.trim().toLowerCase();
  for (const one of rows.children) one.hidden = !one.cells[0].textContent.toLowerCase().includes(wanted);
  const count = [...rows.children].filter((one) => !one.hidden).length;
  setStatus(status, `${count} of ${rows.children.length} data sets`);
}

filter.addEventListener("input", select);
show();
