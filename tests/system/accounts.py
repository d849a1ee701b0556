#!/usr/bin/python3
"""The accounts of a run: they close on grains and on hard ground, better with a smaller step, survive a resume, and are
told."""

from program import SystemTest, changed, furrow, main, rows_of, write_scenario

FLEXIBLE = changed(tire={"rigid": False, "elements_circumference": 30, "elements_width": 6},
                   terrain={"radius": 0.03, "cohesion": 20e3, "layers": 3, "length": 1.4, "width": 0.4},
                   rig={"carrier_mass": 200, "touchdown_damping": 3000, "touchdown_time": 0.1},
                   run={"step": 1e-4, "end": 0.12, "average_from": 0.06},
                   output={"series_interval": 2e-3, "frame_interval": 0})


class Accounts(SystemTest):
    def accounts(self, name, *arguments, scenario=FLEXIBLE):
        told, said = self.run_of(name, scenario, *arguments)
        return told["accounts"], said

    def check(self, accounts):
        energy, momentum = accounts["energy"], accounts["momentum"]
        self.assertTrue(energy["closes"], energy)
        self.assertTrue(momentum["closes"], momentum)
        self.assertLess(abs(energy["residual_share"]), 0.03, energy)
        total = sum(energy["work"].values()) - sum(energy["stored"].values()) - sum(energy["lost"].values())
        self.assertAlmostEqual(total, energy["residual"], delta=1e-9 * energy["turnover"])
        self.assertAlmostEqual(sum(energy["residual_of"].values()), energy["residual"], delta=1e-9 * energy["turnover"])
        for i in range(3):
            balance = sum(momentum[key][i] for key in ("gravity", "walls", "guide", "sleep")) - sum(
                momentum[key][i] for key in ("grains", "tires", "carrier", "under_way"))
            self.assertAlmostEqual(balance, momentum["residual"][i], delta=1e-12 * momentum["largest"])

    def test_flexible_tire_on_grains(self):
        accounts, told = self.accounts("run")
        self.check(accounts)
        lost = accounts["energy"]["lost"]
        for entry in ("sliding_loss", "normal_damping_loss", "tire_viscous_loss", "tire_numerical_loss", "damper_loss"):
            self.assertGreater(lost[entry], 0.0, entry)
        self.assertRegex(told, r"furrow: accounts: energy residual -?[\d.e+-]+ % of [\d.]+ J turned over, momentum "
                         r"residual [\d.e-]+ of")
        self.assertNotIn("does not close", told)
        last = rows_of(self.folder / "run/timeseries_accounts.csv")[-1]
        self.assertEqual(float(last["residual_J"]), accounts["energy"]["residual"])
        self.assertEqual(float(last["sliding_loss_J"]), lost["sliding_loss"])
        done = furrow("report", self.folder / "run", cwd=self.folder)
        for plot in ("energy.png", "momentum.png"):
            self.assertTrue((self.folder / "run" / plot).is_file(), done.stderr)

    def test_hard_ground_at_half_the_step(self):
        ground = {"engine": "rigid", "ground_stiffness": 5e7, "ground_shear_stiffness": 2e7, "ground_damping": 1e4}
        scenario = dict(FLEXIBLE, terrain=ground)
        coarse, _ = self.accounts("coarse", scenario=scenario)
        fine, _ = self.accounts("fine", "--set", "run.step=5e-5", scenario=scenario)
        self.check(coarse)
        self.check(fine)
        for part in ("tires", "rig"):
            rounding = 1e-8 * fine["energy"]["turnover"]
            self.assertLess(abs(fine["energy"]["residual_of"][part]),
                            0.6 * abs(coarse["energy"]["residual_of"][part]) + rounding, part)
        self.assertLess(abs(fine["energy"]["lost"]["surface_lag_loss"]),
                        0.75 * abs(coarse["energy"]["lost"]["surface_lag_loss"]))

    def test_two_wheels_and_sums(self):
        wheels = [{"start": 0.6, "lateral": -0.4}, {"start": 0.9, "lateral": 0.4}]
        scenario = dict(FLEXIBLE, rig={**FLEXIBLE["rig"], "wheels": wheels},
                        tire={"file": "hmmwv_layered.json", "rigid": True},
                        terrain={"engine": "rigid"})
        accounts, _ = self.accounts("two", scenario=scenario)
        self.check(accounts)
        self.assertEqual(len(accounts["energy"]["each_tire"]), 2)
        self.assertAlmostEqual(sum(t["residual"] for t in accounts["energy"]["each_tire"]),
                               accounts["energy"]["residual_of"]["tires"], delta=1e-9 * accounts["energy"]["turnover"])

    def test_a_resumed_run_has_the_same_accounts_bit_for_bit(self):
        whole, _ = self.accounts("whole")
        path = write_scenario(self.folder, dict(FLEXIBLE, checkpoint={"at_end": True}))
        self.furrow("run", path, "--no-plots", "--out", self.folder / "part", "--set", "run.end=0.08")
        self.furrow("resume", self.folder / "part", "--until", "0.12", "--no-plots")
        resumed = self.summary("part")["accounts"]
        self.assertEqual(resumed, whole)
        self.assertEqual((self.folder / "part/timeseries_accounts.csv").read_bytes(),
                         (self.folder / "whole/timeseries_accounts.csv").read_bytes())


if __name__ == "__main__":
    main()
