#!/usr/bin/python3
"""Strength of the soils of budget.json: direct shear (`furrow soil --only shear`, three seeds) on the small rig's
grains in other sizes and with stiffer contacts; writes strength.csv beside this script. Fifteen minutes on two cores.
"""
import argparse
import json
import pathlib
import subprocess

import provenance
from provenance import ROOT

HERE = pathlib.Path(__file__).resolve().parent
VARIANTS = ("base", "grains 12 mm", "grains 8 mm", "grains 6 mm", "stiffness x 2", "stiffness x 4")
# of a variant; depth and the like are the test's own
KEYS = ("terrain.radius", "terrain.young_modulus", "terrain.substeps")
# (column, key of soil.json, factor)
FIGURES = (("cohesion_kPa", "cohesion_Pa", 1e-3), ("friction_angle_deg", "friction_angle_deg", 1.0),
           ("janosi_K_mm", "janosi_K_m", 1e3))


def main():
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    study = json.loads((HERE / "budget.json").read_text())
    rows = []
    for variant in VARIANTS:
        settings = [f"{key}={value}" for key, value in study["cases"][variant]["set"].items() if key in KEYS]
        out = ROOT / "results" / "studies" / "strength" / variant.replace(" ", "_")
        subprocess.run([provenance.program(), "soil", str(ROOT / study["scenario"]),
                        "--only", "shear", "--out", str(out), "--overwrite",
                        *(word for setting in settings for word in ("--set", setting))], check=True)
        soil = provenance.read_json(out / "soil.json")
        row = {"variant": variant}
        for column, key, factor in FIGURES:
            row[column] = f"{factor * soil[key]:.4g}"
            row[f"{column}_se"] = f"{factor * soil['standard_error'][key]:.2g}"
        rows.append(row)
    provenance.write_table(HERE / "strength.csv", list(rows[0]), rows, provenance.made_here())


if __name__ == "__main__":
    main()
