#!/usr/bin/python3
"""Plots of a run, of soil tests, of a pressed tire, of its natural frequencies, of a vehicle's suspensions, of a study
or of a calibration: PNG files in the run directory, and report.html, a page with all of it; their names, without the
folder, as a JSON list on stdout.

usage: report.py DIR [--out FOLDER] [--only NAME]... [--quiet] [--progress]
       report.py DIR DIR... --out FOLDER    one report.html that compares the runs

Every plot is made from what the directory holds; a plot whose data are missing is left out, and a message on stderr
says so. Exit codes: 0 at least one plot was written, 5 a file could not be read or written.
"""
import argparse
import csv
import functools
import io
import json
import os
import pathlib
import sys

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # its threads cost more than they save
import matplotlib  # noqa: E402

matplotlib.use("Agg")

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent), str(pathlib.Path(__file__).resolve().parent / "report")]

# noqa: E402
from plot import (accounts, calibrate, charts, ground, kinematics, modes, press, ride, scene, soil, sweep,
                  vehicle_ground, vehicle_plots, vehicle_run, vehicle_scene, wheels)
from plot.digits import with_error  # noqa: E402
from plot.own_files import may_write, remove_own, write_whole  # noqa: E402
from plot.run_data import Damaged, Missing, Run, printable, why_no_folder  # noqa: E402


quiet = False  # set by --quiet


@functools.lru_cache(maxsize=1)
def vehicle_of(run):
    return vehicle_run.VehicleRun(run)


def of_vehicle(plot):
    """A plot of a vehicle's run, for `Run`."""
    return lambda run: plot(vehicle_of(run))


PLOTS = {
    "pull_slip_sinkage": charts.pull_slip_sinkage,
    "forces": charts.forces,
    "rut": ground.rut,
    "ranks": charts.ranks,
    "energy": accounts.energy,
    "momentum": accounts.momentum,
    "scene": scene.scene,
}
RIDE_PLOTS = {**PLOTS, "ride": ride.ride}
VEHICLE_PLOTS = {
    "vehicle": of_vehicle(vehicle_plots.vehicle),
    "wheel_forces": of_vehicle(wheels.wheel_forces),
    "wheel_motion": of_vehicle(wheels.wheel_motion),
    "front_and_rear": of_vehicle(wheels.front_and_rear),
    "path": of_vehicle(vehicle_plots.path),
    "gear": of_vehicle(vehicle_plots.gear),
    "rut": of_vehicle(vehicle_ground.rut),
    "ranks": charts.ranks,
    "energy": accounts.energy,
    "momentum": accounts.momentum,
    "scene": of_vehicle(vehicle_scene.vehicle_scene),
}
CURVE_PLOTS = {"curve": sweep.curve}
SWEEP_PLOTS = {**CURVE_PLOTS, "passes": sweep.passes, "rut_along": sweep.rut_along}
BEDS_PLOTS = {"beds": sweep.beds}
SOIL_PLOTS = {"plate": soil.plate, "shear": soil.shear, "cone": soil.cone, "repose": soil.repose}
KINEMATICS_PLOTS = {"parallel": kinematics.parallel, "opposite": kinematics.opposite, "steering": kinematics.steering}
MODES_PLOTS = {"frequencies": modes.frequencies, "mode_shapes": modes.mode_shapes, "mode_sections": modes.mode_sections}
CALIBRATION_PLOTS = {"fit": calibrate.fit, "residual": calibrate.residual}
WORK = {"scene": 20, "page": 10}  # of most plots: 1; the shares of the progress follow from it
PRESS_PLOTS = {"load_deflection": press.load_deflection, "footprint": press.footprint}


def note(text):
    """A message that is no error: --quiet leaves it out."""
    if not quiet:
        print(f"report: {text}", file=sys.stderr)


def tell_share(names, k):
    """How much is done before plot `k` of `names`, for `furrow` to show."""
    work = [WORK.get(name, 1) for name in names]
    print(f"progress {sum(work[:k]) / sum(work):.4f}", flush=True)


def words(run):
    """What a reader must know of the result besides the plots."""
    for what, found in (run.summary.get("accounts") or {}).items():
        if isinstance(found, dict) and found.get("closes") is False:
            note(f"the account of {printable(what)} DOES NOT CLOSE: see accounts of summary.json")
    pull = run.summary.get("drawbar_pull_N") or {}
    if pull.get("mean") is None:
        return
    if not run.measured:
        note("the tire did not touch the terrain in the averaging window: nothing was measured")
        return
    if run.window is None:
        raise Damaged("summary.json: key 'drawbar_pull_N': lacks from_s and to_s, the window of the mean")
    note(f"drawbar pull {with_error(pull['mean'], pull.get('sem'))} N (standard error of this run) "
         f"from {run.window[0]:.3g} to {run.window[1]:.3g} s")
    if not pull.get("steady", False):
        reasons = "; ".join(map(printable, pull.get("unsteady_because") or
                                ["the averaging window is not long or even enough"]))
        note(f"this pull is NOT STEADY: {reasons}")


def main():
    parser = argparse.ArgumentParser(description="Plots of a run as PNG files.")
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("others", type=pathlib.Path, nargs="*", help="further runs: one page that compares all of them")
    parser.add_argument("--out", type=pathlib.Path, help="folder for the plots (default: the run directory)")
    parser.add_argument("--only", action="append", choices=RIDE_PLOTS
                        | VEHICLE_PLOTS | SOIL_PLOTS | PRESS_PLOTS | MODES_PLOTS | KINEMATICS_PLOTS
                        | SWEEP_PLOTS | BEDS_PLOTS | CALIBRATION_PLOTS, help="this plot only; may be repeated")
    parser.add_argument("--quiet", action="store_true", help="print errors only")
    parser.add_argument("--progress", action="store_true",
                        help="print the share that is done, 'progress 0.25', before each plot")
    arguments = parser.parse_args()
    global quiet
    quiet = arguments.quiet
    if arguments.others:
        import page
        return page.compare([arguments.directory, *arguments.others], arguments.out or pathlib.Path("."), may_write)
    out = arguments.out or arguments.directory
    try:
        of_soil = (arguments.directory / "soil.json").is_file()
        of_sweep = (arguments.directory / "sweep.json").is_file()
        of_press = (arguments.directory / "press.csv").is_file()
        of_modes = (arguments.directory / "modes.csv").is_file()
        of_kinematics = (arguments.directory / "kinematics.csv").is_file()
        of_calibration = (arguments.directory / "calibration.json").is_file()
        of = (calibrate.Calibration if of_calibration else soil.Soil if of_soil
              else sweep.Sweep if of_sweep else press.Press if of_press
              else modes.Modes if of_modes else kinematics.Kinematics if of_kinematics else Run)
        run = of(arguments.directory)
    except (OSError, ValueError) as error:
        print(f"furrow: error: {arguments.directory}: {printable(error)}", file=sys.stderr)
        return 5
    except (AttributeError, LookupError, TypeError, csv.Error) as error:
        print(f"furrow: error: {arguments.directory}: a file in it is damaged: {printable(repr(error))}",
              file=sys.stderr)
        return 5
    if why := why_no_folder(out):
        print(f"furrow: error: {printable(out)}: {why}", file=sys.stderr)
        return 5
    written, in_the_way = [], []
    of_beds = of_sweep and run.values.get("beds")
    plots = (CALIBRATION_PLOTS if of_calibration else SOIL_PLOTS if of_soil else BEDS_PLOTS if of_beds else SWEEP_PLOTS
             if of_sweep and run.values.get("passes") else CURVE_PLOTS if of_sweep else PRESS_PLOTS if of_press
             else MODES_PLOTS if of_modes else KINEMATICS_PLOTS if of_kinematics else VEHICLE_PLOTS if run.has_vehicle
             else RIDE_PLOTS if ride.COLUMN in run.series else PLOTS)
    names = [*(arguments.only or plots), "page"]
    for k, name in enumerate(names[:-1]):
        if arguments.progress:
            tell_share(names, k)
        try:
            figure = plots[name](run)
        except Missing as reason:
            note(f"no {name}.png: {reason}")
            remove_own(out, f"{name}.png")
            continue
        except Damaged as error:
            print(f"report: no {name}.png: {printable(error)}", file=sys.stderr)
            continue
        except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
            print(f"report: no {name}.png: {printable(repr(error))}", file=sys.stderr)
            continue
        except MemoryError:
            print(f"report: no {name}.png: there is not enough memory for it", file=sys.stderr)
            continue
        except (OSError, RuntimeError) as error:  # h5py's errors for a damaged file
            print(f"report: no {name}.png: a file in {arguments.directory} is damaged: {printable(error)}",
                  file=sys.stderr)
            continue
        try:
            write = may_write(out, f"{name}.png")
            if write:
                picture = io.BytesIO()
                figure.savefig(picture, format="png", dpi=130)
                write_whole(out / f"{name}.png", picture.getvalue())
        except OSError as error:
            print(f"furrow: error: {out / (name + '.png')}: {error}", file=sys.stderr)
            return 5
        matplotlib.pyplot.close(figure)
        (written if write else in_the_way).append(f"{name}.png")
    if not (of_calibration or of_soil or of_sweep or of_press or of_modes or of_kinematics):
        try:
            words(run)
        except Damaged as error:
            print(f"furrow: error: {arguments.directory}: {printable(error)}", file=sys.stderr)
            return 5
    if (written or in_the_way or (arguments.directory / "summary_failed.json").is_file()) and not arguments.only:
        if arguments.progress:
            tell_share(names, len(names) - 1)
        import page
        written += page.write(out, [run], may_write)
    print(json.dumps(written))
    if not written and in_the_way:
        print(f"furrow: error: {printable(out)}: no plot was written, as other files have their names, expected "
              "another folder", file=sys.stderr)
    elif not written:
        before = arguments.directory / ".furrow-before"
        hint = f"; {before} holds earlier results, which 'furrow resume' brings back" if before.is_dir() else ""
        print(f"furrow: error: {printable(arguments.directory)}: holds nothing to plot{printable(hint)}",
              file=sys.stderr)
    return 0 if written else 5


if __name__ == "__main__":
    sys.exit(main())
