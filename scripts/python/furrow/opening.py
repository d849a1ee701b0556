"""Opens folders of results by what they hold."""
from __future__ import annotations

import os
import pathlib

from .runs import Run
from .studies import Study
from .virtual_tests import Calibration, Kinematics, Modes, Press, Soil

Opened = Run | Study | Soil | Press | Modes | Kinematics | Calibration


def open(directory: str | os.PathLike[str]) -> Opened:
    """Opens what any command of furrow left: a Run, Study, Soil, Press, Modes, Kinematics or Calibration.

    Runs may have failed or not have ended.

    Raises FileNotFoundError when there is no such folder, Damaged (a ValueError) for a file that does not hold what it
    should, ValueError for a folder without results.
    """
    folder = pathlib.Path(directory)
    if not folder.is_dir():
        raise FileNotFoundError(f"{folder}: is not a folder")
    kinds: tuple[tuple[str, type[Opened]], ...] = (
        ("soil.json", Soil), ("sweep.json", Study), ("press.csv", Press), ("modes.csv", Modes),
        ("kinematics.csv", Kinematics), ("calibration.json", Calibration))
    for name, kind in kinds:
        if (folder / name).is_file():
            return kind(folder)
    if not any((folder / name).exists() for name in ("scenario.json", "summary.json", "summary_failed.json")):
        raise ValueError(f"{folder}: holds no results of furrow")
    return Run(folder)
