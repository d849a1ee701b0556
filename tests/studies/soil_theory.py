#!/usr/bin/python3
"""Soil theory beside the small rig: what `furrow report --soil` expects of a rigid wheel of the rig's size, load and
slip on soil with the strength that soil_speed.csv holds (0.1 m/s), and what the simulated tire does. Writes
soil_theory.csv.

The equations at the head of terrain/soil/bekker_wong.hpp are integrated here a second time, by other means; the script
stops where the program differs by more than 1e-3. Figures of the simulation: means of five beds in budget.csv with half
of their 95 % intervals.
"""
import json
import math
import pathlib
import subprocess
import tempfile

import numpy as np

import driver
import provenance
import soil_speed
from driver import HERE

WHEEL = {"tire_radius_m": 0.4673, "tread_width_m": 0.2504983721447331, "slip": 0.3}
C1, C2 = 0.4, 0.2  # of the angle of the largest pressure, as RigidWheel has them
LOAD = 4607.77  # N, of rigs/drawbar_pull_small_report_soil.json
COLUMNS = ["quantity", "unit", "theory", "standard_error", "simulated", "half_width_95", "source"]
# quantity, unit, key of the theory, factor, figure and variant of budget.csv
LINES = [("drawbar pull", "N", "drawbar_pull_N", 1.0, "pull_N", "base"),
         ("sinkage", "mm", "sinkage_m", 1e3, "sinkage_mm", "base"),
         ("sinkage, bed twice as deep", "mm", None, 1.0, "sinkage_mm", "depth 226 mm"),
         ("thrust, tractive effort", "N", "thrust_N", 1.0, "tractive_effort_N", "base"),
         ("resistance", "N", "compaction_resistance_N", 1.0, "resistance_N", "base"),
         ("resistance, bed twice as deep", "N", None, 1.0, "resistance_N", "depth 226 mm"),
         ("largest pressure", "kPa", "largest_pressure_Pa", 1e-3, None, None)]


def strength(ending=""):
    """Values, or with `_se` their standard errors, by key of soil.json."""
    row = next(row for row in provenance.read_table(HERE / "soil_speed.csv") if row["speed_m_s"] == "0.1")
    return {key: float(row[column + ending]) / factor for column, key, factor in soil_speed.FIGURES}


def by_the_program(soil, errors):
    with tempfile.TemporaryDirectory() as name:
        run = pathlib.Path(name)
        (run / "scenario.json").write_text("{}")
        (run / "summary.json").write_text(json.dumps({"format_version": 1, "vertical_load_N": LOAD, **WHEEL}))
        (run / "soil.json").write_text(json.dumps({"format_version": 1, **soil, "standard_error": errors}))
        # The folder holds nothing to plot, so the command ends with an error after it has written the estimate.
        subprocess.run([provenance.program(), "report", run, "--soil", run / "soil.json"], capture_output=True)
        return json.loads((run / "soil_estimate.json").read_text())


def by_quadrature(soil):
    """Thrust, resistance, sinkage: Gauss's rule on both parts of the contact, the entry angle by secants."""
    radius, width, slip = (WHEEL[key] for key in ("tire_radius_m", "tread_width_m", "slip"))
    stiffness = soil["k_c"] / width + soil["k_phi"]
    points, weights = np.polynomial.legendre.leggauss(200)

    def forces(entry):
        middle = (C1 + C2 * slip) * entry
        total = np.zeros(3)
        for low, high in ((0.0, middle), (middle, entry)):
            # Substituted so that the points crowd at the upper end, where the pressure has a vertical tangent for
            # n < 1.
            s = 0.5 * (points + 1.0)
            angle, share = high - (high - low) * (1.0 - s) ** 3, 1.5 * (high - low) * (1.0 - s) ** 2 * weights
            front = np.where(angle >= middle, angle, entry - angle * (entry - middle) / middle)
            sigma = stiffness * np.maximum(radius * (np.cos(front) - math.cos(entry)), 0.0) ** soil["n"]
            j = radius * (entry - angle - (1.0 - slip) * (math.sin(entry) - np.sin(angle)))
            strength_here = soil["cohesion_Pa"] + sigma * math.tan(math.radians(soil["friction_angle_deg"]))
            tau = strength_here * (1.0 - np.exp(-j / soil["janosi_K_m"]))
            area = width * radius * share
            total += [np.sum(area * (sigma * np.cos(angle) + tau * np.sin(angle))), np.sum(area * tau * np.cos(angle)),
                      np.sum(area * sigma * np.sin(angle))]
        return total

    a, b = 0.3, 0.6
    for _ in range(60):
        fa, fb = forces(a)[0] - LOAD, forces(b)[0] - LOAD
        if abs(fb) < 1e-9 * LOAD:
            break
        a, b = b, b - fb * (b - a) / (fb - fa)
    _, thrust, resistance = forces(b)
    return {"thrust_N": thrust, "compaction_resistance_N": resistance, "drawbar_pull_N": thrust - resistance,
            "sinkage_m": radius * (1.0 - math.cos(b))}


def main():
    driver.options(__doc__).parse_args()
    soil = strength()
    beds = {row["variant"]: row for row in provenance.read_table(HERE / "budget.csv")}
    theory = by_the_program(soil, strength("_se"))
    for key, value in by_quadrature(soil).items():
        if not math.isclose(theory[key], value, rel_tol=1e-3):
            raise SystemExit(f"{key}: the program gives {theory[key]:.6g}, its equations {value:.6g}")
    rows = []
    for what, unit, key, scale, figure, variant in LINES:
        row = {"quantity": what, "unit": unit, "theory": scale * theory[key] if key else None}
        if figure:
            row |= {"simulated": beds[variant][figure], "half_width_95": beds[variant][f"{figure}_half_95"],
                    "source": f"budget.csv, {variant}"}
        if key == "drawbar_pull_N":
            row["standard_error"] = theory["drawbar_pull_standard_error_N"]
        rows.append(row)
    driver.write("soil_theory.csv", rows, names=COLUMNS, told=True)


if __name__ == "__main__":
    main()
