"""The suspensions of a vehicle against travel and steering: what `furrow kc` leaves in its directory."""
import csv

import matplotlib.pyplot as plt
import numpy as np

from .run_data import Damaged, Missing, read_object
from .style import BLUE, GREEN, GREY, ORANGE, PURPLE, RED, SKY, heading

COLOURS = [BLUE, ORANGE, GREEN, RED, PURPLE, SKY]
DEGREES = 180.0 / np.pi

# column, factor, label of the axis
CAMBER = ("camber_rad", DEGREES, "camber, °")
TOE = ("toe_rad", DEGREES, "toe-in, °")
HALF_TRACK = ("half_track_m", 1e3, "half-track, mm")
ROLL_CENTER = ("roll_center_m", 1e3, "roll centre above ground, mm")
WHEEL_RATE = ("wheel_rate_N_per_m", 1e-3, "wheel rate, kN/m")
CASTER = ("caster_rad", DEGREES, "caster, °")
KINGPIN = ("kingpin_rad", DEGREES, "kingpin, °")
SCRUB = ("scrub_m", 1e3, "scrub radius, mm")
TRAIL = ("trail_m", 1e3, "trail, mm")
SPRING_RATIO = ("spring_ratio", 1.0, "motion ratio of the spring")
SHOCK_RATIO = ("shock_ratio", 1.0, "motion ratio of the shock")
ANTI_DIVE = ("anti_dive", 100.0, "anti-dive, anti-lift, %")
STEER = ("steer_rad", DEGREES, "steer angle to the left, °")
ACKERMANN = ("ackermann", 100.0, "Ackermann, %")
TRAVEL = ("travel_m", 1e3, "wheel travel upward, mm")
WHEEL = ("steering", 1.0, "steering, 1 fully left")


class Kinematics:
    """kinematics.csv, by motion and wheel, and summary.json."""

    def __init__(self, directory):
        self.directory = directory
        self.values = read_object(directory / "summary.json")
        with open(directory / "kinematics.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.motions = {}
        for row in rows:
            self.motions.setdefault(row.get("motion"), {}).setdefault(row.get("wheel"), []).append(row)

    def curves(self, motion, name):
        """(wheel, values) of a column; nan where a quantity does not exist."""
        for wheel, rows in self.motions.get(motion, {}).items():
            try:
                yield str(wheel), np.array([float(row[name]) if row[name] else np.nan for row in rows])
            except (TypeError, ValueError) as error:
                raise Damaged(f"kinematics.csv: column '{name}' holds something that is no number: {error}") from error

    def rest(self):
        """{wheel: travel at rest, m}"""
        wheels = (self.values.get("at_rest") or {}).get("wheels") or []
        return {wheel["name"]: wheel["travel_m"] for wheel in wheels}


def draw(run, motion, against, panels, columns, what):
    if motion not in run.motions:
        raise Missing(f"no axle of this vehicle has the motion '{motion}'")
    name, factor, label = against
    shown = [panel for panel in panels if any(np.isfinite(values).any() for _, values in run.curves(motion, panel[0]))]
    if not shown:
        raise Missing(f"kinematics.csv has no figures of the motion '{motion}'")
    rows = -(-len(shown) // columns)
    figure, axes = plt.subplots(rows, columns, figsize=(3.6 * columns, 2.7 * rows), squeeze=False, sharex=True)
    heading(figure, f"{run.values.get('vehicle')} · {what}")
    places = dict(run.curves(motion, name))
    colour = {axle: COLOURS[k % len(COLOURS)] for k,
              axle in enumerate(dict.fromkeys(wheel.rsplit(" ", 1)[0] for wheel in places))}
    for axis, (column, scale, title) in zip(axes.flat, shown):
        for wheel, values in run.curves(motion, column):
            axis.plot(factor * places[wheel], scale * values, "--" if wheel.endswith("right") else "-", label=wheel,
                      color=colour[wheel.rsplit(" ", 1)[0]])
        axis.set_title(title)
        if against is TRAVEL:
            for wheel, travel in run.rest().items():
                if wheel in places:
                    axis.axvline(1e3 * travel, color=GREY, lw=0.6)
    for axis in list(axes.flat)[len(shown):]:
        axis.set_visible(False)
    for axis in axes[-1]:
        axis.set_xlabel(label)
    axes[0][0].legend(fontsize=7.5)
    return figure


def parallel(run):
    return draw(run, "parallel", TRAVEL, [CAMBER, TOE, CASTER, KINGPIN, HALF_TRACK, SCRUB, TRAIL, ROLL_CENTER,
                                          ANTI_DIVE, SPRING_RATIO, SHOCK_RATIO, WHEEL_RATE], 4,
                "both wheels of an axle lifted alike (grey: at rest)")


def opposite(run):
    return draw(run, "opposite", TRAVEL, [CAMBER, TOE, HALF_TRACK, ROLL_CENTER, SPRING_RATIO, WHEEL_RATE], 3,
                "one wheel of an axle lifted, the other lowered (grey: at rest)")


def steering(run):
    return draw(run, "steering", WHEEL, [STEER, ACKERMANN, CAMBER, CASTER, KINGPIN, SCRUB, TRAIL, HALF_TRACK],
                4, "steered, wheels as drawn")
