"""Plots over time of a run's tables."""
import numpy as np

from ..plot.run_data import Missing
from ..plot.units import naming

from . import blocks
from .blobs import thin

MOST_WHEELS = 16  # in one plot
NOISE = 1e-9  # a column that never exceeds it shows nothing but rounding

# Title and columns of the plots of a wheel; columns that a table lacks are left out, and plots without columns too.
WHEEL = (("Drawbar pull", ("drawbar_pull_N", "tractive_effort_N", "terrain_resistance_N")),
         ("Force of the ground on the tire", ("force_x_N", "force_y_N", "force_z_N")),
         ("Sinkage", ("sinkage_m", "sinkage_kinematic_m", "sinkage_in_rut_m")),
         ("Slip", ("slip",)),
         ("Moments", ("spindle_torque_Nm", "aligning_moment_Nm", "brake_torque_Nm")),
         ("Speed", ("speed_m_per_s",)),
         ("Spin", ("spin_rad_per_s",)),
         ("Slip angle and camber", ("slip_angle_rad", "camber_angle_rad")),
         ("Contacts of the tire", ("contacts_tire",)),
         ("Share of grains awake", ("active_share",)))

# One column over all wheels.
WHEELS = ("vertical_force_N", "slip", "sinkage_m", "spindle_torque_Nm", "tractive_effort_N", "lateral_force_N",
          "speed_m_per_s", "suspension_travel_m", "spring_force_N", "shock_force_N", "wheel_steer_rad",
          "wheel_camber_rad", "drawbar_pull_N")

VEHICLE = (("Speed", ("speed_m_s", "target_speed_m_per_s")),
           ("Driver", ("throttle", "brake", "steering")),
           ("Attitude", ("roll_rad", "pitch_rad")),
           ("Heading", ("yaw_rad", "heading_error_rad")),
           ("Acceleration", ("acceleration_m_per_s2", "lateral_acceleration_m_per_s2")),
           ("Yaw rate", ("yaw_rate_rad_per_s",)),
           ("Power", ("power_W", "wheel_power_W", "soil_power_W")),
           ("Engine speed", ("engine_speed_rpm", "turbine_speed_rpm")),
           ("Engine torque", ("engine_torque_Nm",)),
           ("Gear", ("gear",)),
           ("Distance from the path", ("cross_track_error_m",)),
           ("Height of the chassis", ("z_m",)))


class Table:
    """A table of a run, thinned, whose columns become arrays of the page when they are asked for."""

    def __init__(self, run, name, arrays):
        columns = run.table(name)
        if "time_s" not in columns:
            raise Missing(f"there is no {name}")
        self.arrays = arrays
        time = columns.pop("time_s")
        self.time, self.columns, self.bucket = thin(time, columns)
        self.x = arrays.add(self.time, exact=True)
        self.used = set()

    def line(self, name, label=None):
        words, _, factor = naming(name)
        self.used.add(name)
        return {"label": label or words, "x": self.x, "y": self.arrays.add(factor * self.columns[name]),
                "style": "line"}

    @property
    def note(self):
        return (f"Each pair of points of a curve is the lowest and the highest of {self.bucket} samples."
                if self.bucket > 1 else "")


def plain(table, groups, window, errors=None):
    """The plots of `groups`."""
    items = []
    for title, names in groups:
        names = [name for name in names if name in table.columns
                 and np.nanmax(np.abs(table.columns[name]), initial=0.0) > NOISE]
        if names:
            levels = [level for name in names for level in (errors or {}).get(name, ())]
            if title == "Drawbar pull" and "drawbar_pull_N" not in names:
                title = "Tractive effort and terrain resistance"
            items.append({**blocks.chart(title, "time", "s", naming(names[0])[1], [table.line(name) for name in names],
                                         window, levels), "whole": names == ["gear"]})
            limit_slip(items[-1], names[0], table)
    return items


def over_wheels(tables, window, names=()):
    """One plot per column with a line per wheel. `names` of all wheels, or none."""
    items = []
    for name in WHEELS:
        lines = [table.line(name, names[k] if k < len(names) else f"wheel {k}") for k,
                 table in list(tables.items())[:MOST_WHEELS]
                 if name in table.columns and np.nanmax(np.abs(table.columns[name]), initial=0.0) > NOISE]
        if lines:
            words, unit, _ = naming(name)
            items.append(blocks.chart(words.capitalize(), "time", "s", unit, lines, window))
            limit_slip(items[-1], name, *tables.values())
    return items


def limit_slip(chart, name, *tables):
    """Of a wheel that stands, the slip is any number: the plot then begins with a part of it in view."""
    if name == "slip" and any(np.nanmax(np.abs(table.columns[name]), initial=0.0) > 2.0
                              for table in tables if name in table.columns):
        chart["clip"] = [-1.5, 1.5]
        chart["title"] += " (only ±1.5 shown)"


def explorer(table, window, most=80):
    """Every column that no plot shows yet, to be chosen from a list."""
    items = []
    for name, values in table.columns.items():
        if name not in table.used and len(items) < most and np.isfinite(values).any():
            words, unit, _ = naming(name)
            items.append(blocks.chart(words.capitalize(), "time", "s", unit, [table.line(name)], window))
    return {"type": "explorer", "charts": items} if items else None
