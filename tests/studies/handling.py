#!/usr/bin/python3
"""The tables that handling tires are fitted to (`furrow calibrate rigs/calibrate_handling.json`), in the layout of
sweep.csv, in tire/data:

sweep_lumped.csv      the finished runs of rigs/study_handling.json, in results/study_handling or the folder given
cornering_lumped.csv  the lumped tire's rows of cornering.csv, with the steady side force and aligning moment of that
table

    build/furrow sweep rigs/study_handling.json --jobs 2
    /usr/bin/python3 tests/studies/handling.py [FOLDER] [--commit COMMIT]

--commit names the commit of the program where it is not that of the checkout.
"""
import argparse
import csv
import json
import pathlib

import provenance

HERE = pathlib.Path(__file__).resolve().parent
RESULTS = {"iso_w.force_N.0": "Fx_N", "iso_w.force_N.1": "steady_Fy_N",
           "iso_w.force_N.2": "Fz_N", "iso_w.moment_Nm.0": "Mx_Nm",
           "iso_w.moment_Nm.1": "My_Nm", "iso_w.moment_Nm.2": "steady_Mz_Nm", "iso_w.slip_angle_rad": "slip_angle_rad",
           "iso_w.camber_angle_rad": "camber_angle_rad", "iso_w.loaded_radius_m": "loaded_radius_m",
           "effective_rolling_radius_m": "effective_rolling_radius_m"}
KEYS = ("rig.carrier_mass", "rig.mode", "rig.slip", "rig.toe_angle", "rig.camber_angle")


def value_of(values, path):
    for part in path.split("."):
        values = values[int(part)] if isinstance(values, list) else values[part]
    return values


def short(value):
    return f"{value:.7g}" if isinstance(value, float) else value


def write(name, rows, made):
    rows.sort(key=lambda row: tuple(row.values()))
    provenance.write_table(provenance.ROOT / "tire/data" / name, list(rows[0]),
                           [{key: short(value) for key, value in row.items()} for row in rows], made)


def sweep(folder, commit):
    runs = sorted(path.parent for path in (folder / "runs").glob("*/summary.json"))
    rows = []
    for run in runs:
        if not (run / provenance.RECORD).exists():
            provenance.record_run(run, commit)
        summary, scenario = (json.loads((run / name).read_text(encoding="utf-8"))
                             for name in ("summary.json", "scenario.json"))
        row = {key: value_of(scenario, key) for key in KEYS}
        row = {key: float(value) if not isinstance(value, str) else value for key, value in row.items()}
        rows.append(row | {name: float(value_of(summary, name)) for name in RESULTS})
    write("sweep_lumped.csv", rows, provenance.origin_of_runs(runs))


def cornering():
    lines = (HERE / "cornering.csv").read_text(encoding="utf-8").splitlines()
    made = dict(line[2:].split(": ", 1) for line in lines if line.startswith("# "))
    rows = []
    for row in csv.DictReader(line for line in lines if not line.startswith("#")):
        if row["tire"] != "lumped":
            continue
        mode = "fixed_speed" if row["study"] == "hard_slip" else "free_rolling"
        rows.append({"rig.mode": mode, "study": row["study"], "setting": float(row["setting"])} |
                    {name: float(row[column]) for name, column in RESULTS.items()})
    made["command"] = "handling.py"
    write("cornering_lumped.csv", rows, made | {"note": "rows of cornering.csv"})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, nargs="?", default=provenance.ROOT / "results/study_handling")
    parser.add_argument("--commit")
    arguments = parser.parse_args()
    cornering()
    sweep(arguments.folder, arguments.commit)


if __name__ == "__main__":
    main()
