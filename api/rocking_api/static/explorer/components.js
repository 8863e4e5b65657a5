// Files of a record: one with columns, or several AT2 files, one a component, as columns of one file.

import { Problem } from "./api.js";

const LENGTHS = 1.1; // largest ratio of the numbers of samples of two components
const HEADER = 12; // lines among which an AT2 file has its time step
const UPWARDS = /(up|down|dwn|vert?|vrt|ud|[-_]v|z)$/i; // at the end of the name of a vertical component

/** The file to send, shorter components continued by zeros, the names of its columns, and which of them are the components, as far as that is known. */
export async function joined(files) {
  if (files.length === 1) return { file: files[0], columns: columnsIn(await files[0].slice(0, 8192).text()), chosen: {} };
  const parts = await Promise.all([...files].map(read));
  const { step } = parts[0];
  const other = parts.find((one) => one.step !== step);
  if (other) throw new Problem({ detail: `${other.name} has a time step of ${other.step} s, ${parts[0].name} one of ${step} s` });
  const lengths = parts.map(({ values }) => values.length);
  const length = Math.max(...lengths);
  if (length > LENGTHS * Math.min(...lengths)) throw new Problem({ detail: `the components have ${lengths.join(" and ")} samples` });
  const columns = parts.map(({ name }) => `${name.replace(/[^\w.-]/g, " ")} [g]`);
  const rows = Array.from({ length }, (_, k) => [(k * step).toFixed(9), ...parts.map(({ values }) => values[k] ?? 0)].join());
  const upwards = parts.findIndex(({ name }) => UPWARDS.test(name));
  const [acceleration, second = ""] = columns.filter((_, at) => at !== upwards);
  const text = [["time [s]", ...columns].join(), ...rows].join("\n");
  const file = new File([text], parts.map(({ name }) => name).join(" and "), { lastModified: files[0].lastModified });
  return { file, columns, chosen: { acceleration, second, vertical: columns[upwards] ?? "" } };
}

/** Name, time step [s] and values [g] of an AT2 file. */
async function read(file) {
  const text = await file.text();
  const lines = text.split("\n");
  const at = lines.slice(0, HEADER).findIndex((line) => /\bNPTS\b/i.test(line) && /\bDT\b/i.test(line));
  const found = lines[at]?.match(/\bDT\b\s*[=:]?\s*([\d.eE-]+)/i) ?? lines[at]?.match(/^\s*\d+[\s,]+([\d.eE-]+)/);
  const values = lines.slice(at + 1).join(" ").trim().split(/\s+/);
  if (!found || !/UNITS? OF G\b/i.test(text) || values.some((value) => Number.isNaN(Number(value)))) {
    throw new Problem({ detail: `${file.name} is no AT2 file in g; put components in other formats into columns of one file` });
  }
  return { name: file.name.replace(/\.at2$/i, ""), step: Number(found[1]), values };
}

/** The names of columns in the header of a file. */
function columnsIn(text) {
  const header = text.split(/\r?\n/).find((line) => /[a-z]/i.test(line) && /[,;\t]/.test(line) && !/[:=]/.test(line)) ?? "";
  return header.split(/[,;\t]/).map((name) => name.trim()).filter((name) => name && !/^time\b/i.test(name));
}
