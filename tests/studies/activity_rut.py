#!/usr/bin/python3
"""Compares the ruts of the runs of activity.json with and without sleeping grains: rut cross-sections at the end.
Writes activity_rut.csv beside this script, after run_study.py activity.json.

One row per seed and strip of the bin along y: mean depth of the rut from 0.3 to 0.55 m behind the axle, both runs, m.
On the screen, in grain radii: root mean square of the difference with and without sleep for each seed, of the
difference between seeds without sleep as the yardstick, and of the difference of the profiles' means over the seeds.
"""
import itertools

import h5py
import numpy as np

import driver
import provenance

RUNS = driver.RESULTS / "activity"
WINDOW = (0.3, 0.55)  # behind the axle, m


def depths(folder):
    """(x, y, depth of the rut at x and y, place of the axle at the end), m"""
    with h5py.File(folder / "results.h5") as file:
        axle = np.ravel(file["series/wheel0/position_m"][-1])[0]
        x0, y0, cell = file["terrain/height_before_grid"][:]
        depth = file["terrain/height_before"][:] - file["terrain/height_after"][:]
    return x0 + cell * np.arange(depth.shape[0]), y0 + cell * np.arange(depth.shape[1]), depth, axle


def profile(folder):
    """(y, mean depth) across the rut behind the axle, m."""
    x, y, depth, axle = depths(folder)
    return y, np.nanmean(depth[(x > axle - WINDOW[1]) & (x < axle - WINDOW[0])], axis=0)


def rms(difference):
    return np.sqrt((difference**2).mean())


def main():
    radius = driver.options(__doc__, radius={"type": float, "default": 0.01, "help": "of the grains, m"})
    radius = radius.parse_args().radius
    seeds = [folder.name.split("_")[1] for folder in sorted(RUNS.glob("seed_*_on"))]
    driver.finished_runs(RUNS, [f"seed_{seed}_on" for seed in seeds])
    on, off = ([profile(RUNS / f"seed_{seed}_{sleep}") for seed in seeds] for sleep in ("on", "off"))
    rows = [{"seed": seed, "y_m": f"{at:.4g}", "depth_activity_on_m": f"{a:.5g}", "depth_activity_off_m": f"{b:.5g}"}
            for seed, (y, asleep), (_, awake) in zip(seeds, on, off) for at, a, b in zip(y, asleep, awake)]
    asleep, awake = ([depth / radius for _, depth in profiles] for profiles in (on, off))
    for seed, a, b in zip(seeds, asleep, awake):
        print(f"seed {seed}, on against off: {rms(a - b):.2f}")
    print("between seeds, off:", *(f"{rms(a - b):.2f}" for a, b in itertools.combinations(awake, 2)))
    print(f"means over seeds, on against off: {rms(np.mean(asleep, axis=0) - np.mean(awake, axis=0)):.2f}")
    driver.write("activity_rut.csv", rows, provenance.origin_of_runs(sorted(RUNS.glob("seed_*_o*"))))


if __name__ == "__main__":
    main()
