#!/usr/bin/python3
"""Does the grains' LETE sand bear plates as Wong's table says? Strips of 100 and 200 mm are pushed into beds of grains.

usage: lete_plates.py [fit] [packings]

`fit` calibrates rolling friction, cohesion and packing to Wong's curve for 100 mm together with his friction angle and
cohesion, and writes lete_plates_fit.csv; it goes on from finished evaluations. `packings` presses the strips into beds
of three packings and of grains_lete_sand_loose.json, the result of the fit, and writes lete_plates.csv beside this
script; a test that is finished is used again. The committed fit is of beds five strips long, the default before
2381f383; now it is ten.

A row of a fit is one evaluation: its parameters, and its figures with their errors. A row of packings is one bed and
width: pressure at six sinkages, mean over three beds with half of its 95 % interval; n of the fit
p = (k_c/b + k_phi) z^n and k_c, k_phi, with standard errors; heaved over displaced volume. Rows without a solid
fraction are Wong's k_c, k_phi and n, of terrain/data/lete_sand.json.
"""
import json
import statistics

import driver
import provenance
from calibrated_soils import evaluations
from lete_sand import ANEW, RIG

PACKINGS = {"0.52": {"terrain.solid_fraction": 0.52} | ANEW, "as fitted": {},
            "0.60": {"terrain.solid_fraction": 0.6} | ANEW,
            "fitted to plates": {"terrain.material": "grains_lete_sand_loose.json"}}
SINKAGES = (10, 15, 20, 30, 50, 70)  # mm
NEAR = 0.0025  # m, over which pressures are averaged
WONG = driver.ROOT / "terrain" / "data" / "lete_sand.json"
TABLE = driver.read_json(WONG)["terrain"]
WIDTHS = (0.1, 0.2)  # m
FIT_END = 60  # mm, the deepest point of the fit
FIT = {
    "format_version": 1, "calibrate": "grains", "start": RIG, "set": ANEW,
    "tests": {"seeds": 3, "stresses": [20e3, 50e3, 100e3]},
    "parameters": {"rolling_friction": {"lower": 0.0, "upper": 1.0, "start": 0.3},
                   "cohesion": {"lower": 0.0, "upper": 60e3, "start": 7.4e3},
                   "solid_fraction": {"lower": 0.5, "upper": 0.6, "start": 0.55}},
    "targets": [{"data": "wong_100_mm.csv", "strip": 0.1, "depth": 0.3},
                {"quantity": "friction_angle_deg", "data": str(WONG), "sigma": 1.0},
                {"quantity": "cohesion_Pa", "data": str(WONG), "sigma": 300}],
    "evaluations": 16, "result": "grains_lete_plates.json",
}
FITTED = driver.RESULTS / "lete_fit"


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


def wong(width, mm):
    """Pressure of Wong's table, Pa"""
    return (TABLE["bekker_k_c"] / width + TABLE["bekker_k_phi"]) * (1e-3 * mm) ** TABLE["bekker_n"]


def fit(made):
    FITTED.mkdir(parents=True, exist_ok=True)
    (FITTED / "wong_100_mm.csv").write_text("sinkage_m,pressure_Pa\n" + "".join(
        f"{1e-3 * mm:g},{wong(0.1, mm):.6g}\n" for mm in range(0, FIT_END + 1, 2)), encoding="utf-8")
    study = FITTED / "study.json"
    study.write_text(json.dumps(FIT, indent=2) + "\n", encoding="utf-8")
    driver.furrow("calibrate", study, "--out", FITTED / "fit", progress=True)
    names = [f"at_{mm}_mm_Pa" for mm in range(20, FIT_END + 1, 10)] + ["friction_angle_deg", "cohesion_Pa"]
    driver.write("lete_plates_fit.csv", evaluations(FITTED / "fit", names), made)


def packings(made):
    rows = []
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
    for width in WIDTHS:
        rows.append({"packing": "Wong's table", "width_mm": 1e3 * width}
                    | {key: TABLE[f"bekker_{key}"] for key in ("n", "k_c", "k_phi")}
                    | {f"at_{z}_mm_kPa": 1e-3 * wong(width, z) for z in SINKAGES})
    driver.write("lete_plates.csv", rows, made)


def main():
    parser = driver.options(__doc__)
    parser.add_argument("parts", nargs="*", choices=("fit", "packings"))
    parts, made = parser.parse_args().parts, provenance.made_here()
    for part in (fit, packings):
        if not parts or part.__name__ in parts:
            part(made)


if __name__ == "__main__":
    main()
