#!/usr/bin/python3
"""Does the thrust of a small rigid wheel follow its surface? The wheel of small_wheel.json at several slips, smooth at
two frictions, and rough: with as many grousers as grains fit around it, half a grain high and thick, so that grains
lock between them as between glued half-grains.

usage: rough_wheel.py [--seeds 1 2 …] [--slips 0 0.3 0.6]     writes rough_wheel.csv beside this script

A row is one run. Of the rough wheel, torque over load × radius and slip are also those of the tips of its grousers.
Expected, written down before the first run: if grains that roll along the tread limit the thrust, the rough wheel has
more torque than the smooth one of friction 0.8; if the soil limits it, both have the same.
"""
import driver
import provenance

RIG = str(driver.ROOT / "rigs" / "small_wheel.json")
HALF = 0.0035  # of a grain's diameter, m
FIGURES = {"pull_N": "drawbar_pull_N", "torque_Nm": "drive_torque_Nm", "sinkage_mm": "sinkage_m"}
ALWAYS = {"output.frame_interval": 0}
SURFACES = {
    "smooth, friction 0.4": {"tire.friction": 0.4},
    "smooth, friction 0.8": {"tire.friction": 0.8},
    "rough, friction 0.8": {"tire.friction": 0.8, "tire.grousers": 52, "tire.grouser_height": HALF,
                            "tire.grouser_thickness": HALF},
}


def main():
    arguments = driver.options(__doc__, seeds={"type": int, "nargs": "+", "default": [1, 2, 3]},
                               slips={"type": float, "nargs": "+", "default": [0.0, 0.3, 0.6]}).parse_args()
    rows, made = [], provenance.made_here()
    for seed in arguments.seeds:
        for surface, changed in SURFACES.items():
            for slip in arguments.slips:
                words = [RIG, *driver.settings(changed, {"rig.slip": slip, "run.seed": seed}, ALWAYS)]
                out = driver.RESULTS / "rough_wheel" / f"{surface}_{slip:g}_{seed}".replace(" ", "_").replace(",", "")
                if not driver.done_run(words, out):
                    continue
                summary = driver.summary(out)
                row, radius = driver.drawbar_row(summary, FIGURES), summary["tire_radius_m"]
                load = driver.mean_of(summary["vertical_load_N"])
                tips = radius + changed.get("tire.grouser_height", 0.0)
                rows.append({"surface": surface.replace(",", ""), "slip": slip,
                             "slip_of_tips": 1 - (1 - slip) * radius / tips, "seed": seed,
                             "torque_over_load_radius": row["torque_Nm"] / (load * tips), **row})
                driver.write("rough_wheel.csv", rows, made, told=True)


if __name__ == "__main__":
    main()
