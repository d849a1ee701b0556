#!/usr/bin/python3
"""Grains calibrated to the strength of a soil: runs `furrow calibrate rigs/calibrate_SOIL.json` in results/studies, or
continues it, and writes the evaluations as calibrated_SOIL.csv beside this script and the fitted soil file into
terrain/data.

usage: calibrated_soils.py [lete_sand] [sandy_loam]
"""
import csv
import json
import pathlib
import subprocess
import sys

import provenance
from provenance import ROOT

HERE = pathlib.Path(__file__).resolve().parent
SOILS = ("lete_sand", "sandy_loam")


def evaluations(folder, names):
    """One row for each evaluation of the fitted targets: parameters, figures with their errors, processor time."""
    lines = (folder / "evaluations.csv").read_text(encoding="utf-8").splitlines()
    rows = []
    for line in csv.DictReader(lines[1:]):
        if line.pop("set") != "fitted":
            continue
        values, errors = line.pop("values").split(), line.pop("errors").split()
        problem, time = line.pop("problem"), line.pop("processor_s")
        row = {parameter: f"{float(value):.6g}" for parameter, value in line.items()}
        for k, name in enumerate(names):
            row[name] = f"{float(values[k]):.5g}" if values else ""
            row[f"{name}_se"] = f"{float(errors[k]):.2g}" if errors else ""
        rows.append({**row, "processor_s": time, "problem": problem})
    return rows


def main():
    soils = sys.argv[1:] or SOILS
    if unknown := [soil for soil in soils if soil not in SOILS]:
        sys.exit(f"{unknown[0]}: is unknown, expected {' or '.join(SOILS)}")
    made = provenance.made_here()
    for soil in soils:
        out = ROOT / "results" / "studies" / f"calibrated_{soil}"
        out.parent.mkdir(parents=True, exist_ok=True)
        subprocess.run([provenance.program(), "calibrate", str(ROOT / "rigs" / f"calibrate_{soil}.json"),
                        "--out", str(out)], check=True)
        result = provenance.read_json(out / "calibration.json")
        rows = evaluations(out, [target["name"] for target in result["targets"]])
        provenance.write_table(HERE / f"calibrated_{soil}.csv", list(rows[0]), rows, made)
        fitted = provenance.read_json(out / result["result"])
        fitted["measured"] = {"made": made, **fitted["measured"]}
        (ROOT / "terrain" / "data" / result["result"]).write_text(json.dumps(fitted, indent=2, ensure_ascii=False)
                                                                  + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
