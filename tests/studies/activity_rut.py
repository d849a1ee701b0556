#!/usr/bin/python3
"""Compares the ruts of the runs of activity.json with and without sleeping grains: rut cross-sections at the end.

usage: activity_rut.py [--radius 0.01] OUT.csv      after run_study.py activity.json

One row per seed and strip of the bin along y: mean depth of the rut from 0.3 to 0.55 m behind the axle, both runs, m.
On the screen, in grain radii: root mean square of the difference with and without sleep for each seed, of the
difference between seeds without sleep as the yardstick, and of the difference of the profiles' means over the seeds.
"""
import argparse
import itertools
import pathlib

import h5py
import numpy as np

import provenance

RUNS = pathlib.Path(__file__).resolve().parents[2] / "results" / "studies" / "activity"
WINDOW = (0.3, 0.55)  # behind the axle, m


def profile(folder):
    """(y, mean depth) across the rut behind the axle, m."""
    with h5py.File(folder / "results.h5") as file:
        axle = file["series/wheel0/position_m"][-1]
        x0, y0, cell = file["terrain/height_before_grid"][:]
        before, after = file["terrain/height_before"][:], file["terrain/height_after"][:]
    x = x0 + cell * np.arange(before.shape[0])
    behind = (x > axle - WINDOW[1]) & (x < axle - WINDOW[0])
    return y0 + cell * np.arange(before.shape[1]), np.nanmean((before - after)[behind], axis=0)


def rms(difference):
    return np.sqrt((difference**2).mean())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--radius", type=float, default=0.01, help="of the grains, m")
    arguments = parser.parse_args()
    rows, asleep_all, awake_all = [], [], []
    for on in sorted(RUNS.glob("seed_*_on")):
        off = on.with_name(on.name.replace("_on", "_off"))
        seed = on.name.split("_")[1]
        y, asleep = profile(on)
        _, awake = profile(off)
        rows += [{"seed": seed, "y_m": f"{at:.4g}", "depth_activity_on_m": f"{a:.5g}",
                  "depth_activity_off_m": f"{b:.5g}"}
                 for at, a, b in zip(y, asleep, awake)]
        asleep_all.append(asleep / arguments.radius)
        awake_all.append(awake / arguments.radius)
        print(f"seed {seed}, on against off: {rms(asleep_all[-1] - awake_all[-1]):.2f}")
    print("between seeds, off:", *(f"{rms(a - b):.2f}" for a, b in itertools.combinations(awake_all, 2)))
    print(f"means over seeds, on against off: {rms(np.mean(asleep_all, axis=0) - np.mean(awake_all, axis=0)):.2f}")
    runs = [folder for folder in RUNS.glob("seed_*") if (folder / "summary.json").exists()]
    provenance.write_table(arguments.out, list(rows[0]), rows, provenance.origin_of_runs(runs))


if __name__ == "__main__":
    main()
