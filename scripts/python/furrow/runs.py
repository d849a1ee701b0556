"""One run: what `furrow run` leaves in its folder, as far as it exists."""
from __future__ import annotations

import pathlib
import re
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from .frames_vtk import kinds_of
from .plot import run_data
from .plot.frames import Frames, GrainFrame, TireFrame
from .plot.run_data import Missing
from .plot.vtk import write_kinds
from .tables import dataset_of, frame_of


class Run:
    """A run's folder. It may be done, failed or still running; what is not there raises Missing.

    Everything but the summary and the scenario is read when it is first asked for. SI units, angles in radians.
    World axes: x forward, y left, z up; forces are those on the tire by the terrain.
    """

    def __init__(self, directory: pathlib.Path) -> None:
        self.directory = directory
        self._run = run_data.Run(directory)
        failed = directory / "summary_failed.json"
        done = directory / "summary.json"
        self._failed = failed.exists() and not done.exists()
        #: summary.json, or summary_failed.json of a run that failed; empty while it runs
        self.summary: dict[str, Any] = (run_data.read_object(failed) if self._failed
                                        else run_data.read_object(done) if done.exists() else {})

    @property
    def state(self) -> str:
        """"done", "failed" or "unfinished"."""
        return "failed" if self._failed else "done" if self.summary else "unfinished"

    @property
    def failure(self) -> dict[str, Any] | None:
        """Why it failed: `exit_code`, `error`, `time_s`; None for any other run."""
        return self.summary.get("failed") if self._failed else None

    @property
    def scenario(self) -> dict[str, Any]:
        """The scenario with every default, as it was run."""
        return dict(self._run.scenario)

    @property
    def name(self) -> str:
        return str(self.summary.get("scenario") or self.directory.name)

    def number(self, key: str) -> float:
        """A number of the summary by its dotted path: "drawbar_pull_N.mean", "wheels.1.sinkage_m".

        NaN where the summary says null. Raises KeyError when there is no such key.
        """
        if not isinstance(key, str):
            raise TypeError(f"the key is {key!r}, expected a text: 'drawbar_pull_N.mean'")
        value: Any = self.summary
        for part in key.split("."):
            if isinstance(value, list) and part.isdigit() and int(part) < len(value):
                value = value[int(part)]
            elif isinstance(value, dict) and part in value:
                value = value[part]
            else:
                raise KeyError(f"{self.directory}: the summary has no key '{key}'")
        if value is not None and not isinstance(value, (int, float)):
            raise KeyError(f"{self.directory}: key '{key}' of the summary is no number")
        return float("nan") if value is None else float(value)

    @cached_property
    def subjects(self) -> list[str]:
        """What there are tables of: "wheel0", "wheel1", …, "vehicle", "accounts"."""
        found = ["wheel0"] if (self.directory / "timeseries.csv").exists() else []
        names = (re.fullmatch(r"timeseries_(\w+)\.csv", path.name) for path in self.directory.glob("timeseries_*.csv"))
        found += [match[1] for match in names if match]
        return sorted(found, key=lambda name: (not name.startswith("wheel"), name == "accounts", len(name), name))

    def series(self, subject: str = "wheel0") -> pd.DataFrame:
        """The time series of a subject, over `time_s`. `attrs["units"]` is {column: unit}.

        Raises Missing when the run has no such table, or no line in it yet.
        """
        single = self.directory / "timeseries.csv"
        path = single if subject == "wheel0" and single.exists() else self.directory / f"timeseries_{subject}.csv"
        if not path.exists():
            raise Missing(f"{self.directory} has no table of '{subject}', expected one of: {', '.join(self.subjects)}")
        columns = self._run.table(path.name)
        if "time_s" not in columns:
            raise Missing(f"{path.name} has no line yet")
        return frame_of(columns, index="time_s")

    def xarray(self, subject: str = "wheel0") -> xr.Dataset:
        """The same as a Dataset; every variable has `units` and `long_name`."""
        return dataset_of(self.series(subject), scenario=self.name, subject=subject)

    @property
    def wheels(self) -> list[pd.DataFrame]:
        """The tables of all wheels."""
        return [self.series(name) for name in self._wheel_names]

    @property
    def _wheel_names(self) -> list[str]:
        return [name for name in self.subjects if name.startswith("wheel")]

    @property
    def vehicle(self) -> pd.DataFrame:
        """timeseries_vehicle.csv: place, speeds, driver, engine. Raises Missing for a drawbar rig."""
        return self.series("vehicle")

    @property
    def accounts(self) -> pd.DataFrame:
        """Entries of the account of energy over time, J. The accounts as a whole: `summary["accounts"]`."""
        return self.series("accounts")

    def tire(self, wheel: int = 0) -> Frames[TireFrame]:
        """Frames of a wheel's tire: `position`, `velocity`, `force` (n, 3), `triangle` (m, 3).

        Raises Missing when the run has no such wheel.
        """
        names = self._wheel_names
        if f"wheel{wheel}" not in names and names:
            raise Missing(f"{self.directory} has no wheel {wheel}, expected 0 to {len(names) - 1}")
        return Frames(TireFrame, self._run.frames(f"tire{wheel}"))

    @property
    def grains(self) -> Frames[GrainFrame]:
        """Frames of the grains: `position` (n, 3), `speed`, `radius` (n,). None on rigid ground."""
        return Frames(GrainFrame, self._run.frames("terrain"))

    def footprint(self, wheel: int = 0, time: float | None = None) -> pd.DataFrame:
        """The nodes of a tire that the terrain pushes at, in the frame nearest to `time` (default: the last one).

        One line per node: x_m, y_m, z_m, force_x_N, force_y_N, force_z_N.
        """
        frames = self.tire(wheel)
        frame = frames.at(np.inf if time is None else time) if time is not None or not len(frames) else frames[-1]
        pushed = np.any(frame.force != 0.0, axis=1)
        values = np.hstack([frame.position[pushed], frame.force[pushed]]).astype(float)
        table = frame_of(dict(zip(("x_m", "y_m", "z_m", "force_x_N", "force_y_N", "force_z_N"), values.T)))
        table.attrs["time_s"] = frame.time
        return table

    @cached_property
    def heights(self) -> xr.Dataset:
        """The surface of the terrain: height_before, height_after over x_m, y_m, in m; NaN where no grain is.

        Raises Missing on rigid ground and before the end of the run.
        """
        before, after = self._run.heights()
        values = {"height_before": (("x_m", "y_m"), before.z), "height_after": (("x_m", "y_m"), after.z)}
        dataset = xr.Dataset(values, coords={"x_m": before.x, "y_m": before.y})
        for variable in dataset.variables.values():
            variable.attrs["units"] = "m"
        return dataset

    def write_vtk(self, folder: str | pathlib.Path) -> pathlib.Path:
        """All frames as VTK PolyData: tire<k>_<index>.vtp, terrain_<index>.vtp, and <kind>.pvd, which lists them by
        time.

        Returns the folder. Any VTK or ParaView opens them.
        """
        return pathlib.Path(write_kinds(pathlib.Path(folder), kinds_of(self._run)))

    def __repr__(self) -> str:
        return f"<Run {self.name} in {self.directory}: {self.state}; {', '.join(self.subjects)}>"
