// Draws the page that page/write.py describes.
import * as charts from "./charts.js";
import { bytes, Arrays, el } from "./data.js";
import { ground, scatter } from "./ground.js";
import * as player from "./playback.js";
import "uplot/dist/uPlot.min.css";
import "./style.css";

const MAKERS = {
  text: (block) => el("p", { class: `text ${block.kind}` }, ...commands(block.text)),
  cards: (block) => el("div", { class: "cards" }, ...block.cards.map(card)),
  table,
  bars: (block) =>
    el("div", { class: "bars" }, ...block.rows.map(bar), block.note ? el("p", { class: "note" }, block.note) : null),
  charts: (block, arrays) =>
    el(
      "div",
      {},
      el("div", { class: "charts" }, ...block.charts.map((one) => charts.chart(one, arrays))),
      block.note ? el("p", { class: "note" }, block.note) : null,
    ),
  explorer: charts.explorer,
  ground,
  scatter,
  playback: player.playback,
  fold: (block, arrays) =>
    el("details", {}, el("summary", {}, block.title), ...block.blocks.map((one) => draw(one, arrays))),
};

const draw = (block, arrays) => MAKERS[block.type](block, arrays);

/** A sentence whose commands in quotes, such as 'furrow run NAME', are set as code. */
const commands = (words) => words.split(/'(furrow [^']*)'/).map((part, k) => (k % 2 ? el("code", {}, part) : part));

function card(one) {
  return el(
    "div",
    { class: `card ${one.kind}` },
    el("span", { class: "name" }, one.name),
    el("span", { class: "value" }, one.value, " ", el("small", {}, one.unit)),
    el(
      "span",
      { class: "interval" },
      [one.interval ? `${one.interval} interval` : "", one.explanation].filter(Boolean).join(" · "),
    ),
  );
}

function bar(row) {
  return el(
    "div",
    { class: "bar" },
    el("span", {}, row.label),
    el("i", {}, el("b", { style: `width:${Math.min(Math.max(100 * row.share, 0), 100)}%` })),
    el("span", {}, row.text),
  );
}

function table(block) {
  const marked = new Set(block.marked);
  const numeric = block.columns.map(
    (_, c) => block.rows.length > 0 && block.rows.every((row) => /^[−+\-\d.,\s±e…–]*$/.test(row[c] ?? "")),
  );
  const rows = block.rows.map((row, k) =>
    el(
      "tr",
      { class: marked.has(k) ? "marked" : "" },
      ...row.map((cell, c) =>
        el("td", { class: numeric[c] ? "number" : c === 0 && cell.length < 32 ? "name" : "" }, cell),
      ),
    ),
  );
  const head = block.columns.some(Boolean)
    ? el("thead", {}, el("tr", {}, ...block.columns.map((name) => el("th", {}, name))))
    : null;
  const body = el("tbody", {}, ...rows);
  const made = el("div", { class: "table" }, el("table", {}, head, body));
  const parts = [made];
  if (block.only_marked && marked.size < rows.length) {
    const only = el("input", { type: "checkbox", onchange: () => made.classList.toggle("only", only.checked) });
    parts.unshift(el("label", { class: "box" }, only, ` ${block.only_marked} (${marked.size} of ${rows.length})`));
  }
  if (block.note) parts.push(el("p", { class: "note" }, block.note));
  return el("div", {}, ...parts);
}

function theme(name) {
  document.documentElement.dataset.theme = name;
  charts.redraw();
  player.redraw();
}

async function main() {
  const text = document.getElementById("document").textContent;
  const page = JSON.parse(text);
  const prefers = matchMedia("(prefers-color-scheme: dark)");
  theme(prefers.matches ? "dark" : "light");
  prefers.addEventListener("change", () => theme(prefers.matches ? "dark" : "light"));
  const arrays = new Arrays(await bytes("numbers"), page.arrays);
  const root = document.getElementById("page");
  const swap = el(
    "button",
    {
      type: "button",
      class: "theme",
      onclick: () => theme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"),
    },
    "light / dark",
  );
  root.append(
    el(
      "header",
      {},
      el("h1", {}, page.title),
      ...page.badges.map((badge) => el("span", { class: `badge ${badge.kind}` }, badge.text)),
      swap,
    ),
    el("nav", {}, ...page.sections.map((section) => el("a", { href: `#${section.id}` }, section.title))),
  );
  for (const section of page.sections)
    root.append(
      el(
        "section",
        { id: section.id },
        el("h2", {}, section.title),
        ...section.blocks.map((block) => draw(block, arrays)),
      ),
    );
  if (page.left_out.length)
    root.append(
      el(
        "section",
        { id: "left-out" },
        el("h2", {}, "Not shown"),
        el("ul", {}, ...page.left_out.map((line) => el("li", {}, line))),
      ),
    );
  document.documentElement.dataset.ready = "yes";
}

main().catch((error) => {
  document
    .getElementById("page")
    .append(
      el(
        "p",
        { class: "text bad" },
        `This page could not be drawn: ${error.message}. Browsers of 2023 and later can.`,
      ),
    );
  throw error;
});
