#!/usr/bin/python3
"""The HMMWV at full size across the soil: tables and a picture of the runs of vehicle_straight.json or of another
study, whose name then stands in the names of the files.

    /usr/bin/python3 tests/studies/run_study.py tests/studies/vehicle_straight.json
    /usr/bin/python3 tests/studies/vehicle_straight.py [--study report_vehicle] [CASE]

Writes beside this script, from the series and the summary of every finished case alone; of one CASE, whose name then
stands in the names of the files:
  vehicle_straight_events.csv  what happened and when, with the threshold that decides it, as `furrow events`
  vehicle_straight_axles.csv   the axles beside each other over a stretch that is steady enough
  vehicle_straight_gear.csv    the balance of a change of gear
  vehicle_straight_nodes.csv   per rank: threads, unknowns, and the time that it computes, exchanges and waits
  vehicle_straight_series.csv  means of 20 ms of what the figures show, of axles and of the left wheels
  vehicle_straight.png         speeds, pitch, height, engine and gear, forces, sinkages (of the first case)
"""
import json
import pathlib

import numpy as np

import driver
import provenance
from furrow.plot import axles, events, gear_balance
from furrow.plot.run_data import Run
from furrow.plot.vehicle_run import VehicleRun, running_mean

INTERVAL = 0.02  # s, of the thinned series
# column of the vehicle's table: name and factor here
VEHICLE = {"x_m": ("x_m", 1.0), "z_m": ("height_mm", 1e3), "speed_m_s": ("speed_m_s", 1.0),
           "pitch_rad": ("pitch_deg", 180.0 / np.pi), "throttle": ("throttle", 1.0), "gear": ("gear", 1.0),
           "engine_speed_rpm": ("engine_rpm", 1.0), "power_W": ("power_kW", 1e-3)}
# column of the wheels' tables: name here, factor, whether an axle has the sum of its wheels
AXLE = {"spin_rad_per_s": ("spin_rad_s", 1.0, False), "iso_force_x_N": ("force_x_N", 1.0, True),
        "iso_force_z_N": ("force_z_N", 1.0, True), "terrain_resistance_N": ("resistance_N", 1.0, True),
        "spindle_torque_Nm": ("torque_Nm", 1.0, True), "sinkage_m": ("sinkage_mm", 1e3, False),
        "sinkage_in_rut_m": ("sinkage_in_rut_mm", 1e3, False)}
# column of the tables of the left wheels: name here
LEFT = {"iso_force_z_N": "force_z_N", "terrain_resistance_N": "resistance_N", "iso_force_x_N": "force_x_N"}
STEPPED = ("gear", "throttle")  # not to be averaged
GEAR = {"shift_wheel_speed_m_s": "shift_speed", "limit_over_weight": "limit", "throttle": "throttle",
        "largest_wheel_speed_m_s": "reached", "at_s": "time", "gross_traction_over_weight": "gross",
        "torque_over_radius_and_weight": "torque"}


def finite(value):
    return float(value) if np.isfinite(value) else None


def series_rows(v):
    """Every INTERVAL s: means over as long."""
    at = np.arange(0.0, v.time[-1], INTERVAL)
    found = {"time_s": at}
    for column, (name, factor) in VEHICLE.items():
        values = v[column] if column in STEPPED else running_mean(v.time, v[column], INTERVAL)
        found[name] = factor * values[np.searchsorted(v.time, at)]
    for axle in v.order:
        for column, (name, factor, total) in AXLE.items():
            values = running_mean(v.time, axles.axle_series(v, axle, column, total), INTERVAL)
            found[f"{v.axles[axle]}_{name}"] = factor * values[np.searchsorted(v.time, at)]
        for column, name in LEFT.items():
            values = running_mean(v.time, v.of_axle(axle)[0][column], INTERVAL)
            found[f"{v.axles[axle]}_left_{name}"] = values[np.searchsorted(v.time, at)]
    return [{name: finite(values[k]) for name, values in found.items()} for k in range(len(at))]


def axle_rows(v):
    compared = axles.compare(v)
    for row in compared.rows:
        line = {"from_s": finite(compared.begin), "to_s": finite(compared.end), "steady": not compared.unsteady,
                "quantity": row.what, "unit": row.unit}
        for name, one in zip(compared.names, row.axles):
            line |= {name: finite(one.mean), f"{name}_sem": finite(one.sem), f"{name}_n_eff": finite(one.n_eff)}
        for name, one in zip(compared.names[1:], row.differences):
            line |= {f"{name}_less_the_one_before": finite(one.mean), f"{name}_less_sem": finite(one.sem)}
        yield line


def gear_row(v):
    balance = gear_balance.balance(v)
    return {name: finite(getattr(balance, key)) for name, key in GEAR.items()} | {"changed": balance.changed}


def node_rows(summary):
    for rank in summary["ranks"]:
        times = {key: rank[key] for key in ("compute_s", "communicate_s", "wait_s")}
        yield {**{key: rank[key] for key in ("node", "kind", "threads")}, "unknowns_or_grains": rank["size"],
               **{key: float(rank[key]) for key in ("step_s", "cpu_s", *times)},
               "busy_share": times["compute_s"] / sum(times.values())}


def event_rows(v):
    return [{"time_s": f"{e.time:.3f}", "event": e.what, "of": e.subject, "value": finite(float(e.value)),
             "unit": e.unit, "threshold": e.threshold} for e in events.events(v)]


def picture(v, name):
    figure, grid = driver.subplots(3, 2, figsize=(12, 11), sharex=True)
    (speed, pitch), (height, engine), (force, sinkage) = grid
    for axle, colour in zip(v.order, ("tab:blue", "tab:orange", "tab:green")):
        of, wheels, look = v.axles[axle], v.of_axle(axle), {"color": colour}
        below, dashed = v.order[-1] == axle, {"ls": "--", "lw": 1}
        speed.plot(v.time, running_mean(v.time, sum(w["spin_rad_per_s"] * w.radius for w in wheels) / len(wheels)),
                   lw=1, label=f"ω R, {of}", **look)
        for column, factor, what, more in (
                ("iso_force_x_N", 1e-3, f"net force, {of}", {}),
                ("terrain_resistance_N", -1e-3, f"resistance, {of}, drawn downward", dashed)):
            force.plot(v.time, factor * running_mean(v.time, axles.axle_series(v, axle, column, True), 0.1),
                       label=what, **look, **more)
        sinkage.plot(v.time, 1e3 * axles.axle_series(v, axle, "sinkage_m", False), **look,
                     label=f"{of}, below the undisturbed surface")
        if below:
            sinkage.plot(v.time, 1e3 * axles.axle_series(v, axle, "sinkage_in_rut_m", False), **look, **dashed,
                         label=f"{of}, below the rut before it")
    speed.plot(v.time, v["speed_m_s"], color="black", lw=1.6, label="vehicle")
    pitch.plot(v.time, np.degrees(v["pitch_rad"]), color="black")
    height.plot(v.time, 1e3 * (v["z_m"] - v.wheels[0].surface), color="black")
    engine.plot(v.time, v["engine_speed_rpm"], color="tab:purple", label="engine")
    engine.plot(v.time, v["turbine_speed_rpm"], color="tab:orange", label="turbine")
    gear = engine.twinx()
    gear.step(v.time, v["gear"], color="tab:green", where="post")
    gear.set_ylim(0, 4)
    gear.set_ylabel("gear", color="tab:green")
    sinkage.set_ylim(bottom=-20)
    for axis, title, unit in ((speed, "Speed", "m/s"), (pitch, "Pitch, nose down positive", "°"),
                              (height, "Height of the origin above the soil", "mm"),
                              (engine, "Engine, converter's turbine and gear", "1/min"),
                              (force, "Longitudinal forces by axle (mean of 0.1 s)", "kN"), (sinkage, "Sinkage", "mm")):
        driver.label(axis, "time, s" if axis in grid[-1] else "", unit, title)
        axis.grid(alpha=0.3)
    figure.tight_layout()
    driver.save(figure, name, 80)


def main():
    parser = driver.options(__doc__, results={"type": pathlib.Path}, study={"default": "vehicle_straight"})
    parser.add_argument("case", nargs="?", help="the only case of the tables; all by default")
    arguments = parser.parse_args()
    cases = json.loads((driver.HERE / f"{arguments.study}.json").read_text())["cases"]
    only = [arguments.case] if arguments.case else []
    stem = "_".join([arguments.study, *only])
    folders = driver.finished_runs(arguments.results or driver.RESULTS / arguments.study, only or cases)
    origin = provenance.origin_of_runs(folders.values())
    tables = {"events": [], "axles": [], "gear": [], "nodes": [], "series": []}
    for case, folder in folders.items():
        v = VehicleRun(Run(folder))
        found = {"events": event_rows(v), "axles": axle_rows(v), "gear": [gear_row(v)],
                 "nodes": node_rows(driver.summary(folder)), "series": series_rows(v)}
        for name, rows in found.items():
            tables[name] += [{"case": case, **row} for row in rows]
        if folder == next(iter(folders.values())):
            picture(v, stem)
    for name, rows in tables.items():
        driver.write(f"{stem}_{name}.csv", rows, origin)


if __name__ == "__main__":
    main()
