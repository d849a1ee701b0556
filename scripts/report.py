#!/usr/bin/python3
"""Plots of a run, of soil tests, of a pressed tire or of a study: PNG files in the run directory; their names, without the folder, as a JSON list on stdout.

usage: report.py DIR [--out FOLDER] [--only NAME]...

Every plot is made from what the directory holds; a plot whose data are missing is left out with a word on stderr.
Exit codes: 0 at least one plot was written, 5 a file could not be read or written.
"""
import argparse
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from plot import charts, ground, press, scene, soil, sweep  # noqa: E402
from plot.run_data import Missing, Run  # noqa: E402

PLOTS = {
    "pull_slip_sinkage": charts.pull_slip_sinkage,
    "forces": charts.forces,
    "rut": ground.rut,
    "ranks": charts.ranks,
    "energy": charts.energy,
    "scene": scene.scene,
}
SWEEP_PLOTS = {"curve": sweep.curve, "passes": sweep.passes, "rut_along": sweep.rut_along}
SOIL_PLOTS = {"plate": soil.plate, "shear": soil.shear, "cone": soil.cone, "repose": soil.repose}
PRESS_PLOTS = {"load_deflection": press.load_deflection, "footprint": press.footprint}


def words(run):
    """What a reader must know of the result besides the plots."""
    pull = run.summary.get("drawbar_pull_N") or {}
    if pull.get("mean") is None:
        return
    print(f"report: drawbar pull {pull['mean']:.1f} ± {pull.get('sem') or float('nan'):.1f} N (standard error) "
          f"from {pull['from_s']:.3g} to {pull['to_s']:.3g} s", file=sys.stderr)
    if not pull.get("steady", False):
        reasons = "; ".join(pull.get("unsteady_because") or ["the averaging window is not long or even enough"])
        print(f"report: this pull is NOT STEADY: {reasons}", file=sys.stderr)


def main():
    parser = argparse.ArgumentParser(description="Plots of a run as PNG files.")
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, help="folder for the plots (default: the run directory)")
    parser.add_argument("--only", action="append", choices=PLOTS | SOIL_PLOTS | PRESS_PLOTS | SWEEP_PLOTS, help="this plot only; may be repeated")
    arguments = parser.parse_args()
    out = arguments.out or arguments.directory
    try:
        of_soil = (arguments.directory / "soil.json").is_file()
        of_sweep = (arguments.directory / "sweep.json").is_file()
        of_press = (arguments.directory / "press.csv").is_file()
        of = soil.Soil if of_soil else sweep.Sweep if of_sweep else press.Press if of_press else Run
        run = of(arguments.directory)
        out.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        print(f"furrow: error: {arguments.directory}: {error}", file=sys.stderr)
        return 5
    written = []
    plots = SOIL_PLOTS if of_soil else SWEEP_PLOTS if of_sweep else PRESS_PLOTS if of_press else PLOTS
    for name in arguments.only or plots:
        try:
            figure = plots[name](run)
        except Missing as reason:
            print(f"report: no {name}.png: {reason}", file=sys.stderr)
            continue
        except (KeyError, TypeError, ValueError) as error:
            print(f"report: no {name}.png: {error!r}", file=sys.stderr)
            continue
        except OSError as error:  # h5py's error for a damaged file
            print(f"report: no {name}.png: a file in {arguments.directory} is damaged: {error}", file=sys.stderr)
            continue
        try:
            figure.savefig(out / f"{name}.png", dpi=130)
        except OSError as error:
            print(f"furrow: error: {out / (name + '.png')}: {error}", file=sys.stderr)
            return 5
        matplotlib.pyplot.close(figure)
        written.append(f"{name}.png")
    if not (of_soil or of_sweep or of_press):
        words(run)
    print(json.dumps(written))
    if not written:
        print(f"furrow: error: {arguments.directory}: holds nothing to plot", file=sys.stderr)
    return 0 if written else 5


if __name__ == "__main__":
    sys.exit(main())
