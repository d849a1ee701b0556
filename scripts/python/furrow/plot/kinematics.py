"""The suspensions of a vehicle against travel and steering: what `furrow kc` leaves in its directory."""
import csv

import matplotlib.pyplot as plt
import numpy as np

from .chart_table import MOTIONS, Chart
from .run_data import Damaged, Missing, read_object
from .style import BLUE, GREEN, GREY, ORANGE, PURPLE, RED, SKY, heading
from .units import naming

COLOURS = [BLUE, ORANGE, GREEN, RED, PURPLE, SKY]


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

    def charts(self, motion):
        """Those of the motion whose columns hold figures."""
        _, against, columns = MOTIONS[motion]
        return [Chart(naming(name)[0].capitalize(), {name: ""}, **against) for name in columns
                if any(np.isfinite(values).any() for _, values in self.curves(motion, name))]

    def rest(self):
        """{wheel: travel at rest, m}"""
        wheels = (self.values.get("at_rest") or {}).get("wheels") or []
        return {wheel["name"]: wheel["travel_m"] for wheel in wheels}


def draw(run, motion, columns):
    """The columns of a motion that exist, over its abscissa, `columns` panels side by side."""
    if motion not in run.motions:
        raise Missing(f"no axle of this vehicle has the motion '{motion}'")
    charts = run.charts(motion)
    if not charts:
        raise Missing(f"kinematics.csv has no figures of the motion '{motion}'")
    rows = -(-len(charts) // columns)
    figure, axes = plt.subplots(rows, columns, figsize=(3.6 * columns, 2.7 * rows), squeeze=False, sharex=True)
    at_rest = run.rest() if charts[0].x == "travel_m" else {}
    heading(figure, f"{run.values.get('vehicle')} · {MOTIONS[motion][0]}{' (grey: at rest)' if at_rest else ''}")
    places = {wheel: charts[0].places({charts[0].x: values}) for wheel, values in run.curves(motion, charts[0].x)}
    colour = {axle: COLOURS[k % len(COLOURS)] for k,
              axle in enumerate(dict.fromkeys(wheel.rsplit(" ", 1)[0] for wheel in places))}
    for axis, chart in zip(axes.flat, charts):
        column, = chart.lines
        for wheel, values in run.curves(motion, column):
            axis.plot(places[wheel], chart.values({column: values}, column), "--" if wheel.endswith("right") else "-",
                      label=wheel, color=colour[wheel.rsplit(" ", 1)[0]])
        axis.set_title(chart.label)
        for wheel, travel in at_rest.items():
            if wheel in places:
                axis.axvline(1e3 * travel, color=GREY, lw=0.6)
    for axis in list(axes.flat)[len(charts):]:
        axis.set_visible(False)
    for axis in axes[-1]:
        axis.set_xlabel(charts[0].x_label)
    axes[0][0].legend(fontsize=7.5)
    return figure


def parallel(run):
    """Suspensions against travel of both wheels of an axle."""
    return draw(run, "parallel", 4)


def opposite(run):
    """Suspensions against opposite travel of the wheels of an axle."""
    return draw(run, "opposite", 3)


def steering(run):
    """Suspensions against steering."""
    return draw(run, "steering", 4)
