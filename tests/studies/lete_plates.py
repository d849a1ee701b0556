#!/usr/bin/python3
"""Does the grains' LETE sand bear plates as Wong's table says? Strips of 100 and 200 mm are pushed into beds of three
packings. Writes lete_plates.csv beside this script; a test that is finished is used again.

A row is one packing and width: pressure at six sinkages, mean over three beds with half of its 95 % interval; n of the
fit p = (k_c/b + k_phi) z^n and k_c, k_phi, with standard errors; heaved over displaced volume. Rows without a solid
fraction are Wong's k_c, k_phi and n, of terrain/data/lete_sand.json.
"""
import statistics

import driver
import provenance
from lete_sand import ANEW, RIG

PACKINGS = {"0.52": {"terrain.solid_fraction": 0.52} | ANEW, "as fitted": {},
            "0.60": {"terrain.solid_fraction": 0.6} | ANEW}
SINKAGES = (10, 15, 20, 30, 50, 70)  # mm
NEAR = 0.0025  # m, over which pressures are averaged


def tested(packing, changed):
    out = driver.RESULTS / "lete_plates" / packing.replace(" ", "_")
    if not (out / "soil.json").exists():
        driver.furrow("soil", RIG, "--only", "plate", *driver.settings(changed), "--out", out, "--overwrite")
    return driver.read_json(out / "soil.json"), provenance.read_table(out / "plate.csv")


def pressures(table, width):
    """{sinkage in mm: (mean over beds, half of its 95 % interval)}, kPa"""
    of_bed = {}
    for row in table:
        if float(row["width_m"]) == width:
            of_bed.setdefault(row["seed"], []).append((float(row["sinkage_m"]), 1e-3 * float(row["pressure_Pa"])))
    return {z: driver.over_beds([statistics.mean(p for x, p in curve if abs(x - 1e-3 * z) < NEAR)
                                 for curve in of_bed.values()]) for z in SINKAGES}


def main():
    driver.options(__doc__).parse_args()
    rows, made = [], provenance.made_here()
    for packing, changed in PACKINGS.items():
        soil, table = tested(packing, changed)
        bed = soil["plate"]["beds"][0]
        for plate in soil["plate"]["plates"]:
            row = {"packing": packing, "solid_fraction": bed["box"]["solid_fraction"],
                   "width_mm": 1e3 * plate["size_m"]}
            for z, (mean, half) in pressures(table, plate["size_m"]).items():
                row |= {f"at_{z}_mm_kPa": mean, f"at_{z}_mm_half": half}
            for key in ("n", "k_c", "k_phi"):
                row |= {key: bed[key], f"{key}_se": bed["standard_error"][key]}
            rows.append(row | {"heaved_share": plate["heaved_share"],
                               "heaved_share_se": plate["standard_error"]["heaved_share"]})
    wong = driver.read_json(driver.ROOT / "terrain" / "data" / "lete_sand.json")["terrain"]
    n, k_c, k_phi = (wong[f"bekker_{key}"] for key in ("n", "k_c", "k_phi"))
    for width in (0.1, 0.2):
        rows.append({"packing": "Wong's table", "width_mm": 1e3 * width, "n": n, "k_c": k_c, "k_phi": k_phi}
                    | {f"at_{z}_mm_kPa": 1e-3 * (k_c / width + k_phi) * (1e-3 * z) ** n for z in SINKAGES})
    driver.write("lete_plates.csv", rows, made)


if __name__ == "__main__":
    main()
