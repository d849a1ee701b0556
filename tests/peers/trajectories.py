#!/usr/bin/python3
"""Early trajectories: the same falling grains in the engine and in LIGGGHTS, until they part and why.

usage: trajectories.py OUT [--grains 2000] [--end 0.2] [--step 2e-5] [--seed 1]

Both start from the same positions, the engine half a step of free fall before (LIGGGHTS's velocity Verlet stands at
whole steps), and the floor has no friction. Cases: LIGGGHTS against itself with the bed shifted along a periodic side,
which parts by round-off alone; without friction between grains; with LIGGGHTS's tangential law in the engine, whole and
with one difference put back at a time; the engine as it is. OUT/trajectories.csv: time, then mean and greatest distance
between the same grains per case, m. OUT/trajectories.json: when the mean passes 1e-12 … 1e-4 m, when grains first
touch, what is left at the end.
"""
import csv
import json
import pathlib

import numpy

from common import (ALL_SWITCHES, FREE, RADIUS, SWITCHES, driver, folder_name, nearest, program, random_spheres,
                    record_program, run_furrow, run_liggghts)

SIDE = 20 * RADIUS  # m, periodic
FILL = 0.28  # share of the space that the spheres take at the start
MARKS = [1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4]  # m


def distance(a, b):
    """Between the same grains, nearest image, m: time × grain."""
    d = nearest(a - b, (SIDE, SIDE), (True, True))
    return numpy.sqrt((d * d).sum(axis=-1))


def compared(a, kinds, x, job, box):
    """({case: (frames, frames beside them)}, the series of the engine as it is)"""
    def own(name, **more):
        return run_furrow(a.out / "runs" / folder_name(name), job, kinds, x, **more)

    def theirs(name, **more):
        """With the tangential law of LIGGGHTS."""
        return own(name, **{"switches": ALL_SWITCHES, "damper_mass": "full", **more})[0]

    def peer(name, x=x, **more):
        return run_liggghts(a.out / "runs" / folder_name(name), "deck_fall.in", kinds, x, box, step=a.step,
                            steps=job["steps"], every=job["every"], **{"wall_friction": 0.0, **more})[0]

    liggghts, (as_it_is, series) = peer("liggghts"), own("own")
    whole, mixed, away = theirs("theirs"), own("mixed", precision="mixed")[0], [0.3 * SIDE, 0.0, 0.0]
    moved = x + away
    moved[:, 0] %= SIDE
    shifted = peer("liggghts shifted", x=moved) - away
    cases = {"LIGGGHTS, bed shifted sideways": (shifted, liggghts),
             "no friction": (own("smooth", friction=0.0)[0], peer("liggghts smooth", friction=0.0)),
             "tangential law of LIGGGHTS": (whole, liggghts)}
    if program("liggghts_with_pull"):
        cases["the same with cohesion 80 kPa"] = (theirs("theirs cohesive", cohesion=80e3),
                                                  peer("liggghts cohesive", cohesion=80e3))
    for name, bit in SWITCHES.items():
        cases["but not: " + name] = (theirs(name, switches=ALL_SWITCHES - bit), liggghts)
    cases |= {"but not: damper of m*": (theirs("damper", damper_mass="sliding"), liggghts),
              "but not: springs end with contact": (whole, peer("liggghts stale", clear=False)),
              "but not: frictionless floor": (theirs("floor", wall_friction=0.9),
                                              peer("liggghts floor", wall_friction=0.9)),
              "the engine as it is": (as_it_is, liggghts), "the engine, mixed precision": (mixed, liggghts),
              "mixed against double precision": (mixed, as_it_is)}
    return cases, series


def main():
    a = driver.options(__doc__, grains={"type": int, "default": 2000}, frames={"type": int, "default": 200},
                       end={"type": float, "default": 0.2, "help": "s"}, seed={"type": int, "default": 1},
                       step={"type": float, "default": 2e-5, "help": "s"})
    a.add_argument("out", type=pathlib.Path)
    a = a.parse_args()
    a.out.mkdir(parents=True, exist_ok=True)
    record_program(a.out)
    height = a.grains * 4.0 / 3.0 * numpy.pi * RADIUS**3 / (FILL * SIDE * SIDE)
    x = random_spheres(a.grains, SIDE, SIDE, 1.5 * RADIUS, 1.5 * RADIUS + height, a.seed)
    steps, cell = round(a.end / a.step), {"length": SIDE, "width": SIDE}
    every = max(1, steps // a.frames)
    job = {"test": "fall", "step": a.step, "steps": steps, "every": every, "precision": "double", "wall_friction": 0.0,
           **cell}
    cases, series = compared(a, [FREE] * a.grains, x, job, {"height": 2.0 * height, **cell})

    time = a.step * every * numpy.arange(len(cases["the engine as it is"][0]))
    columns, summary = {"time_s": time}, {}
    for name, (mine, other) in cases.items():
        d = distance(mine, other)
        mean, most = d.mean(axis=1), d.max(axis=1)
        columns[f"mean: {name}"], columns[f"max: {name}"] = mean, most
        passes = {f"{m:g}": next((round(float(t), 6) for t, v in zip(time, mean) if v > m), None) for m in MARKS}
        summary[name] = {"mean_passes_m_at_s": passes, "final_mean_m": float(mean[-1]), "final_max_m": float(most[-1]),
                         "final_mean_height_difference_m": float((mine[-1][:, 2].mean() - other[-1][:, 2].mean()))}
        print(name, {k: v and round(v, 3) for k, v in passes.items()}, f"{mean[-1]:.2e}", flush=True)
    with open(a.out / "trajectories.csv", "w") as out:
        csv.writer(out, lineterminator="\n").writerow(columns)
        for row in zip(*columns.values()):
            out.write(",".join(f"{v:.4g}" for v in row) + "\n")
    facts = {"grains": a.grains, "step_s": a.step, "seed": a.seed, "cases": summary,
             "first_contacts_s": float(series["time_s"][numpy.argmax(series["contacts"] > 0)])}
    (a.out / "trajectories.json").write_text(json.dumps(facts, indent=1) + "\n")


if __name__ == "__main__":
    main()
