#!/usr/bin/python3
"""Results of any content before the plots: summaries, scenarios, series, frames and height fields whose values are of
other types and shapes than a run's. Each ends in plots or in words, never in a traceback.

usage: report.py [--cases N] [--seed S] [--seconds T] [--only CASE]

Case k of a seed is always the same. Plots are drawn, but not saved.
"""
import argparse
import contextlib
import copy
import io
import json
import pathlib
import random
import sys
import tempfile
import time
import traceback
import warnings

import h5py
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "python"))

from furrow import events, report  # noqa: E402

ODD = [None, True, False, 0, -1, 3, 1e308, -1e-320, 10 ** 400, float("nan"), float("inf"), "", "x", "\x1b[31m",
       "ü" * 50, [], [1], [[]], {}, {"a": 1}, ["x"], [None], [{}]]
SUMMARY = {
    "format_version": 1, "scenario": "small", "terrain_engine": "dem",
    "law": "mindlin", "slip": 0.3, "vertical_load_N": 4600.0,
    "drawbar_pull_N": {"mean": 100.0, "sem": 5.0, "from_s": 0.02, "to_s": 0.05,
                       "steady": False, "unsteady_because": ["short"]},
    "net_terrain_force_N": [100.0, 0.0, 4600.0], "surface_height_m": 0.1,
    "rut_depth_m": 0.01, "rut_width_m": 0.2, "tread_width_m": 0.2,
    "sinkage_m": 0.01, "grains": 100, "drawbar_coefficient": 0.02,
    "accounts": {"energy": {"work": {"drive_work": 100.0, "tow_work": -50.0}, "stored": {"tire_elastic": 5.0},
                            "lost": {"sliding_loss": 44.0}, "residual": 1.0,
                            "residual_share": 0.01, "turnover": 99.0, "closes": True},
                 "momentum": {"grains": [0.0, 0.0, 1.0], "gravity": [0.0, 0.0, -5.0], "walls": [0.0, 0.0, 6.0],
                              "residual": [0.0, 0.0, 0.0], "residual_share": 0.0, "largest": 6.0, "closes": True}},
    "ranks": [{"node": "rig", "busy_share": 0.1, "busy_s": 1.0, "wait_s": 2.0, "wall_s": 3.0}],
    "wheels": [{"slip": 0.3}],
}
SCENARIO = {"rig": {"travel_sign": 1, "wheels": [{"lateral": 0.0}]}, "tire": {"file": "x.json"},
            "terrain": {}, "run": {}}
COLUMNS = ["time_s", "drawbar_pull_N", "drawbar_pull_raw_N", "slip", "sinkage_m", "force_z_N", "force_x_N", "force_y_N",
           "position_m", "drive_torque_Nm", "spindle_work_J", "pull_work_J"]
SOIL = {"format_version": 1, "scenario": "small", "quick": True, "grains": {"radius_m": 0.006, "cohesion_Pa": 0.0},
        "n": 1.0, "k_c": 1.0,
        "k_phi": 1.0, "cohesion_Pa": 1.0, "friction_angle_deg": 30.0, "janosi_K_m": 0.01, "standard_error": {"n": 0.1}}
PRESS = {"scenario": "small", "tire": "x", "obstacle": "plate", "deflection_m": 0.01, "load_N": 1e3,
         "secant_stiffness_N_per_m": 1e5, "sticking_stiffness": {"lateral_N_per_m": 1e5},
         "footprint": {"force_N": 1e3, "length_m": 0.1, "width_m": 0.1, "mean_pressure_Pa": 1e5}}
MODES = {"tire": "x", "details": "y", "pressure_Pa": 1e5, "mass_kg": 10.0, "stable": True}
SHAPES = [f"{name}{part}" for name in ("tangential", "axial", "radial") for part in ("", "_imaginary")]
TESTS = [  # the file of a virtual test, its contents, and its tables
    ("soil.json", SOIL, {"plate.csv": ["seed", "width_m", "sinkage_m", "pressure_Pa"],
                         "cone.csv": ["seed", "depth_m", "force_N"]}),
    ("summary.json", PRESS, {"press.csv": ["deflection_m", "force_N", "unloading"],
                             "footprint.csv": ["x_m", "y_m", "pressure_Pa"]}),
    ("summary.json", MODES, {"modes.csv": ["order", "number", "frequency_Hz"],
                             "section.csv": ["y_m", "radius_m", "y_to_m", "radius_to_m", "from", "to"],
                             "shapes.csv": ["order", "number", "node", "y_m", "radius_m", *SHAPES]}),
]
KINEMATICS = {"vehicle": "car", "at_rest": {"wheels": [{"name": "front left", "travel_m": 0.01}]}}


VEHICLE_SCENARIO = {"rig": {"type": "vehicle", "vehicle": "hmmwv.json",
                            "lateral": 0.0, "driver": {"path": {"steering": {"law": "stanley"}}}},
                    "run": {"end": 0.2, "average_from": 0.02}, "terrain": {"engine": "dem"}}
VEHICLE_SUMMARY = {"scenario": "car", "terrain_engine": "dem", "law": "mindlin", "grains": 100,
                   "wheels": [{"vertical_load_N": 1.0, "lateral_m": 0.5 - k % 2, "tire_coordinates": 10}
                              for k in range(4)],
                   "ranks": [{"rank": 1, "node": "tire 0", "kind": "ancf",
                              "threads": 1, "cpu_s": 1.0, "compute_s": 1.0, "wait_s": 0.1}]}
VEHICLE = ["time_s", "x_m", "y_m", "z_m", "roll_rad", "pitch_rad", "yaw_rad", "distance_m", "speed_m_s", "throttle",
           "brake", "steering", "gear", "shifting", "engine_speed_rpm", "turbine_speed_rpm", "power_W", "wheel_power_W",
           "soil_power_W", "target_speed_m_per_s", "path_distance_m", "cross_track_error_m", "heading_error_rad",
           "drive_work_J"]
VEHICLE_WHEEL = ["time_s", "slip", "sinkage_m", "sinkage_in_rut_m", "force_z_N", "iso_force_x_N", "iso_force_y_N",
                 "iso_force_z_N", "tractive_effort_N", "terrain_resistance_N", "spindle_torque_Nm", "speed_m_per_s",
                 "spin_rad_per_s", "position_m", "axle_height_m", "lowest_point_m", "sinkage_kinematic_m",
                 "suspension_travel_m"]


def places(value, path=()):
    """Of everything within a document."""
    yield path
    for key, inner in value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ():
        yield from places(inner, (*path, key))


def changed(chance, document):
    """With up to three values of other types, or missing."""
    document = copy.deepcopy(document)
    for _ in range(chance.choice([0, 1, 1, 1, 2, 3])):
        path = chance.choice([path for path in places(document) if path] or [()])
        if not path:
            break
        at = document
        for key in path[:-1]:
            at = at[key]
        if isinstance(at, dict) and chance.random() < 0.2:
            del at[path[-1]]
        else:
            at[path[-1]] = copy.deepcopy(chance.choice(ODD))
    return document


def array(chance, shape):
    """Numbers of that shape, or nearly."""
    shape = list(shape)
    if chance.random() < 0.3:
        place = chance.randrange(len(shape))
        shape[place] = chance.choice([0, 1, 2, shape[place] + 1])
    if chance.random() < 0.1:
        shape = shape[1:]
    values = np.random.default_rng(chance.randrange(1 << 30)).random(shape)
    if chance.random() < 0.2 and values.size:
        values.flat[chance.randrange(values.size)] = chance.choice([np.nan, np.inf, -np.inf, 1e300, -1.0])
    with np.errstate(all="ignore"):
        return values.astype(chance.choice(["f8", "f4", "i4", "u1"]) if chance.random() < 0.2 else "f8")


def put(chance, file, name, values):
    if chance.random() < 0.08:
        return
    if chance.random() < 0.05:
        file[name] = h5py.SoftLink("/nowhere")
    elif chance.random() < 0.05:
        file.create_dataset(name, shape=(10 ** 6, 10 ** 6), dtype="f8", chunks=(1, 1024))
    elif chance.random() < 0.05:
        file[name] = [["a", "b"]]
    else:
        file[name] = values


def csv(chance, columns, rows=40):
    lines = [",".join(columns)]
    for k in range(rows):
        lines.append(",".join(f"{0.002 * k if c == 0 else chance.uniform(-1, 1):g}" for c in range(len(columns))))
    if chance.random() < 0.3:
        lines[chance.randrange(len(lines))] = chance.choice(["", ",", "x", "nan,nan", lines[0], "1" * 500,
                                                             lines[-1][:-3]])
    return "\n".join(lines[:chance.choice([len(lines), len(lines), 0, 1, 2])]) + "\n"


def make_grounds(chance, folder, tires):
    with h5py.File(folder / "results.h5", "w") as file:
        for when in ("before", "after"):
            put(chance, file, f"terrain/height_{when}", array(chance, (20, 8)))
            put(chance, file, f"terrain/height_{when}_grid", np.array([0.0, -0.2, 0.05])
                if chance.random() < 0.8 else array(chance, (3,)))
    (folder / "frames").mkdir()
    for k in range(tires):
        with h5py.File(folder / "frames" / f"tire{k}_000000.h5", "w") as file:
            if chance.random() < 0.9:
                file.attrs["time_s"] = chance.choice([0.0, 0.0, 0.0, np.ones(3), "x"])
            put(chance, file, "position", array(chance, (12, 3)))
            put(chance, file, "triangle", np.array([[0, 1, 2], [3, 4, chance.choice([5, 5, 5, 12, -1])]]))
    with h5py.File(folder / "frames" / "terrain_000000.h5", "w") as file:
        put(chance, file, "position", array(chance, (30, 3)))
        put(chance, file, "radius", array(chance, (30,)))


def make_run(chance, folder):
    (folder / "summary.json").write_text(json.dumps(changed(chance, SUMMARY)))
    (folder / "scenario.json").write_text(json.dumps(changed(chance, SCENARIO)))
    columns = [name for name in COLUMNS if chance.random() < 0.95]
    (folder / "timeseries.csv").write_text(csv(chance, columns))
    make_grounds(chance, folder, 1)


def make_vehicle(chance, folder):
    (folder / "summary.json").write_text(json.dumps(changed(chance, VEHICLE_SUMMARY)))
    (folder / "scenario.json").write_text(json.dumps(changed(chance, VEHICLE_SCENARIO)))
    for subject, names in [("vehicle", VEHICLE)] + [(f"wheel{k}", VEHICLE_WHEEL) for k in range(4)]:
        columns = names if chance.random() < 0.9 else [name for name in names if chance.random() < 0.95]
        text = csv(chance, columns, 100)
        (folder / f"timeseries_{subject}.csv").write_text(text if chance.random() < 0.5
                                                          else csv(random.Random(1), columns, 100))
    make_grounds(chance, folder, 4)


def make_test(chance, folder):
    file, document, tables = chance.choice(TESTS)
    (folder / file).write_text(json.dumps(changed(chance, document)))
    for name, columns in tables.items():
        (folder / name).write_text(csv(chance, columns))


def make_kinematics(chance, folder):
    (folder / "summary.json").write_text(json.dumps(changed(chance, KINEMATICS)))
    columns = ["steering", "travel_m", "camber_rad", "toe_rad", "steer_rad", "roll_center_m", "wheel_rate_N_per_m"]
    lines = csv(chance, columns).splitlines()
    motions, sides = ("parallel", "opposite", "steering"), ("left", "right")
    names = ["motion,wheel"] + [f"{chance.choice(motions)},front {chance.choice(sides)}" for _ in lines[1:]]
    (folder / "kinematics.csv").write_text("".join(f"{name},{line}\n" for name, line in zip(names, lines)))


def run_case(seed, k):
    """(exit code, stderr); raises whatever report does not catch."""
    chance = random.Random(f"{seed}:{k}")
    with tempfile.TemporaryDirectory(prefix="furrow report ") as name:
        folder = pathlib.Path(name)
        make = chance.choices([make_run, make_vehicle, make_test, make_kinematics], [8, 3, 3, 1])[0]
        make(chance, folder)
        if chance.random() < 0.05:
            victim = chance.choice([path for path in folder.rglob("*") if path.is_file()])
            victim.write_bytes(victim.read_bytes()[:chance.randrange(2000)])
        sys.argv = ["report.py", str(folder)]
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), warnings.catch_warnings(), \
                np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            code = report.main()
            report.matplotlib.pyplot.close("all")
            if make is make_vehicle:
                told = err.getvalue()
                code_of_events = events.main()
                if code_of_events not in (0, 2, 5) or (code_of_events and err.getvalue() == told):
                    return f"{code_of_events} of events", err.getvalue()
        return code, err.getvalue()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=10000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=float("inf"))
    parser.add_argument("--only", type=int)
    options = parser.parse_args()
    report.matplotlib.figure.Figure.savefig = lambda *unused, **unused_too: None
    begin, findings, done = time.monotonic(), 0, 0
    for k in [options.only] if options.only is not None else range(options.cases):
        if time.monotonic() - begin > options.seconds:
            break
        done += 1
        try:
            code, err = run_case(options.seed, k)
            wrong = f"exit code {code}" if code not in (0, 5) else "silence" if code and not err else \
                "control characters" if "\x1b" in err else None
        except BaseException:  # noqa: B902 - whatever comes through is a finding
            wrong, err = "traceback", traceback.format_exc()[-600:]
        if options.only is not None:
            print(err)
        if wrong:
            findings += 1
            print(f"case {k}: {wrong}: {err[-600:]}", flush=True)
    print(f"{done} cases of seed {options.seed}, {findings} findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
