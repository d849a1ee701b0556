#!/usr/bin/python3
"""`furrow run --seeds N`: one scenario on several beds, their means, and what becomes of those that are not done."""
import math
import signal
import statistics
import sys

from program import (ROOT, SystemTest, changed, furrow, main, read_json, rows_of, survivors, wait_for, write_json,
                     write_scenario)

sys.path.insert(0, str(ROOT / "tests" / "campaign"))
from compare_runs import differences  # noqa: E402

SHORT = ["--set", "run.end=0.06", "--set", "run.average_from=0.02"]
STUDENT = {2: 4.302653, 3: 3.182446}  # 97.5 %


class Beds(SystemTest):
    def beds(self, *arguments, **expected):
        path = write_scenario(self.folder, changed(output={"frame_interval": 0}))
        return self.furrow("run", path, *arguments, **expected)

    def check_means(self, run, names):
        """Against the summaries of the beds themselves."""
        beds, together = [self.summary(f"{run}/{name}") for name in names], self.summary(run)
        for key, of in (("drawbar_pull_N", lambda bed: bed["drawbar_pull_N"]["mean"]),
                        ("sinkage_m", lambda bed: bed["sinkage_m"]),
                        ("drive_torque_Nm", lambda bed: bed["drive_torque_Nm"])):
            values, n = [of(bed) for bed in beds], len(beds)
            found, sd = together[key], statistics.stdev(values)
            self.assertAlmostEqual(found["mean"], statistics.mean(values), delta=1e-9 * abs(found["mean"]))
            self.assertAlmostEqual(found["sd"], sd, delta=1e-6 * sd)
            self.assertAlmostEqual(found["half_width_95"], STUDENT[n - 1] * sd / math.sqrt(n), delta=1e-6 * sd)
            self.assertEqual(found["beds"], {"n": n, "mean": found["mean"], "half_width_95": found["half_width_95"]})
        self.assertEqual(together["beds"], together["drawbar_pull_N"]["beds"])
        self.assertEqual(together["wheels"][0]["sinkage_m"], together["sinkage_m"])
        self.assertEqual([run["drawbar_pull_N"]["mean"] for run in together["runs"]],
                         [bed["drawbar_pull_N"]["mean"] for bed in beds])
        self.assertEqual(len({bed["state_hash"] for bed in beds}), len(beds))

    def test_beds_are_run_averaged_kept_and_extended(self):
        done = self.beds("--seeds", "3", "--jobs", "2", *SHORT, prints="results/small-001\n")
        run, names = self.folder / "results" / "small-001", ["seed1", "seed2", "seed3"]
        self.check_means(run, names)
        self.assertIn("furrow: 3 beds: drawbar pull ", done.stderr)
        self.assertIn("NOT STEADY on seed1, seed2, seed3", done.stderr)
        together = self.summary(run)
        self.assertEqual((together["seeds"], together["not_steady"]), (3, names))
        self.assertEqual([(bed["folder"], bed["seed"], bed["done"]) for bed in together["runs"]],
                         [("seed1", 1, True), ("seed2", 2, True), ("seed3", 3, True)])
        self.assertTrue(together["runs"][0]["drawbar_pull_N"]["unsteady_because"])
        self.assertEqual((run / "beds.png").read_bytes()[:4], b"\x89PNG")
        rows = rows_of(run / "sweep.csv")
        self.assertEqual([(row["folder"], row["run.seed"], row["state"], row["drawbar_pull_N.steady"]) for row in rows],
                         [(f"seed{k}", str(k), "done", "false") for k in (1, 2, 3)])

        again = self.beds("--seeds", "4", "--out", run, *SHORT)
        self.assertEqual(again.stderr.count("is done already"), 3, again.stderr)
        self.check_means(run, [*names, "seed4"])
        self.assertEqual(furrow("report", run, cwd=self.folder).stdout, f"{run}/beds.png\n{run}/report.html\n")

        self.beds("--seeds", "2", "--out", run, "--no-plots", *SHORT, "--set", "rig.slip=0.2", code=2,
                  says="holds beds of another scenario or other settings, expected a new folder or --overwrite")
        (run / "notes.txt").write_text("mine")
        self.beds("--seeds", "2", "--out", run, "--no-plots", *SHORT, "--set",
                  "rig.slip=0.2", "--set", "run.seed=7", "--overwrite")
        self.assertEqual(sorted(path.name for path in run.iterdir()),
                         [".furrow-run", "notes.txt", "seed1", "seed1.log",
                          "seed2", "seed2.log", "summary.json", "sweep.csv", "sweep.json"])
        self.assertEqual([bed["seed"] for bed in self.summary(run)["runs"]], [7, 8])
        self.assertEqual(read_json(run / "seed2" / "scenario.json")["run"]["seed"], 8)

    def test_beds_that_were_stopped_go_on(self):
        settings = ["--seeds", "2", "--no-plots", "--set", "run.end=0.2", "--set", "checkpoint.interval=0.01"]
        path = write_scenario(self.folder, changed(output={"frame_interval": 0}))
        process = self.start("run", path, "--out", "beds", *settings)
        wait_for(lambda: list((self.folder / "beds" / "seed1").glob("checkpoints/0*")), 60, "a checkpoint")
        process.send_signal(signal.SIGTERM)
        self.ended(process, 75, says="run the same command with --out beds")
        self.assertFalse((self.folder / "beds" / "summary.json").exists())
        self.assertEqual(survivors(self.folder), [])
        self.beds("--out", "beds", *settings, says="run 1 of 2 (run.seed=1) continues")
        self.beds("--out", "whole", *settings)
        self.assertEqual(differences(self.folder / "whole", self.folder / "beds"), [])
        self.furrow("resume", "beds", code=2, says="holds several runs, expected the folder of one of them")

    def test_means_are_over_the_others_where_a_bed_failed_and_say_so(self):
        (self.folder / "beds").mkdir()
        self.beds("--seeds", "3", "--out", "beds", "--no-plots", *SHORT)
        kept = self.folder / "seed2"
        (self.folder / "beds" / "seed2").rename(kept)
        (self.folder / "beds" / "seed2").mkdir()
        (self.folder / "beds" / "seed2" / "mine.txt").write_text("stands in the way")
        self.beds("--seeds", "3", "--out", "beds", *SHORT, code=2,
                  says=("seed2 failed; the means are over the other 2 beds", "furrow: 2 beds: ",
                        "not every bed finished: seed2: "), errors=1)
        self.assertFalse((self.folder / "beds" / "summary.json").exists())
        failed = self.summary("beds", "summary_failed.json")
        self.assertEqual((failed["failed"]["beds"], failed["failed"]["exit_code"], failed["beds"]["n"]),
                         (["seed2"], 2, 2))
        self.assertEqual([bed["done"] for bed in failed["runs"]], [True, False, True])
        (self.folder / "beds" / "seed2" / "mine.txt").unlink()
        (self.folder / "beds" / "seed2").rmdir()
        self.beds("--seeds", "3", "--out", "beds", "--no-plots", *SHORT)
        self.assertEqual(self.summary("beds")["beds"]["n"], 3)
        self.assertFalse((self.folder / "beds" / "summary_failed.json").exists())

    def test_mistakes_are_told_before_anything_runs(self):
        (self.folder / "bed.csv").write_text("x_m,y_m,z_m\n0.1,0.0,0.1\n")
        write_json(self.folder / "study.json", {"scenario": "small.json",
                                                            "list": [{"rig.slip": 0.1}], "set": {"run.end": 0.01}})
        for flags, words in ((["--seeds", "0"], "--seeds': is 0, expected 2 to 1000 beds"),
                             (["--seeds", "1"], "--seeds': is 1, expected 2 to 1000 beds"),
                             (["--seeds", "-3"], "--seeds': is -3, expected 2 to 1000 beds"),
                             (["--seeds", "many"], "--seeds"),
                             (["--seeds", "3", "--jobs", "0"], "--jobs': is 0, expected 1 to 1024"),
                             (["--jobs", "2"], "--jobs': is given without --seeds"),
                             (["--seeds", "3", "--profile"], "--profile': is given with --seeds"),
                             (["--seeds", "3", "--set", "terrain.engine=rigid"],
                              "key 'terrain.engine': is 'rigid', expected 'dem' or 'liggghts': --seeds makes beds"),
                             (["--seeds", "3", "--set", "terrain.bed=bed.csv"],
                              "expected none with --seeds: every bed would be this one"),
                             (["--seeds", "3", "--set", "run.seed=9007199254740990"],
                              "key 'run.seed': is 9007199254740990, expected at most"),
                             (["--seeds", "3", "--set", "rig.slip=3"], "key 'rig.slip': is 3, expected")):
            self.beds(*flags, code=2, says=words)
            self.assertFalse((self.folder / "results").exists(), flags)

    def test_beds_and_studies_keep_to_their_own_folders(self):
        self.beds("--seeds", "2", "--out", "beds", "--no-plots", *SHORT)
        study = write_json(self.folder / "study.json", {"scenario": "small.json", "list": [{"rig.slip": 0.1}],
                                                        "set": {"run.end": 0.03}})
        self.furrow("sweep", study, "--out", "beds", code=2, says="holds the beds of 'furrow run --seeds'")
        self.furrow("sweep", study, "--out", "study")
        self.beds("--seeds", "2", "--out", "study", "--overwrite", code=2,
                  says="holds a study, expected a new folder or that of beds")
        self.beds("--seeds", "2", "--out", "beds/seed1", "--overwrite", code=2, says="holds a run")


if __name__ == "__main__":
    main()
