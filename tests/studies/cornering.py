#!/usr/bin/python3
"""Side force, aligning moment and camber thrust on hard ground from the sweeps of rigs/study_slip_angle.json,
study_camber.json and study_hard_slip.json, and what the runs of rolling.json add: relaxation length, mesh and
friction checks. Writes cornering.csv (one line a run), cornering_figures.csv (what is derived) and cornering.png beside
it.

The tire takes about half a metre to build up its side force, so that at small angles the means of the summaries are a
few per cent short of the steady values. Those are taken from the series: F = F_end - B exp(-x/sigma), x the distance
travelled, fitted from 0.2 s on; the interval is the difference from a fit that begins at 0.28 s.

    build/furrow sweep rigs/study_slip_angle.json --out results/study_slip_angle      (and the other two)
    /usr/bin/python3 tests/studies/run_study.py tests/studies/rolling.json
    FURROW_ROLLING_MESH=60x12 FURROW_ROLLING_CSV=tests/studies/revolutions.csv build/tests_nodes_rolling
    --gtest_filter='*ten*' /usr/bin/python3 tests/studies/cornering.py
"""
import argparse
import json
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
import provenance  # noqa: E402
from plot.student import student  # noqa: E402

SWEEPS = {"study_slip_angle": "rig.toe_angle", "study_camber": "rig.camber_angle", "study_hard_slip": "rig.slip"}
COLUMNS = {"Fx_N": "iso_w.force_N.0", "Fy_N": "iso_w.force_N.1", "Fz_N": "iso_w.force_N.2",
           "Fy_sem_N": "iso_w.force_sem_N.1",
           "Mx_Nm": "iso_w.moment_Nm.0", "My_Nm": "iso_w.moment_Nm.1", "Mz_Nm": "iso_w.moment_Nm.2",
           "Mz_sem_Nm": "iso_w.moment_sem_Nm.2", "slip_angle_rad": "iso_w.slip_angle_rad",
           "camber_angle_rad": "iso_w.camber_angle_rad", "loaded_radius_m": "iso_w.loaded_radius_m",
           "effective_rolling_radius_m": "effective_rolling_radius_m", "pull_N": "drawbar_pull_N.mean",
           "pull_sem_N": "drawbar_pull_N.sem", "vertical_balance_residual": "vertical_balance_residual"}
LINEAR = math.radians(1.05)  # slip angles up to here are fitted with a line
CONTACT = 0.12  # m
FITTED = ("Fy_N", "iso_force_y_N"), ("Mz_Nm", "iso_moment_z_Nm")


def tire_of(file):
    return file.removesuffix(".json").removeprefix("hmmwv_")


def value_of(summary, path):
    for part in path.split("."):
        summary = summary[int(part)] if isinstance(summary, list) else summary[part]
    return summary


def read_series(file):
    """timeseries.csv, also of a run that is not over: its last line may be cut."""
    lines = file.read_text(encoding="utf-8").splitlines()
    width = lines[0].count(",")
    return np.genfromtxt([line for line in lines if line.count(",") == width], delimiter=",", names=True)


def exponential(x, y):
    """Least squares of end − size exp(−x/σ)."""
    best = None
    for sigma in np.linspace(0.05, 1.5, 291):
        design = np.column_stack([np.ones_like(x), -np.exp(-x / sigma)])
        found, *_ = np.linalg.lstsq(design, y, rcond=None)
        error = np.sum((y - design @ found) ** 2)
        if best is None or error < best[0]:
            best = (error, sigma, *found)
    return {"end": best[2], "size": best[3], "sigma": best[1]}


def steady(series, name, begin):
    """Where a series is heading: least squares of end − B exp(−x/σ), x from the distance at `begin`; its last mean
    where it has no more than 2 % of the range to go."""
    window = series["time_s"] > begin
    x, y = series["position_m"][window], series[name][window]
    x = x - x[0]
    last = y[x > 0.8 * x[-1]].mean()
    if abs(last - y[x < 0.2 * x[-1]].mean()) < 0.02 * max(abs(last), 5.0 * y[x > 0.8 * x[-1]].std()):
        return {"end": last, "sigma": math.nan}
    return exponential(x, y)


def sweep_rows():
    """One dictionary a finished run."""
    rows = []
    for study, key in SWEEPS.items():
        for summary in sorted((RESULTS / study / "runs").glob("*/summary.json")):
            values = json.loads(summary.read_text(encoding="utf-8"))
            scenario = json.loads(summary.with_name("scenario.json").read_text(encoding="utf-8"))
            section, name = key.split(".")
            setting, tire = scenario[section][name], tire_of(scenario["tire"]["file"])
            values = {name: value_of(values, path) for name, path in COLUMNS.items()}
            series = read_series(summary.with_name("timeseries.csv"))
            for name, source in FITTED:
                first, second = steady(series, source, 0.2), steady(series, source, 0.28)
                values[f"steady_{name}"], values[f"steady_interval_{name}"] = first["end"], abs(first["end"]
                                                                                                - second["end"])
                if name == "Fy_N":
                    values["sigma_m"] = first["sigma"]
            values = {name: value if isinstance(value, bool) or value is None else f"{value:.6g}" for name,
                      value in values.items()}
            rows.append({"study": study.removeprefix("study_"), "tire": tire, "setting": setting, **values})
    return sorted(rows, key=lambda r: (r["study"], r["tire"], r["setting"]))


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
    return coefficients[1], student(freedom) * error


def select(rows, study, tire):
    return sorted((r for r in rows if r["study"] == study and r["tire"] == tire), key=lambda r: r["setting"])


def column(rows, name):
    return np.array([float(r[name]) for r in rows])


def relaxation(series, toe_time, toe_ramp, reach):
    """σ of F = F_end − B exp(−s/σ), s the distance travelled since the middle of the step, fitted from CONTACT to
    `reach`. Until the wheel has rolled one contact length off, what the turn of the wheel twisted is still in
    contact."""
    middle = toe_time + 0.5 * toe_ramp
    time, position, force = series["time_s"], series["position_m"], series["iso_force_y_N"]
    s = position - np.interp(middle, time, position)
    window = (s > CONTACT) & (s < reach)
    found = exponential(s[window], force[window])
    return {**found, "s": s[s > -0.05], "y": force[s > -0.05]}


def series_of(case):
    file = RESULTS / "studies" / "rolling" / case / "timeseries.csv"
    return read_series(file) if file.exists() else None


def figures(rows):
    """What is derived, as lines of a table."""
    out = []

    def add(tire, quantity, value, interval, unit, how):
        out.append({"tire": tire, "quantity": quantity, "value": f"{value:.5g}",
                    "interval": f"{interval:.2g}", "unit": unit, "how": how})

    def chord(rows, angle, size, force):
        """Mean of |force|/|angle| at ±size, with half the difference of the two sides and of the fits as its
        interval."""
        these = [r for r in rows if abs(abs(float(r[angle])) - size) < 1e-4]
        values = [abs(float(r[f"steady_{force}"])) / size for r in these]
        if not values:
            return math.nan, math.nan
        return np.mean(values), 0.5 * (max(values) - min(values)) + max(float(r[f"steady_interval_{force}"])
                                                                        for r in these) / size

    for tire in ("layered", "lumped"):
        side, camber = select(rows, "slip_angle", tire), select(rows, "camber", tire)
        for size, degrees in ((0.00873, 0.5), (0.01745, 1.0)):
            stiffness, error = chord(side, "slip_angle_rad", size, "Fy_N")
            aligning, aligning_error = chord(side, "slip_angle_rad", size, "Mz_Nm")
            add(tire, f"cornering stiffness, {degrees:g} degrees", stiffness, error, "N/rad", "-Fy/alpha")
            add(tire, f"aligning stiffness, {degrees:g} degrees", aligning, aligning_error, "N m/rad", "Mz/alpha")
            trail = aligning / stiffness
            add(tire, f"pneumatic trail, {degrees:g} degrees", trail,
                trail * math.hypot(error / stiffness, aligning_error / aligning), "m", "-Mz/Fy")
        small = [float(r["sigma_m"]) for r in side if 1e-3 < abs(float(r["slip_angle_rad"])) < LINEAR
                 and not math.isnan(float(r["sigma_m"]))]
        if small:
            add(tire, "relaxation length, start with a slip angle", np.mean(small),
                0.5 * (max(small) - min(small)), "m",
                f"fits of the side force of {len(small)} runs up to 1 degree")
        for size, degrees in ((0.04363, 2.5), (0.08727, 5.0)):
            stiffness, error = chord(camber, "camber_angle_rad", size, "Fy_N")
            add(tire, f"camber stiffness, {degrees:g} degrees", stiffness, error, "N/rad", "-Fy/gamma")
        driven = select(rows, "hard_slip", tire)
        near = [r for r in driven if -0.001 < r["setting"] < 0.011]
        if len(near) > 1:
            slope, error = line(column(near, "setting"), column(near, "Fx_N"))
            add(tire, "slip stiffness", slope, error, "N", f"line through {len(near)} runs, slip 0 to 1 %")
        step = series_of(f"{tire}_step_of_1_degree")
        if step is not None and step["time_s"][-1] > 0.64:
            fits = [relaxation(step, 0.3, 0.01, reach)["sigma"] for reach in (0.9, 1.1, 1.35)]
            add(tire, "relaxation length, step of 1 degree", np.mean(fits), 0.5 * (max(fits) - min(fits)), "m",
                "fits from 0.12 m to 0.9, 1.1, 1.35 m; half the range")
        for check, what in (("c_50", "friction scale 50 s/m"),
                            ("half_shear_stiffness", "half the ground's shear stiffness"),
                            ("40x12", "40 x 12 elements"), ("90x24", "90 x 24 elements"),
                            ("180x48", "180 x 48 elements")):
            series = series_of(f"{tire}_toe_1_{check}")
            if series is not None and series["time_s"][-1] > 0.5:
                (force, moment), (later, later_moment) = ([steady(series, source, begin)["end"] for _, source in FITTED]
                                                          for begin in (0.2, 0.28))
                add(tire, f"cornering stiffness, 1 degree, {what}", abs(force) / 0.01745, abs(force - later) / 0.01745,
                    "N/rad", "-Fy/alpha")
                add(tire, f"pneumatic trail, 1 degree, {what}", -moment / force,
                    abs(moment / force - later_moment / later), "m", "-Mz/Fy")
    return out


def energies(tire):
    """Revolutions and their mean energy (kinetic + strain) on the finest mesh of revolutions.csv."""
    file = HERE / "revolutions.csv"
    if not file.exists():
        return []
    rows = [row for row in provenance.read_table(file)
            if tire_of(row["tire"]) == tire and row["mesh"] == "60x12" and int(row["revolution"]) > 0]
    return [(int(row["revolution"]), float(row["energy_mean_J"])) for row in rows]


def write(name, rows):
    if not rows:
        return
    runs = [summary.parent for study in SWEEPS for summary in (RESULTS / study / "runs").glob("*/summary.json")]
    provenance.write_table(HERE / name, list(rows[0]), rows, provenance.origin_of_runs(runs))


def draw(rows):
    figure, axes = plt.subplots(2, 3, figsize=(13.5, 7.6))
    for tire, marker in (("layered", "o"), ("lumped", "s")):
        side, camber, slip = (select(rows, study, tire) for study in ("slip_angle", "camber", "hard_slip"))
        angle = np.degrees(column(side, "slip_angle_rad")) if side else []
        if side:
            axes[0, 0].errorbar(angle, column(side, "steady_Fy_N") / 1e3,
                                1e-3 * column(side, "steady_interval_Fy_N"), marker=marker, capsize=2, label=tire)
            axes[0, 1].errorbar(angle, column(side, "steady_Mz_Nm"), column(side, "steady_interval_Mz_Nm"),
                                marker=marker, capsize=2, label=tire)
        if camber:
            axes[0, 2].errorbar(np.degrees(column(camber, "camber_angle_rad")), column(camber, "steady_Fy_N"),
                                column(camber, "steady_interval_Fy_N"), marker=marker, capsize=2, label=tire)
        if slip:
            axes[1, 0].plot(column(slip, "setting"), column(slip, "Fx_N") / 1e3, marker=marker, label=tire)
        step = series_of(f"{tire}_step_of_1_degree")
        if step is not None and step["time_s"][-1] > 0.64:
            fit = relaxation(step, 0.3, 0.01, 1.2)
            line_, = axes[1, 1].plot(fit["s"], fit["y"], lw=0.8, alpha=0.6, label=f"{tire}, σ = {fit['sigma']:.3f} m")
            s = np.linspace(CONTACT, 1.3)
            axes[1, 1].plot(s, fit["end"] - fit["size"] * np.exp(-s / fit["sigma"]), "--", color=line_.get_color())
        turns = energies(tire)
        if turns:
            axes[1, 2].plot([k for k, _ in turns], [energy - turns[0][1] for _, energy in turns],
                            marker=marker, label=tire)
    for axis, x, y in ((axes[0, 0], "slip angle, degrees", "lateral force, kN"),
                       (axes[0, 1], "slip angle, degrees", "aligning moment, N m"),
                       (axes[0, 2], "camber angle, degrees", "lateral force, N"),
                       (axes[1, 0], "slip (undeformed radius)", "longitudinal force, kN"),
                       (axes[1, 1], "distance after a step of 1 degree, m", "lateral force, N"),
                       (axes[1, 2], "revolution at 8 m/s", "mean energy of tire less the first's, J")):
        axis.set(xlabel=x, ylabel=y)
        axis.axhline(0.0, color="0.8", zorder=0)
        if axis.get_legend_handles_labels()[0]:
            axis.legend(fontsize=8)
        else:
            axis.set_visible(False)
    figure.suptitle("Hard ground, 200 kPa, 60 × 12 elements, 4 m/s, friction 0.9", x=0.01, ha="left", fontweight="bold")
    figure.tight_layout()
    figure.savefig(HERE / "cornering.png", dpi=90)


def main():
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    rows = sweep_rows()
    if not rows:
        sys.exit(f"no finished sweep under {RESULTS}")
    write("cornering.csv", rows)
    derived = figures(rows)
    write("cornering_figures.csv", derived)
    for row in derived:
        print(f"{row['tire']:8} {row['quantity']:28} {row['value']:>10} ± {row['interval']:8} {row['unit']}")
    draw(rows)


if __name__ == "__main__":
    main()
