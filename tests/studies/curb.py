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
import pathlib

import h5py
import numpy as np

import driver
from furrow.plot import style
import provenance
from driver import ROOT, read_json

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
    from matplotlib.cm import viridis
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
        axis.plot(rim[:, 0] - edge, rim[:, 2], color=viridis(k / max(1, len(shown) - 1)), lw=1.2)
    axis.plot([-2.0, *(profile[:, 0] - edge), 2.0], [profile[0, 1], *profile[:, 1], profile[-1, 1]], color="0.3", lw=2)
    driver.label(axis, "from the edge, m", "height, m", "deformed tire", xlim=(-1.75, 1.45), ylim=(-0.1, 1.6),
                 aspect="equal")


class Passage:
    """A run over the curb beside the linear model; places count from the edge, heights from rest."""

    def __init__(self, name, run):
        scenario, series = read_json(run / "scenario.json"), driver.series(run)
        rig = scenario["rig"]
        self.name, self.run, self.speed = name, run, rig["speed"]
        self.profile = np.array(scenario["terrain"]["profile"])
        self.edge, self.height = self.profile[1]
        self.time, self.x = series["time_s"], series["position_m"] - self.edge
        self.load = driver.summary(run)["vertical_load_N"]
        before = int(np.searchsorted(self.x, -REST - 0.522))
        self.axle = series["axle_height_m"] - series["axle_height_m"][before]
        self.body = series["body_height_m"] - series["body_height_m"][before]
        self.force, self.push = series["force_z_N"], series["force_x_N"]
        self.simple = linear(self.time, lambda t: self.height if np.interp(t, self.time, self.x) > 0.0 else 0.0,
                             rig["body_mass"], self.load / GRAVITY - rig["body_mass"],
                             rig["suspension_stiffness"], rig["suspension_damping"])
        self.near = (self.x > -1.2) & (self.x < 3.0)

    def rows(self):
        columns = {"time_s": self.time, "x_from_edge_m": self.x, "axle_m": self.axle, "body_m": self.body,
                   "ground_force_N": self.force, "simple_axle_m": self.simple[:, 0], "simple_body_m": self.simple[:, 1],
                   "simple_force_N": self.simple[:, 2]}
        return [{"case": self.name, **{name: float(values[k]) for name, values in columns.items()}}
                for k in np.flatnonzero(self.near)[::2]]

    def figures(self):
        """(what, unit, planar tire, spring and damper)"""
        after, beyond, over = self.x > -1.2, self.x > 0.0, int(np.searchsorted(self.x, 0.0))
        felt = np.flatnonzero(after & (np.abs(self.push) > FELT * self.load))[0]
        off = self.force[after] < AIR * self.load
        yield "contact with the curb begins, before the edge", "m", -self.x[felt], 0.0

        def both(what, unit, of):
            return what, unit, *(of(axle, force) for axle, force in ((self.axle, self.force),
                                                                     (self.simple[:, 0], self.simple[:, 2])))
        yield both("the centre has risen 2 % of the curb, before the edge", "m", lambda axle, _:
                   -self.x[np.flatnonzero(after & (axle > FELT * self.height))[0]])
        yield both("height of the centre over the edge, of the curb's", "-", lambda axle, _: axle[over] / self.height)
        yield both("highest centre over the curb", "m", lambda axle, _: np.max(axle[after]) - self.height)
        yield both("least force of the ground after the edge, of the load", "-",
                   lambda _, force: np.min(force[beyond]) / self.load)
        yield "time off the ground", "s", float(np.sum(np.diff(self.time[after])[off[:-1]])), None
        yield both("largest force of the ground, of the load", "-", lambda _, force: np.max(force[after]) / self.load)

    def draw(self, height, force, wheel):
        draw_wheel(wheel, self.run, self.profile, self.edge)
        time = self.time[self.near]
        for axis, mine, theirs, factor in ((height, self.axle, self.simple[:, 0], 1e3),
                                           (force, self.force, self.simple[:, 2], 1e-3)):
            axis.plot(time, factor * mine[self.near], color=style.SKY, label="planar finite elements")
            axis.plot(time, factor * theirs[self.near], "--", color=style.ORANGE, label="spring and damper")
            axis.axvline(np.interp(0.0, self.x, self.time), color="0.6", lw=0.8)
        lifted = self.near & (self.force < AIR * self.load)
        if lifted.any():
            height.plot(self.time[lifted], 1e3 * self.axle[lifted], ".", ms=3, color=style.BLUE, label="off the ground")
        driver.label(height, "time, s", "height of the centre over rest, mm",
                     f"{self.name}, {self.speed:g} m/s; grey: centre over the edge", 9)
        driver.label(force, "time, s", "force of the ground, kN", "vertical force", None)


def main():
    results = driver.options(__doc__, results={"type": pathlib.Path, "default": ROOT / "results",
                                               "help": "folder of the runs curb and curb_axle"}).parse_args().results
    passages = [Passage("quarter car", results / "curb"), Passage("mass on the axle", results / "curb_axle")]
    made = provenance.made_here()
    driver.write("curb.csv", [row for passage in passages for row in passage.rows()], made, 5)
    driver.write("curb_figures.csv", [
        {"case": passage.name, "what": what, "unit": unit, "planar_tire": float(mine), "spring_and_damper": theirs}
        for passage in passages for what, unit, mine, theirs in passage.figures()], made)
    figure, grid = driver.subplots(len(passages), 3, figsize=(17, 9.6), layout="constrained",
                                   gridspec_kw={"width_ratios": (1, 1, 1.4)})
    for passage, row in zip(passages, grid):
        passage.draw(*row)
    driver.save(figure, "curb", 62)


if __name__ == "__main__":
    main()
