// The outline of an object: its corners as text, and the same corners on a grid, where a tap adds one.

const text = document.getElementById("vertices");
const drawing = document.getElementById("drawing");
const extent = document.getElementById("extent");

const STEPS = 20; // of the grid; a tap is rounded to a fifth of one

/** The corners that can be read [cm]. */
function corners() {
  return text.value
    .split(/[;\n]/)
    .map((line) => line.replaceAll(",", " ").trim().split(/\s+/).map(Number))
    .filter((pair) => pair.length === 2 && pair.every(Number.isFinite));
}

function draw() {
  const size = Number(extent.value);
  const margin = size / STEPS;
  drawing.setAttribute("viewBox", `${-margin} ${-size - margin} ${size + 2 * margin} ${size + 2 * margin}`);
  const lines = Array.from({ length: STEPS + 1 }, (_, k) => (k * size) / STEPS).map((at) => `M ${at} 0 V ${-size} M 0 ${-at} H ${size}`);
  const points = corners();
  const path = points.map(([x, y]) => `${x},${-y}`).join(" ");
  drawing.replaceChildren(
    shape("path", { class: "grid", d: lines.join(" ") }),
    shape("polygon", { class: "area", points: path }),
    ...points.map(([x, y], at) => shape("circle", { class: at === points.length - 1 ? "last" : "corner", cx: x, cy: -y, r: size / 80 })),
  );
}

function shape(name, attributes) {
  const made = document.createElementNS(drawing.namespaceURI, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}

drawing.addEventListener("click", (event) => {
  const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(drawing.getScreenCTM().inverse());
  const step = Number(extent.value) / STEPS / 5;
  const [across, up] = [x, -y].map((value) => Number((Math.max(0, Math.round(value / step)) * step).toFixed(3)));
  text.value = `${text.value.trimEnd()}\n${across}, ${up}`.trimStart();
  draw();
});
document.getElementById("undo").addEventListener("click", () => {
  text.value = text.value.trimEnd().split("\n").slice(0, -1).join("\n");
  draw();
});
text.addEventListener("input", draw);
extent.addEventListener("change", draw);
const largest = Math.max(...corners().flat(), 0);
extent.value = [...extent.options].map(({ value }) => value).find((value) => Number(value) >= largest) ?? extent.options[extent.options.length - 1].value;
draw();
