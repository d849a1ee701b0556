#!/usr/bin/python3
"""The planar tire of `furrow run` as its source has it: the penalty contact, the elastic disc, and Runge and Kutta's
method. Writes planar_paper.csv beside this script.

usage: planar_paper.py [curb] [car]

curb  rigs/curb.json beside the standalone wheel with the same masses (tests/tire/verification/planar_curb.csv). The
      elastic disc has half of the mass of 150 kg, and the viscosity that a moving rim needs
      (scripts/docs/tire_models.md); the rim has the other half. off_the_standalone is the rms difference of the
      centre's height from 1.2 m before the edge to 2 m behind it, over the curb's height.
car   the HMMWV on the planar tires of cleat_roll.py, let down on level ground, driven off at 1 s, coasting from
      2.5 s: means over the last second beside the weight of vehicle and tires, and the front axle's load at rest.
"""
import json

import numpy as np

import driver
import provenance
from cleat_roll import PLANAR
from driver import ROOT, read_json

RESULTS = driver.RESULTS / "planar_paper"
GRAVITY = 9.80665
MODULUS = 1.098e6  # Pa, cleat_roll_figures.csv
SPLIT = {"disc_in_run": "elastic",
         "disc": {"density": 370, "young_modulus": 1e8, "poisson_ratio": 0.3, "viscosity": 1000},
         "rim": {"mass": 75, "spin_inertia": 2.42, "diametral_inertia": 1.21, "carrier_mass": 1350}}
CURB = {"terrain": {}, "penalty": {"contact_law": "penalty"},
        "penalty, Runge-Kutta": {"contact_law": "penalty", "integrator": "runge_kutta_4"},
        "penalty, elastic disc": {"contact_law": "penalty", **SPLIT}}
CAR = {"terrain": {}, "penalty": {"contact_law": "penalty"}}


def tire_file(name, tire, changes):
    RESULTS.mkdir(parents=True, exist_ok=True)
    file = RESULTS / f"tire_{name}.json"
    file.write_text(json.dumps(tire | changes), encoding="utf-8")
    return str(file)


def curb(name, changes):
    file = tire_file(f"curb_{name}", read_json(ROOT / "tire" / "data" / "aligator_planar.json"), changes)
    scenario = read_json(ROOT / "rigs" / "curb.json")
    scenario["tire"] = {"file": file}
    scenario["output"]["frame_interval"] = 0
    if "disc" in changes:
        scenario["run"]["step"] = 2e-5
    return driver.kept(RESULTS / f"curb_{name}", "run", scenario=scenario), scenario


def curb_rows():
    table = provenance.read_table(ROOT / "tests" / "tire" / "verification" / "planar_curb.csv")
    alone = {name: np.array([float(row[name]) for row in table]) for name in table[0]}
    load = (1290.0 + 210.0) * GRAVITY

    def figures(x, axle, force):
        after, beyond = x > -1.2, x > 0.0
        return {"highest_m": np.max(axle[after]), "over_the_edge_m": np.interp(0.0, x, axle),
                "least_force_of_load": np.min(force[beyond]) / load,
                "largest_force_of_load": np.max(force[after]) / load}
    near = (alone["centre_x_m"] > -1.2) & (alone["centre_x_m"] < 2.0)
    places = alone["centre_x_m"][near]
    yield {"case": "curb", "contact": "standalone", **figures(alone["centre_x_m"], alone["axle_m"],
                                                              alone["ground_force_N"])}
    for name, changes in CURB.items():
        folder, scenario = curb(name, changes)
        line, end = driver.series(folder), driver.summary(folder)
        x = line["position_m"] - scenario["terrain"]["profile"][1][0]
        axle = line["axle_height_m"] - line["axle_height_m"][np.searchsorted(x, -1.2)]
        off = np.interp(places, x, axle) - alone["axle_m"][near]
        yield {"case": "curb", "contact": name, **figures(x, axle, line["force_z_N"]),
               "off_the_standalone": float(np.sqrt(np.mean(off ** 2)) / scenario["terrain"]["profile"][1][1]),
               "energy_residual_of_turnover": end["accounts"]["energy"]["residual"] /
               end["accounts"]["energy"]["turnover"]}


def car(name, changes):
    tire = PLANAR | {"tire": PLANAR["tire"] | {"young_modulus": MODULUS}} | changes
    scenario = {
        "format_version": 1,
        "rig": {"type": "vehicle", "vehicle": "hmmwv.json", "driver": {"inputs": {
            "throttle": [[0, 0], [1.0, 0], [1.2, 0.4], [2.4, 0.4], [2.5, 0]],
            "brake": [[0, 1], [1.0, 1], [1.1, 0]]}}},
        "tire": {"file": tire_file(f"car_{name}", tire, {})},
        "terrain": {"engine": "rigid", "friction": 0.9, "friction_velocity_scale": 20, "ground_damping": 2e4},
        "run": {"step": 1e-4 if changes else 2e-5, "end": 4.0, "average_from": 3.0, "seed": 1},
        "output": {"series_interval": 2e-3, "frame_interval": 0},
    }
    return driver.kept(RESULTS / f"car_{name}", "run", scenario=scenario)


def car_row(name, changes):
    folder = car(name, changes)
    end, line = driver.summary(folder), driver.series(folder, "vehicle")
    wheels = [driver.series(folder, f"wheel{k}") for k in range(4)]
    last = wheels[0]["time_s"] > 3.0
    loads, sides = ([float(wheel[column][last].mean()) for wheel in wheels] for column in ("force_z_N", "force_y_N"))
    energy = end["accounts"]["energy"]
    return {"case": "car", "contact": name, "weight_N": end["vehicle"]["mass_kg"] * GRAVITY, "load_N": sum(loads),
            "front_N": loads[0] + loads[1],
            "front_at_rest_N": sum(wheel["vertical_load_N"] for wheel in end["wheels"][:2]),
            "acceleration_m_s2": float(line["acceleration_m_per_s2"][line["time_s"] > 3.0].mean()),
            "side_force_N": sum(sides), "off_its_line_m": float(line["y_m"][-1] - line["y_m"][0]),
            "energy_residual_of_turnover": energy["residual"] / energy["turnover"]}


def main():
    parser = driver.options(__doc__)
    parser.add_argument("parts", nargs="*", default=["curb", "car"])
    parts, made = parser.parse_args().parts, provenance.made_here()
    rows = list(curb_rows()) if "curb" in parts else []
    rows += [car_row(name, changes) for name, changes in CAR.items()] if "car" in parts else []
    driver.write("planar_paper.csv", rows, made, 5, told=True)


if __name__ == "__main__":
    main()
