#!/usr/bin/python3
"""What the HMMWV does on hard ground, from the runs of vehicle_hard_ground.json, beside what its engine map, its gears
and the ground's friction alone give. Writes vehicle_hard_ground_figures.csv.

    /usr/bin/python3 tests/studies/run_study.py tests/studies/vehicle_hard_ground.json
    /usr/bin/python3 tests/studies/vehicle_hard_ground.py

Expected, each from the vehicle's file and as little as possible of the run:
  top speed     engine T_e(u) = converter T_i = (u/K(R))², T_t = T(R) T_i = i F r, v = R u i r: u speed of the crank, R
                of the turbine over it, i speed of the wheels over the turbine's in the highest gear, r rolling radius,
                F what rolling takes, not below 0, both of the run. `speed at the end` likewise, F the force that the
                wheels gave then
  braking       v²/(2 μ g) from the speed at which the pedal is touched
  energy        none of the residual: every entry comes from its own mechanism, none is a difference; sums since the
                start
  cornering     L/tan δ to the middle of the rear axle, cot δ the mean of the steered wheels' cotangents; the understeer
                gradient is the slope of δ − L/R against v²/R
"""
import json
import math
import pathlib

import numpy as np

import driver
import provenance
from driver import ROOT, read_json, series
from furrow.plot.gear_balance import Driveline

STUDY = pathlib.Path(__file__).with_suffix(".json")
RPM = math.pi / 30.0
GRAVITY = 9.80665
STANDS = 0.1  # m/s
LAST = 1.0  # s over which the top speed is a mean


class Runs:
    """The finished cases of the study."""

    def __init__(self, results):
        self.folders = driver.finished_runs(results, json.loads(STUDY.read_text())["cases"])
        self.rows = []

    def add(self, case, quantity, value, expected, unit, how):
        value, expected = (None if one is None or not math.isfinite(one) else float(one) for one in (value, expected))
        self.rows.append({"case": case, "quantity": quantity, "value": value, "expected": expected, "unit": unit,
                          "how": how})


def reached(time, values, level):
    """When a rising series first reaches a level; None if it never does."""
    found = np.flatnonzero(values >= level)
    if not len(found):
        return None
    k = found[0]
    return float(time[0]) if k == 0 else float(np.interp(level, values[k - 1:k + 1], time[k - 1:k + 1]))


def top_speed(line, force, radius):
    """At full throttle in the highest gear against a force, m/s."""
    gears = line["gearbox"]["ratios"][-1] * line["gears"][1]["ratio"]
    driveline = Driveline(line["engine"], line["converter"], gears, 0.0)
    low, high = 1.0, 2700.0 * RPM * gears  # of the wheels, rad/s; the torque on them falls with it
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if driveline.wheel_torque(middle, 1.0) > force * radius else (low, middle)
    return low * radius


def acceleration(runs, line):
    folder = runs.folders.get("acceleration")
    if not folder:
        return
    v, wheels = series(folder, "vehicle"), [series(folder, f"wheel{k}") for k in range(4)]
    time, speed = v["time_s"], v["speed_m_s"]
    begin = reached(time, v["throttle"], 0.01)
    for level in (10.0, 20.0):
        at = reached(time, speed, level)
        runs.add("acceleration", f"time to {level:g} m/s", None if at is None else at - begin, None, "s",
                 "from the first throttle" + ("" if at else "; not reached"))
    for k in np.flatnonzero(np.diff(v["gear"]) > 0) + 1:
        name = f"gear {v['gear'][k - 1]:.0f} to {v['gear'][k]:.0f}"
        runs.add("acceleration", f"{name}, time", time[k] - begin, None, "s", "column gear")
        runs.add("acceleration", f"{name}, speed", speed[k], None, "m/s", "column gear")
        runs.add("acceleration", f"{name}, turbine", v["turbine_speed_rpm"][k - 1],
                 line["gearbox"]["up_rpm"], "1/min", "gearbox.up_rpm")
    last = time > time[-1] - LAST
    force = np.mean(v["soil_power_W"][last]) / np.mean(speed[last])
    radius = np.mean([np.mean(w["speed_m_per_s"][last]) / np.mean(w["spin_rad_per_s"][last]) for w in wheels])
    given = np.mean(v["wheel_power_W"][last]) / np.mean(speed[last])
    runs.add("acceleration", "rolling loss at the end", force, None, "N",
             "soil_power_W over speed; below 0: late forces drive, see the energy")
    runs.add("acceleration", "acceleration at the end", np.mean(v["acceleration_m_per_s2"][last]),
             0.0, "m/s2", "0 at top speed")
    runs.add("acceleration", "speed at the end", np.mean(speed[last]),
             top_speed(line, given, radius), "m/s", "map, converter, gears, wheel_power_W")
    runs.add("acceleration", "top speed", np.mean(speed[last]), top_speed(line, max(force, 0.0), radius),
             "m/s", "map, converter, gears, rolling loss")


def braking(runs):
    folder = runs.folders.get("braking_from_15")
    if not folder:
        return
    v = series(folder, "vehicle")
    friction = json.loads((folder / "scenario.json").read_text())["terrain"]["friction"]
    begin = reached(v["time_s"], v["brake"], 0.01)
    start, speed = (float(np.interp(begin, v["time_s"], v[name])) for name in ("distance_m", "speed_m_s"))
    after = np.flatnonzero((v["time_s"] > begin) & (v["speed_m_s"] < STANDS))
    if not len(after):
        runs.add("braking_from_15", "distance", None, speed ** 2 / (2.0 * friction * GRAVITY), "m", "did not stop")
        return
    end = after[0]
    runs.add("braking_from_15", "speed", speed, 15.0, "m/s", "when the pedal is touched")
    runs.add("braking_from_15", "distance", v["distance_m"][end] - start,
             speed ** 2 / (2.0 * friction * GRAVITY), "m", "v2/(2 mu g)")
    runs.add("braking_from_15", "deceleration", speed / (v["time_s"][end] - begin), friction * GRAVITY, "m/s2", "mu g")


def energy(runs):
    """Where the energy of whole runs went, each entry on its own; what the accounts leave over."""
    for case in ("acceleration", "braking_from_15", "flexible_tires"):
        if case not in runs.folders:
            continue
        summary = driver.summary(runs.folders[case])
        vehicle, accounts = summary["vehicle"]["energy_J"], summary["accounts"]["energy"]
        lost, stored = accounts["lost"], accounts["stored"]
        entries = {
            "work of the engine": accounts["work"]["drive_work"],
            "gained: vehicle, motion and height": stored["rig_kinetic_and_potential"],
            "gained: tires": sum(stored[name] for name in stored if name.startswith("tire_")),
            "gained: springs of the ground": sum(stored[name] for name in stored if name.startswith("terrain_")),
            **{f"lost: {name}": vehicle[name]
               for name in ("converter", "clutch", "shift", "brake", "shock", "lowering")},
            "lost: tires, viscous": lost["tire_viscous_loss"], "lost: sliding": lost["sliding_loss"],
            "lost: dampers of the ground":
                lost["normal_damping_loss"] + lost["tangential_damping_loss"] + lost["opening_loss"],
            "lost: numerical, of tires": lost["tire_numerical_loss"] + lost["tire_solver_loss"],
            "lost: numerical, one step late": lost["surface_lag_loss"] + lost["rim_lag_loss"]}
        for name, value in entries.items():
            runs.add(case, name, value, None, "J", "accounts")
        runs.add(case, "residual", accounts["residual"], 0.0, "J",
                 f"{100.0 * accounts['residual_share']:.2g} % of the turnover")


def wheelbase(vehicle):
    front, rear = (axle["origin"][0] + axle["suspension"]["spindle"]["center"][0] for axle in vehicle["axles"])
    return front - rear


def cornering(runs, base):
    lateral, excess = [], []
    for case, folder in runs.folders.items():
        if not case.startswith("cornering_"):
            continue
        v, steered = series(folder, "vehicle"), [series(folder, f"wheel{k}") for k in (0, 1)]
        late = v["time_s"] > json.loads((folder / "scenario.json").read_text())["run"]["average_from"]
        speed, turning = np.mean(v["speed_m_s"][late]), np.mean(v["yaw_rate_rad_per_s"][late])
        angle = math.atan(1.0 / np.mean([1.0 / math.tan(np.mean(w["wheel_steer_rad"][late])) for w in steered]))
        radius = speed / turning
        lateral.append(speed * turning)
        excess.append(angle - base / radius)
        runs.add(case, "radius", radius, base / math.tan(angle), "m", "L/tan delta, without slip angles")
        runs.add(case, "steer angle", math.degrees(angle), None, "degrees", "of the axle's middle")
        runs.add(case, "lateral acceleration", lateral[-1], None, "m/s2", "speed times yaw rate")
    if len(lateral) > 1:
        slope = np.polyfit(lateral, excess, 1)[0]
        runs.add("cornering", "understeer gradient", math.degrees(slope) * GRAVITY,
                 None, "degrees per g", f"line through {len(lateral)} speeds")


def main():
    parser = driver.options(__doc__, results={"type": pathlib.Path, "default": driver.RESULTS / STUDY.stem})
    runs, vehicle = Runs(parser.parse_args().results), read_json(ROOT / "vehicle" / "data" / "hmmwv.json")
    acceleration(runs, vehicle["driveline"])
    braking(runs)
    energy(runs)
    cornering(runs, wheelbase(vehicle))
    driver.write("vehicle_hard_ground_figures.csv", runs.rows, provenance.origin_of_runs(runs.folders.values()),
                 told=True)


if __name__ == "__main__":
    main()
