#!/usr/bin/python3
"""Load–deflection curves of a shell tire on a plate and on cleats, to which rigs/calibrate_ring.json fits the flexible
ring and which it predicts: tire/data/press_<tire>_<case>.csv, and the contact pressure along the shell's centre line,
ring_targets_pressure.csv beside this script.

usage: ring_targets.py [--run] [--tire lumped] [--mesh 90x24] [--only CASE …]

--run presses first what this build of the program has not pressed yet (see CASES).
"""
import argparse
import csv
import json
import pathlib
import subprocess

import numpy as np

import provenance
from provenance import ROOT

HERE = pathlib.Path(__file__).resolve().parent
RESULTS = ROOT / "results" / "studies" / "ring_targets"
DATA = ROOT / "tire" / "data"

FITTED_TO = 0.024  # m, of the plate's curve; what is deeper is held out
LOAD = 4561.65     # N, of the centre line


def cleat(width, *words):
    return ("--on", "cleat", "--cleat-height", "0.1", "--cleat-width",
            str(width), "--deflection", "0.04", "--points", "10", *words)


PLATE = ("--on", "plate", "--deflection", "0.032", "--points", "8", "--load", str(LOAD))
CASES = {  # in the order in which they are worth most
    "plate": PLATE,
    "cleat51": cleat(0.051),
    "cleat100": cleat(0.1),
    "cleat25": cleat(0.025),
    "cleat38": cleat(0.038),
    "cleat76": cleat(0.076),
    "plate_120kPa": (*PLATE, "--set", "tire.pressure=120e3"),
    "cleat51_120kPa": cleat(0.051, "--set", "tire.pressure=120e3"),
}


def folder_of(tire, mesh, case):
    return RESULTS / f"{tire}_{mesh}" / case


def words_of(tire, mesh, case):
    around, across = mesh.split("x")
    return ["press", "rigs/cleat_press.json", "--set", f"tire.file=hmmwv_{tire}.json",
            "--set", f"tire.elements_circumference={around}",
            "--set", f"tire.elements_width={across}", *CASES[case]]


def press(tire, mesh, case, made_at):
    """Presses a tire unless this build of the program has done so."""
    folder = folder_of(tire, mesh, case)
    if provenance.read_json(folder / provenance.RECORD).get("build") == provenance.build_of(provenance.program()):
        return
    subprocess.run([provenance.program(), *words_of(tire, mesh, case), "--out", str(folder), "--overwrite"],
                   check=True, cwd=ROOT)
    provenance.record_run(folder, made_at)


def curve(folder):
    table = np.atleast_1d(np.genfromtxt(folder / "press.csv", delimiter=",", names=True))
    return table[table["unloading"] == 0]


def write_curve(name, rows, made):
    lines = [{"deflection_m": f"{row['deflection_m']:.9g}", "force_N": f"{row['force_N']:.9g}"} for row in rows]
    provenance.write_table(DATA / f"press_{name}.csv", ["deflection_m", "force_N"], lines, made)


def centre_line(folder, cell):
    """Mean pressure by distance along, over the middle quarter of the footprint's width: x in m, Pa."""
    foot = np.genfromtxt(folder / "footprint.csv", delimiter=",", names=True)
    middle = foot[np.abs(foot["y_m"]) <= 0.25 * np.max(np.abs(foot["y_m"]))]
    place = np.rint(middle["x_m"] / cell).astype(int)
    for k in sorted(set(place)):
        here = middle[place == k]
        yield cell * k, np.sum(here["pressure_Pa"] * here["area_m2"]) / np.sum(here["area_m2"])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--run", action="store_true")
    parser.add_argument("--tire", default="lumped", choices=("lumped", "layered"))
    parser.add_argument("--mesh", default="90x24")
    parser.add_argument("--only", nargs="+", choices=CASES, default=list(CASES))
    arguments = parser.parse_args()
    made_at = provenance.commit()
    for case in arguments.only:
        if arguments.run:
            press(arguments.tire, arguments.mesh, case, made_at)
        folder = folder_of(arguments.tire, arguments.mesh, case)
        if not (folder / "summary.json").exists():
            continue
        origin = provenance.origin_of_runs([folder])
        origin["command"] = f"ring_targets.py --run --tire {arguments.tire} --mesh {arguments.mesh} --only {case}"
        origin["note"] = "furrow " + " ".join(words_of(arguments.tire, arguments.mesh, case)) + "; the loading"
        summary = json.loads((folder / "summary.json").read_text())
        if not summary["stable_while_pressed"]:
            origin["note"] += f"; the tire buckles on the way, loading and unloading differ by {summary['loading_unloading_difference']:.2g} of the largest force"
        rows = curve(folder)
        name = f"{arguments.tire}_{case}"
        if case == "plate":
            write_curve(name, rows[rows["deflection_m"] <= FITTED_TO + 1e-9], origin)
            write_curve(name + "_deeper", rows[rows["deflection_m"] > FITTED_TO + 1e-9], origin)
            with open(HERE / "ring_targets_pressure.csv", "w", newline="", encoding="utf-8") as file:
                provenance.write_header(file, origin)
                writer = csv.writer(file, lineterminator="\n")
                writer.writerow(["x_m", "pressure_Pa"])
                cell = 2 * np.pi * 0.47 / int(arguments.mesh.split("x")[0]) / 3  # three points along an element
                writer.writerows((f"{x:.5g}", f"{p:.5g}") for x, p in centre_line(folder, cell))
        else:
            write_curve(name, rows, origin)


if __name__ == "__main__":
    main()
