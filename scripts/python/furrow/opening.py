"""Opens folders of results by what they hold."""
from __future__ import annotations

import os
import pathlib
from typing import TypeAlias

from .plot.run_data import kind_of
from .runs import Run
from .studies import Study
from .virtual_tests import Calibration, Kinematics, Modes, Press, Soil

Opened: TypeAlias = Run | Study | Soil | Press | Modes | Kinematics | Calibration
KINDS: dict[str, type[Opened]] = {"soil": Soil, "sweep": Study, "press": Press, "modes": Modes,
                                  "kinematics": Kinematics, "calibration": Calibration}


def open(directory: str | os.PathLike[str]) -> Opened:
    """Opens what any command of furrow left: a Run, Study, Soil, Press, Modes, Kinematics or Calibration.

    Runs may have failed or not have ended.

    Raises FileNotFoundError when there is no such folder, Damaged (a ValueError) for a file that does not hold what it
    should, ValueError for a folder without results.
    """
    folder = pathlib.Path(directory)
    if not folder.is_dir():
        raise FileNotFoundError(f"{folder}: is not a folder")
    if kind := KINDS.get(kind_of(folder)):
        return kind(folder)
    if not any((folder / name).exists() for name in ("scenario.json", "summary.json", "summary_failed.json")):
        raise ValueError(f"{folder}: holds no results of furrow")
    return Run(folder)
