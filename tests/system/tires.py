#!/usr/bin/python3
"""Tires at the edges of their range, as a user meets them: changing pressure, drops, heavy loads, the rim, steps too
large. Either a run ends well or one message says what happened, when and what to try; no number in the results is not
finite."""
import json
import math
import re
import subprocess

from program import ROOT, SystemTest, main, rows_of, write_json

HARD = {
    "format_version": 1,
    "rig": {"type": "drawbar", "slip": 0.0, "angular_speed": 0, "ramp": 0, "carrier_mass": 450},
    "tire": {"file": "hmmwv_layered.json", "elements_circumference": 30, "elements_width": 6},
    "terrain": {"engine": "rigid"},
    "run": {"step": 1e-4, "end": 0.2, "average_from": 0.1},
    "output": {"series_interval": 1e-3, "frame_interval": 0},
    "checkpoint": {"at_end": False},
}
ROLLING = {"rig.angular_speed": 8.56, "rig.slip": 0.05, "rig.ramp": 0.05, "rig.touchdown_time": 0.1,
           "terrain.ground_stiffness": 5e7, "terrain.ground_shear_stiffness": 2e7, "terrain.ground_damping": 1e4}
DROP = {"rig.drop_height": 0.3, "rig.touchdown_damping": 0, "terrain.ground_stiffness": 5e7,
        "terrain.ground_damping": 1e4}
GRAINS = {"terrain.engine": "dem", "terrain.radius": 0.03, "terrain.cohesion": 20e3, "terrain.layers": 4,
          "terrain.length": 1.2, "terrain.width": 0.5}


class TireTest(SystemTest):
    def begin(self, settings, *more, command="run", **expected):
        path = write_json(self.folder / "tire.json", HARD)
        flags = [flag for key, value in settings.items() for flag in ("--set", f"{key}={json.dumps(value)}")]
        return self.furrow(command, path, "--out", self.folder / "out", *flags, *more, timeout=400, **expected)

    def series(self, name="out"):
        """Columns of the series; every number in it is finite."""
        rows = rows_of(self.folder / name / "timeseries.csv")
        columns = {key: [float(row[key]) for row in rows] for key in rows[0]} if rows else {}
        for key, values in columns.items():
            self.assertTrue(all(map(math.isfinite, values)), key)
        return columns

    def ends_well(self, settings):
        self.begin(settings, "--no-plots")
        text = (self.folder / "out/summary.json").read_text()
        self.assertNotIn("NaN", text)
        return json.loads(text), self.series()

    def stops(self, settings, expected):
        """Exit code 3, one error that matches, no summary, no number that is not finite."""
        done = self.begin(settings, "--no-plots", code=3, errors=1, matches=f"error: .*{expected}")
        self.assertFalse((self.folder / "out/summary.json").exists())
        if (self.folder / "out/timeseries.csv").exists():
            self.series()
        return next(line for line in done.stderr.splitlines() if "error: " in line)


class Drop(TireTest):
    def test_from_0_3_m_onto_hard_ground(self):
        summary, series = self.ends_well({**DROP, "run.end": 0.5, "run.average_from": 0.4})
        touched = next(t for t, f in zip(series["time_s"], series["vertical_force_N"]) if f > 1.0)
        self.assertAlmostEqual(touched, math.sqrt(2 * 0.301 / 9.81), delta=2e-3)
        # v √(k m) with v² = 2 g h and a stiffness of 300 to 700 kN/m
        self.assertTrue(28e3 < max(series["vertical_force_N"]) < 55e3, max(series["vertical_force_N"]))
        self.assertLess(abs(summary["momentum_residual"]), 1e-12)

    def test_from_0_3_m_onto_grains(self):
        _, series = self.ends_well({**DROP, **GRAINS, "run.end": 0.4, "run.average_from": 0.3})
        self.assertGreater(max(series["vertical_force_N"]), 10e3)
        self.assertGreater(max(series["sinkage_m"]), 0.01)


class Load(TireTest):
    def test_five_times_the_rated_load(self):
        summary, _ = self.ends_well({**ROLLING, "rig.carrier_mass": 2310, "run.end": 0.8, "run.average_from": 0.5,
                                     "rig.touchdown_damping": 60e3, "rig.touchdown_time": 0.8})
        self.assertAlmostEqual(summary["vertical_load_N"], 5 * 4562, delta=100)
        self.assertTrue(0.03 < summary["tire_deflection_m"] < 0.1, summary["tire_deflection_m"])
        self.assertLess(abs(summary["net_terrain_force_N"][2] / summary["vertical_load_N"] - 1), 0.05)

    def test_the_rim_stops_the_run(self):
        error = self.stops({"tire.pressure": 15e3, "rig.carrier_mass": 3000, "rig.drop_height": 0.1,
                            "rig.touchdown_damping": 0, "terrain.ground_stiffness": 2e7, "terrain.ground_damping": 5e3,
                            "run.step": 2e-4, "run.end": 1.0}, r"tire 0 reached its rim at t = [\d.]+ s, step \d+: "
                           r"clearance -[\d.e-]+ m at the node of column \d+, row \d+ .*try a higher pressure")
        time = float(re.search(r"t = ([\d.]+)", error)[1])
        self.assertGreater(time, math.sqrt(2 * 0.1 / 9.81))

    def test_a_step_too_large_is_told(self):
        self.stops({**ROLLING, "run.step": 4e-3, "run.end": 1.0, "terrain.ground_stiffness": 4e8,
                    "output.series_interval": 4e-3},
                   r"tire 0 (did not converge|lost its shape) at t = [\d.]+ s, step \d+: .*; try a smaller run.step")


class Pressure(TireTest):
    TABLE = [[0.0, 2e5], [0.04, 2e5], [0.1, 8e4]]

    def test_ten_times_the_pressure(self):
        summary, _ = self.ends_well({**ROLLING, "tire.pressure": 2e6})
        self.assertLess(summary["tire_deflection_m"], 0.01)

    def test_beyond_what_the_layers_bear_it_is_told(self):
        self.stops({"tire.pressure": 1e8}, r"tire inflation to 1e\+?08 Pa did not converge.*try")

    def test_a_schedule_lets_the_tire_down_and_it_deflects_more(self):
        settings = {**ROLLING, "run.end": 0.4, "run.average_from": 0.3, "rig.touchdown_damping": 20e3}
        full, _ = self.ends_well(settings)
        settings["tire.pressure"] = self.TABLE
        (self.folder / "out").rename(self.folder / "full")
        low, _ = self.ends_well(settings)
        self.assertGreater(low["tire_deflection_m"], 1.2 * full["tire_deflection_m"])
        (self.folder / "out").rename(self.folder / "table")
        settings["tire.pressure"] = 8e4
        constant, _ = self.ends_well(settings)
        self.assertAlmostEqual(low["tire_deflection_m"] / constant["tire_deflection_m"], 1, delta=0.1)
        self.assertLess(abs(low["accounts"]["energy"]["residual_share"]), 0.05)

    def test_a_run_with_a_schedule_goes_on_bit_for_bit(self):
        settings = {**ROLLING, "tire.pressure": [[0.0, 2e5], [0.01, 2e5], [0.05, 8e4]], "run.end": 0.06,
                    "run.average_from": 0.02, "checkpoint.at_end": True}
        whole, _ = self.ends_well(settings)
        (self.folder / "out").rename(self.folder / "whole")
        self.ends_well({**settings, "run.end": 0.03})
        self.furrow("resume", self.folder / "out", "--until", "0.06", "--no-plots", timeout=400)
        resumed = self.summary()
        self.assertEqual(resumed["state_hash"], whole["state_hash"])

    def test_a_rigid_tire_does_not_mind(self):
        settings = {**ROLLING, "tire.rigid": True, "run.end": 0.05, "run.average_from": 0.02}
        constant, _ = self.ends_well(settings)
        (self.folder / "out").rename(self.folder / "constant")
        table, _ = self.ends_well({**settings, "tire.pressure": self.TABLE})
        self.assertEqual(table["drawbar_pull_N"], constant["drawbar_pull_N"])

    def test_bad_tables_are_named(self):
        for table, key, words in (([[0, 1e5], [0, 2e5]], "tire.pressure.1.0", "a time after that of the entry before"),
                                  ([[0, -1]], "tire.pressure.0.1", "expected 0 or more"),
                                  ([[0]], "tire.pressure.0", "a list of 2 entries"),
                                  ([[0, "a"]], "tire.pressure.0.1", "expected a number"),
                                  ([], "tire.pressure", r"a list of 1 to 10000 \[t, p\] in s and Pa"),
                                  ("soft", "tire.pressure", "expected a number")):
            with self.subTest(table):
                self.begin({"tire.pressure": table}, code=2,
                           matches=rf"furrow: error: .*tire.json: key '{key}': .*{words}")


class OtherTires(TireTest):
    """The toroidal tire and the one of tire/HOWTO.md, pressed and rolled."""

    def check(self, file, mass, stiffness):
        coarse = {"tire.file": file, "tire.elements_circumference": 40,
                  "tire.elements_width": 12, "rig.carrier_mass": mass}
        self.begin(coarse, "--deflection", "0.035", "--points", "4", "--load", 9.81 * mass, command="press")
        press = self.summary()
        self.assertLess(press["loading_unloading_difference"], 1e-3)
        self.assertTrue(stiffness[0] < press["secant_stiffness_N_per_m"] < stiffness[1], press)
        (self.folder / "out").rename(self.folder / "press")
        rolled, _ = self.ends_well({**ROLLING, **coarse, "rig.slip": 0.01, "run.end": 0.6, "run.average_from": 0.3,
                                    "rig.touchdown_time": 0.25})
        self.assertLess(abs(rolled["net_terrain_force_N"][2] / rolled["vertical_load_N"] - 1), 0.03)
        # a run counts deflection from the undeformed radius, a press from the inflated one
        deflection = rolled["tire_deflection_m"] + press["inflation_growth_m"]
        self.assertAlmostEqual(deflection / press["deflection_m"], 1, delta=0.35)
        self.assertLess(rolled["momentum_residual"], 1e-12)
        self.assertLess(abs(rolled["accounts"]["energy"]["residual_share"]), 0.05)

    def test_toroidal(self):
        self.check("toroidal.json", 450, (200e3, 2000e3))

    def test_passenger_205_55r16(self):
        self.check("passenger_205_55r16.json", 400, (120e3, 300e3))


class Profile(SystemTest):
    """scripts/tire_profile.py: a meridian from a drawing."""

    def rows(self, text, **expected):
        done = subprocess.run([ROOT / "scripts" / "tire_profile.py", "-"], input=text, text=True, capture_output=True)
        return self.expect(done, **expected)

    def test_mirrors_the_points_and_measures_along_them(self):
        done = self.rows("height_m, axial_m\n0,0.03\n0.04,0.03\n0.04,0\n")
        rows = json.loads("{" + done.stdout + "}")["profile"]
        self.assertEqual(rows, [[0.0, 0.0, -0.03], [round(2 / 7, 9), 0.04, -0.03],
                                [0.5, 0.04, 0.0], [round(5 / 7, 9), 0.04, 0.03], [1.0, 0.0, 0.03]])

    def test_what_is_no_meridian_is_refused_in_one_line(self):
        for text, word in (("height_m;axial_m\n0;1\n", "expected height_m,axial_m"),
                           ("height_m,axial_m\n0,76\n", "line 2"),
                           ("height_m,axial_m\n0,0.1\n0,0.1\n", "line 3"),
                           ("height_m,axial_m\n0,nan\n", "line 2"), ("", "first line"),
                           ("height_m,axial_m\n0,0.1\n0.1,0.1\n0.1,0.05\n", "crown")):
            done = self.rows(text, code=1, says=word)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)


if __name__ == "__main__":
    main()
