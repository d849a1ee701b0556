"""The ruts of a vehicle: the ground from above with the ways of all wheels, across behind each axle and along a
side."""
import matplotlib.pyplot as plt
import numpy as np

from .ground import FARTHEST, NEAREST, median3, row_mean
from .run_data import Damaged, Missing
from .style import GREY, heading
from .vehicle_style import AXLES, SIDES

LARGEST = 1e5  # cells that a way may be long
LINES = 24  # across the vehicle, that a section is the mean of


def at_points(field, values, x, y):
    """Values of the cells that the points lie in; NaN beyond the field."""
    i = np.rint((x - field.x[0]) / field.cell).astype(int)
    j = np.rint((y - field.y[0]) / field.cell).astype(int)
    inside = (i >= 0) & (i < len(field.x)) & (j >= 0) & (j < len(field.y))
    return np.where(inside, values[np.clip(i, 0, len(field.x) - 1), np.clip(j, 0, len(field.y) - 1)], np.nan)


def rut(v):
    before, after = v.run.heights()
    depth = 1e3 * (before.z - after.z)  # mm
    if not np.isfinite(depth).any() or not np.nanmax(np.abs(depth)) > 0.0:
        raise Missing("the ground has not changed its shape")
    reach = max(np.ptp(np.concatenate(track)) for track in v.tracks())
    reach += max(abs(place) for both in v.places for place in both)
    if not reach < LARGEST * after.cell:
        raise Damaged("the vehicle's way is beyond what its ground could be")
    depth = median3(depth)
    figure = plt.figure(figsize=(13, 8.4))
    cells = figure.add_gridspec(2, 2, height_ratios=[1.15, 1], width_ratios=[1, 1.5])
    heading(figure, v.title)
    top_view(figure, figure.add_subplot(cells[0, :]), v, after, depth)
    across(figure.add_subplot(cells[1, 0]), v, after, depth)
    along(figure.add_subplot(cells[1, 1]), v, after, depth)
    return figure


def top_view(figure, axis, v, field, depth):
    limit = max(float(np.nanpercentile(np.abs(depth), 99.5)), 1.0)
    image = axis.pcolormesh(field.x, field.y, depth.T, cmap="RdBu_r", vmin=-limit, vmax=limit, shading="nearest")
    figure.colorbar(image, ax=axis, label="depth below the surface before, mm\n(red: rut, blue: heaped up)",
                    pad=0.01, shrink=0.8)
    axis.set_aspect("equal", anchor="W")
    axis.grid(False)
    for set_limit, all_, cells in ((axis.set_xlim, [x for x, _ in v.tracks()], field.x),
                                   (axis.set_ylim, [y for _, y in v.tracks()], field.y)):
        margin = 0.5 * max(abs(ahead) for ahead, _ in v.places)
        set_limit(max(np.min(all_) - margin, cells[0]), min(np.max(all_) + margin, cells[-1]))
    for wheel, (x, y) in zip(v.wheels, v.tracks()):
        colour = AXLES[v.order.index(wheel.axle) % len(AXLES)]
        axis.plot(x, y, color=colour, lw=0.9, ls=":")
        axis.plot(x[-1], y[-1], "o", color=colour, mec="black", ms=6,
                  label=f"{v.axles[wheel.axle]} wheels at the end; dotted: their path"
                  if wheel.side == "left" else None)
    axis.set(xlabel="x, m", ylabel="y, m (left of +x)")
    axis.set_title("Seen from above (medians over 3 × 3 cells)", pad=24)
    axis.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncol=len(v.axles), borderaxespad=0.2, fontsize=8)


def across(axis, v, field, depth):
    """Behind each axle, in the vehicle's direction at the end."""
    yaw, x0, y0 = v["yaw_rad"][-1], v["x_m"][-1], v["y_m"][-1]
    reach = 1.6 * max(abs(left) for _, left in v.places)
    left = np.arange(-reach, reach, 0.5 * field.cell)
    radius = v.wheels[0].radius
    for number, axle in enumerate(v.order):
        ahead = v.places[2 * axle][0] - radius * np.linspace(NEAREST, FARTHEST, LINES)[:, None]
        values = at_points(field, depth, x0 + np.cos(yaw) * ahead - np.sin(yaw) * left,
                           y0 + np.sin(yaw) * ahead + np.cos(yaw) * left)
        axis.plot(left, -row_mean(values, 0), color=AXLES[number % len(AXLES)],
                  label=f"behind the {v.axles[axle]} axle")
    for _, place in v.places[:2]:
        axis.axvline(place, color=GREY, ls=":", lw=0.9)
    axis.axhline(0.0, color=GREY, lw=1.0)
    axis.set(xlabel="left of the vehicle's middle, m (dotted: middle of the front tires)", ylabel="height change, mm",
             title=f"Across, mean over {NEAREST * radius:.2f} to {FARTHEST * radius:.2f} m behind an axle")
    axis.margins(y=0.2)
    axis.legend(loc="best", fontsize=8)


def along(axis, v, field, depth):
    """Where the front wheels have rolled, and beyond it from the rear wheels at the start to a little ahead at the
    end."""
    front, radius = v.order[0], v.wheels[0].radius
    wheelbase = v.places[2 * front][0] - v.places[2 * v.order[-1]][0]
    behind, ahead = wheelbase + 2.0 * radius, 2.0 * radius
    first, last = (np.array([np.cos(v["yaw_rad"][k]), np.sin(v["yaw_rad"][k])]) for k in (0, -1))
    for wheel in v.of_axle(front):
        x, y = v.tracks()[wheel.index]
        x = np.concatenate([[x[0] - behind * first[0]], x, [x[-1] + ahead * last[0]]])
        y = np.concatenate([[y[0] - behind * first[1]], y, [y[-1] + ahead * last[1]]])
        way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
        points = np.arange(0.0, way[-1], 0.5 * field.cell)
        values = at_points(field, depth, np.interp(points, way, x), np.interp(points, way, y))
        axis.plot(points - behind, -values, color=SIDES[wheel.side], lw=0.7, alpha=0.4)
        axis.plot(points - behind, -moving(values, points, 0.5 * radius),
                  color=SIDES[wheel.side], label=f"{wheel.side} side")
    axis.axhline(0.0, color=GREY, lw=1.0)
    for place, what in ((0.0, "front axle at the start"), (way[-1] - behind - ahead, "front axle at the end"),
                        (way[-1] - behind - ahead - wheelbase, "rear axle at the end")):
        axis.axvline(place, color="black", lw=0.8, ls=":")
        axis.annotate(what, (place, 0.0), xycoords=("data", "axes fraction"), rotation=90, fontsize=7.5, xytext=(-1, 3),
                      textcoords="offset points", va="bottom", ha="right")
    axis.set(xlabel="distance along the path of the front wheels from their start, m", ylabel="height change, mm",
             title=f"Along the way of the front wheels, means over {0.5 * radius:.2g} m")
    axis.margins(y=0.2)
    axis.legend(loc="best", fontsize=8)


def moving(values, points, width):
    """Mean over `width`, of what is finite."""
    half = max(int(0.5 * width / (points[1] - points[0])), 1) if len(points) > 1 else 1
    rows = np.array([np.interp(points + shift * (points[1] - points[0]), points, values)
                     for shift in range(-half, half + 1)])
    return row_mean(rows, 0)
