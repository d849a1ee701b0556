"""The accounts of a run: where its energy and its momentum went, and what they leave over."""
import matplotlib.pyplot as plt
import numpy as np

from .chart_table import LOST, STORED, WORK
from .digits import digits
from .run_data import Missing
from .style import BLUE, GREY, ORANGE, PURPLE, RED, heading, mark_window

GROUPS = (("work", WORK, BLUE), ("stored", STORED, PURPLE), ("lost", LOST, ORANGE))
LEAST_SHARE = 1e-3  # of what is turned over: smaller entries have no bar

MOMENTUM = {"grains": "grains", "tires": "tires", "carrier": "carrier and rim",
            "under_way": "under way", "gravity": "gravity",
            "walls": "walls", "guide": "rails and drives", "sleep": "sleep", "residual": "residual"}
CHANGES = ("grains", "tires", "carrier", "under_way")


def account(run, name):
    """accounts.energy or accounts.momentum of the summary, of a failed run of what it left."""
    accounts = run.told.get("accounts")
    if not accounts:
        raise Missing(f"{run.told_in} has no accounts")
    found = accounts.get(name)
    if not found:
        raise Missing(f"{run.told_in} has no account of {name}")
    return found


def entries(found):
    """(label, value, colour) of what is large enough for a bar; the residual always."""
    least = LEAST_SHARE * abs(found.get("turnover") or 0.0)
    rows = []
    for group, labels, colour in GROUPS:
        values = found.get(group) or {}
        rows += [(f"{label} ({'in' if group == 'work' else group})", float(values[key]), colour) for key,
                 label in labels.items() if values.get(key) is not None and abs(values[key]) > least]
    return rows + [("residual", float(found.get("residual") or 0.0), RED)]


def over_time(run, axis):
    """Work, stored and lost energy since the start, and what they leave over."""
    series = run.table("timeseries_accounts.csv")
    if not series or "time_s" not in series:
        axis.axis("off")
        axis.text(0.5, 0.5, "no timeseries_accounts.csv", ha="center", va="center", color=GREY)
        return
    time = series["time_s"]
    for group, labels, colour in GROUPS:
        parts = [series[f"{key}_J"] for key in labels if f"{key}_J" in series]
        if parts:
            axis.plot(time, sum(parts), color=colour,
                      label={"work": "put in: work from outside", "stored": "stored since the start",
                             "lost": "lost, by all mechanisms"}[group])
    if "residual_J" in series:
        axis.plot(time, series["residual_J"], color=RED, lw=1.3, label="residual: none of them")
    mark_window(axis, run)
    axis.set(xlim=(0.0, max(time[-1], 1e-12)), xlabel="time, s", ylabel="since the start, J",
             title="Work put in = stored + lost + residual")
    axis.legend(loc="upper left", fontsize=8)


def verdict(found, what):
    share = found.get("residual_share")
    text = "" if share is None else f"residual {100 * share:.2g} % of {what}"
    return text + ("" if found.get("closes", True) else ": DOES NOT CLOSE")


def bars(axis, rows, unit):
    values = np.array([value for _, value, _ in rows])
    axis.barh(np.arange(len(rows)), values, color=[colour for _, _, colour in rows])
    low, high = min(values.min(), 0.0), max(values.max(), 0.0)
    span = high - low or 1.0
    for i, value in enumerate(values):
        axis.text(max(value, 0.0) + 0.01 * span, i, f"{digits(value)} {unit}", va="center", fontsize=8)
    axis.set_yticks(np.arange(len(rows)), [label for label, _, _ in rows], fontsize=8)
    axis.invert_yaxis()
    axis.grid(axis="y", visible=False)
    axis.set_xlim(low - 0.02 * span, high + 0.2 * span)
    axis.axvline(0.0, color="black", lw=0.8)


def energy(run):
    """The account of energy, over time and by mechanism."""
    found = account(run, "energy")
    rows = entries(found)
    figure, (left, right) = plt.subplots(1, 2, figsize=(13, 5.6))
    heading(figure, run.title)
    over_time(run, left)
    bars(right, rows, "J")
    right.set(xlabel="over the whole run, J",
              title="Energy by mechanism, each from its own sums\n" + verdict(found, "what is turned over"))
    return figure


def momentum(run):
    """The account of momentum."""
    found = account(run, "momentum")
    figure, axes = plt.subplots(1, 3, figsize=(13, 4.2))
    heading(figure, f"{run.title}\nMomentum: changes of what holds it (purple) = impulses on it (blue) − residual; "
                    + verdict(found, "the largest impulse"), 11)
    for i, (axis, name) in enumerate(zip(axes, ("x, forward", "y, left", "z, up"))):
        rows = []
        for key, label in MOMENTUM.items():
            vector = found.get(key)
            if vector is None:
                continue
            rows.append((label, float(vector[i]), RED if key == "residual" else PURPLE if key in CHANGES else BLUE))
        if not rows:
            raise Missing("the account of momentum is empty")
        bars(axis, rows, "N s")
        axis.set(xlabel="momentum, N s", title=name)
    return figure
