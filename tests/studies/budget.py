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
import argparse
import json
import math
import pathlib
import statistics
import sys

import provenance
import run_study
from provenance import ROOT, read_json

sys.path.insert(0, str(ROOT / "scripts"))
from plot.student import student  # noqa: E402

STUDY = pathlib.Path(__file__).with_suffix(".json")
COLUMNS = ("drawbar_pull_N.mean", "drawbar_pull_N.sem", "drawbar_pull_N.n_eff",
           "drawbar_pull_N.steady", "sinkage_m", "sinkage_sem_m",
           "rut_depth_m", "tractive_effort_N", "terrain_resistance_N",
           "tire_deflection_m", "bed_clearance_m", "vertical_load_N",
           "accounts.energy.turnover", "accounts.energy.residual_share",
           "accounts.energy.sample_error", "accounts.momentum.largest",
           "accounts.momentum.residual_share", "grains", "active_share_mean",
           "scenario_digest", "state_hash", "settle_wall_s", "wall_s")
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


def interval(values):
    """(mean, standard deviation, half of the 95 % interval); None for what two values do not give."""
    n = len(values)
    if n < 2:
        return (values[0] if values else None), None, None
    deviation = statistics.stdev(values)
    return statistics.mean(values), deviation, student(n - 1) * deviation / math.sqrt(n)


def difference(these, those, paired):
    """Mean of a figure {seed: value} over that of the reference, and half of its 95 % interval."""
    if paired:
        mean, _, half = interval([value - those[seed] for seed, value in these.items() if seed in those])
        return mean, half
    if min(len(these), len(those)) < 2:
        return None, None
    a, b = ((statistics.mean(v), statistics.variance(v) / len(v), len(v))
            for v in (list(these.values()), list(those.values())))
    error = a[1] + b[1]
    freedom = error**2 / (a[1]**2 / (a[2] - 1) + b[1]**2 / (b[2] - 1))  # Welch, Biometrika 34 (1947) 28
    return a[0] - b[0], student(max(1, math.floor(freedom))) * math.sqrt(error)


def summaries(folders):
    """{variant: {seed: summary}}"""
    found = {}
    for (variant, seed), folder in folders.items():
        found.setdefault(variant, {})[seed] = read_json(folder / "summary.json")
    return found


def line_of(study, found, variant):
    beds = found[variant]
    base = found.get(reference_of(variant), {})
    paired = same_beds(study["cases"], variant)
    steady = [run_study.value_of(s, "drawbar_pull_N.steady") for s in beds.values()]
    line = {"variant": variant, "beds": len(beds), "not_steady": steady.count(False),
            "reference": reference_of(variant), "paired": "yes" if paired else "no"}
    for name, (path, scale) in FIGURES.items():
        values = {seed: scale * run_study.value_of(s, path) for seed,
                  s in beds.items() if run_study.value_of(s, path) is not None}
        those = {seed: scale * run_study.value_of(s, path) for seed,
                 s in base.items() if run_study.value_of(s, path) is not None}
        line[name], _, line[f"{name}_half_95"] = interval(list(values.values()))
        if variant != reference_of(variant):
            line[f"{name}_change"], line[f"{name}_change_half_95"] = difference(values, those, paired)
    return {key: f"{value:.4g}" if isinstance(value, float) else value for key, value in line.items()}


def write_tables(study, folders):
    found = summaries(folders)
    origin = provenance.origin_of_runs(folders.values())
    origin["command"] = STUDY.with_suffix(".py").name
    rows = [{"variant": variant, "seed": seed, **{path: run_study.value_of(summary, path) for path in COLUMNS}}
            for variant, beds in found.items() for seed, summary in beds.items()]
    for row in rows:
        row.update({key: f"{value:.6g}" for key, value in row.items() if isinstance(value, float)})
    provenance.write_table(STUDY.with_name("budget_runs.csv"), ["variant", "seed", *COLUMNS], rows, origin)
    columns = ["variant", "beds", "not_steady", "reference", "paired"]
    for name in FIGURES:
        columns += [name, f"{name}_half_95", f"{name}_change", f"{name}_change_half_95"]
    provenance.write_table(STUDY.with_suffix(".csv"), columns, [line_of(study, found, variant) for variant in found],
                           origin)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="*", help="names of variants")
    parser.add_argument("--results", type=pathlib.Path, default=ROOT / "results" / "studies" / "budget",
                        help="where the folders of runs are")
    parser.add_argument("--table", action="store_true", help="run nothing")
    arguments = parser.parse_args()
    study = json.loads(STUDY.read_text())
    for name in arguments.only or []:
        if name not in study["cases"]:
            sys.exit(f"{STUDY.name}: has no variant '{name}', expected one of: {', '.join(study['variants'])}")
    folders, failed = {}, []
    for variant, case in study["cases"].items():
        for seed in range(1, study["seeds"] + 1):
            out = arguments.results / f"{variant.replace(' ', '_').replace('/', 'by').replace(',', '')}-{seed}"
            scenario = run_study.scenario_of(study, {"set": {**case["set"], "run.seed": seed}})
            stale = run_study.stale_because(scenario, out)
            chosen = not arguments.table and (not arguments.only or variant in arguments.only)
            if stale and (not chosen or not run_study.run_case(f"{variant}, seed {seed}", scenario, out)):
                if chosen:
                    failed.append(f"{variant}, seed {seed}")
                continue
            folders[variant, seed] = out
    if folders and (arguments.table or len(folders) == study["seeds"] * len(study["cases"])):
        write_tables(study, folders)
    if failed:
        sys.exit(f"failed: {'; '.join(failed)}")


if __name__ == "__main__":
    main()
