"""One look for all plots."""
import matplotlib.pyplot as plt

# Okabe & Ito (2008): distinguishable with every kind of colour vision.
BLUE, ORANGE, GREEN, RED = "#0072B2", "#E69F00", "#009E73", "#D55E00"
PURPLE, SKY, GREY = "#CC79A7", "#56B4E9", "#777777"

LOOK = {
    "font.size": 10, "axes.titlesize": 10.5, "axes.titlelocation": "left", "axes.spines.top": False,
    "axes.spines.right": False, "axes.grid": True, "grid.color": "#e2e2e2", "grid.linewidth": 0.8,
    "axes.axisbelow": True, "legend.frameon": False, "legend.fontsize": 9, "lines.linewidth": 1.4,
    "figure.constrained_layout.use": True,
}
plt.rcParams.update(LOOK)


def heading(figure, text, size=11.5):
    figure.suptitle(text, fontsize=size, x=0.01, ha="left", fontweight="bold")


def panels(run, rows, height, **options):
    """A figure with `rows` axes, which share the time axis unless `sharex` is False."""
    figure, axes = plt.subplots(rows, 1, figsize=(10, height), squeeze=False, **{"sharex": True, **options})
    heading(figure, run.title)
    return figure, axes[:, 0]


def mark_window(axis, run, label=None):
    if run.window:
        axis.axvspan(*run.window, color="#0072B2", alpha=0.08, lw=0, label=label)
