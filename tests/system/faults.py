#!/usr/bin/python3
"""Faults at named points (fault_injection.cpp) and damaged files: what the user sees, the exit code, no process left,
and the run goes on from the last good checkpoint to the very same result."""
import contextlib
import os
import shutil
import signal
import subprocess
import threading
import time
import unittest

from checkpoint_runs import FAULTY, INTERVAL, RANKS, STEPS, CheckpointTest, differences, steps, summary
from program import children, main, read_json, start, write_json

LAUNCHER = " --oversubscribe "  # on its command line: one left without ranks is ended by who waits for the folder

# (point, rank, which time, step at which the run continues at the latest)
KILLS = [
    ("step", "rig", 250, 200),
    ("step", "tire", 250, 200),
    ("step", "terrain", 250, 200),
    ("frame", "tire", 6, 200),  # of step 250
    ("frame", "terrain", 6, 200),
    ("checkpoint.write", "rig", 2, 100),
    ("checkpoint.write", "tire", 2, 100),
    ("checkpoint.written", "terrain", 2, 100),
    ("checkpoint.manifest", "rig", 2, 100),
    ("checkpoint.rename", "rig", 2, 100),
    ("checkpoint.done", "rig", 2, 200),
    ("results", "rig", 1, 500),
]


class Killed(CheckpointTest):
    """kill -9, one test per row of KILLS."""

    def check(self, point, name, count, step):
        node = "tire 0" if name == "tire" else name
        self.run_with_fault(point, RANKS[name], count, "kill", says=(
            f"furrow: error: rank {RANKS[name]} ({node}) was lost: killed by signal 9",
            f"furrow resume '{self.run_folder}'"))
        self.assertEqual(steps(self.run_folder)[-1], step)
        if point == "checkpoint.done":  # what there is can be read
            self.furrow("report", self.run_folder)
            for plot in (*self.run_folder.glob("*.png"), *self.run_folder.glob("report.html")):
                plot.unlink()
        self.continues()
        self.assertEqual(summary(self.run_folder)["segments"][1]["from_step"], step)


    def test_a_rank_after_all_results(self):
        self.run_with_fault("done", RANKS["rig"], 1, "kill", code=0,
                            says="furrow: warning: the run had finished before this happened: rank 0 (rig) was lost")
        self.assertFalse((self.run_folder / "summary_failed.json").exists())
        self.same_as_whole()


for row in KILLS:
    setattr(Killed, f"test_{row[0].replace('.', '_')}_{row[1]}", lambda self, row=row: self.check(*row))


class ProgramFault(CheckpointTest):
    def test_an_exception_that_no_code_expects(self):
        self.run_with_fault("step", RANKS["tire"], 250, "throw", code=70,
                            says="furrow: error: fault of the program: thrown by a test; please report it")
        failed = read_json(self.run_folder / "summary_failed.json")["failed"]
        self.assertEqual(failed["exit_code"], 70)
        self.continues()

    def test_a_precondition_that_does_not_hold(self):
        self.run_with_fault("step", RANKS["terrain"], 250, "misuse", code=70, matches=(
            r"furrow: error: fault of the program: .*fault_injection.cpp:\d+: fire: precondition failed: "
            r"action != \"misuse\" \[action = misuse\]; please report it"))
        self.continues()


class KilledAtTheStart(CheckpointTest):
    """Before MPI connects the ranks."""

    def test_a_rank(self):
        self.run_with_fault("start", 1, 1, "kill", says="furrow: error: rank 1 (tire 0) was lost: killed by signal 9")

    def test_the_launcher(self):
        process = self.start_waiting("start", 1, 1)
        os.kill(children(process.pid)[0], signal.SIGKILL)
        self.ended(process, 4, says="furrow: error: the ranks were lost while they were being started: mpirun was "
                   "killed by signal 9")
        self.no_process_left()


class Stopped(CheckpointTest):
    def test_a_rank_that_stops_is_named_and_the_run_goes_on_without_it(self):
        self.run_with_fault("step", 1, 250, "stop", flags=["--set", "run.peer_timeout=2"],
                            matches=r"furrow: error: .*waited 2 s for tire 0 .*tire 0 does not answer")
        self.continues(leave_out=["scenario.json", "checkpoints/*/manifest.json"])  # they hold the key


class LauncherThatDoesNotEnd(CheckpointTest):
    """Two threads of Open MPI 4.1's mpirun may wait for each other for ever as it shuts down."""
    LOG = "mpirun did not end although its ranks had; it is killed"

    def launcher(self, then):
        """@param then what it does once all is over, in Python"""
        path = self.folder / "launcher"
        path.write_text("#!/usr/bin/python3\nimport signal, subprocess, sys, time\n"
                        "for number in signal.SIGTERM, signal.SIGUSR1: signal.signal(number, lambda *_: "
                        "mpirun.send_signal(number))\n"
                        f"mpirun = subprocess.Popen(['mpirun', "
                        f"*sys.argv[1:]])\nmpirun.wait()\n{then}\ntime.sleep(1000)\n")
        path.chmod(0o755)
        return {"FURROW_MPIRUN": str(path)}

    def hung(self):
        self.assertIn(self.LOG, (self.run_folder / "run.log").read_text())

    def test_once_all_ranks_are_done_is_killed_and_the_run_is_done(self):
        self.program("run", self.path, "--out", self.run_folder, "--no-plots", env=self.launcher(""), lacks="warning")
        self.hung()
        self.same_as_whole()

    def test_once_all_ranks_have_stopped_is_killed_and_the_run_goes_on(self):
        process = self.start_waiting("step", 0, 250, env=self.launcher(""))
        self.told_to_stop(process)
        time.sleep(1)  # the signal passes through the launcher
        self.released(process, 75, says="furrow: stopped by a signal; partial results are in")
        self.hung()
        self.continues()

    def test_whose_supervisor_was_killed_is_killed_by_who_waits_for_the_folder(self):
        process = self.start_waiting("step", 0, 250, env=self.launcher(""))
        process.kill()
        self.mark.unlink()
        process.communicate(timeout=60)
        self.resume(matches=r"furrow: process \d+ \(.*launcher .*\) did not end although its ranks had; it is killed")
        self.no_process_left()
        self.same_as_whole()

    def test_after_a_rank_was_lost_is_killed_and_the_loss_is_told(self):
        begin = time.monotonic()
        done = self.program("run", self.path, "--out", self.run_folder, "--no-plots", "--set", "run.peer_timeout=2",
                            code=4, env={**self.fault("step", 1, 250, "kill"), **self.launcher("")})
        self.assertGreater(time.monotonic() - begin, 20)
        self.assertIn("furrow: error: rank 1 (tire 0) was lost: killed by signal 9", done.stderr)
        self.hung()

    def test_that_takes_no_notice_of_its_ranks_is_killed_sooner(self):
        begin = time.monotonic()
        ended = f"subprocess.Popen([{FAULTY!r}, '--version'], stdout=subprocess.DEVNULL)"
        done = self.program("run", self.path, "--out", self.run_folder, "--no-plots", code=4,
                            env={**self.fault("step", 1, 250, "kill"), **self.launcher(ended)})
        self.assertLess(time.monotonic() - begin, 38)  # the time-out of peers and 20 s
        self.assertIn("furrow: error: rank 1 (tire 0) was lost: killed by signal 9", done.stderr)
        self.hung()


class LostCheckpoint(CheckpointTest):
    """Its folder is removed before it is complete."""
    LOST = "s could not be written: "

    def lose(self, count, step, flags=()):
        """The count-th checkpoint, of this step. @returns the process, which goes on once its mark is removed"""
        process = self.start_waiting("checkpoint.manifest", RANKS["rig"], count, flags=flags)
        shutil.rmtree(self.run_folder / "checkpoints" / f".{step:012}.part")
        return process

    def test_before_the_end_is_a_warning(self):
        told = self.released(self.lose(2, 200), says=f"furrow: warning: the checkpoint at t = 0.04 {self.LOST}")
        self.assertNotIn("furrow: error", told)
        self.same_as_whole()

    def test_of_the_end_is_an_error_after_all_results_are_written(self):
        for count, flags in ((STEPS // INTERVAL, ()), (1, ("--set", "checkpoint.interval=1"))):
            with self.subTest(flags):
                self.afresh()
                self.released(self.lose(count, STEPS, flags), code=5, says=(
                    f"furrow: error: the checkpoint at t = 0.1 {self.LOST}",
                    "; all results are written, but the run cannot be continued from its end"))
                self.assertFalse((self.run_folder / "summary_failed.json").exists())
                self.assertRegex(" ".join(differences(self.whole, self.run_folder, ["scenario.json", "checkpoints/*"])),
                                 r"^checkpoints: the newest is 000000000500 and (000000000400|none)$")
                self.resume(says="is finished")

    def test_of_the_end_that_nobody_asked_for_is_a_warning(self):
        flags = ("--set", "checkpoint.at_end=false")
        told = self.released(self.lose(STEPS // INTERVAL, STEPS, flags), says=self.LOST)
        self.assertNotIn("furrow: error", told)


class FullDisk(CheckpointTest):
    """On a real tmpfs of 8 MB, filled at the point."""

    def setUp(self):
        super().setUp()
        self.disk = self.small_disk(self.folder / "disk", "8m")
        self.run_folder = self.disk / "out"

    @contextlib.contextmanager
    def kept_full(self):
        """Room that the run makes by removing what it could not write is filled as well."""
        over = threading.Event()

        def fill():
            with open(self.disk / "ballast", "wb", buffering=0) as ballast:
                while not over.is_set():
                    try:
                        ballast.write(bytes(4096))
                    except OSError:
                        full.set()
                        over.wait(1e-3)
        full, filler = threading.Event(), threading.Thread(target=fill)
        filler.start()
        full.wait()
        try:
            yield
        finally:
            over.set()
            filler.join()
            (self.disk / "ballast").unlink()

    def check(self, point, rank, count, expected, step):
        process = self.start_waiting(point, rank, count)
        with self.kept_full():
            self.mark.unlink()
            _, err = process.communicate(timeout=60)
            self.no_process_left()
        self.assertEqual(process.returncode, 5, err)
        self.assertRegex(err, expected)
        self.assertEqual(steps(self.run_folder)[-1], step)
        self.continues()

    def test_in_a_checkpoint_it_is_told_and_the_last_one_stays(self):
        # The terrain waits, so that another rank may be the first to write; a frame of the same step may end the run
        # before the rig tells of the checkpoint.
        told = (r"the checkpoint at t = 0.04 s could not be written: .*\.h5: cannot|error: .*frames/t\w+_000004.h5: "
                r"cannot")
        self.check("checkpoint.write", 2, 2, told, 100)

    def test_in_a_frame(self):
        self.check("frame", 2, 6, r"furrow: error: .*frames/t.*_00000[5-6].h5: cannot", 200)

    def test_in_the_results(self):
        self.check("results", 0, 1, r"furrow: error: .*(results.h5|timeseries.csv|summary.json)", 500)


class Damaged(CheckpointTest):
    def setUp(self):
        super().setUp()
        self.run = self.copy_of_whole()
        self.newest = self.run / "checkpoints" / f"{STEPS:012}"

    def goes_on_from_the_one_before(self, words):
        self.resume(says=(f"furrow: warning: {self.newest}", words))
        self.assertEqual(summary(self.run)["segments"][-1]["from_step"], STEPS - INTERVAL)
        self.same_as_whole()

    def test_truncated(self):
        file = self.newest / "terrain.h5"
        os.truncate(file, file.stat().st_size // 2)
        self.goes_on_from_the_one_before("terrain.h5")

    def test_a_flipped_bit_in_every_file(self):
        for name in ("manifest.json", "rig.h5", "tire0.h5", "terrain.h5"):
            with self.subTest(name):
                shutil.rmtree(self.run)
                self.copy_of_whole()
                data = bytearray((self.newest / name).read_bytes())
                data[len(data) // 2] ^= 1
                (self.newest / name).write_bytes(data)
                self.goes_on_from_the_one_before(name)

    def test_missing_part(self):
        (self.newest / "tire0.h5").unlink()
        self.goes_on_from_the_one_before("tire0.h5: does not exist")

    def test_part_of_another_checkpoint(self):
        shutil.copy(self.run / "checkpoints" / f"{STEPS - INTERVAL:012}" / "rig.h5", self.newest)
        self.goes_on_from_the_one_before("rig.h5: does not fit its checkpoint")

    def test_of_a_newer_program(self):
        manifest = read_json(self.newest / "manifest.json")
        manifest["format_version"] = 4
        write_json(self.newest / "manifest.json", manifest)
        self.goes_on_from_the_one_before("has format_version 4, but this program reads 3")

    def test_of_another_scenario(self):
        manifests = sorted((self.run / "checkpoints").glob("*/manifest.json"))
        for manifest in manifests[:-1]:
            shutil.rmtree(manifest.parent)
        shutil.rmtree(self.newest)
        other = self.folder / "other"
        self.program("run", self.path, "--out", other, "--set", "run.seed=2", "--no-plots")
        shutil.copytree(other / "checkpoints" / f"{STEPS:012}", self.newest)
        self.resume(code=2, says="key 'run.seed': is 1 but the run was computed with 2")

    def test_all_of_them(self):
        for part in (self.run / "checkpoints").glob("*/terrain.h5"):
            os.truncate(part, 100)
        done = self.resume(code=5, says="no checkpoint is whole, nothing can be continued")
        self.assertEqual(done.stderr.count("terrain.h5: does not fit its checkpoint"), 3)

    def test_series_that_was_written_on(self):
        shutil.rmtree(self.newest)
        with open(self.run / "timeseries.csv", "a") as series:
            series.write("0.102,0.3,")  # a line cut short
        self.continues()

    def test_series_that_was_changed(self):
        text = (self.run / "timeseries.csv").read_text()
        (self.run / "timeseries.csv").write_text(text.replace("0", "1", 1))
        self.resume(code=5, says="timeseries.csv: does not hold the lines that the checkpoint knows")

    def test_series_and_summary_that_were_emptied_are_no_finished_run(self):
        for name in ("timeseries.csv", "summary.json"):
            (self.run / name).write_text("")
        told = self.resume(code=5).stderr
        self.assertIn("timeseries.csv: does not hold the lines that the checkpoint knows", told)
        self.assertNotIn("is finished", told)

    def test_frames_that_were_lost_are_told(self):
        (self.run / "frames" / "terrain_000001.h5").unlink()
        os.truncate(self.run / "frames" / "tire0_000003.h5", 1000)
        told = self.resume().stderr
        self.assertIn(f"furrow: warning: {self.run}/frames/terrain_000001.h5 is missing or cannot be read: "
                      "results.xdmf leaves out 2 instants\n", told)

    def test_a_log_that_is_no_file(self):
        (self.run / "run.log").unlink()
        os.mkfifo(self.run / "run.log")
        self.resume(code=2, says="run.log: is not a file, expected one")


class Folder(CheckpointTest):
    def test_two_on_one_folder(self):
        process = self.start_waiting("step", 0, 250)
        others = [start(*command, cwd=self.folder) for command in  # they wait for 10 s, together
                  (["resume", self.run_folder], ["run", self.path, "--out", self.run_folder, "--overwrite"])]
        for other in others:
            self.ended(other, 2, says="is in use by a run that has not ended")
        self.released(process)
        self.same_as_whole()

    @unittest.skipIf(os.geteuid() == 0 and not shutil.which("setpriv"), "needs a user who is not root")
    def test_read_only(self):
        run = self.copy_of_whole()
        for path in (self.folder, run):
            os.chmod(path, 0o555)
        command = [FAULTY, "resume", str(run)]
        if os.geteuid() == 0:
            command = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", *command]
        done = subprocess.run(command, cwd="/", capture_output=True, text=True)
        os.chmod(self.folder, 0o755)
        self.expect(done, 2, says="cannot be written, expected a place that can be written")

    def test_killed_supervisor(self):
        process = self.start_waiting("step", 1, 250)
        process.send_signal(signal.SIGKILL)
        process.communicate(timeout=10)
        self.mark.unlink()
        self.no_process_left(but=LAUNCHER)
        self.continues()

    def test_killed_supervisor_of_ranks_that_are_being_started(self):
        """MPI may be stuck, as it is where memory is scarce: nobody waits for it."""
        process = self.start_waiting("start", 1, 1)
        process.send_signal(signal.SIGKILL)
        process.communicate(timeout=10)
        self.no_process_left(but=LAUNCHER)
        self.resume(code=2, says="start again with furrow run --overwrite")
        self.program("run", self.path, "--out", self.run_folder, "--no-plots", "--overwrite")
        self.same_as_whole()


if __name__ == "__main__":
    main()
