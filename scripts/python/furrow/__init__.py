"""Furrow from Python: run scenarios, open results.

    import furrow
    run = furrow.run("drawbar_pull_small", rig__slip=0.5)
    run.summary["drawbar_pull_N"]            # mean, standard error, whether it is steady
    run.series()["drawbar_pull_N"].plot()    # pandas, over time in s
    furrow.plots.pull_slip_sinkage(run)      # the figures of furrow report

Old results are opened by furrow.open(folder). See scripts/python/README.md.
"""
from __future__ import annotations

import pathlib
from types import ModuleType

from . import _needs  # noqa: F401  first: it names the packages that are missing

# The folder scripts/: furrow.plot is scripts/plot, whose readers and plots `furrow report` uses as well.
__path__.append(str(pathlib.Path(__file__).resolve().parents[2]))

from .commands import calibrate, kc, modes, press, resume, run, soil, sweep
from .errors import (BadInput, FurrowError, InputOutputError, LimitReached, PhysicsFailed, ProgramFault, RankLost,
                     Stopped)
from .opening import Opened, open
from .plot.frames import Frame, Frames, GrainFrame, TireFrame
from .plot.run_data import Damaged, Missing
from .runs import Run
from .studies import Study
from .virtual_tests import Calibration, Kinematics, Modes, Press, Soil

__all__ = ["BadInput", "Calibration", "Damaged", "Frame", "Frames", "FurrowError", "GrainFrame", "InputOutputError",
           "Kinematics", "LimitReached", "Missing", "Modes", "Opened", "PhysicsFailed", "Press", "ProgramFault",
           "RankLost", "Run", "Soil", "Stopped", "Study", "TireFrame", "calibrate", "kc", "modes", "open", "plots",
           "press", "resume", "run", "soil", "sweep"]

Missing.__module__ = Damaged.__module__ = __name__  # where a user finds them


def __getattr__(name: str) -> ModuleType:
    """furrow.plots, which needs matplotlib, is loaded when it is first used."""
    if name == "plots":
        import importlib
        return importlib.import_module(f"{__name__}.plots")
    raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
