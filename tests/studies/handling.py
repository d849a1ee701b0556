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
import pathlib

import driver
import provenance
from driver import HERE, ROOT, read_json, value_of

# columns of a sweep's table: of cornering.csv
RESULTS = {"iso_w.force_N.0": "Fx_N", "iso_w.force_N.1": "steady_Fy_N", "iso_w.force_N.2": "Fz_N",
           "iso_w.moment_Nm.0": "Mx_Nm", "iso_w.moment_Nm.1": "My_Nm", "iso_w.moment_Nm.2": "steady_Mz_Nm",
           "iso_w.slip_angle_rad": "slip_angle_rad", "iso_w.camber_angle_rad": "camber_angle_rad",
           "iso_w.loaded_radius_m": "loaded_radius_m", "effective_rolling_radius_m": "effective_rolling_radius_m"}
KEYS = ("rig.carrier_mass", "rig.mode", "rig.slip", "rig.toe_angle", "rig.camber_angle")


def write(name, rows, made):
    driver.write(ROOT / "tire" / "data" / name, sorted(rows, key=lambda row: tuple(row.values())), made, 7)


def sweep(folder, commit):
    runs, rows = sorted(path.parent for path in (folder / "runs").glob("*/summary.json")), []
    for run in runs:
        if not (run / provenance.RECORD).exists():
            provenance.record_run(run, commit)
        summary, scenario = driver.summary(run), read_json(run / "scenario.json")
        row = {key: value_of(scenario, key) for key in KEYS}
        row = {key: float(value) if not isinstance(value, str) else value for key, value in row.items()}
        rows.append(row | {name: float(value_of(summary, name)) for name in RESULTS})
    write("sweep_lumped.csv", rows, provenance.origin_of_runs(runs))


def cornering():
    made = provenance.read_origin(HERE / "cornering.csv") | {"command": "handling.py", "note": "rows of cornering.csv"}
    rows = [{"rig.mode": "fixed_speed" if row["study"] == "hard_slip" else "free_rolling", "study": row["study"],
             "setting": float(row["setting"]), **{name: float(row[column]) for name, column in RESULTS.items()}}
            for row in provenance.read_table(HERE / "cornering.csv") if row["tire"] == "lumped"]
    write("cornering_lumped.csv", rows, made)


def main():
    parser = driver.options(__doc__, commit={})
    parser.add_argument("folder", type=pathlib.Path, nargs="?", default=ROOT / "results" / "study_handling")
    arguments = parser.parse_args()
    cornering()
    sweep(arguments.folder, arguments.commit)


if __name__ == "__main__":
    main()
