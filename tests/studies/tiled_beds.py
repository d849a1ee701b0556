#!/usr/bin/python3
"""Tiled beds (terrain.tile) beside beds settled as a whole: are seams seen, and what does it save? Writes
tiled_beds.csv, tiled_beds_wheel.csv and tiled_beds_cost.csv beside this script.

usage: tiled_beds.py [--parts beds wheel cost] [--seeds N] [--soils cohesive loose_sand] [--full]

beds   Grains of the small rig, cohesive and as loose sand, 3 x 0.6 m, pieces of 1 m. By slices of 50 mm along x: share
       of solid in the middle half of the depth, contacts per grain, height and roughness of the surface (standard
       deviation of the highest grain tops over cells of 2 r). `seam`: the slices on either side of x = 1 m and x = 2 m;
       `away`: those in between, 0.2 m from seams and walls. In the bed that was settled as a whole the same places are
       compared.
wheel  A rigid wheel on such beds. `stands`: let down on a seam (x = 1 m) or away from it (x = 1.5 m), sinkage after
       0.6 s. `rolls`: the small rig's run at slip 0.3, whose averaging window holds the seam at x = 2 m: pull and
       sinkage.
cost   Processor time and wall time of `furrow bed`, tiled and as a whole: the small rig's grains on 12 x 0.6 m, pieces
       of 1 m. --full: also the bed for a vehicle, 20 x 3 m, r = 12 mm, 15 layers, 100 kPa, pieces of 3 m (a million
       grains).
"""
import json
import math
import statistics
import tempfile

import h5py
import numpy as np

import driver
import provenance

RIG = str(driver.ROOT / "rigs" / "drawbar_pull_small_report_soil.json")
SOILS = {"cohesive": {}, "loose_sand": {"terrain.material": "loose_sand.json",
                                        "terrain.cohesion": 0, "terrain.layers": 14}}
KINDS = {"tiled": {"terrain.tile": 1.0}, "whole": {}}
SLICE = 0.05  # m
SLICED = ("solid_fraction", "contacts_per_grain", "surface_height_mm", "roughness_mm")
LONG = {"terrain.length": 12.0}
FULL = {"terrain.radius": 0.012, "terrain.layers": 15, "terrain.cohesion": 100e3,
        "terrain.length": 20.0, "terrain.width": 3.0}


def bed(settings, **environment):
    """What `furrow bed` prints, and the time that it took."""
    told, processor, wall = driver.timed("bed", RIG, *driver.settings(settings), **environment)
    return {**json.loads(told), "processor_s": processor, "elapsed_s": wall}


def contacts_of(x, radii):
    """Touching neighbours of each grain, by cells of two of the largest radii."""
    key = np.floor((x - x.min(axis=0)) / (2.0 * radii.max())).astype(np.int64)
    size = key.max(axis=0) + 2
    number = (key[:, 0] * size[1] + key[:, 1]) * size[2] + key[:, 2]
    order = np.argsort(number, kind="stable")
    ordered = number[order]
    count = np.zeros(len(x), dtype=int)
    for dx, dy, dz in np.ndindex(3, 3, 3):
        other = number + ((dx - 1) * size[1] + dy - 1) * size[2] + dz - 1
        first, last = np.searchsorted(ordered, other, "left"), np.searchsorted(ordered, other, "right")
        for k in range(int((last - first).max(initial=0))):
            near = np.flatnonzero(first + k < last)
            j = order[first[near] + k]
            d = np.linalg.norm(x[near] - x[j], axis=1)
            count[near] += (d < radii[near] + radii[j]) & (near != j)
    return count


def slices(file, radius, width):
    """Figures of each slice along x."""
    with h5py.File(file, "r") as archive:
        x, radii = np.split(archive["position"][:].reshape(-1, 4), [3], axis=1)
    radii = radii[:, 0]
    contacts = contacts_of(x, radii)
    inside = np.abs(x[:, 1]) < 0.5 * width - 0.05  # away from the side walls
    depth = np.quantile(x[:, 2], 0.99)
    low, high, across = 0.25 * depth, 0.75 * depth, width - 0.1

    def below(h):  # volume of each grain below a height
        h = np.clip(h - x[:, 2] + radii, 0.0, 2.0 * radii)
        return math.pi * h * h * (3.0 * radii - h) / 3.0

    volume = below(high) - below(low)
    cells = (np.floor(x[:, 0] / (2 * radius)).astype(int), np.floor((x[:, 1] + 0.5 * width) / (2 * radius)).astype(int))
    tops = {}
    for i, j, z in zip(*cells, x[:, 2] + radii):
        tops[i, j] = max(tops.get((i, j), 0.0), z)
    for k in range(int(round(x[:, 0].max() / SLICE))):
        here = inside & (x[:, 0] >= k * SLICE) & (x[:, 0] < (k + 1) * SLICE)
        heights = [z for (i, j), z in tops.items() if k * SLICE <= (i + 0.5) * 2 * radius < (k + 1) * SLICE
                   and abs((j + 0.5) * 2 * radius - 0.5 * width) < 0.5 * width - 0.05]
        yield {"x": (k + 0.5) * SLICE, "solid_fraction": volume[here].sum() / (SLICE * across * (high - low)),
               "contacts_per_grain": contacts[here].mean(), "surface_height_mm": 1e3 * np.mean(heights),
               "roughness_mm": 1e3 * np.std(heights)}


def place_of(x):
    """Of a slice: at a seam, away from all, or neither."""
    to_seam = min(abs(x - 1.0), abs(x - 2.0))
    return "seam" if to_seam < SLICE else "away" if to_seam > 0.2 and 0.2 < x < 2.8 else None


def line_of(values, digits=5, **about):
    mean, half = driver.over_beds(values)
    return {**about, "beds": len(values), "mean": f"{mean:.{digits}g}", "half_width_95": f"{half:.2g}"}


def study_beds(arguments, made):
    rows = []
    for soil in arguments.soils:
        figures = {}  # (kind, place, quantity): a mean for each seed
        for seed in range(1, arguments.seeds + 1):
            for kind, of_kind in KINDS.items():
                told = bed({**SOILS[soil], **of_kind, "run.seed": seed})
                found = list(slices(told["cache_file"], 0.01, 0.6))
                for name in SLICED:
                    for place in ("seam", "away"):
                        values = [row[name] for row in found if place_of(row["x"]) == place]
                        figures.setdefault((kind, place, name), []).append(statistics.mean(values))
                figures.setdefault((kind, "all", "grains"), []).append(told["grains"])
                figures.setdefault((kind, "all", "max_overlap_mm"), []).append(1e3 * told["max_overlap_m"])
        rows += [line_of(values, soil=soil, bed=kind, where=place, what=name)
                 for (kind, place, name), values in figures.items()]
        rows += [line_of([a - b for a, b in zip(figures[kind, "seam", name], figures[kind, "away", name])], 3,
                         soil=soil, bed=kind, where="seam - away", what=name) for kind in KINDS for name in SLICED]
    driver.write(f"tiled_beds{'' if len(arguments.soils) > 1 else '_' + arguments.soils[0]}.csv", rows, made)


def study_wheel(arguments, made):
    rows = []
    common = {"tire.rigid": True, "output.frame_interval": 0, "checkpoint.at_end": False}
    stands = {"rig.mode": "fixed_speed", "rig.speed": 0.0, "rig.slip": 0.0, "run.end": 0.6, "run.average_from": 0.55}
    cases = [("stands, seam", "tiled", {**stands, "rig.start": 1.0}),
             ("stands, away", "tiled", {**stands, "rig.start": 1.5}),
             ("stands", "whole", {**stands, "rig.start": 1.0}), ("rolls", "tiled", {}), ("rolls", "whole", {})]
    for case, kind, settings in cases:
        found = []
        for seed in range(1, arguments.seeds + 1):
            name = f"{case.replace(', ', '_')}_{kind}_{seed}"
            words = [RIG, *driver.settings(common, settings, KINDS[kind], {"run.seed": seed})]
            found.append(driver.summary(driver.finished_case(name, words, driver.RESULTS / "tiled_beds" / name)))
        figures = {"sinkage_mm": [1e3 * summary["sinkage_m"] for summary in found]}
        if case == "rolls":
            for name, key in (("pull_N", "drawbar_pull_N"), ("tractive_effort_N", "tractive_effort_N")):
                figures[name] = [driver.mean_of(summary[key]) for summary in found]
        rows += [{**line_of(values, case=case, bed=kind, what=name), "values": " ".join(f"{v:.5g}" for v in values)}
                 for name, values in figures.items()]
    driver.write("tiled_beds_wheel.csv", rows, made, told=True)


def study_cost(arguments, made):
    rows = []
    cases = [("12 x 0.6", "tiled", {**LONG, "terrain.tile": 1.0}), ("12 x 0.6", "whole", LONG)]
    if arguments.full:
        cases += [("20 x 3", "tiled", {**FULL, "terrain.tile": 3.0}), ("20 x 3", "whole", FULL)]
    for size, kind, settings in cases:
        with tempfile.TemporaryDirectory() as cache:  # empty: nothing is found in it
            told = bed(settings, XDG_CACHE_HOME=cache)
        rows.append({"size_m": size, "bed": kind, "grains": told["grains"], "settled": told["settled"],
                     "simulated_s": f"{told['settling_time_s']:.3g}",
                     "solid_fraction_bulk": f"{told['solid_fraction_bulk']:.4f}",
                     "contacts_per_grain": f"{told['coordination_number']:.4f}",
                     "depth_mm": f"{1e3 * told['depth_m']:.4g}",
                     "max_overlap_mm": f"{1e3 * told['max_overlap_m']:.3g}", "threads": told["threads"],
                     "processor_s": f"{told['processor_s']:.0f}", "wall_s": f"{told['elapsed_s']:.0f}"})
        driver.write("tiled_beds_cost.csv", rows, made)


def main():
    parts = {"beds": study_beds, "wheel": study_wheel, "cost": study_cost}
    arguments = driver.options(__doc__, parts={"nargs": "+", "choices": tuple(parts), "default": tuple(parts)},
                               seeds={"type": int, "default": 5}, full={"action": "store_true"},
                               soils={"nargs": "+", "choices": tuple(SOILS), "default": tuple(SOILS)}).parse_args()
    made = provenance.made_here()  # before a table makes files differ
    for part in arguments.parts:
        parts[part](arguments, made)


if __name__ == "__main__":
    main()
