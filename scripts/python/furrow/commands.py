"""The program's commands as functions: each runs the program to its end and opens what it left."""
from __future__ import annotations

import os
import pathlib
from collections.abc import Mapping
from typing import Any, TypeVar

from ._home import home
from ._program import Content, File, as_file, call, named_file
from ._settings import arguments
from .opening import open
from .runs import Run
from .studies import Study
from .virtual_tests import Calibration, Kinematics, Modes, Press, Soil


Kind = TypeVar("Kind", Run, Study, Press, Modes, Kinematics, Calibration)


def _options(out: File | None, overwrite: bool = False, plots: bool = True, **given: Any) -> list[str]:
    """Options of a command; those that are None are left out."""
    values = {"out": out and os.fspath(out), **given}
    return [f"--{name}={value}" for name, value in values.items() if value is not None] + (
        ["--overwrite"] if overwrite else []) + ([] if plots else ["--no-plots"])


def _call(kind: type[Kind], command: str, file: File, options: list[str], progress: bool) -> Kind:
    """Runs the command and opens the folder that it prints."""
    printed, _ = call([command, *options, "--", os.fspath(file)], progress)
    opened = open(printed.splitlines()[-1])
    assert isinstance(opened, kind)
    return opened


def run(scenario: File | Content, *, out: File | None = None, overwrite: bool = False, seeds: int | None = None,
        jobs: int | None = None, plots: bool = False, progress: bool = True,
        settings: Mapping[str, Any] | None = None, **keys: Any) -> Run | Study:
    """Runs a scenario and opens it: a Run, or with `seeds` a Study of as many beds.

    scenario   a file, the name of a shipped one ("drawbar_pull_small"), or the scenario itself as a dict
    keys       keys of the scenario: rig__slip=0.5 stands for --set rig.slip=0.5; `settings` takes {"rig.slip": 0.5}
    out        new folder for the results (default: results/<scenario>-NNN here); `overwrite` replaces those of an
    earlier run
    jobs       with `seeds`: beds at once
    plots      whether to make the plots of `furrow report` as files
    progress   whether to show on stderr what the program says

    Raises a FurrowError with the program's message and exit code: BadInput, PhysicsFailed, …; its `directory` can be
    opened. An interrupt stops the run with a checkpoint.
    """
    options = _options(out, overwrite, plots, seeds=seeds, jobs=jobs) + arguments(settings, keys)
    with as_file(scenario, "scenario") as path:
        if seeds is not None:
            return _call(Study, "run", path, options, progress)
        return _call(Run, "run", path, options, progress)


def resume(directory: File, *, plots: bool = False, progress: bool = True, settings: Mapping[str, Any] | None = None,
           **keys: Any) -> Run:
    """Continues a run from its last checkpoint and opens it. run__end=… moves its end. Raises FurrowError."""
    return _call(Run, "resume", directory, _options(None, plots=plots) + arguments(settings, keys), progress)


def _study(content: Content) -> Content:
    """A study whose scenario is found from any folder."""
    named = content.get("scenario")
    if not isinstance(named, str):
        return content
    path = named_file(named)
    shipped = home() / "rigs" / path
    return {**content, "scenario": str(path.absolute() if path.exists() or not shipped.exists() else shipped)}


def sweep(study: File | Content, *, out: File | None = None, jobs: int = 1, progress: bool = True) -> Study:
    """Runs a study and opens it. The same call continues one that was interrupted, and adds runs to one that grew.

    study   a file, the name of a shipped one ("study_slip"), or the study itself as a dict:
            {"scenario": "first_look", "grid": {"rig.slip": [0.1, 0.3]}}; its results are in results/study unless `out`
            says
    jobs    runs at once

    Raises a FurrowError if a run of it failed; the folder of the error can be opened.
    """
    with as_file(_study(study) if isinstance(study, Mapping) else study, "study") as path:
        if path.parent == pathlib.Path(".") and not path.exists() and (home() / "rigs" / path).exists():
            path = home() / "rigs" / path
        return _call(Study, "sweep", path, _options(out, jobs=jobs), progress)


def calibrate(study: File, *, out: File | None = None, overwrite: bool = False,
              plots: bool = False, progress: bool = True) -> Calibration:
    """Fits a model to data and opens the result. The same call continues a calibration that was interrupted.

    study   a file, or the name of a shipped one ("calibrate_ring"); its results are in results/study unless `out` says
    """
    return _call(Calibration, "calibrate", named_file(study), _options(out, overwrite, plots), progress)


def press(scenario: File | Content, *, out: File | None = None, overwrite: bool = False, on: str | None = None,
          deflection: float | None = None, load: float | None = None, points: int | None = None,
          camber: float | None = None,
          progress: bool = True, settings: Mapping[str, Any] | None = None, **keys: Any) -> Press:
    """Presses the tire of a scenario on a plate, a cleat or a profile, statically, and opens what was measured.

    on           "plate", "cleat" or "profile"; where this and the others are not given, the section `press` of the
    scenario counts
    deflection   the largest one, m; `points` of the curve
    load         of the footprint, N
    camber       of the wheel, rad; shells only
    """
    options = _options(out, overwrite, on=on, deflection=deflection, load=load, points=points, camber=camber)
    with as_file(scenario, "scenario") as path:
        return _call(Press, "press", path, options + arguments(settings, keys), progress)


def modes(tire: File, *, out: File | None = None, overwrite: bool = False, orders: int | None = None,
          count: int | None = None, pressure: float | None = None, plots: bool = False, progress: bool = True) -> Modes:
    """Computes the natural frequencies of a tire on a rim at rest and opens them.

    tire       a tire file, as given or one that comes with the program
    orders     highest circumferential order; `count` frequencies of each
    pressure   of inflation, Pa; None: the file's
    """
    options = _options(out, overwrite, plots, orders=orders, count=count, pressure=pressure)
    return _call(Modes, "modes", tire, options, progress)


def kc(vehicle: File, *, out: File | None = None, overwrite: bool = False, travel: float | None = None,
       points: int | None = None, plots: bool = False, progress: bool = True) -> Kinematics:
    """Moves the suspensions of a vehicle and opens what was tabulated.

    vehicle   a vehicle file, as given or one that comes with the program
    travel    of the wheels up and down, m; `points` of each motion
    """
    return _call(Kinematics, "kc", vehicle, _options(out, overwrite, plots, travel=travel, points=points), progress)


def soil(scenario: File | Content, *, out: File | None = None, overwrite: bool = False, quick: bool = False,
         seeds: int | None = None, only: str | None = None, progress: bool = True,
         settings: Mapping[str, Any] | None = None, **keys: Any) -> Soil:
    """Runs virtual soil tests on the grains of a scenario and opens what was measured.

    quick   small boxes and one seed: an impression within seconds, not a result to quote
    seeds   beds per test
    only    this test only: "plate", "shear", "cone" or "repose"
    """
    options = _options(out, overwrite, seeds=seeds, only=only) + (["--quick"] if quick else [])
    with as_file(scenario, "scenario") as path:
        _, folder = call(["soil", *options, *arguments(settings, keys), "--", os.fspath(path)], progress)
    assert folder
    return Soil(folder)
