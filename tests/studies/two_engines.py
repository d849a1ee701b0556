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
import argparse
import math
import os
import pathlib
import resource
import statistics
import subprocess
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "scripts"))
import provenance  # noqa: E402
from plot.student import half_interval  # noqa: E402
from provenance import ROOT  # noqa: E402

RIG = str(ROOT / "rigs" / "drawbar_pull_small.json")
FIGURES = {"pull_N": ("drawbar_pull_N", 1.0), "resistance_N": ("terrain_resistance_N", 1.0),
           "sinkage_mm": ("sinkage_m", 1e3)}
EARLY = 0.1  # s after the first contact
COLUMNS = ["engine", "ranks", "seed", "pull_N", "pull_sem_N", "resistance_N", "sinkage_mm", "steady", "energy_residual",
           "momentum_residual", "transfer_force_residual", "transfer_moment_residual",
           "early_difference", "above_1e-9_s",
           "above_1e-3_s", "wall_s", "processor_s", "commit"]
TABLE = HERE / "two_engines.csv"


def folder(engine, ranks, seed):
    return ROOT / "results" / "studies" / "two_engines" / f"{engine}_{ranks}_{seed}"


def run(engine, ranks, seed, commit):
    out = folder(engine, ranks, seed)
    keys = ["terrain.precision=double", "terrain.activity=false"] if engine == "dem" else \
        ["terrain.engine=liggghts", f"terrain.ranks={ranks}"]
    words = [provenance.program(), "run", RIG, "--set", f"run.seed={seed}", "--set", "output.frame_interval=0"]
    for key in keys:
        words += ["--set", key]
    begin = processor_time()
    subprocess.run([*words, "--out", str(out), "--overwrite", "--no-plots"], check=True, stdout=subprocess.DEVNULL,
                   env=dict(os.environ, FURROW_HOME=str(ROOT)))
    provenance.record_run(out, commit)
    return processor_time() - begin


def processor_time():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def forces(out):
    table = np.genfromtxt(out / "timeseries.csv", delimiter=",", names=True)
    return table["time_s"], np.stack([table[f"force_{axis}_N"] for axis in "xyz"], axis=1)


def mean_of(value):
    return value["mean"] if isinstance(value, dict) else value


def row_of(engine, ranks, seed, processor_s, commit):
    out = folder(engine, ranks, seed)
    summary = provenance.read_json(out / "summary.json")
    row = {"engine": engine, "ranks": ranks, "seed": seed, "pull_sem_N": summary["drawbar_pull_N"]["sem"],
           "steady": summary["drawbar_pull_N"].get("steady", ""), "wall_s": summary["wall_s"],
           "processor_s": processor_s,
           "commit": commit}
    for column, (key, factor) in FIGURES.items():
        row[column] = factor * mean_of(summary[key])
    for column in ("transfer_force_residual", "transfer_moment_residual"):
        row[column] = summary[column]
    for account in ("energy", "momentum"):
        row[f"{account}_residual"] = summary["accounts"][account]["residual_share"]
    if engine != "dem":
        time, reference = forces(folder("dem", 1, seed))
        _, here = forces(out)
        first = time[np.argmax(np.abs(reference).max(axis=1) > 0.0)]
        difference = np.linalg.norm(here - reference, axis=1) / summary["vertical_load_N"]
        row["early_difference"] = difference[time <= first + EARLY].max()
        for bound in ("1e-9", "1e-3"):
            above = difference > float(bound)
            row[f"above_{bound}_s"] = time[np.argmax(above)] - first if above.any() else math.inf
    return row


def kept_rows(cases):
    """Of the table, of those runs that are not made again; mean lines are made of them anew."""
    commit = provenance.read_origin(TABLE)["commit"]
    rows = []
    for line in provenance.read_table(TABLE):
        if line["seed"].isdigit() and (line["engine"], int(line["ranks"])) not in cases:
            numbers = {key: float(value) for key, value in line.items()
                       if value and key in (*FIGURES, "wall_s", "processor_s")}
            rows.append({"commit": commit, **{key: value for key, value in line.items() if value}, **numbers,
                         "ranks": int(line["ranks"]), "seed": int(line["seed"])})
    return rows


def pooled(rows, engine, ranks):
    mine = {row["seed"]: row for row in rows if (row["engine"], row["ranks"]) == (engine, ranks)}
    dem = {row["seed"]: row for row in rows if row["engine"] == "dem"}
    out = []
    for what, beds, value in (("beds", mine.keys(), lambda bed, column: mine[bed][column]),
                              ("less dem", mine.keys() & dem.keys(), lambda bed,
                               column: mine[bed][column] - dem[bed][column])):
        if (what == "less dem" and engine == "dem") or len(beds) < 2:
            continue
        line = {"engine": engine, "ranks": ranks, "seed": f"{len(beds)} {what}"}
        for column in FIGURES:
            values = [value(bed, column) for bed in sorted(beds)]
            line[column] = f"{statistics.mean(values):.4g} ± {half_interval(values):.2g}"
        out.append(line)
    return out


def write(rows, cases, made):
    text = [{key: f"{value:.4g}" if isinstance(value, float) else value for key, value in row.items()} for row in rows]
    for case in cases:
        text += pooled(rows, *case)
    provenance.write_table(TABLE, COLUMNS, [{c: row.get(c, "") for c in COLUMNS} for row in text], made)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", nargs="+", type=int, default=[1, 2, 3, 4, 5])
    parser.add_argument("--ranks", nargs="+", type=int, default=[1, 2, 4])
    parser.add_argument("--keep", action="store_true")
    arguments = parser.parse_args()
    made = provenance.made_here()
    cases = [("dem", 1), *(("liggghts", ranks) for ranks in arguments.ranks)]
    rows = kept_rows(cases) if arguments.keep else []
    all_cases = sorted({*cases, *((row["engine"], row["ranks"]) for row in rows)})
    for case in cases:
        for seed in arguments.seeds:
            rows.append(row_of(*case, seed, run(*case, seed, made["commit"]), made["commit"]))
            print(rows[-1], flush=True)
            write(sorted(rows, key=lambda row: (row["engine"], row["ranks"], row["seed"])), all_cases, made)


if __name__ == "__main__":
    main()
