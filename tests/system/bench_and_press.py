#!/usr/bin/python3
"""`furrow bench` and `furrow press` on coarse tires: what they print, leave behind, and refuse."""
import json

from program import SystemTest, furrow, main, read_json, write_json, write_scenario

SCENARIO = {
    "format_version": 1,
    "rig": {"type": "drawbar", "slip": 0.1},
    "tire": {"file": "hmmwv_lumped.json", "elements_circumference": 30, "elements_width": 6},
    "terrain": {"engine": "rigid"},
    "run": {"step": 1e-4, "end": 1.0},
}
COARSE = ("--elements-circumference", "24", "--elements-width", "6", "--warm",
          "0.02", "--steps", "60", "--step", "1e-4")


class Bench(SystemTest):
    def bench(self, *more):
        return json.loads(self.furrow("bench", "tire", *COARSE, *more).stdout)

    def test_keys_and_same_state_for_any_threads(self):
        one, two = self.bench(), self.bench("--threads", "2")
        for key in ("ms_per_step", "median_ms", "p99_ms", "factorizations", "newton_iterations_mean", "max_residual",
                    "residual_tolerance", "deflection_m", "spindle_load_N", "layers", "revolutions", "coordinates",
                    "threads", "state_hash"):
            self.assertIn(key, one)
        self.assertEqual(sorted(one["parts_ms"]), ["factorize", "force", "jacobian", "other", "solve"])
        self.assertLessEqual(one["max_residual"], one["residual_tolerance"])
        self.assertEqual(one["layers"], 4)
        self.assertEqual(one["steps"], 60)
        self.assertEqual(one["state_hash"], two["state_hash"])
        self.assertEqual(two["threads"], 2)

    def test_a_shipped_tire_by_its_name(self):
        self.assertEqual(self.bench("--tire", "hmmwv_lumped.json")["layers"], 1)

    def test_bad_input(self):
        self.furrow("bench", "tire", "--threads", "0", code=2, says="--threads")
        self.furrow("bench", "tire", "--tire", "none.json", code=2, says="none.json")


    def test_bad_beds(self):
        bed = self.folder / "bed.csv"
        bed.write_text("x_m,y_m,z_m\n0.1,0.1,0.006\n0.1,0.101,0.006\n")
        for more, word in ((("--bed", "none.csv"), "none.csv"), (("--bed", bed), "line 3"),
                           (("--law", "glue"), "--law"),
                           (("--bed", bed, "--step", "1e-3"), "stable step")):
            self.furrow("bench", "grains", *more, code=2, says=word)
        bed.write_text("x_m,y_m,z_m\n0.1,-0.1,0.006\n")
        self.assertIn("line 2", furrow("bench", "grains", "--bed", bed, cwd=self.folder).stderr)

    def test_a_signal_stops_it(self):
        bench = self.start("bench", "tire", *COARSE[:4], "--warm", "1000")
        self.assertIn("touching down", bench.stderr.readline())
        bench.terminate()
        self.ended(bench, 75, says="signal")


class BenchRig(SystemTest):
    def setUp(self):
        super().setUp()
        self.temporary = self.folder / "temporary"
        self.temporary.mkdir()
        self.env = {"XDG_CACHE_HOME": str(self.folder / "cache"), "TMPDIR": str(self.temporary)}
        self.words = ("bench", "rig", "--scenario", write_scenario(self.folder))

    def bench(self, *more, warm="0.02"):
        done = self.furrow(*self.words, "--warm", warm, "--steps", "200", *more, env=self.env)
        self.assertEqual(list(self.temporary.iterdir()), [])
        self.assertEqual(sorted(file.name for file in self.folder.iterdir()), ["cache", "small.json", "temporary"])
        return json.loads(done.stdout)

    def test_times_agree_with_each_other(self):
        found = self.bench()
        self.assertAlmostEqual(found["s_per_simulated_s"], 1e-3 * found["ms_per_step"] / found["step_s"], places=9)
        self.assertTrue(0 < found["median_ms"] <= found["p99_ms"], found)
        both = found["tire_ms"], found["terrain_ms"]
        self.assertTrue(max(both) - 1e-9 <= found["slower_of_both_ms"] <= sum(both), found)
        self.assertLess(found["slower_of_both_ms"], found["ms_per_step"])
        self.assertEqual(list(found["waiting_share"]), ["rig", "terrain", "tire 0"])
        for share in (*found["waiting_share"].values(), found["awake_share"]):
            self.assertTrue(0 < share <= 1, found)
        self.assertEqual((found["steps"], found["steps_recorded"], found["tires"], found["refined_share"]),
                         (200, 200, 1, 0))
        bed = json.loads(self.furrow("bed", "small.json", env=self.env).stdout)
        self.assertEqual(found["grains"], bed["grains"])

    def test_the_state_is_that_of_a_run_for_any_threads(self):
        one, two = self.bench("--threads", "1"), self.bench("--threads", "2")
        self.assertEqual((one["threads"], two["threads"]), (1, 2))
        self.assertEqual(one["state_hash"], two["state_hash"])
        self.furrow("run", "small.json", "--set", "run.end=0.04", "--out", "out", "--no-plots", env=self.env)
        self.assertEqual(self.summary()["state_hash"], one["state_hash"])

    def test_a_long_run_before_is_thinned(self):
        self.assertEqual(self.bench("--set", "rig.angular_speed=0.5", warm="0.5")["steps_recorded"], 100)

    def test_bad_input(self):
        for more, word in ((("--steps", "0"), "key '--steps'"), (("--warm", "-1"), "key '--warm'"),
                           (("--steps", "30", "--warm", "0.5"), "key '--steps': is 30, expected 40 or more"),
                           (("--set", "rig.slip=7"), "rig.slip"), (("--set", "run.end"), "--set")):
            self.furrow(*self.words, *more, code=2, says=word)
        self.furrow("bench", "rig", "--scenario", "none.json", code=2, says="none.json")

    def test_a_signal_stops_it_and_leaves_nothing(self):
        bench = self.start(*self.words, "--steps", "1000000", "--set", "rig.angular_speed=0", env=self.env)
        self.assertTrue(any(" of 100" in line for line in bench.stderr))
        bench.terminate()
        self.ended(bench, 75, says="signal")
        self.assertEqual(list(self.temporary.iterdir()), [])


class Press(SystemTest):
    def press(self, *more, deflection="0.012", points="4", **expected):
        path = write_json(self.folder / "pressed.json", SCENARIO)
        return self.furrow("press", path, "--out", self.folder / "out", "--deflection", deflection, "--points", points,
                           "--overwrite", *more, **expected)

    def test_plate(self):
        # Two rows of nodes or more touch: one alone has no length.
        done = self.press("--load", "2000", "--set", "tire.elements_circumference=60",
                          matches=r"a load of 2000 N deflects the tire by [\d.]+ mm: secant stiffness \d+ kN/m, "
                          r"footprint \d[\d.]* mm long, [\d.]+ mm wide")
        out = self.folder / "out"
        self.assertEqual(done.stdout.strip(), str(out))
        summary = read_json(out / "summary.json")
        self.assertLess(summary["loading_unloading_difference"], 1e-5)
        self.assertLessEqual(summary["max_residual"], 1e-6)
        self.assertTrue(summary["statically_stable"] and summary["stable_while_pressed"])
        self.assertLess(max(summary["runout_m"], summary["director_runout_rad"]), 1e-6)
        self.assertNotIn("equilibri", done.stderr)
        patch = summary["footprint"]
        self.assertAlmostEqual(patch["force_N"], 2000, delta=2)
        self.assertAlmostEqual(patch["mean_pressure_Pa"] * patch["area_m2"], 2000, delta=20)
        sticking = summary["sticking_stiffness"]
        self.assertGreater(sticking["vertical_N_per_m"], summary["tangent_stiffness_N_per_m"] * 0.9)
        self.assertTrue(0 < sticking["lateral_N_per_m"] < sticking["longitudinal_N_per_m"], sticking)
        self.assertGreater(sticking["torsional_Nm_per_rad"], 0)
        self.assertTrue(0.005 < patch["length_m"] < 0.3 and 0.02 < patch["width_m"] < 0.3, patch)  # coarse facets
        lines = (out / "press.csv").read_text().splitlines()
        self.assertTrue(lines[0].startswith("deflection_m,force_N"))
        self.assertEqual(len(lines), 1 + 5 + 4)
        forces = [float(line.split(",")[1]) for line in lines[1:6]]
        self.assertEqual(forces, sorted(forces))

    def test_without_a_load_it_is_pressed_by_what_its_wheel_carries(self):
        self.press("--set", "rig.carrier_mass=null", "--set", "rig.load=1500",
                   "--set", "tire.elements_circumference=60")
        self.assertAlmostEqual(self.summary()["load_N"], 1500, delta=1e-6)

    def test_what_wrinkles_and_what_buckles_on_the_way_is_named(self):
        self.press("--set", "tire.file=hmmwv_layered.json", "--set", "tire.elements_circumference=60",
                   "--set", "tire.elements_width=12", says="furrow: warning: this tire wrinkles under its pressure")
        self.furrow("press", self.folder / "pressed.json", "--out", self.folder / "out", "--overwrite", "--deflection",
                    "0.02", "--points", "5", "--load", "1000", "--set", "tire.pressure=70000",
                    "--set", "tire.elements_circumference=60", "--set", "tire.elements_width=12",
                    matches=r"furrow: warning: this tire buckles while it is pressed, first on the way to 0\.\d+ m")
        summary = self.summary()
        self.assertEqual((summary["statically_stable"], summary["stable_while_pressed"]), (True, False))
        self.assertLess(summary["director_runout_rad"], 1e-6)

    def test_a_cleat_that_the_tire_does_not_touch_is_told(self):
        self.press("--on", "cleat", "--cleat-height", "0.1", "--cleat-position", "0.4",
                   says=("warning: within a deflection of 0.012 m the tire touches nothing", "(--cleat-position)"))

    def test_cleat_is_softer_than_a_plate(self):
        self.press("--on", "cleat", "--cleat-width", "0.004", "--load", "1e5")
        cleat = self.summary()
        self.assertIsNone(cleat["deflection_m"])  # the load is not reached
        self.assertLess(cleat["loading_unloading_difference"], 1e-4)
        self.press("--load", "1e5")
        plate = self.summary()
        self.assertLess(cleat["footprint"]["force_N"], plate["footprint"]["force_N"])

    def test_a_scenario_says_how_its_tire_is_pressed_and_options_override_it(self):
        coarse = ("--set", "tire.elements_circumference=48", "--set", "tire.elements_width=8", "--points", "2",
                  "--deflection", "0.012", "--load", "2000")
        deflections = []
        for more in ((), ("--cleat-width", "0.1"), ("--set", "press.cleat_width=0.1")):
            self.furrow("press", "cleat_press.json", "--out", self.folder / "out", "--overwrite", *coarse, *more)
            summary = self.summary()
            self.assertEqual((summary["obstacle"], summary["cleat_width_m"], summary["cleat_height_m"]),
                             ("cleat", 0.1 if more else 0.051, 0.1))
            deflections.append(summary["deflection_m"])
        self.assertGreater(deflections[0], deflections[1])
        self.assertEqual(deflections[1], deflections[2])
        for setting, said in (("press.on=road", "key 'press.on': is 'road', expected 'plate' or 'cleat'"),
                              ("press.on=profile", "key 'press.on'"), ("press.points=0", "key 'press.points': is 0"),
                              ("press.deflection=0.3", "key 'press.deflection': is 0.3 m"),
                              ("press.width=1", "key 'press.width'"),
                              ("press.cleat_width=[0.1]", "key 'press.cleat_width'")):
            self.furrow("press", "cleat_press.json", "--out", self.folder / "other", "--set", setting, code=2,
                        says="cleat_press.json: " + said)
        done = furrow("press", "cleat_press.json", "--out", self.folder / "other", "--set", "tire.file=hmmwv_ring.json",
                      "--set", "press.deflection=0.19", cwd=self.folder)
        self.assertIn("cleat_press.json: key 'press.deflection': is 0.19 m, expected at most 0.11", done.stderr)
        self.assertFalse((self.folder / "other").exists())

    def test_flexible_ring(self):
        path = write_json(self.folder / "ring.json", {**SCENARIO, "tire": {"file": "hmmwv_ring.json"}})
        deflections, keys = {}, []
        profile = self.folder / "bar.csv"
        profile.write_text("x_m,z_m\n-0.0255,0\n0.0255,0\n")
        for name, more in (("plate", ()), ("cleat", ("--on", "cleat", "--cleat-width", "0.051")),
                           ("profile", ("--on", "profile", "--profile", profile))):
            self.furrow("press", path, "--out", self.folder / "out", "--overwrite", "--deflection", "0.03",
                        "--points", "6", "--load", "8000", *more)
            summary = self.summary()
            self.assertEqual(summary["obstacle"], name)
            self.assertLess(summary["max_residual"], 1e-6)
            self.assertLess(summary["loading_unloading_difference"], 1e-6)
            self.assertAlmostEqual(summary["footprint"]["force_N"], 8000, delta=8)
            self.assertAlmostEqual(summary["footprint"]["width_m"], 0.24)
            keys.append(sorted(summary) + sorted(summary["sticking_stiffness"]) + sorted(summary["footprint"]))
            self.assertGreater(summary["sticking_stiffness"]["vertical_N_per_m"],
                               0.9 * summary["tangent_stiffness_N_per_m"])
            self.assertGreater(summary["sticking_stiffness"]["longitudinal_N_per_m"], 0)
            self.assertIsNone(summary["sticking_stiffness"]["lateral_N_per_m"])
            self.assertAlmostEqual(summary["rim_force_N"][2], 8000, delta=8)
            deflections[name] = summary["deflection_m"]
        self.furrow("press", path, "--set", "tire.file=hmmwv_lumped.json", "--set", "tire.elements_circumference=30",
                    "--set", "tire.elements_width=6", "--deflection", "0.005", "--points", "1", "--load", "100",
                    "--out", self.folder / "shell")
        summary = self.summary("shell")
        self.assertEqual(keys[0], sorted(summary) + sorted(summary["sticking_stiffness"])
                         + sorted(summary["footprint"]))
        self.assertIsNone(summary["stiffness_missing_because"])
        # The patch on a plate is far longer than the bar; up to 3 kN it is not, and the bar is as good as a plate.
        self.assertLess(1.1 * deflections["plate"], deflections["cleat"])
        self.assertAlmostEqual(deflections["profile"], deflections["cleat"], places=9)
        self.assertTrue((self.folder / "out/load_deflection.png").exists(), list((self.folder / "out").iterdir()))

    def test_planar_tire(self):
        path = write_json(self.folder / "planar.json", {**SCENARIO,
                                    "tire": {"file": "aligator_planar.json", "elements_circumference": 48}})
        profile = self.folder / "plate.csv"
        profile.write_text("x_m,z_m\n-1,0\n1,0\n")
        deflections = {}
        for name, more in (("plate", ()), ("cleat", ("--on", "cleat", "--cleat-width", "0.05")),
                           ("profile", ("--on", "profile", "--profile", profile))):
            self.furrow("press", path, "--out", self.folder / "out", "--overwrite", "--deflection", "0.08",
                        "--points", "4", "--load", "15000", *more)
            summary = self.summary()
            self.assertEqual(summary["obstacle"], name)
            self.assertIsNone(summary["pressure_Pa"])
            sticking = summary["sticking_stiffness"]
            self.assertTrue(sticking["longitudinal_N_per_m"] > 0 and sticking["vertical_N_per_m"] > 0, sticking)
            self.assertEqual((sticking["lateral_N_per_m"], sticking["torsional_Nm_per_rad"]), (None, None))
            self.assertIn("rigid sideways", summary["stiffness_missing_because"])
            self.assertLess(summary["max_residual"], 1e-6)
            self.assertLess(summary["loading_unloading_difference"], 1e-5)
            self.assertAlmostEqual(summary["footprint"]["force_N"], 15000, delta=15)
            deflections[name] = summary["deflection_m"]
        self.assertLess(1.2 * deflections["plate"], deflections["cleat"])
        self.assertAlmostEqual(deflections["profile"], deflections["plate"], places=9)
        self.assertTrue((self.folder / "out/load_deflection.png").exists(), list((self.folder / "out").iterdir()))
        self.furrow("press", path, "--out", self.folder / "other", "--deflection", "0.19", code=2,
                    says="key '--deflection': is 0.19 m, expected at most 0.1608 m")
        self.furrow("press", path, "--out", self.folder / "other", "--camber", "0.05", code=2,
                    says="key '--camber': is 0.05 rad, expected 0: a planar tire is alike across its width")
        self.assertFalse((self.folder / "other").exists())

    def test_camber_tilts_the_plate(self):
        force, moment = {}, {}
        for angle in ("0.08", "-0.08", "0"):
            self.press("--camber", angle, "--load", "1500")
            summary = self.summary()
            self.assertEqual(summary["camber_rad"], float(angle))
            force[angle], moment[angle] = summary["deflection_m"], summary["rim_moment_Nm"][0]
            self.assertAlmostEqual(summary["rim_force_N"][2], 1500, delta=1.5)
            self.assertAlmostEqual(summary["rim_force_N"][1], 0, delta=1e-6)
        self.assertAlmostEqual(force["0.08"], force["-0.08"], places=8)
        self.assertNotAlmostEqual(force["0.08"], force["0"], places=4)
        self.assertAlmostEqual(moment["0.08"], -moment["-0.08"], places=2)
        self.assertLess(moment["0.08"], -1)  # leaning to the right it stands on its right shoulder
        self.press("--set", "press.camber=0.08", "--load", "1500")
        self.assertAlmostEqual(self.summary()["deflection_m"], force["0.08"], places=12)
        self.press("--set", "press.camber=0.02", "--set", "tire.file=hmmwv_ring.json", code=2,
                   says="pressed.json: key 'press.camber': is 0.02 rad, expected 0: a flexible ring is alike across "
                   "its width")

    def test_a_curve_that_ends_early_is_written(self):
        self.press("--load", "5000", deflection="0.2", points="8", code=3,
                   matches=r"furrow: error: the curve ends early: .*; up to 0\.\d+ m it was found")
        summary = self.summary()
        self.assertIn("up to", summary["ended_because"])
        lines = (self.folder / "out/press.csv").read_text().splitlines()
        self.assertTrue(2 < len(lines) < 1 + 9, lines)
        self.assertGreater(summary["footprint"]["force_N"], 0)

    def test_a_pressure_that_changes_is_said_to_count_as_it_begins(self):
        self.press("--set", "tire.pressure=[[0, 200000], [1, 100000]]", "--load", "1500",
                   says="tire.pressure changes in time: the tire is pressed at that of t = 0, 200000 Pa")
        self.assertEqual(self.summary()["pressure_Pa"], 200000)

    def test_bad_input(self):
        for more, word in ((("--on", "sand"), "--on"), (("--deflection", "-1"), "--deflection"),
                           (("--load", "inf"), "--load"),
                           (("--set", "tire.rigid=true"), "tire.rigid"),
                           (("--on", "profile"), "--profile"), (("--profile", "road.csv"), "--profile"),
                           (("--on", "profile", "--profile", "road.csv"), "road.csv"),
                           (("--on", "cleat", "--cleat-position", "2"), "--cleat-position"),
                           (("--cleat-height", "0.05"), "--cleat-height"), (("--cleat-width", "0.05"), "--cleat-width"),
                           (("--on", "profile", "--profile", "road.csv", "--cleat-position", "0"), "--cleat-position"),
                           (("--camber", "0.8"), "--camber"), (("--camber", "nan"), "--camber"),
                           (("--set", "press.camber=1"), "press.camber")):
            self.press(*more, code=2, says=word)
            self.assertFalse((self.folder / "out").exists())


if __name__ == "__main__":
    main()
