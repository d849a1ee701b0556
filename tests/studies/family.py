#!/usr/bin/python3
"""Three tires on three grounds: what runs, what it gives, and what a simulated second costs. Writes family.csv beside
this script.

usage: family.py [--only TEST …] [--tires TIRE …] [--grounds GROUND …] [--seeds N] [--finished]

Tests: plate and cleat (`furrow press`: secant stiffness under 4561.65 N; force 20 mm deep on a cleat 51 mm wide),
drawbar (the rig of rigs/drawbar_pull_small_report_soil.json at slip 0.3: pull and sinkage), curb (the wheel of a
quarter car over a step of 30 mm at 2 m/s: largest vertical force). A line is one figure of one tire on one ground.
`beds` is the number of seeds of grains behind it, `standard_error` that of their mean; grounds without grains have one
run. `cpu_s_per_s` is the processor time of all ranks for a simulated second, settled bed apart. `beside` is the line's
value over that of the reference, less one: of the shell on plate, cleat and curb, of the shell on grains for the
drawbar. A tire that does not run has a line that says why.

With --finished nothing is computed: the table holds the lines whose runs this build has made.
"""
import statistics

import numpy as np

import driver
import provenance
from driver import read_json

TIRES = {"shell": "hmmwv_lumped.json", "ring": "hmmwv_ring.json", "planar": "aligator_planar.json"}
OTHERS = ("planar",)  # not the tire of the shell's file: nothing stands beside it
MESH = {"tire.elements_circumference": 60, "tire.elements_width": 12}
GROUNDS = ("rigid", "scm", "dem")
TESTS = ("plate", "cleat", "drawbar", "curb")
COLUMNS = ("test", "ground", "tire", "file", "figure", "value", "unit",
           "beds", "standard_error", "beside", "cpu_s_per_s", "why_not")
# Beds of the planar tire, which is 1 m wide and rolls farther; its step is explicit, not 5e-4 s.
WIDE = {"terrain.width": 1.4, "terrain.length": 3.6, "run.step": 6e-5}
DEEP = 0.02  # m: the deflection on the cleat
CLEAT = ("--cleat-width", "0.051", "--cleat-height", "0.1")
RIGS = {"rigid": "rigid_ground.json", "scm": "drawbar_pull_scm.json", "dem": "drawbar_pull_small_report_soil.json"}
CURB = {"terrain.profile": [[2, 0], [2.0001, 0.03]], "rig.speed": 2, "rig.body_mass": 415, "rig.unsprung_mass": 36,
        "rig.suspension_stiffness": 80e3, "rig.suspension_damping": 4e3, "run.end": 1.6, "run.average_from": 1.4,
        "output.frame_interval": 0}


def words_of(test, ground, tire, seed):
    """Of the command line."""
    keys = MESH if tire == "shell" else {"tire.contact_tangent": False}
    if test in ("plate", "cleat"):
        scenario, keys = "rigid_ground.json", {**keys, "tire.pressure": None}
    elif test == "curb":
        scenario, keys = "curb.json", {**keys, **CURB}
    else:
        scenario, keys = RIGS[ground], {**keys, "tire.pressure": None, "run.seed": seed, "output.frame_interval": 0}
        if ground == "rigid":
            keys |= {"rig.slip": 0.3, "rig.angular_speed": 4.28}
        elif tire == "planar":
            keys |= WIDE
    words = [f"rigs/{scenario}", "--set", f"tire.file={TIRES[tire]}", *driver.settings(keys)]
    if test in ("plate", "cleat"):
        return ["press", *words, "--on", test, "--deflection", DEEP, "--points", 8, *(CLEAT if test == "cleat" else ())]
    return ["run", *words]


def figures_of(test, folder):
    summary = driver.summary(folder)
    if test == "drawbar":
        return {("drawbar pull", "N"): summary["drawbar_pull_N"]["mean"], ("sinkage", "m"): summary["sinkage_m"]}
    if test == "curb":
        series = driver.series(folder)
        return {("largest vertical force", "N"): float(np.max(series["force_z_N"][series["position_m"] > 1.0]))}
    curve = driver.press_curve(folder)
    found = {(f"force at {1e3 * DEEP:g} mm", "N"): float(np.interp(DEEP, curve["deflection_m"], curve["force_N"]))}
    return found | ({("secant stiffness", "N/m"): summary["secant_stiffness_N_per_m"]} if test == "plate" else {})


def cost(folder):
    """Processor time of all ranks over the simulated time; nothing of a static test."""
    ranks = driver.summary(folder).get("ranks")
    return sum(rank["cpu_s"] for rank in ranks) / read_json(folder / "scenario.json")["run"]["end"] if ranks else None


def lines_of(test, ground, tire, arguments):
    about, folders = {"test": test, "ground": ground, "tire": tire, "file": TIRES[tire]}, []
    for seed in range(1, 1 + (arguments.seeds if ground == "dem" else 1)):
        folder = driver.RESULTS / "family" / "_".join([test, ground, tire, str(seed)])
        try:
            if driver.kept(folder, *words_of(test, ground, tire, seed), finished_only=arguments.finished):
                folders.append(folder)
        except SystemExit as error:
            why = next((line for line in str(error).splitlines() if "error" in line), str(error))
            return [about | {"why_not": why.rsplit("furrow: error: ", 1)[-1].replace(f"{driver.ROOT}/", "")}]
    found = [figures_of(test, folder) for folder in folders]
    costs = [c for folder in folders if (c := cost(folder)) is not None]
    rows = []
    for name, unit in found[0] if found else ():
        values = [figures[name, unit] for figures in found]
        error = statistics.stdev(values) / len(values) ** 0.5 if len(values) > 1 else None
        rows.append(about | {"figure": name, "unit": unit, "value": statistics.mean(values),
                             "beds": len(values) if ground == "dem" else "", "standard_error": driver.short(error, 3),
                             "cpu_s_per_s": driver.short(statistics.mean(costs), 3) if costs else ""})
    return rows


def main():
    arguments = driver.options(__doc__, only={"nargs": "+", "choices": TESTS, "default": TESTS},
                               tires={"nargs": "+", "choices": tuple(TIRES), "default": tuple(TIRES)},
                               grounds={"nargs": "+", "choices": GROUNDS, "default": GROUNDS},
                               seeds={"type": int, "default": 1}, finished={"action": "store_true"}).parse_args()
    made = provenance.made_here()
    rows = [row for test in arguments.only for ground in arguments.grounds if test == "drawbar" or ground == "rigid"
            for tire in arguments.tires for row in lines_of(test, ground, tire, arguments)]
    reference = {(r["test"], r["figure"]): r["value"] for r in rows if "figure" in r and r["tire"] == "shell"
                 and r["ground"] == ("dem" if r["test"] == "drawbar" else "rigid")}
    for row in rows:
        of = reference.get((row["test"], row.get("figure")))
        if of and row["tire"] not in OTHERS:
            row["beside"] = f"{row['value'] / of - 1.0:.3f}"
    driver.write("family.csv", rows, made, 5, COLUMNS)


if __name__ == "__main__":
    main()
