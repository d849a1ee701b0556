#!/usr/bin/python3
"""Runs the cases of a study one after another and collects their summaries in one CSV file."""
import argparse
import csv
import json
import os
import pathlib
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]


def settings(*groups):
    """--set flags for the given {key: value} groups; later groups win."""
    merged = {}
    for group in groups:
        merged.update(group)
    return [flag for key, value in merged.items() for flag in ("--set", f"{key}={json.dumps(value)}")]


def run_case(study, name, case, out, force):
    """Runs one case unless its summary is there already; returns the summary."""
    summary = out / "summary.json"
    if force or not summary.exists():
        scenario = ROOT / case.get("scenario", study["scenario"])
        command = [os.environ.get("FURROW", str(ROOT / "build" / "furrow")), "run", str(scenario), "--out", str(out), "--overwrite", "--no-plots"]
        command += settings(study.get("set", {}), case.get("set", {}))
        begin = time.time()
        done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        print(f"{name}: exit {done.returncode}, {time.time() - begin:.0f} s", file=sys.stderr, flush=True)
        if done.returncode != 0:
            print(done.stderr[-2000:], file=sys.stderr)
            return None
    return json.loads(summary.read_text())


def value_of(summary, path):
    """summary['a']['b'] for the dotted path 'a.b'; lists by index."""
    value = summary
    for part in path.split("."):
        value = value[int(part)] if isinstance(value, list) else value.get(part) if isinstance(value, dict) else None
    return value


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("study", type=pathlib.Path)
    parser.add_argument("--only", nargs="*", help="names of the cases to run")
    parser.add_argument("--force", action="store_true", help="run finished cases again")
    arguments = parser.parse_args()
    study = json.loads(arguments.study.read_text())
    results = ROOT / "results" / "studies" / arguments.study.stem
    results.mkdir(parents=True, exist_ok=True)

    failed = []
    rows = []
    for name, case in study["cases"].items():
        out = results / name
        if arguments.only and name not in arguments.only and not (out / "summary.json").exists():
            continue
        summary = run_case(study, name, case, out, arguments.force and (not arguments.only or name in arguments.only))
        if summary is None:
            failed.append(name)
            continue
        rows.append({"case": name, **{path: value_of(summary, path) for path in study["columns"]}})
        target = arguments.study.with_suffix(".csv")
        with open(target, "w", newline="") as file:
            writer = csv.DictWriter(file, ["case", *study["columns"]])
            writer.writeheader()
            writer.writerows(rows)
    if failed:
        sys.exit(f"failed: {', '.join(failed)}")


if __name__ == "__main__":
    main()
