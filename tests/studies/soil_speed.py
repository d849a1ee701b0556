#!/usr/bin/python3
"""Soil tests at three speeds: `furrow soil` of the small rig's grains; writes soil_speed.csv beside this script."""
import driver
import strength

FIGURES = (*strength.FIGURES, ("n", "n", 1.0), ("k_c_kN_per_m_n1", "k_c", 1e-3), ("k_phi_kN_per_m_n2", "k_phi", 1e-3))


def main():
    speeds = driver.options(__doc__, speeds={"nargs": "+", "type": float, "default": [0.05, 0.1, 0.2]})
    rows = [{"speed_m_s": f"{speed:g}",
             **strength.measured(driver.RESULTS / "soil_speed" / f"{speed:g}", FIGURES,
                                 "rigs/drawbar_pull_small_report_soil.json", "--only", "plate", "--only", "shear",
                                 "--speed", speed)}
            for speed in speeds.parse_args().speeds]
    driver.write("soil_speed.csv", rows)


if __name__ == "__main__":
    main()
