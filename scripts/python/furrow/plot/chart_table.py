"""The charts of pictures and of the page: what each is called, its columns and what they are called.

Words, units and factors of axes are those of the columns (units.py), unless the chart has its own.
"""
import dataclasses

import numpy as np

from .units import label_of, naming

NOISE = 1e-9  # a column that never exceeds it shows nothing but rounding


def is_noise(values):
    return np.nanmax(np.abs(values), initial=0.0) <= NOISE


@dataclasses.dataclass(frozen=True, eq=False)
class Chart:
    title: str
    lines: dict  # {column: what it is called; empty: as its name says}
    sign: str = ""  # which sign is positive, and of what
    y: str = ""  # words of the axis, where those of the first column do not fit
    unit: tuple = ()  # (unit, factor), where those of the first column do not fit
    x: str = "time_s"
    x_words: str = ""
    x_unit: tuple = ()
    negative: tuple = ()  # columns that are drawn with the other sign
    if_any: tuple = ()  # columns that are left out where they are zero throughout

    @property
    def heading(self):
        return f"{self.title}: {self.sign}" if self.sign else self.title

    @property
    def scale(self):
        """(unit, factor) of all columns."""
        return self.unit or naming(next(iter(self.lines)))[1:]

    @property
    def label(self):
        """Of the vertical axis."""
        return label_of(next(iter(self.lines)), self.y, self.scale)

    @property
    def x_label(self):
        return label_of(self.x, self.x_words, self.x_unit)

    def places(self, columns):
        """The abscissa as the chart shows it."""
        return (self.x_unit or naming(self.x)[1:])[1] * columns[self.x]

    def values(self, columns, name):
        """A column as the chart shows it."""
        return (-1.0 if name in self.negative else 1.0) * self.scale[1] * columns[name]

    def called(self, name):
        return self.lines[name] or naming(name)[0]

    def curves(self, columns):
        """(column, what it is called, values) of the columns that a table has."""
        return [(name, self.called(name), self.values(columns, name)) for name in self.lines
                if name in columns and not (name in self.if_any and is_noise(columns[name]))]


KW = ("kW", 1e-3)
KJ = ("kJ", 1e-3)
KN = ("kN", 1e-3)
MM = ("mm", 1e3)
GROUND = "on the tire by the ground"

# Of a wheel, over time.
WHEEL = {
    "pull": Chart("Drawbar pull", {"drawbar_pull_N": "corrected for the inertia of what the rig carries"},
                  "positive when the tire pulls the rig along", y="drawbar pull"),
    "slip": Chart("Slip", {"slip": ""}, "1 − v/(ω R), R undeformed radius; positive when driven"),
    "sinkage": Chart("Sinkage", {
        "sinkage_m": "lowest point of the tire",
        "sinkage_kinematic_m": "kinematic: from the axle's height and the undeformed radius",
        "sinkage_in_rut_m": "below the rut"}, "below the undisturbed surface, positive down",
                     if_any=("sinkage_in_rut_m",)),
    "vertical": Chart("Vertical force", {"force_z_N": "of the ground"}, f"{GROUND}, positive up", y="force"),
    "lateral": Chart("Lateral force", {"force_y_N": "of the ground"}, f"{GROUND}, positive to the left", y="force"),
    "along": Chart("Forces along the travel", {
        "tractive_effort_N": "tractive effort (friction)", "terrain_resistance_N": "−terrain resistance (pressure)",
        "drawbar_pull_N": "net: drawbar pull"}, "on the tire, positive forward", y="force",
                   negative=("terrain_resistance_N",)),
    "torque": Chart("Spindle torque", {"spindle_torque_Nm": "drive torque on the spindle", "brake_torque_Nm": ""},
                    "positive when it drives the wheel forward", y="torque", if_any=("brake_torque_Nm",)),
    "aligning": Chart("Aligning moment", {"aligning_moment_Nm": ""}),
    "speed": Chart("Speed", {"speed_m_per_s": ""}),
    "spin": Chart("Spin", {"spin_rad_per_s": ""}),
    "angles": Chart("Slip angle and camber", {"slip_angle_rad": "", "camber_angle_rad": ""}, y="angle"),
    "contacts": Chart("Contacts of the tire", {"contacts_tire": ""}),
    "awake": Chart("Share of grains awake", {"active_share": ""})}

# One column over all wheels of a vehicle.
WHEELS = {
    "net": Chart("Net longitudinal force", {"iso_force_x_N": ""}, "ISO-W x, forward", y="force"),
    "effort": Chart("Tractive effort", {"tractive_effort_N": ""}, y="force"),
    "resistance": Chart("Terrain resistance", {"terrain_resistance_N": ""}, y="force"),
    "lateral": Chart("Lateral force", {"iso_force_y_N": ""}, "ISO-W y, to the left", y="force"),
    "vertical": Chart("Vertical force", {"iso_force_z_N": ""}, "ISO-W z, up", y="force"),
    "spin": Chart("Spin", {"spin_rad_per_s": ""}),
    "slip": Chart("Slip", {"slip": ""}, "1 − v/(ω R)"),
    "sinkage": Chart("Sinkage", {"sinkage_m": ""}, "below the undisturbed surface"),
    "deflection": Chart("Deflection of the tire", {"sinkage_kinematic_m": ""}, "at its lowest point", y="deflection"),
    "height": Chart("Height of the wheel's centre", {"axle_height_m": ""}, y="height", unit=MM),
    "travel": Chart("Suspension travel", {"suspension_travel_m": ""}, "upward from the drawn position", y="travel"),
    **{name: Chart(naming(name)[0].capitalize(), {name: ""})
       for name in ("spindle_torque_Nm", "speed_m_per_s", "spring_force_N", "shock_force_N", "wheel_steer_rad",
                    "wheel_camber_rad", "drawbar_pull_N")}}

HEATS = {"converter_heat_J": "converter", "clutch_heat_J": "clutch and locks", "shift_heat_J": "changes of gear",
         "brake_heat_J": "brakes", "shock_heat_J": "shock absorbers", "lowering_heat_J": "touch-down damper"}
# Of a vehicle, over time.
VEHICLE = {
    "speeds": Chart("Speed", {"speed_m_s": "vehicle", "target_speed_m_per_s": "target"}, y="speed",
                    if_any=("target_speed_m_per_s",)),
    "inputs": Chart("The driver's inputs", {"throttle": "", "brake": "", "steering": "steering, left positive"},
                    y="input"),
    "angles": Chart("Pitch and roll", {"pitch_rad": "pitch, nose down positive",
                                       "roll_rad": "roll, right side down positive"}, y="angle"),
    "heading": Chart("Heading", {"yaw_rad": "", "heading_error_rad": ""}, y="angle"),
    "acceleration": Chart("Acceleration", {"acceleration_m_per_s2": "", "lateral_acceleration_m_per_s2": ""}),
    "yaw_rate": Chart("Yaw rate", {"yaw_rate_rad_per_s": ""}),
    "powers": Chart("Power", {"power_W": "engine and motors give", "wheel_power_W": "arrives at the wheels",
                              "soil_power_W": "tires and ground take"}, unit=KW),
    "heats": Chart("Work of the drive, and heat of the parts that dissipate it",
                   {"drive_work_J": "engine and motors give", **HEATS}, y="since the start", unit=KJ,
                   if_any=tuple(HEATS)),
    "engine": Chart("Speed of engine and converter's turbine", {"engine_speed_rpm": "engine",
                                                                "turbine_speed_rpm": "turbine"}, y="speed",
                    if_any=("turbine_speed_rpm",)),
    "torque": Chart("Engine torque", {"engine_torque_Nm": ""}),
    "gear": Chart("Gear", {"gear": ""}),
    "error": Chart("Error across the path", {"cross_track_error_m": ""}, "left of it positive", y="error"),
    "height": Chart("Height", {"z_m": "origin of the chassis"}, unit=MM)}

# Entries of accounts.energy; those of timeseries_accounts.csv end in _J.
WORK = {"drive_work": "drive of the wheels", "tow_work": "what moves the rig along", "guide_work": "rails and steering",
        "wall_work": "walls"}
STORED = {"terrain_kinetic": "grains: motion", "terrain_rotational": "grains: rotation",
          "terrain_potential": "grains: height", "terrain_elastic_normal": "grains: normal springs",
          "terrain_elastic_tangential": "grains: tangential springs", "terrain_cohesion": "grains: cohesion",
          "tire_kinetic": "tires: motion", "tire_elastic": "tires: strain", "tire_pressure": "tires: air",
          "tire_potential": "tires: height", "rig_kinetic_and_potential": "rig: motion and height"}
LOST = {"sliding_loss": "sliding", "normal_damping_loss": "normal damping",
        "tangential_damping_loss": "tangential damping", "rolling_loss": "rolling",
        "opening_loss": "contacts that open", "sleep_loss": "sleep", "tire_viscous_loss": "tires: viscous",
        "tire_numerical_loss": "tires: numerical", "tire_solver_loss": "tires: solver",
        "damper_loss": "touch-down damper", "surface_lag_loss": "lag at the surface", "rim_lag_loss": "lag at the rim"}
ACCOUNTS = {
    "residual": Chart("Energy that does not close", {"residual_J": "all", "terrain_residual_J": "terrain",
                                                     "tire_residual_J": "tires", "rig_residual_J": "rig"},
                      y="residual"),
    **{group: Chart(title, {f"{key}_J": words for key, words in entries.items()}, y="since the start")
       for group, title, entries in (("work", "Work put in", WORK), ("stored", "Energy stored", STORED),
                                     ("lost", "Energy lost", LOST))},
    "momentum": Chart("Momentum that does not close", {f"momentum_residual_{axis}_Ns": axis for axis in "xyz"},
                      y="residual")}

# Of soil tests: table of the test, and the columns that distinguish its runs.
SOIL = {
    "plate": (Chart("Plate sinkage", {"pressure_Pa": ""}, x="sinkage_m", x_words="sinkage below the mean surface"),
              ("width_m", "seed")),
    "shear": (Chart("Direct shear", {"shear_stress_Pa": ""}, x="travel_m", x_words="travel of the upper plate"),
              ("nominal_normal_stress_Pa", "seed")),
    "cone": (Chart("Cone penetration", {"pressure_Pa": ""}, y="force over base area", x="depth_m",
                   x_words="depth of the cone's base"), ("seed",)),
    "repose": (Chart("Angle of repose", {"height_after_m": ""}, y="height", unit=("m", 1.0), x="x_m"),
               ("cohesion_Pa", "seed"))}

# Of a pressed tire.
PRESS = Chart("Load and deflection", {"force_N": ""}, unit=KN, x="deflection_m")
CENTRE_LINE = Chart("Contact pressure", {"pressure_Pa": ""}, y="pressure along the centre line", x="x_m",
                    x_words="along", x_unit=MM)

MODES = Chart("Natural frequencies", {"frequency_Hz": ""}, "on a rim at rest", x="order",
              x_words="circumferential order")

# Of suspensions: what each motion is, its abscissa and what is drawn over it.
TRAVEL = {"x": "travel_m", "x_words": "wheel travel upward"}
STEERED = {"x": "steering", "x_words": "steering, 1 fully left"}
MOTIONS = {
    "parallel": ("Both wheels of an axle lifted alike", TRAVEL,
                 ("camber_rad", "toe_rad", "caster_rad", "kingpin_rad", "half_track_m", "scrub_m", "trail_m",
                  "roll_center_m", "anti_dive", "spring_ratio", "shock_ratio", "wheel_rate_N_per_m")),
    "opposite": ("One wheel of an axle lifted, the other lowered", TRAVEL,
                 ("camber_rad", "toe_rad", "half_track_m", "roll_center_m", "spring_ratio", "wheel_rate_N_per_m")),
    "steering": ("Steered, wheels as drawn", STEERED,
                 ("steer_rad", "ackermann", "camber_rad", "caster_rad", "kingpin_rad", "scrub_m", "trail_m",
                  "half_track_m"))}
