"""What a run directory holds, read as far as it exists."""
import csv
import functools
import json
import pathlib
import re

import h5py
import numpy as np

from .digits import digits
from .units import is_number


class Missing(Exception):
    """What a plot needs is not in the run directory."""


class Damaged(ValueError):
    """A file in the run directory does not hold what it should."""


Missing.__module__ = Damaged.__module__ = "furrow"  # where a user finds them

# What damaged files may lead to.
PROBLEMS = (ArithmeticError, AttributeError, LookupError, MemoryError, OSError, RuntimeError, TypeError, ValueError,
            csv.Error, Missing)
KIND_FILES = {"calibration.json": "calibration", "soil.json": "soil", "sweep.json": "sweep", "press.csv": "press",
              "modes.csv": "modes", "kinematics.csv": "kinematics"}
RATIO = 64  # that datasets are compressed by, at most
LARGEST = 64 << 20  # bytes of a JSON file

# Types of the keys that plots read: an object of keys, a list of such objects, or the type itself.
SCENARIO = {"rig": {"travel_sign": float, "lateral": float, "vehicle": str, "wheels": [{"lateral": float}]},
            "run": {"average_from": float, "end": float}, "terrain": {"engine": str}}
PULL = {"mean": float, "sem": float, "from_s": float, "to_s": float, "steady": bool, "unsteady_because": list}
SUMMARY = {"scenario": str, "terrain_engine": str, "law": str, "slip": float, "vertical_load_N": float,
           "travel_sign": float, "drawbar_coefficient": float, "tread_width_m": float, "rut_depth_m": float,
           "rut_width_m": float, "surface_height_m": float, "sinkage_m": float, "grains": float,
           "bed_clearance_m": float, "net_terrain_force_N": list, "ranks": list, "failed": dict,
           "drawbar_pull_N": PULL, "accounts": {"energy": dict, "momentum": dict}}
NAMES = {str: "a text", float: "a number", dict: "an object", bool: "true or false", list: "a list"}


def printable(text):
    """One line that a terminal only shows."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in str(text))


def in_words(error):
    """What is wrong with results, of an error of PROBLEMS: one line."""
    if isinstance(error, (Damaged, Missing)) or getattr(error, "errno", None):
        return printable(error)
    if isinstance(error, MemoryError):
        return "there is not enough memory for it"
    return printable(f"a file in it is damaged: {error!r}")[:300]


def why_no_folder(folder):
    """Makes a folder of results. None: it is there."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        return f"cannot be made: {error.strerror}"
    return None


def kind_of(directory):
    """What a folder holds: `run` without any of the files that tell another kind."""
    return next((kind for name, kind in KIND_FILES.items() if (directory / name).is_file()), "run")


def read_object(path):
    """The object that a JSON file holds."""
    if path.stat().st_size > LARGEST:
        raise Damaged(f"{path.name} is larger than {LARGEST >> 20} MB")
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise Damaged(f"{path.name} is no valid JSON: {error}") from error
    except RecursionError as error:
        raise Damaged(f"{path.name} is nested too deeply") from error
    if not isinstance(content, dict):
        raise Damaged(f"{path.name} is not a JSON object")
    return content


def check_types(content, kinds, where):
    """Values of other types than these keys have, null aside, are errors that name the key."""
    for key, kind in kinds.items():
        value, name = content.get(key), NAMES[kind if isinstance(kind, type) else type(kind)]
        if value is None:
            continue
        if not (is_number(value) if kind is float else isinstance(value, kind if isinstance(kind,
                                                                                            type) else type(kind))):
            raise Damaged(f"{where}: key '{key}': is {printable(json.dumps(value))[:60]}, expected {name}")
        if isinstance(kind, dict):
            check_types(value, kind, f"{where}: key '{key}'")
        elif isinstance(kind, list):
            for k, item in enumerate(value):
                check_types({f"{key}.{k}": item}, {f"{key}.{k}": kind[0]}, where)


def read_dataset(file, name):
    """All numbers of an HDF5 dataset, which is not read where it is larger than what is stored of it."""
    what = f"{pathlib.Path(file.filename).name}: the dataset '{name}'"
    found = file.get(name)
    if not isinstance(found, h5py.Dataset):
        raise Damaged(f"{what} is missing")
    if found.dtype.kind not in "iuf":
        raise Damaged(f"{what} holds no plain numbers")
    stored = found.id.get_storage_size()
    if found.size * found.dtype.itemsize > stored * (RATIO if found.id.get_create_plist().get_nfilters() else 1):
        raise Damaged(f"{what} is said to have {found.size} numbers, but {stored} bytes are stored: it was never "
                      "written, or the file is cut short or damaged")
    return found[()]


def table(file, name, columns):
    """A dataset of as many columns; a vector where `columns` is 0."""
    values = read_dataset(file, name)
    if (values.ndim != 1) if columns == 0 else (values.ndim != 2 or values.shape[1] != columns):
        raise Damaged(f"{pathlib.Path(file.filename).name}: the dataset '{name}' has the shape {values.shape}, "
                      "expected " + (f"N × {columns}" if columns else "N numbers"))
    return values


def read_table(path):
    """Columns of a CSV file of numbers by their names; none where it has no line."""
    lines = path.read_text(encoding="utf-8").splitlines()
    names = lines[0].split(",") if lines else []
    # A run that still continues may be half-way through its last line.
    rows = [line.split(",") for line in lines[1:] if line.count(",") == len(names) - 1]
    try:
        return dict(zip(names, np.array(rows, dtype=float).T)) if rows else {}
    except ValueError as error:
        raise Damaged(f"{path.name} holds something that is no number: {error}") from error


def read_surface(path):
    """(vertices, triangles, time) of a frame of a tire."""
    with h5py.File(path, "r") as file:
        vertex, triangle = table(file, "position", 3).astype(float), table(file, "triangle", 3).astype(int)
        time = float(file.attrs["time_s"])
    if not (len(vertex) and len(triangle) and np.isfinite(vertex).all() and 0 <= triangle.min()
            and triangle.max() < len(vertex)):
        raise Damaged(f"{path.name} holds no surface that could be drawn")
    return vertex, triangle, time


def read_grains(path, scale=1.0):
    """(positions, radii) of a frame of the grains, enlarged."""
    with h5py.File(path, "r") as file:
        position, radius = (scale * table(file, *what).astype(float) for what in (("position", 3), ("radius", 0)))
    if not len(radius) or len(position) != len(radius) or not (np.isfinite(position).all() and (radius > 0.0).all()):
        raise Damaged(f"{path.name} holds no grains that could be drawn")
    return position, radius


class HeightField:
    """Surface heights z (m) over cell centres x, y (m); NaN where no grain is."""

    def __init__(self, z, grid):
        if np.shape(grid) != (3,) or np.ndim(z) != 2 or not np.all(np.isfinite(grid)):
            raise Damaged("results.h5 holds no height field")
        x0, y0, cell = grid
        self.z, self.cell = np.asarray(z, float), cell
        self.x = x0 + cell * np.arange(self.z.shape[0])
        self.y = y0 + cell * np.arange(self.z.shape[1])


def read_heights(path):
    """(before, after), HeightField, of results.h5."""
    if not path.exists():
        raise Missing("there is no results.h5 yet")
    try:
        with h5py.File(path, "r") as file:
            if "terrain/height_after" not in file:
                raise Missing("this ground has no surface that deforms")
            return tuple(HeightField(read_dataset(file, f"terrain/height_{when}"),
                                     read_dataset(file, f"terrain/height_{when}_grid")) for when in ("before", "after"))
    except OSError as error:
        raise Damaged(f"{path.name} cannot be read: {error}") from error


class Run:
    def __init__(self, directory):
        if not directory.is_dir():
            raise Damaged("is not a directory")
        self.directory = directory
        self.summary = self._summary("summary.json")
        self.scenario = self._json("scenario.json")
        check_types(self.scenario, SCENARIO, "scenario.json")
        self.soil_estimate = self._json("soil_estimate.json")
        self.series = self._read_series()

    def _json(self, name):
        path = self.directory / name
        return read_object(path) if path.exists() else {}

    @functools.cached_property
    def failed(self):
        """What a run that has failed left in place of its summary; empty for any other."""
        return {} if self.summary else self._summary("summary_failed.json")

    @property
    def told(self):
        """The summary, of a failed run what it left."""
        return self.summary or self.failed

    @property
    def told_in(self):
        """The file that holds it."""
        return "summary_failed.json" if self.failed else "summary.json"

    def _summary(self, name):
        """Of several wheels, wheel 0's keys stand beside those of the run, as they do of a single one."""
        summary = self._json(name)
        check_types(summary, {"wheels": [{}]}, name)
        summary = {**(summary.get("wheels") or [{}])[0], **summary}
        check_types(summary, SUMMARY, name)
        return summary

    def _read_series(self):
        """Columns of the table of wheel 0."""
        return self.table("timeseries.csv") or self.table("timeseries_wheel0.csv")

    @property
    def cut_short(self):
        """Of a finished run's table without its end: a sentence; empty for any other."""
        time, end = self.series.get("time_s", []), self.summary.get("end_time_s")
        if not is_number(end) or len(time) < 2 or end - time[-1] <= 2 * (time[-1] - time[-2]):
            return ""
        return f"the table of the wheel ends at {time[-1]:.4g} s and the run at {end:.4g} s: it was cut short"

    def table(self, name):
        """Columns of a table by their names; none when there is no such file."""
        path = self.directory / name
        return read_table(path) if path.exists() else {}

    def column(self, name):
        if name not in self.series:
            raise Missing(f"the time series has no column {name}" if self.series else "there is no timeseries.csv")
        return self.series[name]

    def heights(self):
        """(before, after), HeightField."""
        return read_heights(self.directory / "results.h5")

    def frames(self, kind):
        """Frame files of `kind` ("tire0", "terrain") by index."""
        found = {}
        for path in (self.directory / "frames").glob(f"{kind}_*.h5"):
            if match := re.fullmatch(rf"{kind}_(\d+)\.h5", path.name):
                found[int(match[1])] = path
        return found

    def number(self, name, default=None):
        """A number of the summary; null and missing become `default`."""
        value = self.summary.get(name)
        return default if value is None else value

    @property
    def travel_sign(self):
        return float(self.rig.get("travel_sign") or self.number("travel_sign") or 1.0)

    @property
    def lateral(self):
        """y of wheel 0's mid-plane, m."""
        return float(self.wheels[0].get("lateral") or 0.0) if self.wheels else 0.0

    @property
    def rig(self):
        return self.scenario.get("rig") or {}

    @property
    def wheels(self):
        """Entries of rig.wheels."""
        return self.rig.get("wheels") or []

    @property
    def wheel_names(self):
        """What a vehicle's file calls its wheels, "front_left"; empty where the summary has none."""
        names = [wheel.get("name") for wheel in self.told.get("wheels") or []]
        return [printable(name) for name in names] if all(isinstance(name, str) for name in names) else []

    @property
    def measured(self):
        """False for a tire that did not touch the ground in the averaging window."""
        force = self.summary.get("net_terrain_force_N") or []
        return not (len(force) == 3 and force[2] == 0)

    @property
    def window(self):
        """(from, to) of the averaging window, s; None when nothing was averaged."""
        pull = self.summary.get("drawbar_pull_N") or {}
        if pull.get("from_s") is None or pull.get("to_s") is None:
            return None
        return pull["from_s"], pull["to_s"]

    @property
    def has_vehicle(self):
        return (self.directory / "timeseries_vehicle.csv").exists()

    @property
    def title(self):
        name = self.summary.get("scenario") or self.directory.name
        what = [name]
        if self.rig.get("vehicle"):
            what.append(pathlib.PurePath(self.rig["vehicle"]).stem)
        if "terrain_engine" in self.summary:
            engine = self.summary["terrain_engine"]
            law = self.summary.get("law")  # of grains
            grains = f"{engine}, {law}" if law else engine
            what.append({"rigid": "rigid ground", "scm": "empirical soil"}.get(engine, grains))
        if self.number("slip") is not None:
            what.append(f"slip {self.number('slip'):g}")
        if self.number("vertical_load_N") is not None and not self.has_vehicle:
            what.append(f"load {digits(self.number('vertical_load_N'))} N")
        if len(self.wheels) > 1:
            what.append(f"wheel 0 of {len(self.wheels)}")
        if self.scenario and not self.summary:
            what.append("ended by an error" if (self.directory / "summary_failed.json").exists()
                        else "stopped before its end")
        return " · ".join(what)
