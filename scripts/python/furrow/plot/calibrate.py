"""A model fitted to data: what `furrow calibrate` leaves in its directory."""
import csv

import matplotlib.pyplot as plt
import numpy as np

from .run_data import Missing, read_object
from .soil import COLOURS
from .style import GREY, RED, heading
from .units import naming

COLUMNS = 3  # panels side by side


class Calibration:
    """calibration.json and fit.csv."""

    def __init__(self, directory):
        self.directory = directory
        self.values = read_object(directory / "calibration.json")

    def title(self, figure, what):
        heading(figure, f"{self.values.get('study', self.directory.name)} · {self.values.get('calibrate', '')} · "
                        f"{what}", 11)

    def targets(self):
        """What calibration.json says of each target, with x_name and y_name, and its points: x, data, sigma, model
        (NaN: no answer), labels."""
        points = {}
        with open(self.directory / "fit.csv", newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                points.setdefault(row["target"], []).append(row)
        found = []
        for key in ("targets", "held_out_targets"):
            for told in self.values.get(key) or []:
                rows = points.get(told.get("name"))
                if not rows:
                    raise Missing(f"fit.csv has no points of {told.get('name')}")
                columns = {name: np.array([float(row[name] or "nan") for row in rows])
                           for name in ("x", "data", "sigma", "model")}
                found.append({**told, "x_name": told.get("x"), "y_name": told.get("y"), **columns,
                              "held_out": key == "held_out_targets", "labels": [row["label"] for row in rows]})
        if not found:
            raise Missing("there are no targets")
        return found


def quantity(name):
    """(words, unit, factor) of a column such as deflection_m; forces are in kN."""
    words, unit, factor = naming(str(name))
    return (words, "kN", 1e-3) if unit == "N" else (words, unit, factor)


def panels_of(targets):
    """The targets that share axes: curves of the same quantities, and each list of figures alone."""
    groups = {}
    for target in targets:
        alone = target["name"] if any(target["labels"]) else ""
        groups.setdefault((target["x_name"], target["y_name"], alone), []).append(target)
    return groups


def figure_of(run, what):
    """Panels in rows of COLUMNS or fewer."""
    groups = panels_of(run.targets())
    columns = min(len(groups), COLUMNS)
    rows = -(-len(groups) // columns)
    wide = 7.6 if columns == 1 else 5.0
    height = 5.0 if rows == 1 else 3.2 * rows
    figure, axes = plt.subplots(rows, columns, figsize=(wide * columns, height), squeeze=False)
    run.title(figure, what)
    for axis in axes.flat[len(groups):]:
        axis.set_visible(False)
    return groups, figure, axes.flat


def mark_places(axis, target):
    """Writes at the axis what the places of figures are: rows of a table, or nothing of a single one. @returns them"""
    place = target["x"]
    axis.set_xlim(place[0] - 0.6, place[-1] + 0.6)
    if len(place) == 1:
        axis.set_xticks([])
    else:
        axis.set_xlabel(target["x_name"])
        axis.xaxis.get_major_locator().set_params(integer=True)
    return place


def label_of(name):
    return ", ".join(filter(None, quantity(name)[:2]))


def fit_of_figures(axis, target, colour):
    single = len(target["x"]) == 1
    factor = 1.0 if single else quantity(target["y_name"])[2]
    place, told = mark_places(axis, target), target.get("figures") or []
    axis.errorbar(place, factor * target["data"], factor * target["sigma"],
                  fmt="o", color=colour, ms=4, capsize=3, label="data")
    spans = [figure.get("evaluations_span") for figure in told]
    if len(spans) == len(place) and all(spans):
        axis.vlines(place + 0.15, *(factor * np.array(spans).T), color=GREY, lw=1.0, alpha=0.6, label="all evaluations")
    errors = [factor * (figure.get("standard_error") or 0.0) for figure in told]
    axis.errorbar(place + 0.15, factor * target["model"], errors if len(errors) == len(place) and any(errors) else None,
                  fmt="_", ms=10, capsize=3, color=RED, label="model, held out" if target["held_out"] else "model")
    axis.set(ylabel=target["y_name"] if single else label_of(target["y_name"]))


def fit(run):
    groups, figure, axes = figure_of(run, "data (points) and model (lines; dashed: held out)")
    for axis, ((x, y, alone), targets) in zip(axes, groups.items()):
        (_, _, x_factor), (_, _, y_factor) = quantity(x), quantity(y)
        for k, target in enumerate(targets):
            colour = COLOURS[k % len(COLOURS)]
            if alone:
                fit_of_figures(axis, target, colour)
                continue
            axis.plot(x_factor * target["x"], y_factor * target["data"], "o", ms=3.5, color=colour)
            axis.plot(x_factor * target["x"], y_factor * target["model"], "--" if target["held_out"] else "-",
                      color=colour, label=f"{target['name']} ({target.get('what', '')})")
        if alone:
            axis.set_title(alone)
        else:
            axis.set(xlabel=label_of(x), ylabel=label_of(y))
        axis.legend(fontsize=7.5)
    return figure


def residual(run):
    groups, figure, axes = figure_of(run, "model less data, of the target's peak (open: held out)")
    for axis, ((x, _, alone), targets) in zip(axes, groups.items()):
        axis.axhline(0.0, color=GREY, lw=0.8)
        for k, target in enumerate(targets):
            peak = np.max(np.abs(target["data"])) or 1.0
            place = mark_places(axis, target) if alone else quantity(x)[2] * target["x"]
            axis.plot(place, 100.0 * (target["model"] - target["data"]) / peak,
                      "o", ms=3, color=COLOURS[k % len(COLOURS)],
                      mfc="none" if target["held_out"] else None, label=f"{target['name']} ({target.get('what', '')})")
        if alone:
            axis.set_title(alone)
        else:
            axis.set_xlabel(label_of(x))
            axis.legend(fontsize=7.5)
        axis.set_ylabel("model less data, % of the peak" if len(groups) <= COLUMNS else "% of the peak")
    return figure
