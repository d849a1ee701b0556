#!/usr/bin/python3
"""Compares the ruts of the runs of activity.json with and without sleeping grains: rut cross-sections at the end.

usage: activity_rut.py [--radius 0.01] OUT.csv      after run_study.py activity.json

One row per seed and strip of the bin along y: mean depth of the rut from 0.3 to 0.55 m behind the axle, both runs, m.
The last line of each seed on the screen is the largest difference in grain radii.
"""
import argparse
import csv
import pathlib

import h5py
import numpy as np

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


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--radius", type=float, default=0.01, help="of the grains, m")
    arguments = parser.parse_args()
    rows = []
    for on in sorted(RUNS.glob("seed_*_on")):
        off = on.with_name(on.name.replace("_on", "_off"))
        seed = on.name.split("_")[1]
        y, asleep = profile(on)
        _, awake = profile(off)
        rows += [{"seed": seed, "y_m": f"{at:.4g}", "depth_activity_on_m": f"{a:.5g}", "depth_activity_off_m": f"{b:.5g}"}
                 for at, a, b in zip(y, asleep, awake)]
        difference = asleep - awake
        print(f"seed {seed}: largest difference {np.abs(difference).max() / arguments.radius:.3f} r, "
              f"root mean square {np.sqrt((difference**2).mean()) / arguments.radius:.3f} r")
    with open(arguments.out, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    main()
