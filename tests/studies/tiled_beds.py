#!/usr/bin/python3
"""Tiled beds (terrain.tile) beside beds settled as a whole: are seams seen, and what does it save? Writes
tiled_beds.csv, tiled_beds_wheel.csv and tiled_beds_cost.csv beside this script.

usage: tiled_beds.py [--parts beds wheel cost] [--seeds N] [--soils cohesive loose_sand]

beds   Grains of the small rig, cohesive and as loose sand, 3 x 0.6 m, pieces of 1 m. By slices of 50 mm along x: share
of solid
       in the middle half of the depth, contacts per grain, height and roughness of the surface (standard deviation of
       the highest grain tops over cells of 2 r). `seam`: the slices on either side of x = 1 m and x = 2 m; `away`:
       those in between, 0.2 m from seams and walls. In the bed that was settled as a whole the same places are
       compared.
wheel  A rigid wheel on such beds. `stands`: let down on a seam (x = 1 m) or away from it (x = 1.5 m), sinkage after 0.6
s.
       `rolls`: the small rig's run at slip 0.3, whose averaging window holds the seam at x = 2 m: pull and sinkage.
cost   Processor time and wall time of `furrow bed`, tiled and as a whole: the small rig's grains on 12 x 0.6 m, pieces
of 1 m.
       --full: also the bed for a vehicle, 20 x 3 m, r = 12 mm, 15 layers, 100 kPa, pieces of 3 m (a million grains).
"""
import argparse
import json
import math
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "scripts"))
import provenance  # noqa: E402
import run_study  # noqa: E402
from plot.student import half_interval  # noqa: E402
from provenance import ROOT  # noqa: E402

RIG = str(ROOT / "rigs" / "drawbar_pull_small.json")
OUT = ROOT / "results" / "studies" / "tiled_beds"
SOILS = {"cohesive": {}, "loose_sand": {"terrain.material": "loose_sand.json",
                                        "terrain.cohesion": 0, "terrain.layers": 14}}
KINDS = {"tiled": {"terrain.tile": 1.0}, "whole": {}}
SLICE = 0.05  # m
LONG = {"terrain.length": 12.0}
FULL = {"terrain.radius": 0.012, "terrain.layers": 15, "terrain.cohesion": 100e3,
        "terrain.length": 20.0, "terrain.width": 3.0}


def flags(*groups):
    merged = {key: value for group in groups for key, value in group.items()}
    return [word for key, value in merged.items() for word in ("--set", f"{key}={json.dumps(value)}")]


def bed(settings):
    """What `furrow bed` prints, and the processor time that it took."""
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.time()
    done = subprocess.run([provenance.program(), "bed", RIG, *flags(settings)], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr[-2000:])
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    told = json.loads(done.stdout)
    told["processor_s"], told["elapsed_s"] = (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime,
                                              time.time() - begin)
    return told


def contacts_of(x, radii):
    """Touching neighbours of each grain, by cells of two of the largest radii."""
    cell = 2.0 * radii.max()
    key = np.floor((x - x.min(axis=0)) / cell).astype(np.int64)
    size = key.max(axis=0) + 2
    number = (key[:, 0] * size[1] + key[:, 1]) * size[2] + key[:, 2]
    order = np.argsort(number, kind="stable")
    ordered = number[order]
    count = np.zeros(len(x), dtype=int)
    for dx in (-1, 0, 1):
        for dy in (-1, 0, 1):
            for dz in (-1, 0, 1):
                other = number + (dx * size[1] + dy) * size[2] + dz
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
    rows = []
    for k in range(int(round(x[:, 0].max() / SLICE))):
        here = inside & (x[:, 0] >= k * SLICE) & (x[:, 0] < (k + 1) * SLICE)
        heights = [z for (i, j), z in tops.items() if k * SLICE <= (i + 0.5) * 2 * radius < (k + 1) * SLICE
                   and abs((j + 0.5) * 2 * radius - 0.5 * width) < 0.5 * width - 0.05]
        rows.append({"x": (k + 0.5) * SLICE, "solid_fraction": volume[here].sum() / (SLICE * across * (high - low)),
                     "contacts_per_grain": contacts[here].mean(), "surface_height_mm": 1e3 * np.mean(heights),
                     "roughness_mm": 1e3 * np.std(heights)})
    return rows


def place_of(x):
    """Of a slice: at a seam, away from all, or neither."""
    to_seam = min(abs(x - 1.0), abs(x - 2.0))
    return "seam" if to_seam < SLICE else "away" if to_seam > 0.2 and 0.2 < x < 2.8 else None


def study_beds(seeds, soils, made):
    rows = []
    for soil in soils:
        of_soil = SOILS[soil]
        figures = {}  # (kind, place, quantity): a mean for each seed
        for seed in range(1, seeds + 1):
            for kind, of_kind in KINDS.items():
                told = bed({**of_soil, **of_kind, "run.seed": seed})
                found = slices(told["cache_file"], 0.01, 0.6)
                for name in ("solid_fraction", "contacts_per_grain", "surface_height_mm", "roughness_mm"):
                    for place in ("seam", "away"):
                        values = [row[name] for row in found if place_of(row["x"]) == place]
                        figures.setdefault((kind, place, name), []).append(statistics.mean(values))
                for name, key in (("grains", "grains"), ("max_overlap_mm", "max_overlap_m")):
                    figures.setdefault((kind, "all", name), []).append(told[key] * (1e3 if name.endswith("mm") else 1))
        for (kind, place, name), values in figures.items():
            rows.append({"soil": soil, "bed": kind, "where": place, "what": name,
                         "beds": len(values), "mean": f"{statistics.mean(values):.5g}",
                         "half_width_95": f"{half_interval(values):.2g}"})
        for kind in KINDS:
            for name in ("solid_fraction", "contacts_per_grain", "surface_height_mm", "roughness_mm"):
                values = [a - b for a, b in zip(figures[kind, "seam", name], figures[kind, "away", name])]
                rows.append({"soil": soil, "bed": kind, "where": "seam - away", "what": name, "beds": len(values),
                             "mean": f"{statistics.mean(values):.3g}", "half_width_95": f"{half_interval(values):.2g}"})
    provenance.write_table(HERE / f"tiled_beds{'' if len(soils) > 1 else '_' + soils[0]}.csv",
                           list(rows[0]), rows, made)


def run(name, settings):
    """The summary of a run; one that this build made of this scenario is used again."""
    out, scenario = OUT / name, [RIG, *flags(settings)]
    if run_study.stale_because(scenario, out) and not run_study.run_case(name, scenario, out):
        sys.exit(f"{name}: failed")
    return provenance.read_json(out / "summary.json")


def study_wheel(seeds, made):
    rows = []
    common = {"tire.rigid": True, "output.frame_interval": 0, "checkpoint.at_end": False}
    stands = {"rig.mode": "fixed_speed", "rig.speed": 0.0, "rig.slip": 0.0, "run.end": 0.6, "run.average_from": 0.55}
    cases = [("stands, seam", "tiled", {**stands, "rig.start": 1.0}),
             ("stands, away", "tiled", {**stands, "rig.start": 1.5}),
             ("stands", "whole", {**stands, "rig.start": 1.0}), ("rolls", "tiled", {}), ("rolls", "whole", {})]
    for case, kind, settings in cases:
        sums = [run(f"{case.replace(', ', '_')}_{kind}_{seed}", {**common, **settings, **KINDS[kind], "run.seed": seed})
                for seed in range(1, seeds + 1)]
        figures = {"sinkage_mm": [1e3 * s["sinkage_m"] for s in sums]}
        if case == "rolls":
            figures["pull_N"] = [s["drawbar_pull_N"]["mean"] for s in sums]
            figures["tractive_effort_N"] = [s["tractive_effort_N"] for s in sums]
        for name, values in figures.items():
            rows.append({"case": case, "bed": kind, "what": name, "beds": len(values),
                         "mean": f"{statistics.mean(values):.5g}",
                         "half_width_95": f"{half_interval(values):.2g}",
                         "values": " ".join(f"{v:.5g}" for v in values)})
            print(rows[-1], flush=True)
    provenance.write_table(HERE / "tiled_beds_wheel.csv", list(rows[0]), rows, made)


def study_cost(full, made):
    rows = []
    cases = [("12 x 0.6", "tiled", {**LONG, "terrain.tile": 1.0}), ("12 x 0.6", "whole", LONG)]
    if full:
        cases += [("20 x 3", "tiled", {**FULL, "terrain.tile": 3.0}), ("20 x 3", "whole", FULL)]
    for size, kind, settings in cases:
        with tempfile.TemporaryDirectory() as cache:  # empty: nothing is found in it
            os.environ["XDG_CACHE_HOME"] = cache
            told = bed(settings)
        rows.append({"size_m": size, "bed": kind, "grains": told["grains"], "settled": told["settled"],
                     "simulated_s": f"{told['settling_time_s']:.3g}",
                     "solid_fraction_bulk": f"{told['solid_fraction_bulk']:.4f}",
                     "contacts_per_grain": f"{told['coordination_number']:.4f}",
                     "depth_mm": f"{1e3 * told['depth_m']:.4g}",
                     "max_overlap_mm": f"{1e3 * told['max_overlap_m']:.3g}", "threads": told["threads"],
                     "processor_s": f"{told['processor_s']:.0f}", "wall_s": f"{told['elapsed_s']:.0f}"})
        print(rows[-1], flush=True)
        provenance.write_table(HERE / "tiled_beds_cost.csv", list(rows[0]), rows, made)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--parts", nargs="+", choices=("beds", "wheel", "cost"), default=["beds", "wheel", "cost"])
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--soils", nargs="+", choices=tuple(SOILS), default=tuple(SOILS))
    parser.add_argument("--full", action="store_true")
    arguments = parser.parse_args()
    made = provenance.made_here()  # before a table makes files differ
    if "beds" in arguments.parts:
        study_beds(arguments.seeds, arguments.soils, made)
    if "wheel" in arguments.parts:
        study_wheel(arguments.seeds, made)
    if "cost" in arguments.parts:
        study_cost(arguments.full, made)


if __name__ == "__main__":
    main()
