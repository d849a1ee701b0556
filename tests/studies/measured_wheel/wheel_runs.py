#!/usr/bin/python3
"""A smooth laboratory wheel in dry sand, predicted before its measured forces were seen.

usage: wheel_runs.py fit | predict | write  MEASURED

MEASURED is a folder with what was measured: training_points.csv and conditions.csv. fit: three training points over the
friction between wheel and sand, two beds each; writes fit.csv and prints the friction that they give. predict: the
smooth wheel straight ahead at the other rim speeds, with that friction: three beds of the sand as calibrated, and one
each of a looser and a denser sand, of smaller grains, and of slower travel; writes runs.csv. write: predictions.csv of
runs.csv, with 95 % intervals.

The ratio of rim to travel speed is that of the measurement; the wheel travels ten times as fast. Finished runs stay in
results/studies/measured_wheel: the script goes on where it was stopped.
"""
import math
import pathlib
import statistics
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import driver
import provenance

TRAVEL = 0.010  # m/s, of the measured wheel
FRICTIONS = (0.2, 0.4, 0.6)
SAND = "grains_loose_dry_sand.json"
SEEDS = {"base": (1, 2, 3), "loose": (1,), "dense": (1,), "fine": (1,), "slow": (1,)}
ONLY = {"fine": (0.003, 0.013, 0.1), "slow": (0.013,)}  # rim speeds of these variants
FRACTIONS = {"loose": 0.490, "dense": 0.515}
TRIAL = {"pull": 0.3, "sinkage": 0.0008}  # standard deviations of three trials
T95 = 2.0  # Student's t of many degrees of freedom: most of the width is not the beds'
ZERO = 0.002  # of the sinkage, m, one standard deviation
HERE = pathlib.Path(__file__).resolve().parent
RESULTS = driver.RESULTS / "measured_wheel"


def words(variant, rim, load, friction, seed):
    """Of `furrow run`."""
    speed = 0.03 if variant == "slow" else 0.1
    radius = 0.0025 if variant == "fine" else 0.0035
    move = 0.26 / speed
    slip = max(1.0 - TRAVEL / rim, -10.0) if rim else -10.0
    keys = {"rig.mode": "fixed_speed", "rig.speed": speed, "rig.slip": slip, "rig.load": load,
            "run.end": round(0.4 + move, 3), "run.average_from": round(0.4 + 0.5 * move, 3), "run.seed": seed,
            "tire.friction": friction, "terrain.material": SAND, "terrain.radius": radius,
            "terrain.layers": round(0.15 / (1.32 * radius)), "terrain.length": 0.55, "terrain.width": 0.16,
            "terrain.substeps": 2 if radius > 0.003 else 3, "output.frame_interval": 0}
    if variant in FRACTIONS:
        keys["terrain.solid_fraction"] = FRACTIONS[variant]
    return ["rigs/small_wheel.json", *driver.settings(keys)]


def run(variant, rim, load, friction, seed):
    """One row."""
    out = RESULTS / f"{variant}_{1e3 * rim:g}_{friction:g}_{seed}"
    out = driver.kept(out, "run", *words(variant, rim, load, friction, seed))
    s = driver.summary(out)
    value = lambda name: driver.mean_of(s[name])
    return {"variant": variant, "rim_speed_m_s": rim, "vertical_force_N": load, "friction": friction, "seed": seed,
            "pull_N": value("drawbar_pull_N"), "sinkage_m": value("sinkage_m"), "torque_Nm": value("drive_torque_Nm"),
            "steady": int(s["drawbar_pull_N"]["steady"])}


def straight(name):
    """Rows of the smooth wheel straight ahead, of a measured file."""
    rows = [row for row in provenance.read_table(MEASURED / name)
            if row["wheel"] == "smooth" and float(row["slip_angle_deg"]) == 0]
    return [{key: float(value) for key, value in row.items() if key != "wheel"} for row in rows]


def points(name):
    """Rim speed, m/s, and vertical force, N."""
    return [(row["rim_speed_m_s"], row["vertical_force_N"]) for row in straight(name)]


def fitted(rows):
    """The friction with the least sum of squares of the pulls, on lines between those tried; and what is left."""
    def misses(friction):
        low = max(f for f in FRICTIONS if f <= friction and f < FRICTIONS[-1])
        high = FRICTIONS[FRICTIONS.index(low) + 1]
        for point in straight("training_points.csv"):
            at = {f: statistics.mean(r["pull_N"] for r in rows
                                     if (r["rim_speed_m_s"], r["friction"]) == (point["rim_speed_m_s"], f))
                  for f in (low, high)}
            yield at[low] + (at[high] - at[low]) * (friction - low) / (high - low) - point["pull_N"]
    steps = [FRICTIONS[0] + 0.01 * k for k in range(round((FRICTIONS[-1] - FRICTIONS[0]) / 0.01) + 1)]
    best = min(steps, key=lambda f: sum(m * m for m in misses(f)))
    return round(best, 2), list(misses(best))


def table(name):
    rows = provenance.read_table(HERE / name)
    return [{k: v if k == "variant" else float(v) for k, v in row.items()} for row in rows]


def fit():
    made = provenance.made_here()
    rows = []
    for seed in (1, 2):
        for friction in FRICTIONS:
            for rim, load in points("training_points.csv"):
                rows.append(run("base", rim, load, friction, seed))
                driver.write("measured_wheel/fit.csv", rows, made)
    friction, misses = fitted(rows)
    print(f"friction {friction}, pulls off by " + ", ".join(f"{m:.2f} N" for m in misses))


def predict():
    friction, _ = fitted(table("fit.csv"))
    made, rows = provenance.made_here(), []
    for variant, seeds in SEEDS.items():
        for rim, load in points("conditions.csv"):
            if rim in ONLY.get(variant, (rim,)):
                for seed in seeds:
                    rows.append(run(variant, rim, load, friction, seed))
                    driver.write("measured_wheel/runs.csv", rows, made)


def write():
    """95 % intervals about the mean of the base beds: t √(bed² + parameters² + size² + model² + trial² + zero²)."""
    training, rows = table("fit.csv"), table("runs.csv")
    friction, misses = fitted(training)
    near = min(FRICTIONS, key=lambda f: abs(f - friction))
    depths = [statistics.mean(r["sinkage_m"] for r in training
                              if (r["rim_speed_m_s"], r["friction"]) == (point["rim_speed_m_s"], near))
              - point["sinkage_m"] for point in straight("training_points.csv")]

    def mean(name, variant, rim):
        return statistics.mean(r[name] for r in rows if (r["variant"], r["rim_speed_m_s"]) == (variant, rim))

    def rms(values):
        return math.sqrt(statistics.mean(v * v for v in values))

    model = {"pull_N": rms(misses), "sinkage_m": rms(depths)}
    out = []
    for rim, load in points("conditions.csv"):
        row = {"wheel": "smooth", "slip_angle_deg": 0, "travel_speed_m_s": TRAVEL, "rim_speed_m_s": rim,
               "vertical_force_N": load}
        for name, trial, zero in (("pull_N", TRIAL["pull"], 0.0), ("sinkage_m", TRIAL["sinkage"], ZERO)):
            beds = [r[name] for r in rows if r["variant"] == "base" and r["rim_speed_m_s"] == rim]
            middle = statistics.mean(beds)
            spread = [statistics.stdev(beds), 0.5 * (mean(name, "dense", rim) - mean(name, "loose", rim)),
                      rms(mean(name, "fine", r) - mean(name, "base", r) for r in ONLY["fine"]),
                      model[name], trial, zero]
            half = T95 * math.sqrt(sum(s * s for s in spread))
            stem, unit = name.rsplit("_", 1)
            row |= {name: middle, f"{stem}_low_{unit}": middle - half, f"{stem}_high_{unit}": middle + half}
            if name == "pull_N":
                row |= {"side_force_N": 0.0, "side_force_low_N": -0.5, "side_force_high_N": 0.5}
        out.append(row)
    driver.write("measured_wheel/predictions.csv", out)


if __name__ == "__main__":
    stages = {"fit": fit, "predict": predict, "write": write}
    if len(sys.argv) != 3 or sys.argv[1] not in stages:
        sys.exit(__doc__)
    MEASURED = pathlib.Path(sys.argv[2])
    stages[sys.argv[1]]()
