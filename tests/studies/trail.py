#!/usr/bin/python3
"""Cornering stiffness and pneumatic trail at 1 degree against the mesh: trail.csv from the runs in results/trail, the
settings of rolling.json. A folder that ends in _before was made with another program.

    build/furrow run rigs/rigid_ground.json --set rig.mode=free_rolling --set rig.speed=4.0 --set rig.ramp=0.05 \\
        --set rig.touchdown_damping=25e3 --set rig.touchdown_time=10 --set terrain.friction_velocity_scale=200 \\
        --set run.end=0.55 --set run.average_from=0.25 --set output.frame_interval=0 --set checkpoint.at_end=false \\
        --set tire.file=hmmwv_lumped.json --set tire.elements_circumference=60 --set tire.elements_width=12 \\
        --set rig.toe_angle=0.01745 --no-plots --out results/trail/lumped_60x12
    /usr/bin/python3 tests/studies/trail.py
"""
import csv

from cornering import FITTED, HERE, RESULTS, read_series, steady

ANGLE = 0.01745  # rad


def main():
    with open(HERE / "trail.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["case", "cornering_stiffness_N_per_rad", "interval", "pneumatic_trail_m", "interval"])
        for folder in sorted((RESULTS / "trail").iterdir()):
            if not (folder / "summary.json").exists():
                continue
            series = read_series(folder / "timeseries.csv")
            (force, moment), (later, later_moment) = ([steady(series, name, begin)["end"] for _, name in FITTED] for begin in (0.2, 0.28))
            writer.writerow([folder.name, f"{abs(force) / ANGLE:.5g}", f"{abs(force - later) / ANGLE:.2g}",
                             f"{-moment / force:.4g}", f"{abs(moment / force - later_moment / later):.2g}"])


if __name__ == "__main__":
    main()
