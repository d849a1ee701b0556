"""Tables as pandas and xarray know them, with units."""
from __future__ import annotations

import pathlib
from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from .units import long_name, unit


def frame_of(columns: Mapping[str, Any], index: str | None = None) -> pd.DataFrame:
    """A DataFrame whose `attrs["units"]` is {column: unit}, the index included."""
    table = pd.DataFrame(dict(columns))
    units = {str(name): unit(str(name)) for name in table.columns}
    if index is not None:
        table = table.set_index(index)
    table.attrs["units"] = units
    return table


def dataset_of(table: pd.DataFrame, **attributes: Any) -> xr.Dataset:
    """A Dataset along the table's index; every variable has `units` and `long_name`, as in results.h5."""
    index = str(table.index.name)
    values = {str(name): (index, table[name].to_numpy()) for name in table.columns}
    dataset = xr.Dataset(values, coords={index: table.index.to_numpy()}, attrs=attributes)
    for name, variable in dataset.variables.items():
        variable.attrs.update(units=unit(str(name)), long_name=long_name(str(name)))
    return dataset


def read_csv(path: pathlib.Path, names: Mapping[str, Any] | None = None) -> pd.DataFrame:
    """A CSV file with texts in some columns; lines that begin with # are comments."""
    table = pd.read_csv(path, comment="#", dtype=dict(names or {}))
    table.attrs["units"] = {str(name): unit(str(name)) for name in table.columns
                            if np.issubdtype(table[name].dtype, np.number)}
    return table
