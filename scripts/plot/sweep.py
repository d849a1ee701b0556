"""Studies: what `furrow sweep` leaves in its directory."""
import csv
import json
import math

import matplotlib.pyplot as plt
import numpy as np

from .run_data import Missing
from .style import BLUE, GREEN, GREY, ORANGE, PURPLE, RED, SKY

COLOURS = [BLUE, ORANGE, GREEN, RED, PURPLE, SKY, GREY]


class Sweep:
    """sweep.json, sweep.csv and the folders of the runs that are done."""

    def __init__(self, directory):
        self.directory = directory
        self.values = json.loads((directory / "sweep.json").read_text(encoding="utf-8"))
        with open(directory / "sweep.csv", newline="", encoding="utf-8") as file:
            self.rows = [row for row in csv.DictReader(file) if row["state"] == "done"]
        self.plot = self.values.get("plot") or {}

    def summary(self, row):
        return json.loads((self.directory / row["folder"] / "summary.json").read_text(encoding="utf-8"))

    def title(self):
        return f"{self.values.get('study', self.directory.name)}"


def number(text):
    """A cell as a number; NaN for anything else."""
    try:
        return float(text)
    except (TypeError, ValueError):
        return math.nan


def curve(sweep):
    """y over x with error bars, one line per value of a third key, as the study's plot says."""
    plot = sweep.plot
    if sweep.values.get("passes") or not plot.get("x") or not plot.get("y"):
        raise Missing("the study asks for no such plot")
    if not sweep.rows:
        raise Missing("no run is done")
    groups = {}
    for row in sweep.rows:
        groups.setdefault(row.get(plot.get("lines", ""), ""), []).append(row)
    figure, axis = plt.subplots(figsize=(8.4, 5.0))
    for i, (label, rows) in enumerate(groups.items()):
        points = sorted((number(row.get(plot["x"])), number(row.get(plot["y"])), number(row.get(plot.get("error", "")))) for row in rows)
        x, y, error = np.array(points).T
        axis.errorbar(x, y, yerr=None if np.isnan(error).all() else np.nan_to_num(error), marker="o", capsize=3,
                      color=COLOURS[i % len(COLOURS)], label=f"{plot['lines']} = {label}" if label else None)
    axis.axhline(0.0, color=GREY, lw=0.8)
    axis.set_xlabel(plot["x"])
    axis.set_ylabel(plot["y"] + (" (bars: standard error)" if plot.get("error") else ""))
    axis.set_title(sweep.title(), loc="left", fontweight="bold")
    if any(groups):
        axis.legend()
    return figure


def passes(sweep):
    """Pull, sinkage and rut against the number of the pass."""
    if not sweep.values.get("passes"):
        raise Missing("the study has no passes")
    summaries = [sweep.summary(row) for row in sweep.rows]
    if not summaries:
        raise Missing("no pass is done")
    pass_number = np.arange(1, len(summaries) + 1)
    pull = [s["drawbar_pull_N"] for s in summaries]
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(14.0, 4.6))
    left.errorbar(pass_number, [number(p["mean"]) for p in pull], yerr=[number(p["sem"]) for p in pull], marker="o", capsize=4, color=BLUE)
    left.set_ylabel("drawbar pull, N (bars: standard error)")
    sinkage = 1e3 * np.array([number(s["sinkage_m"]) for s in summaries])
    middle.plot(pass_number, sinkage, "o-", color=ORANGE, label="sinkage below the undisturbed surface")
    middle.bar(pass_number, np.diff(sinkage, prepend=0.0), width=0.3, color=ORANGE, alpha=0.35, label="increment of the pass")
    middle.plot(pass_number, [1e3 * number(s["bed_clearance_m"]) for s in summaries], "s--", color=GREY, label="tire to floor")
    middle.set_ylabel("mm")
    middle.legend(fontsize=8)
    for axis in (left, middle):
        axis.set_xlabel("pass")
        axis.set_xticks(pass_number)
    profiles(sweep, right)
    figure.suptitle(f"{sweep.title()} · {sweep.values.get('rest_s', 0):g} s of rest between passes", x=0.01, ha="left", fontweight="bold")
    figure.tight_layout()
    return figure


def heights(sweep, row):
    """x, y of the cells, undisturbed and final height of a pass, m."""
    import h5py
    with h5py.File(sweep.directory / row["folder"] / "results.h5", "r") as file:
        x0, y0, cell = file["terrain/height_before_grid"][()]
        before, after = file["terrain/height_before"][()], file["terrain/height_after"][()]
    x = x0 + cell * np.arange(after.shape[0])
    y = y0 + cell * np.arange(after.shape[1])
    return x, y, before, after


def profiles(sweep, axis):
    """The rut across, mean over the middle of the path, against the surface before the first pass."""
    undisturbed = None
    for i, row in enumerate(sweep.rows):
        x, y, before, after = heights(sweep, row)
        undisturbed = before if undisturbed is None else undisturbed
        middle = (x > x[0] + 0.35 * (x[-1] - x[0])) & (x < x[0] + 0.65 * (x[-1] - x[0]))
        axis.plot(1e3 * y, 1e3 * np.nanmean((after - undisturbed)[middle], axis=0), color=COLOURS[i], label=f"after pass {i + 1}")
    axis.axhline(0.0, color=GREY, lw=0.8)
    axis.set_xlabel("across, mm (mean over the middle 30 % of the bed)")
    axis.set_ylabel("surface against undisturbed, mm")
    axis.legend(fontsize=8)


def rut_along(sweep):
    """The rut along the path, mean over the middle of the tread."""
    if not sweep.values.get("passes") or not sweep.rows:
        raise Missing("the study has no passes that are done")
    figure, axis = plt.subplots(figsize=(9.0, 4.4))
    undisturbed = None
    for i, row in enumerate(sweep.rows):
        x, y, before, after = heights(sweep, row)
        undisturbed = before if undisturbed is None else undisturbed
        summary = sweep.summary(row)
        tread = np.abs(y - summary["lateral_m"]) < 0.25 * summary["tread_width_m"]
        axis.plot(x, 1e3 * np.nanmean((after - undisturbed)[:, tread], axis=1), color=COLOURS[i], label=f"after pass {i + 1}")
    axis.axhline(0.0, color=GREY, lw=0.8)
    axis.set_xlabel("along, m")
    axis.set_ylabel("surface against undisturbed, mm")
    axis.set_title(f"{sweep.title()} · middle half of the tread", loc="left", fontweight="bold")
    axis.legend()
    return figure
