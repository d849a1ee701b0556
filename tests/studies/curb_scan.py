#!/usr/bin/python3
"""Speed, damping of the tire and arrangement at the curb of rigs/curb.json: is there a run that leaves the ground and
whose centre stays below 0.3 m, as the paper's figure 7 shows both? Writes curb_scan.csv beside this script.

usage: curb_scan.py [--finished]

--finished runs nothing and writes what has run so far.
"""
import json

import driver
import provenance
from curb import Passage
from driver import RESULTS, ROOT, read_json

SPEEDS = (1.0, 1.5, 2.0, 3.0, 4.0, 6.0)  # m/s
VISCOSITIES = (100, 500, 2500)           # Pa s
PLACE = 10.0                             # m that a run covers
ARRANGEMENTS = {"quarter car": {}, "mass on the axle": {"rig.unsprung_mass": 1290, "rig.body_mass": 1}}


def main():
    finished = driver.options(__doc__, finished={"action": "store_true"}).parse_args().finished
    made, rows, folder = provenance.made_here(), [], RESULTS / "curb_scan"
    folder.mkdir(parents=True, exist_ok=True)
    for viscosity in VISCOSITIES:
        tire = read_json(ROOT / "tire" / "data" / "aligator_planar.json")
        tire["tire"]["viscosity"] = viscosity
        file = folder / f"viscosity_{viscosity}.json"
        file.write_text(json.dumps(tire), encoding="utf-8")
        for speed in SPEEDS:
            end = round(PLACE / speed + 0.15, 2)
            for name, masses in ARRANGEMENTS.items():
                words = [str(ROOT / "rigs" / "curb.json"), *driver.settings(masses, {
                    "rig.speed": speed, "tire.file": str(file), "run.end": end, "run.average_from": end - 0.3,
                    "output.frame_interval": 0})]
                out = folder / f"{name.replace(' ', '_')}_{speed:g}_{viscosity}"
                if not driver.done_run(words, out, finished):
                    continue
                figures = {what: (mine, simple) for what, _, mine, simple in Passage(name, out).figures()}
                mine = {what: of[0] for what, of in figures.items()}
                rows.append({"case": name, "speed_m_s": speed, "viscosity_Pas": viscosity,
                             "highest_m": 0.2 + mine["highest centre over the curb"],
                             "off_the_ground_s": mine["time off the ground"],
                             "least_force_of_load": mine["least force of the ground after the edge, of the load"],
                             "felt_before_edge_m": mine["contact with the curb begins, before the edge"],
                             "simple_highest_m": 0.2 + figures["highest centre over the curb"][1]})
                driver.write("curb_scan.csv", rows, made)


if __name__ == "__main__":
    main()
