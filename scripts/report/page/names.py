"""What columns and keys are called, and their units: `drawbar_pull_N` is the drawbar pull in N."""
import math

# Ending of a name: (unit as shown, factor to it). The first that fits counts.
ENDINGS = (("_kg_m_per_s", "kg m/s", 1.0), ("_Nm_per_rad", "N m/rad", 1.0), ("_rad_per_s", "rad/s", 1.0),
           ("_m_per_s2", "m/s²", 1.0), ("_m_per_s", "m/s", 1.0), ("_m_s", "m/s", 1.0), ("_rpm", "1/min", 1.0),
           ("_N_per_mm", "N/mm", 1.0), ("_N_per_m", "kN/m", 1e-3), ("_N_per_s", "N/s", 1.0), ("_kg_m2", "kg m²", 1.0),
           ("_Nm", "N m", 1.0), ("_Ns", "N s", 1.0), ("_N", "N", 1.0),
           ("_J", "J", 1.0), ("_W", "W", 1.0), ("_m2", "m²", 1.0),
           ("_deg", "°", 1.0), ("_rad", "°", math.degrees(1.0)), ("_Pa", "kPa", 1e-3),
           ("_kg", "kg", 1.0), ("_s", "s", 1.0),
           ("_m", "mm", 1e3))
LONG = {"position_m", "distance_m", "path_distance_m", "x_m", "y_m", "z_m",
        "axle_height_m", "lateral_m", "cross_track_error_m",
        "tire_radius_m", "surface_height_m", "effective_rolling_radius_m", "loaded_radius_m", "tread_width_m",
        "axle_height", "travel_x_m"}  # in m, not in mm
# Names whose own words would be hard to understand.
WORDS = {"simulated_s": "simulated time", "wall_s": "wall time", "settle_wall_s": "wall time for the bed",
         "wall_s_per_simulated_s": "wall time per simulated second", "cpu_s": "processor time",
         "compute_s": "computing", "communicate_s": "communicating", "wait_s": "waiting", "step_s": "step",
         "cpu": "processor", "z_m": "height", "contacts_tire": "contacts of the tire",
         "active_share": "share of grains awake", "active_share_mean": "share of grains awake, mean",
         "sinkage_kinematic_m": "kinematic sinkage"}


def naming(name):
    """(words, unit, factor by which values are multiplied)."""
    for ending, unit, factor in ENDINGS:
        if name.endswith(ending) and len(name) > len(ending):
            words = WORDS.get(name, name[:-len(ending)].replace("_", " ").replace(".", " "))
            if name in LONG:
                unit, factor = "m", 1.0
            return words, unit, factor
    return WORDS.get(name, name.replace("_", " ")), "", 1.0


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < 1e300
