#!/usr/bin/python3
"""run_study.py uses a finished case again only where program and scenario are those that made it, and its tables say
who made them."""
import json
import os
import pathlib
import shutil
import stat
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import driver  # noqa: E402
import provenance  # noqa: E402

# Stands in for the program: counts its runs, and takes settings and content for the scenario's digest.
PROGRAM = """#!/usr/bin/python3
# build {build}
import json, pathlib, sys
words = sys.argv[1:]
digest = " ".join(word for before, word in zip(words, words[1:]) if before == "--set")
digest += "".join(pathlib.Path(word).read_text() for word in words[1:] if pathlib.Path(word).is_file())
if words[0] == "validate":
    print(json.dumps({{"scenario_digest": digest}}))
else:
    out = pathlib.Path(words[words.index("--out") + 1])
    out.mkdir(parents=True, exist_ok=True)
    with open(out / "runs", "a") as file:
        file.write("{build}\\n")
    summary = {{"scenario_digest": digest, "pull": {build}, "drawbar_pull_N": {{"steady": False, "n_eff": 8.5}},
               "compiler": "g++ 12.2.0", "cpu": "a processor, 2.5 GHz"}}
    (out / "summary.json").write_text(json.dumps(summary))
"""


CHECKOUT = shutil.which("git") and subprocess.run(["git", "-C", HERE, "rev-parse"], capture_output=True).returncode == 0


@unittest.skipUnless(CHECKOUT, "needs a checkout of git: a table names the commit of its program")
class RunStudy(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="furrow_study_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.build(1)
        self.study(slip=0.1)

    def build(self, number):
        path = self.folder / "furrow"
        path.write_text(PROGRAM.format(build=number))
        path.chmod(path.stat().st_mode | stat.S_IXUSR)

    def study(self, slip):
        cases = {"first": {"set": {"rig.slip": slip}}, "second": {"set": {"rig.slip": 0.5}}}
        (self.folder / "small.json").write_text(json.dumps({"scenario": "rigs/first_look.json",
                                                            "cases": cases, "columns": ["pull"]}))

    def run_study(self, *arguments):
        done = subprocess.run([sys.executable, HERE / "run_study.py", self.folder / "small.json", "--results",
                               self.folder / "results", *arguments], capture_output=True, text=True,
                              env={**os.environ, "FURROW": str(self.folder / "furrow")})
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stderr

    def runs(self):
        return {name: len((self.folder / "results" / "small" / name / "runs").read_text().split())
                for name in ("first", "second")}

    def pulls(self):
        return {row["case"]: row["pull"] for row in provenance.read_table(self.folder / "small.csv")}

    def test_finished_cases_of_the_same_program_and_scenario_are_used_again(self):
        self.run_study()
        self.run_study()
        self.assertEqual(self.runs(), {"first": 1, "second": 1})
        self.assertEqual(self.pulls(), {"first": "1", "second": "1"})

    def test_another_build_of_the_program_runs_all_cases_again(self):
        self.run_study()
        self.build(2)
        self.assertIn("first: run again: another build of the program made it", self.run_study())
        self.assertEqual(self.runs(), {"first": 2, "second": 2})
        self.assertEqual(self.pulls(), {"first": "2", "second": "2"})

    def test_a_changed_scenario_runs_its_case_again_and_no_other(self):
        self.run_study()
        self.study(slip=0.2)
        self.assertIn("first: run again: its scenario has changed", self.run_study())
        self.assertEqual(self.runs(), {"first": 2, "second": 1})

    def test_results_that_name_no_build_are_not_trusted(self):
        self.run_study()
        (self.folder / "results" / "small" / "second" / "case.json").unlink()
        self.run_study()
        self.assertEqual(self.runs(), {"first": 1, "second": 2})

    def test_cases_that_were_not_chosen_leave_the_table_when_another_build_made_them(self):
        self.run_study()
        self.build(2)
        self.assertIn("second: left out of the table", self.run_study("--only", "first"))
        self.assertEqual(self.pulls(), {"first": "2"})
        self.assertEqual(self.runs(), {"first": 2, "second": 1})

    def test_tables_say_which_means_are_steady_whatever_columns_a_study_has(self):
        self.run_study()
        for row in provenance.read_table(self.folder / "small.csv"):
            self.assertEqual((row["drawbar_pull_N.steady"], row["drawbar_pull_N.n_eff"]), ("False", "8.5"))

    def test_tables_name_commit_compiler_processor_and_command(self):
        self.run_study()
        made = provenance.read_origin(self.folder / "small.csv")
        self.assertEqual(made["compiler"], "g++ 12.2.0")
        self.assertEqual(made["processor"], "a processor, 2.5 GHz")
        self.assertEqual(made["commit"], provenance.commit())
        self.assertTrue(made["command"].startswith("run_study.py "), made["command"])


    def test_results_are_kept_until_their_words_their_scenario_or_the_program_change(self):
        os.environ["FURROW"] = str(self.folder / "furrow")
        self.addCleanup(os.environ.pop, "FURROW")

        def runs(*words, **more):
            out = driver.kept(self.folder / "kept", "press", *words, **more)
            return len((out / "runs").read_text().split()) if out else 0
        self.assertEqual(runs("--on", "plate", finished_only=True), 0)
        self.assertEqual([runs("--on", "plate"), runs("--on", "plate"), runs("--on", "cleat")], [1, 1, 2])
        self.assertEqual([runs(scenario={"rig": slip}) for slip in (1, 1, 2)], [3, 3, 4])
        self.build(2)
        self.assertEqual(runs(scenario={"rig": 2}), 5)

    def test_results_are_kept_until_a_file_that_their_words_name_changes(self):
        os.environ["FURROW"] = str(self.folder / "furrow")
        self.addCleanup(os.environ.pop, "FURROW")
        scenario, profile = self.folder / "wheel.json", self.folder / "profile.csv"

        def runs(rig, heights):
            scenario.write_text(json.dumps({"rig": rig}))
            profile.write_text(heights)
            out = driver.kept(self.folder / "kept", "press", scenario, "--profile", profile)
            return len((out / "runs").read_text().split())
        self.assertEqual([runs(1, "0"), runs(1, "0"), runs(2, "0"), runs(2, "1"), runs(2, "1")], [1, 1, 2, 3, 3])


class Tables(unittest.TestCase):
    def test_tables_of_the_studies_name_their_program_and_can_be_read(self):
        for path in sorted(HERE.glob("*.csv")):
            self.assertIn("commit", provenance.read_origin(path), path.name)
            rows = provenance.read_table(path)
            self.assertTrue(rows, path.name)
            for row in rows:
                self.assertNotIn(None, row, path.name)

    def test_runs_of_different_programs_are_refused(self):
        with tempfile.TemporaryDirectory() as name:
            runs = [pathlib.Path(name) / run for run in ("first", "second")]
            for run in runs:
                run.mkdir()
                (run / "summary.json").write_text(json.dumps({"compiler": "g++ 12.2.0", "cpu": "a processor"}))
                (run / provenance.RECORD).write_text(json.dumps({"build": "b", "commit": "1a2b3c4d"}))
            self.assertEqual(provenance.origin_of_runs(runs)["commit"], "1a2b3c4d")
            for file, key, value in ((provenance.RECORD, "build", "another"), ("summary.json", "cpu", "another"),
                                     ("summary.json", "compiler", None), (provenance.RECORD, "build", None)):
                before = (runs[1] / file).read_text()
                (runs[1] / file).write_text(json.dumps({**json.loads(before), key: value}))
                with self.assertRaises(SystemExit) as refused:
                    provenance.origin_of_runs(runs)
                self.assertIn("second", str(refused.exception))
                (runs[1] / file).write_text(before)


if __name__ == "__main__":
    unittest.main(verbosity=2)
