#!/usr/bin/python3
"""Runs `furrow sweep` and keeps its table with the lines of provenance.py above it.

usage: sweep_table.py STUDY [TABLE] [--jobs N] [--out FOLDER]

The runs lie in FOLDER (results/<name of the study>); those of another build of the program are refused, not mixed in.
Without TABLE the runs are only made, for scripts that read them (cornering.py).
"""
import pathlib
import subprocess
import sys

import driver
import provenance
from provenance import RECORD, ROOT, read_json


def runs_of(out):
    return [file.parent for file in sorted((out / "runs").glob("*/summary.json"))]


def main():
    parser = driver.options(__doc__, jobs={"default": "1"}, out={"type": pathlib.Path})
    parser.add_argument("study", type=pathlib.Path)
    parser.add_argument("table", type=pathlib.Path, nargs="?")
    arguments = parser.parse_args()
    out = arguments.out or ROOT / "results" / arguments.study.stem
    for run in runs_of(out):
        if read_json(run / RECORD).get("build") != provenance.build_of(provenance.program()):
            sys.exit(f"{run}: was made by another build of the program, expected none or this one's: move {out} away")
    done = subprocess.run([provenance.program(), "sweep", arguments.study, "--out", out, "--jobs", arguments.jobs])
    for run in runs_of(out):
        if not (run / RECORD).exists():
            provenance.record_run(run)
    if done.returncode == 0 and arguments.table:
        with open(arguments.table, "w", newline="", encoding="utf-8") as file:
            provenance.write_header(file, provenance.origin_of_runs(runs_of(out)))
            file.write((out / "sweep.csv").read_text(encoding="utf-8"))
    sys.exit(done.returncode)


if __name__ == "__main__":
    main()
