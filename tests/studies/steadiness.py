#!/usr/bin/python3
"""How often the test for drifts is wrong, and how good the standard error is, on synthetic series: steadiness.csv.

    cmake --build build --target steadiness_rates
    /usr/bin/python3 tests/studies/steadiness.py
"""
import argparse
import csv
import pathlib
import subprocess

import provenance

HERE = pathlib.Path(__file__).resolve().parent


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return provenance.NOT_RECORDED


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=pathlib.Path, default=provenance.ROOT / "build" / "steadiness_rates")
    parser.add_argument("--trials", type=int, default=4000)
    arguments = parser.parse_args()
    done = subprocess.run([arguments.program, str(arguments.trials)], check=True, capture_output=True, text=True)
    compiler, *lines = done.stdout.splitlines()
    rows = list(csv.DictReader(lines))
    made = {"commit": provenance.commit(), "compiler": compiler.split(": ", 1)[1],
            "processor": processor(), "command": provenance.command()}
    provenance.write_table(HERE / "steadiness.csv", list(rows[0]), rows, made)


if __name__ == "__main__":
    main()
