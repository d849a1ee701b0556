"""Soil tests, pressed tires, frequencies, suspensions and fits: what `furrow soil`, `press`, `modes`, `kc` and
`calibrate` leave."""
from __future__ import annotations

import pathlib
from functools import cached_property
from typing import Any

import pandas as pd

from .plot import run_data
from .plot.run_data import Missing
from .tables import read_csv


class Tests:
    """A folder with a file of figures and tables beside it."""

    FIGURES = "summary.json"

    def __init__(self, directory: pathlib.Path) -> None:
        self.directory = directory
        #: the figures
        self.summary: dict[str, Any] = run_data.read_object(directory / self.FIGURES)

    def table(self, name: str) -> pd.DataFrame:
        """A table by its name without .csv; `attrs["units"]` is {column: unit}. Raises Missing."""
        path = self.directory / f"{name}.csv"
        if not path.exists():
            raise Missing(f"{self.directory} has no {name}.csv")
        return read_csv(path)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} in {self.directory}>"


def _table(name: str, about: str) -> cached_property[pd.DataFrame]:
    """A table of the folder, read when it is first used. Raises Missing when the test was not run."""
    def read(tests: Tests) -> pd.DataFrame:
        return tests.table(name)
    read.__doc__ = about
    return cached_property(read)


class Soil(Tests):
    """Virtual soil tests. `summary["standard_error"]` holds the errors of the figures."""

    FIGURES = "soil.json"

    plate = _table("plate", "Pressure against sinkage of each plate.")
    shear = _table("shear", "Shear stress against displacement under each normal stress.")
    cone = _table("cone", "Resistance of a cone against its depth.")
    repose = _table("repose", "The slope that is left when a wall is taken away.")


class Press(Tests):
    """A tire pressed on a plate or a cleat."""

    curve = _table("press", "Force against deflection, loading and unloading.")
    footprint = _table("footprint", "Contact pressure over the footprint.")


class Modes(Tests):
    """Natural frequencies of a tire on a rim at rest."""

    frequencies = _table("modes", "Frequencies by circumferential order and number.")
    shapes = _table("shapes", "Amplitudes of the nodes of a section in each mode, their real and imaginary parts.")


class Kinematics(Tests):
    """Suspensions of a vehicle against travel and steering."""

    curves = _table("kinematics", "Camber, toe, rates and more of each wheel, by motion.")


class Calibration(Tests):
    """A model fitted to data. `summary["parameters"]` holds value, standard error and 95 % interval of each
    parameter."""

    FIGURES = "calibration.json"

    @cached_property
    def parameters(self) -> pd.DataFrame:
        """A row for each parameter: value, standard_error, interval_95, unit, at_bound."""
        return pd.DataFrame.from_dict(self.summary["parameters"], orient="index")

    fit = _table("fit", "Data, their standard errors and the model at every point of every target.")

    @property
    def warnings(self) -> list[str]:
        """What the data do not determine, parameters at a bound, and targets that the model does not describe."""
        return list(self.summary["warnings"])

    @property
    def file(self) -> pathlib.Path:
        """The fitted tire or soil."""
        return self.directory / str(self.summary["result"])
