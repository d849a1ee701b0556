#!/usr/bin/python3
"""The flexible ring calibrated to a shell tire on a plate and a 51 mm cleat, and what it predicts of the curves that
were held out: ring_protocol.csv (targets), ring_protocol_parameters.csv, ring_protocol_pressure.csv (along the centre
line, ring and shell) and ring_protocol.png beside this script. The shell's curves are those of ring_targets.py.

usage: ring_protocol.py [--runs]

--runs: instead the shipped ring for runs, hmmwv_ring.json, whose sidewall is told by two pressures: ring_runs.csv
(targets, and the longitudinal stiffness under the load, stuck to a plate) and ring_runs_parameters.csv.
"""
import numpy as np

import driver
import provenance
from driver import HERE, RESULTS, read_json
from furrow.plot.style import BLUE, GREEN, ORANGE, PURPLE, RED, SKY
from ring_targets import PLATE


def stiffening(points):
    """Slope of the last third of a curve over that of its first: below 1 it softens."""
    x, y = np.array([(0.0, 0.0)] + [(float(p["x"]), float(p["data"])) for p in points]).T
    third = max((len(x) - 1) // 3, 1)
    return (y[-1] - y[-1 - third]) / (x[-1] - x[-1 - third]) * x[third] / y[third]


def write_targets(name, result, made):
    points, rows = {}, []
    for row in provenance.read_table(RESULTS / name / "fit.csv"):
        points.setdefault(row["target"], []).append(row)
    for key, how in (("targets", "fitted"), ("held_out_targets", "predicted")):
        rows += [{"target": target["name"], "set": how, "what": target["what"].replace(",", ""),
                  "points": target["points"], "r_squared": f"{target['r_squared']:.5f}",
                  "largest_error_N": float(target["largest_error"]),
                  "largest_error_of_peak": f"{target['largest_error_of_peak']:.4f}", "peak_N": f"{target['peak']:.5g}",
                  "stiffening": f"{stiffening(points[target['name']]):.3f}"} for target in result[key]]
    driver.write(f"{name}.csv", rows, made)


def write_parameters(name, result, made):
    rows = []
    for parameter, p in result["parameters"].items():
        low, high = p["interval_95"] or ("", "")
        rows.append({"parameter": parameter, "unit": p["unit"], "value": f"{p['value']:.6g}",
                     "standard_error": p["standard_error"] or "", "low": low, "high": high,
                     "at_bound": p["at_bound"] or ""})
    driver.write(f"{name}_parameters.csv", rows, made, None)


def press(name, result):
    """The fitted ring under the load on a plate. @returns the folder of the results"""
    out = RESULTS / name / "press"
    driver.furrow("press", "rigs/cleat_press.json", "--set", f"tire.file={RESULTS / name / result['result']}", "--set",
                  "tire.elements_circumference=null", "--set", "tire.elements_width=null", *PLATE, "--out", out,
                  "--overwrite", "--quiet")
    return out


def write_pressure(result, made):
    """Mean pressure along the centre line: the ring's at the places of the shell's."""
    ring = driver.columns(press("ring_protocol", result) / "footprint.csv")
    shell = np.array([(float(row["x_m"]), float(row["pressure_Pa"]))
                      for row in provenance.read_table(HERE / "ring_targets_pressure.csv")])
    there = np.interp(shell[:, 0], ring["x_m"], ring["pressure_Pa"], left=0.0, right=0.0)
    driver.write("ring_protocol_pressure.csv", [{"x_m": x, "shell_Pa": p, "ring_Pa": r}
                                                for (x, p), r in zip(shell, there)], made, 5)
    return shell, ring


def draw(shell, ring):
    from furrow.plot.calibrate import Calibration
    figure, (curves, pressure) = driver.subplots(1, 2, figsize=(11, 4.6))
    colours = {}
    for target in Calibration(RESULTS / "ring_protocol").targets():
        ground, inflated = target["what"].rsplit(", ", 1)
        full = inflated == "200 kPa"
        look = {"color": colours.setdefault(ground, (BLUE, ORANGE, GREEN, RED, PURPLE, SKY)[len(colours) % 6])}
        curves.plot(1e3 * target["x"], 1e-3 * target["data"], "o" if full else "s", ms=3.5, **look)
        curves.plot(1e3 * target["x"], 1e-3 * target["model"],
                    ("--" if full else ":") if target["held_out"] else "-", label=target["what"], **look)
    driver.label(curves, "deflection, mm", "force, kN", "shell (points), ring fitted (lines) and predicted (broken)", 7)
    pressure.plot(1e3 * shell[:, 0], 1e-3 * shell[:, 1], "o", ms=3.5, color=BLUE, label="shell")
    pressure.plot(1e3 * ring["x_m"], 1e-3 * ring["pressure_Pa"], "-", color=ORANGE, label="ring")
    driver.label(pressure, "along, mm", "pressure, kPa", f"centre line under {1e-3 * PLATE[-1]:.3g} kN", 10,
                 ylim=(0, None))
    driver.save(figure, "ring_protocol")


def main():
    runs = driver.options(__doc__, runs={"action": "store_true"}).parse_args().runs
    name, study = ("ring_runs", "calibrate_ring_runs") if runs else ("ring_protocol", "calibrate_ring")
    made = provenance.made_here()
    driver.furrow("calibrate", f"rigs/{study}.json", "--out", RESULTS / name, progress=True)  # continues it
    result = read_json(RESULTS / name / "calibration.json")
    if runs:
        stiffness = driver.summary(press(name, result))["sticking_stiffness"]["longitudinal_N_per_m"]
        made["note"] = f"longitudinal stiffness under {PLATE[-1]} N stuck to a plate: {stiffness:.4g} N/m"
    write_targets(name, result, made)
    write_parameters(name, result, made)
    if not runs:
        draw(*write_pressure(result, made))


if __name__ == "__main__":
    main()
