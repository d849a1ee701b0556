#!/usr/bin/python3
"""Side force, aligning moment and camber thrust on hard ground from the sweeps of rigs/study_slip_angle.json,
study_camber.json and study_hard_slip.json, and what the runs of rolling.json add: relaxation length, energy per
revolution. Writes cornering.csv (one line a run), cornering_figures.csv (what is derived) and cornering.png beside it.

    build/furrow sweep rigs/study_slip_angle.json --out results/study_slip_angle      (and the other two)
    /usr/bin/python3 tests/studies/run_study.py tests/studies/rolling.json
    /usr/bin/python3 tests/studies/cornering.py
"""
import csv
import math
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
RESULTS = ROOT / "results"
sys.path.insert(0, str(ROOT / "scripts"))
import plot.style  # noqa: E402, F401  the look of all plots

SWEEPS = {"study_slip_angle": "rig.toe_angle", "study_camber": "rig.camber_angle", "study_hard_slip": "rig.slip"}
COLUMNS = {"Fx_N": "iso_w.force_N.0", "Fy_N": "iso_w.force_N.1", "Fz_N": "iso_w.force_N.2", "Fy_sem_N": "iso_w.force_sem_N.1",
           "Mx_Nm": "iso_w.moment_Nm.0", "My_Nm": "iso_w.moment_Nm.1", "Mz_Nm": "iso_w.moment_Nm.2",
           "Mz_sem_Nm": "iso_w.moment_sem_Nm.2", "slip_angle_rad": "iso_w.slip_angle_rad",
           "camber_angle_rad": "iso_w.camber_angle_rad", "loaded_radius_m": "iso_w.loaded_radius_m",
           "effective_rolling_radius_m": "effective_rolling_radius_m", "pull_N": "drawbar_pull_N.mean",
           "pull_sem_N": "drawbar_pull_N.sem", "steady": "drawbar_pull_N.steady"}
STUDENT = {1: 12.7, 2: 4.30, 3: 3.18, 4: 2.78, 5: 2.57, 6: 2.45, 7: 2.36}  # 97.5 % quantiles of Student's t
LINEAR = math.radians(1.05)  # slip angles up to here are fitted with a line


def tire_of(file):
    return file.removesuffix(".json").removeprefix("hmmwv_")


def sweep_rows():
    """One dictionary a finished run."""
    rows = []
    for study, key in SWEEPS.items():
        table = RESULTS / study / "sweep.csv"
        if not table.exists():
            continue
        with open(table, newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                if row["state"] != "done":
                    continue
                values = {name: row[column] for name, column in COLUMNS.items()}
                values = {name: value if name == "steady" else float(value) for name, value in values.items()}
                rows.append({"study": study.removeprefix("study_"), "tire": tire_of(row["tire.file"]),
                             "setting": float(row[key]), **values})
    return rows


def line(x, y):
    """Slope of the least-squares line, half its 95 % interval from the scatter about it."""
    x, y = np.asarray(x), np.asarray(y)
    design = np.column_stack([np.ones_like(x), x])
    coefficients = np.linalg.lstsq(design, y, rcond=None)[0]
    freedom = len(x) - 2
    if freedom < 1:
        return coefficients[1], math.nan
    scatter = np.sum((y - design @ coefficients) ** 2) / freedom
    error = math.sqrt(scatter * np.linalg.inv(design.T @ design)[1, 1])
    return coefficients[1], STUDENT.get(freedom, 2.2) * error


def select(rows, study, tire):
    return sorted((r for r in rows if r["study"] == study and r["tire"] == tire), key=lambda r: r["setting"])


def column(rows, name):
    return np.array([r[name] for r in rows])


def relaxation(series, toe_time, toe_ramp, reach):
    """σ of F = F0 + F1 (1 − exp(−s/σ)), s the distance travelled since the middle of the step, fitted up to `reach`."""
    middle = toe_time + 0.5 * toe_ramp
    time, position, force = series["time_s"], series["position_m"], series["iso_force_y_N"]
    start = np.interp(middle, time, position)
    before = force[(time > toe_time - 0.1) & (time < toe_time)].mean()
    s = position - start
    window = (s > 0.5 * toe_ramp * series["speed_m_per_s"].mean()) & (s < reach)
    s, y = s[window], force[window] - before
    best = None
    for sigma in np.linspace(0.01, 1.0, 1981):
        shape = 1.0 - np.exp(-s / sigma)
        size = (shape @ y) / (shape @ shape)
        error = np.sum((y - size * shape) ** 2)
        if best is None or error < best[0]:
            best = (error, sigma, size)
    return {"sigma": best[1], "size": best[2], "rms": math.sqrt(best[0] / len(s)), "s": s, "y": y}


def series_of(case):
    file = RESULTS / "studies" / "rolling" / case / "timeseries.csv"
    return np.genfromtxt(file, delimiter=",", names=True) if file.exists() else None


def figures(rows):
    """What is derived, as lines of a table."""
    out = []

    def add(tire, quantity, value, interval, unit, how):
        out.append({"tire": tire, "quantity": quantity, "value": f"{value:.5g}", "interval": f"{interval:.2g}", "unit": unit, "how": how})

    for tire in ("layered", "lumped"):
        side = select(rows, "slip_angle", tire)
        small = [r for r in side if abs(r["slip_angle_rad"]) < LINEAR]
        if len(small) > 2:
            slope, error = line(column(small, "slip_angle_rad"), column(small, "Fy_N"))
            add(tire, "cornering stiffness", -slope, error, "N/rad", f"line through {len(small)} runs up to 1 degree")
            slope, error = line(column(small, "Fy_N"), column(small, "Mz_Nm"))
            add(tire, "pneumatic trail", -slope, error, "m", "-dMz/dFy of the same runs")
            slope, error = line(column(small, "slip_angle_rad"), column(small, "Mz_Nm"))
            add(tire, "aligning stiffness", slope, error, "N m/rad", "the same runs")
        camber = select(rows, "camber", tire)
        if len(camber) > 2:
            slope, error = line(column(camber, "camber_angle_rad"), column(camber, "Fy_N"))
            add(tire, "camber stiffness", -slope, error, "N/rad", f"line through {len(camber)} runs up to 5 degrees")
            slope, error = line(column(camber, "camber_angle_rad"), column(camber, "Mz_Nm"))
            add(tire, "camber aligning stiffness", slope, error, "N m/rad", "the same runs")
        driven = select(rows, "hard_slip", tire)
        near = [r for r in driven if -0.001 < r["setting"] < 0.011]
        if len(near) > 1:
            slope, error = line(column(near, "setting"), column(near, "Fx_N"))
            add(tire, "slip stiffness", slope, error, "N", f"line through {len(near)} runs, slip 0 to 1 %")
        step = series_of(f"{tire}_step_of_1_degree")
        if step is not None:
            fits = [relaxation(step, 0.3, 0.01, reach)["sigma"] for reach in (0.5, 0.8, 1.1, 1.35)]
            add(tire, "relaxation length", np.mean(fits), 0.5 * (max(fits) - min(fits)), "m",
                "fit of 1 - exp(-x/sigma) over 0.5, 0.8, 1.1, 1.35 m; half the range")
    return out


def energies():
    """Mean and highest energy (kinetic + strain) of every revolution of the long runs."""
    lines = []
    for tire in ("layered", "lumped"):
        s = series_of(f"{tire}_speed_8_ten_revolutions")
        if s is None:
            continue
        angle = np.cumsum(s["spin_rad_per_s"]) * (s["time_s"][1] - s["time_s"][0])
        angle -= np.interp(0.3, s["time_s"], angle)
        for k in range(int(angle[-1] // (2 * math.pi))):
            these = (angle >= 2 * math.pi * k) & (angle < 2 * math.pi * (k + 1))
            e = s["tire_energy_J"][these]
            lines.append({"tire": tire, "revolution": k + 1, "energy_mean_J": f"{e.mean():.6g}", "energy_highest_J": f"{e.max():.6g}",
                          "energy_std_J": f"{e.std():.4g}", "pull_mean_N": f"{s['drawbar_pull_N'][these].mean():.5g}",
                          "loaded_radius_mean_m": f"{s['loaded_radius_m'][these].mean():.7g}"})
    return lines


def write(name, rows):
    if not rows:
        return
    with open(HERE / name, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)


def draw(rows):
    figure, axes = plt.subplots(2, 3, figsize=(13.5, 7.6))
    for tire, marker in (("layered", "o"), ("lumped", "s")):
        side, camber, slip = (select(rows, study, tire) for study in ("slip_angle", "camber", "hard_slip"))
        angle = np.degrees(column(side, "slip_angle_rad")) if side else []
        if side:
            axes[0, 0].errorbar(angle, column(side, "Fy_N") / 1e3, 2e-3 * column(side, "Fy_sem_N"), marker=marker, capsize=2, label=tire)
            axes[0, 1].errorbar(angle, column(side, "Mz_Nm"), 2 * column(side, "Mz_sem_Nm"), marker=marker, capsize=2, label=tire)
        if camber:
            axes[0, 2].errorbar(np.degrees(column(camber, "camber_angle_rad")), column(camber, "Fy_N"),
                                2 * column(camber, "Fy_sem_N"), marker=marker, capsize=2, label=tire)
        if slip:
            axes[1, 0].plot(column(slip, "setting"), column(slip, "Fx_N") / 1e3, marker=marker, label=tire)
        step = series_of(f"{tire}_step_of_1_degree")
        if step is not None:
            fit = relaxation(step, 0.3, 0.01, 1.2)
            line_, = axes[1, 1].plot(fit["s"], fit["y"], lw=0.8, alpha=0.6, label=f"{tire}, σ = {fit['sigma']:.3f} m")
            axes[1, 1].plot(fit["s"], fit["size"] * (1 - np.exp(-fit["s"] / fit["sigma"])), "--", color=line_.get_color())
        long = [row for row in energies() if row["tire"] == tire]
        if long:
            first = float(long[0]["energy_mean_J"])
            axes[1, 2].plot([r["revolution"] for r in long], [float(r["energy_mean_J"]) - first for r in long], marker=marker, label=tire)
    for axis, x, y in ((axes[0, 0], "slip angle, degrees", "lateral force, kN"), (axes[0, 1], "slip angle, degrees", "aligning moment, N m"),
                       (axes[0, 2], "camber angle, degrees", "lateral force, N"), (axes[1, 0], "slip (undeformed radius)", "longitudinal force, kN"),
                       (axes[1, 1], "distance after a step of 1 degree, m", "lateral force, N"),
                       (axes[1, 2], "revolution at 8 m/s", "mean energy of tire less the first's, J")):
        axis.set(xlabel=x, ylabel=y)
        axis.axhline(0.0, color="0.8", zorder=0)
        if axis.get_legend_handles_labels()[0]:
            axis.legend(fontsize=8)
    figure.suptitle("Hard ground, 200 kPa, 60 × 12 elements, 4 m/s, friction 0.9", x=0.01, ha="left", fontweight="bold")
    figure.tight_layout()
    figure.savefig(HERE / "cornering.png", dpi=90)


def main():
    rows = sweep_rows()
    if not rows:
        sys.exit(f"no finished sweep under {RESULTS}")
    write("cornering.csv", rows)
    derived = figures(rows)
    write("cornering_figures.csv", derived)
    write("revolutions.csv", energies())
    for row in derived:
        print(f"{row['tire']:8} {row['quantity']:28} {row['value']:>10} ± {row['interval']:8} {row['unit']}")
    draw(rows)


if __name__ == "__main__":
    main()
