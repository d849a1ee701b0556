#!/usr/bin/python3
"""`furrow calibrate`: what it leaves, how it continues, and what it refuses."""
import csv
import json
import signal
import struct
import time

import calibrate_grains
from program import ROOT, SystemTest, furrow, main, read_json, rows_of, wait_for, write_json

FILES = {"calibration.json", "evaluations.csv", "fit.csv", "soft_ring_fitted.json"}


class Calibrate(SystemTest):
    """Curves of a ring whose first sidewall coefficient is 1e6 N/m, made by `furrow press`."""

    def press(self, tire, name, *words):
        self.furrow("press", ROOT / "rigs" / "cleat_press.json", "--set", f"tire.file={tire}",
                    "--set", "tire.elements_circumference=null", "--set", "tire.elements_width=null", "--points", "8",
                    "--out", name, "--quiet", *words)

    def curve(self, name, *words):
        ring = {**read_json(ROOT / "tire" / "data" / "hmmwv_ring.json"), "segments": 120}
        write_json(self.folder / "soft_ring.json", ring)
        ring["sidewall"][0] = 1e6
        write_json(self.folder / "hard_ring.json", ring)
        if not (self.folder / name).exists():
            self.press(self.folder / "hard_ring.json", name, *words)
        return f"{name}/press.csv"

    def study(self, name="study.json", **more):
        study = {"calibrate": "ring", "start": "soft_ring.json",
                 "parameters": {"sidewall_1": {"lower": 1e5, "upper": 1e7}, "air_share": {"lower": 0.1, "upper": 1}},
                 "targets": [{"data": self.curve("plate", "--on", "plate"), "name": "plate", "on": "plate"},
                             {"data": self.curve("cleat", "--on", "cleat", "--cleat-width", "0.051"), "name": "cleat",
                              "on": "cleat", "cleat_width": 0.051, "weight": 2}],
                 "held_out": [{"data": "plate/press.csv", "name": "again", "on": "plate"}], "starts": 3, **more}
        write_json(self.folder / name, study)
        return name

    def text(self, folder):
        return {name: (self.folder / folder / name).read_bytes() for name in FILES}

    def test_earlier_results_come_back_where_nothing_is_evaluated(self):
        self.furrow("calibrate", self.study(), "--out", "out", "--no-plots")
        before = self.text("out")
        write_json(self.folder / "grains.json", calibrate_grains.CalibrateGrains.STUDY)
        for number in (signal.SIGTERM, signal.SIGKILL):
            process = self.start("calibrate", "grains.json", "--out", "out", "--overwrite")
            wait_for(lambda: all((self.folder / "out" / name).exists()
                                 for name in (".furrow-before/evaluations.csv", "evaluations.csv")), 60,
                     "they are set aside")
            process.send_signal(number)
            _, err = process.communicate(timeout=60)
            if number == signal.SIGTERM:
                self.assertEqual(process.returncode, 75, err)
                self.assertIn("out holds the earlier results again", err)
                self.assertEqual(self.text("out"), before)
        self.furrow("calibrate", "grains.json", "--out", "out", code=2)
        self.assertEqual(self.text("out"), before)

    def test_the_result_is_a_tire_with_the_errors_of_its_parameters(self):
        done = self.furrow("calibrate", self.study(), "--out", "out", matches=r"furrow: sidewall_1 1000000 ± \S+ N/m\n",
                           prints="out\n")
        self.assertRegex(done.stderr,
                         r"furrow: predicted again \(plate\): R² 1\.0000, largest error \S+ N, \S+ % of the peak\n")
        out = self.folder / "out"
        self.assertEqual({path.name for path in out.iterdir()} - {".furrow-run"},
                         FILES | {"fit.png", "residual.png", "report.html"})
        result = read_json(out / "calibration.json")
        stiff = result["parameters"]["sidewall_1"]
        self.assertAlmostEqual(stiff["value"] / 1e6, 1, delta=1e-4)
        self.assertLessEqual(stiff["interval_95"][0], stiff["value"])
        self.assertEqual([target["name"] for target in result["targets"]], ["plate", "cleat"])
        self.assertGreater(result["fitted"]["r_squared"], 0.9999)
        self.assertEqual(len(result["starts"]), 3)
        rows = rows_of(out / "fit.csv")
        self.assertEqual(len(rows), 24)
        self.assertEqual(rows[0]["set"], "fitted")
        fitted = read_json(out / "soft_ring_fitted.json")
        self.assertEqual(fitted["sidewall"][0], stiff["value"])
        self.assertIn("furrow calibrate", fitted["source"])
        self.press(out / "soft_ring_fitted.json", "again", "--on", "plate")
        with open(self.folder / "again" / "press.csv", newline="", encoding="utf-8") as file:
            pressed = [float(row["force_N"]) for row in csv.DictReader(file) if row["unloading"] == "0"][1:]
        for force, row in zip(pressed, [row for row in rows if row["target"] == "plate"], strict=True):
            self.assertAlmostEqual(force / float(row["model"]), 1, delta=1e-9)
        self.furrow("report", "out")

    def test_a_table_is_told_in_one_line_for_each_quantity(self):
        study = {"calibrate": "handling", "start": "handling_start.tir",
                 "parameters": {"PKX1": {"lower": 5, "upper": 60}},
                 "targets": [{"data": "sweep_lumped.csv", "of": of} for of in ("fx", "mz", "fy", "mx", "my")],
                 "starts": 1}
        write_json(self.folder / "handling.json", study)
        done = self.furrow("calibrate", "handling.json", "--out", "out")
        told = [line for line in done.stderr.splitlines() if line.startswith("furrow: fitted ")]
        self.assertEqual(len(told), 5, done.stderr)
        self.assertRegex(told[0],
                         r"fitted sweep_lumped_fx \(fx of 41 rows\): R² -?\S+, largest error \S+ N, \S+ % of the peak$")
        self.assertRegex(told[1], r"fitted sweep_lumped_mz \(mz of 41 rows\): R² -?\S+, largest error \S+ Nm, \S+ % of "
                         r"the peak$")
        for plot in ("fit.png", "residual.png"):  # five panels in two rows
            wide, high = struct.unpack(">II", (self.folder / "out" / plot).read_bytes()[16:24])
            self.assertTrue(2 < wide / high < 3, (plot, wide, high))

    def test_it_continues_to_the_same_bits_after_signals_and_damage(self):
        study = self.study()
        self.furrow("calibrate", study, "--out", "once", "--no-plots")
        expected = self.text("once")
        table = expected["evaluations.csv"]
        stops = 0
        for wait in (0.0, 0.05, 0.2):
            process = self.start("calibrate", study, "--out", "often", "--no-plots")
            wait_for(lambda: (self.folder / "often" / "evaluations.csv").exists() or process.poll() is not None,
                     60, "the table")
            time.sleep(wait)
            process.send_signal(signal.SIGTERM)
            out, err = process.communicate(timeout=60)
            if process.returncode in (0, -signal.SIGTERM) or err == "furrow: error: stopped by a signal\n":
                continue  # it was done, or had not begun
            self.assertEqual((process.returncode, out), (75, "often\n"), err)
            self.assertIn("run the same command to continue", err)
            stops += 1
        self.assertGreater(stops, 0)
        self.furrow("calibrate", study, "--out", "often", "--no-plots")
        self.assertEqual(self.text("often"), expected)
        # Cut in the middle of a line, as a full disk or kill −9 leaves it.
        (self.folder / "often" / "evaluations.csv").write_bytes(table[: len(table) // 2])
        (self.folder / "often" / "calibration.json").unlink()
        self.furrow("calibrate", study, "--out", "often", "--no-plots")
        self.assertEqual(self.text("often"), expected)

    def test_another_calibration_needs_another_folder(self):
        self.furrow("calibrate", self.study(), "--out", "out", "--no-plots")
        before = self.text("out")
        other = self.study("other.json", parameters={"bending": {}})
        self.furrow("calibrate", other, "--out", "out", code=2, says="holds the evaluations of another calibration")
        self.assertEqual(self.text("out"), before)
        self.furrow("calibrate", other, "--out", "out", "--overwrite", "--no-plots")
        self.assertNotEqual(self.text("out"), before)
        (self.folder / "mine").mkdir()
        (self.folder / "mine" / "notes.txt").write_text("mine")
        for words in ((), ("--overwrite",)):
            self.furrow("calibrate", other, "--out", "mine", *words, code=2)
        self.assertEqual([path.name for path in (self.folder / "mine").iterdir()], ["notes.txt"])

    def test_earlier_results_stay_where_the_new_ones_have_no_place(self):
        self.furrow("calibrate", self.study(), "--out", "out", "--no-plots")
        (self.folder / "out" / "notes.json").write_text("mine")
        before = self.text("out")
        self.furrow("calibrate", self.study("other.json", result="notes.json"), "--out", "out", "--overwrite", code=2,
                    says="notes.json: stands where a result is to be written")
        self.assertEqual(self.text("out"), before)
        self.assertEqual((self.folder / "out" / "notes.json").read_text(), "mine")

    def test_wrong_studies_leave_nothing(self):
        self.study()
        before = set(self.names())
        for change, expected in (({"calibrate": "rings"}, "'rings' is unknown, expected 'ring'?"),
                                 ({"start": "no.json"}, "key 'start'"),
                                 ({"starts": 0}, "key 'starts'")):
            document = {**read_json(self.folder / "study.json"), **change}
            write_json(self.folder / "wrong.json", document)
            self.furrow("calibrate", "wrong.json", code=2, says=expected, prints="")
            self.assertEqual(set(self.names()), before | {"wrong.json"}, expected)
        for name, words in (("study_slip", "is a study, expected a calibration ('furrow sweep' takes studies)"),
                            ("first_look", "is a scenario, expected a calibration ('furrow run' takes scenarios)")):
            self.furrow("calibrate", ROOT / "rigs" / f"{name}.json", code=2, says=words)
        # A tire that no pressure of the study can hold.
        document = {**read_json(self.folder / "study.json"), "starts": 2}
        document["targets"][0]["pressure"] = 5e7
        write_json(self.folder / "stiff.json", document)
        self.furrow("calibrate", "stiff.json", "--out", "stiff", code=3,
                    says="the model has no answer at any of the 2 starts")

    def test_commands_for_runs_say_what_a_calibration_is_and_what_continues_it(self):
        study = self.study()
        self.furrow("calibrate", study, "--out", "out", "--no-plots")
        done = self.furrow("resume", "out", code=2, prints="")
        self.assertEqual(done.stderr, "furrow: error: out: holds a calibration, expected a run; the command that began "
                         "it, 'furrow calibrate' with the same study, continues it\n")
        (self.folder / "out" / "calibration.json").unlink()  # as after a signal or kill −9
        before = set(self.names())
        for command in (("report",), ("resume",), ("events",), ("report", "--vtk", "vtk")):
            done = self.furrow(command[0], "out", *command[1:], code=2, prints="")
            self.assertEqual(done.stderr, "furrow: error: out: holds a calibration that has not ended; the command "
                             "that began it, 'furrow calibrate' with the same study, continues it\n")
        self.assertEqual(set(self.names()), before)
        self.furrow("calibrate", study, "--out", "out", "--no-plots")

    def test_validate_checks_a_study_and_says_what_is_fitted(self):
        study = self.study()
        done = furrow("validate", study, cwd=self.folder)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        lines = done.stdout.splitlines()
        self.assertEqual(lines[0], "calibration  study.json, kind ring")
        self.assertIn("parameter    sidewall_1: 100e3 to 1e7 N/m, logarithmic, from 235340", lines)
        self.assertRegex(done.stdout, r"\ntarget       plate \(plate[^)]*\): 8 points, deflection_m \S+ to \S+, "
                         r"force_N \S+ to \S+\n")
        self.assertRegex(done.stdout, r"\nheld out     again \(")
        self.assertIn("starts       3, seed 1", lines)
        self.assertIn("result       soft_ring_fitted.json", lines)
        told = json.loads(furrow("validate", study, "--json", cwd=self.folder).stdout)
        self.assertEqual(told["parameters"]["air_share"],
                         {"unit": "-", "lower": 0.1, "upper": 1.0, "scale": told["parameters"]["air_share"]["scale"],
                          "start": told["parameters"]["air_share"]["start"]})
        self.assertEqual([target["name"] for target in told["targets"]], ["plate", "cleat"])
        done = furrow("validate", study, "--set", "rig.slip=0.1", cwd=self.folder)
        self.assertEqual(done.stderr, "furrow: error: command line: key '--set': is given with a calibration study, "
                         "expected a scenario\n")
        self.study("wrong.json", starts=0)
        self.assertEqual(furrow("validate", "wrong.json", cwd=self.folder).stderr,
                         furrow("calibrate", "wrong.json", cwd=self.folder).stderr)
        self.assertNotIn("results", self.names())

    def test_validate_sums_up_a_target_of_many_values(self):
        done = self.furrow("validate", "calibrate_handling.json")
        self.assertRegex(done.stdout, r"\ntarget       sweep_lumped_fx \(fx of 41 rows\): 41 values, -4011\.897 to "
                         r"5587\.121, each ± 40\n")

    def test_commands_for_scenarios_point_to_calibrate(self):
        for command in ("run", "ranks", "press", "bed", "soil"):
            self.furrow(command, "calibrate_ring.json", code=2, matches=r"^furrow: error: .+calibrate_ring.json: is a "
                        r"calibration, expected a scenario \('furrow calibrate' takes calibrations\)\n$", prints="")

    def test_explain_knows_the_keys_of_calibrations(self):
        def told(key):
            return self.furrow("explain", key).stdout
        for key in ("calibrate.targets", "calibrate.evaluations", "calibrate.grains"):
            self.assertIn(key, told("calibrate"))
        self.assertIn("a list of objects, each with data", told("calibrate.targets"))
        self.assertRegex(told("calibrate.ring"), r"\nbending +\S+ to \S+")
        self.assertRegex(told("calibrate.ring.softening"), r"\n  default  0 to 1\n")
        for key, what in (("calibrate.ring.bendin", "expected 'bending'?"), ("calibrate.target", "expected 'targets'?"),
                          ("calibrate_ring.json",
                           "is the name of a file, expected a key; 'furrow validate' checks a file")):
            self.furrow("explain", key, code=2, says=what, prints="")

    def test_shipped_calibrations_are_valid(self):
        for path in sorted((ROOT / "rigs").glob("calibrate_*.json")):
            done = self.furrow("calibrate", path, "--out", "/proc/furrow", code=2, says="key '--out': cannot be made")
            # By its name alone, from any folder.
            self.assertEqual(furrow("calibrate", path.name, "--out", "/proc/furrow", cwd=self.folder).stderr,
                             done.stderr)
            self.furrow("validate", path.name)


if __name__ == "__main__":
    main()
