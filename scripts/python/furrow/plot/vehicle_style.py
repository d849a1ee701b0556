"""What the plots of a vehicle's run have in common: running means over samples, marks of events, limits."""
import matplotlib.pyplot as plt
import numpy as np

from . import axles, events
from .run_data import Missing
from .style import BLUE, GREEN, GREY, ORANGE, PURPLE, RED, heading
from .vehicle_run import running_mean

SIDES = {"left": BLUE, "right": ORANGE}
AXLES = [BLUE, ORANGE, GREEN, PURPLE, RED]
NEAR = 0.02  # of the run
MOST = 24  # marks in a picture
MARKED = ("throttle on", "brake on", "settled", "gear ", "reaches the place", "ends before")


def line(axis, x, time, values, colour, label=None, style="-", raw=True):
    """The samples, thin, with their running mean over them."""
    if raw:
        axis.plot(x, values, color=colour, alpha=0.22, lw=0.6)
    axis.plot(x, running_mean(time, values), style, color=colour, lw=1.3, label=label)


def quiet_from(v):
    """When the ground has taken the vehicle over, s: what comes before may run out of the pictures."""
    touched = [at for at in events.touch_downs(v) if at is not None]
    return min(v.time[max(touched)] + 0.15, 0.5 * v.time[-1]) if touched else 0.0


def limits(axis, v, curves, zero=True, since=None):
    """Around the running means since touch-down, or since `since`."""
    late = v.time > (quiet_from(v) if since is None else since)
    if late.sum() < 4 or not curves:
        return
    values = np.concatenate([running_mean(v.time, curve)[late] for curve in curves])
    low, high = np.nanmin(values), np.nanmax(values)
    if zero:
        low, high = min(low, 0.0), max(high, 0.0)
    margin = 0.12 * (high - low)
    if np.isfinite(margin) and margin > 0.0:
        axis.set_ylim(low - margin, high + margin)


def marks(v):
    """[(time, words)] of the events that plots show; of several like ones the first."""
    found = {}
    for event in events.events(v):
        if event.what.startswith(MARKED):
            words = "ends early" if event.what.startswith("ends before") else event.what
            if event.what.startswith("reaches"):
                words = f"{event.subject.rsplit(' ', 1)[0]} axle meets the ruts before it"
            found.setdefault((words, event.time if event.what.startswith("gear") else None), event.time)
    if any(key[0].startswith("gear ") for key in found) and len(found) > MOST:
        found = {key: time for key, time in found.items() if not key[0].startswith("gear ")}
    return sorted((time, words) for (words, _), time in found.items())


def mark_events(axis, v, words=False):
    together = []  # words of events that are too near each other to be distinguished
    for time, what in marks(v):
        axis.axvline(time, color=GREY, lw=0.8, ls=":")
        if together and time - together[-1][0] < NEAR * v.time[-1]:
            together[-1][1] += ", " + what
        else:
            together.append([time, what])
    if words:
        for time, what in together:
            axis.annotate(what, (time, 0.0), xycoords=("data", "axes fraction"), rotation=90, fontsize=7.5,
                          color="#444444", xytext=(-1, 3), textcoords="offset points", ha="right", va="bottom")


def mark_window(axis, v):
    """The stretch over which the axles are compared."""
    try:
        begin, end, _ = axles.window(v)
    except Missing:
        return
    axis.axvspan(begin, end, color=BLUE, alpha=0.06, lw=0)


def steadiness(axis, v):
    """NOT STEADY and why, as the plots of a drawbar rig say it."""
    try:
        found = axles.compare(v)
    except Missing:
        return
    if found.unsteady:
        axis.text(0.995, 0.02, "NOT STEADY\n" + "\n".join(found.unsteady), transform=axis.transAxes, ha="right",
                  va="bottom", color=RED, fontsize=7, zorder=5, bbox={"facecolor": "white", "alpha": 0.7, "lw": 0})


def grid(v, rows, columns, height, width=None, **options):
    """A figure of panels that share the time axis."""
    figure, axes = plt.subplots(rows, columns, figsize=(width or min(5.6 * columns + 1.0, 16.0), height), sharex=True,
                                squeeze=False, **options)
    heading(figure, v.title)
    for axis in axes[-1]:
        axis.set(xlabel="time, s", xlim=(0.0, v.time[-1]))
    return figure, axes
