#!/usr/bin/python3
"""Compares the runs of activity.json with and without sleeping grains, bed by bed: forces, and the rut 1 s after the
wheel. Writes activity_rut.csv beside this script, after run_study.py activity.json.

One row per bed and quantity: with sleep, without, and their difference. The rows without a bed hold the mean over beds
and in `half_width` the half-width of its 95 % interval, from the spread of the differences. `rut_later_mm` is the depth
of the rut, mean over 0.24 m across and from 1.3 to 1.6 m behind the axle, where the wheel was about 1 s before the end.
"""
import h5py
import numpy as np

import driver
import provenance

RUNS = driver.RESULTS / "activity"
LATER = (1.3, 1.6)  # behind the axle, m
FIGURES = {"pull_N": ("drawbar_pull_N", 1.0), "sinkage_mm": ("sinkage_m", 1e3), "rut_depth_mm": ("rut_depth_m", 1e3),
           "effort_N": ("tractive_effort_N", 1.0), "active_share": ("active_share_mean", 1.0)}


def depths(folder):
    """(x, y, depth of the rut at x and y, place of the axle at the end), m"""
    with h5py.File(folder / "results.h5") as file:
        axle = np.ravel(file["series/wheel0/position_m"][-1])[0]
        x0, y0, cell = file["terrain/height_before_grid"][:]
        depth = file["terrain/height_before"][:] - file["terrain/height_after"][:]
    return x0 + cell * np.arange(depth.shape[0]), y0 + cell * np.arange(depth.shape[1]), depth, axle


def figures(folder):
    x, y, depth, axle = depths(folder)
    later = depth[(x > axle - LATER[1]) & (x < axle - LATER[0])][:, abs(y) < 0.12]
    summary = driver.summary(folder)
    return {name: scale * driver.mean_of(summary[key]) for name, (key, scale) in FIGURES.items()} | {
        "rut_later_mm": 1e3 * float(np.nanmean(later))}


def main():
    driver.options(__doc__).parse_args()
    seeds = sorted(int(folder.name.split("_")[1]) for folder in RUNS.glob("seed_*_on"))
    driver.finished_runs(RUNS, [f"seed_{seed}_{sleep}" for seed in seeds for sleep in ("on", "off")])
    on, off = ([figures(RUNS / f"seed_{seed}_{sleep}") for seed in seeds] for sleep in ("on", "off"))
    rows, columns = [], ("asleep", "awake", "difference")
    for name in on[0]:
        of = [(a[name], b[name], a[name] - b[name]) for a, b in zip(on, off)]
        rows += [{"bed": seed, "quantity": name, **dict(zip(columns, row))} for seed, row in zip(seeds, of)]
        means, halves = zip(*(driver.over_beds(values) for values in zip(*of)))
        rows.append({"quantity": name, **dict(zip(columns, means)), "half_width": halves[2]})
        print(rows[-1])
    driver.write("activity_rut.csv", rows, provenance.origin_of_runs(sorted(RUNS.glob("seed_*_o*"))), digits=5)


if __name__ == "__main__":
    main()
