#!/usr/bin/python3
"""`furrow events` and `furrow report` on a vehicle's run of known contents: series written here, with events at known
times."""
import json
import pathlib
import sys
import unittest

import h5py
import numpy as np

from program import ROOT, SystemTest, furrow, main, read_json, write_json
from report_page import document

sys.path.insert(0, str(ROOT / "scripts" / "python"))

from furrow.plot.statistics import statistics  # noqa: E402

RADIUS, SURFACE, BASE, TRACK = 0.4673, 0.2, 3.3, 0.91  # m
LOADS = [6250.0, 6250.0, 5870.0, 5870.0]
STEP, END = 0.002, 3.0  # s
TOUCH = [0.1, 0.1, 0.14, 0.14]
MOVE, ACCELERATION, MEETS = 0.5, 1.6, 3.3  # s, m/s²; m until the rear wheels are where the front ones came down
LIFT, SHIFT = (1.5, 1.55), (1.0, 1.4)
DEPTH, RUT = 0.030, 0.018


def series(seed=1, **shape):
    """(vehicle, wheels): columns of the tables."""
    chance = np.random.default_rng(seed)
    time = STEP * np.arange(1, round(END / STEP) + 1)
    t = np.maximum(time - MOVE, 0.0)
    speed, way = shape.get("pace", 2.0) * ACCELERATION * t, shape.get("pace", 2.0) * 0.5 * ACCELERATION * t ** 2
    zero = np.zeros_like(time)
    vehicle = {"time_s": time, "x_m": 2.5 + way, "y_m": zero, "z_m": 0.66 + zero,
               "roll_rad": zero, "pitch_rad": zero.copy(),
               "yaw_rad": zero, "distance_m": way, "speed_m_s": speed, "throttle": np.where(time > MOVE, 0.8, 0.0),
               "brake": np.where(time < 0.4, 1.0, 0.0), "steering": zero, "gear": np.where(time < SHIFT[0], 1.0, 2.0),
               "shifting": np.where((time >= SHIFT[0]) & (time < SHIFT[1]), 1.0, 0.0),
               "engine_speed_rpm": 1000.0 + 100.0 * speed, "power_W": 2e4 + zero, "wheel_power_W": 1e4 + zero,
               "soil_power_W": 5e3 + zero, "drive_work_J": 2e4 * time, "converter_heat_J": 1e3 * time}
    # The rear tires meet the ruts: the nose rises by 0.02 rad.
    meets = time[np.searchsorted(way, MEETS)] if way[-1] > MEETS else np.inf
    vehicle["pitch_rad"] = np.where(time > meets, -0.02, 0.0) + 1e-4 * chance.normal(size=len(time))
    wheels = []
    for k, (load, touch) in enumerate(zip(LOADS, TOUCH)):
        rear = k >= 2
        on = time >= touch
        vertical = np.where(on, load, 0.0)
        if k == 1:
            vertical[(time >= LIFT[0]) & (time < LIFT[1])] = 0.0
        sinkage = np.where(on, DEPTH, -0.05)
        in_rut = sinkage - np.where(rear & (time > meets), RUT, 0.0)
        net = np.where(time > MOVE, (1200.0 if rear else 1000.0) + shape.get("drift", 0.0) * time, 0.0)
        net = net + 30.0 * chance.normal(size=len(time))
        height = SURFACE - sinkage + RADIUS
        locked = rear & (time > shape.get("locks", np.inf))
        slip = np.where(locked, -1e6, np.where(time > MOVE, 0.2, 0.0))  # as the rig limits it
        wheels.append({"time_s": time, "slip": slip, "sinkage_m": sinkage, "sinkage_in_rut_m": in_rut,
                       "force_z_N": vertical, "iso_force_x_N": net, "iso_force_y_N": zero, "iso_force_z_N": vertical,
                       "tractive_effort_N": net + (700.0 if rear else 900.0),
                       "terrain_resistance_N": (700.0 if rear else 900.0) + zero, "spindle_torque_Nm": (net + 900.0)
                       * RADIUS, "speed_m_per_s": speed, "spin_rad_per_s": np.where(locked, 0.0, 1.25 * speed / RADIUS),
                       "position_m": 2.5 + (-BASE / 2 if rear else BASE / 2) + way, "axle_height_m": height,
                       "lowest_point_m": SURFACE - sinkage, "sinkage_kinematic_m": SURFACE - (height - RADIUS),
                       "suspension_travel_m": zero, "brake_torque_Nm": zero})
        if shape.get("dead_front") and not rear:
            wheels[-1].update(spin_rad_per_s=0.1 + zero, spindle_torque_Nm=zero - 3.0, brake_torque_Nm=zero - 3.0)
    return vehicle, wheels


def write_table(path, columns):
    np.savetxt(path, np.column_stack(list(columns.values())), delimiter=",",
               header=",".join(columns), comments="", fmt="%.9g")


def write_run(folder, **shape):
    folder.mkdir()
    vehicle, wheels = series(**shape)
    write_table(folder / "timeseries_vehicle.csv", vehicle)
    for k, wheel in enumerate(wheels):
        write_table(folder / f"timeseries_wheel{k}.csv", wheel)
    write_json(folder / "scenario.json", {
        "rig": {"type": "vehicle", "vehicle": shape.get("vehicle", "hmmwv.json"), "lateral": 0.0},
        "run": {"end": shape.get("end", END), "average_from": 1.0},
        "terrain": {"engine": "dem"}})
    write_json(folder / "summary.json", {"scenario": "made", "terrain_engine": "dem", "law": "mindlin", "grains": 3000,
                                         "ranks": [{"rank": 0, "node": "rig", "kind": "vehicle", "threads": 1,
                                                    "cpu_s": 1.0, "compute_s": 1.0, "wait_s": 2.0}],
                                         "wheels": [{"vertical_load_N": load, "net_terrain_force_N": [0.0, 0.0, load],
                                                     "lateral_m": TRACK * (-1) ** k} for k, load in enumerate(LOADS)]})
    return vehicle, wheels


def write_frames(folder, vehicle, wheels):
    """First and last instant: drums, and grains whose ruts are as deep as the wheels have sunk."""
    (folder / "frames").mkdir()
    angle = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    x, y = (value.ravel() for value in np.meshgrid(np.arange(0.0, 10.0, 0.08),
                                                   np.arange(-1.4, 1.4, 0.08), indexing="ij"))
    for index, line in ((0, 0), (1, -1)):
        with h5py.File(folder / "frames" / f"terrain_{index:06d}.h5", "w") as file:
            rut = (np.abs(np.abs(y) - TRACK) < 0.15) * (index * DEPTH)
            file["position"] = np.column_stack([x, y, SURFACE - 0.04 - rut]).astype("f4")
            file["radius"] = np.full(len(x), 0.04, "f4")
            file.attrs["time_s"] = vehicle["time_s"][line]
        for k, wheel in enumerate(wheels):
            centre = [wheel["position_m"][line], TRACK * (-1) ** k, wheel["axle_height_m"][line]]
            ring = np.column_stack([RADIUS * np.cos(angle), 0 * angle, RADIUS * np.sin(angle)])
            vertex = np.concatenate([ring + [0, side, 0] for side in (-0.12, 0.12)]
                                    + [[[0, -0.12, 0], [0, 0.12, 0]]]) + centre
            n = len(angle)
            triangle = [t for i in range(n) for j in [(i + 1) % n]
                        for t in ((i, j, n + i), (j, n + j, n + i), (2 * n, i, j), (2 * n + 1, n + j, n + i))]
            with h5py.File(folder / "frames" / f"tire{k}_{index:06d}.h5", "w") as file:
                file["position"], file["triangle"] = vertex.astype("f4"), np.array(triangle, "i4")
                file.attrs["time_s"] = vehicle["time_s"][line]


class Events(SystemTest):
    def told(self, *flags, code=0, says=(), shows=(), **shape):
        folder = self.folder / f"run{len(list(self.folder.iterdir()))}"
        write_run(folder, **shape)
        return self.furrow("events", folder, *flags, code=code, says=says, shows=shows)

    def test_events_stand_at_the_times_that_the_series_have(self):
        found = json.loads(self.told("--json").stdout)["events"]
        at = {(event["event"], event["of"]): event for event in found}
        self.assertEqual([event["time_s"] for event in found], sorted(event["time_s"] for event in found))
        wheels = ("front left", "front right", "rear left", "rear right")
        for name, touch in zip(wheels, TOUCH):
            self.assertAlmostEqual(at["touch-down", name]["time_s"], touch, delta=1.5 * STEP)
        self.assertAlmostEqual(at["throttle on", "vehicle"]["time_s"], MOVE, delta=1.5 * STEP)
        self.assertAlmostEqual(at["brake off", "vehicle"]["time_s"], 0.4, delta=1.5 * STEP)
        self.assertAlmostEqual(at["gear 1 to 2", "vehicle"]["time_s"], SHIFT[0], delta=1.5 * STEP)
        self.assertAlmostEqual(at["shift is done", "vehicle"]["value"], SHIFT[1] - SHIFT[0], delta=1.5 * STEP)
        self.assertAlmostEqual(at["wheel lifts", "front right"]["time_s"], LIFT[0], delta=1.5 * STEP)
        self.assertAlmostEqual(at["wheel lifts", "front right"]["value"], LIFT[1] - LIFT[0], delta=1.5 * STEP)
        self.assertNotIn(("wheel lifts", "front left"), at)
        # speed 3.2 m/s² (t − 0.5) is above 0.1 √(g R) = 0.214 m/s
        self.assertAlmostEqual(at["drives off", "vehicle"]["time_s"], MOVE + 0.214 / 3.2, delta=0.01)
        meets = MOVE + (MEETS / 1.6) ** 0.5
        for name in wheels[2:]:
            self.assertAlmostEqual(at["reaches the place of touch-down", name]["time_s"], meets, delta=2.5 * STEP)
            self.assertAlmostEqual(at["rolls in a rut", name]["time_s"], meets, delta=2.5 * STEP)
            self.assertAlmostEqual(at["rolls in a rut", name]["value"], 1e3 * RUT, delta=0.01)
            self.assertAlmostEqual(at["largest sinkage in a rut", name]["value"], 1e3 * (DEPTH - RUT), delta=0.01)
        self.assertAlmostEqual(at["pitch changes", "rear axle"]["time_s"], meets, delta=0.01)
        self.assertAlmostEqual(at["pitch changes", "rear axle"]["value"], np.degrees(-0.02), delta=0.05)
        self.assertEqual(at["end", "vehicle"]["time_s"], END)

    def test_wheels_that_nothing_drives_are_no_part_of_the_speed_of_a_change_of_gear(self):
        told = [json.loads(self.told("--json", **shape).stdout) for shape in ({}, {"dead_front": True})]
        value = [next(event for event in one["events"] if event["event"] == "gear 1 to 2") for one in told]
        self.assertIn("of the driven wheels", value[0]["threshold"])
        self.assertAlmostEqual(value[0]["value"], value[1]["value"], delta=1e-9)

    def test_a_vehicle_of_ones_own_is_read_where_it_is(self):
        car = read_json(ROOT / "vehicle/data/hmmwv.json")
        car["driveline"]["gearbox"]["up_rpm"] *= 1.1
        own = write_json(self.folder / "hmmwv.json", car)  # with the name of a shipped one
        speed = [json.loads(self.told("--json", **file).stdout)["gear_balance"]["shift_wheel_speed_m_per_s"]
                 for file in ({}, {"vehicle": str(own)})]
        self.assertAlmostEqual(speed[1] / speed[0], 1.1, delta=1e-9)
        gone = str(self.folder / "gone" / "hmmwv.json")
        self.assertIsNone(json.loads(self.told("--json", vehicle=gone).stdout)["gear_balance"])

    def test_a_run_that_is_not_complete_says_so(self):
        found = json.loads(self.told("--json", end=5.2).stdout)["events"]
        self.assertEqual(found[-1]["event"], "ends before run.end = 5.2 s")

    def test_axles_are_compared_where_all_of_them_are_in_the_ruts(self):
        told = json.loads(self.told("--json").stdout)["axles"]
        self.assertTrue(told["steady"], told["unsteady_because"])
        self.assertGreater(told["from_s"], MOVE + (MEETS / 1.6) ** 0.5)
        self.assertEqual(told["share_in_ruts"], {"front": 0.0, "rear": 1.0})
        net = told["means"]["net longitudinal force"]
        for axle, force in (("front", 2000.0), ("rear", 2400.0), ("rear - front", 400.0)):
            # White noise of 30 N on each of two wheels, or of four in the difference.
            samples = (told["to_s"] - told["from_s"]) / STEP
            expected = 30.0 * ((4 if " - " in axle else 2) / samples) ** 0.5
            self.assertAlmostEqual(net[axle]["mean"], force, delta=5.0 * expected)
            self.assertAlmostEqual(net[axle]["sem"] / expected, 1.0, delta=0.4)
        self.assertAlmostEqual(told["means"]["resistance"]["rear - front"]["mean"], -400.0, delta=1e-6)

    def test_the_mean_slip_leaves_out_wheels_that_do_not_turn(self):
        slip = json.loads(self.told("--json", "--from=2", locks=2.5).stdout)["axles"]["means"]["slip"]
        self.assertAlmostEqual(slip["rear"]["mean"], 0.2, delta=1e-9)
        self.assertEqual(slip["rear"]["leaves_out"], "locked for 50 % of the time")
        self.assertNotIn("leaves_out", slip["front"])
        self.assertAlmostEqual(slip["rear - front"]["mean"], 0.0, delta=1e-9)
        done = self.told("--from=2", locks=1.0)
        self.assertRegex(done.stdout, r"(?m)^slip +0\.2\S* .*not defined +not defined$")
        self.assertIn("slip, rear axle: locked for 100 % of the time; the mean leaves that out", done.stdout)
        self.assertIsNone(json.loads(self.told("--json", "--from=2",
                                               locks=1.0).stdout)["axles"]["means"]["slip"]["rear"]["mean"])
        standing = json.loads(self.told("--json", "--from=0.1", "--to=0.4").stdout)["axles"]["means"]["slip"]["front"]
        self.assertEqual((standing["mean"], standing["leaves_out"]), (None, "standing for 100 % of the time"))

    def test_a_drift_is_not_called_steady(self):
        self.told(drift=300.0, shows=("NOT STEADY:\n", "front axle: net force drifts by "))

    def test_before_the_ruts_are_met_it_says_that(self):
        told = json.loads(self.told("--json", pace=0.3).stdout)
        self.assertEqual(told["axles"]["share_in_ruts"], {"front": 0.0, "rear": 0.0})
        self.assertIn("have not rolled in the ruts", told["axles"]["window"])
        self.assertNotIn("rolls in a rut", [event["event"] for event in told["events"]])

    def test_what_a_change_of_gear_needs_follows_from_engine_and_gears(self):
        told = json.loads(self.told("--json").stdout)["gear_balance"]
        # 2500 1/min of the turbine, first gear 0.2, conical gears 0.2
        self.assertAlmostEqual(told["shift_wheel_speed_m_per_s"], 2500 * np.pi / 30 * 0.04 * RADIUS, delta=1e-6)
        # Engine and converter meet near 2583 1/min of the crank, at 83 N m.
        self.assertAlmostEqual(told["limit_over_weight"], 0.18, delta=0.005)
        self.assertTrue(told["changed"])
        traction = 2 * (1000 + 900 + 1200 + 700) / sum(LOADS)
        self.assertAlmostEqual(told["gross_traction_over_weight"], traction, delta=0.02)

    def test_wrong_input_is_told_in_one_line(self):
        self.told("--from", "9", code=2, says="key '--from': is 9 s, expected 0 to 3 s, the end of the series")
        folder = self.folder / "torn"
        write_run(folder)
        path = folder / "timeseries_wheel2.csv"
        path.write_text(path.read_text().replace("sinkage_m", "sinkage_x", 1))
        done = self.furrow("events", folder, code=5)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertIn("timeseries_wheel2.csv has no column sinkage_m", done.stderr)
        path.unlink()
        self.furrow("events", folder, code=5,
                    says="timeseries_wheel2.csv is missing or empty, but there are tables of 3 wheels")
        self.furrow("events", self.folder, code=2, says="holds no run")


class Report(SystemTest):
    def test_all_wheels_and_the_vehicle_are_drawn(self):
        folder = self.folder / "run"
        write_frames(folder, *write_run(folder))
        done = self.furrow("report", folder, timeout=600)
        names = {pathlib.Path(name).name for name in done.stdout.splitlines()}
        self.assertEqual(names, {"vehicle.png", "wheel_forces.png", "wheel_motion.png", "front_and_rear.png",
                                 "gear.png", "ranks.png", "scene.png", "report.html"})
        for name in names - {"report.html"}:
            self.assertEqual((folder / name).read_bytes()[:4], b"\x89PNG")
        self.assertIn("no path.png: the driver follows no path", done.stderr)
        self.assertNotIn("Error", done.stderr)

    def test_the_page_shows_the_events_and_the_names_of_the_wheels(self):
        folder = self.folder / "run"
        write_run(folder)
        summary = read_json(folder / "summary.json")
        for wheel, name in zip(summary["wheels"], ("first_left", "first_right", "second_left", "second_right")):
            wheel["name"] = name
        summary["subjects"] = {"vehicle": {"gear": 1.86, "shifting": 0.3, "engine_speed_rpm": 900.0}}
        write_json(folder / "summary.json", summary)
        told = json.loads(furrow("events", folder, "--json", cwd=self.folder).stdout)["events"]
        self.furrow("report", folder, timeout=600)
        about, _ = document(folder / "report.html")
        events, = (section["blocks"][0] for section in about["sections"] if section["id"] == "events")
        self.assertEqual(events["columns"], ["time, s", "what", "of", "value", "threshold"])
        self.assertEqual([[row[0], row[1], row[2], row[4]] for row in events["rows"]],
                         [[f"{e['time_s']:.3f}", e["event"], e["of"], e["threshold"]] for e in told])
        self.assertIn("first right", {row[2] for row in events["rows"]})
        tables = [block for section in about["sections"] for block in section["blocks"] if block["type"] == "table"]
        rows = [row[0] for table in tables for row in table["rows"]]
        self.assertTrue(any("engine" in row for row in rows), rows)
        self.assertFalse({"gear", "shifting"} & set(rows), rows)  # their means are no gear
        self.assertIn("second left", [row[0] for table in tables if table["columns"][0] == "wheel"
                                      for row in table["rows"]])


class Statistics(unittest.TestCase):
    def test_errors_know_that_samples_hang_together(self):
        chance = np.random.default_rng(3)
        values, kept = np.zeros(20000), 0.9
        for k in range(1, len(values)):
            values[k] = kept * values[k - 1] + chance.normal()
        found = statistics(values)
        self.assertAlmostEqual(found.n_eff / (len(values) * (1 - kept) / (1 + kept)), 1.0, delta=0.15)
        self.assertFalse(found.drifts)
        self.assertTrue(statistics(values + np.linspace(0.0, 5.0 * found.std, len(values))).drifts)

    def test_constant_series_have_no_error(self):
        found = statistics(np.full(50, 2.5))
        self.assertEqual((found.mean, found.sem, found.drifts), (2.5, 0.0, False))


if __name__ == "__main__":
    main()
