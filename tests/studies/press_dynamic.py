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
import itertools
import pathlib

import numpy as np

import driver
import provenance
from driver import ROOT, read_json

TIRES = ("hmmwv_lumped.json", "hmmwv_layered.json")
LOADS = {200e3: (2000.0, 4561.65), 70e3: (1000.0, 2500.0)}  # Pa: N
MESHES = ("60x12", "90x24", "120x32")
STIFFNESS = 4e9  # N/m³, of the plate of furrow press
SPEED, END = 0.15, 0.45  # m/s, s: nearly critical damping of the load on the tire
STEP = 2e-5  # s; forces of a ground as stiff come one step late


def scenario(tire, pressure, mesh, load, speed=SPEED):
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


def folder_of(case, ending, command, *words, finished_only=False, **more):
    tire, pressure, mesh, load = case
    name = f"{pathlib.Path(tire).stem}_{pressure / 1e3:.0f}_{mesh}_{load:.0f}_{ending}"
    return driver.kept(driver.RESULTS / "press_dynamic" / name, command, *words, scenario=scenario(*case, **more),
                       finished_only=finished_only)


def stood(folder):
    """Height of the axle, m, mean force of the ground, N, and way of the axle, m, of the last 10 ms."""
    last = driver.series(folder)[-6:]
    heights = last["axle_height_m"]
    return heights[-1], np.mean(last["force_z_N"]), heights[-1] - heights[0]


def row_of(case, finished_only):
    """None where --finished finds no runs."""
    tire, pressure, mesh, load = case
    slowly = mesh == MESHES[0] and load == LOADS[pressure][-1]
    deep = 0.016 if pressure > 1e5 else 0.02
    run = folder_of(case, f"{SPEED:g}", "run", finished_only=finished_only)
    press = folder_of(case, "press", "press", "--load", load, "--deflection", deep, "--points", 16,
                      finished_only=finished_only)
    slower = folder_of(case, f"{SPEED / 2:g}", "run", speed=SPEED / 2, finished_only=finished_only) if slowly else run
    if not (run and press and slower):
        return None
    (height, force, moved), summary, curve = stood(run), driver.summary(press), driver.press_curve(press)
    dynamic = read_json(ROOT / "tire" / "data" / tire)["radius"] + summary["inflation_growth_m"] - height
    return {"tire": tire, "pressure_kPa": str(pressure / 1e3), "mesh": mesh, "load_N": str(load),
            "rest_N": f"{force - load:.2g}",
            "moved_um": f"{1e6 * moved:.2g}", "dynamic_mm": 1e3 * dynamic, "static_mm": 1e3 * summary["deflection_m"],
            "force_error": f"{np.interp(dynamic, curve['deflection_m'], curve['force_N']) / load - 1:.4f}",
            "half_speed_mm": f"{1e3 * (height - stood(slower)[0]):.2g}" if slowly else "",
            "failed_factorizations": summary["failed_factorizations"],
            "statically_stable": summary["statically_stable"], "runout_mm": f"{1e3 * summary['runout_m']:.3g}",
            "loading_unloading": f"{summary['loading_unloading_difference']:.2g}"}


def main():
    arguments = driver.options(__doc__, meshes={"nargs": "+", "choices": MESHES, "default": MESHES},
                               only={"choices": TIRES, "nargs": "+", "default": TIRES, "metavar": "TIRE"},
                               finished={"action": "store_true"}).parse_args()
    made, rows = provenance.made_here(), []
    for tire, (pressure, loads) in itertools.product(arguments.only, LOADS.items()):
        for load, mesh in itertools.product(loads, arguments.meshes):
            if row := row_of((tire, pressure, mesh, load), arguments.finished):
                rows.append(row)
                driver.write("press_dynamic.csv", rows, made)


if __name__ == "__main__":
    main()
