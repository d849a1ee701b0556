#!/usr/bin/python3
"""Whole vehicles as users run them: the shipped scenarios begin, the tables say what vehicle, driver and wheels do, and
what is wrong is told in one line."""

import h5py

from program import ROOT, SystemTest, main, read_json, rows_of, write_json

QUICK = ["--set", "tire.rigid=true", "--set", "output.frame_interval=0", "--no-plots"]


class Vehicles(SystemTest):
    def run_it(self, name, *flags, **expected):
        return self.furrow("run", ROOT / "rigs" / name, "--out", self.folder / "out", *flags, timeout=600, **expected)

    def table(self, subject):
        rows = rows_of(self.folder / "out" / f"timeseries_{subject}.csv")
        return [{key: float(value) for key, value in line.items()} for line in rows]

    def test_the_car_on_hard_ground_is_let_down_stands_and_drives_off(self):
        done = self.run_it("hmmwv_rigid.json", *QUICK, "--set", "run.end=0.9", "--set", "run.average_from=0.7")
        self.assertRegex(done.stderr + done.stdout,
                         r"vehicle: 0\.\d+ m in all; from 0\.7 s on 0\.\d+ m/s on average, engine ")
        vehicle, wheels = self.table("vehicle"), [self.table(f"wheel{k}") for k in range(4)]
        at = {round(line["time_s"], 3): i for i, line in enumerate(vehicle)}
        stands, drives = at[0.5], at[0.9]
        loads = [sum(line["vertical_force_N"] for line in wheel[stands - 20:stands]) / 20 for wheel in wheels]
        summary = self.summary()
        for load, wheel in zip(loads, summary["wheels"]):
            self.assertAlmostEqual(load / wheel["vertical_load_N"], 1.0, delta=0.03)
        self.assertLess(abs(vehicle[stands]["x_m"] - vehicle[0]["x_m"]), 0.005)
        self.assertEqual(vehicle[drives]["gear"], 1)
        self.assertEqual(vehicle[drives]["throttle"], 1)
        self.assertGreater(vehicle[drives]["acceleration_m_per_s2"], 1.0)
        self.assertGreater(vehicle[drives]["power_W"], vehicle[drives]["wheel_power_W"])
        self.assertGreater(vehicle[drives]["turbine_speed_rpm"], 0.0)
        self.assertLess(vehicle[drives]["turbine_speed_rpm"], vehicle[drives]["engine_speed_rpm"])
        names = ["front_left", "front_right", "rear_left", "rear_right"]
        self.assertEqual([wheel["name"] for wheel in summary["wheels"]], names)
        with h5py.File(self.folder / "out" / "results.h5") as file:
            self.assertEqual([file[f"series/wheel{k}"].attrs["name"].decode() for k in range(4)], names)
        told = summary["vehicle"]
        self.assertAlmostEqual(told["mass_kg"] * 9.81 / sum(wheel["vertical_load_N"] for wheel in summary["wheels"]),
                               1.0, delta=1e-3)
        self.assertEqual(told["distance_m"], summary["subjects"]["vehicle"]["distance_m"])
        self.assertEqual(told["energy_J"]["engine"], summary["subjects"]["vehicle"]["drive_work_J"])
        self.assertGreater(told["max_pitch_rad"], 0.0)
        for wheel in wheels:
            self.assertGreater(wheel[drives]["spindle_torque_Nm"], 100)
            self.assertGreater(wheel[drives]["iso_force_x_N"], 100)
            self.assertLess(abs(wheel[drives]["suspension_travel_m"]), 0.05)
        self.assertIn("vehicle", summary["subjects"])
        self.accounts_close(summary)
        self.assertLess(summary["accounts"]["energy"]["residual_share"], 0.01)

    def test_brakes_hold_the_car_on_a_slope(self):
        self.run_it("hmmwv_slope.json", *QUICK, "--set", "run.end=1.5", "--set", "run.average_from=0.8")
        vehicle, wheels = self.table("vehicle"), [self.table(f"wheel{k}") for k in range(4)]
        tail = [line for line in vehicle if line["time_s"] > 1.0]
        self.assertLess(max(line["x_m"] for line in tail) - min(line["x_m"] for line in tail), 1e-3)
        mean = lambda wheel, key: sum(line[key] for line in wheel[-100:]) / 100
        up, along = (sum(mean(wheel, key) for wheel in wheels) for key in ("vertical_force_N", "force_x_N"))
        self.assertAlmostEqual(along / up, 0.2, delta=0.01)
        self.assertGreater(mean(wheels[2], "vertical_force_N"), mean(wheels[0], "vertical_force_N"))
        summary = self.summary()
        for wheel, told in zip(wheels, summary["wheels"]):  # what it carries at rest there, by statics
            self.assertAlmostEqual(mean(wheel, "vertical_force_N") / told["vertical_load_N"], 1.0, delta=0.02)
        weight = summary["vehicle"]["mass_kg"] * 9.80665
        self.assertAlmostEqual(up / weight, 0.98, delta=2e-3)  # the cosine of the slope
        self.assertAlmostEqual(summary["vehicle"]["mass_kg"], 2470.4, delta=0.1)

    def test_a_car_that_tips_over_on_a_side_slope_ends_its_run(self):
        top_heavy = read_json(ROOT / "vehicle/data/hmmwv.json")
        top_heavy["chassis"]["center_of_mass"][2] = 1.3
        for axle in top_heavy["axles"]:
            axle["wheel"]["tire"] = str(ROOT / "tire/data" / axle["wheel"]["tire"])
        write_json(self.folder / "top_heavy.json", top_heavy)
        self.run_it("hmmwv_rigid.json", *QUICK, "--set", f"rig.vehicle={self.folder}/top_heavy.json",
                    "--set", "rig.driver=null", "--set", "rig.heading=1.5707963", "--set", "rig.slope=0.65",
                    "--set", "run.step=5e-4", "--set", "run.end=2", "--set", "run.average_from=0.5",
                    says="s, before 2 s: the vehicle has turned over")
        self.assertEqual(self.summary()["end_reason"], "overturned")
        self.assertLess(self.summary()["end_time_s"], 1.9)

    def test_grains_on_a_slope_carry_the_car_and_its_momentum_closes(self):
        coarse = ["--set", "terrain.radius=0.05", "--set", "terrain.layers=3", "--set", "terrain.length=6",
                  "--set", "rig.driver=null", "--set", "rig.start=3", "--set", "tire.contact_tangent=false"]
        self.run_it("hmmwv_small.json", *QUICK, *coarse, "--set", "rig.slope=0.1", "--set", "run.end=1.2",
                    "--set", "run.average_from=0.8", "--set", "run.step=2e-4")
        wheels = [self.table(f"wheel{k}") for k in range(4)]
        mean = lambda wheel, key: sum(line[key] for line in wheel[-130:]) / 130
        up, along = (sum(mean(wheel, key) for wheel in wheels) for key in ("vertical_force_N", "force_x_N"))
        self.assertAlmostEqual(along / up, 0.1, delta=0.04)
        self.assertTrue(self.summary()["accounts"]["momentum"]["closes"])

    def test_a_car_begins_at_speed_and_tells_its_path(self):
        self.run_it("hmmwv_lane_change.json", *QUICK, "--set", "tire.contact_tangent=false", "--set", "run.end=0.6",
                    "--set", "run.average_from=0.3")
        vehicle = self.table("vehicle")
        self.assertAlmostEqual(vehicle[0]["speed_m_s"], 12, delta=0.1)
        self.assertEqual({line["gear"] for line in vehicle}, {3.0})
        figures = self.summary()["figures"]
        self.assertEqual(figures["gear_changes"], 0)
        self.assertLess(abs(figures["path_error_largest_m"]), 0.02)
        self.assertEqual(self.summary()["end_reason"], "run_end")

    def test_the_rover_begins_on_its_sand(self):
        self.run_it("rover_small.json", "--no-plots", "--set", "run.end=0.05", "--set", "run.average_from=0.02",
                    "--set", "terrain.layers=2", "--set", "terrain.radius=0.012")
        self.assertEqual(len(self.summary()["wheels"]), 6)
        self.assertIn("sinkage_in_rut_m", self.table("wheel5")[0])

    def test_a_run_is_not_continued_with_another_vehicle(self):
        car = read_json(ROOT / "vehicle/data/hmmwv.json")
        scenario = read_json(ROOT / "rigs/hmmwv_rigid.json")
        scenario["rig"]["vehicle"] = "mine.json"
        write_json(self.folder / "mine.json", car)
        write_json(self.folder / "car.json", scenario)
        self.run_it(self.folder / "car.json", *QUICK, "--set", "run.end=0.02", "--set", "run.average_from=0.01")
        car["axles"][0]["suspension"]["shock"]["rebound"] *= 2  # the masses stay
        write_json(self.folder / "mine.json", car)
        self.furrow("resume", self.folder / "out", "--until", "0.04", "--no-plots", timeout=300, code=2,
                    says=f"key 'rig.vehicle': '{self.folder / 'mine.json'}' was changed since the run began, expected "
                    "the file that it was computed with")

    def test_every_shipped_scenario_of_a_vehicle_is_valid(self):
        names = [path.name for path in (ROOT / "rigs").glob("*.json")
                 if read_json(path).get("rig", {}).get("type") == "vehicle"]
        self.assertGreaterEqual(len(names), 3)
        for name in names:
            self.furrow("validate", ROOT / "rigs" / name, shows="vehicle ")
            self.furrow("ranks", ROOT / "rigs" / name)

    def test_what_is_wrong_is_told_in_one_line_before_anything_is_written(self):
        for setting, message in (
                ("rig.vehicle=none.json", "key 'rig.vehicle': 'none.json' does not exist"),
                ("rig.vehicle=null",
                 "key 'rig.vehicle': is missing, expected the name of a vehicle's file: hmmwv.json"),
                ("rig.driver=none.csv", "key 'rig.driver': 'none.csv' does not exist"),
                ('rig.driver={"speed": {"target": -1}}', "key 'rig.driver.speed.target': "),
                ("rig.heading=9", "key 'rig.heading': is 9 rad, expected a number, -3.15 to 3.15 rad"),
                ("tires=[{},{},{}]", "key 'tires': has 3 entries, expected 4, one per wheel, or 2, one per axle"),
                ("rig.type=drawbar", "key 'tire.file': is missing")):
            with self.subTest(setting=setting):
                flags = [] if setting.startswith("tires") else QUICK
                scenario = read_json(ROOT / "rigs" / "hmmwv_rigid.json")
                del scenario["tire"]
                path = write_json(self.folder / "car.json", scenario)
                done = self.furrow("run", path, "--out", self.folder / "out", "--set", setting, *flags, code=2,
                                   says=message)
                self.assertEqual(done.stderr.count("error"), 1, done.stderr)
                self.assertFalse((self.folder / "out").exists())


if __name__ == "__main__":
    main()
