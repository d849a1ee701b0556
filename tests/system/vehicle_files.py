#!/usr/bin/python3
"""Vehicles before they drive: `furrow validate` and `furrow kc` of a vehicle's file, and wrong files of vehicles."""
import csv
import io
import json

from program import ROOT, SystemTest, furrow, main, start

DATA = ROOT / "vehicle" / "data"


def shipped(name):
    return json.loads((DATA / name).read_text())


def changed(name, *changes):
    """A shipped vehicle with values replaced by their path; ... removes the key."""
    document = shipped(name)
    for path, value in changes:
        place = document
        *way, last = path.split("/")
        for part in way:
            place = place[int(part) if isinstance(place, list) else part]
        last = int(last) if isinstance(place, list) else last
        if value is ...:
            del place[last]
        elif isinstance(place, list) and last == len(place):
            place.append(value)
        else:
            place[last] = value
    return document


S = "axles/0/suspension"
# (name, document or text, what the message must hold)
WRONG = [
    ("no_chassis", changed("hmmwv.json", ("chassis", ...)), "key 'chassis': is missing, expected an object { }"),
    ("no_axles", changed("hmmwv.json", ("axles", ...)), "key 'axles': is missing, expected a list"),
    ("empty_axles", changed("hmmwv.json", ("axles", [])), "key 'axles': has 0 entries, expected 1 to 16 axles"),
    ("misspelt_key", changed("hmmwv.json", ("axels", [])), "key 'axels': is unknown, expected 'axles'?"),
    ("of_a_later_program", changed("hmmwv.json", ("format_version", 2)),
     "key 'format_version': is 2: the file is newer than this program"),
    ("no_version", changed("hmmwv.json", ("format_version", ...)), "key 'format_version': is missing, expected 1"),
    ("negative_mass", changed("hmmwv.json", ("chassis/mass", -5)),
     "key 'chassis.mass': is -5 kg, expected a number, above 0 up to 1e7 kg"),
    ("inertia_of_no_body", changed("hmmwv.json", ("chassis/inertia", [1, 2, 4])),
     "key 'chassis.inertia': has the principal moments 1, 2, 4, expected none larger than the sum of the other two"),
    ("axle_without_wheel", changed("hmmwv.json", ("axles/0/wheel", ...)),
     "key 'axles[0].wheel': is missing, expected an object { }"),
    ("wheel_without_tire", changed("hmmwv.json", ("axles/0/wheel/tire", ...)),
     "key 'axles[0].wheel.tire': is missing, expected a text"),
    ("tire_that_is_not_there", changed("hmmwv.json", ("axles/1/wheel/tire", "none.json")),
     "key 'axles[1].wheel.tire': 'none.json' does not exist, expected a file at one of"),
    ("tire_that_is_too_weak", changed("buggy.json", ("chassis/mass", 30e3)), "key 'axles[0].wheel.tire': "),
    ("tire_that_is_no_tire", changed("hmmwv.json", ("axles/0/wheel/tire", "loose_sand.json")), "loose_sand.json"),
    ("unknown_suspension", changed("hmmwv.json", (S + "/type", "mcpherson")),
     "key 'axles[0].suspension.type': is 'mcpherson', expected 'double_wishbone', 'trailing_arm', 'rigid_axle' or "
     "'fixed'"),
    ("left_wheel_on_the_right", changed("hmmwv.json", (S + "/spindle/center", [0, -0.9, 0])),
     "key 'axles[0].suspension.spindle.center': lies at y = -0.9, expected a point on the left"),
    ("hinge_of_one_point", changed("hmmwv.json", (S + "/lower_arm/chassis_back", [0.223, 0.307, 0])),
     "key 'axles[0].suspension.lower_arm.chassis_back': is the point of axles[0].suspension.lower_arm.chassis_front"),
    ("spring_on_the_same_body", changed("hmmwv.json", (S + "/spring/on", "chassis")),
     "key 'axles[0].suspension.spring.on': is 'chassis', the body of its other end, expected 'lower_arm', 'upper_arm' "
     "or 'upright'"),
    ("spring_without_force", changed("hmmwv.json", (S + "/spring/force", ...)),
     "key 'axles[0].suspension.spring.force': is missing, expected a table of forces, or the key rate"),
    ("table_that_does_not_rise", changed("hmmwv.json", (S + "/spring/force/2/0", 0.01)),
     "key 'axles[0].suspension.spring.force[2]': begins with 0.01 after 0.02, expected a table that rises"),
    ("force_that_falls", changed("hmmwv.json", (S + "/spring/force/2/1", 100)),
     "key 'axles[0].suspension.spring.force[2]': ends with 100 after 3629.923, expected forces that rise"),
    ("stops_the_wrong_way_round", changed("hmmwv.json", (S + "/spring/stop/longest", 0.1)),
     "key 'axles[0].suspension.spring.stop.longest': is 0.1, expected more than shortest, 0.15"),
    ("shock_that_drives", changed("hmmwv.json", (S + "/shock/rebound", -1)),
     "key 'axles[0].suspension.shock.rebound': is -1 N s/m, expected a number, 0 to 1e8 N s/m"),
    ("steering_that_does_not_steer", changed("hmmwv.json", ("axles/0/steering/left_angle_deg", 0)),
     "key 'axles[0].steering.left_angle_deg': is 0, expected -90 to 90, not 0"),
    ("axle_on_five_rods", changed("buggy.json", ("axles/1/suspension/links/1/mirrored", True)),
     "key 'axles[1].suspension.links': has 5 rods (a mirrored one counts twice), expected 4"),
    ("beam_on_no_arm", changed("rover.json", ("axles/2/suspension/on", "last")),
     "key 'axles[2].suspension.on': is 'last', expected the name of an axle with trailing arms"),
    ("gear_of_ratio_0", changed("hmmwv.json", ("driveline/gears/1/ratio", 0)),
     "key 'driveline.gears[1].ratio': is 0, expected another number: output over input"),
    ("gearbox_of_ratio_0", changed("hmmwv.json", ("driveline/gearbox/ratios/1", 0)),
     "key 'driveline.gearbox.ratios[1]': is 0, expected a number above zero"),
    ("shifts_up_before_it_shifts_down", changed("hmmwv.json", ("driveline/gearbox/up_rpm", 1000)),
     "key 'driveline.gearbox.up_rpm': is 1000, expected more than down_rpm, 1200"),
    ("no_engine_map", changed("hmmwv.json", ("driveline/engine/torque", ...)),
     "key 'driveline.engine.torque': is missing, expected a list"),
    ("engine_map_that_does_not_rise", changed("hmmwv.json", ("driveline/engine/torque/3/0", 850)),
     "key 'driveline.engine.torque[3]': begins with 850 after 900, expected a table that rises"),
    ("losses_that_drive", changed("hmmwv.json", ("driveline/engine/losses/3/1", 50)),
     "key 'driveline.engine.losses[3]': drives the engine with 50 N m, expected a torque against its speed"),
    ("converter_that_gives_power", changed("hmmwv.json", ("driveline/converter/torque_ratio/3/1", 2)),
     "key 'driveline.converter.torque_ratio[3]': gives 1.5 times the power that it takes, expected at most 1"),
    ("no_engine", changed("hmmwv.json", ("driveline/engine", ...)),
     "key 'driveline.engine': is missing, expected an engine for the clutch"),
    ("differential_of_one_output", changed("hmmwv.json", ("driveline/differentials/1/outputs", ["front left"])),
     "key 'driveline.differentials[1].outputs': has 1 shafts, expected two"),
    ("shaft_of_no_wheel",
     changed("hmmwv.json", ("driveline/shafts/12", {"name": "pump", "inertia": 0.1, "axis": [1, 0, 0]})),
     "key 'driveline.shafts[12].name': 'pump' reaches no wheel, expected a train of gears to one"),
    ("output_that_drives_nothing", changed("hmmwv.json", ("driveline/wheels/3", ...)),
     "key 'driveline.differentials[2].outputs': 'rear right' drives nothing, expected a shaft that a wheel, a gear or "
     "a differential"),
    ("loop_of_gears", changed("hmmwv.json", ("driveline/gears/3",
                                             {"name": "bypass", "in": "front box", "out": "front drive", "ratio": 5})),
     "key 'driveline.gears[3]': 'bypass' closes a loop of gears, expected a train without loops"),
    ("wheel_driven_twice", changed("hmmwv.json", ("driveline/wheels/3/side", "left")),
     "key 'driveline.wheels[3]': drives the wheel 'rear left' again, expected one shaft per wheel"),
    ("wheel_of_no_axle", changed("hmmwv.json", ("driveline/wheels/3/axle", "middle")),
     "key 'driveline.wheels[3].axle': is 'middle', expected one of the axles 'front' or 'rear'"),
    ("motor_beside_a_motor", changed("rover.json", ("driveline/motors/1/axle", "front")),
     "key 'driveline.motors[1].axle': 'front' is driven already, expected one drive per wheel"),
    ("number_for_a_name", changed("hmmwv.json", ("name", 3)), "key 'name': is 3, expected a text"),
    ("text_for_a_number", changed("hmmwv.json", ("chassis/mass", "heavy")),
     "key 'chassis.mass': is 'heavy', expected a number"),
    ("key_given_twice", '{"axles": [], "axles": []}', "key 'axles'"),
    ("empty_name", changed("hmmwv.json", ("name", "")), "key 'name': is empty, expected a name"),
    ("lengths_in_mm", changed("hmmwv.json", ("axles/0/origin", [1688.965, 0, 0])),
     "key 'axles[0].origin': has 1688.965 among its coordinates, expected at most 100 in magnitude: points are in m"),
    ("rack_that_leaves_its_tie_rods", changed("buggy.json", ("axles/0/steering/left_travel", -0.5)),
     "key 'axles[0].steering.left_travel': is -0.5 m, the travel of the rack that full steering asks for, expected at "
     "most 0.1 m in "
     "magnitude: steering -1 asks for 0.5 m, but the linkage of axle 'front' ends at 0.1 m, steering -0.2"),
    ("pitman_arm_beyond_its_dead_centre", changed("hmmwv.json", ("axles/0/steering/left_angle_deg", -85)),
     "key 'axles[0].steering.left_angle_deg': is -85 degrees, the angle of the Pitman arm that full steering asks for, "
     "expected at most "),
    ("cut_short", json.dumps(shipped("hmmwv.json"))[:4000], "wrong.json:1:4001: is not valid JSON"),
    ("rate_in_N_per_mm", changed("buggy.json", ("axles/0/suspension/spring/rate", 38.8)),
     "there is no equilibrium near the drawn posture; it weighs 5511 N, and the springs of axle 'front' push with 4.22 "
     "N as drawn"),
    ("behind_its_wheels", changed("hmmwv.json", ("chassis/center_of_mass", [-4, 0, 0.2])),
     "near the drawn posture; its centre of mass, x = -3.42 m, y = 0.00 m, does not lie between its wheels"),
    ("no_spring", changed("buggy.json", ("axles/0/suspension/spring", ...)), "vehicle 'Buggy'"),
]


class Wrong(SystemTest):
    def refused(self, command, text, message):
        path = self.folder / "wrong.json"
        path.write_text(text if isinstance(text, str) else json.dumps(text))
        done = furrow(command, path, cwd=self.folder, timeout=60)
        self.assertEqual(done.returncode, 2, f"{done.stdout}{done.stderr}")
        self.assertEqual(done.stdout, "")
        lines = [line for line in done.stderr.splitlines() if line.startswith("furrow: error: ")]
        self.assertEqual(len(lines), 1, done.stderr)
        self.assertIn(message, lines[0])
        self.assertIn("wrong.json" if "loose_sand" not in message else message, lines[0])
        self.assertEqual([path], list(self.folder.iterdir()))

    def test_files_are_refused_by_key_and_what_was_expected(self):
        self.assertGreaterEqual(len(WRONG), 25)
        for name, document, message in WRONG:
            with self.subTest(name):
                # Whatever has neither axles nor chassis is taken for a scenario by `validate`.
                self.refused("kc", document, message)
                if isinstance(document, dict) and ("axles" in document or "chassis" in document):
                    self.refused("validate", document, message)

    def test_options(self):
        for more, word in ((("--travel", "-1"), "--travel"), (("--travel", "0.5"), "axle 'front'"),
                           (("--points", "2"), "--points"),
                           (("--csv", "--json"), "--csv"), (("--csv", "--out", "x"), "--out")):
            done = furrow("kc", "rover.json", *more, cwd=self.folder)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(word, done.stderr)
        done = furrow("kc", "none.json", cwd=self.folder)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("key 'VEHICLE': 'none.json' does not exist, expected a file at that place or in", done.stderr)
        done = furrow("kc", ROOT / "rigs" / "hmmwv_rigid.json", cwd=self.folder)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("hmmwv_rigid.json: is a scenario, expected the file of a vehicle: its rig.vehicle is "
                      "'hmmwv.json'", done.stderr)
        done = furrow("run", "hmmwv.json", cwd=self.folder)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("hmmwv.json: is a vehicle, expected a scenario (the key rig.vehicle of a scenario takes "
                      "vehicles)", done.stderr)
        done = furrow("validate", "hmmwv_small.json", "--set", "rig.vehicle=none.json", cwd=self.folder)
        self.assertEqual(done.returncode, 2, done.stderr)
        places = done.stderr.split("expected a file at one of: ")[1].strip().split(", ")
        self.assertEqual(len(places), len(set(places)), places)
        done = furrow("kc", ROOT / "rigs" / "first_look.json", cwd=self.folder)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("first_look.json: is a scenario, expected the file of a vehicle\n", done.stderr)
        done = furrow("validate", "rover.json", "--set", "run.end=1", cwd=self.folder)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("--set", done.stderr)
        self.assertEqual([], list(self.folder.iterdir()))


class Unlikely(SystemTest):
    def test_what_is_hardly_meant_is_warned_of(self):
        for where, value, message in (
                ("driveline/gearbox/up_rpm", 7000,
                 "key 'driveline.gearbox.up_rpm': is 7000, above the 6305 rpm to which the engine drives it"),
                ("chassis/mass", 0.42, "key 'chassis.mass': is 0.42 kg, all other parts have "),
                ("chassis/inertia", [0.07, 0.26, 0.28],
                 "key 'chassis.inertia': gives a radius of gyration of 0.0269 m between wheels "
                                                       "that are 2.78 m apart: another unit?")):
            with self.subTest(where):
                path = self.folder / "odd.json"
                path.write_text(json.dumps(changed("buggy.json", (where, value))))
                done = furrow("validate", path, cwd=self.folder, timeout=300)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertIn(f"furrow: warning: {path}: {message}", done.stderr)
                scenario = self.folder / "run.json"
                scenario.write_text(json.dumps({"rig": {"type": "vehicle", "vehicle": "odd.json"},
                                                "terrain": {"engine": "rigid"}}))
                done = furrow("validate", scenario, cwd=self.folder, timeout=300)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertIn(f"furrow: warning: {scenario}: key 'rig.vehicle': is {path}, whose "
                              f"{message.replace(': ', ' ', 1)}", done.stderr)
        for path in DATA.glob("*.json"):
            if "schema" not in path.name:
                # also where a scenario's name is similar
                done = furrow("validate", path.name, cwd=self.folder, timeout=300)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertNotIn("warning", done.stderr)


class Stands(SystemTest):
    def page(self, name):
        done = furrow("validate", name, "--json", cwd=self.folder, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

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
        text = furrow("validate", DATA / "hmmwv.json", cwd=self.folder, timeout=300)
        self.assertEqual(text.returncode, 0, text.stderr)
        self.assertIn("19, 100 rows, 14 degrees of freedom", text.stdout)
        self.assertIn("front left, spring", text.stdout)

    def test_rover_on_rigid_wheels_tells_no_vibration_of_the_ground(self):
        page = self.page("rover.json")
        self.assertTrue(all(mode["frequency_Hz"] < 50 for mode in page["modes"]), page["modes"])
        self.assertTrue(all("does not deflect" in tire for tire in page["tires"]))
        self.assertAlmostEqual(page["axle_loads_N"][0], 49, delta=5)


class Kinematics(SystemTest):
    def test_folder_with_table_figures_and_plots(self):
        done = furrow("kc", "buggy.json", "--out", "out", "--points", "5", cwd=self.folder, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("warning", done.stderr)  # what keeps plots from being made is one
        self.assertEqual(done.stdout.strip(), "out")
        out = self.folder / "out"
        rows = list(csv.DictReader(io.StringIO((out / "kinematics.csv").read_text())))
        # Two axles parallel and opposite, one steered; two wheels, five points.
        self.assertEqual(len(rows), (2 + 2 + 1) * 2 * 5)
        drawn = next(row for row in rows if row["motion"] == "parallel" and abs(float(row["travel_m"])) < 1e-9)
        self.assertAlmostEqual(float(drawn["camber_rad"]), -0.5 * 3.14159265 / 180, delta=1e-6)
        summary = json.loads((out / "summary.json").read_text())
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
        done = start("kc", "buggy.json", "--points", "1001", cwd=self.folder)
        self.assertIn("moving the suspensions", done.stderr.readline())
        done.terminate()
        _, said = done.communicate(timeout=60)
        self.assertEqual(done.returncode, 75, said)
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
        done = start("kc", "hmmwv.json", cwd=self.folder, env={"XDG_CACHE_HOME": str(self.folder / "cache")})
        self.assertIn("tires", done.stderr.readline())
        done.terminate()
        _, said = done.communicate(timeout=60)
        self.assertEqual(done.returncode, 75, said)
        self.assertFalse((self.folder / "results").exists())


if __name__ == "__main__":
    main()
