#!/usr/bin/python3
"""Checkpoints and `furrow resume`: the run that continues is bit for bit the one that was not interrupted."""
import os
import pathlib
import shutil
import signal
import subprocess
import unittest

from checkpoint_runs import FAULTY, FLEXIBLE, INTERVAL, STEPS, CheckpointTest, steps, summary, table
from program import HAS_OTHER_MATHEMATICS, OTHER_MATHEMATICS, PROGRAM, main, read_json, write_json


class Signals(CheckpointTest):
    def test_term_int_and_usr1_leave_a_checkpoint_to_go_on_from(self):
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGUSR1):
            with self.subTest(number.name):
                run = self.folder / number.name
                process = self.start_waiting("step", 0, 250, run=run)
                self.told_to_stop(process, number)
                err = self.released(process, 75, prints=f"{run}\n", says="furrow: to continue from the last "
                                    f"checkpoint: furrow resume '{run}'")
                self.assertNotIn("error", err)
                self.assertFalse((run / "summary.json").exists())
                self.assertTrue((run / "results.h5").exists())
                stopped = steps(run)[-1]
                self.assertIn(stopped, range(250, 270))
                self.continues(run)
                self.assertEqual([s["from_step"] for s in summary(run)["segments"]], [0, stopped])


class Resume(CheckpointTest):
    def test_checkpoints_come_at_their_interval_and_the_newest_are_kept(self):
        self.assertEqual(steps(self.whole), [STEPS - 2 * INTERVAL, STEPS - INTERVAL, STEPS])

    def test_other_threads_give_the_same_bits_and_are_recorded(self):
        self.run_with_fault("step", 2, 350, "kill", flags=["--threads", "2"])
        self.resume("--threads", "1")
        self.same_as_whole(leave_out=["scenario.json", "checkpoints/*/manifest.json"])
        first, second = summary(self.run_folder)["segments"]
        self.assertEqual((first["threads"], second["threads"]), (2, 1))
        self.assertEqual(second["changed"], {"run.threads": 1})

    def test_again_and_again(self):
        self.run_with_fault("step", 1, 150, "kill")
        for count in (120, 110):
            self.furrow("resume", self.run_folder, "--no-plots", program=FAULTY, env=self.fault("step", 1, count,
                                                                                                "kill"), code=4)
        self.continues()
        self.assertEqual([s["from_step"] for s in summary(self.run_folder)["segments"]], [0, 100, 200, 300])

    def test_a_later_end_is_as_if_it_had_been_so_from_the_start(self):
        self.program("run", self.path, "--out", self.run_folder, "--set", "run.end=0.06", "--no-plots")
        self.resume("--until", "0.1")
        self.same_as_whole(leave_out=["checkpoints/*/manifest.json"])  # those of the first part hold the earlier end
        self.assertEqual(summary(self.run_folder)["segments"][1]["changed"], {"run.end": 0.1})

    def test_another_output_rate_leaves_the_state_alone_and_numbers_frames_on(self):
        self.run_with_fault("step", 0, 250, "kill")
        self.resume("--set", "output.frame_interval=0.02")
        self.assertEqual(summary(self.run_folder)["state_hash"], summary(self.whole)["state_hash"])
        frames = sorted(path.name for path in (self.run_folder / "frames").glob("tire0_*"))
        # every 50 steps before step 200, every 100 from there to 500
        self.assertEqual(frames, [f"tire0_{i:06}.h5" for i in range(4 + 4)])
        rows = table(self.run_folder)
        times = [round(float(row["time_s"]) * 1e3) for row in rows]
        self.assertEqual(times, [*range(2, 101, 2)])

    def test_lines_that_means_count_equally_stay_equally_long(self):
        self.run_with_fault("step", 0, 250, "kill")
        self.resume("--set", "output.series_interval=0.004", code=2, matches=r"key 'output.series_interval': is 0.004 "
                    r".* 0.002, expected the same: .* means count all lines of a series equally")

    def test_a_finished_run_that_has_lost_results_says_so(self):
        run = self.copy_of_whole()
        shutil.copyfile(self.whole / "summary.json", run / "summary.json")
        self.resume(says="results.h5: is missing and is written again from the last checkpoint")
        self.same_as_whole()
        (run / "timeseries.csv").unlink()
        said = self.resume().stderr
        self.assertIn("timeseries.csv: is missing and cannot be made again: bring it back, or", said)
        self.assertIn("there is nothing to do", said)
        (run / "summary.json").unlink()
        said = self.resume(code=5).stderr
        self.assertIn("timeseries.csv: is missing, and a run cannot be continued without the lines", said)

    def test_what_may_not_be_read_is_neither_missing_nor_damaged(self):
        user = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"]
        if os.geteuid() != 0 or not shutil.which("setpriv"):
            self.skipTest("needs root and setpriv")
        if subprocess.run([*user, FAULTY, "--version"], capture_output=True).returncode != 0:
            self.skipTest("another user may not run the program where it lies")
        for closed, words in (("checkpoints", "checkpoints: cannot be read: Permission denied"),
                              ("checkpoints/000000000500",
                               "000000000500/manifest.json: cannot be read: Permission denied"),
                              ("checkpoints/000000000500/tire0.h5", "tire0.h5: cannot be read: Permission denied"),
                              ("", "out: cannot be read: Permission denied, expected the folder of a run")):
            shutil.rmtree(self.run_folder, ignore_errors=True)
            run = self.copy_of_whole()
            for path in [self.folder, run, *run.rglob("*")]:
                os.chown(path, 65534, 65534)
            mode = (run / closed).stat().st_mode
            os.chmod(run / closed, 0)
            done = subprocess.run([*user, FAULTY, "resume", run, "--no-plots"], capture_output=True, text=True,
                                  env={**os.environ, "HOME": str(self.folder)})
            os.chmod(run / closed, mode)
            self.expect(done, done.returncode, says=words, lacks="--overwrite")

    def test_a_pipe_in_the_place_of_a_file_is_not_waited_for(self):
        run = self.copy_of_whole()
        part = next((run / "checkpoints").glob("*500")) / "tire0.h5"
        part.unlink()
        os.mkfifo(part)
        self.resume(says="tire0.h5: does not exist or is no file: the checkpoint is not complete")
        self.same_as_whole()
        for name in ("summary.json", "results.h5", "frames/tire0_000002.h5"):
            (run / name).rename(run / "kept")
            os.mkfifo(run / name)
            self.program("report", run, code=2, says=f"{name}: is not a file, expected one that furrow wrote")
            (run / "kept").rename(run / name)

    def test_a_finished_run_has_nothing_to_do(self):
        before = {path: path.stat().st_mtime_ns for path in self.whole.rglob("*")}
        self.resume(run=self.whole, says="there is nothing to do", prints=f"{self.whole}\n")
        self.assertEqual({path: path.stat().st_mtime_ns for path in self.whole.rglob("*")}, before)

    def test_changed_physics_is_refused_by_its_key(self):
        run = self.copy_of_whole()
        for setting, key, was in (("rig.slip=0.5", "rig.slip", "0.3"),
                                  ("terrain.cohesion=1e3", "terrain.cohesion", "80e3"),
                                  ("run.step=1e-4", "run.step", "0.0002"), ("run.seed=2", "run.seed", "1"),
                                  ("terrain.engine=rigid", "terrain.engine", "'dem'")):
            self.resume("--set", setting, code=2, says=(f"key '{key}': is ", f"but the run was computed with {was}"))
        # also where the file was edited
        scenario = read_json(run / "scenario.json")
        scenario["terrain"]["friction"] = 0.5
        write_json(run / "scenario.json", scenario)
        self.resume(code=2, says="key 'terrain.friction': is 0.5")
        self.assertFalse((run / "summary.json").exists())
        self.assertEqual(steps(run), steps(self.whole))

    def test_an_earlier_end_is_refused(self):
        self.copy_of_whole()
        self.resume("--until", "0.06", code=2, says="key 'run.end': is 0.06 s, but the run has reached 0.1 s")

    def test_nothing_goes_on_without_its_checkpoint(self):
        run = self.copy_of_whole()
        shutil.rmtree(run / "checkpoints")
        self.resume(code=2, says="holds no checkpoint")
        self.assertFalse((run / "summary.json").exists())

    def test_a_lost_scenario_is_restored_from_the_checkpoint(self):
        run = self.copy_of_whole()
        (run / "scenario.json").unlink()
        self.resume(matches=r"warning: \S.*scenario\.json: was missing and is restored from \S.*checkpoints/\d+")
        self.same_as_whole()

    def test_another_build_is_warned_of(self):
        self.copy_of_whole()
        self.furrow("resume", self.run_folder, "--no-plots", says="the checkpoint is of another build of furrow")

    @unittest.skipUnless(HAS_OTHER_MATHEMATICS, "needs a processor with FMA")
    def test_other_mathematics_of_the_c_library_are_warned_of(self):
        self.copy_of_whole()
        done = self.resume(env=OTHER_MATHEMATICS, says="the C library's mathematical functions give other last digits")
        self.assertEqual(done.stderr.count("not bit for bit"), 1)

    def test_under_the_users_mpirun(self):
        self.run_with_fault("step", 0, 250, "kill")
        command = [shutil.which("mpirun"), "--allow-run-as-root", "--oversubscribe", "--bind-to", "none", "-n", "3",
                   FAULTY, "resume", str(self.run_folder)]
        self.call(command)
        self.same_as_whole()


class FlexibleTire(CheckpointTest):
    SCENARIO = FLEXIBLE

    def test_in_the_middle_of_a_factors_life(self):
        rows = table(self.whole)
        made = [int(float(row["factorizations"])) for row in rows]
        alive = [s for s in (100, 200, 300, 400) if made[s // 10 - 2] == made[s // 10 + 1] > 0]
        self.assertTrue(alive, f"no factor lives through a checkpoint: {made}")
        self.run_with_fault("step", 1, alive[0] + 50, "kill")
        self.continues()
        self.assertEqual(summary(self.run_folder)["segments"][1]["from_step"], alive[0])


class Release(unittest.TestCase):
    def test_the_released_program_knows_no_faults(self):
        self.assertNotIn(b"FURROW_FAULT", pathlib.Path(PROGRAM).read_bytes())
        self.assertIn(b"FURROW_FAULT", pathlib.Path(FAULTY).read_bytes())


if __name__ == "__main__":
    main()
