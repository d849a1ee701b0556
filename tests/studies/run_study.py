#!/usr/bin/python3
"""Runs the cases of a study one after another and collects their summaries in one CSV file.

A finished case is used again only if this build of the program made it from the same scenario; otherwise it is run
again."""
import argparse
import json
import pathlib
import subprocess
import sys
import time

import provenance
from provenance import RECORD, ROOT, read_json

STEADINESS = ("drawbar_pull_N.steady", "drawbar_pull_N.n_eff")  # columns of every table


def settings(*groups):
    """--set flags for the given {key: value} groups; later groups win."""
    merged = {}
    for group in groups:
        merged.update(group)
    return [flag for key, value in merged.items() for flag in ("--set", f"{key}={json.dumps(value)}")]


def scenario_of(study, case):
    """The words of a command line that name the scenario of a case."""
    return [str(ROOT / case.get("scenario", study["scenario"])), *settings(study.get("set", {}), case.get("set", {}))]


def digest_of(scenario):
    """Of the scenario as this program reads it; None where the program refuses it."""
    done = subprocess.run([provenance.program(), "validate", *scenario, "--json"], capture_output=True, text=True)
    return json.loads(done.stdout)["scenario_digest"] if done.returncode == 0 else None


def stale_because(scenario, out):
    """Why the results in `out` are not those that this program would get now; None if they are."""
    summary, record = read_json(out / "summary.json"), read_json(out / RECORD)
    if not summary:
        return "it has no summary"
    if record.get("build") != provenance.build_of(provenance.program()):
        return "another build of the program made it"
    if summary.get("scenario_digest") != digest_of(scenario):
        return "its scenario has changed"
    return None


def run_case(name, scenario, out, made_at=None):
    """Returns whether the run was done."""
    (out / RECORD).unlink(missing_ok=True)
    begin = time.time()
    done = subprocess.run([provenance.program(), "run", *scenario, "--out", str(out), "--overwrite", "--no-plots"],
                          stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    print(f"{name}: exit {done.returncode}, {time.time() - begin:.0f} s", file=sys.stderr, flush=True)
    if done.returncode != 0:
        print(done.stderr[-2000:], file=sys.stderr)
        return False
    provenance.record_run(out, made_at)
    return True


def value_of(summary, path):
    """summary['a']['b'] for the dotted path 'a.b'; lists by index."""
    value = summary
    for part in path.split("."):
        value = value[int(part)] if isinstance(value, list) else value.get(part) if isinstance(value, dict) else None
    return value


def collect(study, done, table):
    """Writes the table of the cases {name: folder} that are done."""
    columns = [*study["columns"], *(name for name in STEADINESS if name not in study["columns"])]
    rows = []
    for name, out in done.items():
        summary = read_json(out / "summary.json")
        rows.append({"case": name, **{path: value_of(summary, path) for path in columns}})
    provenance.write_table(table, ["case", *columns], rows, provenance.origin_of_runs(done.values()))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("study", type=pathlib.Path)
    parser.add_argument("--only", nargs="*", help="names of the cases to run")
    parser.add_argument("--force", action="store_true", help="run finished cases again")
    parser.add_argument("--results", type=pathlib.Path, default=ROOT / "results" / "studies",
                        help="where the folders of studies are")
    arguments = parser.parse_args()
    study = json.loads(arguments.study.read_text())
    results = arguments.results / arguments.study.stem
    results.mkdir(parents=True, exist_ok=True)

    done, failed, made_at = {}, [], provenance.commit()
    for name, case in study["cases"].items():
        out, scenario = results / name, scenario_of(study, case)
        chosen = not arguments.only or name in arguments.only
        stale = stale_because(scenario, out)
        if stale and not chosen:
            if (out / "summary.json").exists():
                print(f"{name}: left out of the table: {stale}", file=sys.stderr)
            continue
        if stale and (out / "summary.json").exists():
            print(f"{name}: run again: {stale}", file=sys.stderr)
        if (stale or (chosen and arguments.force)) and not run_case(name, scenario, out, made_at):
            failed.append(name)
            continue
        done[name] = out
        collect(study, done, arguments.study.with_suffix(".csv"))
    if failed:
        sys.exit(f"failed: {', '.join(failed)}")


if __name__ == "__main__":
    main()
