#!/usr/bin/python3
"""Solid fractions asked for and reached. Beds of the sand of small_wheel.json 0.1 m deep, 0.3 m by 0.14 m, with three
radii of the grains and two rolling frictions, over what terrain.solid_fraction asks for. Writes packing.csv beside this
script.

One row a bed: the fraction asked for and reached, the lowest and highest of four layers of its middle, by how much it
grows under 20 % more gravity, the settling friction and drag that were found, grains and seconds. A row without a
fraction is a bed that these grains do not have; `refused` then holds the range that they have.
"""
import json
import re
import subprocess

import driver
import provenance

RADII = (0.005, 0.0035, 0.0025)
ROLLING = (0.2, 0.6)
FRACTIONS = (0.48, 0.50, 0.52, 0.54, 0.56, 0.58, 0.60, 0.62)
DEPTH, LAYER = 0.1, 1.35  # m, radii of a settled layer


def bed(radius, rolling, fraction):
    keys = {"terrain.length": 0.3, "run.end": 0.9, "terrain.radius": radius, "terrain.size_spread": 0,
            "terrain.layers": round(DEPTH / (LAYER * radius)), "terrain.rolling_friction": rolling,
            "terrain.substeps": 5, "terrain.solid_fraction": fraction}
    done = subprocess.run([provenance.program(), "bed", "rigs/small_wheel.json", *driver.settings(keys)],
                          cwd=driver.ROOT, capture_output=True, text=True)
    row = {"radius_m": radius, "rolling_friction": rolling, "asked": fraction}
    if done.returncode:
        refused = re.search(r"lie between ([\d.]+) and ([\d.]+)", done.stderr)
        return {**row, "refused": "%s to %s" % refused.groups() if refused else done.stderr[-200:]}
    found = json.loads(done.stdout)
    profile = found["solid_fraction_profile"]
    return {**row, "reached": found["solid_fraction_bulk"], "lowest": min(profile), "highest": max(profile),
            "more_at_1_2_g": found["solid_fraction_more_at_1_2_g"], "settling_friction": found["settling_friction"],
            "settling_drag": found["settling_drag"], "grains": found["grains"], "settled": int(found["settled"]),
            "wall_s": found["wall_s"]}


def main():
    driver.options(__doc__).parse_args()
    rows, made = [], provenance.made_here()
    for radius in RADII:
        for rolling in ROLLING:
            for fraction in FRACTIONS:
                rows.append(bed(radius, rolling, fraction))
                print(rows[-1], flush=True)
                driver.write("packing.csv", rows, made)


if __name__ == "__main__":
    main()
