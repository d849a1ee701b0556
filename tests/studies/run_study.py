#!/usr/bin/python3
"""Runs the cases of a study one after another and collects their summaries in one CSV file.

A finished case is used again only if this build of the program made it from the same scenario; otherwise it is run
again."""
import argparse
import json
import pathlib
import sys

import driver
import provenance
from provenance import ROOT

STEADINESS = ("drawbar_pull_N.steady", "drawbar_pull_N.n_eff")  # columns of every table


def scenario_of(study, case):
    """The words of a command line that name the scenario of a case."""
    return [str(ROOT / case.get("scenario", study["scenario"])),
            *driver.settings(study.get("set", {}), case.get("set", {}))]


def collect(study, done, table):
    """Writes the table of the cases {name: folder} that are done."""
    columns = [*study["columns"], *(name for name in STEADINESS if name not in study["columns"])]
    rows = [{"case": name, **{path: driver.value_of(driver.summary(out), path) for path in columns}}
            for name, out in done.items()]
    provenance.write_table(table, ["case", *columns], rows, provenance.origin_of_runs(done.values()))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("study", type=pathlib.Path)
    parser.add_argument("--only", nargs="*", help="names of the cases to run")
    parser.add_argument("--force", action="store_true", help="run finished cases again")
    parser.add_argument("--results", type=pathlib.Path, default=driver.RESULTS, help="where the folders of studies are")
    arguments = parser.parse_args()
    study = json.loads(arguments.study.read_text())
    results = arguments.results / arguments.study.stem
    results.mkdir(parents=True, exist_ok=True)

    done, failed, made_at = {}, [], provenance.commit()
    for name, case in study["cases"].items():
        out, scenario = results / name, scenario_of(study, case)
        chosen = not arguments.only or name in arguments.only
        stale = driver.stale_because(scenario, out)
        if stale and (out / "summary.json").exists():
            print(f"{name}: {'run again' if chosen else 'left out of the table'}: {stale}", file=sys.stderr)
        if stale and not chosen:
            continue
        if (stale or (chosen and arguments.force)) and not driver.run_case(name, scenario, out, made_at):
            failed.append(name)
            continue
        done[name] = out
        collect(study, done, arguments.study.with_suffix(".csv"))
    if failed:
        sys.exit(f"failed: {', '.join(failed)}")


if __name__ == "__main__":
    main()
