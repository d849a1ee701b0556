"""A model fitted to data: what `furrow calibrate` leaves in its directory."""
import csv

import matplotlib.pyplot as plt
import numpy as np

from .run_data import Missing, check_types, read_object
from .soil import COLOURS
from .style import GREY

SCALES = {"m": ("mm", 1e3), "N": ("kN", 1e-3), "Pa": ("kPa", 1e-3)}


class Calibration:
    """calibration.json and fit.csv."""

    def __init__(self, directory):
        self.directory = directory
        self.values = read_object(directory / "calibration.json")
        check_types(self.values, "calibration.json", texts=("study", "calibrate", "start", "result"),
                    objects=("parameters", "fitted", "held_out", "identifiability"), lists=("targets", "held_out_targets", "warnings", "starts"))

    def title(self, figure, what):
        figure.suptitle(f"{self.values.get('study', self.directory.name)} · {self.values.get('calibrate', '')} · {what}",
                        fontsize=11, x=0.01, ha="left", fontweight="bold")

    def targets(self):
        """What calibration.json says of each target, with x_name and y_name, and its points: x, data, sigma, model (NaN: no answer),
        labels."""
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
                columns = {name: np.array([float(row[name] or "nan") for row in rows]) for name in ("x", "data", "sigma", "model")}
                found.append({**told, "x_name": told.get("x"), "y_name": told.get("y"), **columns, "held_out": key == "held_out_targets", "labels": [row["label"] for row in rows]})
        if not found:
            raise Missing("there are no targets")
        return found


def quantity(name):
    """(words, unit, factor) of a column such as deflection_m."""
    words, found, unit = str(name).rpartition("_")
    if not found:
        return str(name), "", 1.0
    shown, factor = SCALES.get(unit, (unit, 1.0))
    return words.replace("_", " "), shown, factor


def panels_of(targets):
    """The targets that share axes: curves of the same quantities, and each list of figures alone."""
    groups = {}
    for target in targets:
        alone = target["name"] if any(target["labels"]) else ""
        groups.setdefault((target["x_name"], target["y_name"], alone), []).append(target)
    return groups


def figure_of(run, what):
    groups = panels_of(run.targets())
    widths = [3.0 if alone else 7.6 if len(groups) == 1 else 5.6 for _, _, alone in groups]
    figure, axes = plt.subplots(1, len(groups), figsize=(max(sum(widths), 6.0), 5.0), squeeze=False, gridspec_kw={"width_ratios": widths})
    run.title(figure, what)
    return groups, figure, axes[0]


def fit(run):
    groups, figure, axes = figure_of(run, "data (points) and model (lines; dashed: held out)")
    for axis, ((x, y, alone), targets) in zip(axes, groups.items()):
        (x_words, x_unit, x_factor), (y_words, y_unit, y_factor) = quantity(x), quantity(y)
        for k, target in enumerate(targets):
            colour = COLOURS[k % len(COLOURS)]
            if alone:
                place = np.arange(len(target["x"]))
                axis.errorbar(place, target["data"], target["sigma"], fmt="o", color=colour, ms=4, capsize=3, label="data")
                spans = [figure.get("evaluations_span") for figure in target.get("figures") or []]
                if len(spans) == len(place) and all(spans):
                    axis.vlines(place + 0.15, *np.array(spans).T, color=GREY, lw=1.0, alpha=0.6, label="all evaluations")
                errors = [figure.get("standard_error") or 0.0 for figure in target.get("figures") or []]
                axis.errorbar(place + 0.15, target["model"], errors if len(errors) == len(place) else None, fmt="_", ms=16, capsize=3,
                              color=GREY, label="model, held out" if target["held_out"] else "model")
                axis.set_xlim(-0.6, len(place) - 0.4)
                axis.set_xticks(place, target["labels"], rotation=30, ha="right")
                axis.set(ylabel=target["name"])
                continue
            axis.plot(x_factor * target["x"], y_factor * target["data"], "o", ms=3.5, color=colour)
            axis.plot(x_factor * target["x"], y_factor * target["model"], "--" if target["held_out"] else "-", color=colour,
                      label=f"{target['name']} ({target.get('what', '')})")
        if not alone:
            axis.set(xlabel=f"{x_words}, {x_unit}", ylabel=f"{y_words}, {y_unit}")
        axis.legend(fontsize=7.5)
    return figure


def residual(run):
    groups, figure, axes = figure_of(run, "model less data, of the target's peak (dashed: held out)")
    for axis, ((x, _, alone), targets) in zip(axes, groups.items()):
        words, unit, factor = quantity(x)
        axis.axhline(0.0, color=GREY, lw=0.8)
        for k, target in enumerate(targets):
            off = 100.0 * (target["model"] - target["data"]) / np.max(np.abs(target["data"]))
            place = np.arange(len(target["x"])) if alone else factor * target["x"]
            axis.plot(place, off, "o--" if target["held_out"] else "o-", ms=3, color=COLOURS[k % len(COLOURS)],
                      label=f"{target['name']} ({target.get('what', '')})")
            if alone:
                axis.set_xticks(place, target["labels"], rotation=30, ha="right")
        axis.set(xlabel="" if alone else f"{words}, {unit}", ylabel="model less data, % of the peak")
        axis.legend(fontsize=7.5)
    return figure
