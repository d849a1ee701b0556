#!/usr/bin/python3
"""Does the grains' LETE sand bear plates as Wong's table says? Strips of 100 and 200 mm are pushed into beds of grains.

usage: lete_plates.py [packings] [fits]

`packings` presses them into beds of three packings and writes lete_plates.csv beside this script; a test that is
finished is used again. `fits` calibrates rolling friction, cohesion and packing to Wong's two curves, alone and
together with his friction angle and cohesion, and writes lete_plates_fits.csv; fits go on from finished evaluations.

A row of a fit is one evaluation: its parameters, targets with their errors, and misfit. A row of packings is one packing and width: pressure at six sinkages, mean over three beds with half of its 95 % interval; n of the
fit p = (k_c/b + k_phi) z^n and k_c, k_phi, with standard errors; heaved over displaced volume. Rows without a solid
fraction are Wong's k_c, k_phi and n, of terrain/data/lete_sand.json.
"""
import json
import statistics

import driver
import provenance
from calibrated_soils import evaluations
from lete_sand import ANEW, RIG

PACKINGS = {"0.52": {"terrain.solid_fraction": 0.52} | ANEW, "as fitted": {},
            "0.60": {"terrain.solid_fraction": 0.6} | ANEW}
SINKAGES = (10, 15, 20, 30, 50, 70)  # mm
NEAR = 0.0025  # m, over which pressures are averaged
WONG = driver.ROOT / "terrain" / "data" / "lete_sand.json"
WIDTHS = (0.1, 0.2)  # m
DEPTH = 0.4  # m, of the fits' beds
FIT = {
    "format_version": 1, "calibrate": "grains", "start": RIG, "set": ANEW,
    "tests": {"seeds": 3},
    "parameters": {"rolling_friction": {"lower": 0.0, "upper": 1.0, "start": 0.3},
                   "cohesion": {"lower": 0.0, "upper": 60e3, "start": 7.4e3},
                   "solid_fraction": {"lower": 0.5, "upper": 0.6, "start": 0.55}},
    "evaluations": 24, "result": "grains_lete_plates.json",
}
STRENGTH = [{"quantity": "friction_angle_deg", "data": str(WONG), "sigma": 1.0},
            {"quantity": "cohesion_Pa", "data": str(WONG), "sigma": 300}]


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
    soil = driver.read_json(WONG)["terrain"]
    return (soil["bekker_k_c"] / width + soil["bekker_k_phi"]) * (1e-3 * mm) ** soil["bekker_n"]


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
    table = driver.read_json(WONG)["terrain"]
    for width in WIDTHS:
        rows.append({"packing": "Wong's table", "width_mm": 1e3 * width}
                    | {key: table[f"bekker_{key}"] for key in ("n", "k_c", "k_phi")}
                    | {f"at_{z}_mm_kPa": 1e-3 * wong(width, z) for z in SINKAGES})
    driver.write("lete_plates.csv", rows, made)


def fits(made):
    rows = []
    for name, more in (("plates", []), ("plates and strength", STRENGTH)):
        out = driver.RESULTS / ("lete_fit_" + name.replace(" ", "_"))
        out.mkdir(parents=True, exist_ok=True)
        targets = []
        for width in WIDTHS:
            data = out / f"wong_{1e3 * width:.0f}_mm.csv"
            data.write_text("sinkage_m,pressure_Pa\n" + "".join(f"{1e-3 * mm:g},{wong(width, mm):.6g}\n"
                                                                for mm in range(0, 73, 2)), encoding="utf-8")
            targets.append({"data": str(data), "strip": width, "depth": DEPTH, "points": 6})
        study = out / "study.json"
        study.write_text(json.dumps(FIT | {"targets": targets + more}, indent=2) + "\n", encoding="utf-8")
        driver.furrow("calibrate", study, "--out", out / "fit", progress=True)
        rows += [{"fit": name} | row for row in evaluated(out / "fit")]
    driver.write("lete_plates_fits.csv", rows, made)


def main():
    parser = driver.options(__doc__)
    parser.add_argument("parts", nargs="*", choices=("packings", "fits"))
    parts, made = parser.parse_args().parts, provenance.made_here()
    for part in (packings, fits):
        if not parts or part.__name__ in parts:
            part(made)


if __name__ == "__main__":
    main()
