#!/usr/bin/python3
"""What surrounds the program: variables of launchers, launchers that hang, limits of the system, signals in long work,
odd names, the user's Python."""
import json
import os
import pathlib
import platform
import shutil
import signal
import subprocess
import time

from program import PROGRAM, SystemTest, changed, furrow, main, ranks, survivors, wait_for, write_json, write_scenario

VARIABLES = ("OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK")
SHORT = ["--set", "run.end=0.004", "--set", "run.average_from=0", "--set", "terrain.engine=rigid", "--no-plots"]


class EnvironmentTest(SystemTest):
    def setUp(self):
        super().setUp()
        self.path = write_scenario(self.folder)

    def limited(self, limits, *arguments, env=(), **expected):
        """The program under a shell's ulimit."""
        command = ["bash", "-c", f'ulimit {limits} && exec "$@"', "bash", PROGRAM, *map(str, arguments)]
        return self.call(command, env={**os.environ, **dict(env)}, **expected)


class LauncherVariables(EnvironmentTest):
    """Left over from a shell that mpirun or srun started."""

    def test_commands_that_are_no_ranks_pay_no_regard(self):
        for variable in VARIABLES:
            with self.subTest(variable):
                env = {variable: "3"}
                self.furrow("validate", self.path, env=env)
                self.furrow("explain", "rig.slip", env=env)
                self.furrow("validate", "no.json", env=env, code=2, errors=1, says="does not exist")
                self.furrow("rnu", env=env, code=2, errors=1, says="unknown command")

    def test_run_names_the_variable_and_how_to_be_rid_of_it(self):
        for variable, value in (("PMI_RANK", "1"), ("PMIX_RANK", "0"), ("OMPI_COMM_WORLD_RANK", "3")):
            with self.subTest(variable):
                self.furrow("run", self.path, env={variable: value}, code=2, errors=1,
                            says=(f"the environment has {variable}={value}", f"unset {variable}"))
        self.assertEqual(self.names(), ["small.json"])

    def test_no_rank_ends_without_a_word(self):
        env = {"PMI_RANK": "2", "OMPI_COMM_WORLD_LOCAL_RANK": "2"}
        self.furrow("run", "no.json", env=env, code=2, errors=1, says="does not exist")
        self.furrow("resume", "no", env=env, code=2, errors=1, says="does not exist")
        self.furrow("run", self.path, "--fast", env=env, code=2, errors=1, says="--fast")

    def test_an_empty_variable_is_none(self):
        self.furrow("run", self.path, *SHORT, "--out", "out", env={"PMI_RANK": ""})

    def test_a_finished_run_under_mpirun_says_so(self):
        self.furrow("run", self.path, *SHORT, "--out", "out")
        done = self.call([shutil.which("mpirun"), "--allow-run-as-root", "--oversubscribe", "-n", "3",
                               PROGRAM, "resume", "out"])
        self.assertEqual(done.stderr.count("there is nothing to do"), 1, done.stderr)
        self.assertEqual(done.stdout, "out\n")

    def test_a_sweep_as_a_rank_starts_its_runs_all_the_same(self):
        study = {"scenario": "small.json", "set": {"run.end": 0.004, "run.average_from": 0, "terrain.engine": "rigid"},
                 "grid": {"rig.slip": [0.2]}}
        write_json(self.folder / "study.json", study)
        self.call([shutil.which("mpirun"), "--allow-run-as-root", "-n", "1", PROGRAM, "sweep", "study.json"])


class IgnoredChildren(EnvironmentTest):
    """A parent that ignores SIGCHLD, as daemons do, hands that on."""
    COMMAND = ["bash", "-c", "trap '' CHLD; exec \"$@\"", "bash", PROGRAM]

    def test_run_and_sweep_end(self):
        self.call([*self.COMMAND, "run", str(self.path), *SHORT, "--out", "out"], timeout=200, prints="out\n")
        study = {"scenario": "small.json", "set": {"run.end": 0.004, "run.average_from": 0, "terrain.engine": "rigid"},
                 "grid": {"rig.slip": [0.2]}}
        write_json(self.folder / "study.json", study)
        self.call([*self.COMMAND, "sweep", "study.json", "--out", "swept"], timeout=200, prints="swept\n")


class Launcher(EnvironmentTest):
    def launcher(self, script):
        path = self.folder / "launcher"
        path.write_text("#!/bin/bash\n" + script)
        path.chmod(0o755)
        return {"FURROW_MPIRUN": str(path), "FURROW_START_TIMEOUT": "1"}

    def check(self, script, words, longest, code=5):
        begin = time.monotonic()
        self.furrow("run", self.path, "--out", "out", env=self.launcher(script), code=code, errors=1,
                    says=("none of 3 ranks began within 1 s (FURROW_START_TIMEOUT sets another time)", words))
        self.assertLess(time.monotonic() - begin, longest)
        self.assertEqual(survivors(self.folder), [])

    def test_that_hangs_is_ended_and_its_words_are_told(self):
        self.check("echo no room for pipes >&2; sleep 1000\n", "mpirun said: no room for pipes", 30)
        self.assertIn("no room for pipes", (self.folder / "out" / "run.log").read_text())

    def test_words_on_standard_output_count_too(self):
        self.check("echo all nodes are busy; sleep 1000\n", "mpirun said: all nodes are busy", 30)

    def test_that_has_no_memory_for_its_ranks_is_a_limit(self):
        self.check("echo 'mmap(2): Cannot allocate memory (errno 12)' >&2; sleep 1000\n",
                   "mpirun said: mmap(2)", 30, code=6)

    def test_that_fails_where_memory_is_scarce_is_a_limit(self):
        env = self.launcher("echo 'PMIX ERROR: NOT-AVAILABLE in file dstore_segment.c' >&2; exit 1\n")
        self.limited("-v 400000", "run", self.path, "--out", "out", env=env, code=6, errors=1,
                     matches=r"out of memory: limit 0.4 GB \(ulimit -v\): no rank could be started: mpirun ended with "
                     r"status 1 .*PMIX ERROR")

    def test_that_hands_on_the_death_of_a_rank_is_no_broken_one(self):
        # Open MPI's, of a rank that it has just started
        self.furrow("run", self.path, "--out", "out", env=self.launcher("exit 137\n"), code=4, errors=1,
                    says="the ranks were lost while they were being started: mpirun ended with status 137")

    def test_that_hangs_and_will_not_end_is_killed(self):
        self.check("trap '' TERM; while true; do sleep 0.1; done\n", "mpirun said nothing", 40)

    def test_what_the_user_has_set_for_it_is_named(self):
        version = subprocess.run([shutil.which("mpirun"), "--version"], capture_output=True, text=True).stdout
        for _ in range(1 if "(Open MPI) 4" in version else 5):  # Open MPI 5 loses its own words at times
            said = self.furrow("run", self.path, "--out", "out", "--overwrite", code=5, errors=1,
                               env={"OMPI_MCA_btl": "bogus", "OMPI_MCA_orte_jobid": "left over"}).stderr
            if "Component: bogus" in said:
                break
        self.assertRegex(said, r"no rank could be started \(are PATH, TMPDIR, OMPI_MCA_btl right, is "
                         r"FURROW_MPIRUN Open MPI's\?\): mpirun ended.*Component: bogus")

    def test_bad_time_out(self):
        self.furrow("run", self.path, "--out", "out", env={"FURROW_START_TIMEOUT": "soon"}, code=2, errors=1,
                    says="key 'FURROW_START_TIMEOUT': is 'soon', expected a number of seconds")
        self.assertEqual(self.names(), ["small.json"])

    def test_without_ssh_on_path(self):
        (self.folder / "empty").mkdir()
        self.furrow("run", self.path, *SHORT, "--out", "out", env={"PATH": str(self.folder / "empty")})


class Limits(EnvironmentTest):
    def test_open_files(self):
        self.limited("-n 30", "run", self.path, *SHORT, "--out", "out", code=6, errors=1,
                     says="may open 30 files (ulimit -n), expected ")
        self.assertEqual(self.names(), ["small.json"])
        self.limited("-S -n 30", "run", self.path, *SHORT, "--out", "out")  # may be raised

    def test_stack(self):
        # The loader of glibc 2.41 needs more than 128 kB before the program begins.
        kb = 256 if platform.libc_ver()[1] >= "2.41" else 64
        self.limited(f"-S -s {kb}", "run", self.path, *SHORT, "--out", "out")  # may be raised
        if os.geteuid() != 0:
            self.limited(f"-s {kb}", "validate", self.path, code=6, errors=1,
                         says=f"the stack may take {kb} kB (ulimit -s)")

    def test_a_full_folder_for_temporary_files_is_named(self):
        small = self.small_disk(self.folder / "tmp", "8k")
        done = furrow("run", self.path, *SHORT, "--out", "out", cwd=self.folder,
                      env={"TMPDIR": str(small), "FURROW_START_TIMEOUT": "20"})
        self.assertIn(done.returncode, (4, 5), done.stderr)
        self.assertIn(f"the folder for temporary files, TMPDIR {small}, has room for", done.stderr)

    def test_processor_time(self):
        self.limited("-t 2", "run", self.path, "--set", "run.end=0.3", "--set", "terrain.radius=0.012",
                       "--set", "terrain.layers=12", "--set", "run.step=2e-5", "--out", "out", code=6, errors=1,
                     says="a process may use 2 s of processor time (ulimit -t)")
        self.assertEqual(survivors(self.folder), [])

    def test_processor_time_of_a_command_without_ranks(self):
        for limits in ("-t 2", "-S -t 2"):
            self.limited(limits, "bed", self.path, "--set", "terrain.radius=0.006", "--set", "terrain.layers=30",
                         "--set", "run.step=2e-5", code=6, errors=1,
                         says="a process may use 2 s of processor time (ulimit -t), expected a higher limit")
            self.assertEqual(self.names(), ["small.json"])

    def test_a_terrain_that_cannot_fit_is_refused_before_anything_begins(self):
        large = ["--set", "terrain.radius=0.006", "--set", "terrain.layers=15", "--set", "terrain.length=100",
                 "--set", "terrain.width=40", "--set", "run.step=2e-5"]
        for command in ("run", "bed"):
            begin = time.monotonic()
            self.limited("-v 4000000", command, self.path, *large, code=6, errors=1, matches=r"small.json: out of "
                         r"memory: the terrain needs about \d+\.\d GB, limit 4.1 GB \(ulimit -v\)")
            self.assertLess(time.monotonic() - begin, 20)
        self.assertEqual(self.names(), ["small.json"])
        self.limited("-v 4000000", "validate", self.path, *large)

    def test_memory_that_runs_out_on_the_way_is_no_failure_of_the_physics(self):
        # About 620,000 grains: half of the estimate is below the limit, so it is tried. MPI itself needs about 0.3 GB.
        many = ["--set", "terrain.radius=0.006", "--set", "terrain.layers=15", "--set", "terrain.length=13.3",
                "--set", "terrain.width=0.6", "--set", "run.step=2e-5", "--set", "terrain.bed_generator=lattice"]
        self.limited("-v 340000", "run", self.path, *many, code=6, errors=1,
                     matches=r"out of memory: needs about \d+\.\d GB, limit 0.3 GB \(ulimit -v\)")
        self.assertEqual(survivors(self.folder), [])

    def test_threads_that_cannot_be_started_are_no_rank_that_does_not_answer(self):
        # Of the 500 stacks of 8 MB a few fit.
        self.limited("-v 600000", "run", self.path, "--threads", "500", *SHORT, "--set", "terrain.engine=dem", "--out",
                     "out", code=6, errors=1,
                     says="threads could not be started (ulimit -u, ulimit -v, or no memory), expected ")
        self.assertEqual(survivors(self.folder), [])

    def test_pressing_where_the_solver_would_wait_forever_for_memory(self):
        self.limited("-v 250000", "press", "cleat_press.json", "--out", "out", "--points", "2", timeout=60, code=6,
                     errors=1, matches=r"out of memory: the solver needs \d+ MB of address space, limit 256 MB "
                     r"\(ulimit -v\)")

    def test_plots_that_would_wait_forever_for_memory_are_not_begun(self):
        self.limited("-v 450000", "run", self.path, *SHORT[:-1], "--out", "out",
                     matches=r"no plots: .*plots need 512 MB of memory, limit 461 MB \(ulimit -v\)")
        self.limited("-v 450000", "report", "out", code=6, errors=1)


class LongWork(EnvironmentTest):
    def check(self, *arguments, phase, longest=4.0, code=75):
        """The goal is a second; the limit leaves room for a busy machine and a slow build."""
        said = self.folder / "said"
        with open(said, "w") as file:
            process = subprocess.Popen([PROGRAM, *map(str, arguments)],
                                       cwd=self.folder, stdin=subprocess.DEVNULL, stdout=file, stderr=file)
        self.addCleanup(process.kill)
        wait_for(lambda: phase in said.read_text(), 60, phase)
        time.sleep(0.3)
        begin = time.monotonic()
        process.send_signal(signal.SIGTERM)
        process.wait(timeout=60)
        self.assertLess(time.monotonic() - begin, longest)
        self.assertEqual(process.returncode, code, said.read_text())
        said.unlink()

    def test_placing_one_huge_layer(self):
        self.check("bed", self.path, "--set", "terrain.radius=0.006", "--set",
                   "terrain.length=200", "--set", "terrain.width=10",
                   "--set", "terrain.layers=1", "--set", "run.step=2e-5", phase="placing the grains")

    def test_settling_many_grains(self):
        self.check("bed", self.path, "--set", "terrain.radius=0.01", "--set", "terrain.length=12",
                   "--set", "terrain.layers=12", "--set", "run.step=2e-5", phase="settling the bed")

    def test_plots_and_what_measures_the_machine(self):
        self.furrow("run", self.path, *SHORT, "--out", "out", "--no-plots")
        self.check("report", "out", phase="plotting")
        (self.folder / "said").write_text("")
        process = self.start("validate", self.path, env={"XDG_CACHE_HOME": str(self.folder / "cache")})
        status = pathlib.Path(f"/proc/{process.pid}/status")
        caught = lambda: int(status.read_text().split("SigCgt:")[1].split()[0], 16)
        wait_for(lambda: caught() & 1 << signal.SIGTERM - 1, 60, "it attends to signals")
        process.send_signal(signal.SIGTERM)
        _, err = process.communicate(timeout=60)
        self.assertEqual((process.returncode, err.splitlines()[-1]), (75, "furrow: error: stopped by a signal"))

    def test_soil_tests(self):
        self.check("soil", self.path, "--only", "plate", "--speed", "0.001", "--out", "out", phase="soil tests")
        self.assertEqual(self.names(), ["small.json"])

    def test_pressing(self):
        path = write_scenario(self.folder, changed(tire={"rigid": False, "elements_width": 60}), "soft.json")
        self.check("press", path, "--out", "out", phase="in")  # inflating
        self.assertEqual(self.names(), ["small.json", "soft.json"])


class Pause(EnvironmentTest):
    def states(self):
        found = {}
        for rank, pid in ranks(self.path).items():
            found[rank] = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]
        return found

    def stopped_run(self):
        """A run that Ctrl-Z has stopped, with its ranks."""
        process = self.start("run", self.path, "--set", "run.end=0.3", "--out", "out", "--set", "terrain.engine=rigid",
                             "--no-plots", "--set", "run.step=1e-6")
        wait_for(lambda: (self.folder / "out" / "timeseries.csv").exists(), 60, "the run begins")
        process.send_signal(signal.SIGTSTP)
        wait_for(lambda: set(self.states().values()) == {"T"} and len(self.states()) == 3, 20, "all ranks are stopped")
        state = pathlib.Path(f"/proc/{process.pid}/stat")
        wait_for(lambda: state.read_text().rsplit(")", 1)[1].split()[0] == "T", 20, "the program is stopped")
        return process

    def test_ctrl_z_stops_the_ranks_and_fg_lets_them_go_on(self):
        process = self.stopped_run()
        process.send_signal(signal.SIGCONT)
        wait_for(lambda: "T" not in self.states().values(), 20, "all ranks go on")
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 75)

    def test_ranks_that_are_stopped_end_when_the_program_is_killed(self):
        process = self.stopped_run()
        process.kill()
        process.communicate(timeout=60)
        wait_for(lambda: not survivors(self.folder), 30, "all processes end")
        self.assertTrue(list((self.folder / "out" / "checkpoints").glob("*/manifest.json")))


class Names(EnvironmentTest):
    def test_that_begin_with_a_hyphen(self):
        self.path.rename(self.folder / "-b.json")
        self.furrow("run", *SHORT, "--out=-dd", "--", "-b.json", prints="-dd\n")
        self.furrow("resume", "--until", "0.006", "--no-plots", "--", "-dd")
        self.furrow("report", "--", "-dd", shows="-dd/forces.png")

    def test_that_are_not_utf_8(self):
        folder = os.fsencode(self.folder) + b"/caf\xe9"
        done = subprocess.run([os.fsencode(PROGRAM), b"run", os.fsencode(self.path), *(word.encode() for word in SHORT),
                               b"--out", folder], cwd=self.folder, capture_output=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        done = subprocess.run([os.fsencode(PROGRAM), b"report", folder], cwd=self.folder, capture_output=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        plots = done.stdout.split(b"\n")[:-1]
        self.assertTrue(plots)
        for plot in plots:
            self.assertTrue(os.path.exists(plot), plot)

    def test_a_scenario_in_a_folder_that_is_not_utf_8_with_its_own_tire(self):
        folder = os.fsencode(self.folder) + b"/caf\xe9"
        os.mkdir(folder)
        tire = pathlib.Path(__file__).resolve().parents[2] / "tire" / "data" / "hmmwv_layered.json"
        with open(folder + b"/own.json", "wb") as file:
            file.write(tire.read_bytes())
        with open(folder + b"/s.json", "w") as file:
            json.dump(changed(tire={"file": "own.json"}), file)
        done = subprocess.run([os.fsencode(PROGRAM), b"run", folder + b"/s.json", *(word.encode() for word in SHORT),
                               b"--out", b"out"], cwd=self.folder, capture_output=True)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(b"key 'tire.file': is in a folder with a name that is not UTF-8", done.stderr)

    def test_of_plots_do_not_depend_on_the_users_python(self):
        self.furrow("run", self.path, *SHORT, "--out", "out")
        evil = self.folder / "evil"
        evil.mkdir()
        for module in ("json", "matplotlib", "h5py"):
            (evil / f"{module}.py").write_text("raise SystemExit('the user's own code ran')")
            shutil.copy(evil / f"{module}.py", self.folder)
        self.furrow("report", "out", lacks="Python", env={"PYTHONPATH": str(evil), "PYTHONHOME": "/nowhere",
                                                          "PYTHONSTARTUP": str(evil / "json.py")})


class Output(EnvironmentTest):
    def test_a_reader_that_leaves_is_no_error(self):
        for command in (["bed"], ["bench", "tire", "--steps", "1", "--warm", "0"]):
            read, write = os.pipe()
            os.close(read)
            arguments = [*command] if command[0] == "bench" else [*command, str(self.path)]
            done = subprocess.run([PROGRAM, *arguments], cwd=self.folder,
                                  stdout=write, stderr=subprocess.PIPE, text=True, timeout=120)
            os.close(write)
            self.assertNotIn("furrow: error: ", done.stderr)
            self.assertEqual(done.returncode, 0)

    def test_a_full_disk_is_one(self):
        with open("/dev/full", "w") as full:
            done = subprocess.run([PROGRAM, "explain"], cwd=self.folder, stdout=full, stderr=subprocess.PIPE, text=True)
        self.expect(done, 5, errors=1, says="standard output: cannot be written")

    def test_the_printed_line_of_ranks_works(self):
        self.furrow("ranks", self.path, *SHORT[:-1], "--out", "out", code=2)  # the line is completed by hand
        done = self.furrow("ranks", self.path, *SHORT[:-1])
        line = next(line for line in done.stdout.splitlines() if line.startswith("mpirun "))
        self.call(["bash", "-c", line + " --out out"])
        self.assertTrue((self.folder / "out" / "summary.json").exists())


if __name__ == "__main__":
    main()
