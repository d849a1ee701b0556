#!/usr/bin/python3
"""Whatever is wrong with the input: exit code 2, one clear line per mistake, nothing left behind, within seconds."""
import json
import os
import shutil
import time
import unittest

from program import PROGRAM, SMALL, SystemTest, changed, main, message_of, with_keys, write_scenario

LONGEST = 5.0  # s
HARD_GROUND = {"format_version": 1, "tire": {"file": "aligator_planar.json"}, "terrain": {"engine": "rigid"}}
# Scenarios that are well but for what a row changes.
GOOD = {
    "small": SMALL,
    "empirical": {**SMALL, "terrain": {"engine": "scm"}},
    "quarter_car": {**HARD_GROUND, "rig": {"type": "quarter_car", "speed": 4.0, "body_mass": 1290},
                    "terrain": {"engine": "rigid", "profile": [[6, 0], [6, 0.2]]},
                    "run": {"step": 4e-5, "end": 2.6, "average_from": 2.3}},
    "half_car": {**HARD_GROUND, "rig": {"type": "half_car", "speed": 4.0, "body_mass": 2000},
                 "run": {"step": 4e-5, "end": 1.0}},
    "cleat_stand": {**HARD_GROUND, "rig": {"type": "cleat_stand"}, "run": {"step": 4e-5, "end": 1.0}},
}
# {scenario: [(keys that are changed, what the message of the first of them begins with)]}; after … the message holds
# the words without that key.
BAD = {
    "small": [
        ({"rig.slipp": 0.3}, "is unknown, expected 'rig.slip'?"),
        ({"terain": {"layers": 3}}, "is unknown, expected 'terrain'?"),
        ({"run.cohesion": 1e3}, "is unknown, expected 'terrain.cohesion'?"),
        ({"terrain.radius": -0.006}, "is -0.006 m, expected a number"),
        ({"terrain.radius": 6}, "is 6 m, expected a number"),
        ({"run.step": 0}, "is 0 s, expected a number"),
        ({"run.end": -1}, "is -1 s"),
        ({"rig.slip": 1.5}, "is 1.5, expected a number, -10 to 1"),
        ({"rig.slip": 1, "rig.mode": "fixed_speed"}, "is 1, expected below 1"),
        ({"rig.toe_angle": 2}, "is 2 rad"),
        ({"rig.camber_angle": 3}, "is 3 rad"),
        ({"rig.slip": "much"}, "is 'much', expected a number"),
        ({"rig.slip": None}, "is null, expected a number"),
        ({"rig.mode": 3}, "is 3, expected 'fixed_angular_speed'"),
        ({"terrain.layers": 2.5}, "is 2.5, expected a whole number"),
        ({"rig": 3}, "is 3, expected an object"),
        ({"terrain.law": "hertz"}, "is 'hertz', expected 'mindlin' or 'hertz_tanh'"),
        ({"terrain.activity": False, "terrain.engine": "liggghts"},
         "is a key of engine 'dem', but terrain.engine is 'liggghts'"),
        ({"terrain.ranks": 2}, "is 2, expected 1"),
        ({"vehicle": {"file": "hmmwv"}, "rig": ...},
         "is not a section, expected rig.vehicle beside rig.type 'vehicle'"),
        ({"format_version": 2}, "is 2: the file is newer than this program"),
        ({"tire": ...}, "is missing"),
        ({"tire.file": ..., "tire.rigid": ...}, "is missing"),
        ({"rig.wheels": [{}, {}]},
         "… key 'rig.wheels.1.start': puts this wheel in the way of wheel 0, expected 0.93 m"),
        ({"rig.wheels": [{"lateral": 0.2}]}, "… key 'terrain.width': is 0.4 m, expected at least"),
        ({"rig.wheels": [{"ballast": 3}]}, "… key 'rig.wheels.0.ballast': is unknown"),
        ({"tires": [SMALL["tire"]] * 2, "tire": ...}, "has 2 entries, expected 1: one per wheel"),
        ({"tires": [SMALL["tire"]]}, "is given beside 'tire'"),
        ({"tire.file": "no_such_tire.json"}, "'no_such_tire.json' does not exist, expected a file at one of"),
        ({"tire.file": "hmmwv_layerd.json"}, "… ; did you mean 'hmmwv_layered.json'?"),
        ({"tire.file": "hmmwv_layered"}, "… ; did you mean 'hmmwv_layered.json'?"),
        ({"tire.file": "dry_sand.json"}, "… dry_sand.json: is a soil, expected a tire (the key terrain.material"),
        ({"tire.file": "hmmwv.json"}, "… hmmwv.json: is a vehicle, expected a tire (the key rig.vehicle"),
        ({"terrain.material": "hmmwv_lumped.json"},
         "… hmmwv_lumped.json: is a tire, expected a soil (the key tire.file"),
        ({"tire.file": "/usr"}, "'/usr' is not a regular file"),
        ({"tire.file": "first_look.json"}, "… first_look.json"),
        ({"run.step": 2e-3}, "0.002 s is above the stable step of"),
        ({"terrain.width": 0.3}, "is 0.3 m, expected at least"),
        ({"terrain.length": 0.9}, "is 0.9 m, expected at least"),
        ({"terrain.layers": 0}, "is 0, expected a whole number, 1 to 9999"),
        ({"run.end": 5, "run.average_from": 1}, "… it would hit the end wall"),
        ({"rig.start": 0.1}, "is 0.1 m, expected 0.467 to"),
        ({"run.average_from": 0.05}, "is 0.05 s, expected"),
        ({"run.threads": "many"}, "is 'many', expected a whole number, 1 to 1024 or 'auto'"),
        ({"terrain.bed_generator": "hex"}, "is 'hex', expected 'poisson' or 'lattice'"),
        ({"terrain.compaction_pressure": -5}, "is -5 Pa, expected a number, 0 to"),
        ({"terrain.material": "lete_sand.json"}, "… key 'terrain': has keys of other engines alone (bekker_k_c,"),
        ({"terrain.material": "moon.json"}, "'moon.json' does not exist, expected a file at one of"),
        ({"terrain.size_spread": 0.9}, "is 0.9, expected a number, 0 to 0.6"),
        ({"terrain.size_spread": 0.2, "terrain.law": "hertz_tanh"}, "is 0.2 with law 'hertz_tanh'"),
        ({"terrain.bed": "bed.h5"}, "'bed.h5' does not exist"),
        ({"terrain.law": "\x1b[31m\n"}, "is '\\x1b[31m\\n', expected 'mindlin'"),
        ({"tire.file": "\x1b[31m"}, "is '\\x1b[31m', expected the name of a file"),
        ({"rig.wheels": [{"start": -5}]}, "… key 'rig.wheels.0.start': is -5 m, expected 0.467 to"),
        ({"terrain.road_class": "C"}, "is a key of engine 'rigid', but terrain.engine is 'dem'"),
        ({"terrain.profile": [[0, 0]]}, "is a key of engine 'rigid', but terrain.engine is 'dem'"),
        ({"rig.body_mass": 300}, "is a key of type 'half_car' or 'quarter_car', but rig.type is 'drawbar'"),
        ({"rig.hold_axle_from": 0.1}, "is a key of type 'cleat_stand', but rig.type is 'drawbar'"),
    ],
    "empirical": [
        ({"terrain.bekker_k_phi": 0}, "is 0 N/m^(n+2), expected a number"),
        ({"terrain.bekker_k_c": -9e4, "terrain.patch_width": 0.01},
         "is -90000, expected k_c/b + k_phi above 0 with b = terrain.patch_width"),
        ({"terrain.mohr_friction_angle": 95}, "is 95 deg, expected a number, 0 to 80"),
        ({"terrain.radius": 0.01}, "is a key of engine 'dem' or 'liggghts'"),
        ({"terrain.grid_spacing": 0.2, "terrain.length": 2.0, "terrain.width": 1.0}, "is 0.2 m, expected at most "),
        ({"terrain.bekker_k_c": -3e5, "terrain.bekker_k_phi": 3e5}, "is -300000, expected above "),
        ({"terrain.grid_spacing": 0.001, "terrain.length": 200, "terrain.width": 50},
         "is 0.001: 200 m x 50 m have 1e+10 nodes, expected at most 1e+08"),
    ],
    "quarter_car": [
        ({"terrain.profile": [[1, 0], [0, 1]]},
         "… key 'terrain.profile.1.0': is 0 m, expected 1 m, as in the entry before, or more"),
        ({"terrain.profile": []}, "is [], expected a list of 1 to 100000 [x, z] in m or null"),
        ({"terrain.profile": [[0, 0, 1]]}, "… key 'terrain.profile.0': is [0.0,0.0,1.0], expected a list of 2 entries"),
        ({"terrain.profile": "road.csv"}, "is 'road.csv', expected a list of 1 to 100000 [x, z] in m or null"),
        ({"terrain.profile": [[0, 0], [0, 0.1], [0, 0.2]]},
         "… key 'terrain.profile.2.0': is 0 m a third time, expected two entries at most"),
        ({"terrain.profile": [[0, "high"]]}, "… key 'terrain.profile.0.1': is 'high', expected a number"),
        ({"rig.body_mass": -1}, "is -1 kg, expected a number, above 0"),
        ({"rig.load": 100}, "is given beside 'rig.body_mass', expected one of the two"),
        ({"rig.slip": 0.2}, "is a key of type 'drawbar', but rig.type is 'quarter_car'"),
        ({"rig.wheels": [{}, {}]}, "is a key of type 'drawbar', but rig.type is 'quarter_car'"),
        ({"rig.camber_angle": 0.1}, "is a key of type 'drawbar', but rig.type is 'quarter_car'"),
        ({"rig.suspension_stiffness": -1}, "is -1 N/m, expected a number, 0 to"),
        ({"rig.unsprung_mass": -2}, "is -2 kg, expected a number, above 0"),
        ({"rig.speed": -1}, "is -1 m/s, expected a number, 0 to"),
        ({"rig.wheelbase": 2}, "is a key of type 'half_car', but rig.type is 'quarter_car'"),
    ],
    "half_car": [
        ({"rig.wheelbase": 0}, "is 0 m, expected a number, above 0"),
        ({"rig.wheelbase": "long"}, "is 'long', expected a number"),
        ({"rig.front_share": 1}, "is 1, expected a number, above 0"),
        ({"rig.front_share": 0}, "is 0, expected a number, above 0"),
        ({"rig.pitch_inertia": -5}, "is -5 kg m², expected a number, above 0"),
        ({"rig.rear_suspension_stiffness": -1}, "is -1 N/m, expected a number, 0 to"),
        ({"rig.rear_suspension_damping": -1}, "is -1 N s/m, expected a number, 0 to"),
        ({"rig.load": 3e4}, "is given beside 'rig.body_mass', expected one of the two"),
        ({"rig.load": 100, "rig.body_mass": None}, "is 100 N, expected above"),
        ({"rig.slip": 0.2}, "is a key of type 'drawbar', but rig.type is 'half_car'"),
        ({"rig.hold_axle_from": 1}, "is a key of type 'cleat_stand', but rig.type is 'half_car'"),
    ],
    "cleat_stand": [
        ({"rig.hold_axle_from": -1}, "is -1 s, expected a number, 0 to"),
        ({"rig.load": 4e3, "rig.carrier_mass": 400}, "is given beside 'rig.carrier_mass', expected one of the two"),
        ({"rig.slip": 0.1}, "is a key of type 'drawbar', but rig.type is 'cleat_stand'"),
        ({"rig.hold_axle_from": 5}, "is 5 s, expected a time before the run ends"),
        ({"rig.hold_axle_from": "soon"}, "is 'soon', expected a number"),
    ],
}

# (arguments after the scenario "small", what the error line must hold)
FLAGS = [
    (["--set", "tire.pressure=" + "[" * 50000 + "]" * 50000],
     "key 'tire.pressure': lists and objects are nested deeper than 64 levels"),
    (["--set", ".".join("a" * 50000) + "=1"], "': is not a key, expected --set section.key=value"),
    (["\x1b[31m"], "the argument '\\x1b[31m' holds a control character"),
    (["--set", "rig.slip"], "key '--set': is 'rig.slip', expected the form key=value"),
    (["--set", "rig.slpi=0.1"], "key 'rig.slpi': is unknown, expected 'rig.slip'?"),
    (["--set", "rig.slip=1e400"], "key 'rig.slip': '1e400' is a number too large"),
    (["--set", "rig.slip=nan"], "key 'rig.slip': is 'nan', expected a number"),
    (["--set", "rig.slip.x=1"], "key 'rig.slip.x': there is nothing below 0.3"),
    (["--set", "tires.0.file=x"], "key 'tires"),
    (["--threads", "0"], "key 'run.threads': is 0, expected a whole number, 1 to 1024"),
    (["--fast"], "--fast"), (["--out"], "--out"), (["other.json"], "other.json"),
]
# The same after the quarter car.
ROADS = [
    (["--set", "terrain.profile=null", "--set", "terrain.profile_file=road.csv"],
     "key 'terrain.profile_file': 'road.csv' does not exist, expected a file at one of"),
    (["--set", "terrain.profile_file=road.csv"],
     "key 'terrain.profile_file': is given beside terrain.profile, expected one of them"),
    (["--set", "terrain.road_class=B"],
     "key 'terrain.road_class': is given beside terrain.profile, expected one of them"),
    (["--set", "terrain.profile=null", "--set", "terrain.road_class=J"],
     "key 'terrain.road_class': is 'J', expected 'A', 'B', 'C', 'D', 'E', 'F', 'G', 'H' or null"),
    (["--set", "terrain.road_length=0"], "key 'terrain.road_length': is 0"),
]
TEXT, DEEP = json.dumps(SMALL), "[" * 100000 + "]" * 100000
# (text of a scenario, what the error line must hold)
TEXTS = [
    (TEXT.replace("0.3", "NaN", 1), "is not valid JSON"),
    (TEXT.replace("0.3", "1e400", 1), "key 'rig.slip': is a number too large for a double"),
    ('{"rig": {"slip": 0.1, "slip": 0.2}}', "key 'rig.slip': is given twice"),
    ("", "is empty, expected a scenario in JSON"),
    (" \n\n", "is empty, expected a scenario in JSON"),
    (b'{"description": "caf\xe9"}', ":1:21: byte 0xe9 is not UTF-8"),
    ('{\n  "rig": {}\n  "run": {}\n}', ":3:"),
    (TEXT[:-20], "is not valid JSON"),
    ("[1, 2]", "is [1,2], expected an object"),
    ("# a comment\n{}", ":1:1: is a comment of another language, expected // or /* */"),
    (DEEP, "in.json:1:65: lists and objects are nested deeper than 64 levels"),
    (TEXT[:-1] + f', "description": {DEEP}}}', "nested deeper than 64 levels"),
    ('{"\\u001b]0;owned\\u0007": 1}', "key '\\x1b]0;owned\\x07': has a control character"),
]


class BadScenario(SystemTest):
    def refused(self, content, expected, flags=()):
        path = self.folder / "in.json"
        with self.subTest(expected):
            path.write_bytes(content if isinstance(content, bytes) else content.encode())
            begin = time.monotonic()
            done = self.furrow("run", "in.json", *flags, code=2, prints="")
            self.assertLess(time.monotonic() - begin, LONGEST)
            lines = [line for line in done.stderr.splitlines() if not line.startswith("furrow: warning: ")]
            self.assertTrue(lines and all(line.startswith("furrow: error: ") for line in lines), done.stderr)
            self.assertIn(expected, lines[0])
            self.assertEqual(self.names(), ["in.json"], "left behind")

    def test_keys_that_are_wrong(self):
        for name, rows in BAD.items():
            for changes, words in rows:
                self.refused(json.dumps(with_keys(GOOD[name], changes)), message_of(changes, words))

    def test_texts_that_are_no_scenarios(self):
        for text, words in TEXTS:
            self.refused(text, words)

    def test_arguments_that_are_wrong(self):
        for name, rows in (("small", FLAGS), ("quarter_car", ROADS)):
            for flags, words in rows:
                self.refused(json.dumps(GOOD[name]), words, flags)


# (name, rows of the bed's CSV after its header, what the error line must hold)
BEDS = [
    ("nan", "0.1,0,0.1\n0.3,0,nan", "bed.csv: key 'line 3': '0.3,0,nan', expected three finite numbers, m"),
    ("words", "here,there,0.1", "key 'line 2': 'here,there,0.1', expected three finite numbers, m"),
    ("in_each_other", "0.1,0,0.1\n0.11,0,0.1",
     "key 'line 3': the grain at (0.11, 0, 0.1) m is 0.01 m from that of line 2, expected at least 0.054 m"),
    ("no_grain", "", "bed.csv: holds no grain"),
]


class BadBed(SystemTest):
    """For `run`, `bed` and `soil` alike. All that may be wrong with a bed: tests/terrain/bed_preparation_test.cpp."""

    def test_beds_that_are_none(self):
        path = write_scenario(self.folder, changed(terrain={"bed": "bed.csv"}))
        for name, rows, expected in BEDS:
            (self.folder / "bed.csv").write_text("x_m,y_m,z_m\n" + rows + "\n")
            for command in ("run", "validate", "bed", "soil"):
                with self.subTest(name, command=command):
                    done = self.furrow(command, path, code=2, prints="", says=expected, matches="^furrow: error: ")
                    self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertEqual(self.names(), ["bed.csv", "small.json"])


# (arguments of the program, what its only line holds) beside the scenario small.json and the files of FILES
FILES = {
    "tire.json": '{"Name": "x", "Type": "Tire", "Template": "FialaTire"}',
    "header.csv": "x,y,z\n0.1,0,0.1\n",
    "secret.csv": "root:x:0:0:root:/root:/bin/bash and much more\n",
    "bed.h5": b"\x89HDF\r\n\x1a\n" + bytes(100),
    "deep.json": '{"a": ' + DEEP + "}",
    "out/letter.txt": "dear",
    "run/scenario.json": "{}",
    "ended/scenario.json": "{}",
    "ended/summary.json": json.dumps({"format_version": 1, "tire_radius_m": 0.47, "tread_width_m": 0.25,
                                      "vertical_load_N": 4600, "slip": 0.3}),
    "no_value.json": '{"format_version": 1, "k_c": null}',
    "newer.json": '{"format_version": 2}',
    "deep/scenario.json": '{"a": ' + DEEP + "}",
    "deep/summary.json": '{"a": ' + DEEP + "}",
    "deep/.furrow-run": "furrow-run 1\nscenario.json\nsummary.json\n",
    "rigid.json": json.dumps({**SMALL, "terrain": {"engine": "rigid"}}),
    "of_dem.json": json.dumps({**SMALL, "terrain": {"engine": "rigid", "friction": 0.5, "radius": 0.02}}),
}
TOO_DEEP = "deep.json:1:70: lists and objects are nested deeper than 64 levels"
SOIL = "soil", "small.json"
LINES = [
    (("run", "nowhere.json"), "nowhere.json: does not exist, expected a scenario"),
    (("run", "out"), "is a directory, expected a scenario"),
    (("run", "/dev/zero"), "is not a regular file"),
    (("run", "small.json", "--set", "tire.file=tire.json"), "FialaTire"),
    (("run", "small.json", "--out", "out"), "out: key '--out': exists already, expected a new folder or --overwrite"),
    (("run", "small.json", "--out", "out", "--overwrite"), "holds no run"),
    (("run", "small.json", "--out", "small.json/out"), "cannot be made"),
    (("run", "small.json", "--out", "/proc/furrow/out"), "cannot be made"),
    (("rnu",), "unknown command 'rnu'; did you mean 'run'?"),
    (("run", "small.json", "--out=", "--overwrite"), "--out= has no value, expected one"),
    (("resume", "out", "--until", ""), "the value of --until is empty, expected one"),
    ((), "no command is given"),
    (("explain", "terrain.cohesin"), "expected 'terrain.cohesion'?"),
    (("report", "nowhere"), "does not exist"),
    (("report", "."), "holds no run"),
    (("bed", "small.json", "--set", "terrain.bed=header.csv"),
     "header.csv: key 'line 1': 'x,y,z', expected the header x_m,y_m,z_m"),
    (("validate", "small.json", "--set", "terrain.bed=secret.csv"),
     "key 'line 1': 'root:x:0:0:root:/root:/bin/…', expected the header"),
    (("bed", "small.json", "--set", "terrain.bed=bed.h5"), "bed.h5: not an HDF5 file, or damaged"),
    (("validate", "small.json", "--set", "terrain.bed=bed.h5", "--set", "terrain.compaction_pressure=1e4"),
     "small.json: key 'terrain.compaction_pressure': is 10000 Pa but the bed"),
    (("bed", "rigid.json"), "rigid.json: key 'terrain.engine': is 'rigid', expected 'dem' or 'liggghts'"),
    (("soil", "rigid.json"), "rigid.json: key 'terrain.engine': is 'rigid', expected 'dem' or 'liggghts'"),
    (("validate", "of_dem.json"), "of_dem.json: key 'terrain.radius': is a key of engine 'dem' or 'liggghts', but "
                                  "terrain.engine is 'rigid'"),
    ((*SOIL, "--only", "ring"), "key '--only': is 'ring', expected plate, shear, cone, repose or interface"),
    ((*SOIL, "--seeds", "0"), "key '--seeds': is 0, expected 1 to 100"),
    ((*SOIL, "--speed", "nan"), "key '--speed'"),
    ((*SOIL, "--out", "out"), "exists already"),
    (("sweep", "deep.json"), TOO_DEEP), (("bed", "deep.json"), TOO_DEEP),
    (("validate", "small.json", "--set", "tire.file=deep.json"), TOO_DEEP),
    (("validate", "small.json", "--set", "terrain.material=deep.json"), TOO_DEEP),
    (("report", "run", "--soil", "soil.json"), "run/summary.json: does not exist, expected"),
    (("report", "ended", "--soil", "soil.json"), "soil.json: does not exist, expected"),
    (("report", "ended", "--soil", "no_value.json"), "no_value.json: key 'k_c': is null, expected a number"),
    (("report", "ended", "--soil", "newer.json"), "newer.json: key 'format_version': is 2: the file is newer"),
    (("report", "deep", "--soil", "deep.json"), "summary.json:1:70: lists and objects are nested"),
    (("resume", "deep"), "scenario.json:1:70: lists and objects are nested"),
    (("validate", "hmmwv_handling.tir"), "hmmwv_handling.tir:1:2: is a tire property file, expected JSON"),
    (("calibrate", "hmmwv_handling.tir"), "hmmwv_handling.tir:1:2: is a tire property file, expected JSON"),
    (("validate", "small.json", "--set", "terrain.material=hmmwv_handling.tir"),
     "hmmwv_handling.tir:1:2: is a tire property file, expected JSON"),
]


class BadFile(SystemTest):
    def error_of(self, *arguments, code=2, **options):
        done = self.furrow(*arguments, code=code, prints="", matches="^furrow: error: ", **options)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        return done.stderr

    def test_one_line_for_each_and_nothing_is_changed(self):
        write_scenario(self.folder)
        for name, content in FILES.items():
            (self.folder / name).parent.mkdir(exist_ok=True)
            (self.folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        contents = lambda: {(path, path.read_bytes()) for path in self.folder.rglob("*")
                            if path.is_file() and path.name != ".furrow-run"}
        before = contents()
        for arguments, words in LINES:
            with self.subTest(arguments):
                self.assertIn(words, self.error_of(*arguments, code=5 if "damaged" in words else 2))
                self.assertEqual([path for path, _ in contents() ^ before], [])

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
        self.call(command, cwd=closed, code=2,
                  says="furrow: error: results/small-001: key '--out': cannot be made (Permission denied)")
        self.assertEqual(list(closed.iterdir()), [])

    def test_several_mistakes_are_all_told(self):
        path = write_scenario(self.folder, changed(rig={"slipp": 1}, run={"step": -1}, terrain={"law": "x"}))
        done = self.furrow("run", path, code=2, says=("key 'rig.slipp'", "key 'run.step'", "key 'terrain.law'"))
        self.assertEqual(len(done.stderr.splitlines()), 3, done.stderr)

    def test_no_launcher(self):
        path = write_scenario(self.folder)
        line = self.error_of("run", path, code=5, env={"FURROW_MPIRUN": "/no/mpirun"})
        self.assertIn("FURROW_MPIRUN", line)
        self.assertEqual(self.names(), ["small.json"])

    def test_suspicious_magnitude_is_a_warning(self):
        path = write_scenario(self.folder, changed(tire={"pressure": 200}))
        self.furrow("validate", path, matches=r"^furrow: warning: .*small.json: key 'tire.pressure': 200 Pa is "
                    r"unusually small, usual is .*: did you mean 200e3 \(kPa\) or 1.379e6 \(psi\)\?\n$")

    def test_a_warning_beside_an_error_is_told_as_one(self):
        path = write_scenario(self.folder, changed(tire={"pressure": 200}, terrain={"bed": "none.csv"}))
        done = self.furrow("run", path, code=2)
        kinds = [line.split(": ")[1] for line in done.stderr.splitlines()]
        self.assertEqual(kinds, ["warning", "error"], done.stderr)

    def under_the_users_mpirun(self, count, **sections):
        """What standard error holds: one error, told once."""
        command = [shutil.which("mpirun"), "--allow-run-as-root", "--oversubscribe", "-n", str(count), PROGRAM,
                   "run", write_scenario(self.folder, changed(**sections))]
        done = self.call(command, code=2, errors=1)
        self.assertEqual(self.names(), ["small.json"])
        return done.stderr

    def test_mistakes_under_the_users_mpirun_are_told_once(self):
        self.assertRegex(self.under_the_users_mpirun(2), "needs 3 ranks.*but 2 were started")
        self.under_the_users_mpirun(3, rig={"slip": 7})
        told = self.under_the_users_mpirun(3, tire={"pressure": 200}, terrain={"bed": "none.csv"})
        self.assertEqual(told.count("furrow: warning: "), 1, told)


if __name__ == "__main__":
    main()
