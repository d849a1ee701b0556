"""Studies and beds: what `furrow sweep` and `furrow run --seeds` leave."""
from __future__ import annotations

import pathlib
from functools import cached_property
from typing import Any

import pandas as pd

from .plot import run_data
from .plot.run_data import Missing
from .runs import Run
from .tables import frame_of, read_csv


class Study:
    """The folder of a study, or of several beds of one scenario; both may be unfinished."""

    def __init__(self, directory: pathlib.Path) -> None:
        self.directory = directory
        #: sweep.json: what was asked for
        self.asked: dict[str, Any] = run_data.read_object(directory / "sweep.json")
        done = directory / "summary.json"
        failed = directory / "summary_failed.json"
        #: of beds: means over them with `half_width_95`; empty for a study
        self.summary: dict[str, Any] = (run_data.read_object(done) if done.exists()
                                        else run_data.read_object(failed) if failed.exists() else {})

    @cached_property
    def table(self) -> pd.DataFrame:
        """sweep.csv: one line per run with its folder, state, keys that were varied and results.

        Raises Missing while there is none.
        """
        path = self.directory / "sweep.csv"
        if not path.exists():
            raise Missing(f"{self.directory} has no sweep.csv yet")
        return read_csv(path, {"folder": str, "state": str, "problem": str})

    def run(self, index: int) -> Run:
        """A run by its place in the table, from 0 on. Raises Missing when it has no folder yet."""
        folder = self.table["folder"].iloc[index]
        if not isinstance(folder, str) or not (self.directory / folder).is_dir():
            raise Missing(f"{self.directory}: run {index} has not begun")
        return Run(self.directory / folder)

    @property
    def runs(self) -> list[Run]:
        """All runs that have ended."""
        return [self.run(index) for index, state in enumerate(self.table["state"]) if state == "done"]

    def points(self, x: str, y: str, error: str = "", mean_over: str = "", **only: Any) -> pd.DataFrame:
        """A curve of the study: `y` over `x`, columns of the table, of the runs that are done.

        With `mean_over`, the name of a key such as "run.seed": means over the runs with the same x, and `half_bar` half
        their 95 % interval [Student's t]; else `half_bar` is the column `error`. `unsteady` is true where a run's pull
        is not steady. Further arguments choose runs: terrain__cohesion=80e3. Raises Missing when no such run is done,
        KeyError for a column that is not there, ValueError where a mean would be over runs that differ in another key.
        """
        rows = self.table[self.table["state"] == "done"]
        for name, value in only.items():
            rows = rows[rows[name.replace("__", ".")] == value]
        for name in filter(None, (x, y, error, mean_over)):
            if name not in rows.columns:
                raise KeyError(f"{self.directory}: sweep.csv has no column '{name}'")
        if rows.empty:
            raise Missing(f"{self.directory}: no such run is done")
        from .plots import sweep  # which needs matplotlib
        if mean_over:
            keys = {"pass", *sweep.keys_among(list(rows.columns), self.asked["results"])} & set(rows.columns)
            of_point = rows.groupby(x)[sorted(keys - {x, mean_over})].nunique(dropna=False)
            for key in of_point.columns[(of_point > 1).any()]:
                raise ValueError(f"{self.directory}: runs with the same {x} differ in {key}, expected one value of it: "
                                 f"{key.replace('.', '__')}=…")
        lines = [{name: str(value) for name, value in row.items()} for row in rows.to_dict("records")]
        values = sweep.points(lines, x, y, error, mean_over)
        table = frame_of({x: values[0], y: values[1], "half_bar": values[2]})
        table["unsteady"] = values[3].astype(bool)
        return table

    def __repr__(self) -> str:
        kind = "beds" if self.asked.get("beds") else "study"
        states = self.table["state"].value_counts().to_dict() if (self.directory / "sweep.csv").exists() else {}
        return (f"<{kind} in {self.directory}: "
                f"{', '.join(f'{count} {state}' for state, count in states.items()) or 'no run yet'}>")
