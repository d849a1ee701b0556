#!/usr/bin/python3
"""The small rig on both engines of grains, from the same beds: engine dem in double precision without sleep, and engine
liggghts on 1, 2 and 4 ranks.

usage: two_engines.py [--seeds 1 2 3 4 5] [--ranks 1 2 4] [--keep]     writes two_engines.csv beside this script, line
by line

--keep: the table's lines of other numbers of ranks stay; the column commit says which program made each line.

A line for each run: drawbar pull with its standard error over the averaging window, resistance of the terrain, sinkage,
residuals, and how long the forces on the tire are those of engine dem from the same bed: largest difference over the
load in the first 0.1 s after the first contact, and the time after the first contact at which it exceeds 1e-9 and 1e-3.
Chaos multiplies the round-off by which the two programs differ. Lines without a seed are means over the beds with half
the width of their 95 % interval (Student), and of the difference to engine dem of the same bed. processor_s is that of
all processes; other work may have run beside.
"""
import math

import numpy as np

import driver
import provenance
from driver import HERE, mean_of

FIGURES = {"pull_N": ("drawbar_pull_N", 1.0), "resistance_N": ("terrain_resistance_N", 1.0),
           "sinkage_mm": ("sinkage_m", 1e3)}
EARLY = 0.1  # s after the first contact
COLUMNS = ["engine", "ranks", "seed", "pull_N", "pull_sem_N", "resistance_N", "sinkage_mm", "steady", "energy_residual",
           "momentum_residual", "transfer_force_residual", "transfer_moment_residual", "early_difference",
           "above_1e-9_s", "above_1e-3_s", "wall_s", "processor_s", "commit"]
TABLE = HERE / "two_engines.csv"


def folder(engine, ranks, seed):
    return driver.RESULTS / "two_engines" / f"{engine}_{ranks}_{seed}"


def run(engine, ranks, seed, commit):
    """Its processor time, s"""
    keys = {"terrain.precision": "double", "terrain.activity": False} if engine == "dem" else \
        {"terrain.engine": "liggghts", "terrain.ranks": ranks}
    out = folder(engine, ranks, seed)
    _, processor, _ = driver.timed("run", "rigs/drawbar_pull_small_report_soil.json", "--out", out, "--overwrite",
                                   "--no-plots", *driver.settings(keys, {"run.seed": seed, "output.frame_interval": 0}))
    provenance.record_run(out, commit)
    return processor


def forces(out):
    table = driver.series(out)
    return table["time_s"], np.stack([table[f"force_{axis}_N"] for axis in "xyz"], axis=1)


def row_of(engine, ranks, seed, processor_s, commit):
    out = folder(engine, ranks, seed)
    summary = driver.summary(out)
    row = {"engine": engine, "ranks": ranks, "seed": seed, "pull_sem_N": summary["drawbar_pull_N"]["sem"],
           "steady": summary["drawbar_pull_N"].get("steady", ""), "processor_s": processor_s, "commit": commit,
           **{column: factor * mean_of(summary[key]) for column, (key, factor) in FIGURES.items()},
           **{column: summary[column] for column in ("wall_s", "transfer_force_residual", "transfer_moment_residual")},
           **{f"{account}_residual": summary["accounts"][account]["residual_share"]
              for account in ("energy", "momentum")}}
    if engine != "dem":
        time, reference = forces(folder("dem", 1, seed))
        first = time[np.argmax(np.abs(reference).max(axis=1) > 0.0)]
        difference = np.linalg.norm(forces(out)[1] - reference, axis=1) / summary["vertical_load_N"]
        row["early_difference"] = difference[time <= first + EARLY].max()
        for bound in ("1e-9", "1e-3"):
            above = difference > float(bound)
            row[f"above_{bound}_s"] = time[np.argmax(above)] - first if above.any() else math.inf
    return row


def kept_rows(cases):
    """Of the table, of those runs that are not made again; mean lines are made of them anew."""
    for line in provenance.read_table(TABLE):
        if line["seed"].isdigit() and (line["engine"], int(line["ranks"])) not in cases:
            numbers = {key: float(value) for key, value in line.items()
                       if value and key in (*FIGURES, "wall_s", "processor_s")}
            yield {"commit": provenance.read_origin(TABLE)["commit"], **{key: value for key, value in line.items()
                   if value}, **numbers, "ranks": int(line["ranks"]), "seed": int(line["seed"])}


def pooled(rows, engine, ranks):
    mine = {row["seed"]: row for row in rows if (row["engine"], row["ranks"]) == (engine, ranks)}
    dem = {row["seed"]: row for row in rows if row["engine"] == "dem"}
    for what, beds, less in (("beds", mine.keys(), 0.0), ("less dem", mine.keys() & dem.keys(), 1.0)):
        if (less and engine == "dem") or len(beds) < 2:
            continue
        line = {"engine": engine, "ranks": ranks, "seed": f"{len(beds)} {what}"}
        for column in FIGURES:
            mean, half = driver.over_beds([mine[bed][column] - (less * dem[bed][column] if less else 0.0)
                                           for bed in sorted(beds)])
            line[column] = f"{mean:.4g} ± {half:.2g}"
        yield line


def main():
    arguments = driver.options(__doc__, seeds={"nargs": "+", "type": int, "default": [1, 2, 3, 4, 5]},
                               ranks={"nargs": "+", "type": int, "default": [1, 2, 4]},
                               keep={"action": "store_true"}).parse_args()
    made = provenance.made_here()
    cases = [("dem", 1), *(("liggghts", ranks) for ranks in arguments.ranks)]
    rows = list(kept_rows(cases)) if arguments.keep else []
    all_cases = sorted({*cases, *((row["engine"], row["ranks"]) for row in rows)})
    for case in cases:
        for seed in arguments.seeds:
            rows.append(row_of(*case, seed, run(*case, seed, made["commit"]), made["commit"]))
            print(rows[-1], flush=True)
            of_runs = sorted(rows, key=lambda row: (row["engine"], row["ranks"], row["seed"]))
            driver.write(TABLE, of_runs + [line for one in all_cases for line in pooled(rows, *one)], made,
                         names=COLUMNS)


if __name__ == "__main__":
    main()
