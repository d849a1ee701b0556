#!/usr/bin/python3
"""`furrow bed` and `furrow soil` on a few large grains: what they print, leave behind, and how they stop."""
import json
import math
import pathlib
import signal
import time
import unittest

from program import (HAS_OTHER_MATHEMATICS, OTHER_MATHEMATICS, SystemTest, changed, furrow, main, read_json, start,
                     wait_for, write_json, write_scenario)


class WithCache(SystemTest):
    """The cache of these tests is their own."""

    def setUp(self):
        super().setUp()
        self.work = self.folder / "work"
        self.work.mkdir()
        self.env = {"XDG_CACHE_HOME": str(self.folder / "cache")}

    def run_json(self, *arguments):
        done = self.furrow(*arguments, cwd=self.work, env=self.env)
        return json.loads(done.stdout), done.stderr


class Bed(WithCache):
    def test_statistics_and_cache(self):
        path = write_scenario(self.work)
        first, told = self.run_json("bed", path)
        self.assertIn("settling the bed", told)
        self.assertTrue(first["settled"])
        self.assertFalse(first["from_cache"])
        self.assertLess(first["force_residual"], 1e-3)
        self.assertLess(first["floor_force_error"], 1e-3)
        self.assertTrue(0.4 < first["solid_fraction"] < 0.64, first)
        self.assertTrue(2.0 < first["coordination_number"] < 8.0, first)
        self.assertTrue(0.05 < first["depth_m"] < first["top_m"], first)
        mass = 2500 * 4 / 3 * math.pi * 0.03**3
        self.assertAlmostEqual(first["weight_N"], first["grains"] * mass * 9.81, delta=1e-6 * first["weight_N"])
        cached = pathlib.Path(first["cache_file"])
        self.assertTrue(cached.is_file() and cached.is_relative_to(self.folder / "cache"))
        again, _ = self.run_json("bed", path)
        self.assertTrue(again["from_cache"])
        for key in first:
            if key not in ("from_cache", "wall_s"):
                self.assertEqual(first[key], again[key], key)
        self.assertEqual([p.name for p in self.work.iterdir()], ["small.json"])
        # The cached file can be named as a bed of its own, and a run takes it.
        named, _ = self.run_json("bed", path, "--set", f"terrain.bed={cached}")
        self.assertEqual(named["depth_m"], first["depth_m"])
        self.assertIsNone(named["cache_file"])

    @unittest.skipUnless(HAS_OTHER_MATHEMATICS, "needs a processor with FMA")
    def test_a_bed_of_other_mathematics_is_another(self):
        path = write_scenario(self.work)
        first, _ = self.run_json("bed", path)
        self.env.update(OTHER_MATHEMATICS)
        other, _ = self.run_json("bed", path)
        self.assertFalse(other["from_cache"])
        self.assertNotEqual(other["cache_file"], first["cache_file"])

    def test_positions_of_the_users_own(self):
        rows = ["x_m,y_m,z_m"] + [f"{0.05 + 0.065 * i},{-0.15 + 0.065 * j},{0.04 + 0.062 * k}"
                                  for i in range(20) for j in range(5) for k in range(2)]
        (self.work / "mine.csv").write_text("\n".join(rows))
        path = write_scenario(self.work, changed(terrain={"bed": "mine.csv"}))
        bed, _ = self.run_json("bed", path)
        self.assertEqual(bed["grains"], 200)
        self.assertEqual(bed["bed"], str(self.work / "mine.csv"))
        self.assertIsNone(bed["bed_generator"])
        self.assertIsNone(bed["terrain"]["settling_friction"])
        self.assertEqual(bed["terrain"]["precision"], "mixed")
        self.assertIsNotNone(bed["cache_file"])
        self.assertTrue(self.run_json("bed", path)[0]["from_cache"])

    def test_generator_and_compaction(self):
        path = write_scenario(self.work)
        plain, _ = self.run_json("bed", path)
        lattice, _ = self.run_json("bed", path, "--set", "terrain.bed_generator=lattice")
        pressed, _ = self.run_json("bed", path, "--set", "terrain.compaction_pressure=100e3")
        self.assertNotEqual(lattice["grains"], plain["grains"])
        self.assertEqual(pressed["grains"], plain["grains"])
        self.assertLess(pressed["depth_m"], plain["depth_m"])
        self.assertGreater(pressed["solid_fraction"], plain["solid_fraction"])
        self.assertEqual(len({b["cache_file"] for b in (plain, lattice, pressed)}), 3)


class Soil(WithCache):
    def test_all_tests_quickly(self):
        path = write_scenario(self.work)
        begin = time.monotonic()
        soil, told = self.run_json("soil", path, "--quick", "--speed", "0.3", "--out", "out")
        self.assertLess(time.monotonic() - begin, 60.0)
        self.assertEqual(soil, read_json(self.work / "out" / "soil.json"))
        names = {".furrow-run", "soil.json", "scenario.json", "plate.csv", "shear.csv", "cone.csv", "cones.csv",
                 "repose.csv"}
        if "no plots" not in told:
            names |= {"plate.png", "shear.png", "cone.png", "repose.png", "report.html"}
        self.assertEqual({p.name for p in (self.work / "out").iterdir()}, names)
        self.assertEqual(soil["format_version"], 1)
        self.assertTrue(soil["quick"])
        for key in ("k_c", "k_phi", "n", "cohesion_Pa", "friction_angle_deg",
                    "janosi_K_m", "cone_index_Pa", "repose_angle_deg"):
            self.assertTrue(math.isfinite(soil[key]), key)
            self.assertIsNone(soil["standard_error"][key], key)  # small boxes have a bias that no scatter shows
            self.assertIsNone(soil["interval_95"][key], key)
            self.assertIn("not to be quoted", soil["no_interval_because"][key])
        self.assertIn("not to be quoted", soil["not_to_be_quoted"])
        self.assertIn("not to be quoted", told)
        self.assertNotIn("±", told)
        self.assertTrue(0 < soil["friction_angle_deg"] < 60, soil)
        self.assertGreater(soil["janosi_K_m"], 0)
        self.assertEqual([soil["terrain"][key] for key in ("bekker_k_c", "bekker_k_phi", "bekker_n", "janosi_k")],
                         [soil[key] for key in ("k_c", "k_phi", "n", "janosi_K_m")])
        write_json(self.work / "mine.json", {"format_version": 1, "terrain": soil["terrain"]})
        empirical = write_scenario(self.work, changed(terrain=None)
                                   | {"terrain": {"engine": "scm", "material": "mine.json"}}, "scm.json")
        self.furrow("validate", empirical, cwd=self.work)
        for test in ("plate", "shear", "cone"):
            self.assertEqual(soil[test]["speed_m_s"], 0.3)
            self.assertGreater(soil[test]["box"]["grains"], 50)
        self.assertLess(soil["shear"]["floor_force_error"], 0.05)
        # Cones of three sizes, between the same depths.
        cones = soil["cone"]["cones"]
        self.assertEqual(len(cones), 3)
        self.assertEqual(cones[0]["index_Pa"], soil["cone_index_Pa"])
        for key, band in soil["cone"]["band"].items():
            self.assertEqual(band, [min(c[key] for c in cones), max(c[key] for c in cones)])
        for plate in soil["plate"]["plates"]:
            self.assertEqual(plate["shape"], "strip")
            test = plate["tests"][0]
            self.assertAlmostEqual(test["displaced_m3"], test["heaved_m3"] + test["compacted_m3"]
                                   + test["volume_residual_m3"])
        for name, header in (("plate", "seed,width_m,sinkage_m,pressure_Pa"), ("cone", "seed,depth_m,pressure_Pa"),
                             ("shear",
                              "seed,nominal_normal_stress_Pa,travel_m,shear_stress_Pa,normal_stress_Pa,rise_m"),
                             ("repose", "seed,cohesion_Pa,x_m,height_before_m,height_after_m")):
            lines = (self.work / "out" / f"{name}.csv").read_text().splitlines()
            self.assertEqual(lines[0], header)
            self.assertTrue(all(math.isfinite(float(value)) for line in lines[1:] for value in line.split(",")), name)

    def test_stresses_are_chosen_and_every_value_without_an_interval_says_why(self):
        path = write_scenario(self.work)
        soil, _ = self.run_json("soil", path, "--quick", "--only", "shear",
                                "--speed", "0.3", "--stress", "40e3", "--stress", "10e3", "--out", "out")
        tests = soil["shear"]["tests"]
        self.assertEqual(len(tests), 2)
        for test, stress in zip(tests, (10e3, 40e3)):
            self.assertAlmostEqual(test["normal_stress_Pa"], stress, delta=0.2 * stress)
            self.assertAlmostEqual(math.tan(math.radians(test["secant_friction_angle_deg"])),
                                   test["tau_max_Pa"] / test["normal_stress_Pa"])
        self.assertTrue(0 < soil["friction_angle_without_cohesion_deg"] < 80)
        box = soil["shear"]["box"]
        self.assertTrue(0.3 < box["solid_fraction"] < 0.7, box)
        self.assertAlmostEqual(box["bulk_density_kg_m3"], 2500 * box["solid_fraction"], places=6)
        self.assertEqual(soil["no_interval_because"]["k_c"], "not tested")
        refused = furrow("soil", path, "--stress", "1e3", cwd=self.work)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("--stress", refused.stderr)

    def test_discs_in_metres_on_beds_of_two_depths_whatever_the_step_of_the_scenario(self):
        path = write_scenario(self.work)
        self.furrow("validate", path, "--set", "run.step=1e-2", cwd=self.work, env=self.env, code=2)
        soil, told = self.run_json("soil", path, "--set", "run.step=1e-2", "--only", "plate", "--disc", "0.4",
                                   "--depth", "0.4", "--depth", "0.5", "--sinkage", "0.12", "--bed-width", "1.2",
                                   "--seeds", "1", "--speed", "0.5", "--out", "out")
        self.assertIn("disc 400 mm", told)
        beds, plates = soil["plate"]["beds"], soil["plate"]["plates"]
        self.assertEqual([plate["bed"] for plate in plates], [0, 1])
        for bed, depth in zip(beds, (0.4, 0.5)):
            self.assertAlmostEqual(bed["box"]["height_m"], depth, delta=0.1 * depth)
            self.assertIsNone(bed["k_c"])  # of one size
        self.assertTrue(all(plate["b_m"] == 0.2 and plate["k"] > 0 for plate in plates), plates)
        self.assertEqual((self.work / "out" / "plate.csv").read_text().splitlines()[0],
                         "seed,width_m,sinkage_m,pressure_Pa,diameter_m,bed_depth_m")
        refused = furrow("soil", path, "--disc", "0.4", "--sinkage", "0.01", cwd=self.work)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("--sinkage", refused.stderr)

    def test_the_own_bed_is_the_one_of_the_cache(self):
        path = write_scenario(self.work)
        deeper = ["--set", "terrain.layers=8"]
        bed, _ = self.run_json("bed", path, *deeper)
        soil, _ = self.run_json("soil", path, *deeper, "--own-bed", "--disc", "0.3", "--sinkage", "0.08", "--seeds",
                                "1", "--speed", "0.5", "--out", "out")
        box = soil["plate"]["box"]
        self.assertTrue(box["own_bed"])
        self.assertEqual([box["grains"], box["height_m"]], [bed["grains"], bed["depth_m"]])
        self.assertNotIn("shear", soil)

    def test_soil_files_with_grains_of_several_sizes_fit_the_small_boxes(self):
        path = write_scenario(self.work)
        for test in ("shear", "repose"):
            soil, _ = self.run_json("soil", path, "--quick", "--speed", "0.3", "--only", test, "--out", test,
                                    "--set", "terrain.material=loose_sand.json", "--set", "terrain.size_spread=0.5")
            self.assertIsNotNone(soil["friction_angle_deg" if test == "shear" else "repose_angle_deg"])

    def test_one_test_alone_twice_the_same(self):
        path = write_scenario(self.work)
        flags = ["--quick", "--speed", "0.3", "--only", "shear"]
        one, _ = self.run_json("soil", path, *flags, "--threads", "1")
        two, _ = self.run_json("soil", path, *flags, "--threads", "2")
        self.assertEqual(one["cohesion_Pa"], two["cohesion_Pa"])
        self.assertEqual(one["shear"], two["shear"])
        self.assertIsNone(one["k_phi"])
        self.assertNotIn("plate", one)
        self.assertEqual(sorted(p.name for p in (self.work / "results").iterdir()),
                         ["small-soil-001", "small-soil-002"])
        self.assertEqual(sorted(p.name for p in (self.work / "results" / "small-soil-001").glob("*.csv")),
                         ["shear.csv"])

    def test_what_was_measured_is_printed_where_the_disk_is_full(self):
        disk = self.small_disk(self.work / "disk", "16k")
        done = self.furrow("soil", write_scenario(self.work), "--quick", "--only", "repose", "--out", "disk/out",
                           cwd=self.work, env=self.env, code=5,
                           matches=r"furrow: error: disk/out/.*: cannot .*: No space left on device")
        self.assertIn("repose", json.loads(done.stdout))
        self.assertEqual(list(disk.iterdir()), [])

    def test_signal_stops_it_and_leaves_nothing(self):
        path = write_scenario(self.work)
        process = start("soil", path, "--out", "out", cwd=self.work, env=self.env)
        wait_for(lambda: (self.work / "out").exists(), 20, "the folder")
        time.sleep(1.0)
        process.send_signal(signal.SIGTERM)
        out, err = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 75, err)
        self.assertIn("stopped by a signal", err)
        self.assertEqual(out, "")
        self.assertEqual([p.name for p in self.work.iterdir()], ["small.json"])

    def test_theory_beside_a_run(self):
        run = self.work / "run"
        run.mkdir()
        (run / "scenario.json").write_text("{}")
        write_json(run / "summary.json", {"format_version": 1, "tire_radius_m": 0.4673,
                                                      "tread_width_m": 0.25, "vertical_load_N": 4609, "slip": 0.3})
        write_json(self.work / "soil.json", {"format_version": 1, "k_c": 15.6e3, "k_phi": 245e3, "n": 0.395,
                                             "cohesion_Pa": 6.9e3, "friction_angle_deg": 26.8, "janosi_K_m": 0.0209,
                                             "standard_error": {"cohesion_Pa": 1.4e3}})
        done = furrow("report", "run", "--soil", "soil.json", cwd=self.work)
        self.assertRegex(done.stderr,
                         r"furrow: soil theory \(rigid wheel\): drawbar pull 9\d\d ± \d+ N, sinkage \d+.\d mm")
        (run / "scenario.json").write_text('{"terrain": {"engine": "rigid"}}')
        refused = furrow("report", "run", "--soil", "soil.json", cwd=self.work)
        self.assertEqual(refused.returncode, 2, refused.stderr)
        self.assertIn("terrain.engine", refused.stderr)
        estimate = read_json(run / "soil_estimate.json")
        self.assertAlmostEqual(estimate["thrust_N"] - estimate["compaction_resistance_N"],
                               estimate["drawbar_pull_N"], places=6)
        pulls = [point["drawbar_pull_N"] for point in estimate["curve"]]
        self.assertEqual(pulls, sorted(pulls))


if __name__ == "__main__":
    main()
