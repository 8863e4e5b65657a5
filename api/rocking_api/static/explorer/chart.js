// A line chart by uPlot in the colours of the page, as wide as its container.

import { Problem } from "./api.js";
import { onTheme, themed } from "./colours.js";
import { number } from "./labels.js";

const FONT = "12px system-ui, sans-serif";

const SOURCE = "/static/uplot/uPlot.iife.min.js";

const live = new Map();
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

/** An axis with a title. */
export function axis(label, more = {}) {
  return {
    ...(label && { label, labelFont: FONT, labelSize: 20 }),
    labelGap: 2,
    font: FONT,
    size: 44,
    values: (_, splits) => splits.map((value) => number(value, 4)),
    stroke: () => themed("ink"),
    grid: { stroke: () => themed("line"), width: 1 },
    ticks: { stroke: () => themed("muted"), width: 1, size: 4 },
    ...more,
  };
}

/** A chart in `place`, which replaces the one before; options as in uPlot, without width. */
export function chart(place, options, data) {
  live.get(place)?.destroy();
  const made = new uPlot(
    {
      legend: { show: false },
      cursor: { drag: { setScale: false, x: false, y: false }, points: { show: false } },
      ...options,
      width: Math.max(place.clientWidth, 120),
    },
    data,
    place,
  );
  live.set(place, made);
  sizes.observe(place); // once more has no effect
  return made;
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
    const made = live.get(target);
    if (made && target.clientWidth) made.setSize({ width: target.clientWidth, height: made.height });
  }
});

onTheme(() => live.forEach((made) => made.redraw(false)));
