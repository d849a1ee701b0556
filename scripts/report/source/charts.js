// Plots with uPlot: hover, zoom, the averaging window and levels with their intervals.
import uPlot from "uplot";
import { curve, grid, ink, windowTint } from "./colours.js";
import { digits, el } from "./data.js";

const sync = uPlot.sync("time");
const COUNTED = new Set(["run", "bed", "pass"]); // values of x that are whole numbers
const WHOLE = [1, 2, 5, 10, 20, 50, 100, 500, 1000]; // steps between ticks of whole numbers
const drawn = new Set(); // plots that exist, to be drawn again in another theme

/** One common x for lines that have their own; missing values are gaps that are spanned. */
function aligned(lines, arrays) {
  const tables = lines.map((line) => [arrays.get(line.x), arrays.get(line.y)]);
  const nulls = (values) => Array.from(values, (v) => (Number.isNaN(v) ? null : v));
  if (tables.every(([x]) => x === tables[0][0])) return [tables[0][0], ...tables.map(([, y]) => nulls(y))];
  const joined = uPlot.join(
    tables.map(([x, y]) => [Array.from(x), nulls(y)]),
    tables.map(() => [0, 2]),
  );
  return joined;
}

/** The averaging window behind the curves. */
function drawWindow(u, window) {
  const [a, b] = window.map((t) => u.valToPos(t, "x", true));
  const { left, top, width, height } = u.bbox;
  const from = Math.max(a, left),
    to = Math.min(b, left + width);
  if (to <= from) return;
  u.ctx.fillStyle = windowTint();
  u.ctx.fillRect(from, top, to - from, height);
}

function drawLevels(u, levels, window) {
  const { ctx, bbox } = u;
  ctx.save();
  for (const level of levels) {
    const span = window ? window.map((t) => u.valToPos(t, "x", true)) : [bbox.left, bbox.left + bbox.width];
    const from = Math.max(span[0], bbox.left),
      to = Math.min(span[1], bbox.left + bbox.width);
    if (to <= from) continue;
    if (level.half) {
      const low = u.valToPos(level.y - level.half, "y", true),
        high = u.valToPos(level.y + level.half, "y", true);
      ctx.fillStyle = curve(0) + "33";
      ctx.fillRect(from, high, to - from, low - high);
    }
    ctx.strokeStyle = curve(0);
    ctx.lineWidth = 2 * devicePixelRatio;
    ctx.beginPath();
    const y = u.valToPos(level.y, "y", true);
    ctx.moveTo(from, y);
    ctx.lineTo(to, y);
    ctx.stroke();
  }
  ctx.restore();
}

function drawWhiskers(u, lines, arrays) {
  const { ctx } = u;
  ctx.save();
  ctx.lineWidth = 1.5 * devicePixelRatio;
  lines.forEach((line, k) => {
    if (line.low == null || !u.series[k + 1].show) return;
    const [x, low, high] = [line.x, line.low, line.high].map((n) => arrays.get(n));
    ctx.strokeStyle = curve(k);
    ctx.beginPath();
    for (let i = 0; i < x.length; i++) {
      if (Number.isNaN(low[i]) || low[i] === high[i]) continue;
      const at = u.valToPos(x[i], "x", true),
        a = u.valToPos(low[i], "y", true),
        b = u.valToPos(high[i], "y", true);
      const cap = 4 * devicePixelRatio;
      ctx.moveTo(at, a);
      ctx.lineTo(at, b);
      for (const y of [a, b]) {
        ctx.moveTo(at - cap, y);
        ctx.lineTo(at + cap, y);
      }
    }
    ctx.stroke();
  });
  ctx.restore();
}

/** Lowest and highest value that must be seen, whiskers and levels included. */
function rangeOf(chart, arrays) {
  const wanted = chart.levels.flatMap((level) => [level.y - (level.half || 0), level.y + (level.half || 0)]);
  for (const line of chart.lines)
    if (line.low != null)
      for (const n of [line.low, line.high]) wanted.push(...arrays.get(n).filter((v) => !Number.isNaN(v)));
  return wanted;
}

function options(chart, arrays, width) {
  const axis = (label, unit) => ({
    label: unit ? `${label}, ${unit}` : label,
    labelSize: 22,
    labelFont: "12px system-ui, sans-serif",
    font: "11px system-ui, sans-serif",
    stroke: ink,
    grid: { stroke: grid, width: 1 },
    ticks: { stroke: grid, width: 1 },
  });
  const time = chart.x === "time",
    wanted = rangeOf(chart, arrays);
  const points = chart.lines.every((line) => line.style === "points");
  const monotonic = chart.lines.every((line) => arrays.get(line.x).every((v, i, x) => i === 0 || v >= x[i - 1]));
  const base = {
    width,
    height: chart.wide ? 380 : 240,
    ms: 1,
    scales: {
      x: { time: false, range: points ? (u, low, high) => pad(low, high, 0.06) : undefined },
      y: {
        range:
          chart.clip ??
          (chart.whole
            ? (u, low, high) => [low - 0.5, high + 0.5]
            : (u, low, high) =>
                pad(Math.min(low ?? Infinity, ...wanted), Math.max(high ?? -Infinity, ...wanted), 0.06)),
      },
    },
    axes: [
      { ...axis(chart.x, chart.x_unit), ...(COUNTED.has(chart.x) ? { incrs: WHOLE } : {}) },
      {
        ...axis("", ""),
        label: undefined,
        size: 58,
        values: (u, ticks) => ticks.map((v) => shortTick(v)),
        ...(chart.whole ? { incrs: WHOLE } : {}),
      },
    ],
    cursor: { drag: { x: true, y: false }, sync: time ? { key: sync.key, scales: ["x", null] } : undefined },
    legend: { live: true },
    series: [
      { label: chart.x, value: (u, v) => (v == null ? "–" : `${digits(v)} ${chart.x_unit}`) },
      ...chart.lines.map((line, k) => ({
        label: line.label,
        stroke: () => curve(k),
        width: 1.5,
        dash: line.dash,
        spanGaps: true,
        paths:
          line.style === "points" && chart.lines.length > 1 && arrays.get(line.x).length === 1
            ? () => null
            : undefined,
        points: { show: line.style === "points", size: 8, fill: () => curve(k) },
        value: (u, v) => (v == null ? "–" : `${digits(v)} ${chart.unit}`.trim()),
      })),
    ],
    hooks: {
      drawClear: [(u) => chart.window && time && drawWindow(u, chart.window)],
      draw: [
        (u) => drawLevels(u, chart.levels, time ? chart.window : null),
        (u) => drawWhiskers(u, chart.lines, arrays),
      ],
    },
  };
  return { base, monotonic };
}

function shortTick(value) {
  const size = Math.abs(value);
  if (size >= 1e6 || (size > 0 && size < 1e-3)) return value.toExponential(1).replace("e+", "e").replace(".0e", "e");
  return String(Number(value.toPrecision(6)));
}

function pad(low, high, share) {
  if (!Number.isFinite(low) || !Number.isFinite(high)) return [0, 1];
  const span = high - low || Math.abs(high) || 1;
  return [low - share * span, high + share * span];
}

/** Curves whose x does not increase (a path, loading and unloading): drawn as uPlot's second kind of plot, without
 * snapping. */
function pathOptions(chart, arrays, base) {
  const boxes = chart.lines.map((line) => [arrays.get(line.x), arrays.get(line.y)]);
  const span = (k) => {
    let low = Infinity,
      high = -Infinity;
    for (const box of boxes)
      for (const v of box[k])
        if (!Number.isNaN(v)) {
          low = Math.min(low, v);
          high = Math.max(high, v);
        }
    return pad(low, high, 0.06);
  };
  const draw = (k) => (u) => {
    const [x, y] = boxes[k - 1];
    const path = new Path2D();
    let begun = false;
    for (let i = 0; i < x.length; i++) {
      if (Number.isNaN(x[i]) || Number.isNaN(y[i])) {
        begun = false;
        continue;
      }
      const px = u.valToPos(x[i], "x", true),
        py = u.valToPos(y[i], "y", true);
      if (begun) path.lineTo(px, py);
      else path.moveTo(px, py);
      begun = true;
    }
    u.ctx.save();
    u.ctx.strokeStyle = curve(k - 1);
    u.ctx.lineWidth = 1.5 * devicePixelRatio;
    u.ctx.stroke(path);
    u.ctx.restore();
    return null;
  };
  const made = { ...base, mode: 2, legend: { live: false }, cursor: { drag: { x: true, y: true } } };
  made.scales = {
    x: { time: false, range: (u, low, high) => (u.zoomed ? [low, high] : span(0)) },
    y: { range: (u, low, high) => (u.zoomed ? [low, high] : span(1)) },
  };
  made.series = [
    {},
    ...chart.lines.map((line, k) => ({
      label: line.label,
      stroke: () => curve(k),
      paths: (u, n) => draw(n)(u),
      facets: [
        { scale: "x", auto: true },
        { scale: "y", auto: true },
      ],
    })),
  ];
  made.hooks = { draw: [(u) => drawWhiskers(u, chart.lines, arrays)] };
  return [made, [null, ...boxes.map((box) => [Array.from(box[0]), Array.from(box[1])])]];
}

/** The plot in its frame. It is made when it comes into view. */
export function chart(description, arrays) {
  const place = el("div", { class: "plot" });
  const title = description.unit ? `${description.title}, ${description.unit}` : description.title;
  const frame = el(
    "figure",
    { class: description.wide ? "chart wide" : "chart" },
    el("figcaption", {}, title, description.note ? el("span", {}, ` (${description.note})`) : null),
    place,
  );
  let plot = null;
  const make = () => {
    const { base, monotonic } = options(description, arrays, Math.max(place.clientWidth, 200));
    if (monotonic) plot = new uPlot(base, aligned(description.lines, arrays), place);
    else plot = new uPlot(...pathOptions(description, arrays, base), place);
    if (description.lines.length === 1 && monotonic) plot.root.classList.add("single");
    drawn.add(plot);
    new ResizeObserver(() => {
      const width = Math.max(place.clientWidth, 200);
      if (width !== plot.width) plot.setSize({ width, height: plot.height });
    }).observe(place);
  };
  place.style.minHeight = `${(description.wide ? 380 : 240) + 24}px`;
  const seen = new IntersectionObserver(
    (entries) => {
      if (!entries.some((entry) => entry.isIntersecting) || plot) return;
      seen.disconnect();
      make();
      frame.dataset.drawn = "yes";
    },
    { rootMargin: "300px" },
  );
  seen.observe(place);
  return frame;
}

/** A list from which one of many plots is chosen. */
export function explorer(block, arrays) {
  const place = el("div", { class: "charts" });
  const choice = el(
    "select",
    {
      onchange: () =>
        place.replaceChildren(...(choice.value === "" ? [] : [chart(block.charts[choice.value], arrays)])),
    },
    el("option", { value: "" }, `choose one of ${block.charts.length} more curves …`),
    ...block.charts.map((one, k) =>
      el("option", { value: String(k) }, one.unit ? `${one.title}, ${one.unit}` : one.title),
    ),
  );
  return el("div", { class: "explorer" }, el("label", {}, "Other curves: ", choice), place);
}

export function redraw() {
  for (const plot of drawn) {
    if (!plot.root.isConnected) drawn.delete(plot);
    else plot.redraw(false, true);
  }
}
