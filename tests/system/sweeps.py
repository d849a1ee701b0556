#!/usr/bin/python3
"""`furrow sweep`: a table of runs that continues where it was interrupted, and passes over one bed."""
import os
import shutil
import signal
import sys

import h5py
import numpy as np

from program import (ROOT, SystemTest, changed, children, main, read_json, rows_of, survivors, wait_for, write_json,
                     write_scenario)

sys.path.insert(0, str(ROOT / "tests" / "campaign"))
from compare_runs import differences  # noqa: E402


class Sweep(SystemTest):
    def study(self, **keys):
        write_scenario(self.folder, changed(output={"frame_interval": 0}))
        path = write_json(self.folder / "study.json", {"scenario": "small.json", **keys})
        return path

    def table(self, folder="results/study"):
        return rows_of(self.folder / folder / "sweep.csv")

    def test_grid_is_run_kept_and_extended(self):
        grid = {"rig.slip": [0.1, 0.4]}
        study = self.study(set={"run.end": 0.03}, grid=grid, plot={"x": "rig.slip", "y": "drawbar_pull_N.mean"})
        self.furrow("sweep", study, "--jobs", "2", prints="results/study\n")
        rows = self.table()
        self.assertEqual([(row["rig.slip"], row["state"], row["exit_code"]) for row in rows],
                         [("0.1", "done", "0"), ("0.4", "done", "0")])
        for row in rows:
            run = self.folder / "results" / "study" / row["folder"]
            summary = read_json(run / "summary.json")
            self.assertEqual(float(row["drawbar_pull_N.mean"]), summary["drawbar_pull_N"]["mean"])
            self.assertEqual(str(summary["slip"]), row["rig.slip"])
        self.assertEqual((self.folder / "results" / "study" / "curve.png").read_bytes()[:4], b"\x89PNG")

        study = self.study(set={"run.end": 0.03}, grid={"rig.slip": [0.1, 0.2, 0.4]})
        done = self.furrow("sweep", study)
        self.assertEqual(done.stderr.count("is done already"), 2)
        self.assertEqual([row["state"] for row in self.table()], ["done"] * 3)

    def test_a_table_of_another_study_is_told_before_it_is_replaced(self):
        for slip, others in ((0.1, False), (0.3, True), (0.3, False)):
            done = self.furrow("sweep", self.study(set={"run.end": 0.03}, grid={"rig.slip": [slip]}), "--no-plots")
            self.assertEqual("sweep.csv: held 1 run of another study" in done.stderr, others, done.stderr)

    def test_a_misspelt_result_is_told_and_needs_no_run_again(self):
        keys = {"set": {"run.end": 0.03}, "grid": {"rig.slip": [0.1]}}
        done = self.furrow("sweep", self.study(**keys, results=["drawbar_pul_N.mean"]), "--no-plots",
                           says="has no result 'drawbar_pul_N.mean', expected 'drawbar_pull_N.mean' or ")
        self.assertEqual(self.table()[0]["drawbar_pul_N.mean"], "")
        done = self.furrow("sweep", self.study(**keys, results=["drawbar_pull_N.mean"]), "--no-plots",
                           says="is done already", lacks="has no result")
        self.assertNotEqual(self.table()[0]["drawbar_pull_N.mean"], "", done.stderr)

    def test_a_removed_folder_ends_it_and_is_not_made_anew(self):
        study = self.study(grid={"rig.slip": [0.1, 0.2, 0.3, 0.4]})
        out = self.folder / "results" / "study"
        for jobs in ("1", "2"):
            process = self.start("sweep", study, "--jobs", jobs)
            wait_for(lambda: list(out.glob("runs/*/.furrow-run")), 60, "a run of the study")
            shutil.rmtree(out, ignore_errors=True)
            err = self.ended(process, 5)
            self.assertEqual(err.count("furrow: error: "), 1, err)
            self.assertFalse(out.exists(), [str(path) for path in out.rglob("*")])
            self.assertEqual(survivors(self.folder), [])
        self.furrow("sweep", study, "--jobs", "2", "--no-plots")

    def test_a_failed_run_stops_no_other(self):
        # grains as soft as these leave the bin while they settle
        study = self.study(list=[{"rig.slip": 0.1},
                                 {"terrain.young_modulus": 1e3, "rig.carrier_mass": 20000, "run.end": 0.2},
                                 {"rig.slip": 0.2}])
        self.furrow("sweep", study, "--no-plots", code=3, errors=1,
                    says="sweep.csv: not every run finished; the first that failed has exit code")
        rows = self.table()
        self.assertEqual([row["state"] for row in rows], ["done", "failed", "done"])
        self.assertEqual(rows[1]["exit_code"], "3")
        self.assertIn("was lost", rows[1]["problem"])

    def test_a_killed_sweep_goes_on(self):
        study = self.study(grid={"rig.slip": [0.1, 0.2]}, set={"run.end": 0.2, "checkpoint.interval": 0.01})
        process = self.start("sweep", study)
        runs = self.folder / "results" / "study" / "runs"
        wait_for(lambda: list(runs.glob("*/checkpoints/0*")), 60, "a checkpoint")
        process.send_signal(signal.SIGTERM)
        self.ended(process, 75)
        self.assertEqual([row["state"] for row in self.table()], ["stopped", "waiting"])
        self.assertEqual(survivors(self.folder), [])
        self.furrow("sweep", study, "--no-plots", says="run 1 of 2 (rig.slip=0.1) continues")
        self.assertEqual([row["state"] for row in self.table()], ["done", "done"])
        folders = [self.folder / "results" / "study" / row["folder"] for row in self.table()]
        self.assertEqual([len(read_json(run / "summary.json")["segments"]) for run in folders], [2, 1])
        self.furrow("sweep", study, "--out", "whole", "--no-plots")
        self.assertEqual(differences(self.folder / "whole", self.folder / "results" / "study"), [])

    def test_a_run_whose_supervisor_was_killed_says_so(self):
        study = self.study(list=[{"rig.slip": 0.1}], set={"run.end": 0.2})
        process = self.start("sweep", study)
        supervisor = wait_for(lambda: children(process.pid), 60, "the run begins")[0]
        os.kill(supervisor, signal.SIGKILL)
        self.ended(process, 4, says="FAILED with exit code 4: killed by signal 9 (Killed)")

    def test_mistakes_are_told_before_anything_runs(self):
        for keys, words in (({"grid": {"rig.slpi": [1]}}, "key 'rig.slpi': is unknown, expected 'rig.slip'?"),
                            ({"grid": {"rig.slip": [0.1, 2]}}, "key 'rig.slip': is 2, expected"),
                            ({"grid": {"rig.slip": []}}, "key 'grid.rig.slip': expected a list of values"),
                            ({"grid": {}, "list": [{}]}, "has 'grid' and 'list', expected one of them"),
                            ({}, "expected one of 'grid', 'list' and 'passes'"),
                            ({"grid": {"rig.slip": [0.1, 0.2, 0.1]}}, "key 'grid': has the run 'rig.slip=0.1' twice"),
                            ({"grid": {"rig.slip": [0.1]}, "set": {"rig.slip": 0.2}},
                             "key 'grid.rig.slip': is in 'set' as well"),
                            ({"grid": {"rig.slip": [0.1]}, "rest": 0.1}, "key 'rest': is the time between passes"),
                            ({"passes": 0}, "key 'passes': is 0, expected a whole number"),
                            ({"passes": 2, "set": {"checkpoint.at_end": False}},
                             "key 'checkpoint.at_end': is false, expected true"),
                            ({"passes": 2, "set": {"terrain.engine": "rigid"}},
                             "key 'terrain.engine': is 'rigid', expected 'dem'"),
                            ({"list": [{"rig.slip": 0.1}], "plot": {"x": "rig.slipp", "y": "sinkage_m"}},
                             "key 'plot.x': is 'rig.slipp', expected"),
                            ({"list": [{"rig.slip": 0.1}], "plot": {"x": "rig.slip", "y": "q"}},
                             "key 'plot.y': is 'q', expected one of: drawbar_pull_N.mean"),
                            ({"list": [{"rig.slip": 0.1}], "plot": {"x": "rig.slip"}}, "key 'plot.y': is missing"),
                            ({"grid": {"rig.slip": [0.1, 0.2], "terrain.cohesion": [0, 1e3], "run.seed": [1, 2]},
                              "plot": {"x": "rig.slip", "y": "sinkage_m", "mean_over": "run.seed"}},
                             "key 'plot.mean_over': is 'run.seed', but runs of one point differ in 'terrain.cohesion'"),
                            ({"grid": {"rig.slip": [0.1, 0.2], "run.seed": [1, 2]}, "passes": 2,
                              "plot": {"x": "rig.slip", "y": "sinkage_m", "mean_over": "run.seed"}},
                             "key 'plot.mean_over': is 'run.seed', but runs of one point differ in 'pass'"),
                            ({"grid": {"run.threads": [1, 2]}},
                             "has a run with run.threads=1 and a run with run.threads=2, which have the same results"),
                            ({"terrain": {}}, "is a scenario, expected a study"),
                            ({"gird": {}}, "key 'gird': is unknown, expected 'grid'?"),
                            ({"scenario": "none.json", "passes": 1}, "key 'scenario': 'none.json' does not exist")):
            self.furrow("sweep", self.study(**keys), code=2, says=words)
            self.assertFalse((self.folder / "results").exists())

    def test_run_says_that_it_was_given_a_study(self):
        self.furrow("run", self.study(passes=1), code=2, says="is a study, expected a scenario")

    def test_shipped_studies_are_valid(self):
        for name in ("study_slip.json", "study_slip_angle.json", "study_camber.json",
                     "study_hard_slip.json", "study_handling.json", "multipass.json"):
            self.furrow("sweep", ROOT / "rigs" / name, "--out", "/proc/furrow", code=2,
                        says="key '--out': cannot be made")

    def test_passes_begin_on_the_bed_that_the_last_one_left(self):
        study = self.study(passes=2, rest=0.01, grid={"run.seed": [1, 2]},
                           set={"run.end": 0.15, "run.average_from": 0.1},
                           plot={"x": "pass", "y": "drawbar_pull_N.mean", "mean_over": "run.seed"})
        done = self.furrow("sweep", study, "--jobs", "2")
        self.assertEqual([(row["run.seed"], row["pass"], row["state"]) for row in self.table()],
                         [("1", "1", "done"), ("1", "2", "done"), ("2", "1", "done"), ("2", "2", "done")])
        self.assertEqual(done.stderr.count(": settled, net force"), 2, done.stderr)
        for plot in ("curve", "passes", "rut_along"):
            self.assertEqual((self.folder / "results" / "study" / f"{plot}.png").read_bytes()[:4], b"\x89PNG")
        first, second = [self.folder / "results" / "study" / row["folder"] for row in self.table()[:2]]
        a, b = [read_json(run / "summary.json") for run in (first, second)]
        self.assertEqual(a["grains"], b["grains"])
        self.assertEqual(a["surface_height_m"], b["surface_height_m"], "sinkage counts from another surface")
        with h5py.File(second / "results.h5") as file:
            before = file["terrain/height_before"][()]
        np.testing.assert_array_equal(before[np.isfinite(before)], a["surface_height_m"],
                                      "the rut counts from another surface")
        scenario = read_json(second / "scenario.json")
        self.assertTrue(scenario["terrain"]["bed"].endswith(f"beds/{first.name}_rest_0.01.h5"))
        self.assertNotEqual(a["state_hash"], b["state_hash"])
        # the bed of a pass is made again, bit for bit, so that the pass is still the one that is done
        (bed := self.folder / "results" / "study" / "beds" / f"{first.name}_rest_0.01.h5").write_bytes(b"damaged")
        again = self.furrow("sweep", study, "--no-plots")
        self.assertEqual(again.stderr.count("is done already"), 4, again.stderr)
        self.assertGreater(bed.stat().st_size, 1000)
        shutil.rmtree(second)
        self.furrow("sweep", study, "--no-plots")
        self.assertEqual(read_json(second / "summary.json")["state_hash"], b["state_hash"])

    def test_a_pass_goes_on_where_its_study_was_moved(self):
        keys = {"run.step": 2e-5, "run.end": 0.25, "run.average_from": 0.1, "checkpoint.interval": 0.02}
        study = self.study(passes=2, rest=0.01, set=keys)
        process = self.start("sweep", study, "--out", "before")
        second = lambda: [path for path in self.folder.glob("before/runs/*/checkpoints/0*")
                          if self.on_a_bed_of_the_study(path.parents[1])]
        wait_for(lambda: second() or process.poll() is not None, 120, "a checkpoint of the second pass")
        process.terminate()
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 75)
        (self.folder / "before").rename(self.folder / "after")
        self.furrow("sweep", study, "--out", "after", "--no-plots", says="continues")
        self.furrow("sweep", study, "--out", "whole", "--no-plots")
        hashes = [{path.parent.name: read_json(path)["state_hash"]
                   for path in self.folder.glob(f"{name}/runs/*/summary.json")} for name in ("after", "whole")]
        self.assertEqual(*hashes)
        self.assertEqual(len(hashes[0]), 2)

    def on_a_bed_of_the_study(self, run):
        return "bed" in read_json(run / "scenario.json")["terrain"]


if __name__ == "__main__":
    main()
