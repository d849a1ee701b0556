#!/usr/bin/python3
"""Static footprints and load–deflection curves of the layered and the lumped tire from folders of `furrow press`:
footprints.csv (one line a case), footprints_pressure.csv (pressure maps) and footprints.png beside it.

    for each tire, mesh and obstacle:
    build/furrow press rigs/rigid_ground.json --set tire.file=hmmwv_lumped.json --set tire.elements_circumference=90 \\
        --set tire.elements_width=24 --on plate --out results/press/lumped_90x24_plate
    /usr/bin/python3 tests/studies/footprints.py
"""
import csv
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
RESULTS = ROOT / "results" / "press"
sys.path.insert(0, str(ROOT / "scripts"))
import plot.style  # noqa: E402, F401  the look of all plots

KEYS = ("obstacle", "inflation_growth_m", "load_N", "deflection_m", "secant_stiffness_N_per_m", "tangent_stiffness_N_per_m",
        "loading_unloading_difference", "max_residual", "failed_factorizations", "statically_stable")
FOOT = ("deflection_m", "force_N", "length_m", "width_m", "area_m2", "mean_pressure_Pa", "max_pressure_Pa")


def table(file):
    return np.atleast_1d(np.genfromtxt(file, delimiter=",", names=True))


def coarse(foot, cell=8e-3):
    """Mean pressure on a grid of square cells: x, y of the centres in mm, kPa; cells without contact left out."""
    lines = []
    x, y = np.rint(foot["x_m"] / cell).astype(int), np.rint(foot["y_m"] / cell).astype(int)
    for i, j in sorted(set(zip(x, y))):
        here = (x == i) & (y == j)
        force = np.sum(foot["pressure_Pa"][here] * foot["area_m2"][here])
        lines.append((1e3 * cell * i, 1e3 * cell * j, 1e-3 * force / cell**2))
    return lines


def main():
    cases = {folder.name: json.loads((folder / "summary.json").read_text())
             for folder in sorted(RESULTS.iterdir()) if (folder / "summary.json").exists()}
    with open(HERE / "footprints.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["case", *KEYS, *(f"footprint_{key}" for key in FOOT)])
        for name, s in cases.items():
            writer.writerow([name, *(s.get(key) for key in KEYS), *(s["footprint"][key] for key in FOOT)])
    plates = [name for name in cases if name.endswith("plate")]
    with open(HERE / "footprints_pressure.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["case", "along_mm", "across_mm", "pressure_kPa"])
        for name in plates:
            for x, y, p in coarse(table(RESULTS / name / "footprint.csv")):
                writer.writerow([name, f"{x:.0f}", f"{y:.0f}", f"{p:.1f}"])
    figure = plt.figure(figsize=(13.0, 7.0), layout="constrained")
    grid = figure.add_gridspec(2, max(len(plates), 2))
    for k, name in enumerate(plates):
        foot, s = table(RESULTS / name / "footprint.csv"), cases[name]["footprint"]
        axis = figure.add_subplot(grid[0, k])
        points = axis.scatter(1e3 * foot["y_m"], 1e3 * foot["x_m"], c=1e-3 * foot["pressure_Pa"], s=6, marker="s", cmap="viridis", vmin=0)
        figure.colorbar(points, label="kPa", ax=axis, shrink=0.8)
        axis.set_aspect("equal")
        axis.set(xlabel="across, mm", ylabel="along, mm", xlim=(-130, 130), ylim=(-90, 90))
        axis.set_title(f"{name.replace('_plate', '').replace('_', ' ')}\n{1e3 * s['length_m']:.0f} × {1e3 * s['width_m']:.0f} mm, "
                       f"mean {1e-3 * s['mean_pressure_Pa']:.0f} kPa", fontsize=10)
    for k, obstacle in enumerate(("plate", "cleat")):
        pressed = [name for name in cases if name.endswith(obstacle)]
        if not pressed:
            continue
        axis = figure.add_subplot(grid[1, k])
        for name in pressed:
            curve = table(RESULTS / name / "press.csv")
            loading = curve["unloading"] == 0
            axis.plot(1e3 * curve["deflection_m"][loading], 1e-3 * curve["force_N"][loading], "o-", ms=3,
                      label=name.removesuffix(f"_{obstacle}").replace("_", " "))
        axis.set(xlabel="deflection, mm", ylabel="force, kN", title=f"on a {obstacle}")
        axis.legend(fontsize=8)
    figure.savefig(HERE / "footprints.png", dpi=90)


if __name__ == "__main__":
    main()
