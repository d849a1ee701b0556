#!/usr/bin/python3
"""What wheels and axles do on soil, from the runs of vehicle_on_soil.json or of another study of vehicles on several
beds.

    /usr/bin/python3 tests/studies/run_study.py tests/studies/vehicle_on_soil.json
    /usr/bin/python3 tests/studies/vehicle_on_soil.py
    /usr/bin/python3 tests/studies/run_study.py tests/studies/vehicle_turn_and_rover.json
    /usr/bin/python3 tests/studies/vehicle_on_soil.py tests/studies/vehicle_turn_and_rover.json --wheels

Writes beside the study, named after it: ..._wheels.csv, the means of every wheel of every run over its averaging
window, and ..._figures.csv: the vehicle and its axles over the beds, of each variant with half of the 95 % interval of
the mean over the beds [Student's t] and, of other tires, the difference from flexible ones at 200 kPa, bed by bed. With
--wheels also every wheel, and every axle less the front one, bed by bed.
"""
import argparse
import json
import pathlib
import statistics
import sys

import numpy as np

import provenance
from provenance import ROOT, read_json

sys.path.insert(0, str(ROOT / "scripts"))
from plot.student import half_interval  # noqa: E402

STUDY = pathlib.Path(__file__).with_suffix(".json")  # unless another is named
REFERENCE = "flexible_200_kPa"
# column of a wheel's table, name in the tables here, factor, whether an axle has the sum of its wheels
WHEEL = [("iso_force_x_N", "force_x_N", 1.0, True), ("iso_force_y_N", "force_y_N", 1.0, True),
         ("iso_force_z_N", "force_z_N", 1.0, True),
         ("tractive_effort_N", "tractive_effort_N", 1.0, True), ("terrain_resistance_N", "resistance_N", 1.0, True),
         ("spindle_torque_Nm", "torque_Nm", 1.0, True), ("slip", "slip", 1.0, False),
         ("slip_angle_rad", "slip_angle_deg", 180.0 / np.pi, False),
         ("sinkage_m", "sinkage_mm", 1e3, False), ("sinkage_in_rut_m", "sinkage_in_rut_mm", 1e3, False),
         ("suspension_travel_m", "travel_mm", 1e3, False)]
NAMES = [name for _, name, _, _ in WHEEL]


class Run:
    def __init__(self, folder):
        self.summary = read_json(folder / "summary.json")
        self.folder = folder
        self.wheels = [wheel["name"] for wheel in self.summary["wheels"]]
        self.means = [self.of_wheel(k) for k in range(len(self.wheels))]

    def series(self, subject):
        table = np.genfromtxt(self.folder / f"timeseries_{subject}.csv", delimiter=",", names=True)
        return table, table["time_s"] > self.summary["average_from_s"]

    def of_wheel(self, index):
        table, late = self.series(f"wheel{index}")
        return {name: factor * float(np.mean(table[column][late])) for column, name, factor, _ in WHEEL}

    def of_vehicle(self):
        table, late = self.series("vehicle")
        time, speed = table["time_s"][late], table["speed_m_s"][late]
        return {"distance_m": float(table["distance_m"][-1]), "speed_at_the_end_m_s": float(speed[-1]),
                "acceleration_m_s2": float((speed[-1] - speed[0]) / (time[-1] - time[0])),
                "engine_work_kJ": 1e-3 * float(table["drive_work_J"][-1]),
                "power_into_tires_and_soil_kW": 1e-3 * float(np.mean(table["soil_power_W"][late]))}

    def of_axles(self):
        found = {}
        for axle in dict.fromkeys(name.rsplit("_", 1)[0] for name in self.wheels):
            means = [mean for name, mean in zip(self.wheels, self.means) if name.rsplit("_", 1)[0] == axle]
            for _, name, _, total in WHEEL:
                values = [mean[name] for mean in means]
                found[f"{axle}: {name}"] = sum(values) if total else statistics.mean(values)
        return found

    def of_wheels(self):
        """Every wheel, and the axles less the front one."""
        found = {f"{wheel}: {name}": mean[name] for wheel, mean in zip(self.wheels, self.means) for name in NAMES}
        axles = self.of_axles()
        front = next(iter(axles)).split(":")[0]
        for key, value in axles.items():
            axle, name = key.split(": ")
            if axle != front:
                found[f"{axle} less {front}: {name}"] = value - axles[f"{front}: {name}"]
        return found

    def figures(self, wheels):
        return {**self.of_vehicle(), **self.of_axles(), **(self.of_wheels() if wheels else {})}


def short(value):
    return f"{value:.4g}"


def figures_of_beds(runs, wheels):
    """Lines of the variants that were run on several beds; `runs`: {case: Run}, cases named variant-seed; `wheels`: of
    every wheel too."""
    variants = {}
    for case, run in runs.items():
        if "-" in case:
            variant, seed = case.rsplit("-", 1)
            variants.setdefault(variant, {})[seed] = run.figures(wheels)
    rows = []
    for variant, beds in variants.items():
        reference = variants.get(REFERENCE, {})
        shared = [seed for seed in beds if seed in reference]
        for name in next(iter(beds.values())):
            values = [figures[name] for figures in beds.values()]
            row = {"tires": variant, "figure": name, "beds": len(beds), "mean": short(statistics.mean(values)),
                   "half_95": short(half_interval(values)) if len(values) > 1 else ""}
            if variant != REFERENCE and shared:
                changes = [beds[seed][name] - reference[seed][name] for seed in shared]
                row["change"] = short(statistics.mean(changes))
                row["change_half_95"] = short(half_interval(changes)) if len(changes) > 1 else ""
            rows.append(row)
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("study", type=pathlib.Path, nargs="?", default=STUDY, help="study file whose runs are finished")
    parser.add_argument("--wheels", action="store_true",
                        help="figures of every wheel, and of the axles against the front one")
    parser.add_argument("--results", type=pathlib.Path,
                        help="folder of the cases; default: results/studies/NAME_OF_THE_STUDY")
    arguments = parser.parse_args()
    study, results = arguments.study, arguments.results or ROOT / "results" / "studies" / arguments.study.stem
    cases = json.loads(study.read_text())["cases"]
    runs = {case: Run(results / case) for case in cases if (results / case / "summary.json").exists()}
    if not runs:
        raise SystemExit(f"{results}: holds no finished case, expected those of run_study.py {study.name}")
    origin = provenance.origin_of_runs(run.folder for run in runs.values())
    origin["command"] = " ".join([pathlib.Path(__file__).name, *([study.name] if study.stem != STUDY.stem else []),
                                  *(["--wheels"] if arguments.wheels else [])])
    rows = [{"case": case, "wheel": wheel, **{name: short(value) for name, value in means.items()}}
            for case, run in runs.items() for wheel, means in zip(run.wheels, run.means)]
    provenance.write_table(study.with_name(f"{study.stem}_wheels.csv"), ["case", "wheel", *NAMES], rows, origin)
    figures = figures_of_beds(runs, arguments.wheels)
    provenance.write_table(study.with_name(f"{study.stem}_figures.csv"),
                           ["tires", "figure", "beds", "mean", "half_95", "change", "change_half_95"],
                           figures, origin)
    for row in figures:
        change = f"change {row['change']:>8} ± {row['change_half_95']}" if row.get("change") else ""
        print(f"{row['tires']:<18} {row['figure']:<34} {row['mean']:>9} ± {row['half_95']:<8} {change}")


if __name__ == "__main__":
    main()
