#!/usr/bin/env python3
"""Cost of a grain-step against the number of grains, and with one and two threads: `furrow bench grains` on beds of one
shape.

usage: grains_scaling.py BED.csv OUT.csv [--steps 300] [--rounds 2]

BED.csv: as for grains_and_peers.py, one whole metre long. Longer beds repeat it along x; the smallest is its lowest
quarter. Each bed is stepped with the law that is timed before the clock starts. Nothing else may run meanwhile. One row
per bed, law and number of threads: the median over rounds.
"""
import csv
import itertools
import pathlib
import statistics
import tempfile

from grains_and_peers import bench_grains, driver, options

METRES = (1, 3, 10, 26, 52)
WARM = 100  # steps before the clock starts


def write_bed(grains, metres, file):
    with open(file, "w") as out:
        out.write("x_m,y_m,z_m\n")
        for k in range(metres):
            out.writelines(f"{x + k:.12g},{y:.12g},{z:.12g}\n" for x, y, z in grains)


def main():
    arguments = options(__doc__, steps={"type": int, "default": 300}, rounds={"type": int, "default": 2})
    with open(arguments.bed) as file:
        grains = [tuple(map(float, row)) for row in list(csv.reader(file))[1:]]
    lowest = sorted(grains, key=lambda p: p[2])[: len(grains) // 4]
    cases, rows = list(itertools.product(("hertz_tanh", "mindlin"), (1, 2))), []
    with tempfile.TemporaryDirectory() as folder:
        for metres, part in [(1, lowest)] + [(n, grains) for n in METRES]:
            bed = pathlib.Path(folder) / "bed.csv"
            write_bed(part, metres, bed)
            steps = max(50, arguments.steps * len(grains) * 10 // max(len(part) * metres, len(grains) * 10))
            results = {case: [] for case in cases}
            for _, case in itertools.product(range(arguments.rounds), cases):
                results[case].append(bench_grains(bed, *case, steps, WARM))
            speeds = {case: statistics.median(r["grain_steps_per_s"] for r in found) for case, found in results.items()}
            for (law, threads), found in results.items():
                speed = speeds[law, threads]
                rows.append({"law": law, "grains": found[0]["grains"], "threads": threads, "steps": steps,
                             "grain_steps_per_s": speed, "ns_per_grain_step": 1e9 / speed,
                             "against_one_thread": f"{speed / speeds[law, 1]:.3g}",
                             "coordination": float(found[0]["coordination"]),
                             "bytes_per_grain": float(found[0]["bytes_per_grain"])})
    rows.sort(key=lambda r: (r["law"], r["threads"], r["grains"]))
    driver.write(arguments.out, rows, told=True)


if __name__ == "__main__":
    main()
