#!/usr/bin/python3
"""The commands that start nothing: validate, ranks, explain, --help, --version."""
import json
import os
import re

from program import ROOT, SMALL, SystemTest, changed, furrow, main, on_terminal, read_json, write_json, write_scenario

# for `furrow sweep`
STUDIES = ("study_slip.json", "study_slip_angle.json", "study_camber.json",
           "study_hard_slip.json", "study_handling.json", "multipass.json")
CALIBRATIONS = sorted(path.name for path in (ROOT / "rigs").glob("calibrate_*.json"))  # for `furrow calibrate`
SHIPPED = sorted(path.name for path in (ROOT / "rigs").glob("*.json")
                 if path.name not in ("scenario.schema.json", *STUDIES, *CALIBRATIONS))

SCHEMAS = {"scenario": "rigs/scenario.schema.json", "tire": "tire/data/tire.schema.json",
           "vehicle": "vehicle/data/vehicle.schema.json", "driver": "vehicle/driver/driver.schema.json"}


class Commands(SystemTest):
    def output(self, *arguments):
        return self.furrow(*arguments).stdout

    def test_version(self):
        self.assertRegex(self.output("--version"), r"^furrow \d+\.\d+\.\d+\n$")

    def test_help_names_every_command(self):
        text = self.output("--help")
        for command in ("run", "validate", "ranks", "explain", "report", "events", "bed", "soil"):
            self.assertIn(command, text)
            self.assertIn("SCENARIO" if command in ("run", "validate", "ranks", "bed", "soil") else "KEY" if command
                          == "explain" else "DIR", self.output(command, "--help"))

    def test_examples_in_the_help_name_options_and_files_that_there_are(self):
        commands = re.findall(r"^  (\w+)  ", self.output("--help"), re.MULTILINE)
        self.assertIn("calibrate", commands)
        shipped = [name for kind in json.loads(self.output("list", "--json")).values() for name in kind["files"]]
        for command in [*[name for name in commands if name != "bench"], "bench grains", "bench tire", "bench rig"]:
            help_text = self.output(*command.split(), "--help")
            options, examples = help_text.split("Examples:\n")
            lines = re.findall(r"^  (furrow .*?)  +\S", examples, re.MULTILINE)
            self.assertGreater(len(lines), 0, command)
            for line in lines:
                with self.subTest(line):
                    self.assertTrue(line.startswith(f"furrow {command}"))
                    for option in re.findall(r"--[\w-]+", line):
                        self.assertRegex(options, rf"{option}\b")
                    for name in re.findall(r"\S+\.json", line):
                        self.assertTrue(name in shipped or name in ("mine.json", "my_tire.json"), name)

    def test_texts_for_people_are_as_wide_as_the_terminal_and_no_wider_than_120_columns(self):
        for command in (*re.findall(r"^  ([a-z]+) {3,}", self.output("--help"), re.MULTILINE),
                        "bench grains", "bench tire", "bench rig", ""):
            for line in self.output(*command.split(), "--help").splitlines():
                self.assertLessEqual(len(line), 120, command)
        for arguments in (["press", "--help"], ["explain"], ["explain", "terrain.bed"],
                          ["list"], ["validate", "first_look.json"],
                          ["validate", "calibrate_handling.json"]):
            with self.subTest(arguments):
                code, text = on_terminal(*arguments, cwd=self.folder, columns=90)
                self.assertEqual(code, 0, text)
                words = text.replace("\r", "").split()
                self.assertLessEqual(max(len(line) for line in text.splitlines() if len(line.split()) > 1), 90)
                if arguments[0] != "validate":  # whose times differ
                    self.assertEqual(words, self.output(*arguments).split())
        self.assertRegex(on_terminal("list", "scenarios", cwd=self.folder, columns=90)[1],
                         r"\n  half_car\.json              Ride: .*\n {29}\S")

    def test_shipped_scenarios_are_valid(self):
        self.assertIn("first_look.json", SHIPPED)
        for name in SHIPPED:
            with self.subTest(name):
                report = json.loads(self.output("validate", ROOT / "rigs" / name, "--json"))
                self.assertEqual(report["scenario"], name[:-5])
                self.assertGreater(report["steps"], 0)
                counts = {"rover": 6, "hmmwv": 4, "four_wheels": 4, "half_car": 2}
                tires = next((count for car, count in counts.items() if name.startswith(car)), 1)
                self.assertEqual([rank["node"] for rank in report["ranks"]],
                                 ["rig", *(f"tire {k}" for k in range(tires)), "terrain"])
                if not name.endswith("_tr.json"):
                    self.assertEqual(report["warnings"], [])
                    if report["stable_step_s"] is not None:
                        self.assertLess(report["terrain_step_s"], report["stable_step_s"])

    def test_full_size_is_that_of_the_report(self):
        # 382,500 grains and 13,500 coordinates in the report; our layers hold 1 % fewer grains.
        report = json.loads(self.output("validate", ROOT / "rigs" / "drawbar_pull.json", "--json"))
        self.assertAlmostEqual(report["grains"], 382500, delta=0.02 * 382500)
        self.assertEqual(report["tire_coordinates"], 13500)
        self.assertAlmostEqual(report["tire_mass_kg"][0], 4.8, delta=0.2)

    def test_validate_tells_people(self):
        text = self.output("validate", write_scenario(self.folder))
        for word in ("of the stable", "grains", "coordinates" if "layered" not in text else "radius", "memory", "disk",
                     "terrain", "load         4609 N", "sinkage", "Froude number",
                     "bound by     terrain.radius: the contact is about"):
            self.assertIn(word, text)

    def test_a_wheel_of_a_laboratory_is_bound_by_nothing(self):
        report = json.loads(self.output("validate", ROOT / "rigs" / "small_wheel.json", "--json"))
        self.assertEqual(report["bound_by"], [])
        self.assertAlmostEqual(report["wheels"][0]["load_N"], 24.5)

    def test_shipped_scenarios_are_found_by_their_names(self):
        self.assertIn("first_look.json", self.output("validate", "first_look.json"))
        write_json(self.folder / "first_look.json", changed(run={"end": 0.04}))
        self.assertIn("0.04 s in 400 steps", self.output("validate", "first_look.json"),
                      "a file that is here comes first")

    def test_shipped_files_are_found_by_name_and_taken_for_what_they_are(self):
        for arguments, expected in (
                (("run", "first_look"), "first_look: does not exist, expected 'first_look.json'?"),
                (("validate", "frist_look.json"), "frist_look.json: does not exist, expected 'first_look.json'?"),
                (("sweep", "study_slop.json"), "study_slop.json: does not exist, expected 'study_slip.json'?"),
                (("run", "nothing_like_it.json"), "does not exist, expected a scenario in JSON"),
                (("run", "calibrate_ring.json"),
                 "is a calibration, expected a scenario ('furrow calibrate' takes calibrations)"),
                (("sweep", "calibrate_ring.json"),
                 "is a calibration, expected a study ('furrow calibrate' takes calibrations)"),
                (("calibrate", "study_slip.json"), "is a study, expected a calibration ('furrow sweep' takes studies)"),
                (("sweep", "first_look.json"), "is a scenario, expected a study")):
            self.furrow(*arguments, code=2, says=expected)
        self.assertEqual(self.names(), [])

    def test_list_names_what_comes_with_the_program(self):
        listed = json.loads(self.output("list", "--json"))
        self.assertEqual(sorted(listed["scenarios"]["files"]), SHIPPED)
        self.assertEqual(sorted(listed["studies"]["files"]), sorted(STUDIES))
        self.assertEqual(sorted(listed["calibrations"]["files"]), CALIBRATIONS)
        for kind, folder in (("tires", "tire/data"), ("soils", "terrain/data"), ("vehicles", "vehicle/data")):
            there = {path.name for path in (ROOT / folder).glob("*.json") if not path.name.endswith(".schema.json")}
            self.assertEqual(set(listed[kind]["files"]), there)
        self.assertNotIn("", [line for kind in listed.values() for line in kind["files"].values()],
                         "each says what it is")
        self.assertTrue(listed["soils"]["files"]["dry_sand.json"].endswith("Wiley 2008"), "an initial ends no sentence")
        self.assertEqual(list(json.loads(self.output("list", "soils", "--json"))), ["soils"])
        self.assertIn("first_look.json", self.output("list", "scenarios"))
        self.furrow("list", "wheels", code=2, says="KIND': is 'wheels', expected one of 'scenarios', ")

    def test_new_scenarios_are_valid_and_fit_their_tires(self):
        reports = {}
        for name, options in (("truck", []), ("lab", ["--tire", "rigid_drum.json",
                                                      "--rigid", "--soil", "loose_sand.json", "--load", "24.5"]),
                              ("car", ["--tire", "passenger_205_55r16.json"]),
                              ("six_wheels", ["--vehicle", "rover.json"])):
            with self.subTest(name):
                self.assertEqual(self.output("new", name, *options), f"{name}.json\n")
                report = reports[name] = json.loads(self.output("validate", f"{name}.json", "--json"))
                self.assertLess(report["terrain_step_s"], report["stable_step_s"])
                self.assertLess(report["grains"], 300_000)
                self.assertGreater(report["wheels"][0]["contact_length_in_grains"], 2)
        self.assertAlmostEqual(reports["lab"]["wheels"][0]["load_N"], 24.5)
        self.assertIn("// Kind of rig. cleat_stand: rolls", (self.folder / "truck.json").read_text())
        self.assertIn("// Grain radius", (self.folder / "truck.json").read_text())

    def test_new_scenarios_have_the_ground_that_tire_and_soil_ask_for(self):
        for options, engine in ((["--tire", "hmmwv_handling.json"], "rigid"), (["--soil", "lete_sand.json"], "scm"),
                                (["--soil", "cohesive_sand.json"], "dem"), (["--tire", "hmmwv_ring.json"], "dem"),
                                (["--tire", "aligator_planar.json", "--soil", "lete_sand.json"], "scm")):
            with self.subTest(options):
                name = "_".join(options).replace("--", "").replace(".json", "")
                self.output("new", name, *options)
                report = json.loads(self.output("validate", f"{name}.json", "--json"))
                self.assertEqual(report["warnings"], [])
                self.assertIn(f'"engine": "{engine}"', (self.folder / f"{name}.json").read_text())
        self.output("new", "fitted", "--soil", "grains_lete_sand.json")
        fitted = (self.folder / "fitted.json").read_text()
        self.assertNotIn('"young_modulus"', fitted, "the soil gives it")
        self.assertIn('"radius": 0.01,', fitted, "with which its strength was measured")
        self.assertEqual(json.loads(self.output("validate", "fitted.json", "--json"))["warnings"], [])
        self.furrow("new", "wrong", "--tire", "hmmwv_handling.json", "--soil", "loose_sand.json", code=2,
                    says="--soil': is given, expected none: the file of 'hmmwv_handling.json' holds for hard "
                    "ground; with --rigid")

    def test_new_leaves_no_file_where_it_fails_and_none_of_yours_is_touched(self):
        for options, said in ((["--tire", "no_such.json"], "'no_such.json' does not exist"),
                              (["--soil", "no_such.json"], "no_such.json"),
                              (["--vehicle", "no_such.json"], "no_such.json"),
                              (["--load", "-1"], "--load: is -1, expected a number above 0, see"),
                              (["--load", "nan"], "--load: is nan"),
                              (["--vehicle", "rover.json", "--load", "5"], "excludes")):
            self.furrow("new", "mine", *options, code=2, says=said)
            self.assertEqual(self.names(), [])
        self.furrow("new", "my drum", "--tire", "rigid_drum.json", says="run it with: furrow run 'my drum.json'")
        self.assertIn("set tire.rigid if the wheel is rigid",
                      furrow("validate", "my drum.json", cwd=self.folder).stderr)
        (self.folder / "my drum.json").unlink()
        self.furrow("new", "rover", "--vehicle", "rover.json", code=2,
                    says="NAME': is 'rover.json': beside that scenario")
        for name in ("", "-", ".", "no_such_folder/x"):
            self.furrow("new", name, code=5 if "/" in name else 2)
        self.assertEqual(self.names(), [])
        self.furrow("list", env={"FURROW_HOME": str(self.folder)}, code=5,
                    says="rigs: is missing, expected the folder that comes with furrow")
        (self.folder / "mine.json").write_text("mine")
        self.furrow("new", "mine", code=2, says="'mine.json' exists already, expected a new file")
        self.assertEqual((self.folder / "mine.json").read_text(), "mine")

    def test_comments_are_taken(self):
        (self.folder / "small.json").write_text("// mine\n" + json.dumps(SMALL)[:-1] + " /* no more */ }\n// [[")
        self.assertIn("0.05 s in 500 steps", self.output("validate", "small.json"))

    def test_rounded_times_are_explained(self):
        for key in ("run.end", "output.series_interval", "output.frame_interval", "checkpoint.interval"):
            self.assertIn("rounded to a whole number of run.step", self.output("explain", key))

    def test_validate_writes_nothing(self):
        self.output("validate", write_scenario(self.folder))
        self.assertEqual(self.names(), ["small.json"])

    def test_unstable_step_can_be_allowed(self):
        path = write_scenario(self.folder, changed(run={"step": 2e-3}, output={"series_interval": 2e-3},
                                                   terrain={"allow_unstable_step": True}))
        self.furrow("validate", path, says=("furrow: warning: ", "is above the stable step"))

    def test_set_changes_the_digest_and_threads_do_not(self):
        path = write_scenario(self.folder)
        digest = lambda *flags: json.loads(self.output("validate", path, "--json", *flags))["scenario_digest"]
        self.assertEqual(digest(), digest("--threads", "2"))
        self.assertEqual(digest(), digest("--set", "rig.slip=0.30"))
        self.assertNotEqual(digest(), digest("--set", "rig.slip=0.31"))

    def test_mirrored_travel_starts_at_the_other_end(self):
        path = write_scenario(self.folder)
        there = json.loads(self.output("validate", path, "--json"))["axle_path_m"][0]
        back = json.loads(self.output("validate", path, "--json", "--set", "rig.travel_sign=-1"))["axle_path_m"][0]
        self.assertAlmostEqual(there[0] + back[0], 1.4)
        self.assertAlmostEqual(there[1] + back[1], 1.4)

    def test_tires_as_a_list_of_one(self):
        scenario = changed(tire=None)
        scenario["tires"] = [{"file": "hmmwv_layered.json", "rigid": True}]
        report = json.loads(self.output("validate", write_scenario(self.folder, scenario), "--json"))
        self.assertEqual(len(report["ranks"]), 3)

    def test_tire_file_beside_the_scenario_comes_first(self):
        own = read_json(ROOT / "tire" / "data" / "hmmwv_layered.json")
        own["elements_circumference"] = 30
        write_json(self.folder / "hmmwv_layered.json", own)
        path = write_scenario(self.folder, changed(tire={"rigid": False}))
        self.assertIn("30 × ", self.output("validate", path))

    def test_ranks(self):
        path = write_scenario(self.folder)
        text = self.output("ranks", path, "--set", "rig.slip=0.2")
        self.assertRegex(text, r"(?m)^ +0 +rig .*\n +1 +tire 0 .*\n +2 +terrain ")
        self.assertRegex(text, r"(?m)^mpirun -n 3 .* run '.*small.json' --set rig.slip=0.2$")
        self.assertRegex(text, r"(?m)^srun -n 3 .* run '.*small.json' --set rig.slip=0.2$")

    def test_explain(self):
        text = self.output("explain", "terrain.cohesion")
        for word in ("Pa", "default", "range", "attract"):
            self.assertIn(word, text)
        self.assertIn("rig.slip", self.output("explain", "rig"))
        self.assertIn("tire.pressure", self.output("explain"))
        self.assertIn("tires.0.pressure", self.output("explain", "tires"))
        self.assertIn("rig.wheels.0.lateral", self.output("explain", "rig.wheels"))

    def test_every_key_is_explained_in_words_with_unit_and_default(self):
        keys = [line.split()[0] for line in self.output("explain").splitlines()]
        self.assertGreater(len(keys), 50)
        schema = read_json(ROOT / "rigs" / "scenario.schema.json")
        for key in keys:
            node = schema["definitions"]["tire"] if key.startswith("tire.") else schema
            for part in key.split(".")[1 if key.startswith("tire.") else 0:]:
                node = node["properties"][part]
            self.assertIn("description", node, key)
            if node.get("type") == "number" or node.get("type") == ["number", "null"]:
                self.assertIn("unit", node, key)
            if "default" not in node:
                self.assertIn(key.split(".")[0],
                              ("$schema", "completed_by", "description", "expected", "tire", "tires"), key)

    def test_committed_schemas_are_what_the_program_prints(self):
        for kind, file in SCHEMAS.items():
            self.assertEqual(self.output("schema", kind), (ROOT / file).read_text(), f"furrow schema {kind} > {file}")
        done = furrow("schema", "bridge", cwd=self.folder)
        self.assertEqual(done.returncode, 2)
        self.assertIn("'bridge': is unknown, expected 'scenario', 'tire', 'vehicle' or 'driver'", done.stderr)

    def test_skeleton_of_the_contract_is_accepted(self):
        scenario = {
            "format_version": 1,
            "rig": {"type": "drawbar", "slip": 0.3, "mode": "fixed_angular_speed", "angular_speed": 8.56, "ramp": 0.15,
                    "touchdown_damping": 12e3, "touchdown_time": 0.35, "toe_angle": 0.0, "carrier_mass": 450,
                    "chassis_mass": 1, "set_toe_mass": 1, "rim_mass": 15},
            "tire": {"file": "hmmwv_layered.json", "pressure": 200e3, "substeps": 1},
            "terrain": {"engine": "dem", "ranks": 1, "law": "mindlin", "radius": 0.006, "density": 2500,
                        "young_modulus": 2.49e7, "poisson_ratio": 0.3, "restitution": 0.2, "friction": 0.9,
                        "rolling_friction": 0.0, "cohesion": 80e3, "layers": 15, "length": 10, "width": 0.6,
                        "activity": True, "bed": None, "substeps": 1},
            "run": {"step": 4e-5, "end": 1.5, "average_from": 0.8, "threads": "auto", "seed": 1, "peer_timeout": 60},
            "output": {"series_interval": 1e-3, "frame_interval": 0.02},
            "checkpoint": {"wall_interval": 600, "keep": 2},
        }
        self.output("validate", write_scenario(self.folder, scenario))


class BatchScripts(SystemTest):
    def test_times_and_cores_that_slurm_cannot_give_are_refused(self):
        scenario = ROOT / "rigs" / "first_look.json"
        for options, told in ((["--time", "4"], "'--time': is '4', expected 8 minutes or more: the run saves its state "
                                                "6 minutes before"),
                              (["--time", "25:61:99"],
                               "'--time': is '25:61:99', expected minutes, hh:mm:ss or days-hh:mm:ss"),
                              (["--nodes", "2", "--cores-per-node", "5"],
                               "'--cores-per-node': is 5, expected 4 or another multiple of the 2 ranks")):
            with self.subTest(options):
                self.furrow("ranks", "--slurm", *options, scenario, code=2, says=told)
        for time in ("8", "12:00:00", "1-12", "2-12:30"):
            self.furrow("ranks", "--slurm", "--time", time, scenario, shows=f"#SBATCH --time={time}\n")

    def test_a_job_that_begins_again_finds_its_checkpoints_whatever_its_folder_is_called(self):
        for name in ("x[1]", "x*?", "a b\\c"):
            with self.subTest(name):
                path = write_scenario(self.folder, name=f"{name}.json")
                text = self.furrow("ranks", "--slurm", path).stdout
                script = self.folder / "job.sh"
                script.write_text("".join("program=echo\n" if line.startswith("program=") else line
                                          for line in text.splitlines(keepends=True)))
                run = f"results/{name}-job1"
                again = {**os.environ, "SLURM_JOB_ID": "1", "SLURM_RESTART_COUNT": "1"}
                self.assertIn("run --overwrite", self.call(["bash", script], env=again).stdout)
                (self.folder / run / "checkpoints" / "000000000750").mkdir(parents=True)
                self.call(["bash", script], env=again, prints=f"resume -- {run}\n")


if __name__ == "__main__":
    main()
