#!/usr/bin/python3
"""Strength of the soils of budget.json: direct shear (`furrow soil --only shear`, three seeds) on the small rig's
grains in other sizes and with stiffer contacts; writes strength.csv beside this script. Fifteen minutes on two cores.
"""
import json

import driver
from driver import HERE, RESULTS, read_json

VARIANTS = ("base", "grains 12 mm", "grains 8 mm", "grains 6 mm", "stiffness x 2", "stiffness x 4")
# of a variant; depth and the like are the test's own
KEYS = ("terrain.radius", "terrain.young_modulus", "terrain.substeps")
# (column, key of soil.json, factor)
FIGURES = (("cohesion_kPa", "cohesion_Pa", 1e-3), ("friction_angle_deg", "friction_angle_deg", 1.0),
           ("janosi_K_mm", "janosi_K_m", 1e3))


def measured(out, figures, *words):
    """What `furrow soil` finds: columns with their standard errors."""
    driver.furrow("soil", *words, "--out", out, "--overwrite", progress=True)
    soil, row = read_json(out / "soil.json"), {}
    for column, key, factor in figures:
        row[column] = f"{factor * soil[key]:.4g}"
        row[f"{column}_se"] = f"{factor * soil['standard_error'][key]:.2g}"
    return row


def main():
    driver.options(__doc__).parse_args()
    study, rows = json.loads((HERE / "budget.json").read_text()), []
    for variant in VARIANTS:
        changed = {key: value for key, value in study["cases"][variant]["set"].items() if key in KEYS}
        rows.append({"variant": variant, **measured(RESULTS / "strength" / variant.replace(" ", "_"), FIGURES,
                                                    study["scenario"], "--only", "shear", *driver.settings(changed))})
    driver.write("strength.csv", rows)


if __name__ == "__main__":
    main()
