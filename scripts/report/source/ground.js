// The height field of the ground as a map with cross-sections, and maps of points.
import { chart } from "./charts.js";
import { colour, css } from "./colours.js";
import { digits, el } from "./data.js";

/** Arrays made here, not stored in the page. */
class Local {
  constructor() {
    this.held = [];
  }
  add(values) {
    return this.held.push(Float32Array.from(values)) - 1;
  }
  get(number) {
    return this.held[number];
  }
}

function span(values, share) {
  const sorted = values
    .filter((v) => !Number.isNaN(v))
    .map(Math.abs)
    .sort(); // a Float32Array sorts by value
  return sorted.length ? sorted[Math.floor(share * (sorted.length - 1))] || 1 : 1;
}

function bar(map, low, high, label) {
  return el(
    "div",
    { class: "scale" },
    el("span", {}, low),
    el("i", { style: `background:${css(map)}` }),
    el("span", {}, high),
    el("b", {}, label),
  );
}

function section(field, along, index) {
  const { block, before, after, at } = field,
    local = new Local();
  const count = along ? block.nx : block.ny;
  const cell = (i) => (along ? at(i, index) : at(index, i));
  const x = local.add(Array.from({ length: count }, (_, i) => (along ? block.x0 : block.y0) + i * block.cell));
  const lines = [
    ["before", before],
    ["after", after],
  ].map(([label, z]) => ({
    label,
    x,
    y: local.add(Array.from({ length: count }, (_, i) => z[cell(i)])),
    style: "line",
  }));
  const where = along
    ? `y = ${digits(block.y0 + index * block.cell)} m`
    : `x = ${digits(block.x0 + index * block.cell)} m`;
  return chart(
    {
      title: along ? `Height along the path at ${where}` : `Height across at ${where}`,
      x: along ? "x" : "y",
      x_unit: "m",
      unit: "mm",
      lines,
      window: null,
      levels: [],
    },
    local,
  );
}

/** The change of the surface as a map. */
export function ground(block, arrays) {
  const before = arrays.get(block.before),
    after = arrays.get(block.after);
  const at = (i, j) => i * block.ny + j;
  const field = { block, before, after, at };
  const change = after.map((z, k) => z - before[k]);
  const most = Number(span(change, 0.98).toPrecision(2));
  const canvas = el("canvas", { class: "map", width: block.nx, height: block.ny });
  const image = new ImageData(block.nx, block.ny),
    rgb = [0, 0, 0];
  for (let i = 0; i < block.nx; i++)
    for (let j = 0; j < block.ny; j++) {
      const value = change[at(i, j)],
        k = 4 * ((block.ny - 1 - j) * block.nx + i);
      if (Number.isNaN(value)) continue;
      colour("earth", 0.5 + (0.5 * value) / most, rgb);
      image.data.set([...rgb, 255], k);
    }
  canvas.getContext("2d").putImageData(image, 0, 0);
  canvas.style.aspectRatio = `${block.nx} / ${Math.max(block.ny, block.nx / 12)}`;
  const words = el("div", { class: "reading" }, "Move over the map.");
  const cuts = el("div", { class: "charts" });
  const place = (event) => {
    const box = canvas.getBoundingClientRect();
    const i = Math.floor(((event.clientX - box.left) / box.width) * block.nx);
    const j = block.ny - 1 - Math.floor(((event.clientY - box.top) / box.height) * block.ny);
    return [Math.min(Math.max(i, 0), block.nx - 1), Math.min(Math.max(j, 0), block.ny - 1)];
  };
  const cut = (i, j) => cuts.replaceChildren(section(field, false, i), section(field, true, j));
  canvas.addEventListener("pointermove", (event) => {
    const [i, j] = place(event);
    words.textContent =
      `x ${digits(block.x0 + i * block.cell)} m, y ${digits(block.y0 + j * block.cell)} m: ` +
      `change ${digits(change[at(i, j)])} mm, height ${digits(after[at(i, j)])} mm`;
  });
  canvas.addEventListener("click", (event) => cut(...place(event)));
  cut(Math.floor(block.nx / 2), Math.floor(block.ny / 2));
  return el(
    "div",
    { class: "ground" },
    canvas,
    bar("earth", `−${digits(most)} mm`, `+${digits(most)} mm`, "change of the height"),
    words,
    cuts,
  );
}

/** Points coloured by value, such as the pressure in a footprint. */
export function scatter(block, arrays) {
  const [x, y, values] = [block.x, block.y, block.values].map((n) => arrays.get(n));
  const most = Math.max(...values, 1e-9);
  const low = [Math.min(...x), Math.min(...y)],
    high = [Math.max(...x), Math.max(...y)];
  const scale = Math.min(760 / (high[0] - low[0] || 1), 420 / (high[1] - low[1] || 1));
  const canvas = el("canvas", {
    class: "map points",
    width: Math.ceil((high[0] - low[0]) * scale) + 40,
    height: Math.ceil((high[1] - low[1]) * scale) + 40,
  });
  const context = canvas.getContext("2d");
  const position = (k) => [20 + (x[k] - low[0]) * scale, canvas.height - 20 - (y[k] - low[1]) * scale];
  for (let k = 0; k < x.length; k++) {
    context.fillStyle = `rgb(${colour("viridis", values[k] / most).map(Math.round)})`;
    const [a, b] = position(k);
    context.fillRect(a - 4, b - 4, 8, 8);
  }
  const words = el("div", { class: "reading" }, "Move over the points.");
  const size =
    `Drawn to scale, along the travel from left to right. The outermost points are ` +
    `${digits(high[0] - low[0])} mm apart along it and ` +
    `${digits(high[1] - low[1])} mm across.`;
  canvas.addEventListener("pointermove", (event) => {
    const box = canvas.getBoundingClientRect();
    const at = [
      ((event.clientX - box.left) / box.width) * canvas.width,
      ((event.clientY - box.top) / box.height) * canvas.height,
    ];
    let best = 0,
      near = Infinity;
    for (let k = 0; k < x.length; k++) {
      const [a, b] = position(k),
        distance = (a - at[0]) ** 2 + (b - at[1]) ** 2;
      if (distance < near) [best, near] = [k, distance];
    }
    const where = `along ${digits(x[best])} mm, across ${digits(y[best])} mm`;
    words.textContent = `${where}: ${digits(values[best])} ${block.unit}`;
  });
  return el(
    "div",
    { class: "ground" },
    canvas,
    bar("viridis", "0", `${digits(most)} ${block.unit}`, block.label),
    el("p", { class: "note" }, size),
    words,
  );
}
