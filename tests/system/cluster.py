#!/usr/bin/python3
"""Runs under Slurm: a job that is signalled, queued again and continued leaves the files of an undisturbed run, whoever
queues it again; ranks that srun starts; and what is refused. Needs Debian's slurm-wlm and munge; skipped without them."""
import os
import subprocess
import sys
import time
import unittest

import slurm
from checkpoint_runs import FAULTY, CheckpointTest
from program import furrow, wait_for

SCRIPT = ["--cores-per-node", "2", "--partition", "all", "--time", "10"]


class ClusterTest(CheckpointTest):
    """On a cluster of its own. The undisturbed run is one without Slurm."""
    REQUEUE_EXIT = True

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.cluster = slurm.Cluster(cls.REQUEUE_EXIT)
        cls.addClassCleanup(cls.cluster.end)

    def script(self, *flags):
        """The path of what `furrow ranks --slurm` prints."""
        done = furrow("ranks", "--slurm", *SCRIPT, *flags, self.path, "--out", self.run_folder, cwd=self.folder, program=FAULTY)
        self.assertEqual(done.returncode, 0, done.stderr)
        path = self.folder / "job.sh"
        # the plots of the other run were left out, too
        path.write_text(done.stdout.replace('"$program" run', '"$program" run --no-plots')
                        .replace('"$program" resume', '"$program" resume --no-plots'))
        return path

    def srun(self, *arguments, mpi="pmix", count=3):
        return self.cluster.call("srun", f"--mpi={mpi}", "-K1", "--cpu-bind=none", "--overcommit", "-n", count, FAULTY, *arguments,
                                 cwd=self.folder, check=False)

    def requeued_job_ends_as_if_undisturbed(self, **env):
        number = self.cluster.submit(self.script(), cwd=self.folder, env={**self.fault("step", 0, 250, "wait"), **env})
        self.addCleanup(self.cluster.call, "scancel", "--quiet", number, check=False)
        wait_for(self.mark.exists, 60, f"the job comes to its 250th step: {self.cluster.job(number)}")
        self.cluster.call("scancel", "--batch", "--signal=USR1", number)
        said = self.folder / f"slurm-{number}.out"
        wait_for(lambda: "stopping" in said.read_text(), 20, "the signal comes")
        self.mark.unlink()
        self.cluster.wait_for_state(number, lambda job: job["Restarts"] == "1" and job["JobState"] in ("PENDING", "RUNNING"), 60)
        time.sleep(3)  # Slurm refuses what it began in the same second; on its own it lets two minutes pass
        wait_for(lambda: self.cluster.call("scontrol", "update", f"JobId={number}", "StartTime=now", check=False).returncode == 0,
                 30, "the job need not wait for two minutes")
        self.cluster.wait_for_state(number, lambda job: job["JobState"] == "COMPLETED", 240)
        text = said.read_text()
        self.assertRegex(text, r"furrow: continuing small from t = 0\.050\d* s")
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
        self.resume()
        self.same_as_whole()

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
        done = subprocess.run(["bash", self.script()], cwd=self.folder, env={**os.environ, **env}, capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("ended 3 times before the first checkpoint", done.stderr)


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
