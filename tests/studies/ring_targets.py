#!/usr/bin/python3
"""Load–deflection curves of a shell tire on a plate and on cleats, to which rigs/calibrate_ring.json fits the flexible
ring and which it predicts: tire/data/press_<tire>_<case>.csv, and the contact pressure along the shell's centre line,
ring_targets_pressure.csv beside this script.

usage: ring_targets.py [--run] [--tire lumped] [--mesh 90x24] [--only CASE …]

--run presses first what this build of the program has not pressed yet (see CASES).
"""
import numpy as np

import driver
import provenance
from driver import ROOT

FITTED_TO = 0.024  # m, of the plate's curve; what is deeper is held out
LOAD = 4561.65     # N, of the centre line


def cleat(width, *words):
    return ("--on", "cleat", "--cleat-height", 0.1, "--cleat-width", width, "--deflection", 0.04, "--points", 10,
            *words)


PLATE = ("--on", "plate", "--deflection", 0.032, "--points", 8, "--load", LOAD)
LOW = ("--set", "tire.pressure=120e3")
CASES = {  # in the order in which they are worth most
    "plate": PLATE, "cleat51": cleat(0.051), "cleat100": cleat(0.1), "cleat25": cleat(0.025), "cleat38": cleat(0.038),
    "cleat76": cleat(0.076), "plate_120kPa": (*PLATE, *LOW), "cleat51_120kPa": cleat(0.051, *LOW)}


def words_of(tire, mesh, case):
    around, across = map(int, mesh.split("x"))
    return ["rigs/cleat_press.json",
            *driver.settings({"tire.elements_circumference": around, "tire.elements_width": across}),
            "--set", f"tire.file=hmmwv_{tire}.json", *CASES[case]]


def write_curve(name, rows, made):
    driver.write(ROOT / "tire" / "data" / f"press_{name}.csv",
                 [{key: float(row[key]) for key in ("deflection_m", "force_N")} for row in rows], made, 9)


def centre_line(folder, cell):
    """Mean pressure by distance along, over the middle quarter of the footprint's width: x in m, Pa."""
    foot = driver.columns(folder / "footprint.csv")
    middle = foot[np.abs(foot["y_m"]) <= 0.25 * np.max(np.abs(foot["y_m"]))]
    place = np.rint(middle["x_m"] / cell).astype(int)
    for k in sorted(set(place)):
        here = middle[place == k]
        yield {"x_m": float(cell * k),
               "pressure_Pa": float(np.sum(here["pressure_Pa"] * here["area_m2"]) / np.sum(here["area_m2"]))}


def main():
    arguments = driver.options(__doc__, run={"action": "store_true"}, mesh={"default": "90x24"},
                               tire={"default": "lumped", "choices": ("lumped", "layered")},
                               only={"nargs": "+", "choices": CASES, "default": list(CASES)}).parse_args()
    tire, mesh, made_at = arguments.tire, arguments.mesh, provenance.commit()
    for case in arguments.only:
        words, folder = words_of(tire, mesh, case), driver.RESULTS / "ring_targets" / f"{tire}_{mesh}" / case
        if arguments.run:
            driver.kept(folder, "press", *words, made_at=made_at)
        if not (summary := driver.summary(folder)):
            continue
        origin = provenance.origin_of_runs([folder])
        origin["command"] = f"ring_targets.py --run --tire {tire} --mesh {mesh} --only {case}"
        origin["note"] = f"furrow press {' '.join(map(str, words))}; the loading"
        if not summary["stable_while_pressed"]:
            origin["note"] += ("; the tire buckles on the way, loading and unloading differ by "
                               f"{summary['loading_unloading_difference']:.2g} of the largest force")
        rows, name = driver.press_curve(folder), f"{tire}_{case}"
        if case != "plate":
            write_curve(name, rows, origin)
            continue
        fitted = rows["deflection_m"] <= FITTED_TO + 1e-9
        write_curve(name, rows[fitted], origin)
        write_curve(name + "_deeper", rows[~fitted], origin)
        cell = 2 * np.pi * 0.47 / int(mesh.split("x")[0]) / 3  # three points along an element
        driver.write("ring_targets_pressure.csv", list(centre_line(folder, cell)), origin, 5)


if __name__ == "__main__":
    main()
