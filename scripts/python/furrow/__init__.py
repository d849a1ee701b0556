"""Furrow from Python: run scenarios, open results.

    import furrow
    run = furrow.run("drawbar_pull_small", rig__slip=0.5)
    run.summary["drawbar_pull_N"]            # mean, standard error, whether it is steady
    run.series()["drawbar_pull_N"].plot()    # pandas, over time in s
    furrow.plots.pull_slip_sinkage(run)      # the figures of furrow report

Old results are opened by furrow.open(folder). See scripts/python/README.md.
"""
from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from . import plots
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


def __getattr__(name: str) -> Any:
    """Names are loaded when they are first used: `furrow report` needs no pandas, and `furrow.run` no matplotlib."""
    if name not in __all__:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    import_module("._needs", __name__)  # first: it names the packages that are missing
    if name == "plots":
        return import_module(".plots", __name__)
    for home in ("commands", "errors", "opening", "plot.frames", "plot.run_data"):
        if name in vars(module := import_module(f".{home}", __name__)):
            globals()[name] = value = getattr(module, name)
            return value
    raise AssertionError(name)
