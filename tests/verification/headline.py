#!/usr/bin/python3
"""The figures of the small rig on the report's soil: `furrow run rigs/drawbar_pull_small_report_soil.json --seeds 5`.

Pull, sinkage and rut of one bed are stated with their spread in that scenario's block `expected`, and nowhere else; the
mean over n beds must lie within spread/√n. Five to twenty minutes on two cores. With --results DIR the folder is kept,
and what is done in it is not done again.
"""
import math
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "studies"))
import driver  # noqa: E402

SCENARIO = driver.ROOT / "rigs" / "drawbar_pull_small_report_soil.json"
BEDS = 5
# Figure of the summary, keys of `expected`, unit, scale.
FIGURES = (("drawbar_pull_N", "drawbar_pull", "N", 1.0), ("sinkage_m", "sinkage", "mm", 1e3),
           ("rut_depth_m", "rut_depth", "mm", 1e3))


def outside(summary, expected):
    """Prints every figure beside what is expected. Returns the names of those that are outside."""
    found = []
    for figure, key, unit, scale in FIGURES:
        value, of = expected[key], summary[figure]
        allowed = expected[f"{key}_spread"] / math.sqrt(of["beds"]["n"])
        inside = abs(of["mean"] - value) <= allowed
        print(f"{figure}: {scale * of['mean']:.4g} ± {scale * of['half_width_95']:.2g} {unit} (95 %; from bed to bed "
              f"{scale * of['sd']:.2g}), expected {scale * value:.4g} ± {scale * allowed:.2g}: "
              f"{'within' if inside else 'OUTSIDE'}", flush=True)
        found += [] if inside else [figure]
    return found


def main():
    results = driver.options(__doc__, results={"type": lambda name: pathlib.Path(name).resolve(),
                                               "help": "folder for the beds; kept"}).parse_args().results
    with tempfile.TemporaryDirectory(prefix="furrow_headline_") as holder:
        folder = results or pathlib.Path(holder) / "beds"
        driver.furrow("run", SCENARIO, "--seeds", BEDS, "--out", folder, "--no-plots", progress=True)
        summary = driver.summary(folder)
    if summary["not_steady"]:
        print(f"not steady: {', '.join(summary['not_steady'])}")
    found = outside(summary, driver.read_json(SCENARIO)["expected"])
    return f"outside the stated interval over {summary['beds']['n']} beds: {', '.join(found)}" if found else 0


if __name__ == "__main__":
    sys.exit(main())
