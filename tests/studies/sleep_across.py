#!/usr/bin/python3
"""One rigid wheel on one side of a bed 3 m wide: what sleeps when whole strips do and when parcels do, and what else
changes.

usage: sleep_across.py --before PROGRAM COMMIT [--seeds 1 2 3] [--core N]     writes sleep_across.csv beside this script

PROGRAM: of COMMIT, the last whose grains sleep by whole strips. Per seed it runs with sleep, and the present program
($FURROW, or build/furrow) with and without, one after another on one thread. The table has a line for each: drawbar
pull and its standard error over the averaging window, sinkage and rut of the run, the rut's mean depth along the whole
track, 0.24 m wide, share of the grains that are awake, wall time of the run without its bed, processor time of all of
it (the bed is made beforehand), and that beside the run of whole strips. Lines without a seed are means over the seeds,
with the standard deviation between them.
"""
import os
import statistics

import numpy as np

import driver
import provenance
from activity_rut import depths

SETTINGS = {"terrain.width": 3, "terrain.radius": 0.015, "terrain.layers": 8, "terrain.length": 3, "tire.rigid": True,
            "rig.wheels": [{"lateral": -1.0}], "run.step": 1e-4, "output.frame_interval": 0}
FIGURES = {"pull_N": "drawbar_pull_N", "sinkage_mm": "sinkage_m", "rut_depth_mm": "rut_depth_m",
           "rut_width_mm": "rut_width_m", "rut_track_mm": "rut_track_m", "active_share": "active_share_mean"}
SLEEP = ("strips", "parcels", "none")  # what sleeps as a whole


def words(seed):
    return ["rigs/drawbar_pull_small_report_soil.json", *driver.settings(SETTINGS, {"run.seed": seed})]


def run(program, seed, sleep, core):
    out = driver.RESULTS / "sleep_across" / f"{sleep}_{seed}"
    activity = driver.settings({"terrain.activity": sleep != "none"})
    _, processor, _ = driver.timed("run", *words(seed), *activity, "--threads", 1, "--out", out, "--overwrite",
                                   "--no-plots", program=program,
                                   before=["taskset", "-c", core] if core is not None else [])
    return driver.summary(out) | {"cpu_s": processor, "rut_track_m": rut_along(out)}


def rut_along(folder):
    """Mean depth from where the wheel rolls steadily to behind it, within 0.12 m of its middle, m."""
    x, y, depth, axle = depths(folder)
    return float(np.nanmean(depth[(x > 0.75) & (x < axle - 0.25)][:, abs(y + 1.0) < 0.12]))


def row_of(summary, seed, sleep, whole):
    row = {"seed": seed, "sleep": sleep}
    for column, key in FIGURES.items():
        row[column] = (1e3 if column.endswith("_mm") else 1.0) * driver.mean_of(summary[key])
    return {**row, "pull_sem_N": summary["drawbar_pull_N"]["sem"],
            **{f"{time}_s": summary[f"{time}_s"] for time in ("wall", "cpu")},
            **{f"{time}_ratio": summary[f"{time}_s"] / whole[f"{time}_s"] for time in ("wall", "cpu")}}


def pooled(rows, sleep):
    mine, out = [row for row in rows if row["sleep"] == sleep], {"sleep": sleep}
    for column in mine[0].keys() - {"seed", "sleep"}:
        values = [row[column] for row in mine]
        spread = f" ± {statistics.stdev(values):.2g}" if len(values) > 1 else ""
        out[column] = f"{statistics.mean(values):.4g}{spread}"
    return out


def main():
    arguments = driver.options(__doc__, seeds={"nargs": "+", "type": int, "default": [1, 2, 3]}, core={"type": int},
                               before={"nargs": 2, "metavar": ("PROGRAM", "COMMIT"), "required": True}).parse_args()
    program, commit = arguments.before
    made = provenance.made_here() | {"note": f"sleep = strips: commit {commit}"}  # before the table makes files differ
    rows = []
    for seed in arguments.seeds:
        driver.furrow("bed", *words(seed))
        of = {sleep: run(os.path.abspath(program) if sleep == "strips" else None, seed, sleep, arguments.core)
              for sleep in SLEEP}
        rows += [row_of(of[sleep], seed, sleep, of["strips"]) for sleep in SLEEP]
        print(*rows[-3:], sep="\n", flush=True)
        driver.write("sleep_across.csv", rows + [pooled(rows, sleep) for sleep in SLEEP], made)


if __name__ == "__main__":
    main()
