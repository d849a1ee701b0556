"""What columns and keys are called, and their units, which their names end in: `drawbar_pull_N` is the drawbar pull in
N."""
import math

# Ending of a name, its unit in results.h5, the unit that people are shown and the factor to it. The first counts.
ENDINGS = (("kg_m_per_s", "kg m/s", "kg m/s", 1.0), ("Nm_per_rad", "N m/rad", "N m/rad", 1.0),
           ("rad_per_s", "rad/s", "rad/s", 1.0), ("m_per_s2", "m/s2", "m/s²", 1.0), ("m_per_s", "m/s", "m/s", 1.0),
           ("m_s", "m/s", "m/s", 1.0), ("rpm", "1/min", "1/min", 1.0), ("N_per_mm", "N/mm", "N/mm", 1.0),
           ("N_per_m", "N/m", "kN/m", 1e-3), ("N_per_s", "N/s", "N/s", 1.0), ("kg_m2", "kg m2", "kg m²", 1.0),
           ("Nm", "N m", "N m", 1.0), ("Ns", "N s", "N s", 1.0), ("N", "N", "N", 1.0), ("J", "J", "J", 1.0),
           ("W", "W", "W", 1.0), ("m2", "m2", "m²", 1.0), ("deg", "deg", "°", 1.0),
           ("rad", "rad", "°", math.degrees(1.0)), ("Pa", "Pa", "kPa", 1e-3), ("kg", "kg", "kg", 1.0),
           ("Hz", "Hz", "Hz", 1.0), ("s", "s", "s", 1.0), ("m", "m", "mm", 1e3))
LONG = {"position_m", "distance_m", "path_distance_m", "x_m", "y_m", "z_m", "axle_height_m", "lateral_m",
        "cross_track_error_m", "tire_radius_m", "surface_height_m", "effective_rolling_radius_m", "loaded_radius_m",
        "tread_width_m", "axle_height", "travel_x_m"}  # in m, not in mm
# Names whose own words would be hard to understand.
WORDS = {"simulated_s": "simulated time", "wall_s": "wall time", "settle_wall_s": "wall time for the bed",
         "wall_s_per_simulated_s": "wall time per simulated second", "cpu_s": "processor time",
         "compute_s": "computing", "communicate_s": "communicating", "wait_s": "waiting", "step_s": "step",
         "cpu": "processor", "z_m": "height", "contacts_tire": "contacts of the tire",
         "active_share": "share of grains awake", "active_share_mean": "share of grains awake, mean",
         "sinkage_kinematic_m": "kinematic sinkage", "drawbar_coefficient": "pull over load",
         "vertical_load_N": "load", "toe_rad": "toe-in", "half_track_m": "half-track",
         "roll_center_m": "roll centre above ground", "scrub_m": "scrub radius",
         "spring_ratio": "motion ratio of the spring", "shock_ratio": "motion ratio of the shock",
         "anti_dive": "anti-dive, anti-lift", "steer_rad": "steer angle to the left"}
PERCENT = {"anti_dive", "ackermann"}  # numbers without a unit that are shown as shares


def ending_of(name):
    """The row of ENDINGS that fits a name; None: it has no unit."""
    return next((row for row in ENDINGS if name.endswith("_" + row[0]) and len(name) > len(row[0]) + 1), None)


def naming(name):
    """(words, unit, factor by which values are multiplied), as people are shown them."""
    row = ending_of(name)
    if row is None:
        return WORDS.get(name, name.replace("_", " ")), *(("%", 100.0) if name in PERCENT else ("", 1.0))
    unit, factor = ("m", 1.0) if name in LONG else row[2:]
    return WORDS.get(name, name[:-len(row[0]) - 1].replace("_", " ").replace(".", " ")), unit, factor


def label_of(name, words="", scale=()):
    """An axis' words with its unit; those of the column unless others are given."""
    own, *usual = naming(name)
    return ", ".join(filter(None, (words or own, (scale or usual)[0])))


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < 1e300
