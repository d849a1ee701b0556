#!/usr/bin/python3
"""What moves the pull of the small rig: every variant of budget.json on five beds, beside the scenario as it is.

usage: budget.py [--only VARIANT ...] [--results DIR] [--table]

Writes two tables beside the study: budget_runs.csv, a line a run, and budget.csv, a line a variant: mean over the beds,
half of its 95 % interval (Student), and its difference from the reference. Variants of one soil have the soil's own
reference, all others `base`. Where a variant runs on the very beds of its reference (it changes no key of the terrain
but those that leave the bed alone) the difference is taken bed by bed, otherwise between the means (Welch). Finished
runs are used again as long as this build of the program would make them from the same scenario. The tables are written
when all variants are done; --table makes them of what there is.
"""
import json
import math
import pathlib
import re
import statistics
import sys

import driver
import provenance
import run_study
from driver import over_beds, value_of
from furrow.plot.student import student

STUDY = pathlib.Path(__file__).with_suffix(".json")
COLUMNS = ("drawbar_pull_N.mean", "drawbar_pull_N.sem", "drawbar_pull_N.n_eff", "drawbar_pull_N.steady", "sinkage_m",
           "sinkage_sem_m", "rut_depth_m", "tractive_effort_N", "terrain_resistance_N", "tire_deflection_m",
           "bed_clearance_m", "vertical_load_N", "accounts.energy.turnover", "accounts.energy.residual_share",
           "accounts.energy.sample_error", "accounts.momentum.largest", "accounts.momentum.residual_share", "grains",
           "active_share_mean", "scenario_digest", "state_hash", "settle_wall_s", "wall_s")
FIGURES = {"pull_N": ("drawbar_pull_N.mean", 1.0), "sinkage_mm": ("sinkage_m", 1e3), "rut_mm": ("rut_depth_m", 1e3),
           "tractive_effort_N": ("tractive_effort_N", 1.0), "resistance_N": ("terrain_resistance_N", 1.0)}
SAME_BED = {"terrain.substeps", "terrain.activity"}  # of the terrain's keys
REFERENCES = {"20 kPa": "20 kPa, tire 200 kPa", "40 kPa": "40 kPa, tire 200 kPa"}


def reference_of(variant):
    return REFERENCES.get(variant.split(",")[0], "base")


def same_beds(cases, variant):
    def bed(name):
        return {key: value for key, value in cases[name]["set"].items()
                if key.startswith("terrain.") and key not in SAME_BED}
    return bed(variant) == bed(reference_of(variant))


def difference(these, those, paired):
    """Mean of a figure {seed: value} over that of the reference, and half of its 95 % interval."""
    if paired:
        changes = [value - those[seed] for seed, value in these.items() if seed in those]
        return over_beds(changes) if changes else (None, None)
    if min(len(these), len(those)) < 2:
        return None, None
    a, b = ((statistics.mean(v.values()), statistics.variance(v.values()) / len(v), len(v)) for v in (these, those))
    error = a[1] + b[1]
    freedom = error**2 / (a[1]**2 / (a[2] - 1) + b[1]**2 / (b[2] - 1))  # Welch, Biometrika 34 (1947) 28
    return a[0] - b[0], student(max(1, math.floor(freedom))) * math.sqrt(error)


def line_of(study, found, variant):
    beds, base = found[variant], found.get(reference_of(variant), {})
    paired = same_beds(study["cases"], variant)
    steady = [value_of(summary, "drawbar_pull_N.steady") for summary in beds.values()]
    line = {"variant": variant, "beds": len(beds), "not_steady": steady.count(False),
            "reference": reference_of(variant), "paired": "yes" if paired else "no"}
    for name, (path, scale) in FIGURES.items():
        values, those = ({seed: scale * value_of(summary, path) for seed, summary in runs.items()
                          if value_of(summary, path) is not None} for runs in (beds, base))
        line[name], line[f"{name}_half_95"] = over_beds(list(values.values())) if values else (None, None)
        line[f"{name}_change"], line[f"{name}_change_half_95"] = (
            difference(values, those, paired) if variant != reference_of(variant) else (None, None))
    return line


def write_tables(study, folders):
    """@param folders {(variant, seed): folder of the run}"""
    found = {}
    for (variant, seed), folder in folders.items():
        found.setdefault(variant, {})[seed] = driver.summary(folder)
    origin = provenance.origin_of_runs(folders.values()) | {"command": STUDY.with_suffix(".py").name}
    rows = [{"variant": variant, "seed": seed, **{path: value_of(summary, path) for path in COLUMNS}}
            for variant, beds in found.items() for seed, summary in beds.items()]
    driver.write("budget_runs.csv", rows, origin, 6)
    driver.write("budget.csv", [line_of(study, found, variant) for variant in found], origin)


def main():
    arguments = driver.options(
        __doc__, table={"action": "store_true", "help": "run nothing"}, only={"nargs": "*", "help": "of variants"},
        results={"type": pathlib.Path, "default": driver.RESULTS / "budget", "help": "where the folders of runs are"},
    ).parse_args()
    study = json.loads(STUDY.read_text())
    if unknown := set(arguments.only or []) - set(study["cases"]):
        sys.exit(f"{STUDY.name}: has no variant '{min(unknown)}', expected one of: {', '.join(study['cases'])}")
    folders, failed = {}, []
    for variant, case in study["cases"].items():
        for seed in range(1, study["seeds"] + 1):
            name = re.sub("[,/ ]", lambda c: {"/": "by", " ": "_"}.get(c[0], ""), variant)
            out = arguments.results / f"{name}-{seed}"
            words = run_study.scenario_of(study, {"set": {**case["set"], "run.seed": seed}})
            chosen = not arguments.table and (not arguments.only or variant in arguments.only)
            if not driver.stale_because(words, out) or (chosen and
                                                        driver.run_case(f"{variant}, seed {seed}", words, out)):
                folders[variant, seed] = out
            elif chosen:
                failed.append(f"{variant}, seed {seed}")
    if folders and (arguments.table or len(folders) == study["seeds"] * len(study["cases"])):
        write_tables(study, folders)
    if failed:
        sys.exit(f"failed: {'; '.join(failed)}")


if __name__ == "__main__":
    main()
