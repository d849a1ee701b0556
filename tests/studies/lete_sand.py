#!/usr/bin/python3
"""The shipped example on LETE sand: pull against slip, and what else its answer depends on, over five beds.

usage: lete_sand.py [slip] [variants] [--seeds 1 2 …] [--cases NAME …] [--finished]

`slip` runs drawbar_pull_small.json at slips from -0.1 to 0.8 on a bed long enough for all of them and writes
lete_sand_slip.csv; `variants` runs it with one thing changed at a time and writes lete_sand_variants.csv. A row is one
bed, or, without a seed, the mean over the beds with half of its 95 % interval; of a variant, the difference from the
shipped case on the same beds. Rows that the program of this commit has written are kept. --finished runs nothing and
writes the tables of what has run so far.

Expected, written down before the first run: net traction at slip 0 below zero; a fall of the pull from its peak to slip
0.7 of less than 15 %; gross traction at slip 0.2 within 20 % of the WES regression.
"""
import driver
import provenance

RIG = str(driver.ROOT / "rigs" / "drawbar_pull_small.json")
SLIPS = (-0.1, 0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8)
ALWAYS = {"output.frame_interval": 0}
LONG = {"terrain.length": 4.7}  # m
# How the soil's file packs its grains holds for its own solid fraction.
ANEW = {"terrain.settling_friction": None, "terrain.settling_cohesion": None}
VARIANTS = {
    "shipped": {},
    "step 15 µs": {"run.step": 1.5e-5},
    "layers 14": {"terrain.layers": 14},
    "layers 30": {"terrain.layers": 30},
    "width 0.9 m": {"terrain.width": 0.9},
    "radius 8 mm": {"terrain.radius": 0.008, "terrain.layers": 25, "run.step": 2.4e-5},
    "radius 12.5 mm": {"terrain.radius": 0.0125, "terrain.layers": 16},
    "stiffness x 1/2": {"terrain.young_modulus": 5e7},
    "stiffness x 4": {"terrain.young_modulus": 4e8, "run.step": 1.5e-5},
    "solid fraction 0.58": {"terrain.solid_fraction": 0.58} | ANEW,
    "solid fraction 0.62": {"terrain.solid_fraction": 0.62} | ANEW,
    "half the speed": {"rig.angular_speed": 2.14, "run.end": 3.0, "run.average_from": 1.2},
}
FIGURES = {"pull_N": "drawbar_pull_N", "gross_N": "tractive_effort_N", "resistance_N": "terrain_resistance_N",
           "torque_Nm": "drive_torque_Nm", "sinkage_mm": "sinkage_m", "rut_mm": "rut_depth_m",
           "slip_of_free_rolling": "slip_of_free_rolling", "slip_of_no_pull": "slip_of_no_pull"}
OVER_BEDS = ("pull_N", "gross_N", "sinkage_mm")  # with their intervals
REGRESSIONS = ("wes_sand", "mason", "brixius_bias", "brixius_radial", "wismer_luth")


def row_of(summary, seed):
    row = {"seed": seed, **driver.drawbar_row(summary, FIGURES)}
    for name in REGRESSIONS if summary.get("regressions") else ():
        of = summary["regressions"][name]
        row |= {f"{name}_gross_N": of["gross_N"], f"{name}_net_N": of["net_N"]}
    return row | {key: summary[key] for key in ("grains", "settle_wall_s", "wall_s")}


def pooled(rows, base=None):
    """The mean over beds, or that of the differences from the rows of `base` with the same seeds."""
    of_seed = {row["seed"]: row for row in base or ()}
    mine = [row for row in rows if not base or row["seed"] in of_seed]
    out = {"beds": len(mine), "steady": sum(row["steady"] for row in mine)}
    for column in mine[0].keys() - {"seed", "steady", "sem_N"}:
        values = [row[column] - (of_seed[row["seed"]][column] if base else 0.0) for row in mine
                  if row[column] is not None]
        if len(values) == len(mine):
            mean, half = driver.over_beds(values)
            out |= {column: mean} | ({f"{column}_half": half} if column in OVER_BEDS else {})
    return out


def table(name, label, cases, seeds, finished, paired):
    """Runs the cases {label: settings} bed by bed, so that every case has beds early on."""
    rows, made = {case: [] for case in cases}, provenance.made_here()
    before = driver.rows_before(name, made, label, "seed")
    names = [label, "seed", "beds", "steady", "sem_N"]
    for column in FIGURES:
        names += [column, f"{column}_half"] if column in OVER_BEDS else [column]
    for seed in seeds:
        for case, changed in cases.items():
            if row := before.get((str(case), str(seed))):
                rows[case].append({key: value for key, value in row.items()
                                   if key not in ("beds", label) and not key.endswith("_half")})
                continue
            words = [RIG, *driver.settings(ALWAYS, changed, {"run.seed": seed})]
            out = driver.RESULTS / "lete_sand" / f"{label}_{case}_{seed}".replace(" ", "_").replace("/", "_")
            if driver.done_run(words, out, finished):
                rows[case].append(row_of(driver.summary(out), seed))
        kept = {case: mine for case, mine in rows.items() if mine}
        means = [{label: case, **pooled(mine)} for case, mine in kept.items()]
        if paired and "shipped" in kept:
            means += [{label: f"{case}, difference", **pooled(mine, kept["shipped"])} for case, mine in kept.items()
                      if case != "shipped"]
        told = [{label: case, **row} for case, mine in kept.items() for row in mine]
        if told:
            columns = names + [key for key in told[0] if key not in names]
            driver.write(name, [*told, *means], made, names=columns)


def main():
    parser = driver.options(__doc__, seeds={"type": int, "nargs": "+", "default": [1, 2, 3, 4, 5]},
                            finished={"action": "store_true"}, cases={"nargs": "+", "help": "variants to run"})
    parser.add_argument("parts", nargs="*", default=["slip", "variants"])
    arguments = parser.parse_args()
    if "slip" in arguments.parts:
        table("lete_sand_slip.csv", "slip", {slip: LONG | {"rig.slip": slip} for slip in SLIPS}, arguments.seeds,
              arguments.finished, paired=False)
    if "variants" in arguments.parts:
        cases = {case: VARIANTS[case] for case in arguments.cases or VARIANTS}
        table("lete_sand_variants.csv", "case", cases, arguments.seeds, arguments.finished, paired=True)


if __name__ == "__main__":
    main()
