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
import json
import pathlib
import statistics

import numpy as np

import driver
import provenance
from driver import over_beds

STUDY = pathlib.Path(__file__).with_suffix(".json")  # unless another is named
REFERENCE = "flexible_200_kPa"
# column of a wheel's table: name in the tables here, factor, whether an axle has the sum of its wheels
WHEEL = {"iso_force_x_N": ("force_x_N", 1.0, True), "iso_force_y_N": ("force_y_N", 1.0, True),
         "iso_force_z_N": ("force_z_N", 1.0, True), "tractive_effort_N": ("tractive_effort_N", 1.0, True),
         "terrain_resistance_N": ("resistance_N", 1.0, True), "spindle_torque_Nm": ("torque_Nm", 1.0, True),
         "slip": ("slip", 1.0, False), "slip_angle_rad": ("slip_angle_deg", 180.0 / np.pi, False),
         "sinkage_m": ("sinkage_mm", 1e3, False), "sinkage_in_rut_m": ("sinkage_in_rut_mm", 1e3, False),
         "suspension_travel_m": ("travel_mm", 1e3, False)}


class Run:
    def __init__(self, folder):
        self.folder, self.summary = folder, driver.summary(folder)
        self.wheels = [wheel["name"] for wheel in self.summary["wheels"]]
        self.means = [self.of_wheel(k) for k in range(len(self.wheels))]

    def series(self, subject):
        table = driver.series(self.folder, subject)
        return table, table["time_s"] > self.summary["average_from_s"]

    def of_wheel(self, index):
        table, late = self.series(f"wheel{index}")
        return {name: factor * float(np.mean(table[column][late])) for column, (name, factor, _) in WHEEL.items()}

    def of_vehicle(self):
        table, late = self.series("vehicle")
        time, speed = table["time_s"][late], table["speed_m_s"][late]
        return {"distance_m": float(table["distance_m"][-1]), "speed_at_the_end_m_s": float(speed[-1]),
                "acceleration_m_s2": float((speed[-1] - speed[0]) / (time[-1] - time[0])),
                "engine_work_kJ": 1e-3 * float(table["drive_work_J"][-1]),
                "power_into_tires_and_soil_kW": 1e-3 * float(np.mean(table["soil_power_W"][late]))}

    def of_axles(self):
        """{axle: {name: value}}"""
        found = {}
        for wheel, mean in zip(self.wheels, self.means):
            found.setdefault(wheel.rsplit("_", 1)[0], []).append(mean)
        return {axle: {name: (sum if total else statistics.mean)([mean[name] for mean in means])
                       for name, _, total in WHEEL.values()} for axle, means in found.items()}

    def figures(self, wheels):
        axles = self.of_axles()
        groups = dict(axles)
        if wheels:  # every wheel, and the axles less the front one
            front, *others = axles
            groups |= dict(zip(self.wheels, self.means))
            groups |= {f"{axle} less {front}": {name: axles[axle][name] - axles[front][name] for name in axles[axle]}
                       for axle in others}
        return self.of_vehicle() | {f"{group}: {name}": value for group, values in groups.items()
                                    for name, value in values.items()}


def figures_of_beds(runs, wheels):
    """Lines of the variants that were run on several beds; `runs`: {case: Run}, cases named variant-seed; `wheels`: of
    every wheel too."""
    variants = {}
    for case, run in runs.items():
        if "-" in case:
            variant, seed = case.rsplit("-", 1)
            variants.setdefault(variant, {})[seed] = run.figures(wheels)
    for variant, beds in variants.items():
        reference = {} if variant == REFERENCE else variants.get(REFERENCE, {})
        for name in next(iter(beds.values())):
            row = dict(zip(("mean", "half_95"), over_beds([figures[name] for figures in beds.values()])))
            if changes := [beds[seed][name] - reference[seed][name] for seed in beds if seed in reference]:
                row |= dict(zip(("change", "change_half_95"), over_beds(changes)))
            yield {"tires": variant, "figure": name, "beds": len(beds), **row}


def main():
    parser = driver.options(
        __doc__, wheels={"action": "store_true", "help": "figures of every wheel, and of the axles against the front"},
        results={"type": pathlib.Path, "help": "folder of the cases; default: results/studies/NAME_OF_THE_STUDY"})
    parser.add_argument("study", type=pathlib.Path, nargs="?", default=STUDY, help="study file whose runs are finished")
    arguments = parser.parse_args()
    study = arguments.study
    folders = driver.finished_runs(arguments.results or driver.RESULTS / study.stem,
                                   json.loads(study.read_text())["cases"])
    runs = {case: Run(folder) for case, folder in folders.items()}
    origin = provenance.origin_of_runs(folders.values())
    origin["command"] = " ".join([pathlib.Path(__file__).name, *([study.name] if study.stem != STUDY.stem else []),
                                  *(["--wheels"] if arguments.wheels else [])])
    driver.write(f"{study.stem}_wheels.csv", [{"case": case, "wheel": wheel, **means} for case, run in runs.items()
                                              for wheel, means in zip(run.wheels, run.means)], origin)
    driver.write(f"{study.stem}_figures.csv", list(figures_of_beds(runs, arguments.wheels)), origin, told=True,
                 names=["tires", "figure", "beds", "mean", "half_95", "change", "change_half_95"])


if __name__ == "__main__":
    main()
