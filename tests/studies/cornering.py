#!/usr/bin/python3
"""Side force, aligning moment and camber thrust on hard ground from the sweeps of rigs/study_slip_angle.json,
study_camber.json and study_hard_slip.json, and what the runs of rolling.json add: relaxation length, mesh and
friction checks. Writes cornering.csv (one line a run), cornering_figures.csv (what is derived) and cornering.png beside
it.

The tire takes about half a metre to build up its side force, so that at small angles the means of the summaries are a
few per cent short of the steady values. Those are taken from the series: F = F_end - B exp(-x/sigma), x the distance
travelled, fitted from 0.2 s on; the interval is the difference from a fit that begins at 0.28 s.

    tests/studies/sweep_table.py rigs/study_slip_angle.json      (and the other two)
    tests/studies/run_study.py tests/studies/rolling.json
    tests/studies/made_with.py FURROW_ROLLING_CSV=tests/studies/revolutions.csv FURROW_ROLLING_MESH=60x12 -- \\
      build/tests_nodes_rolling '--gtest_filter=*ten*'
    tests/studies/cornering.py
"""
import math
import sys

import numpy as np

import driver
import provenance
from driver import HERE, read_json, value_of
from furrow.plot.student import student

RESULTS = driver.ROOT / "results"
SWEEPS = {"study_slip_angle": "rig.toe_angle", "study_camber": "rig.camber_angle", "study_hard_slip": "rig.slip"}
COLUMNS = {"Fx_N": "iso_w.force_N.0", "Fy_N": "iso_w.force_N.1", "Fz_N": "iso_w.force_N.2",
           "Fy_sem_N": "iso_w.force_sem_N.1", "Mx_Nm": "iso_w.moment_Nm.0", "My_Nm": "iso_w.moment_Nm.1",
           "Mz_Nm": "iso_w.moment_Nm.2", "Mz_sem_Nm": "iso_w.moment_sem_Nm.2", "slip_angle_rad": "iso_w.slip_angle_rad",
           "camber_angle_rad": "iso_w.camber_angle_rad", "loaded_radius_m": "iso_w.loaded_radius_m",
           "effective_rolling_radius_m": "effective_rolling_radius_m", "pull_N": "drawbar_pull_N.mean",
           "pull_sem_N": "drawbar_pull_N.sem", "vertical_balance_residual": "vertical_balance_residual"}
LINEAR = math.radians(1.05)  # slip angles up to here are fitted with a line
CONTACT = 0.12  # m
FITTED = ("Fy_N", "iso_force_y_N"), ("Mz_Nm", "iso_moment_z_Nm")


def tire_of(file):
    return file.removesuffix(".json").removeprefix("hmmwv_")


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
    late = y[x > 0.8 * x[-1]]
    if abs(late.mean() - y[x < 0.2 * x[-1]].mean()) < 0.02 * max(abs(late.mean()), 5.0 * late.std()):
        return {"end": late.mean(), "sigma": math.nan}
    return exponential(x, y)


def sweep_rows():
    """One dictionary a finished run."""
    rows = []
    for study, key in SWEEPS.items():
        for run in sorted(file.parent for file in (RESULTS / study / "runs").glob("*/summary.json")):
            summary, scenario = driver.summary(run), read_json(run / "scenario.json")
            row = {"study": study.removeprefix("study_"), "tire": tire_of(scenario["tire"]["file"]),
                   "setting": value_of(scenario, key),
                   **{name: value_of(summary, path) for name, path in COLUMNS.items()}}
            series = read_series(run / "timeseries.csv")
            for name, source in FITTED:
                first, second = steady(series, source, 0.2), steady(series, source, 0.28)
                row[f"steady_{name}"], row[f"steady_interval_{name}"] = first["end"], abs(first["end"] - second["end"])
                if name == "Fy_N":
                    row["sigma_m"] = first["sigma"]
            rows.append(row)
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
    `reach`. Until the wheel has rolled one contact length off, what its turn twisted is still in contact."""
    middle = toe_time + 0.5 * toe_ramp
    time, position, force = series["time_s"], series["position_m"], series["iso_force_y_N"]
    s = position - np.interp(middle, time, position)
    window = (s > CONTACT) & (s < reach)
    found = exponential(s[window], force[window])
    return {**found, "s": s[s > -0.05], "y": force[s > -0.05]}


def series_of(case, until):
    """Of a run of rolling.json that has come so far, s; else None."""
    file = RESULTS / "studies" / "rolling" / case / "timeseries.csv"
    series = read_series(file) if file.exists() else None
    return series if series is not None and series["time_s"][-1] > until else None


def chord(rows, angle, size, force):
    """Mean of |force|/|angle| at ±size, with half the difference of the two sides and of the fits as its interval."""
    these = [r for r in rows if abs(abs(float(r[angle])) - size) < 1e-4]
    values = [abs(float(r[f"steady_{force}"])) / size for r in these]
    if not values:
        return math.nan, math.nan
    fits = max(float(r[f"steady_interval_{force}"]) for r in these) / size
    return np.mean(values), 0.5 * (max(values) - min(values)) + fits


def spread(values):
    """(mean, half the range)"""
    return np.mean(values), 0.5 * (max(values) - min(values))


CHECKS = {"c_50": "friction scale 50 s/m", "half_shear_stiffness": "half the ground's shear stiffness",
          "40x12": "40 x 12 elements", "90x24": "90 x 24 elements", "180x48": "180 x 48 elements"}


def figures_of(rows, tire):
    """(quantity, (value, interval), unit, how)"""
    side, camber, driven = (select(rows, study, tire) for study in ("slip_angle", "camber", "hard_slip"))
    for size, degrees in ((0.00873, 0.5), (0.01745, 1.0)):
        stiffness, aligning = (chord(side, "slip_angle_rad", size, force) for force in ("Fy_N", "Mz_Nm"))
        trail = aligning[0] / stiffness[0]
        yield f"cornering stiffness, {degrees:g} degrees", stiffness, "N/rad", "-Fy/alpha"
        yield f"aligning stiffness, {degrees:g} degrees", aligning, "N m/rad", "Mz/alpha"
        yield (f"pneumatic trail, {degrees:g} degrees",
               (trail, trail * math.hypot(*(error / value for value, error in (stiffness, aligning)))), "m", "-Mz/Fy")
    small = [float(r["sigma_m"]) for r in side if 1e-3 < abs(float(r["slip_angle_rad"])) < LINEAR
             and not math.isnan(float(r["sigma_m"]))]
    if small:
        yield ("relaxation length, start with a slip angle", spread(small), "m",
               f"fits of the side force of {len(small)} runs up to 1 degree")
    for size, degrees in ((0.04363, 2.5), (0.08727, 5.0)):
        yield (f"camber stiffness, {degrees:g} degrees", chord(camber, "camber_angle_rad", size, "Fy_N"), "N/rad",
               "-Fy/gamma")
    near = [r for r in driven if -0.001 < r["setting"] < 0.011]
    if len(near) > 1:
        yield ("slip stiffness", line(column(near, "setting"), column(near, "Fx_N")), "N",
               f"line through {len(near)} runs, slip 0 to 1 %")
    if (step := series_of(f"{tire}_step_of_1_degree", 0.64)) is not None:
        yield ("relaxation length, step of 1 degree",
               spread([relaxation(step, 0.3, 0.01, reach)["sigma"] for reach in (0.9, 1.1, 1.35)]), "m",
               "fits from 0.12 m to 0.9, 1.1, 1.35 m; half the range")
    for check, what in CHECKS.items():
        if (series := series_of(f"{tire}_toe_1_{check}", 0.5)) is not None:
            (force, moment), (later, later_moment) = ([steady(series, source, begin)["end"] for _, source in FITTED]
                                                      for begin in (0.2, 0.28))
            yield (f"cornering stiffness, 1 degree, {what}", (abs(force) / 0.01745, abs(force - later) / 0.01745),
                   "N/rad", "-Fy/alpha")
            yield (f"pneumatic trail, 1 degree, {what}",
                   (-moment / force, abs(moment / force - later_moment / later)), "m", "-Mz/Fy")


def energies(tire):
    """Revolutions and their mean energy (kinetic + strain) on the finest mesh of revolutions.csv."""
    file = HERE / "revolutions.csv"
    if not file.exists():
        return []
    rows = [row for row in provenance.read_table(file)
            if tire_of(row["tire"]) == tire and row["mesh"] == "60x12" and int(row["revolution"]) > 0]
    return [(int(row["revolution"]), float(row["energy_mean_J"])) for row in rows]


def draw(rows):
    figure, axes = driver.subplots(2, 3, figsize=(13.5, 7.6))
    (force, moment, thrust), (pull, relaxed, energy) = axes
    for tire, marker in (("layered", "o"), ("lumped", "s")):
        side, camber, slip = (select(rows, study, tire) for study in ("slip_angle", "camber", "hard_slip"))
        look = {"marker": marker, "label": tire}
        for axis, of, angle, name, scale in ((force, side, "slip_angle_rad", "Fy_N", 1e-3),
                                             (moment, side, "slip_angle_rad", "Mz_Nm", 1.0),
                                             (thrust, camber, "camber_angle_rad", "Fy_N", 1.0)):
            if of:
                axis.errorbar(np.degrees(column(of, angle)), scale * column(of, f"steady_{name}"),
                              scale * column(of, f"steady_interval_{name}"), capsize=2, **look)
        if slip:
            pull.plot(column(slip, "setting"), column(slip, "Fx_N") / 1e3, **look)
        if (step := series_of(f"{tire}_step_of_1_degree", 0.64)) is not None:
            fit = relaxation(step, 0.3, 0.01, 1.2)
            drawn, = relaxed.plot(fit["s"], fit["y"], lw=0.8, alpha=0.6, label=f"{tire}, σ = {fit['sigma']:.3f} m")
            s = np.linspace(CONTACT, 1.3)
            relaxed.plot(s, fit["end"] - fit["size"] * np.exp(-s / fit["sigma"]), "--", color=drawn.get_color())
        if turns := energies(tire):
            energy.plot([k for k, _ in turns], [value - turns[0][1] for _, value in turns], **look)
    for axis, x, y in ((force, "slip angle, degrees", "lateral force, kN"),
                       (moment, "slip angle, degrees", "aligning moment, N m"),
                       (thrust, "camber angle, degrees", "lateral force, N"),
                       (pull, "slip (undeformed radius)", "longitudinal force, kN"),
                       (relaxed, "distance after a step of 1 degree, m", "lateral force, N"),
                       (energy, "revolution at 8 m/s", "mean energy of tire less the first's, J")):
        driver.label(axis, x, y, legend=8)
        axis.axhline(0.0, color="0.8", zorder=0)
        axis.set_visible(bool(axis.get_legend_handles_labels()[0]))
    figure.suptitle("Hard ground, 200 kPa, 60 × 12 elements, 4 m/s, friction 0.9", x=0.01, ha="left", fontweight="bold")
    figure.tight_layout()
    driver.save(figure, "cornering")


def main():
    driver.options(__doc__).parse_args()
    rows = sweep_rows()
    if not rows:
        sys.exit(f"no finished sweep under {RESULTS}")
    made = provenance.origin_of_runs(file.parent for study in SWEEPS
                                     for file in (RESULTS / study / "runs").glob("*/summary.json"))
    driver.write("cornering.csv", [row | {"setting": str(row["setting"])} for row in rows], made, 6)
    derived = [{"tire": tire, "quantity": quantity, "value": f"{value:.5g}", "interval": f"{interval:.2g}",
                "unit": unit, "how": how} for tire in ("layered", "lumped")
               for quantity, (value, interval), unit, how in figures_of(rows, tire)]
    driver.write("cornering_figures.csv", derived, made, told=True)
    draw(rows)


if __name__ == "__main__":
    main()
