#!/usr/bin/python3
"""Contacts too hard for the step: the terrain steps more finely; and what is left of a run that fails all the same."""
import csv

from program import SystemTest, changed, main, read_json, rows_of, write_json, write_scenario

# A rigid disc of a laboratory's single-wheel test: radius 58 mm, width 50 mm, on dry sand.
DISC = {
    "format_version": 1, "template": "ancf_shell", "name": "disc", "radius": 0.058,
    "rim_radius": 0.058, "rim_width": 0.05, "pressure": 1e3,
    "structural_damping": 1e-3, "elements_circumference": 60,
    "contact": {"young_modulus": 5e7, "poisson_ratio": 0.3, "friction": 0.4, "restitution": 0.2,
                "normal_stiffness": 1e6, "normal_damping": 10},
    "materials": {"steel": {"density": 1000, "young_modulus": 1e8, "poisson_ratio": 0.3}},
    "sections": {name: {"elements_per_side": 1, "layers": [{"thickness": 2e-3, "angle_deg": 0, "material": "steel"}]}
                 for name in ("bead", "sidewall", "tread")},
    "profile": [[k / 12, 0, -0.025 + 0.05 * k / 12] for k in range(13)],
}
WHEEL = {
    "format_version": 1,
    "rig": {"type": "drawbar", "slip": 0.5, "angular_speed": 8.0, "ramp": 0.05, "carrier_mass": 2.0,
            "chassis_mass": 0.1, "set_toe_mass": 0.1, "rim_mass": 0.4, "rim_spin_inertia": 1e-3,
            "rim_diametral_inertia": 1e-3, "touchdown_damping": 20, "touchdown_time": 0.05},
    "tire": {"file": "disc.json", "rigid": True},
    "terrain": {"radius": 0.0035, "density": 2420, "young_modulus": 5e6, "friction": 0.5, "rolling_friction": 0.1,
                "layers": 8, "length": 0.32, "width": 0.1},
    "run": {"step": 7.8e-5, "end": 0.12, "average_from": 0.06},
    "output": {"frame_interval": 0},
}


def summary(run, name="summary.json"):
    return read_json(run / name)


class SmallWheel(SystemTest):
    def setUp(self):
        super().setUp()
        write_json(self.folder / "disc.json", DISC)
        self.path = write_scenario(self.folder, WHEEL, "wheel.json")
        self.run_folder = self.folder / "run"

    def test_a_run_that_a_hard_contact_used_to_end_comes_to_its_end(self):
        done = self.furrow("run", self.path, "--no-plots", "--out", self.run_folder)
        found = summary(self.run_folder)
        self.assertGreater(found["substeps_added"], 0, done.stderr)
        self.assertTrue(0.0 < found["substeps_refined_share"] <= 1.0)
        self.assertGreaterEqual(found["substeps_most_parts"], 2)
        self.assertIn(f"the terrain took {found['substeps_added']} more substeps", done.stderr)
        # It continues bit for bit while it is refined, whatever the threads.
        again = self.folder / "again"
        for arguments in (("run", self.path, "--threads", "1", "--out", again, "--set", "run.end=0.0845",
                           "--set", "run.average_from=0.06"), ("resume", again, "--until", "0.12")):
            self.furrow(*arguments, "--no-plots")
        other = summary(again)
        for key in ("state_hash", "substeps_added", "substeps_refined_share", "drawbar_pull_N"):
            self.assertEqual(other[key], found[key], key)


class Failed(SystemTest):
    """Grains so soft that the wheel presses them flat."""
    SOFT = changed(terrain={"young_modulus": 3e5, "cohesion": 0.0},
                   run={"step": 1e-4, "end": 0.3, "average_from": 0.01},
                   output={"frame_interval": 0}, checkpoint={"interval": 0.01})

    def fail(self, scenario, *flags, code=3):
        path = write_scenario(self.folder, scenario)
        run = self.folder / "run"
        done = self.furrow("run", path, "--no-plots", "--out", run, *flags, code=code)
        return run, done.stderr

    def test_what_no_step_cures_says_how_many_where_and_what_to_change(self):
        run, told = self.fail(self.SOFT)
        self.assertRegex(told, r"terrain has contacts that are too hard for its grains at t = .* contacts? (is|are) "
                         r"deeper than 30 % of a grain's diameter, the deepest by .* m \(\d+ %\) between .* at \(.*\) "
                         r"m; expected stiffer grains \(about .* Pa in terrain.young_modulus, which needs a step of at "
                         r"most .* s\), or less load or speed; a smaller step does not help")
        self.assertNotIn("furrow resume", told)
        self.assertIn("a resumed run would fail at the same step; start again with furrow run", told)
        self.assertFalse((run / "summary.json").exists())
        found = summary(run, "summary_failed.json")
        self.assertEqual(found["failed"]["exit_code"], 3)
        self.assertIn("deeper than 30 %", found["failed"]["error"])
        self.assertGreater(found["failed"]["time_s"], 0.01)
        self.assertNotIn("state_hash", found)
        self.assertTrue((run / "results.h5").exists())
        with open(run / "timeseries.csv", newline="") as file:
            rows = [row for row in csv.DictReader(file)]
        pull = found["drawbar_pull_N"]
        part = [float(row["drawbar_pull_N"]) for row in rows if pull["from_s"] < float(row["time_s"]) <= pull["to_s"]]
        self.assertAlmostEqual(pull["mean"], sum(part) / len(part), delta=1e-9 * abs(pull["mean"]))

    def test_a_failed_run_may_be_stepped_more_finely_and_only_that(self):
        run, told = self.fail(self.SOFT)
        for setting, key in (("terrain.young_modulus=1e7", "terrain.young_modulus"), ("run.step=7e-5", "run.step")):
            self.furrow("resume", run, "--set", setting, code=2, says=f"key '{key}': is ")
        # Up to before the failure, where it has a checkpoint: it continues with half the step and ends.
        stopped = summary(run, "summary_failed.json")["failed"]["time_s"]
        last = max(int(entry.name) for entry in (run / "checkpoints").iterdir()) * 1e-4
        self.assertLess(last, stopped)
        self.furrow("resume", run, "--no-plots", "--set", "run.step=5e-5", "--set", "terrain.substeps=2",
                    "--until", f"{last + 2e-4:.4f}")
        self.assertFalse((run / "summary_failed.json").exists())
        segment = summary(run)["segments"][-1]
        self.assertEqual(segment["from_step"], round(last / 5e-5))
        self.assertEqual(segment["changed"]["run.step"], 5e-5)
        self.assertEqual(segment["changed"]["terrain.substeps"], 2)
        with open(run / "timeseries.csv", newline="") as file:
            times = [float(row["time_s"]) for row in csv.DictReader(file)]
        self.assertEqual(times, sorted(set(times)))
        # A run that has not failed keeps its step.
        self.furrow("resume", run, "--until", "0.3", "--set", "run.step=2.5e-5", code=2,
                    says="only one that failed may be stepped more finely")

    def test_unchanged_it_is_told_that_it_will_fail_again(self):
        run, _ = self.fail(self.SOFT)
        self.furrow("resume", run, "--no-plots", code=3,
                    matches=r"warning: .*failed at t = .* s and will fail again, as nothing is changed",
                    lacks="to continue from the last checkpoint: furrow resume")

    def test_a_sweep_keeps_what_there_is(self):
        write_scenario(self.folder, self.SOFT)
        study = write_json(self.folder / "study.json", {"scenario": "small.json", "plot": {"x": "rig.slip",
                                                                                           "y": "drawbar_pull_N.mean"},
                                                        "list": [{"rig.slip": 0.3}, {"rig.slip": 0.4,
                                                                                     "terrain.young_modulus": 2.49e7,
                                                                                     "run.end": 0.03}]})
        self.furrow("sweep", study, code=3)
        rows = rows_of(self.folder / "results" / "study" / "sweep.csv")
        self.assertEqual([row["state"] for row in rows], ["failed", "done"])
        self.assertTrue(float(rows[0]["drawbar_pull_N.mean"]) == float(rows[0]["drawbar_pull_N.mean"]))
        self.assertIn("deeper than 30 %", rows[0]["problem"])


if __name__ == "__main__":
    main()
