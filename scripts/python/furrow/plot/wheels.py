"""All wheels of a vehicle side by side: forces in the tires' axes on the ground (ISO-W), slip, sinkage, suspension."""
import matplotlib.pyplot as plt
import numpy as np

from . import axles, events
from .chart_table import WHEELS
from .run_data import Missing
from .style import GREY, RED, heading
from .vehicle_run import running_mean
from .vehicle_style import AXLES, SIDES, grid, limits, line, mark_events, mark_window, steadiness


def finish(axes, v, charts, notes):
    """Marks, titles and legends that all panels have; `notes` on what else a chart shows."""
    for row, chart in zip(axes, charts):
        title = chart.heading + notes.get(chart, "")
        for column, axis in enumerate(row):
            mark_window(axis, v)
            mark_events(axis, v)
            axis.axhline(0.0, color="black", lw=0.6)
            axis.set_title(f"{v.axles[v.order[column]]} · {title}", fontsize=9.5)
        row[0].set_ylabel(chart.label)
    for axis in axes[:, 0]:
        if axis.get_legend_handles_labels()[0]:
            axis.legend(fontsize=7.5, loc="best")


def wheel_forces(v):
    charts = [WHEELS[name] for name in ("net", "effort", "lateral", "vertical")]
    figure, axes = grid(v, 4, len(v.axles), 10.5, sharey="row")
    curves = [[], [], [], []]
    for column, axle in enumerate(v.order):
        for wheel in v.of_axle(axle):
            colour = SIDES[wheel.side]
            shown = [(row, chart.values(wheel, *chart.lines), "-") for row, chart in enumerate(charts)]
            for row, values, style in (*shown, (1, -wheel["terrain_resistance_N"], "--")):
                line(axes[row][column], v.time, v.time, values, colour, wheel.side if style == "-" else None, style)
                curves[row].append(values)
            axes[3][column].axhline(v.loads[wheel.index], color=colour, ls="--", lw=0.8)
    finish(axes, v, charts, {WHEELS["effort"]: "; dashed: −resistance", WHEELS["vertical"]: "; dashed: load at rest"})
    for row, found in zip(axes, curves):
        limits(row[0], v, found)
    mark_events(axes[3][0], v, words=True)
    steadiness(axes[0][-1], v)
    return figure


def wheel_motion(v):
    charts = [WHEELS[name] for name in ("spin", "slip", "deflection" if v.hard_ground else "sinkage", "height",
                                        "travel")]
    figure, axes = grid(v, 5, len(v.axles), 12.5, sharey="row")
    curves = [[], [], [], [], []]
    _, slow = events.drive_off(v)
    for column, axle in enumerate(v.order):
        for wheel in v.of_axle(axle):
            colour = SIDES[wheel.side]
            axes[0][column].plot(v.time, running_mean(v.time, wheel["speed_m_per_s"]) / wheel.radius,
                                 color=GREY, lw=0.9)
            turns = np.maximum(np.abs(wheel["spin_rad_per_s"]) * wheel.radius, np.abs(wheel["speed_m_per_s"])) > slow
            made = {"slip": np.where(turns, np.clip(wheel["slip"], -2.0, 2.0), np.nan),
                    "axle_height_m": wheel["axle_height_m"] - wheel.surface}
            for row, chart in enumerate(charts):
                name, = chart.lines
                values = chart.values({name: made.get(name, wheel[name])}, name)
                line(axes[row][column], v.time, v.time, values, colour, wheel.side, raw=row < 2)
                curves[row].append(values)
            inside = events.in_rut(wheel)
            if inside.any() and not v.hard_ground:
                axes[2][column].plot(v.time, np.where(inside, 1e3 * wheel["sinkage_in_rut_m"], np.nan),
                                     ":", color=colour)
    finish(axes, v, charts, {WHEELS["spin"]: "; grey: speed over undeformed radius",
                             WHEELS["slip"]: ", where the wheel is not slow",
                             WHEELS["sinkage"]: "; dotted: below the rut",
                             WHEELS["height"]: ", above the undisturbed surface"})
    for row, found, zero in zip(axes, curves, (True, True, True, False, True)):
        limits(row[0], v, found, zero)
    low, high = axes[1][0].get_ylim()
    axes[1][0].set_ylim(max(low, -1.0), min(high, 1.05))
    axes[2][0].invert_yaxis()
    mark_events(axes[4][0], v, words=True)
    return figure


def axle_positions(v, axle):
    return sum(wheel["position_m"] for wheel in v.of_axle(axle)) / 2.0


def front_and_rear(v):
    """Each axle at its place over the ground: what the soil gives the axles one after the other at the same spot."""
    if len(v.order) < 2:
        raise Missing("the vehicle has one axle only")
    shown = [row for row in axles.QUANTITIES if row[0] in ("iso_force_x_N", *axles.OF_SOIL, "tractive_effort_N")
             and row[0] != "sinkage_in_rut_m"]
    figure, axes = plt.subplots(2, 2, figsize=(13, 7.6), sharex=True)
    heading(figure, f"{v.title}\nMeans of each axle over its place on the bed: values above each other are for the "
                    "same soil", 11)
    begin = events.first(v.time >= quiet_time(v)) or 0
    for axis, (column, what, unit, factor, total) in zip(axes.flat, shown):
        curves = []
        for number, axle in enumerate(v.order):
            place, values = axle_positions(v, axle), factor * axles.axle_series(v, axle, column, total)
            colour = AXLES[number % len(AXLES)]
            line(axis, place[begin:], v.time[begin:], values[begin:], colour, f"{v.axles[axle]} axle")
            curves.append(values)
            if number + 1 < len(v.order):
                axis.axvline(touch_place(v, axle), color=colour, ls=":", lw=1.0)
        limits(axis, v, curves, since=v.time[begin])
        axis.axhline(0.0, color="black", lw=0.6)
        axis.set_title(f"{what}{' of the wheels of an axle' if total else ''}, {unit}", fontsize=9.5)
    axes[1][1].invert_yaxis()
    axes[0][0].legend(loc="best", fontsize=8)
    axes[1][0].annotate("dotted: where the axle before it came down", (0.01, 0.97),
                        xycoords="axes fraction", fontsize=8, va="top")
    for axis in axes[1]:
        axis.set_xlabel("place of the axle along the heading at the start, m")
    comparison_box(axes[1][1], v)
    return figure


def quiet_time(v):
    moved, _ = events.drive_off(v)
    return v.time[moved] if moved is not None else 0.0


def touch_place(v, axle):
    """Where the axle came down, m."""
    touched = events.touch_downs(v)
    found = [wheel["position_m"][touched[wheel.index] or 0] for wheel in v.of_axle(axle)]
    return sum(found) / len(found)


def comparison_box(axis, v):
    """Means of the axles, as `furrow events` prints them."""
    try:
        found = axles.compare(v)
    except Missing:
        return
    lines = [f"{found.begin:.2f} to {found.end:.2f} s" + (": NOT STEADY" if found.unsteady else "")]
    for row in found.rows:
        if row.what in ("net longitudinal force", "resistance") or row.what.startswith("sinkage below the undisturbed"):
            what = row.what.split(" below")[0]
            lines.append(f"{what}, {row.unit}: " + ", ".join(f"{name} {axles.told(one)}" for name,
                                                             one in zip(found.names, row.axles)))
    axis.text(0.01, 0.98, "\n".join(lines), transform=axis.transAxes, va="top", fontsize=7.5,
              color=RED if found.unsteady else "black", bbox={"facecolor": "white", "alpha": 0.75, "lw": 0})
