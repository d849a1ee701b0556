#!/usr/bin/python3
"""The two evaluators of tire property files agree: tire/handling (by the program formula_states) and evaluate_tir.py,
on a tire that uses every coefficient and on the fitted one of tire/data.

usage: formula_peer_test.py FORMULA_STATES
"""
import csv
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import evaluate_tir

ROOT = pathlib.Path(__file__).resolve().parents[3]
ROUND_OFF = 1e-9  # of the largest value of each column; a hundredth is what users may count on
STATES = None


class Peer(unittest.TestCase):
    def compare(self, *given):
        with tempfile.TemporaryDirectory() as folder:
            tir, states = pathlib.Path(folder) / "a.tir", pathlib.Path(folder) / "states.csv"
            subprocess.run([STATES, tir, states, *given], check=True)
            with open(states, encoding="utf-8") as file:
                rows = list(csv.DictReader(file))
            tire = evaluate_tir.Tire(evaluate_tir.read(tir))
        column = {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}
        mine = evaluate_tir.evaluate(tire, *(column[name] for name in evaluate_tir.INPUTS))
        for name, values in mine.items():
            size = np.abs(column[name]).max()
            self.assertGreater(size, 0.0, name)
            self.assertLess(np.abs(values - column[name]).max(), ROUND_OFF * size, name)

    def test_a_tire_with_every_coefficient(self):
        self.compare()

    def test_a_tire_of_version_6_1_at_another_pressure(self):
        self.compare("6.1")

    def test_the_fitted_tire(self):
        self.compare(ROOT / "tire/data/hmmwv_handling.tir")


if __name__ == "__main__":
    STATES = sys.argv.pop(1)
    unittest.main()
