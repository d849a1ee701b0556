#!/usr/bin/python3
"""Charts of planar_*.csv, beside them: planar.png (compression, modulus, meshes) and planar_curb.png (curb, deformed
wheel)."""
import collections
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
sys.path.insert(0, str(HERE.parents[1] / "studies"))
from plot_curves import save  # noqa: E402
from furrow.plot import style  # noqa: E402
import provenance  # noqa: E402

COLOURS = [style.SKY, style.ORANGE, style.BLUE]
MEASURED, PAPER = 639782.0, 295740.0  # N/m, Pa


def rows(name):
    return provenance.read_table(HERE / f"planar_{name}.csv")


def column(table, name):
    return np.array([float(row[name]) for row in table])


def groups(table, key):
    found = collections.OrderedDict()
    for row in table:
        found.setdefault(row[key], []).append(row)
    return found


def study():
    figure, (compression, modulus, meshes) = plt.subplots(1, 3, figsize=(14, 4.4), layout="constrained")
    for colour, (poisson, table) in zip(COLOURS, groups(rows("compression"), "poisson_ratio").items()):
        compression.plot(1e3 * column(table, "deflection_m"), 1e-3 * column(table, "force_N"),
                         color=colour, label=f"ν = {poisson}")
    compression.set(xlabel="deflection, mm", ylabel="force, kN", title="compression, E = 295.74 kPa")
    table = rows("modulus")
    young = 1e-6 * column(table, "young_modulus_Pa")
    modulus.plot(young, 1e-6 * column(table, "secant_N_per_m"), "o-", color=COLOURS[0],
                 label="end force / end deflection")
    modulus.plot(young, 1e-6 * column(table, "regression_N_per_m"), "s--", color=COLOURS[1], label="regression")
    for colour, line in zip(COLOURS, rows("line")):
        modulus.plot(young, 1e-6 * (float(line["intercept_N_per_m"]) + 1e6 * young * float(line["slope_m"])),
                     ":", color=colour,
                     label=f"straight line, R² = {float(line['r_squared']):.4f}")
    modulus.plot([1e-6 * PAPER], [1e-6 * MEASURED], "*", color=COLOURS[2], ms=12, label="source: measured, its mesh")
    modulus.set(xlabel="Young's modulus, MPa", ylabel="radial stiffness, MN/m", title="stiffness at 80 mm, ν = 0.45")
    for colour, (volume, table) in zip(COLOURS, groups(rows("mesh"), "volume").items()):
        meshes.semilogx(column(table, "elements"), 1e-6 * column(table, "secant_N_per_m"), "o-", color=colour,
                        label={"element": "constant-strain triangles", "averaged": "averaged nodal volumes"}[volume])
        meshes.axhline(1e-6 * float(table[-1]["limit_N_per_m"]), color=colour, ls=":")
    meshes.set(xlabel="triangles", ylabel="secant stiffness, MN/m", title="four meshes; dotted: extrapolated")
    for axis in (compression, modulus, meshes):
        axis.legend(fontsize=9)
        axis.set_ylim(bottom=0)
    meshes.set_ylim(auto=True)
    meshes.autoscale(axis="y")
    save(figure, "planar.png")


def curb():
    table = rows("curb")
    time, centre = column(table, "time_s"), column(table, "centre_x_m")
    here = centre > -0.8
    figure, axes = plt.subplots(1, 2, figsize=(14, 5.2), layout="constrained", width_ratios=(1, 1.15))
    axes[0].plot(time[here], 1e3 * column(table, "axle_m")[here], color=COLOURS[0], label="planar finite elements")
    axes[0].plot(time[here], 1e3 * column(table, "simple_axle_m")[here],
                 "--", color=COLOURS[1], label="spring and damper")
    axes[0].axvline(np.interp(0.0, centre, time), color="0.6", lw=0.8)
    lifted = (column(table, "ground_force_N") == 0.0) & here
    if lifted.any():
        axes[0].plot(time[lifted], 1e3 * column(table, "axle_m")[lifted], ".", color=COLOURS[2], label="off the ground")
    axes[0].set(xlabel="time, s", ylabel="height of the centre over rest, mm",
                title="curb of 0.2 m; grey: centre over the edge")
    axes[0].legend(fontsize=9)
    for colour, picture in zip(COLOURS, groups(rows("shapes"), "centre_x_m").values()):
        for ring in groups(picture, "ring").values():
            x, z = column(ring, "x_m"), column(ring, "z_m")
            axes[1].plot(np.append(x, x[0]), np.append(z, z[0]), color=colour, lw=0.7)
        spokes = groups(picture, "node")
        for spoke in list(spokes.values())[::2]:
            axes[1].plot(column(spoke, "x_m"), column(spoke, "z_m"), color=colour, lw=0.4)
    axes[1].fill_between([-1.0, 0, 0, 0.8], [0, 0, 0.2, 0.2], -0.1, color="0.8", lw=0)
    axes[1].set(aspect="equal", xlabel="x, m", ylabel="z, m", title="deformed wheel at three places", xlim=(-1.0, 0.8))
    save(figure, "planar_curb.png")


if __name__ == "__main__":
    study()
    curb()
