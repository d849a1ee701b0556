#!/usr/bin/python3
"""Soil tests at three speeds: `furrow soil` of the small rig's grains; writes soil_speed.csv beside this script.

usage: soil_speed.py [--speeds 0.05 0.1 0.2]
"""
import argparse
import pathlib
import subprocess

import provenance
from provenance import ROOT

HERE = pathlib.Path(__file__).resolve().parent
# (column, key of soil.json, factor)
FIGURES = (("cohesion_kPa", "cohesion_Pa", 1e-3), ("friction_angle_deg", "friction_angle_deg", 1.0),
           ("janosi_K_mm", "janosi_K_m", 1e3),
           ("n", "n", 1.0), ("k_c_kN_per_m_n1", "k_c", 1e-3), ("k_phi_kN_per_m_n2", "k_phi", 1e-3))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--speeds", nargs="+", type=float, default=[0.05, 0.1, 0.2])
    speeds = parser.parse_args().speeds
    rows = []
    for speed in speeds:
        out = ROOT / "results" / "studies" / "soil_speed" / f"{speed:g}"
        subprocess.run([provenance.program(), "soil", str(ROOT / "rigs" / "drawbar_pull_small.json"),
                        "--only", "plate", "--only",
                        "shear", "--speed", str(speed), "--out", str(out), "--overwrite"], check=True)
        soil = provenance.read_json(out / "soil.json")
        rows.append({"speed_m_s": f"{speed:g}"})
        for column, key, factor in FIGURES:
            rows[-1][column] = f"{factor * soil[key]:.4g}"
            rows[-1][f"{column}_se"] = f"{factor * soil['standard_error'][key]:.2g}"
    provenance.write_table(HERE / "soil_speed.csv", list(rows[0]), rows, provenance.made_here())


if __name__ == "__main__":
    main()
