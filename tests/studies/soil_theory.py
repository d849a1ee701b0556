#!/usr/bin/python3
"""Soil theory beside the small rig: what `furrow report --soil` expects of a rigid wheel of the rig's size, load and
slip on soil with the strength that soil_speed.csv holds (0.1 m/s), and what the simulated tire does. Writes
soil_theory.csv.

The equations at the head of terrain/soil/bekker_wong.hpp are integrated here a second time, by other means; the script
stops where the program differs by more than 1e-3. Figures of the simulation: means of five beds in budget.csv with half
of their 95 % intervals.
"""
import argparse
import json
import math
import pathlib
import subprocess
import tempfile

import numpy as np

import provenance

HERE = pathlib.Path(__file__).resolve().parent
WHEEL = {"tire_radius_m": 0.4673, "tread_width_m": 0.2504983721447331, "slip": 0.3}
C1, C2 = 0.4, 0.2  # of the angle of the largest pressure, as RigidWheel has them
LOAD = 4607.77  # N, of rigs/drawbar_pull_small.json
COLUMNS = ["quantity", "unit", "theory", "standard_error", "simulated", "half_width_95", "source"]


def strength():
    """(value, standard error) by key of soil.json"""
    row = next(row for row in provenance.read_table(HERE / "soil_speed.csv") if row["speed_m_s"] == "0.1")
    keys = {"cohesion_Pa": ("cohesion_kPa", 1e3), "friction_angle_deg": ("friction_angle_deg", 1.0),
            "janosi_K_m": ("janosi_K_mm", 1e-3),
            "n": ("n", 1.0), "k_c": ("k_c_kN_per_m_n1", 1e3), "k_phi": ("k_phi_kN_per_m_n2", 1e3)}
    return ({key: factor * float(row[column]) for key, (column, factor) in keys.items()},
            {key: factor * float(row[f"{column}_se"]) for key, (column, factor) in keys.items()})


def by_the_program(soil, errors, load):
    with tempfile.TemporaryDirectory() as name:
        run = pathlib.Path(name)
        (run / "scenario.json").write_text("{}")
        (run / "summary.json").write_text(json.dumps({"format_version": 1, "vertical_load_N": load, **WHEEL}))
        (run / "soil.json").write_text(json.dumps({"format_version": 1, **soil, "standard_error": errors}))
        # The folder holds nothing to plot, so the command ends with an error after it has written the estimate.
        subprocess.run([provenance.program(), "report", str(run), "--soil", str(run / "soil.json")],
                       stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
        return json.loads((run / "soil_estimate.json").read_text())


def by_quadrature(soil, load):
    """Thrust, resistance, sinkage: Gauss's rule on both parts of the contact, the entry angle by secants."""
    radius, width, slip = (WHEEL[key] for key in ("tire_radius_m", "tread_width_m", "slip"))
    stiffness = soil["k_c"] / width + soil["k_phi"]
    points, weights = np.polynomial.legendre.leggauss(200)

    def forces(entry):
        middle = (C1 + C2 * slip) * entry
        total = np.zeros(3)
        for low, high in ((0.0, middle), (middle, entry)):
            # Substituted so that the points crowd at the upper end, where the pressure has a vertical tangent for n <
            # 1.
            s = 0.5 * (points + 1.0)
            angle, share = high - (high - low) * (1.0 - s) ** 3, 1.5 * (high - low) * (1.0 - s) ** 2 * weights
            front = np.where(angle >= middle, angle, entry - angle * (entry - middle) / middle)
            sigma = stiffness * np.maximum(radius * (np.cos(front) - math.cos(entry)), 0.0) ** soil["n"]
            j = radius * (entry - angle - (1.0 - slip) * (math.sin(entry) - np.sin(angle)))
            tau = (soil["cohesion_Pa"] + sigma
                   * math.tan(math.radians(soil["friction_angle_deg"]))) * (1.0 - np.exp(-j / soil["janosi_K_m"]))
            area = width * radius * share
            total += [np.sum(area * (sigma * np.cos(angle) + tau * np.sin(angle))), np.sum(area * tau * np.cos(angle)),
                      np.sum(area * sigma * np.sin(angle))]
        return total

    a, b = 0.3, 0.6
    for _ in range(60):
        fa, fb = forces(a)[0] - load, forces(b)[0] - load
        if abs(fb) < 1e-9 * load:
            break
        a, b = b, b - fb * (b - a) / (fb - fa)
    _, thrust, resistance = forces(b)
    return {"thrust_N": thrust, "compaction_resistance_N": resistance, "drawbar_pull_N": thrust - resistance,
            "sinkage_m": radius * (1.0 - math.cos(b))}


def main():
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    soil, errors = strength()
    beds = {row["variant"]: row for row in provenance.read_table(HERE / "budget.csv")}
    theory, again = by_the_program(soil, errors, LOAD), by_quadrature(soil, LOAD)
    for key, value in again.items():
        if not math.isclose(theory[key], value, rel_tol=1e-3):
            raise SystemExit(f"{key}: the program says {theory[key]:.6g}, its equations {value:.6g}")
    def line(what, unit, key, scale, figure, variant="base", error=None):
        beds_of = beds[variant]
        return dict(zip(COLUMNS, (what, unit, digits(theory[key], scale) if key else "", digits(error), beds_of[figure],
                                  beds_of[f"{figure}_half_95"], f"budget.csv, {variant}")))

    def digits(value, scale=1.0):
        return "" if value is None else f"{scale * value:.4g}"

    rows = [line("drawbar pull", "N", "drawbar_pull_N", 1.0, "pull_N", error=theory["drawbar_pull_standard_error_N"]),
            line("sinkage", "mm", "sinkage_m", 1e3, "sinkage_mm"),
            line("sinkage, bed twice as deep", "mm", None, 1.0, "sinkage_mm", "depth 226 mm"),
            line("thrust, tractive effort", "N", "thrust_N", 1.0, "tractive_effort_N"),
            line("resistance", "N", "compaction_resistance_N", 1.0, "resistance_N"),
            line("resistance, bed twice as deep", "N", None, 1.0, "resistance_N", "depth 226 mm"),
            {**dict.fromkeys(COLUMNS, ""), "quantity": "largest pressure",
             "unit": "kPa", "theory": digits(theory["largest_pressure_Pa"], 1e-3)}]
    provenance.write_table(HERE / "soil_theory.csv", COLUMNS, rows, provenance.made_here())
    print(*rows, sep="\n")


if __name__ == "__main__":
    main()
