#!/usr/bin/python3
"""The folder of a run: nothing of the user's own is lost in it, one run at a time has it, and a run notices when it is
gone."""
import fcntl
import os
import pathlib
import re
import shutil
import subprocess
import unittest

from checkpoint_runs import FAULTY, RUN, CheckpointTest, steps, summary
from program import SystemTest, furrow, main, start, wait_for, write_json, write_scenario

CYCLES = int(os.environ.get("FURROW_CYCLES", "6"))
MINE = ("photo.png", "summary_of_my_thesis.json", "timeseries_measured.csv", "frames/cad.step", "checkpoints/notes.txt")


def files(folder):
    """{path in the folder: file} of all files below it."""
    return {str(path.relative_to(folder)): path for path in pathlib.Path(folder).rglob("*") if not path.is_dir()}


def unlisted(folder):
    """The files that the list does not hold."""
    forms = (pathlib.Path(folder) / ".furrow-run").read_text().split("furrow-run 1\n")[-1].splitlines()
    numbers = lambda form: re.sub(r"%0?(\d+)d", r"\\d{\1,}", re.escape(form).replace("\\%", "%"))
    listed = re.compile("|".join(map(numbers, forms)))
    return {name for name in files(folder) if not listed.fullmatch(name)} - {".furrow-run"}


class Overwrite(SystemTest):
    def setUp(self):
        super().setUp()
        self.path = write_scenario(self.folder, RUN)
        self.out = self.folder / "out"

    def run_it(self, *arguments, **expected):
        return self.furrow("run", *arguments, **expected)

    def put_mine(self, names=MINE):
        for name in names:
            (self.out / name).parent.mkdir(parents=True, exist_ok=True)
            (self.out / name).write_text("mine")

    def test_a_folder_that_no_run_made_is_refused(self):
        names = (*MINE, "scenario.json", "report.json", "soil.json", "run.log")
        self.put_mine(names)
        for command in (["run", self.path, "--overwrite"], ["run", self.path], ["soil", self.path, "--overwrite"],
                        ["press", self.path, "--set", "tire.rigid=false", "--overwrite"]):
            self.furrow(*command, "--out", self.out, code=2,
                        matches=r"furrow: error: .*out: key '--out': (holds no run|exists already)")
        self.assertIn("an earlier version of furrow made it", furrow("resume", self.out, cwd=self.folder).stderr)
        self.assertEqual({name: path.read_text() for name, path in files(self.out).items()},
                         dict.fromkeys(names, "mine"))

    def test_what_furrow_wrote_goes_and_what_the_user_wrote_stays(self):
        self.run_it(self.path, "--out", "out", "--profile")
        self.assertEqual(unlisted(self.out), set())
        self.put_mine()
        self.furrow("report", "out")  # plots are listed too, once
        ours = files(self.out).keys() - set(MINE)
        self.assertEqual(unlisted(self.out), set(MINE))
        self.run_it(self.path, "--out", "out", "--overwrite", "--no-plots", "--set", "output.frame_interval=0")
        self.assertEqual(unlisted(self.out), set(MINE))
        for name in MINE:
            self.assertEqual((self.out / name).read_text(), "mine", name)
        left = files(self.out).keys() - set(MINE)
        self.assertFalse([name for name in left if name.endswith((".png", "profile.json"))
                          or name.startswith("frames")])
        self.assertLess(left, ours)

    def test_a_plot_never_replaces_a_picture_of_the_users_own(self):
        self.run_it(self.path, "--out", "out", "--no-plots")
        (self.out / "forces.png").write_text("mine")
        self.furrow("report", "out", says="no forces.png: furrow did not write the file of that name")
        self.assertEqual((self.out / "forces.png").read_text(), "mine")

    def test_a_runs_own_scenario_can_be_run_over_its_folder(self):
        self.run_it(self.path, "--out", "out", "--no-plots")
        first = summary(self.out)
        for arguments, cwd in (((self.out / "scenario.json", "--out", "out"), self.folder),
                               (("scenario.json", "--out", "."), self.out)):
            self.run_it(*arguments, "--overwrite", "--no-plots", cwd=cwd)
            self.assertEqual(summary(self.out)["state_hash"], first["state_hash"])
        before = {name: path.read_bytes() for name, path in files(self.out).items()}
        link = self.folder / "link.json"
        link.symlink_to(self.out / "scenario.json")
        self.run_it(link, "--out", "out", "--overwrite", "--set", "terrain.bed=none.csv", code=2, says="none.csv")
        self.assertEqual({name: path.read_bytes() for name, path in files(self.out).items()}, before)

    def test_a_way_through_a_folder_that_is_not_there_is_refused(self):
        inner = self.folder / "inner"
        inner.mkdir()
        self.run_it(self.path, "--out", "nonex/../../w/x", code=2, cwd=inner,
                    matches="^furrow: error: nonex/../../w/x: key '--out': leads through 'nonex', which does not exist")
        self.assertEqual((self.names(), list(inner.iterdir())), (["inner", "small.json"], []))

    def test_a_study_is_refused_where_no_study_was(self):
        study = write_json(self.folder / "study.json", {"scenario": "small.json", "grid": {"rig.slip": [0.1]}})
        self.put_mine(("sweep.csv",))
        self.furrow("sweep", study, "--out", "out", code=2,
                    says="holds no run's list of its files (.furrow-run): no study made it")
        self.assertEqual(files(self.out).keys(), {"sweep.csv"})

    def test_of_two_that_begin_together_one_has_the_folder(self):
        both = [start("run", self.path, "--out", "out", "--no-plots", cwd=self.folder) for _ in range(2)]
        told = [process.communicate(timeout=60)[1] for process in both]
        self.assertEqual(sorted(process.returncode for process in both), [0, 2], told)
        self.assertEqual(sum(err.count("furrow: error: ") for err in told), 1, told)
        self.assertEqual(summary(self.out)["simulated_s"], RUN["run"]["end"])

    def test_a_full_disk_as_the_list_is_written_is_told_and_leaves_nothing(self):
        disk = self.small_disk(self.folder / "disk", "1m")
        subprocess.run(["dd", "if=/dev/zero", f"of={disk}/ballast", "bs=4k"], capture_output=True)
        done = self.run_it(self.path, "--out", "disk/out", code=5)
        self.assertEqual(done.stderr,
                         "furrow: error: disk/out/.furrow-run: cannot be written: No space left on device\n")
        self.assertEqual([path.name for path in disk.iterdir()], ["ballast"])


class Gone(CheckpointTest):
    """What happens to the folder while the run waits in the middle of a step."""

    def goes_on(self, process, code, words):
        self.mark.unlink()
        _, err = process.communicate(timeout=60)
        self.no_process_left()
        self.assertEqual(process.returncode, code, err)
        self.assertEqual(err.count("furrow: error: "), 1, err)
        self.assertRegex(err, words)
        return err

    def test_an_overwriting_run_that_is_lost_as_it_writes_its_first_frame(self):
        shutil.copytree(self.whole, self.run_folder)
        (self.run_folder / "checkpoints" / "notes.txt").write_text("mine")
        before = {name: path.read_bytes() for name, path in files(self.run_folder).items() if name != ".furrow-run"}
        self.run_with_fault("frame", 1, 1, "kill", flags=["--overwrite"], says="the run had not begun to step; ")
        self.assertEqual({name: path.read_bytes() for name, path in files(self.run_folder).items()
                          if name != ".furrow-run"}, before)

    def test_moved(self):
        process = self.start_waiting("step", 0, 220)
        elsewhere = self.folder / "elsewhere"
        self.run_folder.rename(elsewhere)
        err = self.goes_on(process, 5,
                           "furrow: error: .*out: was moved, removed or emptied while the run was under way")
        self.assertNotIn("resume", err)
        self.assertFalse(self.run_folder.exists())
        self.continues(elsewhere)

    def test_removed(self):
        process = self.start_waiting("step", 0, 220)
        shutil.rmtree(self.run_folder)
        self.goes_on(process, 5, "furrow: error: .*out: was moved, removed or emptied while the run was under way")
        self.assertFalse(self.run_folder.exists())

    def test_a_folder_in_it_removed(self):
        for name in ("frames", "checkpoints"):
            with self.subTest(name):
                shutil.rmtree(self.run_folder, ignore_errors=True)
                process = self.start_waiting("step", 0, 220)
                shutil.rmtree(self.run_folder / name)
                self.goes_on(process, 5,
                             f"furrow: error: .*out/{name}: was moved or removed while the run was under way")
                self.assertFalse((self.run_folder / name).exists())

    def test_a_link_where_the_parts_of_a_checkpoint_are_to_be(self):
        process = self.start_waiting("step", 0, 220)
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        (elsewhere / "rig.h5").write_text("mine")
        (self.run_folder / "checkpoints" / ".000000000300.part").symlink_to(elsewhere)
        self.released(process, says="the checkpoint at t = 0.06 s could not be written")
        self.assertEqual({path.name: path.read_text() for path in elsewhere.iterdir()}, {"rig.h5": "mine"})
        self.assertEqual(steps(self.run_folder), [100, 200, 400, 500][-3:])

    def test_what_a_move_left_unfinished_is_gone_at_the_end(self):
        """Moved while a checkpoint is written and moved back before anything looks: its parts have nobody to remove
        them."""
        process = self.start_waiting("step", 0, 220)
        part = self.run_folder / "checkpoints" / ".000000000210.part"
        part.mkdir()
        for path in (part / "rig.h5", part / "tire0.h5", self.run_folder / ".results.h5.0123456789abcdef.part"):
            path.write_text("half")
        self.released(process)
        self.same_as_whole(self.run_folder)

    def test_a_link_in_the_place_of_a_folder_of_results_is_refused(self):
        own = self.folder / "own"
        own.mkdir()
        (own / "tire0_000000.h5").write_text("precious")
        for name in ("frames", "checkpoints"):
            shutil.copytree(self.whole, self.run_folder)
            shutil.rmtree(self.run_folder / name)
            (self.run_folder / name).symlink_to("../own")
            for command in (["run", self.path, "--out", self.run_folder, "--overwrite"],
                            ["resume", self.run_folder, "--until", "0.2"]):
                self.furrow(*command, "--no-plots", code=2, says=f"{name}: is a link, expected what it leads to")
            shutil.rmtree(self.run_folder)
        for name in ("run.log", "timeseries.csv"):
            shutil.copytree(self.whole, self.run_folder)
            (self.run_folder / name).rename(self.folder / name)
            (self.run_folder / name).symlink_to(f"../{name}")
            before = (self.folder / name).read_bytes()
            self.furrow("resume", self.run_folder, "--until", "0.2", "--no-plots", code=2,
                        says=f"{name}: is a link, expected what it leads to")
            self.assertEqual((self.folder / name).read_bytes(), before)
            shutil.rmtree(self.run_folder)
        self.assertEqual([(path.name, path.read_text()) for path in own.iterdir()], [("tire0_000000.h5", "precious")])

    def test_a_copy_that_shares_its_files_does_not_change(self):
        shutil.copytree(self.whole, self.run_folder)
        shutil.copytree(self.run_folder, self.folder / "backup", copy_function=os.link)
        self.resume("--until", "0.12")
        for name in ("timeseries.csv", "timeseries_accounts.csv", "summary.json", "results.h5"):
            self.assertEqual((self.folder / "backup" / name).read_bytes(), (self.whole / name).read_bytes(), name)

    def test_series_that_are_removed_or_replaced_are_written_again(self):
        def emptied(file):
            os.truncate(file, 0)

        def replaced(file):
            shutil.copy(file, self.folder / "copy")
            os.replace(self.folder / "copy", file)
        for change, name in ((os.unlink, "timeseries.csv"), (emptied, "timeseries.csv"),
                             (replaced, "timeseries_accounts.csv"),
                             (os.unlink, "scenario.json")):
            with self.subTest(change=change, name=name):
                process = self.start_waiting("step", 0, 220)
                change(self.run_folder / name)
                self.released(process,
                           says=f"{name} was removed or changed while the run was under way, and is written again")
                self.same_as_whole()
                shutil.rmtree(self.run_folder)

    def test_another_run_in_its_place(self):
        process = self.start_waiting("step", 0, 220)
        self.run_folder.rename(self.folder / "elsewhere")
        shutil.copytree(self.whole, self.run_folder)
        before = {name: path.read_bytes() for name, path in files(self.run_folder).items()}
        self.goes_on(process, 5, "furrow: error: .*out: was moved, removed or emptied while the run was under way")
        self.assertEqual({name: path.read_bytes() for name, path in files(self.run_folder).items()}, before)

    @unittest.skipUnless(os.geteuid() == 0 and shutil.which("setpriv"), "needs to become a user who is not root")
    def test_made_read_only(self):
        for path in (self.folder, self.path):
            os.chown(path, 65534, 65534)
        command = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups",
                   FAULTY, "run", self.path, "--out", self.run_folder]
        environment = {**os.environ, **self.fault("step", 0, 220, "wait"),
                       "HOME": str(self.folder), "XDG_CACHE_HOME": str(self.folder / "cache")}
        process = subprocess.Popen(command, cwd=self.folder, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment)
        self.addCleanup(process.kill)
        wait_for(lambda: self.mark.exists() or process.poll() is not None, 60, "the fault fires")
        for name in ("frames", "checkpoints", ""):
            os.chmod(self.run_folder / name, 0o555)
        self.goes_on(process, 5, "furrow: error: .*out/frames/.*: cannot create: Permission denied")
        for name in ("", "frames", "checkpoints"):
            os.chmod(self.run_folder / name, 0o755)
        for path in self.folder.rglob("*"):
            os.chown(path, 0, 0)
        self.continues()


class Killed(CheckpointTest):
    """kill -9 of `furrow` itself, and somebody who continues at once."""
    # the run has 133 steps for each cycle: ranks that lost `furrow` go on for a while, more on a busy machine
    FINER = CYCLES / 6
    SCENARIO = {**RUN, "run": {**RUN["run"], "end": 0.16, "step": 2e-4 / FINER},
                "checkpoint": {"interval": 0.004 / FINER, "keep": 2}}

    def test_again_and_again_without_a_pause(self):
        command = ["run", self.path, "--out", self.run_folder, "--no-plots"]
        for _ in range(CYCLES):  # each comes past a checkpoint, every 20 steps, and dies in the middle of a step
            process = self.start(*command, program=FAULTY, env=self.fault("step", 0, 25, "wait"))
            wait_for(lambda: self.mark.exists() or process.poll() is not None, 60, "the fault fires")
            self.assertIsNone(process.poll(), process.stderr.read() if process.poll() is not None else "")
            process.kill()
            self.mark.unlink()
            process.communicate(timeout=30)
            command = ["resume", self.run_folder, "--no-plots"]
        self.continues()
        self.assertEqual(len(summary(self.run_folder)["segments"]), CYCLES + 1)

    def test_whoever_waits_in_vain_is_told_for_whom(self):
        run = self.copy_of_whole()
        with open(run / ".furrow-run") as held:  # as a rank that does not end
            fcntl.flock(held, fcntl.LOCK_SH)
            others = [start(*command, cwd=self.folder, program=FAULTY) for command in
                      (["resume", run], ["run", self.path, "--out", run, "--overwrite"])]
            for other in others:
                err = self.ended(other, 2)
                waits, error = err.splitlines()
                self.assertRegex(waits, r"^furrow: .*out is in use by a run that has not ended: process \d+ .*; "
                                 r"waiting for up to 10 s")
                self.assertRegex(error, rf"^furrow: error: .*out: .*process {os.getpid()} \(")


if __name__ == "__main__":
    main()
