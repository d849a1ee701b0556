#!/usr/bin/python3
"""`furrow calibrate` with grains: real soil tests of a few seconds, stopped and continued."""
import csv
import signal

from program import ROOT, SystemTest, main, read_json, wait_for, write_json


class CalibrateGrains(SystemTest):
    """One parameter, one bed, two loads, fast tools, soft grains: as quick as the tests can be, and no result to
    quote."""

    STUDY = {"calibrate": "grains", "start": "drawbar_pull_small_report_soil.json",
             "set": {"terrain.material": "loose_sand.json", "terrain.young_modulus": 1e6, "terrain.size_spread": 0},
             "tests": {"seeds": 1, "speed": 2.0, "stresses": [2e3, 5e3]},
             "parameters": {"rolling_friction": {"lower": 0, "upper": 1, "start": 0.3}},
             "targets": [{"quantity": "friction_angle_without_cohesion_deg", "value": 28.0, "sigma": 1.0},
                         {"quantity": "bulk_density_kg_m3", "value": 3000.0, "sigma": 100.0},
                         {"quantity": "janosi_K_m", "value": 1e-3, "sigma": 5e-4}],
             "evaluations": 6, "result": "sand.json"}

    def rows(self):
        text = (self.folder / "out" / "evaluations.csv").read_text()
        return list(csv.DictReader(text.splitlines()[1:]))

    def test_it_is_stopped_continued_and_leaves_a_soil_with_what_was_reached(self):
        write_json(self.folder / "study.json", self.STUDY)
        process = self.start("calibrate", "study.json", "--out", "out", "--no-plots")
        table = self.folder / "out" / "evaluations.csv"
        wait_for(lambda: process.poll() is not None or (table.exists() and table.read_text().count("\n") >= 4),
                 300, "two evaluations")
        process.send_signal(signal.SIGTERM)
        out, err = process.communicate(timeout=120)
        self.assertEqual((process.returncode, out), (75, "out\n"), err)
        # Before anything is computed.
        self.assertIn("janosi_K_m of 1 mm cannot be reached with grains of 20 mm diameter", err)
        before = table.read_text()
        self.furrow("calibrate", "study.json", "--out", "out", timeout=300, prints="out\n")
        self.assertTrue(table.read_text().startswith(before))
        rows = self.rows()
        fitted = [row for row in rows if row["set"] == "fitted"]
        self.assertGreaterEqual(len(fitted), 4)
        self.assertLessEqual(len(fitted), 6)
        self.assertTrue(all(float(row["processor_s"]) > 0 for row in fitted))

        result = read_json(self.folder / "out" / "calibration.json")
        self.assertEqual(result["evaluations"], len(fitted))
        self.assertAlmostEqual(result["processor_s"], sum(float(row["processor_s"] or 0) for row in rows), places=2)
        states = {target["name"]: target["figures"][0].get("state")
                  for target in result["targets"] + result["held_out_targets"]}
        self.assertEqual(states["bulk_density_kg_m3"], "out of range")  # denser than the grains themselves
        self.assertIsNone(states["janosi_K_m"])
        self.assertTrue(any("bulk_density_kg_m3" in warning and "is not reached" in warning
                            for warning in result["warnings"]))
        place = {row["rolling_friction"] for row in fitted}
        self.assertIn(result["parameters"]["rolling_friction"]["value"], map(float, place))

        soil = read_json(self.folder / "out" / "sand.json")
        self.assertEqual(soil["terrain"]["rolling_friction"], result["parameters"]["rolling_friction"]["value"])
        self.assertEqual(soil["measured"]["grain_radius_m"], 0.01)
        self.assertIn("mean", soil["measured"]["bulk_density_kg_m3"])
        self.furrow("validate", ROOT / "rigs" / "drawbar_pull_small_report_soil.json",
                    "--set", f"terrain.material={self.folder / 'out' / 'sand.json'}")
        for name in ("fit.png", "residual.png", "report.html"):
            self.assertTrue((self.folder / "out" / name).exists(), name)
        # All is known: the same bits at once.
        expected = {name: (self.folder / "out" / name).read_bytes()
                    for name in ("calibration.json", "fit.csv", "evaluations.csv", "sand.json")}
        self.furrow("calibrate", "study.json", "--out", "out", "--no-plots")
        self.assertEqual({name: (self.folder / "out" / name).read_bytes() for name in expected}, expected)


if __name__ == "__main__":
    main()
