#!/usr/bin/python3
"""Runs `furrow sweep` and keeps its table with the lines of provenance.py above it.

usage: sweep_table.py STUDY [TABLE] [--jobs N] [--out FOLDER]

The runs lie in FOLDER (results/<name of the study>); those of another build of the program are refused, not mixed in.
Without TABLE the runs are only made, for scripts that read them (cornering.py).
"""
import argparse
import pathlib
import subprocess
import sys

import provenance
from provenance import RECORD, ROOT


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", type=pathlib.Path)
    parser.add_argument("table", type=pathlib.Path, nargs="?")
    parser.add_argument("--jobs", default="1")
    parser.add_argument("--out", type=pathlib.Path)
    arguments = parser.parse_args()
    out = arguments.out or ROOT / "results" / arguments.study.stem
    for folder in (out / "runs").glob("*"):
        build = provenance.read_json(folder / RECORD).get("build")
        if (folder / "summary.json").exists() and build != provenance.build_of(provenance.program()):
            sys.exit(f"{folder}: was made by another build of the program, expected none or this one's: move {out} "
                     f"away")
    done = subprocess.run([provenance.program(), "sweep", str(arguments.study),
                           "--out", str(out), "--jobs", arguments.jobs])
    runs = [summary.parent for summary in sorted((out / "runs").glob("*/summary.json"))]
    for run in runs:
        if not (run / RECORD).exists():
            provenance.record_run(run)
    if done.returncode != 0:
        sys.exit(done.returncode)
    if arguments.table:
        with open(arguments.table, "w", newline="", encoding="utf-8") as file:
            provenance.write_header(file, provenance.origin_of_runs(runs))
            file.write((out / "sweep.csv").read_text(encoding="utf-8"))


if __name__ == "__main__":
    main()
