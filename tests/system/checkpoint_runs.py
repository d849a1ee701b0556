"""What the tests of checkpoints share: a run of a second, the same run made to fail at a named point, and
comparisons."""
import os
import pathlib
import shutil
import signal
import sys
import tempfile

from program import ROOT, SystemTest, changed, furrow, read_json, rows_of, survivors, wait_for, write_scenario

sys.path.insert(0, str(ROOT / "tests" / "campaign"))
from compare_runs import differences  # noqa: E402

FAULTY = os.environ.get("FURROW_FAULTY", str(ROOT / "build" / "furrow_faults"))
INTERVAL, STEPS = 100, 500  # steps between checkpoints, steps of the run
RANKS = {"rig": 0, "tire": 1, "terrain": 2}

# The wheel comes down within the first half: frames of a wheel in the air would show no forces whatever is saved.
RUN = changed(rig={"touchdown_damping": 0}, run={"step": 2e-4, "end": 0.1, "average_from": 0.04, "peer_timeout": 20},
              output={"series_interval": 0.002, "frame_interval": 0.01}, checkpoint={"interval": 0.02, "keep": 3})
FLEXIBLE = changed(tire={"file": "hmmwv_layered.json", "rigid": False, "elements_circumference": 30,
                         "elements_width": 12}, run=RUN["run"], output=RUN["output"], checkpoint=RUN["checkpoint"])


def steps(run):
    """Of the complete checkpoints, oldest first."""
    folder = pathlib.Path(run) / "checkpoints"
    return sorted(int(entry.name) for entry in folder.iterdir() if entry.name.isdigit()) if folder.exists() else []


def summary(run):
    return read_json(pathlib.Path(run) / "summary.json")


def table(run):
    """The lines of the series."""
    return rows_of(pathlib.Path(run) / "timeseries.csv")


class CheckpointTest(SystemTest):
    """`whole` is the run that nothing disturbs."""
    SCENARIO = RUN
    PROGRAM = FAULTY

    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory(prefix="furrow whole ")
        cls.addClassCleanup(holder.cleanup)
        cls.whole = pathlib.Path(holder.name) / "whole"
        path = write_scenario(holder.name, cls.SCENARIO)
        done = furrow("run", path, "--out", cls.whole, "--no-plots", cwd=holder.name, program=cls.PROGRAM)
        assert done.returncode == 0, done.stderr

    def setUp(self):
        super().setUp()
        self.path = write_scenario(self.folder, self.SCENARIO)
        self.run_folder = self.folder / "out"
        self.mark = self.folder / "fired"

    def program(self, *arguments, **expected):
        done = self.furrow(*arguments, program=self.PROGRAM, **expected)
        self.no_process_left()
        return done

    def fault(self, point, rank, count, action):
        return {"FURROW_FAULT": f"{point}:{rank}:{count}:{action}", "FURROW_FAULT_FIRED": str(self.mark)}

    def run_with_fault(self, point, rank, count, action, code=4, flags=(), **expected):
        done = self.program("run", self.path, "--out", self.run_folder, "--no-plots", *flags, code=code,
                            env=self.fault(point, rank, count, action), **expected)
        self.assertTrue(self.mark.exists(), f"the fault {point} of rank {rank} did not fire")
        return done

    def start_waiting(self, point, rank, count, run=None, env=(), flags=()):
        """A run that waits at the point until self.mark is removed."""
        process = self.start("run", self.path, "--out", run or self.run_folder, "--no-plots", *flags,
                             program=self.PROGRAM, env={**self.fault(point, rank, count, "wait"), **dict(env)})
        wait_for(lambda: self.mark.exists() or process.poll() is not None, 150, "the fault fires")
        self.assertIsNone(process.poll(), process.stderr.read() if process.poll() is not None else "")
        return process

    def resume(self, *flags, run=None, **expected):
        return self.program("resume", run or self.run_folder, "--no-plots", *flags, **expected)

    def continues(self, run=None, leave_out=()):
        """The run goes on to the end of the whole one. @param leave_out files that differ by intent"""
        self.resume(run=run)
        self.same_as_whole(run, leave_out)

    def afresh(self):
        """Nothing is left of the run and of its fault."""
        shutil.rmtree(self.run_folder, ignore_errors=True)
        self.mark.unlink(missing_ok=True)

    def released(self, process, code=0, **told):
        """A run that has waited goes on to this exit code. @returns what it said on standard error"""
        self.mark.unlink()
        return self.ended(process, code, **told)

    def told_to_stop(self, process, number=signal.SIGTERM):
        """A run that waits has noticed the signal."""
        process.send_signal(number)
        while "stopping" not in process.stderr.readline():
            pass

    def no_process_left(self, but=None):
        """@param but a text of command lines that may be left"""
        def left():
            return [command for command in survivors(self.folder) if not (but and but in command)]
        wait_for(lambda: not left(), 10, lambda: f"all processes end, still there: {left()}")

    def copy_of_whole(self):
        """The whole run as if it had died in its last step."""
        shutil.copytree(self.whole, self.run_folder)
        for name in ("summary.json", "results.h5"):
            (self.run_folder / name).unlink()
        return self.run_folder

    def cut_to(self, step):
        """The whole run as if it had died after the checkpoint of this step."""
        self.afresh()
        self.copy_of_whole()
        for later in [s for s in steps(self.whole) if s > step]:
            shutil.rmtree(self.run_folder / "checkpoints" / f"{later:012}")

    def same_as_whole(self, run=None, leave_out=()):
        """@param leave_out files that differ by intent"""
        self.assertEqual(differences(self.whole, run or self.run_folder, leave_out), [])
