"""Studies: what `furrow sweep` leaves in its directory."""
import csv
import math

import matplotlib.pyplot as plt
import numpy as np

from .digits import with_error
from .keys import named, unit_of
from .run_data import Damaged, Missing, read_heights, read_object
from .student import half_interval
from .style import BLUE, GREEN, GREY, ORANGE, PURPLE, RED, SKY, heading

COLOURS = [BLUE, ORANGE, GREEN, RED, PURPLE, SKY, GREY]
BROKEN = [":", "--", "-.", (0, (6, 2, 1, 2, 1, 2)), (0, (1, 4))]  # lines that cannot be told apart by colour


class Sweep:
    """sweep.json, sweep.csv and the folders of the runs that are done."""

    def __init__(self, directory):
        self.directory = directory
        self.values = read_object(directory / "sweep.json")
        with open(directory / "sweep.csv", newline="", encoding="utf-8") as file:
            table = csv.DictReader(line for line in file if not line.startswith("#"))
            rows = list(table)
        if missing := {"state", "folder"} - set(table.fieldnames or ()):
            raise Damaged(f"sweep.csv has no column '{min(missing)}', expected the table that furrow sweep wrote")
        self.rows = [row for row in rows if row["state"] == "done"]
        self.failed = [row for row in rows if row["state"] == "failed"]
        self.plot = self.values.get("plot") or {}

    def summary(self, row):
        return read_object(self.directory / row["folder"] / "summary.json")

    def title(self):
        return f"{self.values.get('study', self.directory.name)}"


def number(text):
    """A cell as a number; NaN for anything else."""
    try:
        return float(text)
    except (TypeError, ValueError):
        return math.nan


def mean_and_interval(values):
    """(mean, half the 95 % interval of the mean); NaN for the interval of one value."""
    return float(np.mean(values)), half_interval(values)


def keys_among(columns, results):
    """The columns of a table that are keys of the scenario: those that the runs differ in."""
    last = max((k for k, name in enumerate(columns) if name in ("exit_code", "pass")), default=len(columns))
    return [name for name in columns[last + 1:] if name not in results and name != "problem"]


def keys_of(sweep):
    """The keys of the scenario that the runs differ in."""
    columns = [name for name in next(iter(sweep.rows + sweep.failed), {}) if name]
    return keys_among(columns, sweep.values.get("results", []))


def varied(sweep):
    """The keys that the runs differ in, without those that points are means over."""
    if not sweep.rows:
        raise Missing("no run is done")
    return [name for name in keys_of(sweep) if name != sweep.plot.get("mean_over")]


def unsteady(row):
    """Whether the table says that the run's pull is not steady."""
    return (row.get("drawbar_pull_N.steady") or "").lower() == "false"


def points(rows, x, y, error, over):
    """Rows x, y, half bar, sorted by x: each run, or the mean over the runs with the same x with its 95 % interval; and
    1 where a run of the point is not steady."""
    if not over:
        return np.array(sorted((number(row.get(x)), number(row.get(y)), number(row.get(error)), unsteady(row))
                               for row in rows)).T
    same = {}
    for row in rows:
        same.setdefault(number(row.get(x)), []).append(row)
    return np.array([(at, *mean_and_interval([number(row.get(y)) for row in group]), any(map(unsteady, group)))
                     for at, group in sorted(same.items())]).T


def open_points(axis, x, y, which, colour):
    """Draws those points open, and says what that means."""
    which = np.asarray(which, bool)
    if not which.any():
        return
    axis.plot(np.asarray(x)[which], np.asarray(y)[which], ls="none", marker="o", mfc="white", mec=colour, zorder=5)
    axis.annotate("open: not steady", (0.99, 0.02), xycoords="axes fraction",
                  ha="right", va="bottom", fontsize=8.5, color=RED)


def bars(error):
    return None if np.isnan(error).all() else np.nan_to_num(error)


def cell(text, factor=1.0):
    """A cell of sweep.csv as people are shown it."""
    value = factor * number(text)
    if not math.isfinite(value) or (factor == 1.0 and "." not in text):
        return str(text or "")
    return f"{value:.4g}" if abs(value) < 1e4 else f"{value:.6g}"


def group_label(plot, value):
    """Of the line that has this value of the key `lines`."""
    return f"{plot['lines']} = {cell(value)} {unit_of(plot['lines'])}".rstrip()


def bar_meaning(plot):
    if plot.get("mean_over"):
        return f" (mean over {plot['mean_over']}, bars: 95 %)"
    return " (bars: standard error)" if plot.get("error") else ""


def mark_failed(axis, sweep, factors):
    """A cross for each run that failed: at the mean of what there is, at the foot of the figure where there is none."""
    x, y = (factor * np.array([number(row.get(sweep.plot[name])) for row in sweep.failed])
            for name, factor in zip("xy", factors))
    known = np.isfinite(x) & np.isfinite(y)
    if known.any():
        axis.plot(x[known], y[known], ls="none", marker="x", ms=9, mew=2, color=RED, label="failed: mean until then")
    lost = np.isfinite(x) & ~np.isfinite(y)
    if lost.any():
        axis.plot(x[lost], np.full(lost.sum(), 0.03), ls="none", marker="x", ms=9, mew=2, color=GREY,
                  transform=axis.get_xaxis_transform(), label="failed: nothing measured")


def regression_lines(axis, sweep):
    """Thin lines of the net traction that published regressions expect, grey and broken where one does not hold."""
    if not sweep.plot["x"].endswith("slip") or sweep.plot["y"] != "drawbar_pull_N.mean":
        return
    lines = {}
    for row in sweep.rows:
        found = sweep.summary(row).get("regressions")
        for of in found.values() if isinstance(found, dict) else ():
            if isinstance(of, dict) and of.get("net_N") is not None:
                at, values = number(row.get(sweep.plot["x"])), lines.setdefault(of["name"], {})
                values.setdefault(at, []).append((of["net_N"], of["in_range"]))
    for i, (name, values) in enumerate(lines.items()):
        holds = all(ok for group in values.values() for _, ok in group)
        x = sorted(values)
        name = name if holds else f"{name} (out of range)"
        axis.plot(x, [np.mean([net for net, _ in values[at]]) for at in x], lw=0.8, zorder=1,
                  ls="-" if holds else BROKEN[i % len(BROKEN)],
                  color=COLOURS[-2 - i % (len(COLOURS) - 1)] if holds else GREY, label=name)


def curve(sweep):
    """y over x with error bars, one line per value of a third key, as the study's plot says."""
    plot = sweep.plot
    if not plot.get("x") or not plot.get("y"):
        raise Missing("the study asks for no such plot")
    if not sweep.rows and not sweep.failed:
        raise Missing("no run is done")
    groups = {}
    for row in sweep.rows:
        groups.setdefault(row.get(plot.get("lines", ""), ""), []).append(row)
    (x_words, x_unit, x_factor), (words, unit, factor) = (named(plot[name], keys_of(sweep)) for name in "xy")
    figure, axis = plt.subplots(figsize=(8.4, 5.0))
    for i, (label, rows) in enumerate(groups.items()):
        x, y, error, which = points(rows, plot["x"], plot["y"], plot.get("error", ""), plot.get("mean_over"))
        axis.errorbar(x_factor * x, factor * y, yerr=bars(factor * error), marker="o", capsize=3,
                      color=COLOURS[i % len(COLOURS)], label=group_label(plot, label) if label else None)
        open_points(axis, x_factor * x, factor * y, which, COLOURS[i % len(COLOURS)])
    axis.axhline(0.0, color=GREY, lw=0.8)
    mark_failed(axis, sweep, (x_factor, factor))
    regression_lines(axis, sweep)
    axis.set(xlabel=", ".join(filter(None, (x_words, x_unit))),
             ylabel=", ".join(filter(None, (words, unit))) + bar_meaning(plot))
    axis.set_title(sweep.title(), loc="left", fontweight="bold")
    if axis.get_legend_handles_labels()[1]:
        axis.legend()
    return figure


def chains(sweep):
    """{text of the keys that differ: rows} of the studies with passes, and of each pass its rows."""
    if not sweep.values.get("passes"):
        raise Missing("the study has no passes")
    keys = varied(sweep)
    groups = {}
    for row in sweep.rows:
        groups.setdefault(", ".join(f"{key} = {row[key]}" for key in keys), []).append(row)
    return groups


def passes(sweep):
    """Pull, sinkage and rut against the number of the pass; means over `mean_over` with their 95 % intervals."""
    groups = chains(sweep)
    over = sweep.plot.get("mean_over")
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(14.0, 4.6))
    for i, (label, rows) in enumerate(groups.items()):
        colour = COLOURS[i % len(COLOURS)]
        of_pass, pull, error, which = points(rows, "pass", "drawbar_pull_N.mean", "drawbar_pull_N.sem", over)
        left.errorbar(of_pass, pull, yerr=bars(error), marker="o", capsize=4, color=colour, label=label)
        open_points(left, of_pass, pull, which, colour)
        by_pass = [[sweep.summary(row) for row in rows if number(row["pass"]) == n] for n in of_pass]
        sinkage, bar = np.array([mean_and_interval([1e3 * number(s["sinkage_m"]) for s in run]) for run in by_pass]).T
        clearance = [np.mean([1e3 * number(s["bed_clearance_m"]) for s in run]) for run in by_pass]
        middle.errorbar(of_pass, sinkage, yerr=bars(bar), marker="o", capsize=4,
                        color=colour, label="sinkage" if i == 0 else None)
        middle.plot(of_pass, clearance, "s--", color=colour, alpha=0.5, label="tire to floor" if i == 0 else None)
    left.set_ylabel("drawbar pull, N" + (bar_meaning(sweep.plot) if over else " (bars: standard error)"))
    middle.set_ylabel("depth, mm")
    middle.legend(fontsize=8)
    if any(groups):
        left.legend(fontsize=8)
    for axis in (left, middle):
        axis.set_xlabel("pass")
        axis.set_xticks(range(1, int(sweep.values["passes"]) + 1))
    profiles(sweep, right)
    heading(figure, f"{sweep.title()} · {sweep.values.get('rest_s', 0):g} s of rest between passes")
    figure.tight_layout()
    return figure


def rut_lines(sweep, axis, where, profile):
    """A line per pass of each group, mean over its runs, of the surface against that before the first pass of the run;
    `profile(x, y, summary, change)` makes it and `where(x, y)` its abscissa."""
    groups = chains(sweep)
    for g, (label, rows) in enumerate(groups.items()):
        undisturbed, lines = None, {}
        for row in rows:
            before, after = read_heights(sweep.directory / row["folder"] / "results.h5")
            if number(row["pass"]) == 1:
                undisturbed = before.z
            x, y = after.x, after.y
            lines.setdefault(int(row["pass"]), []).append(profile(x, y, sweep.summary(row), after.z - undisturbed))
        for n, of_runs in sorted(lines.items()):
            axis.plot(where(x, y), 1e3 * np.nanmean(of_runs, axis=0), color=COLOURS[g % len(COLOURS)],
                      alpha=0.35 + 0.65 * n / len(lines), lw=0.6 + 0.6 * n, label=f"after pass {n}" if not label
                      else f"{label}, pass 1 (thin) to {n}" if n == max(lines) else None)
    axis.axhline(0.0, color=GREY, lw=0.8)


def profiles(sweep, axis):
    """The rut across, mean over the middle of the path, against the surface before the first pass."""
    def across(x, y, _, change):
        middle = (x > x[0] + 0.35 * (x[-1] - x[0])) & (x < x[0] + 0.65 * (x[-1] - x[0]))
        return np.nanmean(change[middle], axis=0)
    rut_lines(sweep, axis, lambda x, y: 1e3 * y, across)
    axis.set(xlabel="y across the bed, mm (mean over the middle 30 % of its length)",
             ylabel="height above the undisturbed surface, mm")
    axis.legend(fontsize=8)


def rut_along(sweep):
    """The rut along the path, mean over the middle of the tread."""
    figure, axis = plt.subplots(figsize=(9.0, 4.4))

    def along(_, y, summary, change):
        tread = np.abs(y - summary["lateral_m"]) < 0.25 * summary["tread_width_m"]
        return np.nanmean(change[:, tread], axis=1)
    rut_lines(sweep, axis, lambda x, y: x, along)
    axis.set(xlabel="x along the bed, m", ylabel="height above the undisturbed surface, mm")
    axis.set_title(f"{sweep.title()} · middle half of the tread", loc="left", fontweight="bold")
    axis.legend(fontsize=8)
    return figure


# Figures of beds: keys of a bed's summary and of its standard error.
OF_BEDS = (("drawbar_pull_N.mean", "drawbar_pull_N.sem"), ("sinkage_m", "sinkage_sem_m"),
           ("rut_depth_m", "rut_depth_sem_m"))


def beds(sweep):
    """Pull, sinkage and rut of every bed with its own standard error, and the mean over beds with its 95 % interval."""
    if not sweep.rows:
        raise Missing("no bed is done")
    at = np.array([number(row["folder"].removeprefix("seed")) for row in sweep.rows])
    which = np.array([unsteady(row) for row in sweep.rows])
    figure, axes = plt.subplots(1, 3, figsize=(13.0, 4.4))
    for axis, (key, sem) in zip(axes, OF_BEDS):
        what, unit, scale = named(key)
        values, errors = (scale * np.array([number(row.get(name)) for row in sweep.rows]) for name in (key, sem))
        if not np.isfinite(values).any():
            axis.set_title(f"{what}: not measured")
            continue
        axis.errorbar(at, values, yerr=bars(errors), ls="none", marker="o",
                      capsize=3, color=BLUE, label="a bed, its own standard error")
        open_points(axis, at, values, which, BLUE)
        mean, half = mean_and_interval(values[np.isfinite(values)])
        axis.axhline(mean, color=ORANGE, label=f"mean over beds {with_error(mean, half)} {unit} (95 %)")
        if math.isfinite(half):
            axis.axhspan(mean - half, mean + half, color=ORANGE, alpha=0.2, lw=0)
        axis.set_xticks(at)
        axis.set(xlabel="bed", ylabel=f"{what}, {unit}")
        axis.legend(fontsize=8, loc="upper left")
        axis.margins(y=0.35)
    lost = f" · {len(sweep.failed)} failed" if sweep.failed else ""
    heading(figure, f"{sweep.title()} on {len(at)} beds{lost}")
    return figure
