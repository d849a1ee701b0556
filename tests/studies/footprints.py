#!/usr/bin/python3
"""Static footprints and load–deflection curves of the layered and the lumped tire from folders of `furrow press`:
footprints.csv (one line a case), footprints_curves.csv, footprints_pressure.csv (pressure maps) and footprints.png
beside it.

usage: footprints.py [--run]     --run presses first what this build of the program has not pressed yet (see CASES)
"""
import numpy as np

import driver
import provenance
from driver import columns

RESULTS = driver.ROOT / "results" / "press"
KEYS = ("obstacle", "inflation_growth_m", "runout_m", "load_N", "deflection_m", "secant_stiffness_N_per_m",
        "tangent_stiffness_N_per_m", "loading_unloading_difference", "max_residual", "creep_steps",
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
    tire, mesh, obstacle = name.split("_")
    around, across = mesh.split("x")
    mesh_keys = {"tire.elements_circumference": int(around), "tire.elements_width": int(across)}
    driver.kept(RESULTS / name, "press", "rigs/rigid_ground.json", "--set",
                f"tire.file=hmmwv_{tire.split('-')[0]}.json", *driver.settings(mesh_keys), "--on", obstacle, *words)


def coarse(name, cell=8e-3):
    """Mean pressure on a grid of square cells; cells without contact left out."""
    foot = columns(RESULTS / name / "footprint.csv")
    x, y = np.rint(foot["x_m"] / cell).astype(int), np.rint(foot["y_m"] / cell).astype(int)
    for i, j in sorted(set(zip(x, y))):
        here = (x == i) & (y == j)
        force = np.sum(foot["pressure_Pa"][here] * foot["area_m2"][here])
        yield {"case": name, "along_mm": f"{1e3 * cell * i:.0f}", "across_mm": f"{1e3 * cell * j:.0f}",
               "pressure_kPa": f"{1e-3 * force / cell**2:.1f}"}


def label(name):
    return name.replace("_plate", "").replace("_cleat", ", cleat").replace("_", " ").replace("x", " × ")


def draw_footprint(axis, name, s):
    foot = columns(RESULTS / name / "footprint.csv")
    points = axis.scatter(1e3 * foot["y_m"], 1e3 * foot["x_m"], c=1e-3 * foot["pressure_Pa"], marker="s", lw=0,
                          s=1.5e4 * np.sqrt(np.median(foot["area_m2"])) ** 1.2, cmap="viridis", vmin=0, vmax=800)
    axis.figure.colorbar(points, label="kPa", ax=axis, shrink=0.7)
    driver.label(axis, "across, mm", "along, mm", xlim=(-115, 115), ylim=(-85, 85), aspect="equal")
    axis.set_title(f"{label(name)}, {1e-3 * s['force_N']:.2f} kN\n{1e3 * s['length_m']:.0f} × {1e3 * s['width_m']:.0f} "
                   f"mm, mean {1e-3 * s['mean_pressure_Pa']:.0f} kPa", fontsize=10)


def draw_curves(axis, cases):
    for name, s in cases.items():
        if name not in MAPS and not name.endswith("cleat"):
            continue
        curve = columns(RESULTS / name / "press.csv")
        deflection, force, back = 1e3 * curve["deflection_m"], 1e-3 * curve["force_N"], curve["unloading"] > 0
        look = {"color": "tab:blue" if name.startswith("lumped") else "tab:orange",
                "alpha": 0.9 if "180x48" in name else 0.6}
        axis.plot(deflection[~back], force[~back], "--" if s["obstacle"] == "cleat" else "-", lw=1.3, label=label(name),
                  **look)
        axis.plot(deflection[back], force[back], "x", ms=4, **look)
    driver.label(axis, "deflection, mm", "force, kN", "plate solid, cleat dashed; crosses: unloading", legend=8)


def draw_convergence(axis, cases, tire):
    """Secant stiffness and size of the footprint against the elements around, each over that of the finest mesh."""
    meshes = sorted((int(name.split("_")[1].split("x")[0]), s) for name, s in cases.items()
                    if name.split("_")[0] == tire and name.endswith("plate") and s["secant_stiffness_N_per_m"])
    if len(meshes) < 2:
        return
    for path in ("secant_stiffness_N_per_m", "footprint.length_m", "footprint.width_m", "footprint.area_m2"):
        values = np.array([driver.value_of(s, path) for _, s in meshes])
        axis.plot([n for n, _ in meshes], values / values[-1], "o-", ms=3, lw=1.2,
                  label=path.split(".")[-1].split("_")[0])
    driver.label(axis, "elements around", "over the finest mesh", f"{tire}, plate, 4.56 kN", legend=7)


def main():
    if driver.options(__doc__, run={"action": "store_true"}).parse_args().run:
        for name, words in CASES.items():
            press(name, words)
    cases = {name: driver.summary(folder) for name, folder in driver.finished_runs(RESULTS, sorted(CASES)).items()}
    made = provenance.origin_of_runs([RESULTS / name for name in cases])
    driver.write("footprints.csv", [
        {"case": name, **{key: s.get(key) for key in KEYS}, **{f"footprint_{key}": s["footprint"][key] for key in FOOT}}
        for name, s in cases.items()], made, None)
    driver.write("footprints_curves.csv", [
        {"case": name, **{key: float(row[key]) for key in ("deflection_m", "force_N", "residual", "unloading")}}
        for name in cases for row in columns(RESULTS / name / "press.csv")], made, 9)
    driver.write("footprints_pressure.csv", [row for name in cases if name.endswith("plate") for row in coarse(name)],
                 made)
    figure, (maps, below) = driver.subplots(2, 4, figsize=(15.0, 8.0), layout="constrained")
    for axis, name in zip(maps, [name for name in MAPS if name in cases]):
        draw_footprint(axis, name, cases[name]["footprint"])
    grid = below[0].get_gridspec()
    for axis in below[:2]:
        axis.remove()
    draw_curves(figure.add_subplot(grid[1, :2]), cases)
    for axis, tire in zip(below[2:], ("lumped", "layered")):
        draw_convergence(axis, cases, tire)
    driver.save(figure, "footprints", 64)


if __name__ == "__main__":
    main()
