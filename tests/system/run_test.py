#!/usr/bin/python3
"""`furrow run` for real: what it leaves behind, and what it does when ranks die, stop, or it is told to stop."""
import csv
import os
import shutil
import signal

from program import (PROGRAM, ROOT, SystemTest, changed, children, furrow, main, ranks, read_json, survivors, wait_for,
                     write_json, write_scenario)

FIRST_LOOK = ROOT / "rigs" / "first_look.json"
SHORT = ["--set", "run.end=0.05", "--set", "run.average_from=0.02"]
RESULTS = {"summary.json", "timeseries.csv", "results.h5", "results.xdmf", "scenario.json", "run.log", "frames"}


class Run(SystemTest):
    def test_first_look_shortened_leaves_its_results(self):
        landed = ["--set", "run.end=0.3", "--set", "run.average_from=0.25"]
        done = self.furrow("run", FIRST_LOOK, *landed, prints="results/first_look-001\n")
        run = self.folder / "results" / "first_look-001"
        self.assertLessEqual(RESULTS, {path.name for path in run.iterdir()})
        summary = read_json(run / "summary.json")
        self.assertAlmostEqual(summary["simulated_s"], 0.3)
        self.assertGreater(summary["grains"], 1000)
        self.assertEqual([rank["node"] for rank in summary["ranks"]], ["rig", "tire 0", "terrain"])
        self.check_works(run, summary)
        self.expect(done, says=("drawbar pull", "% of the load", "sinkage", "not steady", "Steady or not",
                                "no rut measured: the axle", "busy"), lacks=("mpirun", "expected"))
        self.assertEqual(survivors(self.folder), [])

        again = furrow("run", FIRST_LOOK, *SHORT, cwd=self.folder)
        self.assertEqual(again.stdout, "results/first_look-002\n")
        self.assertIn("the tire did not touch the terrain", again.stderr)

    def check_works(self, run, summary):
        """A tire that starts at rest holds what rim, terrain and gravity did on it; the series' last line is the
        summary's."""
        with open(run / "timeseries.csv", newline="") as file:
            rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
        rig = read_json(run / "scenario.json")["rig"]
        tire_mass = summary["vertical_load_N"] / 9.81 - rig["carrier_mass"] - rig["rim_mass"]
        weight_work = -9.81 * tire_mass * (rows[-1]["axle_height_m"] - rows[0]["axle_height_m"])
        on_tire = summary["interface_work_J"] + rows[-1]["rim_work_J"] + weight_work
        self.assertLess(summary["interface_work_J"], 0.0)
        self.assertAlmostEqual(on_tire, rows[-1]["tire_energy_J"], delta=0.01 * abs(summary["interface_work_J"]))
        self.assertEqual(summary["spindle_work_J"], rows[-1]["spindle_work_J"])

    def test_a_wheel_that_stands_on_a_soil_of_ones_own_and_goes_on(self):
        write_json(self.folder / "mysand.json", {"format_version": 1, "terrain": {"friction": 0.5}})
        scenario = changed(rig={"mode": "fixed_speed", "speed": 0}, terrain={"material": "mysand.json"},
                           output={"frame_interval": 0})
        done = self.furrow("run", write_scenario(self.folder, scenario), "--no-plots")
        run = self.folder / done.stdout.strip()
        summary = read_json(run / "summary.json")
        reasons = " ".join(summary["drawbar_pull_N"]["unsteady_because"])
        self.assertIn("less than 2 tire radii", reasons)
        self.assertIsNotNone(summary["interface"]["ok"], summary["interface"])
        self.assertEqual(summary["columns"]["drawbar_pull_N"], summary["drawbar_pull_N"]["mean"])
        self.assertEqual(summary["wheels"][0]["columns"], summary["columns"])
        self.assertEqual(summary["columns"]["spindle_work_J"], summary["spindle_work_J"])
        again = furrow("resume", run, "--until", "0.06", "--no-plots", cwd=self.folder.parent)
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertAlmostEqual(read_json(run / "summary.json")["simulated_s"], 0.06)

    def test_threads_do_not_change_the_result_and_the_seed_does(self):
        path = write_scenario(self.folder)
        hashes = []
        sides = ["--set", "terrain.sides=periodic", "--threads"]
        for number, flags in enumerate((["--threads", "1"], ["--threads", "2"],
                                        ["--set", "run.seed=2"], [*sides, "1"], [*sides, "2"])):
            self.furrow("run", path, "--out", f"out{number}", "--no-plots", *flags)
            hashes.append(self.summary(f"out{number}")["state_hash"])
        self.assertEqual(hashes[0], hashes[1])
        self.assertEqual(hashes[3], hashes[4])
        self.assertEqual(len({hashes[0], hashes[2], hashes[3]}), 3)

    def test_overwrite_replaces_results_and_nothing_else(self):
        path = write_scenario(self.folder)
        self.furrow("run", path, "--out", "out", "--no-plots")
        (self.folder / "out" / "notes.txt").write_text("mine")
        (self.folder / "out" / "frames" / "terrain_009999.h5").write_text("of an older, longer run")
        done = self.furrow("run", path, "--out", "out", "--overwrite", "--no-plots")
        self.assertEqual(done.stderr.count("Open MPI's option --allow-run-as-root"), os.geteuid() == 0, done.stderr)
        self.assertEqual((self.folder / "out" / "notes.txt").read_text(), "mine")
        self.assertFalse((self.folder / "out" / "frames" / "terrain_009999.h5").exists())

    def test_under_the_users_mpirun(self):
        path = write_scenario(self.folder)
        command = [shutil.which("mpirun"), "--allow-run-as-root", "--oversubscribe", "--bind-to", "none", "-n", "3",
                   PROGRAM, "run", str(path), "--no-plots"]
        done = self.call(command, prints="results/small-001\n")
        self.assertTrue((self.folder / "results" / "small-001" / "summary.json").exists())
        self.assertEqual(done.stderr.count(" simulated s, "), 1, done.stderr)

    def test_four_wheels_on_one_bed_each_read_their_own_weight(self):
        self.furrow("run", ROOT / "rigs" / "four_wheels.json", "--out", "out", "--set", "terrain.radius=0.03",
                    "--set", "terrain.layers=3", "--set", "run.step=2e-4", "--no-plots")
        masses = [200, 320, 450, 700]
        summary = self.summary()
        self.assertEqual(len(summary["ranks"]), 6)
        self.assertNotIn("vertical_load_N", summary)
        for wheel, (mass, entry) in enumerate(zip(masses, summary["wheels"], strict=True)):
            weight = entry["vertical_load_N"]
            self.assertAlmostEqual(weight, 9.81 * (mass + 15 + 4.8), delta=0.5)
            self.assertAlmostEqual(entry["net_terrain_force_N"][2], weight, delta=0.005 * weight, msg=f"wheel {wheel}")
        tables = sorted(path.name for path in (self.folder / "out").glob("*.csv"))
        self.assertEqual(tables, ["timeseries_accounts.csv", *(f"timeseries_wheel{wheel}.csv" for wheel in range(4))])
        self.assertEqual(sorted(path.name for path in (self.folder / "out").glob("summary*")), ["summary.json"])

    def test_profile_is_a_chrome_trace_of_all_ranks(self):
        self.furrow("run", write_scenario(self.folder), "--out", "out", "--profile", "--no-plots")
        events = read_json(self.folder / "out" / "profile.json")["traceEvents"]
        names = {event["pid"]: event["args"]["name"] for event in events if event["ph"] == "M"}
        self.assertEqual(list(names.values()), ["rig", "tire 0", "terrain"])
        for rank in names:
            steps = [event for event in events if event["pid"] == rank and event["ph"] == "X"]
            self.assertEqual(len(steps), 2 * 500)
            for before, after in zip(steps, steps[1:]):
                self.assertLessEqual(before["ts"] + before["dur"], after["ts"] + 0.2)

    def test_report_makes_plots(self):
        path = write_scenario(self.folder)
        self.furrow("run", path, "--out", "out", "--no-plots")
        self.assertEqual(list((self.folder / "out").glob("*.png")), [])
        done = self.furrow("report", "out")
        self.assertTrue(done.stdout)
        for name in done.stdout.splitlines():
            self.assertEqual((self.folder / name).read_bytes()[:4],
                             b"<!DO" if name.endswith("report.html") else b"\x89PNG")


class Interrupted(SystemTest):
    """A run that would take a while, disturbed once the wheel moves."""

    def setUp(self):
        super().setUp()
        self.path = write_scenario(self.folder,
                                   changed(run={"end": 60.0, "average_from": 1.0, "step": 1e-4, "peer_timeout": 2},
                                           rig={"mode": "fixed_speed", "speed": 0.005, "slip": 0.3},
                                           output={"frame_interval": 0.05}))

    def started(self):
        process = self.start("run", self.path, "--out", "out", "--no-plots")
        series = self.folder / "out" / "timeseries.csv"
        wait_for(lambda: series.exists() and len(ranks(self.path)) == 3 and process.poll() is None,
                 60, "the run begins")
        frames = self.folder / "out" / "frames"
        wait_for(lambda: frames.exists() and len(list(frames.glob("tire0_*.h5"))) >= 2, 60, "the run moves")
        return process

    def end(self, process, code, seconds=20):
        out, err = process.communicate(timeout=seconds)
        self.assertEqual(process.returncode, code, err)
        wait_for(lambda: not survivors(self.path), 5,
                 lambda: f"all processes end, still there: {survivors(self.path)}")
        return out, err

    def error_line(self, err):
        told = [line for line in err.splitlines() if line.startswith("furrow: error: ")]
        self.assertEqual(len(told), 1, err)
        self.assertNotIn("mpirun", err)
        self.assertNotIn("-----", err)
        return told[0]

    def test_killed_rank_is_named(self):
        for rank, name in ((0, "rig"), (1, "tire 0"), (2, "terrain")):
            with self.subTest(name):
                shutil.rmtree(self.folder / "out", ignore_errors=True)
                process = self.started()
                os.kill(ranks(self.path)[rank], signal.SIGKILL)
                _, err = self.end(process, 4)
                self.assertIn(f"furrow: error: rank {rank} ({name}) was lost: killed by signal 9", self.error_line(err))

    def test_stopped_rank_is_named_within_the_time_out(self):
        process = self.started()
        os.kill(ranks(self.path)[1], signal.SIGSTOP)
        _, err = self.end(process, 4)
        self.assertRegex(self.error_line(err), r"waited 2 s for tire 0 .*tire 0 does not answer")

    def test_term_int_hup_and_usr1_stop_it_cleanly(self):
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGUSR1):
            with self.subTest(number.name):
                shutil.rmtree(self.folder / "out", ignore_errors=True)
                process = self.started()
                process.send_signal(number)
                out, err = self.end(process, 75)
                self.assertEqual(out, "out\n")
                self.assertIn("stopped by a signal", err)
                self.assertNotIn("error", err)
                self.assertTrue((self.folder / "out" / "results.h5").exists())
                self.assertFalse((self.folder / "out" / "summary.json").exists())

    def test_stop_while_starting(self):
        process = self.start("run", self.path, "--out", "out")
        wait_for(lambda: (self.folder / "out" / "run.log").exists(), 20, "the supervisor begins")
        process.send_signal(signal.SIGTERM)
        self.end(process, 75, 60)

    def test_killed_supervisor_leaves_no_process(self):
        process = self.started()
        process.kill()
        process.communicate(timeout=10)
        wait_for(lambda: not survivors(self.path), 10, "all processes end")

    def test_killed_launcher_leaves_no_process(self):
        process = self.started()
        os.kill(children(process.pid)[0], signal.SIGKILL)
        _, err = self.end(process, 4)
        self.assertIn("furrow: error: mpirun was killed by signal 9", err)


if __name__ == "__main__":
    main()
