#!/usr/bin/python3
"""The figures of the front page, over five beds: `furrow run rigs/drawbar_pull_small.json --seeds 5`.

Pull, sinkage and rut of one bed are stated with their spread in that scenario's block `expected`, and nowhere else; the
mean over n beds must lie within spread/√n. Five to twenty minutes on two cores. With --results DIR the folder is kept,
and what is done in it is not done again.
"""
import argparse
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("FURROW", str(ROOT / "build" / "furrow"))
SCENARIO = ROOT / "rigs" / "drawbar_pull_small.json"
BEDS = 5
# Figure of the summary, keys of `expected`, unit, scale.
FIGURES = (("drawbar_pull_N", "drawbar_pull", "N", 1.0), ("sinkage_m", "sinkage", "mm", 1e3),
           ("rut_depth_m", "rut_depth", "mm", 1e3))


def outside(summary, expected):
    """Prints every figure beside what is expected. Returns the names of those that are outside."""
    found = []
    for figure, key, unit, scale in FIGURES:
        value, spread = expected[key], expected[f"{key}_spread"]
        of = summary[figure]
        allowed = spread / math.sqrt(of["beds"]["n"])
        inside = abs(of["mean"] - value) <= allowed
        print(f"{figure}: {scale * of['mean']:.4g} ± {scale * of['half_width_95']:.2g} {unit} (95 %; from bed to bed "
              f"{scale * of['sd']:.2g}), "
              f"expected {scale * value:.4g} ± {scale * allowed:.2g}: {'within' if inside else 'OUTSIDE'}", flush=True)
        if not inside:
            found.append(figure)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--results", type=pathlib.Path, help="folder for the beds; kept")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="furrow_headline_") as holder:
        folder = arguments.results or pathlib.Path(holder) / "beds"
        done = subprocess.run([PROGRAM, "run", SCENARIO, "--seeds", str(BEDS), "--out", folder, "--no-plots"],
                              stdout=subprocess.DEVNULL)
        if done.returncode != 0:
            return f"furrow ended with exit code {done.returncode}"
        summary = json.loads((folder / "summary.json").read_text())
    if summary["not_steady"]:
        print(f"not steady: {', '.join(summary['not_steady'])}")
    expected = json.loads(SCENARIO.read_text())["expected"]
    found = outside(summary, expected)
    return f"outside the stated interval over {summary['beds']['n']} beds: {', '.join(found)}" if found else 0


if __name__ == "__main__":
    sys.exit(main())
