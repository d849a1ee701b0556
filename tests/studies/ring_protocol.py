#!/usr/bin/python3
"""The flexible ring calibrated to a shell tire on a plate and a 51 mm cleat, and what it predicts of the curves that
were held out: ring_protocol.csv (targets), ring_protocol_parameters.csv, ring_protocol_pressure.csv (along the centre
line, ring and shell) and ring_protocol.png beside this script. The shell's curves are those of ring_targets.py.

usage: ring_protocol.py [--runs]

--runs: instead the shipped ring for runs, hmmwv_ring.json, whose sidewall is told by two pressures: ring_runs.csv
(targets, and the longitudinal stiffness under the load, stuck to a plate) and ring_runs_parameters.csv.
"""
import argparse
import json
import pathlib
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import provenance
from provenance import ROOT

sys.path.insert(0, str(ROOT / "scripts"))
from plot.style import BLUE, ORANGE  # noqa: E402  the look of all plots

HERE = pathlib.Path(__file__).resolve().parent
RESULTS = ROOT / "results" / "studies"
LOAD = 4561.65  # N, as of ring_targets.py


def furrow(*words):
    subprocess.run([provenance.program(), *map(str, words)], check=True, cwd=ROOT)


def stiffening(points):
    """Slope of the last third of a curve over that of its first: below 1 it softens."""
    x, y = np.array([(float(p["x"]), float(p["data"])) for p in points]).T
    x, y = np.concatenate(([0.0], x)), np.concatenate(([0.0], y))
    third = max(len(x) // 3, 1)
    return (y[-1] - y[-1 - third]) / (x[-1] - x[-1 - third]) * x[third] / y[third]


def write_targets(name, result, made):
    points = {}
    for row in provenance.read_table(RESULTS / name / "fit.csv"):
        points.setdefault(row["target"], []).append(row)
    rows = []
    for key, how in (("targets", "fitted"), ("held_out_targets", "predicted")):
        for target in result[key]:
            rows.append({"target": target["name"], "set": how, "what": target["what"].replace(",", ""),
                         "points": target["points"],
                         "r_squared": f"{target['r_squared']:.5f}", "largest_error_N": f"{target['largest_error']:.4g}",
                         "largest_error_of_peak": f"{target['largest_error_of_peak']:.4f}",
                         "peak_N": f"{target['peak']:.5g}",
                         "stiffening": f"{stiffening(points[target['name']]):.3f}"})
    provenance.write_table(HERE / f"{name}.csv", list(rows[0]), rows, made)


def write_parameters(name, result, made):
    rows = []
    for parameter, p in result["parameters"].items():
        low, high = p["interval_95"] or ("", "")
        rows.append({"parameter": parameter, "unit": p["unit"], "value": f"{p['value']:.6g}",
                     "standard_error": p["standard_error"] or "",
                     "low": low, "high": high, "at_bound": p["at_bound"] or ""})
    provenance.write_table(HERE / f"{name}_parameters.csv", list(rows[0]), rows, made)


def press(name, result):
    """The fitted ring under the load on a plate. @returns the folder of the results"""
    out = RESULTS / name / "press"
    furrow("press", "rigs/cleat_press.json", "--set", f"tire.file={RESULTS / name / result['result']}", "--set",
           "tire.elements_circumference=null", "--set", "tire.elements_width=null",
           "--on", "plate", "--load", LOAD, "--deflection", 0.032,
           "--points", 8, "--out", out, "--overwrite", "--quiet")
    return out


def write_pressure(result, made):
    """Mean pressure along the centre line: the ring's at the places of the shell's."""
    ring = np.genfromtxt(press("ring_protocol", result) / "footprint.csv", delimiter=",", names=True)
    shell = np.array([(float(row["x_m"]), float(row["pressure_Pa"]))
                      for row in provenance.read_table(HERE / "ring_targets_pressure.csv")])
    there = np.interp(shell[:, 0], ring["x_m"], ring["pressure_Pa"], left=0.0, right=0.0)
    rows = [{"x_m": f"{x:.5g}", "shell_Pa": f"{p:.5g}", "ring_Pa": f"{r:.5g}"} for (x, p), r in zip(shell, there)]
    provenance.write_table(HERE / "ring_protocol_pressure.csv", ["x_m", "shell_Pa", "ring_Pa"], rows, made)
    return shell, ring


def draw(result, shell, ring):
    from plot.calibrate import Calibration
    from plot.soil import COLOURS
    figure, (curves, pressure) = plt.subplots(1, 2, figsize=(11, 4.6))
    for k, target in enumerate(Calibration(RESULTS / "ring_protocol").targets()):
        colour = COLOURS[k % len(COLOURS)]
        curves.plot(1e3 * target["x"], 1e-3 * target["data"], "o" if k < 5 else "s", ms=3.5, color=colour)
        curves.plot(1e3 * target["x"], 1e-3 * target["model"], "--" if target["held_out"] else "-",
                    color=colour, label=target["what"])
    curves.set(xlabel="deflection, mm", ylabel="force, kN",
               title="shell (points), ring fitted (lines) and predicted (dashed)")
    curves.legend(fontsize=7)
    pressure.plot(1e3 * shell[:, 0], 1e-3 * shell[:, 1], "o", ms=3.5, color=BLUE, label="shell")
    pressure.plot(1e3 * ring["x_m"], 1e-3 * ring["pressure_Pa"], "-", color=ORANGE, label="ring")
    pressure.set(xlabel="along, mm", ylabel="pressure, kPa", title=f"centre line under {1e-3 * LOAD:.3g} kN",
                 ylim=(0, None))
    pressure.legend()
    figure.savefig(HERE / "ring_protocol.png", dpi=90)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", action="store_true")
    name, study = ("ring_runs", "calibrate_ring_runs") if parser.parse_args().runs else ("ring_protocol",
                                                                                         "calibrate_ring")
    made = provenance.made_here()
    furrow("calibrate", f"rigs/{study}.json", "--out", RESULTS / name)  # continues what was begun
    result = json.loads((RESULTS / name / "calibration.json").read_text())
    if name == "ring_runs":
        stiffness = json.loads((press(name, result)
                                / "summary.json").read_text())["sticking_stiffness"]["longitudinal_N_per_m"]
        made["note"] = f"longitudinal stiffness under {LOAD} N stuck to a plate: {stiffness:.4g} N/m"
    write_targets(name, result, made)
    write_parameters(name, result, made)
    if name == "ring_protocol":
        draw(result, *write_pressure(result, made))


if __name__ == "__main__":
    main()
