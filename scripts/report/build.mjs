// Makes bundle/report.js, bundle/report.css and bundle/LICENSES.txt. Run by build.sh, with the packages beside it.
import { build } from "esbuild";
import { readFileSync, writeFileSync } from "node:fs";

const LICENSES = [
  ["three", "LICENSE"],
  ["uplot", "LICENSE"],
];

await build({
  entryPoints: { report: "source/main.js" },
  outdir: "bundle",
  bundle: true,
  minify: true,
  format: "iife",
  target: ["chrome110", "firefox115", "safari16.4"],
  charset: "ascii",
  legalComments: "none",
  logLevel: "warning",
});
const script = readFileSync("bundle/report.js", "utf8");
if (/<\/script|<!--/i.test(script))
  throw new Error("bundle/report.js cannot stand inside of a page: it holds '</script' or '<!--'");
const texts = LICENSES.map(([name, file]) => {
  const { version } = JSON.parse(readFileSync(`node_modules/${name}/package.json`, "utf8"));
  return `${name} ${version}\n\n${readFileSync(`node_modules/${name}/${file}`, "utf8").trim()}\n`;
});
writeFileSync(
  "bundle/LICENSES.txt",
  `The file report.js contains parts of these packages.\n\n${texts.join("\n----\n\n")}`,
);
