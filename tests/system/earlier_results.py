#!/usr/bin/python3
"""Results that stand in a folder are not lost, whatever ends the command that was to replace them."""
import json
import os
import pathlib
import resource
import shutil
import subprocess
import tempfile

from program import PROGRAM, ROOT, SMALL, SystemTest, changed, furrow, main, read_json, wait_for, write_scenario

# Its bed settles for a minute or more.
SLOW = changed(terrain={"radius": 0.01, "layers": 12, "length": 12}, run={"step": 2e-5})

# Its first call is a run that a signal stops before it has a checkpoint.
STOPPED_WHILE_IT_SETTLES = """#!/bin/bash
if [ ! -e said ]; then
  "$REAL" run slow.json --out out --no-plots 2> said & run=$!
  until grep -q settling said; do sleep 0.05; done
  kill -TERM $run; wait $run; exit
fi
exec "$REAL" "$@" --no-plots
"""


def contents(folder):
    """{path in the folder: content} of all files below it, but for what lists of files held before."""
    files = {path.relative_to(folder).as_posix(): path.read_bytes() for path in pathlib.Path(folder).rglob("*")
             if path.is_file()}
    return {name: sorted(set(data.decode().split("furrow-run 1\n")[-1].splitlines())) if name.endswith(".furrow-run")
            else data for name, data in files.items()}


def without(stream, *arguments, cwd, **options):
    """Runs the program with that stream closed."""
    return subprocess.run([PROGRAM, *map(str, arguments)], cwd=cwd, timeout=120, text=True, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          preexec_fn=lambda: os.close(stream), **options)


class Earlier:
    """Results of a run with these flags, and what `--overwrite` does with them."""
    FLAGS, SUMMARY, LOG = (), "summary.json", "said"

    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory(prefix="furrow base ")
        cls.addClassCleanup(holder.cleanup)
        cls.base = pathlib.Path(holder.name) / "base"
        done = furrow("run", write_scenario(holder.name), *cls.FLAGS, "--out", cls.base, "--no-plots", cwd=holder.name)
        assert done.returncode == 0, done.stderr

    def setUp(self):
        super().setUp()
        self.path = write_scenario(self.folder)
        self.out = self.folder / "out"
        shutil.copytree(self.base, self.out)
        self.before = contents(self.out)

    def command(self, path):
        return ["run", path, *self.FLAGS, "--out", self.out, "--overwrite", "--no-plots"]

    def is_as_before(self):
        self.assertEqual(contents(self.out), self.before)
        self.assertFalse((self.out / ".furrow-before").exists())

    def begun_to_settle(self):
        """The process, and the file that holds what it says."""
        said, log = self.folder / "said", self.folder / self.LOG
        slow = write_scenario(self.folder, SLOW, "slow.json")
        with open(said, "w") as file:
            process = subprocess.Popen([PROGRAM, *self.command(slow)], cwd=self.folder, stdin=subprocess.DEVNULL,
                                       stdout=file, stderr=file,
                                       env={**os.environ, "XDG_CACHE_HOME": str(self.folder / "cache")})
        self.addCleanup(process.kill)
        wait_for(lambda: log.exists() and "settling" in log.read_text(), 60, "the bed settles")
        self.assertIsNone(process.poll())
        self.assertTrue((self.out / ".furrow-before" / self.SUMMARY).exists())
        return process, said

    def killed_while_it_settles(self):
        process, _ = self.begun_to_settle()
        process.kill()
        process.wait(timeout=60)

    def test_they_come_back_where_no_rank_can_be_started(self):
        self.furrow(*self.command(self.path), env={"FURROW_MPIRUN": "/bin/false"}, code=5,
                    says=("no rank could be started", "out holds the earlier results again"))
        self.is_as_before()

    def test_they_come_back_where_a_signal_ends_the_run_before_its_first_step(self):
        process, said = self.begun_to_settle()
        process.terminate()
        self.assertEqual(process.wait(timeout=60), 75, said.read_text())
        self.assertIn("out holds the earlier results again", said.read_text())
        self.is_as_before()


class Overwrite(Earlier, SystemTest):
    def test_they_come_back_to_who_resumes_after_a_kill_before_the_first_step(self):
        self.killed_while_it_settles()
        self.furrow("report", self.out, code=5,
                    says=f"{self.out}/.furrow-before holds earlier results, which 'furrow resume' brings back")
        self.furrow("resume", self.out, says="is finished")
        self.is_as_before()

    def test_those_of_soil_tests_come_back_after_a_kill(self):
        tests = self.folder / "soil"
        begin = ["soil", self.path, "--only", "plate", "--out", tests]
        self.furrow(*begin, "--speed", "1", "--set", "terrain.layers=2")
        before = contents(tests)
        process = self.start(*begin, "--speed", "0.001", "--overwrite")
        wait_for(lambda: (tests / ".furrow-before" / "soil.json").exists(), 60, "the results are set aside")
        process.kill()
        process.communicate(timeout=60)
        self.furrow("resume", tests, code=2, says="holds the results of 'furrow soil'")
        self.assertEqual(contents(tests), before)


class OverwrittenBeds(Earlier, SystemTest):
    FLAGS, SUMMARY, LOG = ("--seeds", "2"), "seed2/summary.json", "out/seed1.log"

    def test_they_come_back_to_the_next_command_after_a_kill_before_the_first_step(self):
        self.killed_while_it_settles()
        done = self.furrow("run", self.path, "--seeds", "2", "--out", self.out, "--no-plots")
        self.assertEqual(done.stderr.count("is done already"), 2, done.stderr)
        after = contents(self.out)
        for name in self.before:
            if name.startswith("seed"):
                self.assertEqual(after[name], self.before[name], name)

    def test_a_file_of_the_users_own_in_a_bed_stays_and_the_bed_is_replaced(self):
        mine = self.out / "seed1" / "mine.txt"
        mine.write_text("mine")
        self.furrow(*self.command(write_scenario(self.folder, changed(rig={"slip": 0.2}), "other.json")))
        self.assertEqual(mine.read_text(), "mine")
        self.assertEqual(read_json(self.out / "seed1" / "summary.json")["slip"], 0.2)
        self.assertFalse((self.out / ".furrow-before").exists())

    def test_they_stay_where_a_file_of_the_users_own_stands_in_the_place_of_a_new_one(self):
        (self.out / "seed3.log").write_text("mine")
        before = contents(self.out)
        self.furrow("run", self.path, "--seeds", "3", "--out", self.out, "--no-plots", "--overwrite", code=2,
                    says="seed3.log: stands where a result is to be written")
        self.assertEqual(contents(self.out), before)


class ClosedStreams(SystemTest):
    """The descriptor that is free is not taken for a file of results."""

    def setUp(self):
        super().setUp()
        self.path = write_scenario(self.folder)
        self.out = self.folder / "out"

    def test_of_errors(self):
        for arguments in ((), ("--overwrite",)):
            done = without(2, "run", self.path, "--out", self.out, "--no-plots", *arguments, cwd=self.folder)
            self.assertEqual(done.returncode, 0)
            self.assertTrue((self.out / "summary.json").exists())
            listed = (self.out / ".furrow-run").read_bytes()
            self.assertTrue(listed.startswith(b"furrow-run 1\n"))
        self.assertEqual(without(2, "resume", self.out, cwd=self.folder).returncode, 0)
        self.assertEqual((self.out / ".furrow-run").read_bytes(), listed)

    def test_of_results(self):
        for _ in range(2):
            done = without(1, "kc", "buggy.json", "--out", self.out, "--overwrite", cwd=self.folder)
            self.assertEqual(done.returncode, 5)
            self.assertIn("standard output: cannot be written", done.stderr)
            self.assertTrue((self.out / "kinematics.csv").exists())
            self.assertTrue((self.out / ".furrow-run").read_bytes().startswith(b"furrow-run 1\n"))


class ContinuedRun(SystemTest):
    """A finished run that is to go on to a later end."""

    def setUp(self):
        super().setUp()
        self.out, self.end = self.folder / "out", SMALL["run"]["end"]
        self.furrow("run", write_scenario(self.folder, {**SMALL, "terrain": {"engine": "rigid"}}), "--out", self.out)

    def test_it_stays_finished_where_no_rank_can_be_started(self):
        self.furrow("resume", self.out, "--until", 2 * self.end, env={"FURROW_MPIRUN": "/bin/false"}, code=5,
                    says="the run had not gone on; ")
        self.assertTrue((self.out / "summary.json").exists())
        self.assertFalse((self.out / "summary_failed.json").exists())

    def test_plots_of_the_earlier_end_are_gone_where_it_stops_on_the_way(self):
        self.assertTrue((self.out / "ranks.png").exists())
        process = self.start("resume", self.out, "--until", 1000 * self.end)
        wait_for(lambda: not (self.out / "summary.json").exists(), 60, "it goes on")
        wait_for(lambda: not list(self.out.glob("*.png")), 10, "its plots are gone")
        process.terminate()
        self.ended(process, 75)
        self.assertFalse((self.out / "report.html").exists())
        (self.out / "energy.png").write_text("of an earlier version")
        with open(self.out / ".furrow-run", "a") as names:
            names.write("energy.png\n")
        self.furrow("report", self.out)
        self.assertFalse((self.out / "energy.png").exists())

    def test_settings_that_change_nothing_are_told(self):
        self.furrow("resume", self.out, "--set", "output.frame_interval=0.001",
                    says="key 'output.frame_interval': is not changed to 0.001, as the run is finished")
        self.furrow("resume", self.out, "--until", 1, "--set", "run.end=2", code=2,
                    says="key '--until': is given with --set run.end, expected one of them")


class UnwritableFiles(SystemTest):
    """What the HDF5 library could not write does not end the program with a crash."""

    def test_a_bed_that_does_not_fit_into_the_cache(self):
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, 50_000))
        done = subprocess.run([PROGRAM, "bed", write_scenario(self.folder)],
                              cwd=self.folder, text=True, capture_output=True,
                              timeout=120, preexec_fn=limit,
                              env={**os.environ, "XDG_CACHE_HOME": str(self.folder / "cache")})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("bed not cached", done.stderr)
        self.assertIn("grains", json.loads(done.stdout))


class RetryScript(SystemTest):
    """The script of nodes/SURVIVES.md."""

    def test_it_begins_again_where_there_is_no_checkpoint(self):
        text = (ROOT / "nodes" / "SURVIVES.md").read_text()
        script = text[text.index("```sh\n") + 6:].split("```")[0]
        write_scenario(self.folder)
        write_scenario(self.folder, SLOW, "slow.json")
        program = self.folder / "bin" / "furrow"
        program.parent.mkdir()
        program.write_text(STOPPED_WHILE_IT_SETTLES)
        program.chmod(0o755)
        environment = {**os.environ, "PATH": f"{program.parent}:{os.environ['PATH']}", "REAL": PROGRAM,
                       "XDG_CACHE_HOME": str(self.folder / "cache")}
        self.call(["bash", "-c", script], env=environment)
        self.assertIn("stopped by a signal", (self.folder / "said").read_text())
        self.assertTrue((self.folder / "out" / "summary.json").exists())


if __name__ == "__main__":
    main()
