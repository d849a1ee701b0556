"""The rut: the height field seen from above, across and along the wheel's path."""
import warnings

import matplotlib.pyplot as plt
import numpy as np

from .digits import digits
from .run_data import Missing
from .style import BLUE, GREY, ORANGE, RED, heading

NEAREST, FARTHEST = 0.642, 1.177  # tire radii behind the axle: where the rut is measured (terrain/rut.cpp)


def row_mean(values, axis):
    """Mean without NaN; NaN where nothing is."""
    good = np.isfinite(values)
    count = good.sum(axis)
    return np.where(count > 0, np.where(good, values, 0.0).sum(axis) / np.maximum(count, 1), np.nan)


def rut(run):
    """The surface from above, across and along the path."""
    before, after = run.heights()
    depth = 1e3 * (before.z - after.z)  # mm
    if not np.isfinite(depth).any():
        raise Missing("the height fields are empty")
    if not np.nanmax(np.abs(depth)) > 0.0:
        raise Missing("the ground has not changed its shape")
    sign, lateral = run.travel_sign, run.lateral
    start, end = (sign * run.column("position_m")[[0, -1]]).tolist()
    tread, radius = run.number("tread_width_m"), run.number("tire_radius_m") or 0.4673
    window = sorted(end - sign * share * radius for share in (NEAREST, FARTHEST))
    figure = plt.figure(figsize=(12, 7.6))
    grid = figure.add_gridspec(2, 2, height_ratios=[1, 1.15], width_ratios=[1, 1.5])
    heading(figure, run.title)
    top_view(figure, figure.add_subplot(grid[0, :]), after, depth, start, end, sign, tread, lateral, window)
    across(figure.add_subplot(grid[1, 0]), run, after, depth, end, tread, lateral, window)
    along(figure.add_subplot(grid[1, 1]), before, after, start, end, sign, tread, lateral, window)
    return figure


def median3(values):
    """Median over 3 × 3 cells, without NaN: single grains lost or gained in a cell do not hide the rut."""
    padded = np.pad(values, 1, constant_values=np.nan)
    nx, ny = values.shape
    stack = np.stack([padded[i:i + nx, j:j + ny] for i in range(3) for j in range(3)])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # cells all of NaN
        return np.nanmedian(stack, axis=0)


def top_view(figure, axis, field, depth, start, end, sign, tread, lateral, window):
    depth = median3(depth)
    limit = max(float(np.nanpercentile(np.abs(depth), 99.5)), 1.0)
    image = axis.pcolormesh(field.x, field.y, depth.T, cmap="RdBu_r", vmin=-limit, vmax=limit, shading="nearest")
    figure.colorbar(image, ax=axis, label="depth below the surface before, mm\n(red: rut, blue: heaped up)",
                    pad=0.01, shrink=0.8)
    axis.set_aspect("equal")
    axis.grid(False)
    axis.plot([start, end], [lateral, lateral], color="black", ls=":", lw=1.0)
    axis.plot(start, lateral, "o", color="black", ms=5, label="axle at the start")
    axis.plot(end, lateral, ">" if sign > 0 else "<", color="black", ms=9,
              label="axle at the end, in direction of travel")
    if tread:
        axis.add_patch(plt.Rectangle((window[0], lateral - 0.5 * tread), window[1] - window[0], tread, fill=False,
                                     lw=1.4, label="tread width, where the rut is measured"))
    axis.set(xlabel="x, m", ylabel="y, m (left of +x)")
    axis.set_title("Seen from above (medians over 3 × 3 cells)", pad=24)
    axis.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncol=3, borderaxespad=0.2, fontsize=8)


def across(axis, run, field, depth, end, tread, lateral, window):
    chosen = (field.x >= window[0]) & (field.x <= window[1])
    near, far = sorted(abs(end - x) for x in window)
    axis.set_title(f"Across, mean over {digits(near)}–{digits(far)} m behind the axle")
    if chosen.any():
        axis.plot(1e3 * field.y, -row_mean(depth[chosen], 0), color=BLUE, lw=2.0)
    axis.axhline(0.0, color=GREY, lw=1.0)
    if tread:
        axis.axvspan(1e3 * lateral - 500.0 * tread, 1e3 * lateral + 500.0 * tread, color=ORANGE, alpha=0.12, lw=0,
                     label=f"tread width {1e3 * tread:.0f} mm")
    measured, width = run.number("rut_depth_m"), run.number("rut_width_m")
    if measured is not None:
        axis.axhline(-1e3 * measured, color=RED, ls="--", lw=1.2, label=f"rut depth {digits(1e3 * measured)} mm")
    if measured is not None and width is not None:
        axis.axhline(-500.0 * measured, color=RED, ls=":", lw=1.2,
                     label=f"width at half depth {digits(1e3 * width)} mm")
    axis.set(xlabel="y, mm", ylabel="height change, mm")
    axis.margins(y=0.25)
    if axis.get_legend_handles_labels()[0]:
        axis.legend(loc="lower right", fontsize=8)


def along(axis, before, after, start, end, sign, tread, lateral, window):
    half = 0.25 * (tread or 0.2)
    middle = np.abs(after.y - lateral) <= half
    axis.plot(before.x, 1e3 * row_mean(before.z[:, middle], 1), color=GREY, label="before")
    axis.plot(after.x, 1e3 * row_mean(after.z[:, middle], 1), color=BLUE, lw=1.8, label="after")
    axis.axvline(end, color="black", lw=1.0)
    axis.axvline(start, color="black", lw=1.0, ls=":")
    axis.annotate("axle at the end", (end, 1.0), xycoords=("data", "axes fraction"), fontsize=8.5,
                  xytext=(3 if sign > 0 else -3, -10), textcoords="offset points", ha="left" if sign > 0 else "right")
    axis.axvspan(*window, color=RED, alpha=0.10, lw=0, label="where the rut is measured")
    axis.set(xlabel="x, m", ylabel="surface height z, mm", title="Along, mean over the middle half of the tread width")
    axis.margins(y=0.25)
    axis.legend(loc="best", fontsize=8)
