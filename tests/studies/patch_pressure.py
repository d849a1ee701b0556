#!/usr/bin/python3
"""Figs 6, 10, 11 and 17 of the 2016 report at its size: strain of the tire and velocity of the grains, pressure in the
patch at the largest deflection and in steady motion, and the criterion of Wong for a rigid or flexible tire.

usage: patch_pressure.py [--law mindlin|report] [--seed 1] [--fall]

Runs drawbar_pull.json (with the report's law drawbar_pull_tr.json) with frames. Adds a row to patch_pressure.csv. With
seed 1 it also writes patch_pressure_LAW.csv, the pressure in wheel axes, and patch_pressure.png. --fall: as the public
program of the report starts, 10 mm above the ground, for 0.3 s with frames every 4 ms; adds a row alone.

Pressure of a node: the force on it along the surface's inward normal over a third of the area of its triangles. Angles
count from the downward vertical, forward positive. The row across is the node's place in the meridian. The largest
deflection is sought before `run.average_from`; the steady pressure is the mean over the frames after it.

A tire is rigid where p_i + p_c >= p_gcr [Wong 2010, Theory of Ground Vehicles, 2.5],
  p_gcr = (k_c/b + k_phi)^(1/(2n+1)) (3 W / ((3 - n) b sqrt(D)))^(2n/(2n+1)),
p_i the inflation pressure, p_c the carcass's: mean pressure of the patch on a plate at that load less p_i, of
footprints.csv. k_c, k_phi and n are those of the same grains of 10 mm at 0.1 m/s, of soil_speed.csv.
"""
import math
import types

import h5py
import numpy as np

import driver
import provenance

RIGS = {"mindlin": "drawbar_pull.json", "report": "drawbar_pull_tr.json"}
COLUMNS = 90  # of the mesh, around
STEP_OF_ANGLE = 2 * math.pi / COLUMNS
CELL = 0.015  # m, over which the velocities of grains are averaged
FALL = {"rig.drop_height": 0.009, "rig.touchdown_damping": 0, "run.end": 0.3, "run.average_from": 0.25,
        "output.frame_interval": 4e-3}
WIDTH, DIAMETER = 0.254, 2 * 0.4673  # m, of the tire


def read_frame(path):
    with h5py.File(path, "r") as file:
        return types.SimpleNamespace(time=float(file.attrs["time_s"]), **{name: file[name][()] for name in (
            "position", "force", "triangle", "strain")})


def nodal_pressure(frame):
    """(pressure, area) of the nodes, Pa and m²."""
    corner = frame.position[frame.triangle]
    across = 0.5 * np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])  # outward, m²
    normal = np.zeros_like(frame.position)
    for k in range(3):
        np.add.at(normal, frame.triangle[:, k], across / 3.0)
    area = np.linalg.norm(normal, axis=1)
    return -np.einsum("ij,ij->i", frame.force, normal) / area**2, area


def in_wheel_axes(frame, rows):
    """{(angle bin, row): (force, area)} of the nodes; the two last vertices are the middles of the discs."""
    pressure, area = nodal_pressure(frame)
    centre = 0.5 * (frame.position[-1] + frame.position[-2])
    arm = (frame.position - centre)[:-2]
    angle = np.arctan2(arm[:, 0], -arm[:, 2])
    bins = np.rint(angle / STEP_OF_ANGLE).astype(int)
    found = {}
    for node, (bin_, row) in enumerate(zip(bins, np.arange(len(arm)) % rows)):
        force, of = found.get((bin_, row), (0.0, 0.0))
        found[bin_, row] = (force + pressure[node] * area[node], of + area[node])
    return found


def mean_map(frames, rows):
    total = {}
    for frame in frames:
        for place, (force, area) in in_wheel_axes(frame, rows).items():
            f, a = total.get(place, (0.0, 0.0))
            total[place] = (f + force, a + area)
    return {place: force / area for place, (force, area) in total.items()}


def critical_pressure(load):
    """p_gcr, Pa."""
    soil = next(row for row in provenance.read_table(driver.HERE / "soil_speed.csv") if row["speed_m_s"] == "0.1")
    n, k_c, k_phi = float(soil["n"]), 1e3 * float(soil["k_c_kN_per_m_n1"]), 1e3 * float(soil["k_phi_kN_per_m_n2"])
    return ((k_c / WIDTH + k_phi) ** (1 / (2 * n + 1))
            * (3 * load / ((3 - n) * WIDTH * math.sqrt(DIAMETER))) ** (2 * n / (2 * n + 1)))


def pressure_on_plate():
    """p_i + p_c of the layered tire at about 4.6 kN, Pa."""
    return float(next(row for row in provenance.read_table(driver.HERE / "footprints.csv")
                      if row["case"] == "layered_90x24_plate")["footprint_mean_pressure_Pa"])


def grain_velocities(out, middle):
    """(places, m, velocities, m/s) in the wheel's middle plane: means over cells of the way between the last frames."""
    before, after = ((of["position"][()], float(of.attrs["time_s"])) for of in
                     (h5py.File(path, "r") for path in sorted((out / "frames").glob("terrain_*.h5"))[-2:]))
    place = 0.5 * (before[0] + after[0])
    velocity = (after[0] - before[0]) / (after[1] - before[1])
    near = (np.abs(place[:, 1]) < 2 * CELL) & (np.abs(place[:, 0] - middle) < 0.5)
    cells = {}
    for x, v in zip(place[near], velocity[near]):
        cells.setdefault((x[0] // CELL, x[2] // CELL), []).append((x, v))
    means = np.array([np.mean(of, axis=0) for of in cells.values()])
    return means[:, 0], means[:, 1]


def draw(maps, law, strain, grains):
    figure, axes = driver.subplot_mosaic("abc;ddd", figsize=(11, 6), layout="constrained", height_ratios=(2, 1))
    for axis, (title, values) in zip((axes["a"], axes["b"]), maps.items()):
        angles = sorted({a for a, _ in values if abs(a) <= 12})
        rows = sorted({r for _, r in values})
        image = np.array([[values.get((a, r), 0.0) / 1e3 for r in rows] for a in angles])
        shown = axis.pcolormesh(rows, np.degrees(np.array(angles) * STEP_OF_ANGLE), image, cmap="viridis")
        figure.colorbar(shown, ax=axis, label="pressure, kPa")
        driver.label(axis, "node across", "angle from the vertical, °", title)
    place, values = strain
    shown = axes["c"].scatter(place[:, 0], place[:, 2], c=100 * values, s=6, lw=0)
    figure.colorbar(shown, ax=axes["c"], label="largest principal strain, %")
    driver.label(axes["c"], "x, m", "z, m", "strain, right half", aspect="equal")
    at, velocity = grains
    shown = axes["d"].quiver(at[:, 0], at[:, 2], velocity[:, 0], velocity[:, 2], np.hypot(*velocity[:, ::2].T),
                             cmap="viridis", angles="xy", scale_units="xy", scale=12, width=0.0015)
    figure.colorbar(shown, ax=axes["d"], label="speed, m/s")
    driver.label(axes["d"], "x, m", "z, m", "velocity of grains in the wheel's middle plane", aspect="equal")
    driver.save(figure, "patch_pressure" + ("" if law == "mindlin" else "_report"))


def results_of(name, law, changed):
    """(folder, frames, rows of the mesh, end of the touch-down, frame at the largest deflection before it)"""
    out = driver.finished_case(name, [str(driver.ROOT / "rigs" / RIGS[law]), *driver.settings(changed)],
                               driver.RESULTS / name)
    frames = [read_frame(path) for path in sorted((out / "frames").glob("tire0_*.h5"))]
    series, begin = driver.series(out), driver.read_json(out / "scenario.json")["run"]["average_from"]
    early = series["time_s"] < begin
    at = series["time_s"][early][np.argmin(series["loaded_radius_m"][early])]
    return (out, frames, (len(frames[0].position) - 2) // COLUMNS, begin,
            min(frames, key=lambda frame: abs(frame.time - at)))


def add_row(row, made):
    table = driver.HERE / "patch_pressure.csv"
    others = [of for of in (provenance.read_table(table) if table.exists() else ())
              if (of["law"], of["seed"]) != (row["law"], str(row["seed"]))]
    driver.write("patch_pressure.csv", [*others, row], made, told=True)


def fall(law, seed, made):
    *_, rows, _, touch = results_of(f"patch_pressure_{law}_fall_{seed}", law, FALL | {"run.seed": seed})
    add_row({"law": f"{law}, falls 10 mm", "seed": seed, "commit": made["commit"],
             "largest_at_deflection_kPa": max(mean_map([touch], rows).values()) / 1e3}, made)


def main():
    parser = driver.options(__doc__, law={"choices": list(RIGS), "default": "mindlin"},
                            seed={"type": int, "default": 1}, fall={"action": "store_true"})
    arguments = parser.parse_args()
    made = provenance.made_here()
    if arguments.fall:
        fall(arguments.law, arguments.seed, made)
        return
    out, frames, rows, begin, touch = results_of(f"patch_pressure_{arguments.law}_{arguments.seed}", arguments.law,
                                                 {"run.seed": arguments.seed})
    summary = driver.summary(out)
    steady = [frame for frame in frames if frame.time >= begin]
    maps = {f"largest deflection, {touch.time:.2f} s": mean_map([touch], rows), "steady": mean_map(steady, rows)}
    last = frames[-1]
    if arguments.seed == 1:
        driver.write(f"patch_pressure_{arguments.law}.csv",
                     [{"when": when, "angle_deg": round(math.degrees(angle * STEP_OF_ANGLE)), "row": row,
                       "pressure_kPa": pressure / 1e3}
                      for when, values in maps.items() for (angle, row), pressure in sorted(values.items())
                      if abs(pressure) > 1e3], made)
        right = last.position[:-2, 1] >= np.mean(last.position[:-2, 1])
        draw(maps, arguments.law, (last.position[:-2][right], last.strain[:-2][right]),
             grain_velocities(out, np.mean(last.position[:, 0])))
    load = driver.mean_of(summary["vertical_load_N"])
    pull = summary["drawbar_pull_N"]
    row = {"law": arguments.law, "seed": arguments.seed, "commit": made["commit"], "pull_N": pull["mean"],
           "sem_N": pull["sem"], "steady": int(pull["steady"]), "sinkage_mm": 1e3 * summary["sinkage_m"],
           "load_N": load, "frames": len(steady), "largest_kPa": max(maps["steady"].values()) / 1e3,
           "largest_at_deflection_kPa": max(next(iter(maps.values())).values()) / 1e3,
           "strain_percent": 100 * float(last.strain.max()), "p_i_and_p_c_kPa": pressure_on_plate() / 1e3,
           "p_gcr_kPa": critical_pressure(load) / 1e3}
    add_row(row, made)


if __name__ == "__main__":
    main()
