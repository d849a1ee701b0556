"""The plots of `furrow report` as functions: each takes what furrow.open returns and gives a matplotlib Figure.

Raises Missing when what a plot shows is not there, Damaged (a ValueError) when a file does not hold what it should.
"""
from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import matplotlib
from matplotlib.figure import Figure

from . import virtual_tests as tests
from .runs import Run
from .studies import Study

with matplotlib.rc_context():  # the import sets the look of these plots; for those of the user all stays as it is
    from .plot import accounts, charts, ground, kinematics, modes, press, soil, style
    from .plot import scene as scenes
    from .plot import sweep as sweep

Opened = TypeVar("Opened")


def _plot(draw: Callable[[Any], Figure], read: Callable[[Opened], Any], about: str) -> Callable[[Opened], Figure]:
    """A function of this package that draws what `read` makes of the opened folder."""
    def plot(opened: Opened) -> Figure:
        with matplotlib.rc_context(style.LOOK):
            return draw(read(opened))
    plot.__name__, plot.__doc__ = draw.__name__, about
    return plot


def _run(opened: Run) -> Any:
    return opened._run


def _study(opened: Study) -> Any:
    return sweep.Sweep(opened.directory)


def _soil(opened: tests.Soil) -> Any:
    return soil.Soil(opened.directory)


def _press(opened: tests.Press) -> Any:
    return press.Press(opened.directory)


def _modes(opened: tests.Modes) -> Any:
    return modes.Modes(opened.directory)


def _kinematics(opened: tests.Kinematics) -> Any:
    return kinematics.Kinematics(opened.directory)


pull_slip_sinkage = _plot(charts.pull_slip_sinkage, _run, "Drawbar pull with its mean, slip and sinkage over time.")
forces = _plot(charts.forces, _run, "Vertical force, forces along the travel and spindle torque over time.")
ranks = _plot(charts.ranks, _run, "How long each rank computed, communicated and waited.")
rut = _plot(ground.rut, _run, "The surface from above, across and along the path.")
energy = _plot(accounts.energy, _run, "The account of energy, over time and by mechanism.")
momentum = _plot(accounts.momentum, _run, "The account of momentum.")
scene = _plot(scenes.scene, _run, "The tire on the bed in the last frame.")
curve = _plot(sweep.curve, _study, "The curve that the study asks for, with intervals.")
passes = _plot(sweep.passes, _study, "Results pass by pass of several passes in one rut.")
rut_along = _plot(sweep.rut_along, _study, "The rut along the track, pass by pass.")
beds = _plot(sweep.beds, _study, "The results of each bed and their mean with its interval.")
plate = _plot(soil.plate, _soil, "Pressure against sinkage.")
shear = _plot(soil.shear, _soil, "Shear stress against displacement, and the strength.")
cone = _plot(soil.cone, _soil, "Cone resistance against depth.")
repose = _plot(soil.repose, _soil, "The slope that is left when a wall is taken away.")
load_deflection = _plot(press.load_deflection, _press, "Force against deflection of a pressed tire.")
footprint = _plot(press.footprint, _press, "Contact pressure of a pressed tire.")
frequencies = _plot(modes.frequencies, _modes, "Natural frequencies against the circumferential order.")
mode_shapes = _plot(modes.mode_shapes, _modes, "The first modes seen from the side.")
mode_sections = _plot(modes.mode_sections, _modes, "Sections of the tire in the first modes.")
parallel = _plot(kinematics.parallel, _kinematics, "Suspensions against travel of both wheels of an axle.")
opposite = _plot(kinematics.opposite, _kinematics, "Suspensions against opposite travel of the wheels of an axle.")
steering = _plot(kinematics.steering, _kinematics, "Suspensions against steering.")
