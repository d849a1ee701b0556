"""A vehicle's run: the tables of vehicle and wheels on one clock, with the wheels' names and places."""
import functools

import numpy as np

from .._home import home
from .digits import digits
from .run_data import Damaged, Missing, read_object, read_surface
from .units import is_number

ROLES = {1: ["front"], 2: ["front", "rear"], 3: ["front", "middle", "rear"]}
SMOOTHING = 0.05  # s, width of running means
GRAVITY = 9.81  # m/s²


def running_mean(time, values, width=SMOOTHING):
    """Over `width` s, shorter at the ends; of what is finite there."""
    values = np.asarray(values, float)
    half = int(0.5 * width / max(float(np.median(np.diff(time))), 1e-12)) if len(time) > 2 else 0
    if half < 1:
        return values
    good = np.isfinite(values)
    total = np.concatenate([[0.0], np.cumsum(np.where(good, values, 0.0))])
    count = np.concatenate([[0], np.cumsum(good)])
    index = np.arange(len(values))
    low, high = np.maximum(index - half, 0), np.minimum(index + half + 1, len(values))
    return np.where(good, (total[high] - total[low]) / np.maximum(count[high] - count[low], 1), np.nan)


class Wheel:
    """Columns of one wheel. Wheels 2 a and 2 a + 1 are the left and the right one of axle a."""

    def __init__(self, index, columns):
        self.index, self.columns = index, columns
        self.axle, self.side = index // 2, ("left", "right")[index % 2]
        self.name = f"wheel {index}"

    def __getitem__(self, column):
        if column not in self.columns:
            raise Missing(f"timeseries_wheel{self.index}.csv has no column {column}")
        return self.columns[column]

    def __contains__(self, column):
        return column in self.columns

    @property
    def surface(self):
        """Height of the undisturbed surface, m."""
        return float(self["sinkage_m"][0] + self["lowest_point_m"][0])

    @property
    def radius(self):
        """Undeformed, m."""
        found = float(self["sinkage_kinematic_m"][0] + self["axle_height_m"][0]) - self.surface
        if not found > 0.0:
            raise Damaged(f"timeseries_wheel{self.index}.csv: sinkages and heights give the wheel a radius of "
                          f"{found:g} m")
        return found


class VehicleRun:
    def __init__(self, run):
        self.run = run
        self.columns = run.table("timeseries_vehicle.csv")
        if not self.columns:
            raise Missing("is not the run of a vehicle (there is no timeseries_vehicle.csv)")
        self.wheels = []
        while columns := run.table(f"timeseries_wheel{len(self.wheels)}.csv"):
            self.wheels.append(Wheel(len(self.wheels), columns))
        files = sum(1 for path in run.directory.glob("timeseries_wheel*.csv"))
        if len(self.wheels) < files:
            raise Missing(f"timeseries_wheel{len(self.wheels)}.csv is missing or empty, but there are tables of "
                          f"{files} wheels")
        if not self.wheels or len(self.wheels) % 2:
            raise Missing(f"there are tables of {len(self.wheels)} wheels, expected two per axle")
        self._cut()
        self._name()

    def _cut(self):
        """To the lines that all tables have: those of a run that still continues may differ by one."""
        tables = [self.columns, *(wheel.columns for wheel in self.wheels)]
        for columns in tables:
            if "time_s" not in columns:
                raise Missing("a time series has no column time_s")
        length = min(len(columns["time_s"]) for columns in tables)
        for columns in tables:
            for name in columns:
                columns[name] = columns[name][:length]
        if not all(np.array_equal(columns["time_s"], tables[0]["time_s"]) for columns in tables):
            raise Damaged("timeseries_vehicle.csv and those of the wheels have lines at different times")
        if not np.all(np.diff(self.time) > 0.0):
            raise Damaged("timeseries_vehicle.csv: column 'time_s' does not rise")

    def _name(self):
        """Wheels after the vehicle's file, if the summary names them, else after the axles' places."""
        count = len(self.wheels) // 2
        order = sorted(range(count), key=lambda a: -self.wheels[2 * a]["position_m"][0])
        names = ROLES.get(count) or [f"axle {k + 1}" for k in range(count)]
        self.axles = [None] * count  # names, by number
        self.order = order  # numbers, from the front
        for name, axle in zip(names, order):
            self.axles[axle] = name
        told = self.run.wheel_names
        if len(told) == len(self.wheels):
            self.axles = [name.removesuffix("_left").replace("_", " ") for name in told[::2]]
        for wheel in self.wheels:
            wheel.name = f"{self.axles[wheel.axle]} {wheel.side}"

    def __getitem__(self, column):
        if column not in self.columns:
            raise Missing(f"timeseries_vehicle.csv has no column {column}")
        return self.columns[column]

    def __contains__(self, column):
        return column in self.columns

    @property
    def time(self):
        return self["time_s"]

    @property
    def hard_ground(self):
        return (self.run.told.get("terrain_engine") or (self.run.scenario.get("terrain")
                                                        or {}).get("engine")) == "rigid"

    def of_axle(self, axle):
        return [wheel for wheel in self.wheels if wheel.axle == axle]

    @property
    def window(self):
        """(from, to) over which the run averages, s; None before it begins."""
        begin = (self.run.scenario.get("run") or {}).get("average_from")
        return None if begin is None or not begin < self.time[-1] else (float(begin), float(self.time[-1]))

    @functools.cached_property
    def loads(self):
        """Weight on each wheel at rest, N. A run without a summary has their mean over the last half instead."""
        loads = [entry.get("vertical_load_N") for entry in self.run.told.get("wheels") or []]
        if len(loads) == len(self.wheels) and all(is_number(load) and load > 0 for load in loads):
            return [float(load) for load in loads]
        late = self.time >= 0.5 * self.time[-1]
        return [float(np.mean(wheel["force_z_N"][late])) for wheel in self.wheels]

    @property
    def weight(self):
        return sum(self.loads)

    def pose(self, time):
        """(origin, rotation) of the chassis: columns of the rotation are forward, left, up. Z-Y-X angles."""
        x, y, z, roll, pitch = (np.interp(time, self.time, self[name])
                                for name in ("x_m", "y_m", "z_m", "roll_rad", "pitch_rad"))
        yaw = np.interp(time, self.time, np.unwrap(self["yaw_rad"]))
        (ca, sa), (cb, sb), (cc, sc) = ((np.cos(angle), np.sin(angle)) for angle in (yaw, pitch, roll))
        rotation = np.array([[ca * cb, ca * sb * sc - sa * cc, ca * sb * cc + sa * sc],
                             [sa * cb, sa * sb * sc + ca * cc, sa * sb * cc - ca * sc],
                             [-sb, cb * sc, cb * cc]])
        return np.array([x, y, z]), rotation

    def tire_frames(self, index):
        """[(vertices, triangles)] of all tires at an instant, and its time."""
        tires, time = [], 0.0
        for wheel in self.wheels:
            path = self.run.frames(f"tire{wheel.index}").get(index)
            if path is None:
                raise Missing(f"there is no frame {index} of tire {wheel.index}")
            vertex, triangle, time = read_surface(path)
            tires.append((vertex, triangle))
        return tires, time

    def instants(self):
        """Numbers of frames that all tires have."""
        have = [set(self.run.frames(f"tire{wheel.index}")) for wheel in self.wheels]
        return sorted(set.intersection(*have)) if have else []

    @functools.cached_property
    def places(self):
        """(forward, left) of each wheel's centre in the vehicle's frame at the start, m."""
        instants = self.instants()
        if instants:
            tires, time = self.tire_frames(instants[0])
            origin, rotation = self.pose(time)
            return [tuple((0.5 * (vertex.min(0) + vertex.max(0)) - origin) @ rotation[:, :2]) for vertex, _ in tires]
        lateral = [entry.get("lateral_m") for entry in self.run.told.get("wheels") or []]
        if len(lateral) != len(self.wheels) or not all(map(is_number, lateral)):
            raise Missing("there are no frames and no summary.json: where the wheels are is not known")
        yaw = self["yaw_rad"][0]
        along = np.cos(yaw) * self["x_m"][0] + np.sin(yaw) * self["y_m"][0]
        middle = self.run.rig.get("lateral") or 0.0
        return [(wheel["position_m"][0] - along, y - middle) for wheel, y in zip(self.wheels, lateral)]

    def tracks(self):
        """(x, y) of each wheel's centre over the ground against time."""
        yaw = self["yaw_rad"]
        return [(self["x_m"] + np.cos(yaw) * ahead - np.sin(yaw) * left, self["y_m"] + np.sin(yaw) * ahead + np.cos(yaw)
                 * left) for ahead, left in self.places]

    @functools.cached_property
    def data(self):
        """The vehicle's file where the run has it from, or one of those that are shipped; else an empty object."""
        path = home() / "vehicle/data" / (self.run.rig.get("vehicle") or "")  # the user's own has its full name
        return read_object(path) if path.is_file() else {}

    @property
    def title(self):
        return f"{self.run.title} · weight {digits(1e-3 * self.weight)} kN on {len(self.wheels)} wheels"
