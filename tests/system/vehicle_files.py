#!/usr/bin/python3
"""Vehicles before they drive: `furrow validate` and `furrow kc` of a vehicle's file, and wrong files of vehicles."""
import csv
import io
import json

from program import ROOT, SystemTest, furrow, main, message_of, read_json, with_keys, write_json

DATA = ROOT / "vehicle" / "data"


def shipped(name):
    return read_json(DATA / name)


# {shipped vehicle: [(key that is changed, its value, what the message of that key begins with)]}: see with_keys and
# message_of. All other keys: tests/vehicle/vehicle_file_test.cpp.
WRONG = {
    "hmmwv.json": [
        ("chassis", ..., "is missing, expected an object { }"),
        ("axles", ..., "is missing, expected a list"),
        ("axels", [], "is unknown, expected 'axles'?"),
        ("format_version", ..., "is missing, expected 1"),
        ("chassis.mass", -5, "is -5 kg, expected a number, above 0 up to 1e7 kg"),
        ("axles[1].wheel.tire", "none.json", "'none.json' does not exist, expected a file at one of"),
        ("axles[0].wheel.tire", "… loose_sand.json", "… loose_sand.json"),
        ("driveline.wheels[3]", ..., "… key 'driveline.differentials[2].outputs': 'rear right' drives nothing, "
         "expected a shaft that a wheel, a gear or a differential"),
        ("chassis.center_of_mass", [0.1, 0, -0.7], "has z = -0.7 m, expected a place above the ground"),
        ("name", 3, "is 3, expected a text"),
        ("chassis.mass", "heavy", "is 'heavy', expected a number"),
        ("name", "", "is empty, expected a name"),
        ("axles[0].origin", [1688.965, 0, 0],
         "has 1688.965 among its coordinates, expected at most 100 in magnitude: points are in m"),
        ("axles[0].steering.left_angle_deg", -85,
         "is -85 degrees, the angle of the Pitman arm that full steering asks for, expected at most "),
        ("chassis.center_of_mass", [-4, 0, 0.2],
         "… near the drawn posture; its centre of mass, x = -3.42 m, y = 0.00 m, does not lie between its wheels"),
    ],
    "buggy.json": [
        ("chassis.mass", 30000.0, "… key 'axles[0].wheel.tire': "),
        ("axles[0].steering.left_travel", -0.5,
         "is -0.5 m, the travel of the rack that full steering asks for, expected at most 0.1 m in magnitude: "
         "steering -1 asks for 0.5 m, but the linkage of axle 'front' ends at 0.1 m, steering -0.2"),
        ("axles[0].suspension.spring.rate", 38.8, "… there is no equilibrium near the drawn posture; it weighs 5511 N, "
         "and the springs of axle 'front' push with 4.22 N as drawn"),
        ("axles[0].suspension.spring", ..., "… vehicle 'Buggy'"),
    ],
}


class Wrong(SystemTest):
    def refused(self, document, message):
        """Whatever has neither axles nor chassis is taken for a scenario by `validate`."""
        path = self.folder / "wrong.json"
        path.write_text(document if isinstance(document, str) else json.dumps(document))
        for command in ("kc", "validate") if {"axles", "chassis"} & set(document) else ("kc",):
            done = self.furrow(command, path, timeout=60, code=2, prints="")
            line, = [line for line in done.stderr.splitlines() if line.startswith("furrow: error: ")]
            self.assertIn(message, line)
            self.assertRegex(line, "wrong.json|loose_sand.json")
            self.assertEqual([path], list(self.folder.iterdir()))

    def test_files_are_refused_by_key_and_what_was_expected(self):
        for name, rows in WRONG.items():
            for key, value, words in rows:
                with self.subTest(key, value=value):
                    self.refused(with_keys(shipped(name), {key: value}), message_of({key: value}, words))
        self.refused('{"axles": [], "axles": []}', "key 'axles'")
        self.refused(json.dumps(shipped("hmmwv.json"))[:4000], "wrong.json:1:4001: is not valid JSON")

    def test_options(self):
        for more, word in ((("--travel", "-1"), "--travel"), (("--travel", "0.5"), "axle 'front'"),
                           (("--points", "2"), "--points"),
                           (("--csv", "--json"), "--csv"), (("--csv", "--out", "x"), "--out")):
            self.furrow("kc", "rover.json", *more, code=2, says=word)
        self.furrow("kc", "none.json", code=2,
                    says="key 'VEHICLE': 'none.json' does not exist, expected a file at that place or in")
        self.furrow("kc", ROOT / "rigs" / "hmmwv_rigid.json", code=2, says="hmmwv_rigid.json: is a scenario, expected "
                    "the file of a vehicle: its rig.vehicle is 'hmmwv.json'")
        self.furrow("run", "hmmwv.json", code=2, says="hmmwv.json: is a vehicle, expected a scenario (the key "
                    "rig.vehicle of a scenario takes vehicles)")
        done = self.furrow("validate", "hmmwv_small.json", "--set", "rig.vehicle=none.json", code=2)
        places = done.stderr.split("expected a file at one of: ")[1].strip().split(", ")
        self.assertEqual(len(places), len(set(places)), places)
        self.furrow("kc", ROOT / "rigs" / "first_look.json", code=2,
                    says="first_look.json: is a scenario, expected the file of a vehicle\n")
        self.furrow("validate", "rover.json", "--set", "run.end=1", code=2, says="--set")
        self.assertEqual([], list(self.folder.iterdir()))


class Unlikely(SystemTest):
    def test_what_is_hardly_meant_is_warned_of(self):
        for where, value, message in (
                ("driveline.gearbox.up_rpm", 7000,
                 "key 'driveline.gearbox.up_rpm': is 7000, above the 6305 rpm to which the engine drives it"),
                ("chassis.mass", 0.42, "key 'chassis.mass': is 0.42 kg, all other parts have "),
                ("chassis.inertia", [0.07, 0.26, 0.28], "key 'chassis.inertia': gives a radius of gyration of 0.0269 m "
                 "between wheels that are 2.78 m apart: another unit?")):
            with self.subTest(where):
                path = write_json(self.folder / "odd.json", with_keys(shipped("buggy.json"), {where: value}))
                self.furrow("validate", path, timeout=300, says=f"furrow: warning: {path}: {message}")
                scenario = write_json(self.folder / "run.json", {"rig": {"type": "vehicle", "vehicle": "odd.json"},
                                                "terrain": {"engine": "rigid"}})
                self.furrow("validate", scenario, timeout=300, says=f"furrow: warning: {scenario}: key 'rig.vehicle': "
                            f"is {path}, whose {message.replace(': ', ' ', 1)}")
        path = write_json(self.folder / "odd.json",
                          with_keys(shipped("buggy.json"), {"axles[0].steering.left_travel": 0.05}))
        self.furrow("validate", path, timeout=300, shows="full left turns the wheels of front", says=(
            "key 'axles[0].steering.left_travel': turns the wheels ", " degrees to the right at full steering to the "
            "left: the other sign?"))
        for path in DATA.glob("*.json"):
            if "schema" not in path.name:
                # also where a scenario's name is similar
                self.furrow("validate", path.name, timeout=300, lacks="warning")


class Stands(SystemTest):
    def page(self, name):
        return json.loads(self.furrow("validate", name, "--json", timeout=300).stdout)

    def test_hmmwv(self):
        page = self.page("hmmwv.json")
        self.assertEqual([page[key] for key in ("bodies", "rows", "freedoms", "shaft_freedoms")], [19, 100, 14, 1])
        weight = 9.81 * (page["mass_kg"] + sum(page["tire_masses_kg"]))
        self.assertAlmostEqual(sum(page["axle_loads_N"]), weight, delta=1e-6 * weight)
        self.assertAlmostEqual(page["mass_kg"], 2422.74, delta=0.01)
        for wheel in page["wheels"]:
            self.assertLess(abs(wheel["travel_m"]), 0.02, wheel)  # the tires' mass and the engine's
            self.assertTrue(0.005 < wheel["deflection_m"] < 0.03, wheel)
            self.assertGreater(wheel["spring"]["to_shortest_m"], 0.0)
            self.assertGreater(wheel["spring"]["to_longest_m"], 0.0)
            self.assertGreater(wheel["shock"]["to_shortest_m"], 0.0)
        modes = {mode["name"]: mode["frequency_Hz"] for mode in page["modes"]}
        self.assertTrue(0.5 < modes["heave"] < 4 and 0.5 < modes["pitch"] < 4, modes)
        self.furrow("validate", DATA / "hmmwv.json", timeout=300, shows=("19, 100 rows, 14 degrees of freedom",
                                                                         "front left, spring"))

    def test_rover_on_rigid_wheels_tells_no_vibration_of_the_ground(self):
        page = self.page("rover.json")
        self.assertTrue(all(mode["frequency_Hz"] < 50 for mode in page["modes"]), page["modes"])
        self.assertTrue(all("does not deflect" in tire for tire in page["tires"]))
        self.assertAlmostEqual(page["axle_loads_N"][0], 49, delta=5)


class Kinematics(SystemTest):
    def test_folder_with_table_figures_and_plots(self):
        done = self.furrow("kc", "buggy.json", "--out", "out", "--points", "5", timeout=300)
        self.assertNotIn("warning", done.stderr)  # what keeps plots from being made is one
        self.assertEqual(done.stdout.strip(), "out")
        out = self.folder / "out"
        rows = list(csv.DictReader(io.StringIO((out / "kinematics.csv").read_text())))
        # Two axles parallel and opposite, one steered; two wheels, five points.
        self.assertEqual(len(rows), (2 + 2 + 1) * 2 * 5)
        drawn = next(row for row in rows if row["motion"] == "parallel" and abs(float(row["travel_m"])) < 1e-9)
        self.assertAlmostEqual(float(drawn["camber_rad"]), -0.5 * 3.14159265 / 180, delta=1e-6)
        summary = read_json(out / "summary.json")
        self.assertEqual(summary["vehicle"], "Buggy")
        self.assertEqual(len(summary["as_drawn"]), 4)
        self.assertEqual(summary["at_rest"]["axles"], ["front", "rear"])
        for plot in ("parallel", "opposite", "steering"):
            self.assertGreater((out / f"{plot}.png").stat().st_size, 10000, plot)
        again = furrow("kc", "buggy.json", "--csv", "--points", "5", cwd=self.folder, timeout=300)
        self.assertEqual(again.stdout, (out / "kinematics.csv").read_text())
        listed = json.loads(furrow("kc", "buggy.json", "--json", "--points", "5", cwd=self.folder, timeout=300).stdout)
        self.assertEqual(len(listed["rows"]), len(rows))
        self.assertEqual([out], list(self.folder.iterdir()))

    def test_a_long_sweep_tells_how_far_it_is_and_stops_on_a_signal(self):
        furrow("kc", "buggy.json", "--csv", "--points", "3", cwd=self.folder, timeout=300)
        done = self.start("kc", "buggy.json", "--points", "1001")
        self.assertIn("moving the suspensions", done.stderr.readline())
        done.terminate()
        self.ended(done, 75)
        self.assertFalse((self.folder / "results").exists())

    def test_a_damaged_cache_is_made_anew(self):
        first = furrow("kc", "buggy.json", "--csv", "--points", "3", cwd=self.folder, timeout=300,
                       env={"XDG_CACHE_HOME": str(self.folder / "cache")})
        kept = list((self.folder / "cache/furrow/press").iterdir())
        self.assertEqual(len(kept), 1)
        whole = kept[0].read_bytes()
        kept[0].write_bytes(whole[:-20])
        again = furrow("kc", "buggy.json", "--csv", "--points", "3", cwd=self.folder, timeout=300,
                       env={"XDG_CACHE_HOME": str(self.folder / "cache")})
        self.assertEqual(first.stdout, again.stdout)
        self.assertEqual(kept[0].read_bytes(), whole)

    def test_a_signal_stops_it_while_tires_are_pressed(self):
        done = self.start("kc", "hmmwv.json", env={"XDG_CACHE_HOME": str(self.folder / "cache")})
        self.assertIn("tires", done.stderr.readline())
        done.terminate()
        self.ended(done, 75)
        self.assertFalse((self.folder / "results").exists())


if __name__ == "__main__":
    main()
