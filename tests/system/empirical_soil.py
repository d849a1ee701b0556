#!/usr/bin/python3
"""Empirical soil as a user meets it: a wheel on it, the same with any number of threads, soil files for several
engines."""
import csv
import math

import h5py

from program import SystemTest, changed, main, read_json, write_scenario

# A rigid wheel is let down on dry sand while it starts, and rolls half a metre.
WHEEL = {
    **changed(terrain=None, run={"step": 2e-4, "end": 0.5, "average_from": 0.3},
              output={"series_interval": 2e-3, "frame_interval": 0.1}),
    "terrain": {"engine": "scm", "material": "dry_sand.json", "length": 2.5, "width": 0.4, "grid_spacing": 0.01},
}


class EmpiricalSoil(SystemTest):
    def run_of(self, name, *flags, scenario=WHEEL):
        return super().run_of(name, scenario, *flags)

    def test_a_wheel_sinks_pulls_leaves_a_rut_and_its_accounts_close(self):
        told, _ = self.run_of("out")
        self.assertGreater(told["sinkage_m"], 0.005)
        self.assertLess(told["sinkage_m"], 0.1)
        energy = told["accounts"]["energy"]
        self.assertTrue(energy["closes"], energy)
        self.assertTrue(told["accounts"]["momentum"]["closes"])
        for entry in ("sliding_loss", "normal_damping_loss"):
            self.assertGreater(energy["lost"][entry], 0.0)
        with open(self.folder / "out/timeseries.csv", newline="") as file:
            for line in csv.DictReader(file):
                self.assertTrue(all(math.isfinite(float(value)) for value in line.values()), line)
        frame = sorted((self.folder / "out/frames").glob("terrain_*.h5"))[-1]
        with h5py.File(frame) as file:
            deepest = file["position"][:, 2].min()
        self.assertLess(deepest, -0.005)

    def test_a_wheel_that_no_ground_bears_is_warned_of(self):
        _, told = self.run_of("soft", "--set", "terrain.bekker_k_phi=1e4", "--set", "terrain.bekker_k_c=0",
                              "--set", "run.end=0.6", "--set", "run.average_from=0.5", "--set", "terrain.length=3.5")
        self.assertRegex(told, r"WARNING: the wheel has sunk in by \S+ radii: the ground does not bear its load")
        path = write_scenario(self.folder, WHEEL)
        self.furrow("run", path, "--no-plots", "--set", "terrain.bekker_k_phi=1e4", "--set", "terrain.bekker_k_c=0",
                    "--set", "run.end=0.8", "--set", "run.average_from=0.7", "--set", "terrain.length=3.5", code=3,
                    says=("wheel 0 has sunk in by 0.9", ", expected less than its diameter of 0.934"))
        _, told = self.run_of("usual")
        self.assertNotIn("WARNING", told)

    def test_a_step_that_the_ground_does_not_bear_is_told_before_and_ends_the_run(self):
        path = write_scenario(self.folder, {**WHEEL, "run": {**WHEEL["run"], "step": 2e-3}})
        hard = ("--set", "terrain.bekker_k_phi=1e12", "--set", "terrain.bekker_k_c=0")
        self.furrow("validate", path, *hard, says="key 'run.step': 0.002 s is more than")
        self.furrow("run", path, *hard, "--no-plots", code=3, says=("at the interface 'wheel 0 ", "' late forces made",
                                                                    "run.step of", "run.on_lag 'warn' to go on"))

    def test_light_wheels_sink_alike_at_any_step(self):
        """The unloading stiffness shakes a wheel of 2 kg with 60 Hz: late forces threw it off."""
        light = {"format_version": 1,
                 "rig": {"type": "drawbar", "mode": "fixed_speed", "speed": 0.1, "slip": 0.13, "load": 19.6,
                         "ramp": 0.1, "rim_mass": 0.3, "rim_spin_inertia": 1e-3},
                 "tire": {"file": "rigid_drum.json", "rigid": True},
                 "terrain": {"engine": "scm", "material": "lete_sand.json", "length": 0.6, "width": 0.3,
                             "grid_spacing": 0.005},
                 "run": {"end": 2.0, "average_from": 1.0}, "output": {"frame_interval": 0}}
        coarse, fine = (self.run_of(step, "--set", f"run.step={step}", scenario=light)[0] for step in ("1e-3", "1e-4"))
        self.assertAlmostEqual(coarse["sinkage_m"], fine["sinkage_m"], delta=0.02 * fine["sinkage_m"])
        self.assertAlmostEqual(coarse["drawbar_pull_N"]["mean"], fine["drawbar_pull_N"]["mean"], delta=0.02 * 19.6)
        self.assertTrue(coarse["interface"]["ok"], coarse["interface"])

    def test_threads_change_nothing(self):
        self.run_of("one", "--set", "run.end=0.2", "--set", "run.average_from=0.1", "--set", "run.threads=1")
        _, told = self.run_of("two", "--set", "run.end=0.2", "--set", "run.average_from=0.1", "--set", "run.threads=2")
        self.assertIn("key 'run.threads': is 2: engine 'scm' takes one thread", told)
        for name in ("timeseries.csv", "frames/terrain_000001.h5"):
            self.assertEqual((self.folder / "one" / name).read_bytes(), (self.folder / "two" / name).read_bytes(), name)

    def test_one_soil_file_serves_grains_and_empirical_soil(self):
        scenario = {**WHEEL, "run": {"step": 2e-4, "end": 0.01, "average_from": 0.005},
                    "terrain": {**WHEEL["terrain"], "material": None}}
        _, told = self.run_of("scm", "--set", "terrain.material=loose_sand.json", scenario=scenario)
        terrain = read_json(self.folder / "scm/scenario.json")["terrain"]
        self.assertEqual(terrain["bekker_n"], 0.2843)
        self.assertNotIn("rolling_friction", terrain)
        self.assertNotIn("are ignored", told)
        path = write_scenario(self.folder, changed(terrain={"material": "loose_sand.json"}))
        self.furrow("validate", path, lacks="are ignored")

    def test_commands_that_need_grains_say_so(self):
        path = write_scenario(self.folder, WHEEL)
        for command in ("bed", "soil"):
            self.furrow(command, path, code=2, says="key 'terrain.engine': is 'scm'")


if __name__ == "__main__":
    main()
