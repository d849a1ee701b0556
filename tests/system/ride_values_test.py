"""Weighting and figures of ISO 2631-1 against the standard's table and closed forms."""
import pathlib
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts" / "python"))
from furrow.plot import ride_values as ride  # noqa: E402

# ISO 2631-1:1997, table 3: third-octave centre (Hz) and W_k × 1000.
TABLE = {0.5: 418, 0.63: 459, 0.8: 477, 1.0: 482, 1.25: 484, 1.6: 494, 2.0: 531, 2.5: 631, 3.15: 804, 4.0: 967,
         5.0: 1039, 6.3: 1054, 8.0: 1036, 10.0: 988, 12.5: 902, 16.0: 768, 20.0: 636, 25.0: 513, 31.5: 405, 40.0: 314,
         50.0: 246, 63.0: 186, 80.0: 132}


class Weighting(unittest.TestCase):
    def test_is_that_of_the_standards_table(self):
        for nominal, wanted in TABLE.items():
            self.assertAlmostEqual(1000.0 * abs(ride.weighting(nominal)) / wanted,
                                   1.0, delta=0.006, msg=f"{nominal} Hz")

    def test_a_sine_has_its_weighted_rms(self):
        time = np.arange(0.0, 40.0, 1e-3)
        for frequency in (1.0, 5.0, 20.0):
            values = ride.ride_values(time, 2.0 * np.sin(2.0 * np.pi * frequency * time))
            factor = abs(ride.weighting(frequency))
            self.assertAlmostEqual(values["rms"], np.sqrt(2.0), delta=2e-3)
            self.assertAlmostEqual(values["weighted_rms"] / (np.sqrt(2.0) * factor), 1.0, delta=0.01)
            self.assertAlmostEqual(values["mtvv"] / (np.sqrt(2.0) * factor), 1.0, delta=0.1)
            # ∫ (A sin)⁴ = 3/8 A⁴ T
            self.assertAlmostEqual(values["vdv"] / (2.0 * factor * (0.375 * 40.0) ** 0.25), 1.0, delta=0.01)
            self.assertAlmostEqual(values["crest"], np.sqrt(2.0), delta=0.3)  # the filter swings in

    def test_the_density_of_noise_adds_up_to_its_variance(self):
        time = np.arange(0.0, 30.0, 2e-3)
        noise = np.random.default_rng(1).normal(0.0, 1.5, len(time))
        frequency, power = ride.density(time, noise)
        self.assertAlmostEqual(np.sum(power) * frequency[1] / np.var(noise), 1.0, delta=0.05)
        self.assertEqual(ride.in_words(0.2), "not uncomfortable")
        self.assertEqual(ride.in_words(3.0), "extremely uncomfortable")


if __name__ == "__main__":
    unittest.main()
