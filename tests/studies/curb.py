#!/usr/bin/python3
"""A planar tire over the curb of rigs/curb.json, as the wheel of a quarter car and with all the mass on its axle,
beside a spring and a damper in its place, which know of the road only how high it is under the wheel's centre. Writes
curb.csv (both over time), curb_figures.csv (what is derived) and curb.png beside this script.

The linear model has the masses and the suspension of the run; its tire spring is the measured radial stiffness of the
tire's source, its damper 0.13 of the critical damping of the quarter car's wheel. Heights count from rest on the flat
before the curb.

    build/furrow run rigs/curb.json --out results/curb
    build/furrow run rigs/curb.json --set rig.speed=2 --set rig.unsprung_mass=1290 --set rig.body_mass=1 \
      --set run.end=4.6 --set run.average_from=4.3 --out results/curb_axle
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
# m before the edge, where the wheel is at rest on the flat: it has been let down, and does not feel the curb yet
REST = 0.5
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
    axis.set(xlabel="from the edge, m", ylabel="height, m", xlim=(-1.75, 1.45),
             ylim=(-0.1, 1.6), aspect="equal", title="deformed tire")


def stretches(times, flags):
    """Time during which the flag is set, s."""
    return float(np.sum(np.diff(times)[flags[:-1]])) if len(times) > 1 else 0.0


class Passage:
    """A run over the curb beside the linear model; places count from the edge, heights from rest."""

    def __init__(self, name, run):
        scenario = json.loads((run / "scenario.json").read_text(encoding="utf-8"))
        series = np.genfromtxt(run / "timeseries.csv", delimiter=",", names=True)
        rig = scenario["rig"]
        self.name, self.run, self.speed, self.profile = (name, run, rig["speed"],
                                                         np.array(scenario["terrain"]["profile"]))
        self.edge, self.height = self.profile[1]
        self.time, self.x = series["time_s"], series["position_m"] - self.edge
        self.load = json.loads((run / "summary.json").read_text(encoding="utf-8"))["vertical_load_N"]
        before = int(np.searchsorted(self.x, -REST - 0.522))
        self.axle = series["axle_height_m"] - series["axle_height_m"][before]
        self.body = series["body_height_m"] - series["body_height_m"][before]
        self.force, self.push = series["force_z_N"], series["force_x_N"]
        self.simple = linear(self.time, lambda t: self.height if np.interp(t, self.time, self.x) > 0.0 else 0.0,
                             rig["body_mass"],
                             self.load / GRAVITY - rig["body_mass"], rig["suspension_stiffness"],
                             rig["suspension_damping"])
        self.near = (self.x > -1.2) & (self.x < 3.0)

    def rows(self):
        for k in np.flatnonzero(self.near)[::2]:
            yield [self.name,
                   *(f"{value:.5g}" for value in (self.time[k], self.x[k], self.axle[k], self.body[k], self.force[k],
                                                  *self.simple[k]))]

    def figures(self):
        """(what, unit, planar tire, spring and damper)"""
        after, over = self.x > -1.2, int(np.searchsorted(self.x, 0.0))
        felt = np.flatnonzero(after & (np.abs(self.push) > FELT * self.load))[0]

        def risen(axle):
            return -self.x[np.flatnonzero(after & (axle > FELT * self.height))[0]]

        return [("contact with the curb begins, before the edge", "m", -self.x[felt], 0.0),
                ("the centre has risen 2 % of the curb, before the edge",
                 "m", risen(self.axle), risen(self.simple[:, 0])),
                ("height of the centre over the edge, of the curb's", "-",
                 self.axle[over] / self.height, self.simple[over, 0] / self.height),
                ("highest centre over the curb", "m", np.max(self.axle[after]) - self.height,
                 np.max(self.simple[after, 0]) - self.height),
                ("least force of the ground after the edge, of the load",
                 "-", np.min(self.force[self.x > 0.0]) / self.load,
                 np.min(self.simple[self.x > 0.0, 2]) / self.load),
                ("time off the ground", "s", stretches(self.time[after], self.force[after] < AIR * self.load), None),
                ("largest force of the ground, of the load", "-", np.max(self.force[after]) / self.load,
                 np.max(self.simple[after, 2]) / self.load)]

    def draw(self, height, force, wheel):
        draw_wheel(wheel, self.run, self.profile, self.edge)
        for axis, mine, theirs, factor in ((height, self.axle, self.simple[:, 0], 1e3),
                                           (force, self.force, self.simple[:, 2], 1e-3)):
            axis.plot(self.time[self.near], factor * mine[self.near], color=style.SKY, label="planar finite elements")
            axis.plot(self.time[self.near], factor * theirs[self.near],
                      "--", color=style.ORANGE, label="spring and damper")
            axis.axvline(np.interp(0.0, self.x, self.time), color="0.6", lw=0.8)
            axis.set_xlabel("time, s")
        lifted = self.near & (self.force < AIR * self.load)
        if lifted.any():
            height.plot(self.time[lifted], 1e3 * self.axle[lifted], ".", ms=3, color=style.BLUE, label="off the ground")
        height.set(ylabel="height of the centre over rest, mm",
                   title=f"{self.name}, {self.speed:g} m/s; grey: centre over the edge")
        force.set(ylabel="force of the ground, kN", title="vertical force")
        height.legend(fontsize=9)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--results", type=pathlib.Path, default=ROOT / "results",
                        help="folder of the runs curb and curb_axle")
    results = parser.parse_args().results
    passages = [Passage("quarter car", results / "curb"), Passage("mass on the axle", results / "curb_axle")]
    made = provenance.made_here(provenance.program())
    with open(HERE / "curb.csv", "w", newline="", encoding="utf-8") as file:
        provenance.write_header(file, made)
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("case", "time_s", "x_from_edge_m", "axle_m", "body_m",
                         "ground_force_N", "simple_axle_m", "simple_body_m",
                         "simple_force_N"))
        for passage in passages:
            writer.writerows(passage.rows())
    with open(HERE / "curb_figures.csv", "w", newline="", encoding="utf-8") as file:
        provenance.write_header(file, made)
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("case", "what", "unit", "planar_tire", "spring_and_damper"))
        for passage in passages:
            for what, unit, *values in passage.figures():
                writer.writerow((passage.name, what, unit,
                                 *("" if value is None else f"{value:.4g}" for value in values)))
    figure, grid = plt.subplots(len(passages), 3, figsize=(17, 9.6), layout="constrained", width_ratios=(1, 1, 1.4))
    for passage, row in zip(passages, grid):
        passage.draw(*row)
    figure.savefig(HERE / "curb.png", dpi=62)


if __name__ == "__main__":
    main()
