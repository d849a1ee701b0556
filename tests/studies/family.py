#!/usr/bin/python3
"""Three tires on three grounds: what runs, what it gives, and what a simulated second costs. Writes family.csv beside
this script.

usage: family.py [--only TEST …] [--tires TIRE …] [--grounds GROUND …] [--seeds N] [--finished]

Tests: plate and cleat (`furrow press`: secant stiffness under 4561.65 N; force 20 mm deep on a cleat 51 mm wide),
drawbar (the rig of rigs/drawbar_pull_small.json at slip 0.3: pull and sinkage), curb (the wheel of a quarter car over a
step of 30 mm at 2 m/s: largest vertical force). A line is one figure of one tire on one ground. `beds` is the number of
seeds of grains behind it, `standard_error` that of their mean; grounds without grains have one run. `cpu_s_per_s` is
the processor time of all ranks for a simulated second, settled bed apart. `beside` is the line's value over that of the
reference, less one: of the shell on plate, cleat and curb, of the shell on grains for the drawbar. A tire that does not
run has a line that says why.

With --finished nothing is computed: the table holds the lines whose runs this build has made.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys

import numpy as np

import provenance
from provenance import ROOT, read_json

HERE = pathlib.Path(__file__).resolve().parent
RESULTS = ROOT / "results" / "studies" / "family"
TIRES = {"shell": "hmmwv_lumped.json", "ring": "hmmwv_ring.json", "planar": "aligator_planar.json"}
OTHERS = ("planar",)  # not the tire of the shell's file: nothing stands beside it
MESH = ["--set", "tire.elements_circumference=60", "--set", "tire.elements_width=12"]
GROUNDS = ("rigid", "scm", "dem")
TESTS = ("plate", "cleat", "drawbar", "curb")
COLUMNS = ("test", "ground", "tire", "file", "figure", "value", "unit",
           "beds", "standard_error", "beside", "cpu_s_per_s", "why_not")
WIDE = (1.4, 3.6)  # m: width and length of a bed for the planar tire, which is 1 m wide and rolls farther
DEEP = 0.02  # m: the deflection on the cleat
RIGS = {"rigid": "rigid_ground.json", "scm": "drawbar_pull_scm.json", "dem": "drawbar_pull_small.json"}
CURB = ["--set", "terrain.profile=[[2, 0], [2.0001, 0.03]]", "--set", "rig.speed=2",
        "--set", "rig.body_mass=415", "--set",
        "rig.unsprung_mass=36", "--set", "rig.suspension_stiffness=80e3", "--set", "rig.suspension_damping=4e3",
        "--set", "run.end=1.6", "--set", "run.average_from=1.4", "--set", "output.frame_interval=0"]


def furrow(folder, *words):
    """Runs the program once for each build and words. @returns what it said last where it failed, or None"""
    record, told = read_json(folder / provenance.RECORD), list(map(str, words))
    if (record.get("build"), record.get("words")) != (provenance.build_of(provenance.program()), told):
        done = subprocess.run([provenance.program(), *told, "--out", str(folder), "--overwrite"],
                              stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, text=True)
        print(f"{folder.name}: exit {done.returncode}", file=sys.stderr, flush=True)
        said = [line for line in done.stderr.splitlines() if "error" in line] or done.stderr.splitlines()[-1:]
        folder.mkdir(parents=True, exist_ok=True)
        provenance.record_run(folder)
        record = read_json(folder / provenance.RECORD) | {"failed": said[0].strip() if done.returncode else "",
                                                          "words": told}
        (folder / provenance.RECORD).write_text(json.dumps(record) + "\n", encoding="utf-8")
    return read_json(folder / provenance.RECORD)["failed"] or None


def table(file):
    return np.atleast_1d(np.genfromtxt(file, delimiter=",", names=True))


def tire_words(tire):
    return ["--set", f"tire.file={TIRES[tire]}",
            *(MESH if tire == "shell" else ["--set", "tire.contact_tangent=false"])]


def press(folder, obstacle, tire):
    cleat = ["--cleat-width", "0.051", "--cleat-height", "0.1"] if obstacle == "cleat" else []
    return furrow(folder, "press", ROOT / "rigs" / "rigid_ground.json",
                  *tire_words(tire), "--set", "tire.pressure=null", "--on", obstacle,
                  "--deflection", DEEP, "--points", 8, *cleat)


def press_figures(folder, obstacle):
    summary, curve = read_json(folder / "summary.json"), table(folder / "press.csv")
    up = curve[curve["unloading"] == 0]
    deep = float(np.interp(DEEP, up["deflection_m"], up["force_N"]))
    yield (f"force at {1e3 * DEEP:g} mm", deep, "N")
    if obstacle == "plate":
        yield ("secant stiffness", summary["secant_stiffness_N_per_m"], "N/m")


def drawbar(folder, ground, tire, seed):
    more = ["--set", "rig.slip=0.3", "--set", "rig.angular_speed=4.28"] if ground == "rigid" else []
    if tire == "planar" and ground != "rigid":
        # explicit: not 5e-4 s
        more = ["--set", f"terrain.width={WIDE[0]}", "--set", f"terrain.length={WIDE[1]}", "--set", "run.step=6e-5"]
    return furrow(folder, "run", ROOT / "rigs" / RIGS[ground], *tire_words(tire),
                  "--set", "tire.pressure=null", "--set", f"run.seed={seed}",
                  "--set", "output.frame_interval=0", *more, "--no-plots")


def drawbar_figures(folder):
    summary = read_json(folder / "summary.json")
    yield ("drawbar pull", summary["drawbar_pull_N"]["mean"], "N")
    yield ("sinkage", summary["sinkage_m"], "m")


def curb(folder, tire):
    return furrow(folder, "run", ROOT / "rigs" / "curb.json", *tire_words(tire), *CURB, "--no-plots")


def curb_figures(folder):
    series = table(folder / "timeseries.csv")
    yield ("largest vertical force", float(np.max(series["force_z_N"][series["position_m"] > 1.0])), "N")


def cost(folder):
    """Processor time of all ranks over the simulated time; nothing of a static test."""
    summary = read_json(folder / "summary.json")
    if "ranks" not in summary:
        return None
    return sum(rank["cpu_s"] for rank in summary["ranks"]) / read_json(folder / "scenario.json")["run"]["end"]


def cells(arguments):
    for test in arguments.only:
        for ground in (arguments.grounds if test == "drawbar" else ["rigid"] if "rigid" in arguments.grounds else []):
            for tire in arguments.tires:
                yield test, ground, tire


def runs_of(test, ground, tire, arguments):
    """[(folder, why it failed)], run where that is wanted."""
    found = []
    for seed in range(1, 1 + (arguments.seeds if ground == "dem" else 1)):
        folder = RESULTS / "_".join([test, ground, tire, str(seed)])
        if arguments.finished:
            if read_json(folder / provenance.RECORD).get("build") != provenance.build_of(provenance.program()):
                continue
            found.append((folder, read_json(folder / provenance.RECORD)["failed"] or None))
        elif test in ("plate", "cleat"):
            found.append((folder, press(folder, test, tire)))
        elif test == "drawbar":
            found.append((folder, drawbar(folder, ground, tire, seed)))
        else:
            found.append((folder, curb(folder, tire)))
    return found


def figures_of(test, folder):
    return press_figures(folder, test) if test in ("plate",
                                                   "cleat") else drawbar_figures(folder) if test == "drawbar" else curb_figures(folder)


def lines(arguments):
    rows = []
    for test, ground, tire in cells(arguments):
        runs = runs_of(test, ground, tire, arguments)
        row = {"test": test, "ground": ground, "tire": tire, "file": TIRES[tire], "beds": ""}
        failed = next((why for _, why in runs if why), None)
        if failed:
            rows.append(row | {"why_not": failed.replace(str(ROOT) + "/", "").replace("furrow: error: ", "")})
            continue
        costs = [c for c in (cost(folder) for folder, _ in runs) if c is not None]
        by_figure = {}
        for folder, _ in runs:
            for name, value, unit in figures_of(test, folder):
                by_figure.setdefault((name, unit), []).append(value)
        for (name, unit), values in by_figure.items():
            rows.append(row | {"figure": name, "unit": unit, "value": statistics.mean(values),
                               "beds": len(values) if ground == "dem" else "",
                               "standard_error": f"{statistics.stdev(values) / len(values) ** 0.5:.3g}"
                               if len(values) > 1 else "",
                               "cpu_s_per_s": f"{statistics.mean(costs):.3g}" if costs else ""})
    reference = {(r["test"], r["figure"]): r["value"] for r in rows
                 if "figure" in r and r["tire"] == "shell" and r["ground"]
                 == ("dem" if r["test"] == "drawbar" else "rigid")}
    for row in rows:
        if "figure" not in row:
            continue
        of = reference.get((row["test"], row["figure"]))
        if of and row["tire"] not in OTHERS:
            row["beside"] = f"{row['value'] / of - 1.0:.3f}"
        row["value"] = f"{row['value']:.5g}"
    return rows


def main():
    parser = argparse.ArgumentParser(description="Three tires on three grounds.")
    parser.add_argument("--only", nargs="+", choices=TESTS, default=TESTS)
    parser.add_argument("--tires", nargs="+", choices=tuple(TIRES), default=tuple(TIRES))
    parser.add_argument("--grounds", nargs="+", choices=GROUNDS, default=GROUNDS)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--finished", action="store_true")
    arguments = parser.parse_args()
    made = provenance.made_here()
    rows = lines(arguments)
    provenance.write_table(HERE / "family.csv", COLUMNS, rows, made)


if __name__ == "__main__":
    main()
