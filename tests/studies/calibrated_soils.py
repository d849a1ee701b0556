#!/usr/bin/python3
"""Grains calibrated to the strength of a soil: runs `furrow calibrate rigs/calibrate_SOIL.json` in results/studies, or
continues it, and writes the evaluations as calibrated_SOIL.csv beside this script and the fitted soil file into
terrain/data.

usage: calibrated_soils.py [lete_sand] [sandy_loam]
"""
import csv
import json

import driver
import provenance
from driver import RESULTS, ROOT, read_json

SOILS = ("lete_sand", "sandy_loam")


def evaluations(folder, names):
    """One row for each evaluation of the fitted targets: parameters, figures with their errors, processor time."""
    lines = (folder / "evaluations.csv").read_text(encoding="utf-8").splitlines()
    for line in csv.DictReader(lines[1:]):
        if line.pop("set") != "fitted":
            continue
        values, errors = line.pop("values").split(), line.pop("errors").split()
        problem, time = line.pop("problem"), line.pop("processor_s")
        row = {parameter: f"{float(value):.6g}" for parameter, value in line.items()}
        for k, name in enumerate(names):
            row[name] = f"{float(values[k]):.5g}" if values else ""
            row[f"{name}_se"] = f"{float(errors[k]):.2g}" if errors else ""
        yield {**row, "processor_s": time, "problem": problem}


def main():
    parser = driver.options(__doc__)
    parser.add_argument("soils", nargs="*", default=SOILS)
    soils, made = parser.parse_args().soils, provenance.made_here()
    if unknown := [soil for soil in soils if soil not in SOILS]:
        parser.error(f"{unknown[0]}: is unknown, expected {' or '.join(SOILS)}")
    for soil in soils:
        out = RESULTS / f"calibrated_{soil}"
        out.parent.mkdir(parents=True, exist_ok=True)
        driver.furrow("calibrate", f"rigs/calibrate_{soil}.json", "--out", out, progress=True)
        result = read_json(out / "calibration.json")
        driver.write(f"calibrated_{soil}.csv", evaluations(out, [target["name"] for target in result["targets"]]), made)
        fitted = read_json(out / result["result"])
        fitted["measured"] = {"made": made, **fitted["measured"]}
        (ROOT / "terrain" / "data" / result["result"]).write_text(json.dumps(fitted, indent=2, ensure_ascii=False)
                                                                  + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
