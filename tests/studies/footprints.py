#!/usr/bin/python3
"""Static footprints and load–deflection curves of the layered and the lumped tire from folders of `furrow press`:
footprints.csv (one line a case), footprints_curves.csv, footprints_pressure.csv (pressure maps) and footprints.png
beside it.

usage: footprints.py [--run]     --run presses first what this build of the program has not pressed yet (see CASES)
"""
import argparse
import json
import pathlib
import subprocess
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
import provenance  # noqa: E402

KEYS = ("obstacle", "inflation_growth_m", "runout_m", "load_N", "deflection_m",
        "secant_stiffness_N_per_m", "tangent_stiffness_N_per_m",
        "loading_unloading_difference", "max_residual", "creep_steps",
        "failed_factorizations", "statically_stable", "wall_s")
FOOT = ("deflection_m", "force_N", "length_m", "width_m", "area_m2", "mean_pressure_Pa", "max_pressure_Pa")

PLATE, FINE = ("--deflection", "0.015", "--points", "5"), ("--deflection", "0.0135", "--points", "9")
CLEAT = ("--cleat-height", "0.02", "--cleat-width", "0.02", "--deflection", "0.016", "--points", "8")
LOW = ("--set", "tire.pressure=20e3")
CASES = {  # folder, whose name is TIRE_MESH_OBSTACLE: more words for `furrow press`
    **{f"lumped_{mesh}_plate": PLATE for mesh in ("45x12", "60x12", "90x24", "180x48")},
    **{f"layered_{mesh}_plate": FINE for mesh in ("60x12", "90x24")},
    "layered_180x48_plate": ("--deflection", "0.0135", "--points", "6"),
    "lumped_90x24_cleat": CLEAT,
    "layered_90x24_cleat": CLEAT,
    "layered-20kPa-4mm_90x24_plate": (*LOW, "--deflection", "0.004", "--points", "4", "--load", "300"),
    "layered-20kPa_90x24_plate": (*LOW, "--deflection", "0.0135", "--points", "6", "--load", "500"),
}
MAPS = ("lumped_90x24_plate", "lumped_180x48_plate", "layered_90x24_plate", "layered_180x48_plate")


def press(name, words):
    """Presses a tire unless this build of the program has done so."""
    folder, (tire, mesh, obstacle) = RESULTS / name, name.split("_")
    if provenance.read_json(folder / provenance.RECORD).get("build") == provenance.build_of(provenance.program()):
        return
    around, across = mesh.split("x")
    subprocess.run([provenance.program(), "press", str(ROOT / "rigs" / "rigid_ground.json"),
                    "--set", f"tire.file=hmmwv_{tire.split('-')[0]}.json",
                    "--set", f"tire.elements_circumference={around}",
                    "--set", f"tire.elements_width={across}", "--on", obstacle,
                    "--out", str(folder), "--overwrite", *words], check=True)
    provenance.record_run(folder)


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


def label(name):
    return name.replace("_plate", "").replace("_cleat", ", cleat").replace("_", " ").replace("x", " × ")


def draw_footprint(axis, name, s):
    foot = table(RESULTS / name / "footprint.csv")
    points = axis.scatter(1e3 * foot["y_m"], 1e3 * foot["x_m"], c=1e-3 * foot["pressure_Pa"], marker="s", lw=0,
                          s=1.5e4 * np.sqrt(np.median(foot["area_m2"])) ** 1.2, cmap="viridis", vmin=0,
                          vmax=800)
    plt.colorbar(points, label="kPa", ax=axis, shrink=0.7)
    axis.set_aspect("equal")
    axis.set(xlabel="across, mm", ylabel="along, mm", xlim=(-115, 115), ylim=(-85, 85))
    axis.set_title(f"{label(name)}, {1e-3 * s['force_N']:.2f} kN\n{1e3 * s['length_m']:.0f} × {1e3 * s['width_m']:.0f} "
                   f"mm, "
                   f"mean {1e-3 * s['mean_pressure_Pa']:.0f} kPa", fontsize=10)


def draw_curves(axis, cases):
    shown = {name: s for name, s in cases.items() if name in MAPS or name.endswith("cleat")}
    for name, s in shown.items():
        curve = table(RESULTS / name / "press.csv")
        back, cleat = curve["unloading"] > 0, s["obstacle"] == "cleat"
        color = plt.get_cmap("Blues" if name.startswith("lumped") else "Oranges")(0.9 if "180x48" in name else 0.6)
        axis.plot(1e3 * curve["deflection_m"][~back], 1e-3 * curve["force_N"][~back], "--" if cleat else "-", lw=1.3,
                  color=color, label=label(name))
        axis.plot(1e3 * curve["deflection_m"][back], 1e-3 * curve["force_N"][back], "x", ms=4, color=color)
    axis.set(xlabel="deflection, mm", ylabel="force, kN", title="plate solid, cleat dashed; crosses: unloading")
    axis.legend(fontsize=8)


def draw_convergence(axis, cases, tire):
    """Secant stiffness and size of the footprint against the elements around, each over that of the finest mesh."""
    meshes = sorted((int(name.split("_")[1].split("x")[0]), s) for name, s in cases.items()
                    if name.split("_")[0] == tire and name.endswith("plate") and s["secant_stiffness_N_per_m"])
    if len(meshes) < 2:
        return
    around = [n for n, _ in meshes]
    for values, what in (([s["secant_stiffness_N_per_m"] for _, s in meshes], "secant stiffness"),
                         ([s["footprint"]["length_m"] for _, s in meshes], "length"),
                         ([s["footprint"]["width_m"] for _, s in meshes], "width"),
                         ([s["footprint"]["area_m2"] for _, s in meshes], "area")):
        axis.plot(around, np.array(values) / values[-1], "o-", ms=3, lw=1.2, label=what)
    axis.set(xlabel="elements around", ylabel="over the finest mesh", title=f"{tire}, plate, 4.56 kN")
    axis.legend(fontsize=7)


def write(name, made, columns, rows):
    provenance.write_table(HERE / name, columns, [dict(zip(columns, row)) for row in rows], made)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--run", action="store_true")
    if parser.parse_args().run:
        for name, words in CASES.items():
            press(name, words)
    cases = {folder.name: json.loads((folder / "summary.json").read_text())
             for folder in sorted(RESULTS.iterdir()) if (folder / "summary.json").exists()}
    plates = [name for name in cases if name.endswith("plate")]
    made = provenance.origin_of_runs([RESULTS / name for name in cases])
    write("footprints.csv", made, ["case", *KEYS, *(f"footprint_{key}" for key in FOOT)],
          ([name, *(s.get(key) for key in KEYS), *(s["footprint"][key] for key in FOOT)] for name, s in cases.items()))
    write("footprints_curves.csv", made, ["case", "deflection_m", "force_N", "residual", "unloading"],
          ([name, *(f"{value:.9g}" for value in row)] for name in cases for row in table(RESULTS / name / "press.csv")))
    write("footprints_pressure.csv", made, ["case", "along_mm", "across_mm", "pressure_kPa"],
          ([name, f"{x:.0f}", f"{y:.0f}", f"{p:.1f}"]
           for name in plates for x, y, p in coarse(table(RESULTS / name / "footprint.csv"))))
    shown = [name for name in MAPS if name in cases]
    figure = plt.figure(figsize=(15.0, 8.0), layout="constrained")
    grid = figure.add_gridspec(2, 4)
    for k, name in enumerate(shown):
        draw_footprint(figure.add_subplot(grid[0, k]), name, cases[name]["footprint"])
    draw_curves(figure.add_subplot(grid[1, :2]), cases)
    for k, tire in enumerate(("lumped", "layered")):
        draw_convergence(figure.add_subplot(grid[1, 2 + k]), cases, tire)
    figure.savefig(HERE / "footprints.png", dpi=64)


if __name__ == "__main__":
    main()
