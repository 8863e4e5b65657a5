// A line chart by uPlot in the colours of the page, as wide as its container.

import { Problem } from "./api.js";
import { decades, spread } from "./axes.js";
import { onTheme, themed } from "./colours.js";
import { number } from "./labels.js";
import { fontOf, onTextSize, textScale } from "./text.js";

const SPACE = [50, 30]; // [px] between the ticks of the two axes, at least
const LABEL_SPACE = [36, 20]; // [px] between the labels of logarithmic ones
const SOURCE = "/static/uplot/uPlot.iife.min.js";

const live = new Map(); // by place: what is drawn there, and how it is made
const pen = document.createElement("canvas").getContext("2d"); // measures texts
let loading = null; // promise of uPlot, a third of the bytes of the page: it is loaded for the first chart

/** Resolves once charts can be drawn. */
export function chartsReady() {
  loading ??= new Promise((resolve, reject) => {
    const script = document.createElement("script");
    script.addEventListener("load", resolve);
    script.addEventListener("error", () => {
      loading = null;
      script.remove();
      reject(new Problem({ detail: "the service does not answer (a part of the page is missing)" }));
    });
    script.src = SOURCE;
    document.head.append(script);
  });
  return loading;
}

/** An axis with a title; sizes are px where the text of the page has 16 px. */
export function axis(label, more = {}) {
  return {
    ...(label && { label, labelSize: 20 }),
    labelGap: 2,
    size: 44,
    values: (_, splits) => splits.map((value) => number(value, 4)),
    stroke: () => themed("ink"),
    grid: { stroke: () => themed("line"), width: 1 },
    ticks: { stroke: () => themed("muted"), width: 1, size: 4 },
    ...more,
  };
}

/** A logarithmic axis with a title, with labels at round values that do not touch each other. */
export function logAxis(label, more = {}) {
  // those of uPlot begin at the low end of the scale and are not round from 10 on
  const splits = (_, at, low, high) => decades(low, high).filter((value) => Number(value.toPrecision(1)) === value);
  const values = (u, places, at) => {
    const labelled = spread(places, (value) => u.valToPos(value, "xy"[at]), LABEL_SPACE[at] * textScale());
    return places.map((value) => (labelled.includes(value) ? number(value, 3) : ""));
  };
  return axis(label, { filter: (_, places) => places, splits, values, ...more });
}

/**
 * A chart in `place`, which replaces the one before; options as in uPlot, without width, and the height in px where the text of
 * the page has 16 px. It is made again when that text changes its size: what it needs besides is done by its hook `ready`.
 */
export function chart(place, options, data) {
  const make = () => {
    live.get(place)?.made.destroy();
    const width = Math.max(place.clientWidth, 120);
    const made = new uPlot(
      {
        legend: { show: false },
        cursor: { drag: { setScale: false, x: false, y: false }, points: { show: false } },
        ...options,
        axes: withText(options.axes, width),
        width,
        height: options.height * textScale(),
      },
      data,
      place,
    );
    live.set(place, { made, make });
  };
  make();
  sizes.observe(place); // once more has no effect
}

/** Axes in the size of the text; the title below is smaller where it is longer than the chart is wide. */
function withText(axes, width) {
  const scale = textScale();
  const beside = axes[1].size + (axes[1].labelSize ?? 0);
  pen.font = fontOf(12);
  const shrink = Math.min(1, (width - beside * scale) / pen.measureText(axes[0].label ?? "").width);
  return axes.map(({ size, labelSize = 0, space, ...rest }, at) => ({
    ...rest,
    font: fontOf(12),
    labelFont: fontOf(at ? 12 : 12 * shrink),
    size: size * scale,
    labelSize: labelSize * scale,
    space: (space ?? SPACE[at]) * scale,
  }));
}

/** A dashed vertical line over the height of a chart at a value of its x axis, if that is in view. */
export function markValue(u, value) {
  const { ctx, bbox } = u;
  const x = u.valToPos(value, "x", true);
  if (!(x >= bbox.left && x <= bbox.left + bbox.width)) return;
  ctx.save();
  ctx.strokeStyle = themed("ink");
  ctx.lineWidth = 1.5 * devicePixelRatio;
  ctx.setLineDash([6 * devicePixelRatio, 4 * devicePixelRatio]);
  ctx.beginPath();
  ctx.moveTo(x, bbox.top);
  ctx.lineTo(x, bbox.top + bbox.height);
  ctx.stroke();
  ctx.restore();
}

/** The canvas of a chart, for a picture of it. */
export function canvasOf(place) {
  return place.querySelector("canvas");
}

const sizes = new ResizeObserver((entries) => {
  for (const { target } of entries) {
    const { made } = live.get(target) ?? {};
    if (made && target.clientWidth) made.setSize({ width: target.clientWidth, height: made.height });
  }
});

onTheme(() => live.forEach(({ made }) => made.redraw(false)));
onTextSize(() => live.forEach(({ make }) => make()));
