#!/usr/bin/python3
"""Runs under Slurm: a job that is signalled, queued again and continued leaves the files of an undisturbed run, whoever
queues it again, also with four wheels on two ranks of LIGGGHTS; ranks that srun starts; and what is refused. Needs
Debian's slurm-wlm and munge; skipped without them."""
import csv
import os
import subprocess
import sys
import time
import unittest

import slurm
from checkpoint_runs import FAULTY, CheckpointTest, steps
from liggghts import LIBRARY, on_liggghts
from program import changed, wait_for


class ClusterTest(CheckpointTest):
    """On a cluster of its own. The undisturbed run is one without Slurm."""
    REQUEUE_EXIT = True
    CORES = 2  # that the node says it has, and that the job takes
    MEMORY = 2000  # MB
    STOPPED_AT = 250

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.cluster = slurm.Cluster(cls.REQUEUE_EXIT, cls.CORES, cls.MEMORY)
        cls.addClassCleanup(cls.cluster.end)

    def script(self, *flags):
        """The path of what `furrow ranks --slurm` prints."""
        job = ["--cores-per-node", self.CORES, "--partition", "all", "--time", "10"]
        done = self.furrow("ranks", "--slurm", *job, *flags, self.path, "--out", self.run_folder, program=FAULTY)
        path = self.folder / "job.sh"
        # the plots of the other run were left out, too
        path.write_text(done.stdout.replace('"$program" run', '"$program" run --no-plots')
                        .replace('"$program" resume', '"$program" resume --no-plots'))
        return path

    def srun(self, *arguments, mpi="pmix", count=3):
        return self.cluster.call("srun", f"--mpi={mpi}", "-K1", "--cpu-bind=none", "--overcommit", "-n", count, FAULTY,
                                 *arguments, cwd=self.folder, check=False)

    def requeued_job_ends_as_if_undisturbed(self, **env):
        number = self.cluster.submit(self.script(), cwd=self.folder,
                                     env={**self.fault("step", 0, self.STOPPED_AT, "wait"), **env})
        self.addCleanup(self.cluster.call, "scancel", "--quiet", number, check=False)
        wait_for(self.mark.exists, 60,
                 lambda: f"the job comes to its step {self.STOPPED_AT}: {self.cluster.job(number)}")
        self.cluster.call("scancel", "--batch", "--signal=USR1", number)
        said = self.folder / f"slurm-{number}.out"
        wait_for(lambda: "stopping" in said.read_text(), 20, "the signal comes")
        self.mark.unlink()
        self.cluster.wait_for_state(number, lambda job: job["Restarts"] == "1"
                                    and job["JobState"] in ("PENDING", "RUNNING"), 60)
        time.sleep(3)  # Slurm refuses what it began in the same second; on its own it lets two minutes pass
        wait_for(lambda: self.cluster.call("scontrol", "update", f"JobId={number}", "StartTime=now",
                                           check=False).returncode == 0, 30, "the job need not wait for two minutes")
        self.cluster.wait_for_state(number, lambda job: job["JobState"] == "COMPLETED", 240)
        text = said.read_text()
        time_then = self.STOPPED_AT * self.SCENARIO["run"]["step"]
        self.assertRegex(text, rf"furrow: continuing small from t = {time_then:.3f}\d* s")
        self.assertIn("furrow: small, results in", text)
        self.same_as_whole()


class QueuedAgainBySlurm(ClusterTest):
    def test_job_ends_as_if_undisturbed(self):
        self.requeued_job_ends_as_if_undisturbed()

    def test_job_whose_ranks_srun_starts_ends_as_if_undisturbed(self):
        self.requeued_job_ends_as_if_undisturbed(FURROW_MPIRUN=self.cluster.path_of("srun"))

    def test_a_rank_that_dies_under_srun_is_named(self):
        script = self.folder / "job.sh"
        script.write_text(f"#!/bin/bash\nexec '{FAULTY}' run --no-plots '{self.path}' --out '{self.run_folder}'\n")
        number = self.cluster.submit(script, cwd=self.folder, env={**self.fault("step", 1, 250, "kill"),
                                                                   "FURROW_MPIRUN": self.cluster.path_of("srun")})
        self.cluster.wait_for_state(number, lambda job: job["JobState"] == "FAILED", 120)
        self.assertEqual(self.cluster.job(number)["ExitCode"], "4:0")
        text = (self.folder / f"slurm-{number}.out").read_text()
        self.assertIn("furrow: error: rank 1 (tire 0) was lost: killed by signal 9", text)
        self.continues()

    def test_ranks_that_srun_starts(self):
        done = self.srun("run", self.path, "--out", self.run_folder, "--no-plots")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.same_as_whole(leave_out=["run.log"])

    def test_a_wrong_number_of_ranks_is_refused_once(self):
        done = self.srun("run", self.path, "--out", self.run_folder, count=2)
        self.assertNotEqual(done.returncode, 0)
        told = [line for line in done.stderr.splitlines() if line.startswith("furrow: error: ")]
        self.assertEqual(len(told), 1, done.stderr)
        self.assertIn("this scenario needs 3 ranks (1 rig, 1 tire(s), 1 terrain), but 2 were started", told[0])
        self.assertIn("srun -n 3", told[0])
        self.assertFalse(self.run_folder.exists())

    def test_tasks_without_mpi_are_refused(self):
        done = self.srun("run", self.path, "--out", self.run_folder, mpi="none")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("srun: started 3 tasks without MPI, expected srun --mpi=pmix", done.stderr)
        self.assertFalse(self.run_folder.exists())

    def test_a_job_that_never_comes_to_a_checkpoint_ends(self):
        env = {"SLURM_RESTART_COUNT": "3", "SLURM_JOB_ID": "1"}
        done = subprocess.run(["bash", self.script()], cwd=self.folder,
                              env={**os.environ, **env}, capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("ended 3 times before the first checkpoint", done.stderr)


# A wheel at each corner of the bed, each under a load of its own, two of them on either rank of the terrain.
FOUR_WHEELS = on_liggghts(changed(
    rig={"touchdown_damping": 0, "wheels": [{"start": start, "lateral": lateral, "carrier_mass": mass} for start,
                                            lateral, mass in ((0.55, -0.23, 300), (0.55, 0.23, 350), (1.65, -0.23, 400),
                                                              (1.65, 0.23, 450))]},
    terrain={"layers": 3, "length": 2.4, "width": 0.95},
    run={"step": 2e-4, "end": 0.08, "average_from": 0.02, "peer_timeout": 60},
    output={"series_interval": 1e-3, "frame_interval": 0.01}, checkpoint={"interval": 0.01, "keep": 1000}), 2)


@unittest.skipUnless(LIBRARY.exists(), f"{LIBRARY.name} was not built")
class FourWheelsOnTwoRanks(ClusterTest):
    """Seven ranks: rig, four tires, and a terrain in LIGGGHTS on two. The node says that it has a core for each."""
    SCENARIO = FOUR_WHEELS
    CORES, MEMORY = 8, 16000
    STOPPED_AT = 270

    def test_job_ends_as_if_undisturbed(self):
        for wheel in range(4):
            with open(self.whole / f"timeseries_wheel{wheel}.csv", newline="") as file:
                self.assertGreater(max(float(line["vertical_force_N"]) for line in csv.DictReader(file)),
                                   900.0, f"wheel {wheel}")
        self.requeued_job_ends_as_if_undisturbed()
        signalled = set(steps(self.run_folder)) - set(steps(self.whole))
        self.assertEqual(len(signalled), 1, "the checkpoint of the signal")
        self.assertIn(min(signalled), range(self.STOPPED_AT, self.STOPPED_AT + 20))
        files = [path for path in self.whole.rglob("*") if path.is_file()]
        equal = [path for path in files if path.read_bytes()
                 == (self.run_folder / path.relative_to(self.whole)).read_bytes()]
        rest = [path.relative_to(self.whole).as_posix() for path in set(files) - set(equal)]
        self.assertEqual(sorted(path for path in rest if not path.startswith("checkpoints/")),
                         ["run.log", "summary.json"])
        print(f"signalled before step {min(signalled)} of {steps(self.whole)[-1]}; of {len(files)} files {len(equal)} "
              f"are equal byte for byte; wall times aside so are summary.json and {len(rest) - 2} files of checkpoints")


class QueuedAgainByItself(ClusterTest):
    REQUEUE_EXIT = False

    def test_job_ends_as_if_undisturbed(self):
        self.requeued_job_ends_as_if_undisturbed()


if __name__ == "__main__":
    if not os.access(FAULTY, os.X_OK):
        sys.exit(f"{FAULTY} is not there; set FURROW_FAULTY")
    if slurm.missing():
        print("skipped: needs Debian's slurm-wlm and munge, lacks " + ", ".join(slurm.missing()))
        sys.exit(77)
    unittest.main(verbosity=2)
