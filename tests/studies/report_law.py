#!/usr/bin/python3
"""The contact law of the 2016 report on the small rig: does it turn the trends of its Figs 8, 16 and 20?

usage: report_law.py [shear] [rig] [passes] [factors] [small_steps] [full_size] [janosi] [--seeds 1 2 …] [--finished]

`shear`: direct shear at 0.05 to 4 m/s with the report's law at three steps, and with `mindlin`, three beds each;
writes report_law_shear.csv. `rig`: drawbar_pull_small_report_soil.json at the report's rim speed of 4 m/s on a bed of
6 m over slip and cohesion; writes report_law.csv, a row for each bed, report_law_slopes.csv, and
report_law_resistance.csv, the resistance against time at four cohesions (Fig. 13). `passes`: three passes
in one rut; writes report_law_passes.csv. `factors`: what turns the trend of Fig. 8, one change at a time from the rig's
runs: pull at slips 0.1 and 0.7; writes report_law_factors.csv. `small_steps`: the rig at steps of 3, 6 and 20 µs on
the first bed, for the law as it is printed; writes report_law_small_steps.csv. `full_size`: the ends of Figs 8, 15 and
16 with the report's grains of 6 mm, layered tire and step, drawbar_pull_tr.json, on the first bed; writes
report_law_full_size.csv. `janosi`: the tractive effort that the shear strength at the speed of sliding would give,
beside the rig's; runs nothing and writes report_law_janosi.csv.

Expected, written down before the first run: a trend agrees with the report's if the 95 % interval of the slope over
beds excludes zero with the report's sign: pull grows with slip (Fig. 8), tractive effort falls with cohesion (Fig. 16),
pull grows with the number of passes (Fig. 20).
"""
import math

import driver
import provenance

RIG = str(driver.ROOT / "rigs" / "drawbar_pull_small_report_soil.json")
LAW = {"terrain.law": "hertz_tanh", "terrain.normal_stiffness": 1e6, "terrain.normal_damping": 60,
       "terrain.friction_velocity_scale": 5, "terrain.friction_impulse_limit": False,
       "terrain.allow_unstable_step": True}
FAST = {"rig.angular_speed": 8.56, "terrain.length": 6.0, "run.end": 1.2, "run.average_from": 0.6,
        "output.frame_interval": 0}
SLIPS = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
COHESIONS = (40e3, 50e3, 60e3, 70e3, 90e3, 100e3)  # Pa; the scenario has slip 0.3 and 80 kPa
CASES = {f"slip {slip:g}": {"rig.slip": slip} for slip in SLIPS} | {
    f"cohesion {cohesion / 1e3:g} kPa": {"terrain.cohesion": cohesion} for cohesion in COHESIONS}
# cohesion and rest between passes (s)
PASSES = {"cohesion 80 kPa": ({}, 0.2), "cohesion 40 kPa": ({"terrain.cohesion": 40e3}, 0.2),
          "80 kPa, rest 0 s": ({}, 0.0), "80 kPa, rest 1 s": ({}, 1.0)}
SLOW = {"rig.angular_speed": 4.28, "run.end": 1.8, "run.average_from": 0.9}
STIFF = {"terrain.normal_stiffness": 5.17e6}  # N/m^1.5, of the scenario's 1e8 Pa at 10 mm
DOUBLE = {"terrain.friction_velocity_scale": 10}  # s/m
FACTORS = {
    "report's law": LAW, "speed 2 m/s": LAW | SLOW, "c = 10 s/m": LAW | DOUBLE,
    "speed 2 m/s, c = 10 s/m": LAW | SLOW | DOUBLE, "impulse limit": LAW | {"terrain.friction_impulse_limit": True},
    "stiffness of 1e8 Pa": LAW | STIFF, "mindlin": {}, "mindlin, speed 2 m/s": SLOW,
    "mindlin, stiffness of 1e6 N/m^1.5": {"terrain.young_modulus": 1.93e7}}
# step (s): cases, end (s); means begin at its half
SMALL_STEPS = {6e-6: (("slip 0.1", "slip 0.9", "slip 0.5", "cohesion 40 kPa", "cohesion 100 kPa"), 1.2),
               3e-6: (("slip 0.1", "slip 0.9"), 0.6), 20e-6: (("slip 0.1", "slip 0.9"), 1.2)}
FULL = str(driver.ROOT / "rigs" / "drawbar_pull_tr.json")
FULL_SIZE = ("slip 0.1", "slip 0.7", "cohesion 40 kPa", "cohesion 100 kPa", "slip 0.9")
FIGURES = {"pull_N": "drawbar_pull_N", "gross_N": "tractive_effort_N", "resistance_N": "terrain_resistance_N",
           "sinkage_mm": "sinkage_m", "rut_mm": "rut_depth_m"}
OVER_TIME = {40: "cohesion 40 kPa", 60: "cohesion 60 kPa", 80: "slip 0.3", 100: "cohesion 100 kPa"}  # kPa: case
MEAN = 0.05  # s, of a point over time
RADIUS, SPEED, LOAD = 0.4673, 4.0, 4608.0  # of the rig: m, m/s of the rim, N
# law, settings, step (s), cohesions (Pa), speeds (m/s)
SHEAR = (("hertz_tanh", LAW, 60e-6, (40e3, 80e3), (0.05, 0.2, 1.0, 4.0)),
         ("hertz_tanh", LAW, 20e-6, (80e3,), (0.2, 1.0, 4.0)),
         ("hertz_tanh", LAW, 5e-6, (80e3,), (1.0, 4.0)),
         ("hertz_tanh, c = 10 s/m", LAW | {"terrain.friction_velocity_scale": 10}, 60e-6, (80e3,), (0.2, 1.0)),
         ("mindlin", {}, 60e-6, (80e3,), (0.05, 0.2, 1.0, 4.0)))


def near_50_kpa(tests):
    """One test of each bed."""
    of_bed = {}
    for test in sorted(tests, key=lambda test: -abs(test["normal_stress_Pa"] - 5e4)):
        of_bed[test["seed"]] = test
    return list(of_bed.values())


def shear():
    rows, made = [], provenance.made_here()
    for law, changed, step, cohesions, speeds in SHEAR:
        for cohesion in cohesions:
            for speed in speeds:
                case = {"law": law, "step_us": step * 1e6, "cohesion_kPa": cohesion / 1e3, "speed_m_s": speed}
                out = driver.RESULTS / "report_law_shear" / "_".join(str(value) for value in case.values())
                out = out.with_name(out.name.replace(" ", "_").replace(",", "").replace("/", "_"))
                words = driver.settings(changed, {"run.step": step, "terrain.cohesion": cohesion})
                found = driver.read_json(driver.kept(out, "soil", RIG, "--only", "shear", "--speed", speed, *words)
                                         / "soil.json")
                middle = near_50_kpa(found["shear"]["tests"])
                ratios = [test["final_shear_stress_Pa"] / test["normal_stress_Pa"] for test in middle]
                mean, half = driver.over_beds(ratios)
                rows.append(case | {"beds": len(middle), "final_shear_over_normal_stress": mean, "half": half,
                                    "phi_deg": found["friction_angle_deg"],
                                    "phi_final_deg": found["final_friction_angle_deg"],
                                    "c_final_kPa": found["final_cohesion_Pa"] / 1e3,
                                    "K_mm": found["janosi_K_m"] * 1e3,
                                    "floor_force_error": found["shear"]["floor_force_error"]})
                driver.write("report_law_shear.csv", rows, made)


def slope(points):
    """Of a straight line through (x, y)."""
    n, x, y = len(points), sum(x for x, _ in points), sum(y for _, y in points)
    return ((n * sum(a * b for a, b in points) - x * y) / (n * sum(a * a for a, _ in points) - x * x))


def folder_of(part, case, seed):
    return driver.RESULTS / part / f"{case}_{seed}".replace(" ", "_").replace("/", "_")


def run_of(part, case, seed, finished, *changed, of=RIG):
    """The summary of a run of the rig; None where it has failed or must not run."""
    words = [of, *driver.settings(FAST, *changed, {"run.seed": seed})]
    out = folder_of(part, case, seed)
    return driver.summary(out) if driver.done_run(words, out, finished) else None


def row_of(case, seed, summary):
    return {"case": case, "seed": seed, "slip": CASES[case].get("rig.slip", 0.3),
            "cohesion_kPa": CASES[case].get("terrain.cohesion", 80e3) / 1e3, **driver.drawbar_row(summary, FIGURES)}


def rig(seeds, finished):
    rows, made = [], provenance.made_here()
    for seed in seeds:
        for case, changed in CASES.items():
            if summary := run_of("report_law", case, seed, finished, LAW, changed):
                rows.append(row_of(case, seed, summary))
                driver.write("report_law.csv", rows, made)
    trends = (("Fig. 8: pull, N for each unit of slip", "slip ", "slip", "pull_N"),
              ("Fig. 16: tractive effort, N for each kPa", "cohesion ", "cohesion_kPa", "gross_N"),
              ("Fig. 15: resistance, N for each kPa", "cohesion ", "cohesion_kPa", "resistance_N"))
    slopes = []
    for trend, kind, x, y in trends:
        of_bed = {}
        for row in rows:
            if row["case"].startswith(kind) or kind == "cohesion " and row["case"] == "slip 0.3":
                of_bed.setdefault(row["seed"], []).append((row[x], row[y]))
        most = max(map(len, of_bed.values()))
        values = [slope(points) for points in of_bed.values() if len(points) == most]
        mean, half = driver.over_beds(values)
        slopes.append({"trend": trend, "beds": len(values), "points": most, "slope": mean, "half_of_95_%": half})
    driver.write("report_law_slopes.csv", slopes, made)
    resistance(seeds, finished, made)


def resistance(seeds, finished, made):
    """Means of MEAN seconds over beds: touch-down, and whether the end is steady."""
    import numpy
    rows = {}
    for kpa, case in OVER_TIME.items():
        of_bed = []
        for seed in seeds:
            if run_of("report_law", case, seed, finished, LAW, CASES[case]):
                series = driver.series(folder_of("report_law", case, seed))
                place = (series["time_s"] / MEAN).astype(int)
                of_bed.append([series["terrain_resistance_N"][place == k].mean() for k in range(place[-1])])
        for k, values in enumerate(zip(*of_bed)):
            mean, half = driver.over_beds([float(value) for value in values])
            rows.setdefault(k, {"time_s": (k + 0.5) * MEAN}).update(
                {f"resistance_{kpa}_kPa_N": mean, f"half_{kpa}_kPa_N": half})
    if rows:
        driver.write("report_law_resistance.csv", rows.values(), made)


def passes(cases, seeds):
    """Rows of other cases and beds stay in the table; each row has the commit of its program."""
    name, made = "report_law_passes.csv", provenance.made_here()
    for case in cases:
        changed, rest = PASSES[case]
        for seed in seeds:
            study = {"format_version": 1, "scenario": RIG, "set": LAW | FAST | changed | {"run.seed": seed},
                     "passes": 3, "rest": rest}
            out = driver.kept(folder_of("report_law_passes", case, seed), "sweep", scenario=study)
            before = provenance.read_origin(driver.HERE / name)
            if "note" in before:
                made["note"] = before["note"]
            rows = [{"commit": before["commit"]} | row for row in provenance.read_table(driver.HERE / name)
                    if (row["case"], row["seed"]) != (case, str(seed))]
            for run in provenance.read_table(out / "sweep.csv"):
                rows.append({"case": case, "seed": seed, "pass": run["pass"],
                             **driver.drawbar_row(driver.summary(out / run["folder"]), FIGURES),
                             "commit": made["commit"]})
            driver.write(name, rows, made)


def factors(seeds, finished):
    rows, made = [], provenance.made_here()
    for seed in seeds:
        for case, changed in FACTORS.items():
            for slip in (0.1, 0.7):
                summary = run_of("report_law_factors", f"{case} {slip:g}", seed, finished, changed, {"rig.slip": slip})
                if summary:
                    rows.append({"case": case, "slip": slip, "seed": seed, **driver.drawbar_row(summary, FIGURES)})
                    driver.write("report_law_factors.csv", rows, made)


def small_steps(seed, finished):
    rows, made = [], provenance.made_here()
    for step, (cases, end) in SMALL_STEPS.items():
        for case in cases:
            at_step = "report_law_small_steps", f"{case} {step * 1e6:g} us", seed
            if summary := run_of(*at_step, finished, LAW, CASES[case], {
                    "run.step": step, "run.end": end, "run.average_from": 0.5 * end}):
                energy, series = summary["accounts"]["energy"], driver.series(folder_of(*at_step))
                early = (series["time_s"] >= 0.3) & (series["time_s"] <= 0.6)
                rows.append({"case": case, "step_us": round(step * 1e6), "seed": seed,
                             "slip": CASES[case].get("rig.slip", 0.3),
                             "cohesion_kPa": CASES[case].get("terrain.cohesion", 80e3) / 1e3,
                             "pull_0.3_to_0.6_s_N": series["drawbar_pull_N"][early].mean(), "from_s": 0.5 * end,
                             **driver.drawbar_row(summary, FIGURES), "sliding_loss_J": energy["lost"]["sliding_loss"],
                             "energy_residual_J": energy["residual"], "energy_turnover_J": energy["turnover"],
                             "energy_closes": int(energy["closes"])})
                driver.write("report_law_small_steps.csv", rows, made)


def full_size(seed, finished):
    rows, made = [], provenance.made_here()
    for case in FULL_SIZE:
        if summary := run_of("report_law_full_size", case, seed, finished, CASES[case], of=FULL):
            rows.append(row_of(case, seed, summary))
            driver.write("report_law_full_size.csv", rows, made)


def over_speed(rows, speed, column):
    """A value of the shear tests between their speeds, linear in ln speed; the slowest and fastest beyond."""
    points = [(math.log(float(row["speed_m_s"])), float(row[column])) for row in rows]
    at = min(max(math.log(speed), points[0][0]), points[-1][0])
    for (a, left), (b, right) in zip(points, points[1:]):
        if at <= b:
            return left + (right - left) * (at - a) / (b - a)


def janosi(made):
    """H = W τ/σ (1 − K/(s L) (1 − exp(−s L/K))) [Wong 2008, §2.4] with τ/σ and K at the sliding speed s v, and the
    length of contact of a rigid wheel at the rig's sinkage z, L = √(2 R z)."""
    shear = [row for row in provenance.read_table(driver.HERE / "report_law_shear.csv") if row["cohesion_kPa"] == "80"]
    first_bed = [row | {"step_us": "60"} for row in provenance.read_table(driver.HERE / "report_law.csv")]
    found = first_bed + provenance.read_table(driver.HERE / "report_law_small_steps.csv")
    rows = []
    for row in found:
        tests = [test for test in shear if test["law"] == "hertz_tanh" and test["step_us"] == row["step_us"]]
        slip = float(row["slip"])
        if row["seed"] != "1" or not row["case"].startswith("slip ") or slip == 0 or not tests:
            continue
        length = math.sqrt(2 * RADIUS * 1e-3 * float(row["sinkage_mm"]))

        def thrust(speed):
            ratio, k = (over_speed(tests, speed, column) for column in ("final_shear_over_normal_stress", "K_mm"))
            way = slip * length / (1e-3 * k)
            return ratio, k, LOAD * ratio * (1 + math.expm1(-way) / way)
        ratio, k, force = thrust(slip * SPEED)
        rows.append({"step_us": row["step_us"], "slip": slip, "sliding_m_s": slip * SPEED, "shear_over_normal": ratio,
                     "K_mm": k, "length_mm": 1e3 * length, "janosi_N": force,
                     "janosi_at_the_speed_of_slip_0.1_N": thrust(0.1 * SPEED)[2], "gross_N": float(row["gross_N"])})
    driver.write("report_law_janosi.csv", rows, made)


def main():
    parser = driver.options(__doc__, seeds={"type": int, "nargs": "+", "default": [1, 2, 3, 4, 5]},
                            finished={"action": "store_true"},
                            cases={"nargs": "+", "default": list(PASSES), "help": "of passes"})
    parser.add_argument("parts", nargs="*", default=["shear", "rig", "passes", "factors", "small_steps", "full_size",
                                                    "janosi"])
    arguments = parser.parse_args()
    if "shear" in arguments.parts:
        shear()
    if "rig" in arguments.parts:
        rig(arguments.seeds, arguments.finished)
    if "passes" in arguments.parts:
        passes(arguments.cases, arguments.seeds)
    if "factors" in arguments.parts:
        factors(arguments.seeds, arguments.finished)
    if "small_steps" in arguments.parts:
        small_steps(arguments.seeds[0], arguments.finished)
    if "full_size" in arguments.parts:
        full_size(arguments.seeds[0], arguments.finished)
    if "janosi" in arguments.parts:
        janosi(provenance.made_here())


if __name__ == "__main__":
    main()
