"""Plots over time of a run's tables."""
import numpy as np

from ..plot.chart_table import VEHICLE, WHEELS, is_noise
from ..plot.run_data import Missing
from ..plot.units import naming

from . import blocks
from .blobs import thin

MOST_WHEELS = 16  # in one plot

def empty(table, name):
    return name not in table.columns or is_noise(table.columns[name])


class Table:
    """A table of a run, thinned, whose columns become arrays of the page when they are asked for."""

    def __init__(self, run, name, arrays):
        columns = run.table(name)
        if "time_s" not in columns:
            raise Missing(f"there is no {name}")
        self.arrays = arrays
        time = columns.pop("time_s")
        self.time, self.columns, self.bucket = thin(time, columns)
        self.x = arrays.add(self.time, exact=True)
        self.used = set()

    def drawn(self, name, label, values):
        """The line of a column in a chart."""
        self.used.add(name)
        return {"label": label, "x": self.x, "y": self.arrays.add(values), "style": "line"}

    def line(self, name, label=None):
        words, _, factor = naming(name)
        return self.drawn(name, label or words, factor * self.columns[name])

    @property
    def note(self):
        return (f"Each pair of points of a curve is the lowest and the highest of {self.bucket} samples."
                if self.bucket > 1 else "")


def over_time(table, charts, window, levels=None):
    """The charts whose columns the table has, but for those that show nothing beside the ones before."""
    items, levels = [], dict(levels or {})
    for chart in charts:
        curves = [(name, *rest) for name, *rest in chart.curves(table.columns) if not empty(table, name)]
        if not curves or {name for name, *_ in curves} <= table.used:
            continue
        own = [level for name, *_ in curves for level in levels.pop(name, ())]
        items.append({**blocks.of(chart, [table.drawn(*curve) for curve in curves], window, own),
                      "whole": chart is VEHICLE["gear"]})
        limit_slip(items[-1], curves[0][0], table)
    return items


def over_wheels(tables, window, names=(), hard=False):
    """A chart per column with a line per wheel. `names` of all wheels, or none; `hard`: nothing sinks."""
    items = []
    for key, chart in WHEELS.items():
        column, = chart.lines
        lines = [table.drawn(column, names[k] if k < len(names) else f"wheel {k}", chart.values(table.columns, column))
                 for k, table in list(tables.items())[:MOST_WHEELS] if not empty(table, column)]
        if lines and key != ("sinkage" if hard else "deflection"):
            items.append(blocks.of(chart, lines, window))
            limit_slip(items[-1], column, *tables.values())
    return items


def limit_slip(chart, name, *tables):
    """Of a wheel that stands, the slip is any number: the plot then begins with a part of it in view."""
    if name == "slip" and any(np.nanmax(np.abs(table.columns[name]), initial=0.0) > 2.0
                              for table in tables if name in table.columns):
        chart["clip"] = [-1.5, 1.5]
        chart["title"] += " (only ±1.5 shown)"


def explorer(table, window, most=80):
    """Every column that no plot shows yet, to be chosen from a list."""
    items = []
    for name, values in table.columns.items():
        if name not in table.used and len(items) < most and np.isfinite(values).any():
            words, unit, _ = naming(name)
            items.append(blocks.chart(words.capitalize(), "time", "s", unit, [table.line(name)], window))
    return {"type": "explorer", "charts": items} if items else None
