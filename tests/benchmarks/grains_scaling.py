#!/usr/bin/env python3
"""Cost of a grain-step against the number of grains, and with one and two threads: `furrow bench grains` on beds of one
shape.

usage: grains_scaling.py BED.csv OUT.csv [--steps 300] [--rounds 2]

BED.csv: as for grains_and_peers.py, one whole metre long. Longer beds repeat it along x; the smallest is its lowest
quarter. Each bed is stepped with the law that is timed before the clock starts. Nothing else may run meanwhile. One row
per bed, law and number of threads: the median over rounds.
"""
import argparse
import csv
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "studies"))
import provenance  # noqa: E402

METRES = (1, 3, 10, 26, 52)
WARM = 100  # steps before the clock starts


def write_bed(rows, metres, file):
    with open(file, "w") as out:
        out.write("x_m,y_m,z_m\n")
        for k in range(metres):
            out.writelines(f"{x + k:.12g},{y:.12g},{z:.12g}\n" for x, y, z in rows)


def bench(bed, law, threads, steps):
    command = [provenance.program(), "bench", "grains", "--bed", str(bed), "--law", law]
    command += ["--threads", str(threads), "--steps", str(steps), "--warm", str(WARM)]
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bed", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--steps", type=int, default=300)
    parser.add_argument("--rounds", type=int, default=2)
    arguments = parser.parse_args()
    with open(arguments.bed) as file:
        grains = [tuple(map(float, row)) for row in list(csv.reader(file))[1:]]
    lowest = sorted(grains, key=lambda p: p[2])[: len(grains) // 4]
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for metres, part in [(1, lowest)] + [(n, grains) for n in METRES]:
            bed = pathlib.Path(folder) / "bed.csv"
            write_bed(part, metres, bed)
            steps = max(50, arguments.steps * len(grains) * 10 // max(len(part) * metres, len(grains) * 10))
            cases = [(law, threads) for law in ("hertz_tanh", "mindlin") for threads in (1, 2)]
            results = {case: [] for case in cases}
            for _ in range(arguments.rounds):
                for case in cases:
                    results[case].append(bench(bed, *case, steps))
            for law, threads in cases:
                found = results[law, threads]
                speed = statistics.median(r["grain_steps_per_s"] for r in found)
                one = statistics.median(r["grain_steps_per_s"] for r in results[law, 1])
                rows.append({"law": law, "grains": found[0]["grains"], "threads": threads, "steps": steps,
                             "grain_steps_per_s": f"{speed:.4g}", "ns_per_grain_step": f"{1e9 / speed:.4g}",
                             "against_one_thread": f"{speed / one:.3g}",
                             "coordination": f"{found[0]['coordination']:.4g}",
                             "bytes_per_grain": f"{found[0]['bytes_per_grain']:.4g}"})
                print(rows[-1], file=sys.stderr, flush=True)
    rows.sort(key=lambda r: (r["law"], r["threads"], r["grains"]))
    provenance.write_table(arguments.out, list(rows[0]), rows, provenance.made_here())


if __name__ == "__main__":
    main()
