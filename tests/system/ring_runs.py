#!/usr/bin/python3
"""The flexible ring in runs: it stands as `furrow press` has it, rolls on every kind of ground with accounts that
close, under a vehicle, through a study and a report."""

from program import ROOT, SystemTest, main, read_json, write_json, write_scenario

RING = {"file": "hmmwv_ring.json", "elements_circumference": 120}
# A few kilometres per hour, let down quickly.
ROLLING = {
    "format_version": 1,
    "rig": {"type": "drawbar", "slip": 0.1, "angular_speed": 4.28, "ramp": 0.05, "carrier_mass": 450,
            "touchdown_damping": 12e3, "touchdown_time": 0.3},
    "tire": RING,
    "run": {"step": 1e-4, "end": 0.6, "average_from": 0.4},
    "output": {"series_interval": 2e-3, "frame_interval": 0.1},
    "checkpoint": {"at_end": False},
}
GROUNDS = {
    "rigid": {"engine": "rigid", "ground_stiffness": 5e7, "ground_shear_stiffness": 2e7, "ground_damping": 1e4},
    "scm": {"engine": "scm", "material": "dry_sand.json", "length": 2.5, "width": 0.5, "grid_spacing": 0.02},
    "dem": {"engine": "dem", "radius": 0.03, "cohesion": 20e3, "layers": 3, "length": 2.1, "width": 0.5},
}
# The damper holds on to the end: the tire's own damping lets the load bounce for seconds.
STAND = {**ROLLING, "rig": {"type": "drawbar", "slip": 0.0, "angular_speed": 0, "ramp": 0, "carrier_mass": 450,
                            "touchdown_damping": 20e3, "touchdown_time": 10},
         "terrain": GROUNDS["rigid"], "run": {"step": 1e-4, "end": 1.2, "average_from": 1.1}}


class RingRuns(SystemTest):
    def test_at_rest_on_hard_ground_it_is_deflected_as_by_press(self):
        """On a ground that hardly gives way: 5e7 N/m³ takes up 7 % of the deflection, 2e8 N/m³ 2 %. Of 120 segments the
        middles lie 0.16 mm above the nodes, 1.2 % of the deflection."""
        ring = {**RING, "elements_circumference": 240}
        hard = {**STAND, "tire": ring, "terrain": {"engine": "rigid", "ground_stiffness": 1e9,
                                                   "ground_shear_stiffness": 1e8, "ground_damping": 5e4},
                "run": {"step": 2e-5, "end": 0.5, "average_from": 0.45}}
        path = write_scenario(self.folder, hard, "stand.json")
        told, _ = self.run_of("sticks", hard)
        slides, _ = self.run_of("slides", {**hard, "tire": {**ring, "friction": 0.0}})
        self.furrow("press", path, "--out", self.folder / "press", "--deflection", "0.03",
                    "--load", told["vertical_load_N"])
        pressed = self.summary("press")["deflection_m"]
        self.assertAlmostEqual(slides["tire_deflection_m"] / pressed, 1.0, delta=0.01)
        # Segments of the footprint come straight down: friction changes nothing.
        self.assertAlmostEqual(told["tire_deflection_m"] / slides["tire_deflection_m"], 1.0, delta=1e-3)

    def test_it_rolls_on_every_ground_and_its_accounts_close(self):
        for engine, terrain in GROUNDS.items():
            with self.subTest(engine=engine):
                told, _ = self.run_of(engine, {**ROLLING, "terrain": terrain})
                energy = told["accounts"]["energy"]
                self.assertTrue(energy["closes"], energy)
                self.assertTrue(told["accounts"]["momentum"]["closes"])
                self.assertLess(abs(energy["residual_of"]["tires"]), 1e-3 * energy["turnover"])
                self.assertGreater(energy["lost"]["tire_viscous_loss"], 0.0)
                self.assertAlmostEqual(told["net_terrain_force_N"][2] / told["vertical_load_N"], 1.0,
                                       delta=0.5 if engine == "dem" else 0.1)
                self.assertGreater(told["tire_deflection_m"], 0.004)

    def test_threads_change_nothing(self):
        scenario = {**ROLLING, "terrain": GROUNDS["dem"], "run": {"step": 1e-4, "end": 0.06, "average_from": 0.03}}
        for threads in (1, 2):
            self.run_of(f"threads{threads}", scenario, "--threads", threads)
        one, two = (self.folder / f"threads{threads}" / "timeseries.csv" for threads in (1, 2))
        self.assertEqual(one.read_bytes(), two.read_bytes())

    def test_a_pressure_schedule_lets_it_down(self):
        deflections = []
        for name, pressure in (("full", 2e5), ("low", 5e4), ("down", [[0, 2e5], [0.4, 2e5], [0.5, 5e4]])):
            told, _ = self.run_of(name, {**STAND, "tire": {**RING, "pressure": pressure}})
            deflections.append(told["tire_deflection_m"])
            self.assertTrue(told["accounts"]["energy"]["closes"], told["accounts"]["energy"])
        full, low, down = deflections
        self.assertGreater(down, 1.4 * full)
        self.assertAlmostEqual(down / low, 1.0, delta=0.01)

    def test_a_load_beyond_the_model_ends_the_run(self):
        path = write_scenario(self.folder, {**ROLLING, "terrain": GROUNDS["rigid"]})
        self.furrow("run", path, "--no-plots", "--out", self.folder / "out", "--set", "rig.carrier_mass=6000",
                    "--set", "rig.touchdown_damping=0", "--set", "rig.drop_height=0.2", code=3,
                    matches=r"tire 0 was pressed (further than a flexible ring is meant for|to its rim) at t = ")

    def test_a_vehicle_stands_and_drives_off_on_rings(self):
        scenario = read_json(ROOT / "rigs/hmmwv_rigid.json")
        scenario.pop("expected", None)
        scenario["tire"] = RING
        summary, _ = self.run_of("out", scenario, "--set", "output.frame_interval=0", "--set", "run.end=0.9", "--set",
                                 "run.average_from=0.7")
        self.accounts_close(summary)
        self.assertEqual(len(summary["wheels"]), 4)

    def test_study_and_report(self):
        scenario = {**ROLLING, "terrain": GROUNDS["scm"], "run": {"step": 1e-4, "end": 0.12, "average_from": 0.06}}
        write_scenario(self.folder, scenario, "ring.json")
        study = {"scenario": "ring.json", "grid": {"rig.slip": [0.1, 0.3]},
                 "plot": {"x": "rig.slip", "y": "drawbar_pull_N.mean"}}
        write_json(self.folder / "study.json", study)
        self.furrow("sweep", self.folder / "study.json", "--out", self.folder / "study", timeout=400)
        self.assertTrue((self.folder / "study/curve.png").exists())
        self.run_of("one", scenario)
        self.furrow("report", self.folder / "one", timeout=400)
        self.assertTrue((self.folder / "one/report.html").exists())


if __name__ == "__main__":
    main()
