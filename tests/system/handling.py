#!/usr/bin/python3
"""A tire property file as a tire on hard ground: what a user gets of it in the rig, under a vehicle, pressed, and
refused."""
import csv
import re
import sys

import numpy as np

from program import ROOT, SystemTest, main, rows_of, write_json

sys.path.insert(0, str(ROOT / "tests/tire/handling"))
import evaluate_tir  # noqa: E402  the other evaluator

TIR = ROOT / "tire/data/hmmwv_handling.tir"
SHELL_RADIUS = 0.4673  # m, of hmmwv_lumped.json
STEADY = {
    "format_version": 1,
    "rig": {"type": "drawbar", "mode": "fixed_speed", "speed": 4.0, "ramp": 0.05, "carrier_mass": 450, "rim_mass": 15,
            "rim_spin_inertia": 0.7, "rim_diametral_inertia": 0.4, "touchdown_damping": 12e3, "touchdown_time": 0.5},
    "tire": {"file": "hmmwv_handling.tir"},
    "terrain": {"engine": "rigid"},
    "run": {"step": 4e-4, "end": 2.0, "average_from": 1.5},
    "output": {"series_interval": 2e-3, "frame_interval": 0},
}


class Handling(SystemTest):
    def run_of(self, name, *flags, scenario=STEADY):
        return super().run_of(name, scenario, *flags)[0]

    def expected(self, summary):
        """Of the other evaluator, at the slips of the run."""
        tire = evaluate_tir.Tire(evaluate_tir.read(TIR))
        axes = summary["iso_w"]
        load = axes["force_N"][2]
        nominal = tire.FNOMIN / tire.VERTICAL_STIFFNESS
        depth = load / tire.VERTICAL_STIFFNESS / nominal
        rolling = tire.UNLOADED_RADIUS - nominal * (tire.DREFF * np.arctan(tire.BREFF * depth) + tire.FREFF * depth)
        kappa = rolling / summary["effective_rolling_radius_m"] - 1.0
        kappa += (1.0 / np.cos(axes["slip_angle_rad"]) - 1.0) * (1.0 + kappa)  # the speed along the wheel is less
        state = [np.array([value]) for value in (load, kappa, axes["slip_angle_rad"], axes["camber_angle_rad"], 4.0)]
        return {key: float(value[0]) for key, value in evaluate_tir.evaluate(tire, *state).items()}

    def test_steady_rolling_gives_what_the_other_evaluator_says(self):
        for slip, toe, camber in ((0.02, 0.0, 0.0), (-0.03, 0.03, 0.0), (0.06, -0.05, 0.05)):
            with self.subTest(slip=slip, toe=toe, camber=camber):
                name = f"run{slip}"
                told = self.run_of(name, "--set", f"rig.slip={slip}", "--set",
                                   f"rig.toe_angle={toe}", "--set", f"rig.camber_angle={camber}")
                said, axes = self.expected(told), told["iso_w"]
                load = axes["force_N"][2]
                self.assertAlmostEqual(axes["force_N"][0], said["Fx_N"], delta=0.01 * load)
                self.assertAlmostEqual(axes["force_N"][1], said["Fy_N"], delta=0.01 * load)
                self.assertAlmostEqual(axes["moment_Nm"][0], said["Mx_Nm"], delta=0.01 * load * 0.47)
                self.assertAlmostEqual(axes["moment_Nm"][1], said["My_Nm"], delta=0.5)
                self.assertAlmostEqual(axes["moment_Nm"][2], said["Mz_Nm"], delta=0.003 * load * 0.47)
                self.accounts_close(told)
                self.assertEqual(told["warnings"] if "warnings" in told else [], [])

    def test_runs_give_the_table_that_it_was_fitted_to_within_its_residuals(self):
        text = TIR.read_text()
        largest = {of: float(re.search(rf"residual of sweep_lumped_{of}: .* largest ([0-9.e+-]+) N", text)[1])
                   for of in ("fx", "fy")}
        with open(ROOT / "tire/data/sweep_lumped.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        radius = evaluate_tir.read(TIR)["UNLOADED_RADIUS"]
        for mode, slip, toe in (("fixed_speed", 0.01, 0.0), ("fixed_speed", 0.03, 0.0),
                                ("fixed_speed", 0.1, 0.0), ("free_rolling", 0.0, -0.13963)):
            wanted = {"rig.mode": mode, "rig.slip": slip, "rig.toe_angle": toe, "rig.camber_angle": 0.0}
            found = [row for row in rows if all(row[key] == value if key == "rig.mode"
                                                else float(row[key]) == value for key, value in wanted.items())]
            row = max(found, key=lambda row: row["rig.carrier_mass"] == "450")
            # the same spin: rig.slip counts from each tire's own radius
            turns = 1.0 - SHELL_RADIUS * (1.0 - slip) / radius
            told = self.run_of(f"table_{mode}_{slip}", "--set", f"rig.mode={mode}", "--set", f"rig.slip={turns}",
                               "--set", f"rig.toe_angle={toe}", "--set", f"rig.carrier_mass={row['rig.carrier_mass']}")
            for k, of in enumerate(("fx", "fy")):
                self.assertAlmostEqual(told["iso_w"]["force_N"][k], float(row[f"iso_w.force_N.{k}"]),
                                       delta=1.1 * largest[of] + 5.0, msg=(wanted, of))

    def test_the_smaller_friction_of_tire_and_ground_holds(self):
        def shares(name, *flags):  # of the load: F_x with the wheel braked to a slip ratio of -0.5, F_y at -0.14 rad
            found = []
            for k, (key, value) in enumerate((("slip", -1.0), ("toe_angle", 0.14))):
                force = self.run_of(f"{name}_{key}", "--set", f"rig.{key}={value}", *flags)["iso_w"]["force_N"]
                found.append(abs(force[k]) / force[2])
            return found
        own = shares("own")
        self.assertGreater(min(own), 0.7)
        self.assertEqual(shares("rough", "--set", "terrain.friction=1.1"), own)
        along, across = shares("smooth", "--set", "terrain.friction=0.2")
        self.assertAlmostEqual(along, 0.2, delta=0.006)
        self.assertLess(across, 0.201)  # far beyond its peak the formula falls
        self.assertGreater(across, 0.15)

    def test_the_rolling_moment_balances_the_torque_at_any_speed(self):
        """T + M_y = F_x R_l of a wheel that turns steadily; the spin axis is level."""
        for name, flags in (("free", ("rig.mode=free_rolling", "rig.slip=0")), ("driven", ("rig.slip=0.05",)),
                            ("rigid", ("rig.slip=0.0", "tire.rigid=true", "run.step=1e-4")),
                            ("smooth", ("rig.slip=-0.5", "tire.rigid=true", "run.step=1e-4", "terrain.friction=0"))):
            for speed in (5.0, 15.0):
                with self.subTest(name=name, speed=speed):
                    told = self.run_of(f"{name}{speed:g}", *(word for flag in (*flags, f"rig.speed={speed}")
                                                             for word in ("--set", flag)))
                    axes = told["iso_w"]
                    balance = axes["loaded_radius_m"] * axes["force_N"][0] - told["drive_torque_Nm"]
                    self.assertAlmostEqual(axes["moment_Nm"][1], balance, delta=0.1)
                    if name in ("free", "driven"):
                        file, load = evaluate_tir.read(TIR), axes["force_N"][2]
                        formula = -load * file["UNLOADED_RADIUS"] * (
                            file["QSY1"] + file["QSY2"] * axes["force_N"][0] / file["FNOMIN"])
                        self.assertAlmostEqual(axes["moment_Nm"][1], formula, delta=0.1)

    def test_slip_ratio_is_beside_the_slip(self):
        columns = self.run_of("braked", "--set", "rig.slip=-1")["columns"]
        self.assertAlmostEqual(columns["slip"], -1.0, delta=1e-9)
        self.assertAlmostEqual(columns["slip_ratio"], -0.5, delta=1e-9)

    def test_a_resumed_run_has_the_same_bits(self):
        scenario = {**STEADY, "run": {"step": 2e-4, "end": 0.4, "average_from": 0.2},
                    "checkpoint": {"interval": 0.1, "keep": 10}}
        self.run_of("whole", scenario=scenario)
        folder = self.folder / "whole"
        checkpoints = sorted((folder / "checkpoints").iterdir())
        self.assertGreater(len(checkpoints), 1)
        self.run_of("cut", "--set", "run.end=0.2", "--set", "run.average_from=0.1", scenario=scenario)
        self.furrow("resume", self.folder / "cut", "--until", "0.4", "--no-plots")
        first, second = (self.summary(name)["state_hash"] for name in ("whole", "cut"))
        self.assertEqual(first, second)
        for name in ("whole", "cut"):
            self.assertTrue((self.folder / name / "timeseries.csv").exists())
        self.assertEqual((folder / "timeseries.csv").read_bytes(), (self.folder / "cut/timeseries.csv").read_bytes())

    def test_under_a_vehicle(self):
        path = ROOT / "rigs/hmmwv_rigid.json"
        self.furrow("run", path, "--no-plots", "--out", self.folder / "car", "--set", "tire.file=hmmwv_handling.tir",
                    "--set", "run.step=5e-4", "--set", "run.end=2", "--set", "output.frame_interval=0")
        told = self.summary("car")
        self.assertTrue(told["accounts"]["momentum"]["closes"], told["accounts"]["momentum"])

    def test_a_quarter_car_follows_long_waves_as_two_masses_on_springs_do(self):
        """M q̈ + C q̇ + K q = (K_z + C_z s) h of body and wheel, h the mean over the contact."""
        amplitude, length, speed, first = 0.01, 4.0, 6.0, 2.0
        x = np.arange(0.0, 60.0, 0.02)
        rows = "".join(f"{first + a:.3f},{amplitude * np.sin(2 * np.pi * a / length):.9f}\n" for a in x)
        (self.folder / "waves.csv").write_text("x_m,z_m\n" + rows)
        body, strut, damper, unsprung, rim = 400.0, 2e4, 2e3, 1.0, 40.0
        rig = {"type": "quarter_car", "speed": speed, "ramp": 0, "body_mass": body, "suspension_stiffness": strut,
               "suspension_damping": damper, "unsprung_mass": unsprung, "rim_mass": rim, "rim_spin_inertia": 0.7,
               "start": 1.0}
        told = self.run_of("waves", scenario={**STEADY, "rig": rig, "run": {"step": 2e-4, "end": 8, "average_from": 6},
                                              "terrain": {"engine": "rigid", "profile_file": "waves.csv"}})
        self.accounts_close(told)
        tire, s = evaluate_tir.read(TIR), 2j * np.pi * speed / length
        spring = tire["VERTICAL_STIFFNESS"] + s * tire["VERTICAL_DAMPING"]
        link, wheel = strut + s * damper, unsprung + rim + tire["MASS"]
        half = np.sqrt(2 * tire["UNLOADED_RADIUS"] * tire["FNOMIN"] / tire["VERTICAL_STIFFNESS"])
        seen = amplitude * np.sinc(2 * half / length)
        expected = s * s * np.linalg.solve([[body * s * s + link, -link], [-link, wheel * s * s + link + spring]],
                                           [0.0, spring * seen])[0]
        lines = [line for line in rows_of(self.folder / "waves" / "timeseries.csv") if float(line["time_s"]) > 6.0]
        at = np.array([float(line["position_m"]) for line in lines]) - first
        wave = 2 * np.pi * at / length
        basis = np.stack([np.sin(wave), np.cos(wave), np.ones_like(wave)], axis=1)
        found = np.array([float(line["body_acceleration_m_per_s2"]) for line in lines])
        sine, cosine, _ = np.linalg.lstsq(basis, found, rcond=None)[0]
        self.assertLess(abs(sine + 1j * cosine - expected), 0.03 * abs(expected))

    def test_a_vehicle_stands_on_ramps_and_banks_as_under_gravity_turned(self):
        angle = 0.1
        rise = np.tan(angle)
        (self.folder / "ramp.csv").write_text(f"x_m,z_m\n-50,{-50 * rise}\n50,{50 * rise}\n")
        (self.folder / "bank.csv").write_text("x_m,y_m,z_m\n" + "".join(
            f"{x},{y},{-y * rise}\n" for x in (-50, 50) for y in (-10, 10)))  # rises to the right

        def loads(name, rig, normal, terrain=()):
            scenario = {"format_version": 1, "terrain": {"engine": "rigid", **dict(terrain)},
                        "rig": {"type": "vehicle", "vehicle": "hmmwv.json", **rig,
                                "driver": {"inputs": {"brake": [[0, 1]]}}},
                        "tire": {"file": "hmmwv_handling.tir"},
                        "run": {"step": 5e-4, "end": 4.0, "average_from": 3.0},
                        "output": {"series_interval": 5e-3, "frame_interval": 0}}
            told = self.run_of(name, scenario=scenario)
            self.assertTrue(told["accounts"]["momentum"]["closes"], told["accounts"]["momentum"])
            self.mass = told["vehicle"]["mass_kg"]
            return np.array([np.dot(normal, [wheel["columns"][f"force_{axis}_N"] for axis in "xyz"])
                             for wheel in told["wheels"]])
        cosine, sine, level = np.cos(angle), np.sin(angle), (0, 0, 1)
        for name, slope, normal in (("ramp", {"slope": angle}, (-sine, 0, cosine)),
                                    ("bank", {"slope": angle, "heading": np.pi / 2}, (0, sine, cosine))):
            with self.subTest(name):
                turned = loads(f"{name}_gravity", slope, level)
                found = loads(name, {"start": 10.0}, normal, {"profile_file": f"{name}.csv"}.items())
                np.testing.assert_allclose(found, turned, rtol=0.01)
                self.assertAlmostEqual(found.sum() / (9.81 * self.mass * cosine), 1.0, delta=2e-3)
                if name == "bank":  # its left side is the lower one
                    self.assertGreater(found[0] + found[2] - found[1] - found[3], 0.05 * found.sum())

    def test_a_vehicle_leans_with_a_banked_curve_of_a_road(self):
        """Where the bank is v²/(g R), the weight and the turn act along the road's normal: no load goes across."""
        radius, speed, before = 40.0, 8.0, 6.0
        bank = speed ** 2 / (9.81 * radius)  # falls to the left, into the turn
        rows = "".join(f"{max(0.0, u - 0.25 - before) / radius:20.12f}{0:20.12f}{0:20.12f}\n"
                       for u in np.arange(0.0, 60.1, 0.5))
        (self.folder / "curve.crg").write_text(
            f"$ROAD_CRG\nREFERENCE_LINE_INCREMENT = 0.5\nREFERENCE_LINE_START_B = {-bank}\n"
            f"REFERENCE_LINE_END_B = {-bank}\n$\n$KD_DEFINITION\n#:LDFI\nD:reference line phi,rad\n"
            f"D:long section at v = -5,m\nD:long section at v = 5,m\n$\n$$\n{rows}")
        path = {"kind": "circle", "x": 3, "y": 0, "lead_in": 3, "radius": radius, "turn": "left", "angle_deg": 80,
                "steering": {"law": "preview"}}
        told = self.run_of("curve", scenario={
            "format_version": 1, "tire": {"file": "hmmwv_handling.tir"},
            "rig": {"type": "vehicle", "vehicle": "hmmwv.json", "start": 3.0, "start_speed": speed + 0.5,
                    "driver": {"speed": {"target": speed + 0.5}, "path": path}},
            "terrain": {"engine": "rigid", "profile_file": "curve.crg", "profile_line": "curved"},
            "run": {"step": 1e-3, "end": 4.0, "average_from": 2.5},
            "output": {"series_interval": 0.01, "frame_interval": 0}})
        loads = [wheel["columns"]["force_z_N"] for wheel in told["wheels"]]
        self.assertLess(abs(loads[0] + loads[2] - loads[1] - loads[3]), 0.02 * sum(loads))
        lines = [{key: float(value) for key, value in line.items()}
                 for line in rows_of(self.folder / "curve" / "timeseries_vehicle.csv") if float(line["time_s"]) > 2.5]
        for line in lines:
            self.assertAlmostEqual(line["roll_rad"], -np.arctan(bank), delta=5e-3)
            self.assertAlmostEqual(line["z_m"], lines[0]["z_m"], delta=3e-3)
        self.assertGreater(lines[-1]["y_m"] - lines[0]["y_m"], 3.0)

    def test_pressed_on_a_plate_and_validated(self):
        path = write_json(self.folder / "scenario.json", STEADY)
        self.furrow("press", path, "--out", self.folder / "press", "--load", "4000", "--no-plots")
        self.assertFalse((self.folder / "press" / "report.html").exists())
        told = self.summary("press")
        stiffness = evaluate_tir.read(TIR)["VERTICAL_STIFFNESS"]
        self.assertAlmostEqual(told["secant_stiffness_N_per_m"], stiffness, delta=1e-6 * stiffness)
        self.furrow("press", path, "--on", "cleat", "--out", self.folder / "cleat", code=2, says="expected plate")
        self.furrow("validate", path, shows="hmmwv_handling.tir")

    def test_other_ground_is_refused_by_key(self):
        path = self.folder / "scenario.json"
        for terrain in ({"engine": "scm", "material": "dry_sand.json"}, {"engine": "dem"}):
            write_json(path, {**STEADY, "terrain": terrain})
            self.furrow("validate", path, code=2, says=("key 'terrain.engine'", "Magic Formula"))

    def test_calibration_finds_the_tire_that_made_the_table(self):
        truth = evaluate_tir.read(TIR)
        tire = evaluate_tir.Tire(truth)
        states = [(load, kappa, alpha, gamma) for load in (3000.0, 4500.0, 6500.0)
                  for kappa, alpha, gamma in [(k, 0.0, 0.0) for k in (-0.1, -0.03, -0.01, 0.01, 0.03, 0.1)] +
                  [(0.0, a, 0.0) for a in (-0.1, -0.03, 0.0, 0.01, 0.03, 0.1)] + [(0.0, 0.0, 0.05), (0.0, 0.03, -0.05)]]
        load, kappa, alpha, gamma = (np.array(column) for column in zip(*states))
        forces = evaluate_tir.evaluate(tire, load, kappa, alpha, gamma, 0 * load)
        lines = ["rig.mode," + ",".join(f"iso_w.force_N.{k}" for k in range(3))
                 + "," + ",".join(f"iso_w.moment_Nm.{k}" for k in range(3)) +
                 ",iso_w.slip_angle_rad,iso_w.camber_angle_rad,iso_w.loaded_radius_m,effective_rolling_radius_m"]
        for k, state in enumerate(states):
            rolling = 0.47 / (1.0 + state[1])
            lines.append(("free_rolling" if state[1] == 0.0 else "fixed_speed") + "," +
                         ",".join(repr(float(x)) for x in (forces["Fx_N"][k],
                                                           forces["Fy_N"][k], state[0], forces["Mx_Nm"][k],
                                                            forces["My_Nm"][k],
                                                           forces["Mz_Nm"][k], *state[2:], 0.46, rolling)))
        (self.folder / "table.csv").write_text("\n".join(lines) + "\n")
        fitted = {"PDX1": 1.1, "PKX1": 0.8, "PDY1": 0.9, "PKY1": 1.2, "PKY2": 1.1, "QDZ1": 0.8, "QSY1": 1.3}
        text = TIR.read_text()
        for name, factor in fitted.items():
            line = next(line for line in text.splitlines() if line.startswith(name + " "))
            text = text.replace(line, f"{name} = {factor * truth[name]!r}")
        (self.folder / "start.tir").write_text(text)
        study = {"format_version": 1, "calibrate": "handling", "start": "start.tir", "starts": 1,
                 "parameters": {name: dict(zip(("lower", "upper"), sorted((0.5 * truth[name], 1.6 * truth[name]))))
                                for name in fitted},
                 "targets": [{"data": "table.csv", "of": of} for of in ("fx", "fy", "my", "mz")]}
        write_json(self.folder / "fit.json", study)
        self.furrow("calibrate", self.folder / "fit.json", "--out", self.folder / "fit", "--no-plots")
        found = evaluate_tir.read(self.folder / "fit/start_fitted.tir")
        for name in fitted:
            self.assertAlmostEqual(found[name], truth[name], delta=1e-4 * abs(truth[name]), msg=name)
        self.assertEqual(found["FZMIN"], 3000.0)
        self.assertAlmostEqual(found["KPUMAX"], 0.1)
        text = (self.folder / "fit/start_fitted.tir").read_text()
        self.assertIn("! fitted ranges: slip to 0.1, slip angle to 0.1 rad, camber to 0.05 rad, load 3000 to 6500 N",
                      text)
        self.assertIn("! residual of table_fy: root mean square", text)
        table = (self.folder / "fit/start_fitted.tdx").read_text()
        self.assertTrue(table.startswith("**HEADER\nRELEASE   Release of TYDEX-Format"))
        self.assertEqual(len(table.split("**MEASURDATA\n")[1].splitlines()), len(states) + 1)
        write_json(self.folder / "scenario.json", {**STEADY, "tire": {"file": "fit/start_fitted.json"}})
        self.furrow("validate", self.folder / "scenario.json")

    def test_wrong_calibrations_are_refused_by_key(self):
        good = {"format_version": 1, "calibrate": "handling", "start": "handling_start.tir", "parameters": {"PKY1": {}},
                "targets": [{"data": "sweep_lumped.csv", "of": "fy"}]}
        for change, said in (
                ({"start": "hmmwv_ring.json"}, "key 'start': is 'hmmwv_ring.json', expected a tire property file"),
                ({"parameters": {"PKY9": {}}}, "key 'parameters.PKY9'"),
                ({"targets": [{"data": "sweep_lumped.csv"}]}, "key 'targets[0].of': is missing"),
                ({"targets": [{"data": "sweep_lumped.csv", "of": "fw"}]},
                 "key 'targets[0].of': 'fw' is unknown, expected 'fx'?"),
                ({"targets": [{"data": "no.csv", "of": "fy"}]}, "no.csv"),
                ({"targets": [{"data": "sweep_lumped.csv", "of": "fy", "on": "plate"}]}, "key 'targets[0].on'")):
            write_json(self.folder / "fit.json", {**good, **change})
            self.furrow("calibrate", self.folder / "fit.json", "--out", self.folder / "fit", "--no-plots", code=2,
                        says=said)

    def test_a_changed_file_is_noticed(self):
        text = TIR.read_text()
        (self.folder / "my.tir").write_text(text)
        scenario = {**STEADY, "tire": {"file": "my.json"}, "run": {"step": 2e-4, "end": 0.02, "average_from": 0.01}}
        write_json(self.folder / "my.json", {"format_version": 1, "model": "handling", "tir": "my.tir", "mass": 12.0})
        self.run_of("own", scenario=scenario)
        (self.folder / "my.tir").write_text(text.replace("[UNITS]", "! changed\n[UNITS]"))
        self.furrow("resume", self.folder / "own", "--until", "0.04", code=2,
                    says="my.tir' was changed since the run began")


if __name__ == "__main__":
    main()
