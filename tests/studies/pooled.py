#!/usr/bin/python3
"""What the tables of the small rig say together: all beds of one case pooled, whatever else was changed in a run.
Writes pooled.csv beside this script and prints it.

usage: pooled.py [--out FILE]

The runs of the pool (slip 0.3, 80 kPa, bed 113 mm, flexible tire) differ in seed, travel, step, sleep, contact
tangents, bin and program, none of which is seen to change the pull. They are not independent: three seeds make three
beds (and mirrored ones), so two standard errors are given, of all runs as if each had a bed of its own, and of the
means of the seeds.

Single runs of other cases are set against the pool: `outside` says whether a run lies beyond the interval in which one
more run of the pool would lie 95 times in 100, mean ± t s √(1 + 1/n). That takes the scatter of the other case to be
the pool's.
"""
import argparse
import math
import pathlib
import statistics
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "scripts"))
import provenance  # noqa: E402
from plot.student import half_interval, student  # noqa: E402

# Runs of the pool: table, case or settings, seed. What the run changes besides is in the table itself.
POOL = [("behaviour", "base", 1), ("behaviour", "seed_2", 2), ("behaviour", "seed_3", 3), ("behaviour", "half_step", 1),
        ("behaviour", "mirrored", 1),
        *(("activity", f"seed_{seed}_{sleep}", seed) for seed in (1, 2, 3) for sleep in ("on", "off")),
        *(("tire_step", f"tau_5ms_step_4e-5_seed_{seed}", seed) for seed in (1, 2, 3)),
        ("tire_step_tangents", "tau_5ms_step_4e-5_seed_1", 1),
        *(("multipass", ("1", "80000.0", "9", str(seed)), seed) for seed in (1, 2, 3)),
        ("slip", ("80000.0", "0.3"), 1)]
DEEP = [("behaviour", "depth_x2", 1), *(("multipass", ("1", "80000.0", "18", str(seed)), seed) for seed in (1, 2, 3))]
SINGLE = [("behaviour", "rigid_tire"), ("behaviour", "width_0.9"), ("behaviour", "depth_x2"), ("behaviour", "slip_0.6"),
          *(("slip", ("80000.0", slip)) for slip in ("0.0", "0.1", "0.2", "0.5", "0.7", "0.9")),
          *(("step_size", f"mindlin_step_1{part}") for part in ("", "_2", "_4"))]
KEYS = {"multipass": ("pass", "terrain.cohesion", "terrain.layers", "run.seed"),
        "slip": ("terrain.cohesion", "rig.slip")}
PULL, SINKAGE = "drawbar_pull_N.mean", "sinkage_m"
COLUMNS = ["what", "unit", "runs", "seeds", "mean", "standard_deviation",
           "standard_error", "half_width_95", "half_width_95_of_seeds",
           "lowest", "highest", "not_steady", "outside"]


def row_of(table, case):
    """The line of a run."""
    for row in provenance.read_table(HERE / f"{table}.csv"):
        if (tuple(row[key] for key in KEYS[table]) if table in KEYS else row["case"]) == case:
            return row
    sys.exit(f"{table}.csv: has no case {case}")


def unsteady(rows):
    """How many say that they are not steady; tables without the column do not say it."""
    return sum(row.get("drawbar_pull_N.steady", "").lower() == "false" for row in rows)


def summary(what, unit, runs, key, factor=1.0):
    rows = [row_of(table, case) for table, case, _ in runs]
    values = [factor * float(row[key]) for row in rows]
    of_seed = {}
    for (_, _, seed), value in zip(runs, values):
        of_seed.setdefault(seed, []).append(value)
    return {"what": what, "unit": unit, "runs": len(values), "seeds": len(of_seed), "mean": statistics.mean(values),
            "standard_deviation": statistics.stdev(values),
            "standard_error": statistics.stdev(values) / math.sqrt(len(values)),
            "half_width_95": half_interval(values),
            "half_width_95_of_seeds": half_interval([statistics.mean(v) for v in of_seed.values()]),
            "lowest": min(values), "highest": max(values), "not_steady": unsteady(rows)}


def ratio(what, a, b):
    """a over b, less one, in per cent, with the standard error of the two means as if they were independent, and the 95
    % interval with as many degrees of freedom as the smaller one has."""
    mean = 100.0 * (a["mean"] / b["mean"] - 1.0)
    error = 100.0 * a["mean"] / b["mean"] * math.hypot(a["standard_error"] / a["mean"], b["standard_error"] / b["mean"])
    return {"what": what, "unit": "%", "runs": a["runs"] + b["runs"], "mean": mean, "standard_error": error,
            "half_width_95": student(min(a["runs"], b["runs"]) - 1) * error}


def single(table, case, pool):
    row = row_of(table, case)
    value, name = float(row[PULL]), case if isinstance(case, str) else ", ".join(f"{k} {v}" for k,
                                                                                 v in zip(KEYS[table], case))
    reach = student(pool["runs"] - 1) * pool["standard_deviation"] * math.sqrt(1.0 + 1.0 / pool["runs"])
    return {"what": f"pull, {table}.csv: {name}", "unit": "N", "runs": 1, "seeds": 1, "mean": value,
            "standard_error": float(row["drawbar_pull_N.sem"]), "not_steady": unsteady([row]),
            "outside": "yes" if abs(value - pool["mean"]) > reach else "no"}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, default=HERE / "pooled.csv")
    out = parser.parse_args().out
    pull, deep = summary("pull, bed 113 mm", "N", POOL, PULL), summary("pull, bed 226 mm", "N", DEEP, PULL)
    sinkage, deeper = (summary(f"sinkage, bed {d} mm", "mm", runs, SINKAGE, 1e3) for d,
                       runs in ((113, POOL), (226, DEEP)))
    reach = student(pull["runs"] - 1) * pull["standard_deviation"] * math.sqrt(1.0 + 1.0 / pull["runs"])
    rows = [pull, deep, sinkage, deeper, ratio("pull, bed 226 over 113 mm", deep, pull),
            ratio("sinkage, bed 226 over 113 mm", deeper, sinkage),
            {"what": "pull of one more run, bed 113 mm", "unit": "N", "runs": pull["runs"],
             "mean": pull["mean"], "half_width_95": reach},
            *(single(table, case, pull) for table, case in SINGLE)]
    for row in rows:
        for key, value in row.items():
            if isinstance(value, float):
                row[key] = f"{value:.4g}"
    tables = sorted({table for table, *_ in POOL + DEEP + SINGLE})
    origins = {table: provenance.read_origin(HERE / f"{table}.csv") for table in tables}
    made = {key: "; ".join(f"{table}.csv: {origins[table][key]}" for table in tables)
            for key in ("commit", "compiler", "processor")}
    for key in ("compiler", "processor"):
        values = {origins[table][key] for table in tables}
        made[key] = values.pop() if len(values) == 1 else made[key]
    made |= {"command": provenance.command(),
             "note": "pools tables of several programs on purpose; the runs are not independent"}
    provenance.write_table(out, COLUMNS, rows, made)
    for row in rows:
        print("; ".join(f"{key} {value}" for key, value in row.items()))


if __name__ == "__main__":
    main()
