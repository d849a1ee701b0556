#!/usr/bin/python3
"""The static press beside the tire in motion: both shell tires are lowered slowly onto hard ground by a damper and
stand there until they rest; nothing of `furrow press` takes part. Writes press_dynamic.csv beside this script.

usage: press_dynamic.py [--meshes 60x12 …] [--only TIRE …] [--finished]

With --finished nothing is computed: the table holds the lines whose runs this build has made.

A line is one tire, pressure, mesh and load. Dynamic: the axle's height at the end of a run under that load, without
friction, on ground of the stiffness (pressure per depth) of the plate of the press; the deflection is counted from the
height at which the inflated tire would touch, radius and growth by inflation. `rest_N` is the mean force of the ground
over the last 10 ms less the load, `moved_um` how far the axle moved in that time. `half_speed_mm` is the deflection
when the tire is lowered half as fast, less the other. Static: deflection of `furrow press --load` on the same mesh.
`force_error` is the static force at the dynamic deflection over the load, less one.
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
RESULTS = ROOT / "results" / "studies" / "press_dynamic"
TIRES = ("hmmwv_lumped.json", "hmmwv_layered.json")
LOADS = {200e3: (2000.0, 4561.65), 70e3: (1000.0, 2500.0)}  # Pa: N
MESHES = ("60x12", "90x24", "120x32")
STIFFNESS = 4e9  # N/m³, of the plate of furrow press
SPEED, END = 0.15, 0.45  # m/s, s: nearly critical damping of the load on the tire
STEP = 2e-5  # s; forces of a ground as stiff come one step late


def furrow(*arguments):
    subprocess.run([provenance.program(), *map(str, arguments)], check=True)


def scenario(tire, pressure, mesh, load, speed):
    around, across = map(int, mesh.split("x"))
    end = END * SPEED / speed
    return {
        "format_version": 1,
        "rig": {"type": "drawbar", "load": load, "slip": 0, "move_from": 2 * end, "lowering_speed": speed},
        "tire": {"file": tire, "rigid": False, "pressure": pressure, "elements_circumference": around,
                 "elements_width": across},
        "terrain": {"engine": "rigid", "ground_stiffness": STIFFNESS, "friction": 0},
        "run": {"step": STEP, "end": end, "average_from": 0.8 * end},
        "output": {"series_interval": 2e-3, "frame_interval": 0},
    }


class Unfinished(Exception):
    pass


only_finished = False


def folder_of(name, made, *command):
    """Of the results, made unless this build made them already from the same scenario."""
    folder, stamp = RESULTS / name, RESULTS / f"{name}.stamp"
    key = json.dumps([provenance.build_of(provenance.program()), made, command])
    if not (folder / "summary.json").exists() or not stamp.exists() or stamp.read_text() != key:
        if only_finished:
            raise Unfinished
        RESULTS.mkdir(parents=True, exist_ok=True)
        file = RESULTS / f"{name}.json"
        file.write_text(json.dumps(made))
        furrow(command[0], file, *command[1:], "--out", folder, "--overwrite", "--quiet")
        stamp.write_text(key)
    return folder


def stood(tire, pressure, mesh, load, speed=SPEED):
    """Height of the axle, m, mean force of the ground less the load, N, and way of the axle, m, of the last 10 ms."""
    name = f"{pathlib.Path(tire).stem}_{pressure / 1e3:.0f}_{mesh}_{load:.0f}_{speed:g}"
    folder = folder_of(name, scenario(tire, pressure, mesh, load, speed), "run", "--no-plots")
    with open(folder / "timeseries.csv", newline="") as file:
        last = list(csv.DictReader(file))[-6:]
    heights = [float(line["axle_height_m"]) for line in last]
    return heights[-1], np.mean([float(line["force_z_N"]) for line in last]) - load, heights[-1] - heights[0]


def pressed(tire, pressure, mesh, load):
    """The summary of the press and its curve (deflection, m; force, N)."""
    name = f"{pathlib.Path(tire).stem}_{pressure / 1e3:.0f}_{mesh}_{load:.0f}_press"
    made = scenario(tire, pressure, mesh, load, SPEED)
    folder = folder_of(name, made, "press", "--load", load, "--deflection",
                       0.016 if pressure > 1e5 else 0.02, "--points", 16)
    with open(folder / "press.csv", newline="") as file:
        curve = [(float(line["deflection_m"]), float(line["force_N"]))
                 for line in csv.DictReader(file) if line["unloading"] == "0"]
    summary = json.loads((folder / "summary.json").read_text())
    radius = json.loads((ROOT / "tire" / "data" / tire).read_text())["radius"]
    return summary, np.array(curve), radius + summary["inflation_growth_m"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--meshes", nargs="+", choices=MESHES, default=MESHES)
    parser.add_argument("--finished", action="store_true", help="only lines whose runs are there")
    parser.add_argument("--only", choices=TIRES, nargs="+", default=TIRES, metavar="TIRE")
    arguments = parser.parse_args()
    global only_finished
    only_finished = arguments.finished
    origin = provenance.made_here()
    rows = []
    for tire in arguments.only:
        for pressure, loads in LOADS.items():
            for load in loads:
                for mesh in arguments.meshes:
                    try:
                        height, rest, moved = stood(tire, pressure, mesh, load)
                        summary, curve, touching = pressed(tire, pressure, mesh, load)
                    except Unfinished:
                        continue
                    dynamic = touching - height
                    row = {"tire": tire, "pressure_kPa": pressure / 1e3,
                           "mesh": mesh, "load_N": load, "rest_N": f"{rest:.2g}",
                           "moved_um": f"{1e6 * moved:.2g}",
                           "dynamic_mm": f"{1e3 * dynamic:.4g}", "static_mm": f"{1e3 * summary['deflection_m']:.4g}",
                           "force_error": f"{np.interp(dynamic, curve[:, 0], curve[:, 1]) / load - 1:.4f}",
                           "half_speed_mm": "",
                           "failed_factorizations": summary["failed_factorizations"],
                           "statically_stable": summary["statically_stable"],
                           "runout_mm": f"{1e3 * summary['runout_m']:.3g}",
                           "loading_unloading": f"{summary['loading_unloading_difference']:.2g}"}
                    if mesh == MESHES[0] and load == loads[-1]:
                        slower = stood(tire, pressure, mesh, load, SPEED / 2)[0]
                        row["half_speed_mm"] = f"{1e3 * (height - slower):.2g}"
                    rows.append(row)
                    print(" ".join(f"{key}={value}" for key, value in row.items()), flush=True)
                    provenance.write_table(HERE / "press_dynamic.csv", list(row), rows, origin)


if __name__ == "__main__":
    main()
