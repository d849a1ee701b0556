#!/usr/bin/python3
"""The HMMWV at full size across the soil: tables and a picture of the runs of vehicle_straight.json.

    /usr/bin/python3 tests/studies/run_study.py tests/studies/vehicle_straight.json
    /usr/bin/python3 tests/studies/vehicle_straight.py [CASE]

Writes beside this script, from the series and the summary of every finished case alone; of one CASE, whose name then
stands in the names of the files:
  vehicle_straight_events.csv  what happened and when, with the threshold that decides it, as `furrow events`
  vehicle_straight_axles.csv   the axles beside each other over a stretch that is steady enough
  vehicle_straight_gear.csv    the balance of a change of gear
  vehicle_straight_nodes.csv   per rank: threads, unknowns, and the time that it computes, exchanges and waits
  vehicle_straight_series.csv  means of 20 ms of what the figures show
  vehicle_straight.png         speeds, pitch, height, engine and gear, forces, sinkages (of the first case)
"""
import argparse
import json
import pathlib
import sys

import numpy as np

import provenance
from provenance import ROOT, read_json

sys.path.insert(0, str(ROOT / "scripts"))
import matplotlib  # noqa: E402

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from plot import axles, events, gear_balance  # noqa: E402
from plot.run_data import Run  # noqa: E402
from plot.vehicle_run import VehicleRun, running_mean  # noqa: E402

STUDY = pathlib.Path(__file__).with_suffix(".json")
INTERVAL = 0.02  # s, of the thinned series
# column of the vehicle's table: name and factor here
VEHICLE = {"x_m": ("x_m", 1.0), "z_m": ("height_mm", 1e3), "speed_m_s": ("speed_m_s", 1.0),
           "pitch_rad": ("pitch_deg", 180.0 / np.pi),
           "throttle": ("throttle", 1.0), "gear": ("gear", 1.0), "engine_speed_rpm": ("engine_rpm", 1.0),
           "power_W": ("power_kW", 1e-3)}
# column of the wheels' tables: name here, factor, whether an axle has the sum of its wheels
AXLE = {"spin_rad_per_s": ("spin_rad_s", 1.0, False), "iso_force_x_N": ("force_x_N", 1.0, True),
        "iso_force_z_N": ("force_z_N", 1.0, True),
        "terrain_resistance_N": ("resistance_N", 1.0, True), "spindle_torque_Nm": ("torque_Nm", 1.0, True),
        "sinkage_m": ("sinkage_mm", 1e3, False), "sinkage_in_rut_m": ("sinkage_in_rut_mm", 1e3, False)}
STEPPED = ("gear", "throttle")  # not to be averaged


def short(value):
    return f"{value:.4g}" if np.isfinite(value) else ""


def thinned(v):
    """{name: values} every INTERVAL s: means over as long."""
    at = np.arange(0.0, v.time[-1], INTERVAL)
    found = {"time_s": at}
    for column, (name, factor) in VEHICLE.items():
        values = v[column] if column in STEPPED else running_mean(v.time, v[column], INTERVAL)
        found[name] = factor * values[np.searchsorted(v.time, at)]
    for axle in v.order:
        for column, (name, factor, total) in AXLE.items():
            values = running_mean(v.time, axles.axle_series(v, axle, column, total), INTERVAL)
            found[f"{v.axles[axle]}_{name}"] = factor * values[np.searchsorted(v.time, at)]
    return found


def axle_rows(case, v):
    compared = axles.compare(v)
    for row in compared.rows:
        line = {"case": case, "from_s": short(compared.begin), "to_s": short(compared.end),
                "steady": not compared.unsteady,
                "quantity": row.what, "unit": row.unit}
        for name, one in zip(compared.names, row.axles):
            line |= {name: short(one.mean), f"{name}_sem": short(one.sem), f"{name}_n_eff": short(one.n_eff)}
        for name, one in zip(compared.names[1:], row.differences):
            line |= {f"{name}_less_the_one_before": short(one.mean), f"{name}_less_sem": short(one.sem)}
        yield line


def gear_row(case, v):
    b = gear_balance.balance(v)
    return {"case": case, "shift_wheel_speed_m_s": short(b.shift_speed),
            "limit_over_weight": short(b.limit), "throttle": short(b.throttle),
            "largest_wheel_speed_m_s": short(b.reached), "at_s": short(b.time),
            "gross_traction_over_weight": short(b.gross),
            "torque_over_radius_and_weight": short(b.torque), "changed": b.changed}


def node_rows(case, summary):
    for rank in summary["ranks"]:
        times = {key: rank[key] for key in ("compute_s", "communicate_s", "wait_s")}
        yield {"case": case, **{key: rank[key] for key in ("node", "kind", "threads")},
               "unknowns_or_grains": rank["size"],
               "step_s": short(rank["step_s"]), "cpu_s": short(rank["cpu_s"]),
               **{key: short(value) for key, value in times.items()},
               "busy_share": short(times["compute_s"] / sum(times.values()))}


def picture(v, path):
    figure, grid = plt.subplots(3, 2, figsize=(12, 11), sharex=True)
    (speed, pitch), (height, engine), (force, sinkage) = grid
    colours = ("tab:blue", "tab:orange", "tab:green")
    for axle, colour in zip(v.order, colours):
        name, wheels = v.axles[axle], v.of_axle(axle)
        speed.plot(v.time, running_mean(v.time, sum(w["spin_rad_per_s"] * w.radius for w in wheels) / len(wheels)),
                   color=colour, lw=1, label=f"ω R, {name}")
        force.plot(v.time, 1e-3 * running_mean(v.time, axles.axle_series(v, axle, "iso_force_x_N", True), 0.1),
                   color=colour, label=f"net force, {name}")
        force.plot(v.time, -1e-3 * running_mean(v.time, axles.axle_series(v, axle, "terrain_resistance_N", True), 0.1),
                   color=colour, ls="--", lw=1,
                   label=f"resistance, {name}, drawn downward")
        sinkage.plot(v.time, 1e3 * axles.axle_series(v, axle, "sinkage_m", False),
                     color=colour, label=f"{name}, below the undisturbed surface")
    last = v.order[-1]
    sinkage.plot(v.time, 1e3 * axles.axle_series(v, last, "sinkage_in_rut_m", False),
                 color=colours[len(v.order) - 1], ls="--", lw=1,
                 label=f"{v.axles[last]}, below the rut before it")
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
                              (force, "Longitudinal forces by axle (mean of 0.1 s)", "kN"),
                              (sinkage, "Sinkage", "mm")):
        axis.set_title(title, fontsize=10)
        axis.set_ylabel(unit)
        axis.grid(alpha=0.3)
        if axis.get_legend_handles_labels()[0]:
            axis.legend(fontsize=7.5)
    for axis in grid[-1]:
        axis.set_xlabel("time, s")
    figure.tight_layout()
    figure.savefig(path, dpi=80)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--results", type=pathlib.Path, default=ROOT / "results" / "studies" / STUDY.stem,
                        help="folder of the cases")
    cases = list(json.loads(STUDY.read_text())["cases"])
    parser.add_argument("case", nargs="?", choices=cases, help="the only case of the tables; all by default")
    arguments = parser.parse_args()
    stem = f"{STUDY.stem}_{arguments.case}" if arguments.case else STUDY.stem
    folders = [arguments.results / case for case in ([arguments.case] if arguments.case else cases)]
    folders = [folder for folder in folders if (folder / "summary.json").exists()]
    if not folders:
        raise SystemExit(f"{arguments.results}: holds no finished case, expected those of run_study.py {STUDY.name}")
    origin = provenance.origin_of_runs(folders)
    origin["command"] = " ".join([pathlib.Path(__file__).name, *([arguments.case] if arguments.case else [])])
    tables = {"events": [], "axles": [], "gear": [], "nodes": [], "series": []}
    for folder in folders:
        v = VehicleRun(Run(folder))
        tables["events"] += [{"case": folder.name, "time_s": f"{e.time:.3f}",
                              "event": e.what, "of": e.subject, "value": short(float(e.value)),
                              "unit": e.unit, "threshold": e.threshold} for e in events.events(v)]
        tables["axles"] += axle_rows(folder.name, v)
        tables["gear"].append(gear_row(folder.name, v))
        tables["nodes"] += node_rows(folder.name, read_json(folder / "summary.json"))
        series = thinned(v)
        tables["series"] += [{"case": folder.name, **{name: short(values[k]) for name, values in series.items()}}
                             for k in range(len(series["time_s"]))]
        if folder == folders[0]:
            picture(v, STUDY.with_name(f"{stem}.png"))
    for name, rows in tables.items():
        columns = list(dict.fromkeys(key for row in rows for key in row))
        provenance.write_table(STUDY.with_name(f"{stem}_{name}.csv"), columns, rows, origin)


if __name__ == "__main__":
    main()
