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
import argparse
import os
import pathlib
import resource
import statistics
import subprocess

import h5py
import numpy as np

import provenance
from provenance import ROOT

HERE = pathlib.Path(__file__).resolve().parent
SCENARIO = [str(ROOT / "rigs" / "drawbar_pull_small.json"), "--set", "terrain.width=3",
            "--set", "terrain.radius=0.015", "--set",
            "terrain.layers=8", "--set", "terrain.length=3", "--set", "tire.rigid=true",
            "--set", 'rig.wheels=[{"lateral":-1.0}]',
            "--set", "run.step=1e-4", "--set", "output.frame_interval=0", "--threads", "1"]
FIGURES = {"pull_N": "drawbar_pull_N", "sinkage_mm": "sinkage_m", "rut_depth_mm": "rut_depth_m",
           "rut_width_mm": "rut_width_m",
           "rut_track_mm": "rut_track_m",
           "active_share": "active_share_mean"}
SLEEP = ("strips", "parcels", "none")  # what sleeps as a whole


def run(program, seed, sleep, core):
    out = ROOT / "results" / "studies" / "sleep_across" / f"{sleep}_{seed}"
    words = [program, "run", *SCENARIO, "--set", f"run.seed={seed}", "--set",
             f"terrain.activity={json_bool(sleep != 'none')}",
             "--out", str(out), "--overwrite", "--no-plots"]
    pinned = ["taskset", "-c", str(core)] if core is not None else []
    begin = processor_time()
    subprocess.run([*pinned, *words], check=True, stdout=subprocess.DEVNULL,
                   env=dict(os.environ, FURROW_HOME=str(ROOT)))
    return provenance.read_json(out / "summary.json") | {"cpu_s": processor_time() - begin,
                                                         "rut_track_m": rut_along(out)}


def rut_along(folder):
    """Mean depth from where the wheel rolls steadily to behind it, within 0.12 m of its middle, m."""
    with h5py.File(folder / "results.h5") as file:
        axle = np.ravel(file["series/wheel0/position_m"][-1])[0]
        x0, y0, cell = file["terrain/height_before_grid"][:]
        depth = file["terrain/height_before"][:] - file["terrain/height_after"][:]
    x, y = x0 + cell * np.arange(depth.shape[0]), y0 + cell * np.arange(depth.shape[1])
    return float(np.nanmean(depth[(x > 0.75) & (x < axle - 0.25)][:, abs(y + 1.0) < 0.12]))


def processor_time():
    """Of all processes that this one has started and waited for, s."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def make_bed(seed):
    subprocess.run([provenance.program(), "bed", *SCENARIO[:-2], "--set", f"run.seed={seed}"], check=True,
                   stdout=subprocess.DEVNULL, env=dict(os.environ, FURROW_HOME=str(ROOT)))


def json_bool(value):
    return "true" if value else "false"


def row_of(summary, seed, sleep, whole):
    row = {"seed": seed, "sleep": sleep}
    for column, key in FIGURES.items():
        value = summary[key]["mean"] if isinstance(summary[key], dict) else summary[key]
        row[column] = (1e3 if column.endswith("_mm") else 1.0) * value
    row["pull_sem_N"] = summary["drawbar_pull_N"]["sem"]
    row["wall_s"] = summary["wall_s"]
    row["cpu_s"] = summary["cpu_s"]
    row["wall_ratio"] = summary["wall_s"] / whole["wall_s"]
    row["cpu_ratio"] = summary["cpu_s"] / whole["cpu_s"]
    return row


def pooled(rows, sleep):
    mine = [row for row in rows if row["sleep"] == sleep]
    out = {"seed": "", "sleep": sleep}
    for column in mine[0]:
        if column in out:
            continue
        values = [row[column] for row in mine]
        out[column] = (f"{statistics.mean(values):.4g} ± {statistics.stdev(values):.2g}"
                       if len(values) > 1 else f"{values[0]:.4g}")
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--before", nargs=2, metavar=("PROGRAM", "COMMIT"), required=True)
    parser.add_argument("--seeds", nargs="+", type=int, default=[1, 2, 3])
    parser.add_argument("--core", type=int)
    arguments = parser.parse_args()
    # Before the table makes files differ.
    made = provenance.made_here() | {"note": f"sleep = strips: commit {arguments.before[1]}"}
    rows = []
    for seed in arguments.seeds:
        make_bed(seed)
        of = {sleep: run(arguments.before[0] if sleep == "strips" else provenance.program(),
                         seed, sleep, arguments.core)
              for sleep in SLEEP}
        rows += [row_of(of[sleep], seed, sleep, of["strips"]) for sleep in SLEEP]
        print(*rows[-3:], sep="\n", flush=True)
        text = [{key: f"{value:.4g}" if isinstance(value, float) else value for key, value in row.items()}
                for row in rows]
        text += [pooled(rows, sleep) for sleep in SLEEP]
        provenance.write_table(HERE / "sleep_across.csv", list(text[0]), text, made)


if __name__ == "__main__":
    main()
