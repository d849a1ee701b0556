#!/usr/bin/python3
"""Whatever is wrong with the input: exit code 2, one clear line per mistake, nothing left behind, within seconds."""
import json
import os
import pathlib
import shutil
import subprocess
import time
import unittest

from program import PROGRAM, SMALL, SystemTest, changed, furrow, main, write_scenario

LONGEST = 5.0  # s


def text(**sections):
    return json.dumps(changed(**sections))


def curb(rig=(), profile=None):
    """A quarter car on a planar tire over a curb, with keys of its own."""
    return json.dumps({"format_version": 1,
                       "rig": {"type": "quarter_car", "speed": 4.0, "body_mass": 1290, **dict(rig)},
                       "tire": {"file": "aligator_planar.json"},
                       "terrain": {"engine": "rigid", "profile": [[6, 0], [6, 0.2]] if profile is None else profile},
                       "run": {"step": 4e-5, "end": 2.6, "average_from": 2.3}})


def half_car(**rig):
    """A half car on two planar tires, with keys of its own."""
    return json.dumps({"format_version": 1, "rig": {"type": "half_car", "speed": 4.0, "body_mass": 2000, **rig},
                       "tire": {"file": "aligator_planar.json"}, "terrain": {"engine": "rigid"},
                       "run": {"step": 4e-5, "end": 1.0}})


def cleat_stand(rig):
    """A cleat test stand on a plane, with keys of its own."""
    return json.dumps({"format_version": 1, "rig": {"type": "cleat_stand", **rig},
                       "tire": {"file": "aligator_planar.json"},
                       "terrain": {"engine": "rigid"}, "run": {"step": 4e-5, "end": 1.0}})


EMPIRICAL = json.dumps({**changed(terrain=None), "terrain": {"engine": "scm"}})

# (name, file text or bytes, flags of `furrow run`, what the error line must hold)
SCENARIOS = [
    ("unknown_key", text(rig={"slipp": 0.3}), [], "key 'rig.slipp': is unknown, expected 'rig.slip'?"),
    ("unknown_section", text(terain={"layers": 3}), [], "key 'terain': is unknown, expected 'terrain'?"),
    ("key_in_wrong_section", text(run={"cohesion": 1e3}), [],
     "key 'run.cohesion': is unknown, expected 'terrain.cohesion'?"),
    ("negative_radius", text(terrain={"radius": -0.006}), [], "key 'terrain.radius': is -0.006 m, expected a number"),
    ("radius_in_millimetres", text(terrain={"radius": 6}), [], "key 'terrain.radius': is 6 m, expected a number"),
    ("zero_step", text(run={"step": 0}), [], "key 'run.step': is 0 s, expected a number"),
    ("negative_end", text(run={"end": -1}), [], "key 'run.end': is -1 s"),
    ("slip_above_one", text(rig={"slip": 1.5}), [], "key 'rig.slip': is 1.5, expected a number, -10 to 1"),
    ("full_slip_at_fixed_speed", text(rig={"slip": 1, "mode": "fixed_speed"}),
     [], "key 'rig.slip': is 1, expected below 1"),
    ("toe_angle_in_degrees", text(rig={"toe_angle": 2}), [], "key 'rig.toe_angle': is 2 rad"),
    ("camber_angle_in_degrees", text(rig={"camber_angle": 3}), [], "key 'rig.camber_angle': is 3 rad"),
    ("text_for_number", text(rig={"slip": "much"}), [], "key 'rig.slip': is 'much', expected a number"),
    ("null_for_number", text(rig={"slip": None}), [], "key 'rig.slip': is null, expected a number"),
    ("number_for_text", text(rig={"mode": 3}), [], "key 'rig.mode': is 3, expected 'fixed_angular_speed'"),
    ("fraction_for_whole", text(terrain={"layers": 2.5}), [], "key 'terrain.layers': is 2.5, expected a whole number"),
    ("section_is_number", text(rig=3), [], "key 'rig': is 3, expected an object"),
    ("unknown_law", text(terrain={"law": "hertz"}), [],
     "key 'terrain.law': is 'hertz', expected 'mindlin' or 'hertz_tanh'"),
    ("key_of_grains_that_sleep", text(terrain={"engine": "liggghts", "activity": False}), [],
     "key 'terrain.activity': is a key of engine 'dem', but terrain.engine is 'liggghts'"),
    ("two_terrain_ranks", text(terrain={"ranks": 2}), [], "key 'terrain.ranks': is 2, expected 1"),
    ("vehicle", text(vehicle={"file": "hmmwv"}, rig=None), [],
     "key 'vehicle': is not a section, expected rig.vehicle beside rig.type 'vehicle'"),
    ("newer_format", text(format_version=2), [], "key 'format_version': is 2: the file is newer than this program"),
    ("no_tire", text(tire=None), [], "key 'tire': is missing"),
    ("no_tire_file_key", text(tire=None).replace('"terrain"', '"tire": {}, "terrain"'),
     [], "key 'tire.file': is missing"),
    ("wheels_in_the_way", text(rig={"wheels": [{}, {}]}), [],
     "key 'rig.wheels.1.start': puts this wheel in the way of wheel 0, expected 0.93 m"),
    ("wheel_outside", text(rig={"wheels": [{"lateral": 0.2}]}), [], "key 'terrain.width': is 0.4 m, expected at least"),
    ("wheel_key", text(rig={"wheels": [{"ballast": 3}]}), [], "key 'rig.wheels.0.ballast': is unknown"),
    ("two_tires", json.dumps({**changed(tire=None), "tires": [SMALL["tire"]] * 2}), [],
     "key 'tires': has 2 entries, expected 1: one per wheel"),
    ("tire_and_tires", json.dumps({**SMALL, "tires": [SMALL["tire"]]}), [], "key 'tires': is given beside 'tire'"),
    ("missing_tire_file", text(tire={"file": "no_such_tire.json"}), [],
     "key 'tire.file': 'no_such_tire.json' does not exist, expected a file at one of"),
    ("misspelt_tire_file", text(tire={"file": "hmmwv_layerd.json"}), [], "; did you mean 'hmmwv_layered.json'?"),
    ("tire_file_without_json", text(tire={"file": "hmmwv_layered"}), [], "; did you mean 'hmmwv_layered.json'?"),
    ("soil_as_tire", text(tire={"file": "dry_sand.json"}), [],
     "dry_sand.json: is a soil, expected a tire (the key terrain.material"),
    ("vehicle_as_tire", text(tire={"file": "hmmwv.json"}), [],
     "hmmwv.json: is a vehicle, expected a tire (the key rig.vehicle"),
    ("tire_as_soil", text(terrain={"material": "hmmwv_lumped.json"}), [],
     "hmmwv_lumped.json: is a tire, expected a soil (the key tire.file"),
    ("grid_too_coarse_for_the_tire",
     json.dumps({**SMALL, "terrain": {"engine": "scm", "length": 2.0, "width": 1.0, "grid_spacing": 0.2}}), [],
     "key 'terrain.grid_spacing': is 0.2 m, expected at most "),
    ("soil_that_cannot_bear", json.dumps({**SMALL, "terrain": {"engine": "scm", "length": 2.0, "width": 1.0,
                                                               "bekker_k_phi": 3e5, "bekker_k_c": -3e5}}), [],
     "key 'terrain.bekker_k_c': is -300000, expected above "),
    ("tire_file_is_folder", text(tire={"file": "/usr"}), [], "key 'tire.file': '/usr' is not a regular file"),
    ("scenario_as_tire", text(tire={"file": "first_look.json"}), [], "first_look.json"),
    ("unstable_step", text(run={"step": 2e-3}), [], "key 'run.step': 0.002 s is above the stable step of"),
    ("tire_wider_than_bin", text(terrain={"width": 0.3}), [], "key 'terrain.width': is 0.3 m, expected at least"),
    ("tire_longer_than_bin", text(terrain={"length": 0.9}), [], "key 'terrain.length': is 0.9 m, expected at least"),
    ("empty_bin", text(terrain={"layers": 0}), [], "key 'terrain.layers': is 0, expected a whole number, 1 to 9999"),
    ("runs_into_the_wall", text(run={"end": 5, "average_from": 1}), [], "it would hit the end wall"),
    ("starts_in_the_wall", text(rig={"start": 0.1}), [], "key 'rig.start': is 0.1 m, expected 0.467 to"),
    ("window_after_the_end", text(run={"average_from": 0.05}), [], "key 'run.average_from': is 0.05 s, expected"),
    ("bad_threads", text(run={"threads": "many"}), [],
     "key 'run.threads': is 'many', expected a whole number, 1 to 1024 or 'auto'"),
    ("unknown_generator", text(terrain={"bed_generator": "hex"}), [],
     "key 'terrain.bed_generator': is 'hex', expected 'poisson' or 'lattice'"),
    ("negative_compaction", text(terrain={"compaction_pressure": -5}),
     [], "key 'terrain.compaction_pressure': is -5 Pa, expected a number, 0 to"),
    ("soil_of_others", text(terrain={"material": "lete_sand.json"}), [],
     "key 'terrain': has keys of other engines alone (bekker_k_c,"),
    ("soft_plate", EMPIRICAL.replace('"scm"', '"scm", "bekker_k_phi": 0'),
     [], "key 'terrain.bekker_k_phi': is 0 N/m^(n+2), expected a number"),
    ("negative_modulus", EMPIRICAL.replace('"scm"', '"scm", "bekker_k_c": -9e4, "patch_width": 0.01'), [],
     "key 'terrain.bekker_k_c': is -90000, expected k_c/b + k_phi above 0 with b = terrain.patch_width"),
    ("friction_angle_in_percent", EMPIRICAL.replace('"scm"', '"scm", "mohr_friction_angle": 95'), [],
     "key 'terrain.mohr_friction_angle': is 95 deg, expected a number, 0 to 80"),
    ("grid_too_fine", EMPIRICAL.replace('"scm"', '"scm", "grid_spacing": 0.001, "length": 200, "width": 50'), [],
     "key 'terrain.grid_spacing': is 0.001: 200 m x 50 m have 1e+10 nodes, expected at most 1e+08"),
    ("grains_key_of_soil", EMPIRICAL.replace('"scm"', '"scm", "radius": 0.01'),
     [], "key 'terrain.radius': is a key of engine 'dem' or 'liggghts'"),
    ("missing_soil", text(terrain={"material": "moon.json"}), [],
     "key 'terrain.material': 'moon.json' does not exist, expected a file at one of"),
    ("spread_too_wide", text(terrain={"size_spread": 0.9}), [],
     "key 'terrain.size_spread': is 0.9, expected a number, 0 to 0.6"),
    ("spread_with_hertz_tanh", text(terrain={"size_spread": 0.2, "law": "hertz_tanh"}),
     [], "key 'terrain.size_spread': is 0.2 with law 'hertz_tanh'"),
    ("missing_bed", text(terrain={"bed": "bed.h5"}), [], "key 'terrain.bed': 'bed.h5' does not exist"),
    ("not_a_number", json.dumps(SMALL).replace("0.3", "NaN", 1), [], "is not valid JSON"),
    ("overflow", json.dumps(SMALL).replace("0.3", "1e400", 1), [],
     "key 'rig.slip': is a number too large for a double"),
    ("duplicate_key", '{"rig": {"slip": 0.1, "slip": 0.2}}', [], "key 'rig.slip': is given twice"),
    ("empty_file", "", [], "is empty, expected a scenario in JSON"),
    ("blank_file", " \n\n", [], "is empty, expected a scenario in JSON"),
    ("not_utf8", b'{"description": "caf\xe9"}', [], ":1:21: byte 0xe9 is not UTF-8"),
    ("missing_comma", '{\n  "rig": {}\n  "run": {}\n}', [], ":3:"),
    ("cut_short", json.dumps(SMALL)[:-20], [], "is not valid JSON"),
    ("a_list", "[1, 2]", [], "is [1,2], expected an object"),
    ("comment", "# a comment\n{}", [], ":1:1: is a comment of another language, expected // or /* */"),
    ("deep_list", "[" * 100000 + "]" * 100000, [], "in.json:1:65: lists and objects are nested deeper than 64 levels"),
    ("deep_value", json.dumps(SMALL)[:-1] + ', "description": ' + "[" * 100000 + "]" * 100000 + "}",
     [], "nested deeper than 64 levels"),
    ("deep_setting", json.dumps(SMALL), ["--set", "tire.pressure=" + "[" * 50000 + "]" * 50000],
     "key 'tire.pressure': lists and objects are nested deeper than 64 levels"),
    ("deep_key", json.dumps(SMALL), ["--set", ".".join("a" * 50000) + "=1"],
     "': is not a key, expected --set section.key=value"),
    ("terminal_codes_in_a_key", '{"\\u001b]0;owned\\u0007": 1}', [],
     "key '\\x1b]0;owned\\x07': has a control character"),
    ("terminal_codes_in_a_value", text(terrain={"law": "\x1b[31m\n"}),
     [], "key 'terrain.law': is '\\x1b[31m\\n', expected 'mindlin'"),
    ("terminal_codes_in_a_name", text(tire={"file": "\x1b[31m"}), [],
     "key 'tire.file': is '\\x1b[31m', expected the name of a file"),
    ("terminal_codes_in_an_argument", json.dumps(SMALL), ["\x1b[31m"],
     "the argument '\\x1b[31m' holds a control character"),
    ("one_listed_wheel_outside", text(rig={"wheels": [{"start": -5}]}),
     [], "key 'rig.wheels.0.start': is -5 m, expected 0.467 to"),
    ("set_without_value", json.dumps(SMALL), ["--set", "rig.slip"],
     "key '--set': is 'rig.slip', expected the form key=value"),
    ("set_unknown", json.dumps(SMALL), ["--set", "rig.slpi=0.1"], "key 'rig.slpi': is unknown, expected 'rig.slip'?"),
    ("set_overflow", json.dumps(SMALL), ["--set", "rig.slip=1e400"], "key 'rig.slip': '1e400' is a number too large"),
    ("set_nan", json.dumps(SMALL), ["--set", "rig.slip=nan"], "key 'rig.slip': is 'nan', expected a number"),
    ("set_below_a_value", json.dumps(SMALL), ["--set", "rig.slip.x=1"], "key 'rig.slip.x': there is nothing below 0.3"),
    ("set_list_entry", json.dumps(SMALL), ["--set", "tires.0.file=x"], "key 'tires"),
    ("zero_threads", json.dumps(SMALL), ["--threads", "0"],
     "key 'run.threads': is 0, expected a whole number, 1 to 1024"),
    ("unknown_flag", json.dumps(SMALL), ["--fast"], "--fast"),
    ("missing_flag_value", json.dumps(SMALL), ["--out"], "--out"),
    ("two_scenarios", json.dumps(SMALL), ["other.json"], "other.json"),
    ("profile_that_goes_back", curb(profile=[[1, 0], [0, 1]]), [],
     "key 'terrain.profile.1.0': is 0 m, expected 1 m, as in the entry before, or more"),
    ("empty_profile", curb(profile=[]), [],
     "key 'terrain.profile': is [], expected a list of 1 to 100000 [x, z] in m or null"),
    ("profile_of_three_numbers", curb(profile=[[0, 0, 1]]), [],
     "key 'terrain.profile.0': is [0.0,0.0,1.0], expected a list of 2 entries"),
    ("profile_as_text", curb(profile="road.csv"), [],
     "key 'terrain.profile': is 'road.csv', expected a list of 1 to 100000 [x, z] in m or null"),
    ("profile_file_that_is_not_there", curb(),
     ["--set", "terrain.profile=null", "--set", "terrain.profile_file=road.csv"],
     "key 'terrain.profile_file': 'road.csv' does not exist, expected a file at one of"),
    ("profile_file_beside_a_profile", curb(), ["--set", "terrain.profile_file=road.csv"],
     "key 'terrain.profile_file': is given beside terrain.profile, expected one of them"),
    ("road_beside_a_profile", curb(), ["--set", "terrain.road_class=B"],
     "key 'terrain.road_class': is given beside terrain.profile, expected one of them"),
    ("road_of_no_class", curb(), ["--set", "terrain.profile=null", "--set", "terrain.road_class=J"],
     "key 'terrain.road_class': is 'J', expected 'A', 'B', 'C', 'D', 'E', 'F', 'G', 'H' or null"),
    ("road_without_length", curb(), ["--set", "terrain.road_length=0"], "key 'terrain.road_length': is 0"),
    ("road_on_grains", text(terrain={"road_class": "C"}), [],
     "key 'terrain.road_class': is a key of engine 'rigid', but terrain.engine is 'dem'"),
    ("profile_of_three_heights", curb(profile=[[0, 0], [0, 0.1], [0, 0.2]]),
     [], "key 'terrain.profile.2.0': is 0 m a third time, expected two entries at most"),
    ("profile_with_a_text", curb(profile=[[0, "high"]]), [], "key 'terrain.profile.0.1': is 'high', expected a number"),
    ("profile_on_grains", text(terrain={"profile": [[0, 0]]}), [],
     "key 'terrain.profile': is a key of engine 'rigid', but terrain.engine is 'dem'"),
    ("negative_body_mass", curb({"body_mass": -1}), [], "key 'rig.body_mass': is -1 kg, expected a number, above 0"),
    ("load_beside_body_mass", curb({"load": 100}), [],
     "key 'rig.load': is given beside 'rig.body_mass', expected one of the two"),
    ("slip_of_a_quarter_car", curb({"slip": 0.2}), [],
     "key 'rig.slip': is a key of type 'drawbar', but rig.type is 'quarter_car'"),
    ("wheels_of_a_quarter_car", curb({"wheels": [{}, {}]}), [],
     "key 'rig.wheels': is a key of type 'drawbar', but rig.type is 'quarter_car'"),
    ("camber_of_a_quarter_car", curb({"camber_angle": 0.1}), [],
     "key 'rig.camber_angle': is a key of type 'drawbar', but rig.type is 'quarter_car'"),
    ("negative_suspension", curb({"suspension_stiffness": -1}), [],
     "key 'rig.suspension_stiffness': is -1 N/m, expected a number, 0 to"),
    ("negative_unsprung_mass", curb({"unsprung_mass": -2}), [],
     "key 'rig.unsprung_mass': is -2 kg, expected a number, above 0"),
    ("backward_quarter_car", curb({"speed": -1}), [], "key 'rig.speed': is -1 m/s, expected a number, 0 to"),
    ("body_mass_of_a_drawbar_rig", text(rig={"body_mass": 300}), [],
     "key 'rig.body_mass': is a key of type 'half_car' or 'quarter_car', but rig.type is 'drawbar'"),
    ("half_car_without_wheelbase", half_car(wheelbase=0), [],
     "key 'rig.wheelbase': is 0 m, expected a number, above 0"),
    ("wheelbase_as_text", half_car(wheelbase="long"), [], "key 'rig.wheelbase': is 'long', expected a number"),
    ("half_car_on_its_front_wheel", half_car(front_share=1), [],
     "key 'rig.front_share': is 1, expected a number, above 0"),
    ("half_car_on_its_rear_wheel", half_car(front_share=0), [],
     "key 'rig.front_share': is 0, expected a number, above 0"),
    ("negative_pitch_inertia", half_car(pitch_inertia=-5), [],
     "key 'rig.pitch_inertia': is -5 kg m², expected a number, above 0"),
    ("negative_rear_spring", half_car(rear_suspension_stiffness=-1), [],
     "key 'rig.rear_suspension_stiffness': is -1 N/m, expected a number, 0 to"),
    ("negative_rear_damper", half_car(rear_suspension_damping=-1), [],
     "key 'rig.rear_suspension_damping': is -1 N s/m, expected a number, 0 to"),
    ("load_beside_body_mass_of_a_half_car", half_car(load=30e3), [],
     "key 'rig.load': is given beside 'rig.body_mass', expected one of the two"),
    ("half_car_lighter_than_its_wheels", half_car(body_mass=None, load=100),
     [], "key 'rig.load': is 100 N, expected above"),
    ("slip_of_a_half_car", half_car(slip=0.2), [],
     "key 'rig.slip': is a key of type 'drawbar', but rig.type is 'half_car'"),
    ("held_axle_of_a_half_car", half_car(hold_axle_from=1), [],
     "key 'rig.hold_axle_from': is a key of type 'cleat_stand', but rig.type is 'half_car'"),
    ("wheelbase_of_a_quarter_car", curb({"wheelbase": 2}), [],
     "key 'rig.wheelbase': is a key of type 'half_car', but rig.type is 'quarter_car'"),
    ("negative_time_of_the_stop", cleat_stand({"hold_axle_from": -1}),
     [], "key 'rig.hold_axle_from': is -1 s, expected a number, 0 to"),
    ("stop_of_a_drawbar_rig", text(rig={"hold_axle_from": 0.1}), [],
     "key 'rig.hold_axle_from': is a key of type 'cleat_stand', but rig.type is 'drawbar'"),
    ("load_beside_carrier_mass_of_a_cleat_stand", cleat_stand({"load": 4e3, "carrier_mass": 400}),
     [], "key 'rig.load': is given beside 'rig.carrier_mass', expected one of the two"),
    ("slip_of_a_cleat_stand", cleat_stand({"slip": 0.1}), [],
     "key 'rig.slip': is a key of type 'drawbar', but rig.type is 'cleat_stand'"),
    ("stop_after_the_end", cleat_stand({"hold_axle_from": 5}), [],
     "key 'rig.hold_axle_from': is 5 s, expected a time before the run ends"),
    ("stop_as_text", cleat_stand({"hold_axle_from": "soon"}), [],
     "key 'rig.hold_axle_from': is 'soon', expected a number"),
]


class BadScenario(SystemTest):
    """One test per row of SCENARIOS."""

    def check(self, content, flags, expected):
        path = self.folder / "in.json"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        begin = time.monotonic()
        done = furrow("run", "in.json", *flags, cwd=self.folder)
        wall = time.monotonic() - begin
        lines = [line for line in done.stderr.splitlines() if not line.startswith("furrow: warning: ")]
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertTrue(lines and all(line.startswith("furrow: error: ") for line in lines), done.stderr)
        self.assertIn(expected, lines[0])
        self.assertEqual(self.names(), ["in.json"], "left behind")
        self.assertLess(wall, LONGEST)


def add_test(name, content, flags, expected):
    setattr(BadScenario, "test_" + name, lambda self: self.check(content, flags, expected))


for row in SCENARIOS:
    add_test(*row)


# (name, rows of the bed's CSV after its header, what the error line must hold)
BEDS = [
    ("nan", "0.1,0,0.1\n0.3,0,nan", "bed.csv: key 'line 3': '0.3,0,nan', expected three finite numbers, m"),
    ("infinite", "0.1,0,1e999", "bed.csv: key 'line 2': '0.1,0,1e999', expected three finite numbers, m"),
    ("two_columns", "0.1,0", "bed.csv: key 'line 2': '0.1,0', expected three finite numbers, m"),
    ("words", "here,there,0.1", "key 'line 2': 'here,there,0.1', expected three finite numbers, m"),
    ("outside", "0.1,0,0.1\n1.5,0,0.1",
     "bed.csv: key 'line 3': the grain stands at (1.5, 0, 0.1) m, expected a centre inside the bin"),
    ("in_each_other", "0.1,0,0.1\n0.11,0,0.1",
     "key 'line 3': the grain at (0.11, 0, 0.1) m is 0.01 m from that of line 2, expected at least 0.054 m"),
    ("no_grain", "", "bed.csv: holds no grain"),
    ("in_the_sky", "0.1,0,0.1\n0.3,0,5000",
     "key 'line 3': the grain stands at (0.3, 0, 5000) m, 5000 m above all that is below it, "
     "expected at most 3 m, 100 radii"),
    ("terminal_codes", "\x1b[31m,0,0.1", "key 'line 2': '\\x1b[31m,0,0.1', expected three finite numbers, m"),
    ("one_long_line", "0" * 100000, "key 'line 2': is longer than 1023 bytes, expected a CSV file of positions"),
]


class BadBed(SystemTest):
    """One test per row of BEDS, for `run`, `bed` and `soil` alike."""

    def check(self, rows, expected):
        (self.folder / "bed.csv").write_text("x_m,y_m,z_m\n" + rows + "\n")
        path = write_scenario(self.folder, changed(terrain={"bed": "bed.csv"}))
        for command in ("run", "validate", "bed", "soil"):
            done = furrow(command, path, cwd=self.folder)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertEqual(done.stdout, "")
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertTrue(done.stderr.startswith("furrow: error: "), done.stderr)
            self.assertIn(expected, done.stderr)
        self.assertEqual(self.names(), ["bed.csv", "small.json"])


for row in BEDS:
    setattr(BadBed, "test_" + row[0], lambda self, row=row: self.check(*row[1:]))


class BadFile(SystemTest):
    def error_of(self, *arguments, cwd=None, code=2, **options):
        done = furrow(*arguments, cwd=cwd or self.folder, **options)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertEqual(done.stdout, "")
        lines = done.stderr.splitlines()
        self.assertEqual(len(lines), 1, done.stderr)
        self.assertTrue(lines[0].startswith("furrow: error: "), lines[0])
        return lines[0]

    def test_missing_scenario(self):
        self.assertIn("nowhere.json: does not exist, expected a scenario", self.error_of("run", "nowhere.json"))

    def test_folder_as_scenario(self):
        self.assertIn("is a directory, expected a scenario", self.error_of("run", self.folder))

    def test_device_as_scenario(self):
        self.assertIn("is not a regular file", self.error_of("run", "/dev/zero"))

    def test_tire_of_another_template(self):
        (self.folder / "tire.json").write_text('{"Name": "x", "Type": "Tire", "Template": "FialaTire"}')
        path = write_scenario(self.folder, changed(tire={"file": "tire.json"}))
        self.assertIn("FialaTire", self.error_of("run", path))
        self.assertEqual(self.names(), ["small.json", "tire.json"])

    def test_existing_output(self):
        path = write_scenario(self.folder)
        (self.folder / "out").mkdir()
        self.assertIn("out: key '--out': exists already, expected a new folder or --overwrite",
                      self.error_of("run", path, "--out", "out"))
        self.assertEqual(list((self.folder / "out").iterdir()), [])

    def test_overwriting_what_is_no_run(self):
        path = write_scenario(self.folder)
        (self.folder / "out").mkdir()
        (self.folder / "out" / "letter.txt").write_text("dear")
        self.assertIn("holds no run", self.error_of("run", path, "--out", "out", "--overwrite"))
        self.assertEqual((self.folder / "out" / "letter.txt").read_text(), "dear")

    def test_output_below_a_file(self):
        path = write_scenario(self.folder)
        self.assertIn("cannot be made", self.error_of("run", path, "--out", "small.json/out"))

    def test_unwritable_output(self):
        path = write_scenario(self.folder)
        self.assertIn("cannot be made", self.error_of("run", path, "--out", "/proc/furrow/out"))

    @unittest.skipIf(os.geteuid() == 0 and not shutil.which("setpriv"), "needs a user who is not root")
    def test_unwritable_working_folder(self):
        path = write_scenario(self.folder)
        closed = self.folder / "closed"
        closed.mkdir()
        os.chmod(self.folder, 0o755)
        os.chmod(closed, 0o555)
        command = [PROGRAM, "run", str(path)]
        if os.geteuid() == 0:
            command = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", *command]
        done = subprocess.run(command, cwd=closed, capture_output=True, text=True)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("furrow: error: results/small-001: key '--out': cannot be made (Permission denied)", done.stderr)
        self.assertEqual(list(closed.iterdir()), [])

    def test_several_mistakes_are_all_told(self):
        path = write_scenario(self.folder, changed(rig={"slipp": 1}, run={"step": -1}, terrain={"law": "x"}))
        done = furrow("run", path, cwd=self.folder)
        self.assertEqual(done.returncode, 2)
        self.assertEqual(len(done.stderr.splitlines()), 3, done.stderr)
        for key in ("rig.slipp", "run.step", "terrain.law"):
            self.assertIn(f"key '{key}'", done.stderr)

    def test_unknown_command(self):
        self.assertIn("unknown command 'rnu'; did you mean 'run'?", self.error_of("rnu"))

    def test_values_that_are_empty(self):
        for arguments, words in ((["run", "small.json", "--out=", "--overwrite"], "--out= has no value, expected one"),
                                 (["resume", "out", "--until", ""], "the value of --until is empty, expected one")):
            self.assertIn(words, self.error_of(*arguments))

    def test_no_command(self):
        self.assertIn("no command is given", self.error_of())

    def test_unknown_key_to_explain(self):
        self.assertIn("expected 'terrain.cohesion'?", self.error_of("explain", "terrain.cohesin"))

    def test_report_of_nothing(self):
        self.assertIn("does not exist", self.error_of("report", "nowhere"))
        self.assertIn("holds no run", self.error_of("report", self.folder))

    def test_header_of_a_bed(self):
        (self.folder / "bed.csv").write_text("x,y,z\n0.1,0,0.1\n")
        path = write_scenario(self.folder, changed(terrain={"bed": "bed.csv"}))
        self.assertIn("bed.csv: key 'line 1': 'x,y,z', expected the header x_m,y_m,z_m", self.error_of("bed", path))

    def test_damaged_bed(self):
        (self.folder / "bed.h5").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100))
        path = write_scenario(self.folder, changed(terrain={"bed": "bed.h5"}))
        self.assertIn("bed.h5: not an HDF5 file, or damaged", self.error_of("bed", path, code=5))

    def test_compaction_of_a_settled_bed(self):
        (self.folder / "bed.h5").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100))
        path = write_scenario(self.folder, changed(terrain={"bed": "bed.h5", "compaction_pressure": 1e4}))
        self.assertIn("small.json: key 'terrain.compaction_pressure': is 10000 Pa but the bed",
                      self.error_of("validate", path))

    def test_beds_and_soil_tests_need_grains(self):
        path = write_scenario(self.folder, {**changed(), "terrain": {"engine": "rigid"}})
        for command in ("bed", "soil"):
            self.assertIn("small.json: key 'terrain.engine': is 'rigid', expected 'dem' or 'liggghts'",
                          self.error_of(command, path))

    def test_keys_of_another_engine(self):
        path = write_scenario(self.folder,
                              {**changed(), "terrain": {"engine": "rigid", "friction": 0.5, "radius": 0.02}})
        self.assertIn("small.json: key 'terrain.radius': is a key of engine 'dem' or 'liggghts', but terrain.engine is "
                      "'rigid'",
                      self.error_of("validate", path))

    def test_soil_options(self):
        path = write_scenario(self.folder)
        self.assertIn("key '--only': is 'ring', expected plate, shear, cone or repose",
                      self.error_of("soil", path, "--only", "ring"))
        self.assertIn("key '--seeds': is 0, expected 1 to 100", self.error_of("soil", path, "--seeds", "0"))
        self.assertIn("key '--speed'", self.error_of("soil", path, "--speed", "nan"))
        (self.folder / "out").mkdir()
        self.assertIn("exists already", self.error_of("soil", path, "--out", "out"))
        self.assertEqual(self.names(), ["out", "small.json"])

    def test_report_with_soil_that_is_none(self):
        run = self.folder / "run"
        run.mkdir()
        (run / "scenario.json").write_text("{}")
        self.assertIn("run/summary.json: does not exist, expected",
                      self.error_of("report", "run", "--soil", "soil.json"))
        summary = {"format_version": 1, "tire_radius_m": 0.47, "tread_width_m": 0.25,
                   "vertical_load_N": 4600, "slip": 0.3}
        (run / "summary.json").write_text(json.dumps(summary))
        self.assertIn("soil.json: does not exist, expected", self.error_of("report", "run", "--soil", "soil.json"))
        (self.folder / "soil.json").write_text('{"format_version": 1, "k_c": null}')
        self.assertIn("soil.json: key 'k_c': is null, expected a number",
                      self.error_of("report", "run", "--soil", "soil.json"))
        (self.folder / "soil.json").write_text('{"format_version": 2}')
        self.assertIn("soil.json: key 'format_version': is 2: the file is newer",
                      self.error_of("report", "run", "--soil", "soil.json"))

    def test_a_text_file_as_bed_is_not_printed(self):
        (self.folder / "bed.csv").write_text("root:x:0:0:root:/root:/bin/bash and much more\n")
        path = write_scenario(self.folder, changed(terrain={"bed": "bed.csv"}))
        line = self.error_of("validate", path)
        self.assertIn("key 'line 1': 'root:x:0:0:root:/root:/bin/…', expected the header", line)

    def test_deep_files_of_every_kind(self):
        deep = '{"a": ' + "[" * 100000 + "]" * 100000 + "}"
        (self.folder / "deep.json").write_text(deep)
        tire = write_scenario(self.folder, changed(tire={"file": "deep.json"}), "tire.json")
        soil = write_scenario(self.folder, changed(terrain={"material": "deep.json"}), "soil.json")
        for arguments in (("sweep", "deep.json"), ("validate", tire), ("validate", soil), ("bed", "deep.json")):
            self.assertIn("deep.json:1:70: lists and objects are nested deeper than 64 levels",
                          self.error_of(*arguments))
        run = self.folder / "run"
        run.mkdir()
        (run / "scenario.json").write_text(deep)
        (run / "summary.json").write_text(deep)
        (run / ".furrow-run").write_text("furrow-run 1\nscenario.json\nsummary.json\n")
        self.assertIn("summary.json:1:70: lists and objects are nested",
                      self.error_of("report", "run", "--soil", "deep.json"))
        self.assertIn("scenario.json:1:70: lists and objects are nested", self.error_of("resume", "run"))

    def test_no_launcher(self):
        path = write_scenario(self.folder)
        line = self.error_of("run", path, code=5, env={"FURROW_MPIRUN": "/no/mpirun"})
        self.assertIn("FURROW_MPIRUN", line)
        self.assertEqual(self.names(), ["small.json"])

    def test_suspicious_magnitude_is_a_warning(self):
        path = write_scenario(self.folder, changed(tire={"pressure": 200}))
        done = furrow("validate", path, cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stderr,
                         r"^furrow: warning: .*small.json: key 'tire.pressure': 200 Pa is unusually small, usual is "
                         r".*: did you mean 200e3\?\n$")

    def test_a_warning_beside_an_error_is_told_as_one(self):
        path = write_scenario(self.folder, changed(tire={"pressure": 200}, terrain={"bed": "none.csv"}))
        done = furrow("run", path, cwd=self.folder)
        self.assertEqual(done.returncode, 2, done.stderr)
        kinds = [line.split(": ")[1] for line in done.stderr.splitlines()]
        self.assertEqual(kinds, ["warning", "error"], done.stderr)

    def test_a_tire_property_file_where_json_is_expected(self):
        for line in (self.error_of("validate", "hmmwv_handling.tir"), self.error_of("calibrate", "hmmwv_handling.tir"),
                     self.error_of("validate",
                                   write_scenario(self.folder, changed(terrain={"material": "hmmwv_handling.tir"})))):
            self.assertIn("hmmwv_handling.tir:1:2: is a tire property file, expected JSON", line)

    def test_wrong_rank_count_under_the_users_mpirun(self):
        path = write_scenario(self.folder)
        mpirun = shutil.which("mpirun")
        command = [mpirun, "-q", "--allow-run-as-root", "--oversubscribe", "-n", "2", PROGRAM, "run", str(path)]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 2, done.stderr)
        told = [line for line in done.stderr.splitlines() if line.startswith("furrow: error: ")]
        self.assertEqual(len(told), 1, done.stderr)
        self.assertIn("needs 3 ranks", told[0])
        self.assertIn("but 2 were started", told[0])
        self.assertEqual(self.names(), ["small.json"])

    def under_the_users_mpirun(self, **sections):
        path = write_scenario(self.folder, changed(**sections))
        command = [shutil.which("mpirun"), "-q", "--allow-run-as-root",
                   "--oversubscribe", "-n", "3", PROGRAM, "run", str(path)]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stderr.count("furrow: error: "), 1, done.stderr)
        return done

    def test_bad_scenario_under_the_users_mpirun_is_told_once(self):
        self.under_the_users_mpirun(rig={"slip": 7})

    def test_a_warning_beside_an_error_under_the_users_mpirun_is_told_once(self):
        done = self.under_the_users_mpirun(tire={"pressure": 200}, terrain={"bed": "none.csv"})
        self.assertEqual(done.stderr.count("furrow: warning: "), 1, done.stderr)


if __name__ == "__main__":
    main()
