"""The vehicle itself: motion, engine and gears, driver, powers, path, and the balance of a change of gear."""
import matplotlib.pyplot as plt
import numpy as np

from . import gear_balance
from .chart_table import VEHICLE
from .run_data import Missing
from .style import BLUE, GREEN, GREY, ORANGE, PURPLE, RED, SKY, heading
from .vehicle_run import running_mean
from .vehicle_style import AXLES, grid, limits, mark_events, mark_window

COLOURS = (PURPLE, ORANGE, GREEN, GREY, RED, BLUE, SKY)


def lines(axis, v, ylabel, title, *curves):
    """Curves over time: values, colour, label."""
    for values, colour, label in curves:
        axis.plot(v.time, values, color=colour, label=label)
    axis.set(ylabel=ylabel, title=title)
    return [values for values, _, _ in curves]


def columns(axis, v, name, colours, how=lambda values: values, note=""):
    """A chart of the vehicle's columns. @returns the values"""
    chart = VEHICLE[name]
    colour = dict(zip(chart.lines, colours))
    return lines(axis, v, chart.label, chart.heading + note,
                 *((how(values), colour[column], called) for column, called, values in chart.curves(v)))


def place(axis, v):
    lines(axis, v, "distance, m", "Displacement of the vehicle's origin",
          *((v[f"{name}_m"] - v[f"{name}_m"][0], colour, f"{name} − {name} at the start")
            for name, colour in (("x", BLUE), ("y", ORANGE))))


def height(axis, v):
    columns(axis, v, "height", (BLUE,), lambda values: values - 1e3 * v.wheels[0].surface,
            " above the undisturbed surface")


def speeds(axis, v):
    curves = []
    for number, axle in enumerate(v.order):
        wheels = v.of_axle(axle)
        values = running_mean(v.time, sum(wheel["spin_rad_per_s"] * wheel.radius for wheel in wheels) / len(wheels))
        curves.append((values, AXLES[number % len(AXLES)], f"ω R, {v.axles[axle]} wheels"))
    drawn = lines(axis, v, "", "", *curves)
    limits(axis, v, drawn + columns(axis, v, "speeds", ("black", GREY),
                                    note=", and circumferential speed of the wheels (mean of 50 ms)"))


def angles(axis, v):
    columns(axis, v, "angles", (BLUE, ORANGE))


def engine(axis, v):
    if not v["engine_speed_rpm"].any():
        axis.set_title("No engine: motors in the wheels or none")
        return
    columns(axis, v, "engine", (PURPLE, ORANGE), note=", and gear (right)")
    axis.set_ylim(bottom=0.0)
    gear = axis.twinx()
    gear.step(v.time, v["gear"], color=GREEN, where="post", lw=1.2, label="gear")
    gear.set_ylim(min(v["gear"].min(), 0.0) - 0.1, max(v["gear"].max(), 2.0) + 1.0)
    gear.yaxis.get_major_locator().set_params(integer=True)
    gear.grid(False)
    gear.legend(loc="lower right", fontsize=7.5)


def inputs(axis, v):
    columns(axis, v, "inputs", (GREEN, RED, BLUE))
    axis.set_ylim(min(-0.05, 1.1 * v["steering"].min()), 1.1)


def powers(axis, v):
    limits(axis, v, columns(axis, v, "powers", (PURPLE, BLUE, ORANGE), lambda values: running_mean(v.time, values),
                            " (mean of 50 ms)"))


def heats(axis, v):
    columns(axis, v, "heats", COLOURS)


def vehicle(v):
    figure, axes = grid(v, 4, 2, 11.5, 13.5)
    for axis, draw in zip(axes.flat, (speeds, angles, place, height, engine, inputs, powers, heats)):
        draw(axis, v)
        mark_window(axis, v)
        mark_events(axis, v, words=draw is angles)
        if axis.get_legend_handles_labels()[0]:
            axis.legend(fontsize=7.5, loc="upper left" if draw is not angles else "best")
    return figure


def stanley(v):
    """Whether the front axle is steered onto the path, not the rear one."""
    found = v.run.rig
    for key in ("driver", "path", "steering", "law"):
        found = found.get(key) if isinstance(found, dict) else None
    return found == "stanley"


def path(v):
    """The way of origin and wheels, and how far it is from the path that the driver follows."""
    if "cross_track_error_m" not in v or not v["path_distance_m"].any():
        raise Missing("the driver follows no path")
    figure, (above, error, heading) = plt.subplots(3, 1, figsize=(12, 8.6), gridspec_kw={"height_ratios": [1.7, 1, 1]})
    heading(figure, v.title)
    for wheel, (x, y) in zip(v.wheels, v.tracks()):
        colour = AXLES[v.order.index(wheel.axle) % len(AXLES)]
        above.plot(x, y, color=colour, lw=0.8, label=f"{v.axles[wheel.axle]} wheels" if wheel.side == "left" else None)
    above.plot(v["x_m"], v["y_m"], color="black", lw=1.6, label="vehicle's origin")
    # The error is that of the middle of an axle, across the path's direction.
    axle = v.order[0 if stanley(v) else -1]
    ahead, direction = v.places[2 * axle][0], v["yaw_rad"] - v["heading_error_rad"]
    x = v["x_m"] + ahead * np.cos(v["yaw_rad"]) + np.sin(direction) * v["cross_track_error_m"]
    y = v["y_m"] + ahead * np.sin(v["yaw_rad"]) - np.cos(direction) * v["cross_track_error_m"]
    above.plot(x, y, color=RED, ls="--", lw=1.2, label="path: middle of the axle that follows it, less its error")
    wide = np.ptp(v["x_m"]) > 6.0 * max(np.ptp(v["y_m"]) + np.ptp([left for _, left in v.places]), 1e-9)
    above.set_aspect("auto" if wide else "equal", adjustable="datalim")
    above.set(xlabel="x, m", ylabel="y, m" + (" (stretched)" if wide else ""), title="Seen from above")
    above.legend(loc="best", fontsize=8, ncol=2)
    for axis, values, unit, title in ((error, v["cross_track_error_m"],
                                       "m", "Error across the path: left of it positive"),
                                      (heading, np.degrees(v["heading_error_rad"]), "°", "Error of the heading")):
        axis.plot(v["path_distance_m"], values, color=BLUE)
        axis.axhline(0.0, color="black", lw=0.6)
        axis.set(ylabel=f"error, {unit}", title=f"{title} (largest {np.abs(values).max():.3g} {unit}, rms "
                 f"{np.sqrt(np.mean(values ** 2)):.3g} {unit})")
    heading.set_xlabel("distance along the path, m")
    return figure


def gear(v):
    """Traction that the wheels take and that engine and gears give against the speed of the wheels."""
    found, line = gear_balance.balance(v), gear_balance.driveline(v)
    speed, torque, gross = gear_balance.demand(v)
    radius = sum(wheel.radius for wheel in v.wheels) / len(v.wheels)
    figure, axis = plt.subplots(figsize=(10, 6.2))
    wheel = np.linspace(0.02, 1.25, 120) * found.shift_speed
    given = [line.wheel_torque(u / radius, found.throttle) / radius / v.weight for u in wheel]
    axis.plot(wheel, given, color=PURPLE, lw=1.8,
              label=f"engine and lowest gear give, steady, throttle {found.throttle:.2g}")
    driving = (v["throttle"] >= 0.99 * found.throttle) & (v["gear"] == 1)
    for values, colour, label in ((torque, BLUE, "torque at the wheels / radius"),
                                  (gross, GREEN, "gross traction: tractive effort of all tires")):
        axis.plot(np.where(driving, speed, np.nan), np.where(driving, values, np.nan),
                  color=colour, lw=1.0, label=label)
    axis.axvline(found.shift_speed, color=RED, lw=1.0, ls="--",
                 label=f"speed of the change, {found.shift_speed:.2f} m/s")
    axis.plot(found.shift_speed, found.limit, "o", color=RED, label=f"gross traction must be below {found.limit:.3f}")
    axis.plot(found.reached, found.gross, "o", color=GREEN,
              label=f"largest wheel speed {found.reached:.2f} m/s: {found.gross:.3f}")
    axis.axhline(0.0, color="black", lw=0.6)
    axis.set(ylim=(min(0.0, 1.1 * np.nanmin(np.where(driving, gross, 0.0))), 1.15 * max(max(given), 0.2)),
             xlim=(0.0, wheel[-1]), xlabel="circumferential speed of the wheels ω R, m/s (mean of 100 ms)",
             ylabel="share of the weight", title=f"{v.title}\nWhat a change of gear needs: {found.verdict}")
    axis.legend(loc="upper right", fontsize=8.5)
    return figure
