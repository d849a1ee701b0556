"""What a run directory holds, read as far as it exists."""
import json
import re

import h5py
import numpy as np

from .digits import digits


class Missing(Exception):
    """What a plot needs is not in the run directory."""


class HeightField:
    """Surface heights z (m) over cell centres x, y (m); NaN where no grain is."""

    def __init__(self, z, grid):
        x0, y0, cell = grid
        self.z, self.cell = np.asarray(z, float), cell
        self.x = x0 + cell * np.arange(self.z.shape[0])
        self.y = y0 + cell * np.arange(self.z.shape[1])


class Run:
    def __init__(self, directory):
        if not directory.is_dir():
            raise OSError("is not a directory")
        self.directory = directory
        self.summary = self._summary()
        self.scenario = self._json("scenario.json")
        self.soil_estimate = self._json("soil_estimate.json")
        self.series = self._read_series()

    def _json(self, name):
        path = self.directory / name
        if not path.exists():
            return {}
        try:
            content = json.loads(path.read_text(encoding="utf-8"))
        except ValueError as error:
            raise ValueError(f"{name} is no valid JSON: {error}") from error
        if not isinstance(content, dict):
            raise ValueError(f"{name} is not a JSON object")
        return content

    def _summary(self):
        """Of several wheels, wheel 0's keys stand beside those of the run, as they do of a single one."""
        summary = self._json("summary.json")
        wheels = summary.get("wheels") or [{}]
        return {**wheels[0], **summary}

    def _read_series(self):
        """Columns of the table of wheel 0."""
        path = next((self.directory / name for name in ("timeseries.csv", "timeseries_wheel0.csv")
                     if (self.directory / name).exists()), None)
        if path is None:
            return {}
        lines = path.read_text(encoding="utf-8").splitlines()
        names = lines[0].split(",") if lines else []
        # A run that still goes on may be half-way through its last line.
        rows = [line.split(",") for line in lines[1:] if line.count(",") == len(names) - 1]
        if not rows:
            return {}
        try:
            return dict(zip(names, np.array(rows, dtype=float).T))
        except ValueError as error:
            raise ValueError(f"{path.name} holds something that is no number: {error}") from error

    def column(self, name):
        if name not in self.series:
            raise Missing(f"the time series has no column {name}" if self.series else "there is no timeseries.csv")
        return self.series[name]

    def heights(self):
        """(before, after), HeightField."""
        path = self.directory / "results.h5"
        if not path.exists():
            raise Missing("there is no results.h5 yet")
        with h5py.File(path, "r") as file:
            if "terrain/height_after" not in file:
                raise Missing("this ground has no surface that deforms")
            return tuple(HeightField(file[f"terrain/height_{when}"][()], file[f"terrain/height_{when}_grid"][()])
                         for when in ("before", "after"))

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
        rig = self.scenario.get("rig", {})
        return float(rig.get("travel_sign", self.number("travel_sign", 1.0)) or 1.0)

    @property
    def lateral(self):
        """y of wheel 0's mid-plane, m."""
        wheels = self.scenario.get("rig", {}).get("wheels") or [{}]
        return float(wheels[0].get("lateral") or 0.0)

    @property
    def window(self):
        """(from, to) of the averaging window, s; None when nothing was averaged."""
        pull = self.summary.get("drawbar_pull_N") or {}
        if pull.get("from_s") is None or pull.get("to_s") is None:
            return None
        return pull["from_s"], pull["to_s"]

    @property
    def title(self):
        name = self.summary.get("scenario") or self.directory.name
        what = [name]
        if "terrain_engine" in self.summary:
            engine = self.summary["terrain_engine"]
            what.append(f"{engine}, {self.summary.get('law', '?')}" if engine != "rigid" else "rigid ground")
        if self.number("slip") is not None:
            what.append(f"slip {self.number('slip'):g}")
        if self.number("vertical_load_N") is not None:
            what.append(f"load {digits(self.number('vertical_load_N'))} N")
        wheels = len(self.scenario.get("rig", {}).get("wheels") or [])
        if wheels > 1:
            what.append(f"wheel 0 of {wheels}")
        if self.scenario and not self.summary:
            what.append("stopped before its end")
        return " · ".join(what)
