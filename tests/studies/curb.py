#!/usr/bin/python3
"""The quarter car of rigs/curb.json on its planar tire, beside the linear quarter car on a spring and a damper, which knows of
the road only how high it is under the wheel's centre. Writes curb.csv (both over time), curb_figures.csv (what is derived)
and curb.png beside it.

The linear model has the masses and the suspension of the run; its tire spring is the measured radial stiffness of the tire's
source, its damper 0.13 of the wheel's critical damping. Heights count from rest on the flat before the curb.

    build/furrow run rigs/curb.json --out results/curb
    /usr/bin/python3 tests/studies/curb.py
"""
import argparse
import csv
import json
import pathlib
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(ROOT / "scripts"))
import plot.style as style  # noqa: E402
import provenance  # noqa: E402

TIRE_SPRING, TIRE_DAMPER = 639782.0, 3e3  # N/m, N s/m
GRAVITY = 9.80665
REST = 0.5  # m before the edge, where the wheel is at rest on the flat: it has been let down, and does not feel the curb yet
FELT = 0.02  # share of the load by which a force differs when it is felt
AIR = 0.01  # share of the load below which a wheel is off the ground


def linear(times, road, body_mass, wheel_mass, stiffness, damping):
    """Heights of wheel and body and the tire's force at the times, from (1) of vehicle/analysis/quarter_car.hpp."""
    step = 2e-5
    load = (body_mass + wheel_mass) * GRAVITY
    wheel = wheel_rate = body = body_rate = 0.0
    lines, now = [], times[0]
    for time in times:
        while now < time - 0.5 * step:
            force = TIRE_SPRING * (road(now) - wheel) - TIRE_DAMPER * wheel_rate
            between = stiffness * (wheel - body) + damping * (wheel_rate - body_rate)
            wheel_rate += step * (force - between) / wheel_mass
            body_rate += step * between / body_mass
            wheel += step * wheel_rate
            body += step * body_rate
            now += step
        lines.append((wheel, body, load + TIRE_SPRING * (road(now) - wheel) - TIRE_DAMPER * wheel_rate))
    return np.array(lines)


def draw_wheel(axis, run, profile, edge):
    """The rim of the deformed tire in several frames, over the ground."""
    shown, last = [], None
    for file in sorted((run / "frames").glob("tire0_*.h5")):
        with h5py.File(file) as frame:
            at = frame["position"][()]
        rim = at[at[:, 1] > 1e-6]  # of the two sides of the extruded tire, one: the tread and the centre
        middle = rim.mean(axis=0)
        rim = rim[np.hypot(rim[:, 0] - middle[0], rim[:, 2] - middle[2]) > 0.1]
        if not edge - 1.2 < middle[0] < edge + 0.9 or (last is not None and middle[0] - last < 0.38):
            continue
        last = middle[0]
        around = np.argsort(np.arctan2(rim[:, 2] - middle[2], rim[:, 0] - middle[0]))
        shown.append(rim[np.append(around, around[0])])
    for k, rim in enumerate(shown):
        axis.plot(rim[:, 0] - edge, rim[:, 2], color=plt.cm.viridis(k / max(1, len(shown) - 1)), lw=1.2)
    axis.plot([-2.0, *(profile[:, 0] - edge), 2.0], [profile[0, 1], *profile[:, 1], profile[-1, 1]], color="0.3", lw=2)
    axis.set(xlabel="from the edge, m", ylabel="height, m", xlim=(-1.75, 1.45), aspect="equal", title="deformed tire")


def stretches(times, flags):
    """Time during which the flag is set, s."""
    return float(np.sum(np.diff(times)[flags[:-1]])) if len(times) > 1 else 0.0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", nargs="?", type=pathlib.Path, default=ROOT / "results" / "curb")
    run = parser.parse_args().run
    scenario = json.loads((run / "scenario.json").read_text(encoding="utf-8"))
    summary = json.loads((run / "summary.json").read_text(encoding="utf-8"))
    series = np.genfromtxt(run / "timeseries.csv", delimiter=",", names=True)
    rig = scenario["rig"]
    edge, height = scenario["terrain"]["profile"][1]
    time, x = series["time_s"], series["position_m"]
    load = summary["vertical_load_N"]
    before = int(np.searchsorted(x, edge - REST - 0.522))
    axle = series["axle_height_m"] - series["axle_height_m"][before]
    body = series["body_height_m"] - series["body_height_m"][before]
    force = series["force_z_N"]
    wheel_mass = load / GRAVITY - rig["body_mass"]
    simple = linear(time, lambda t: height if np.interp(t, time, x) > edge else 0.0, rig["body_mass"], wheel_mass,
                    rig["suspension_stiffness"], rig["suspension_damping"])
    made = provenance.made_here(provenance.program())
    near = (x > edge - 1.2) & (x < edge + 3.0)
    with open(HERE / "curb.csv", "w", newline="", encoding="utf-8") as file:
        provenance.write_header(file, made)
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("time_s", "x_from_edge_m", "axle_m", "body_m", "ground_force_N", "simple_axle_m", "simple_body_m",
                         "simple_force_N"))
        for k in np.flatnonzero(near):
            writer.writerow([f"{value:.6g}" for value in (time[k], x[k] - edge, axle[k], body[k], force[k], *simple[k])])
    after = x > edge - 1.2
    felt = np.flatnonzero(after & (np.abs(series["force_x_N"]) > FELT * load))[0]
    risen = np.flatnonzero(after & (axle > FELT * height))[0]
    over = int(np.searchsorted(x, edge))
    simple_risen = np.flatnonzero(simple[:, 0] > FELT * height)[0]
    figures = [("contact begins at, before the edge", "m", edge - x[felt]),
               ("planar tire: centre has risen 2 % of the curb at, before the edge", "m", edge - x[risen]),
               ("spring and damper: the same", "m", edge - x[simple_risen]),
               ("planar tire: height of the centre over the edge, of the curb's", "-", axle[over] / height),
               ("planar tire: highest centre over the curb", "m", np.max(axle[after]) - height),
               ("spring and damper: highest centre over the curb", "m", np.max(simple[after, 0]) - height),
               ("planar tire: least force of the ground after the edge, of the load", "-", np.min(force[x > edge]) / load),
               ("planar tire: time off the ground", "s", stretches(time[after], force[after] < AIR * load)),
               ("planar tire: largest force of the ground, of the load", "-", np.max(force[after]) / load),
               ("spring and damper: largest force, of the load", "-", np.max(simple[after, 2]) / load)]
    with open(HERE / "curb_figures.csv", "w", newline="", encoding="utf-8") as file:
        provenance.write_header(file, made)
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("what", "unit", "value"))
        for what, unit, value in figures:
            writer.writerow((what, unit, f"{value:.4g}"))
            print(f"{what}: {value:.4g} {unit}")
    figure, (*axes, wheel) = plt.subplots(1, 3, figsize=(17, 4.8), layout="constrained", width_ratios=(1, 1, 1.4))
    draw_wheel(wheel, run, np.array(scenario["terrain"]["profile"]), edge)
    for axis, mine, theirs, factor in ((axes[0], axle, simple[:, 0], 1e3), (axes[1], force, simple[:, 2], 1e-3)):
        axis.plot(time[near], factor * mine[near], color=style.SKY, label="planar finite elements")
        axis.plot(time[near], factor * theirs[near], "--", color=style.ORANGE, label="spring and damper")
        axis.axvline(time[over], color="0.6", lw=0.8)
    lifted = near & (force < AIR * load)
    if lifted.any():
        axes[0].plot(time[lifted], 1e3 * axle[lifted], ".", color=style.BLUE, label="off the ground")
    axes[0].set(xlabel="time, s", ylabel="height of the centre over rest, mm",
                title=f"curb of {height:g} m at {rig['speed']:g} m/s; grey: centre over the edge")
    axes[1].set(xlabel="time, s", ylabel="force of the ground, kN", title="vertical force")
    for axis in axes:
        axis.legend(fontsize=9)
    figure.savefig(HERE / "curb.png", dpi=100)


if __name__ == "__main__":
    main()
