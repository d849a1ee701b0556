#!/usr/bin/python3
"""How much faster or slower one build is than another: both in turn, A B B A …, on one core, ratio pair by pair.

paired_speed.py SOURCE_A SOURCE_B [--rounds 100] [--bench grains,tire] [--core 1] [--csv FILE]

SOURCE_A and SOURCE_B are checkouts with a build in build/. `grains` steps 63,360 grains on a lattice, every grain in
every step; `tire` rolls the layered tire. The ratio is exp(mean of log(B/A)) with its 95 % interval over the pairs.
Nothing else may compute on the machine meanwhile.
"""
import argparse
import csv
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "studies"))
import provenance  # noqa: E402


def write_lattice(file):
    """A lattice of grains that nearly touch; bench grains' radius is 6 mm."""
    rows = [(0.006 + 0.0119 * i, 0.007 + 0.0122 * j, 0.0059 + 0.0118 * k)
            for k in range(20) for i in range(66) for j in range(48)]
    with open(file, "w", newline="") as out:
        table = csv.writer(out)
        table.writerow(["x_m", "y_m", "z_m"])
        table.writerows([f"{value:.6f}" for value in row] for row in rows)


def milliseconds(source, words, core):
    environment = dict(os.environ, FURROW_HOME=str(source), OMP_NUM_THREADS="1")
    run = subprocess.run(["taskset", "-c", str(core), source / "build" / "furrow", "bench", *words],
                         env=environment, capture_output=True, text=True, check=True)
    result = json.loads(run.stdout)
    return result.get("ms_per_step") or result["median_ms"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("a", type=lambda text: Path(text).resolve(), metavar="SOURCE_A")
    parser.add_argument("b", type=lambda text: Path(text).resolve(), metavar="SOURCE_B")
    parser.add_argument("--rounds", type=int, default=100)
    parser.add_argument("--bench", default="grains,tire")
    parser.add_argument("--core", type=int, default=1)
    parser.add_argument("--csv", type=Path, help="write every pair to this file")
    arguments = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        bed = Path(folder) / "lattice.csv"
        write_lattice(bed)
        benches = {"grains": ["grains", "--bed", bed, "--threads", "1", "--steps", "400", "--warm", "50"],
                   "tire": ["tire", "--threads", "1", "--steps", "400", "--warm", "0.02"]}
        for name in arguments.bench.split(","):
            pairs = []
            for number in range(arguments.rounds):
                order = ("a", "b") if number % 2 == 0 else ("b", "a")
                took = {side: milliseconds(getattr(arguments, side), benches[name], arguments.core) for side in order}
                pairs.append((took["a"], took["b"]))
                rows.append((name, number, took["a"], took["b"]))
            logs = [math.log(b / a) for a, b in pairs]
            mean, error = statistics.mean(logs), statistics.stdev(logs) / math.sqrt(len(logs))
            print(f"{name}: median {statistics.median(a for a, _ in pairs):.4g} and "
                  f"{statistics.median(b for _, b in pairs):.4g} ms per step; B/A {math.exp(mean):.4f}, 95 % "
                  f"{math.exp(mean - 1.96 * error):.4f} to {math.exp(mean + 1.96 * error):.4f}, {len(logs)} pairs")
    if arguments.csv:
        sources = (arguments.a, arguments.b)
        made = {"commit": " and ".join(provenance.commit(source) for source in sources),
                "compiler": " and ".join(sorted({provenance.compiler_of(source / "build" / "furrow")
                                                 for source in sources})),
                "processor": provenance.processor(), "command": provenance.command()}
        columns = ["bench", "pair", "a_ms", "b_ms"]
        provenance.write_table(arguments.csv, columns, [dict(zip(columns, row)) for row in rows], made)


if __name__ == "__main__":
    main()
