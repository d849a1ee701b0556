"""The plots of `furrow report` as functions: each takes what furrow.open returns and gives a matplotlib Figure.

Raises Missing when what a plot shows is not there, Damaged (a ValueError) when a file does not hold what it should.
"""
from __future__ import annotations

from typing import Any

import matplotlib
from matplotlib.figure import Figure

from ._scripts import drawing, style
from .runs import Run
from .studies import Study
from .virtual_tests import Kinematics, Modes, Press, Soil


def _draw(where: str, name: str, shown: Any) -> Figure:
    with matplotlib.rc_context(style()):
        figure = getattr(drawing(where), name)(shown)
    assert isinstance(figure, Figure)
    return figure


def _of(where: str, kind: str, opened: Study | Soil | Press | Modes | Kinematics) -> Any:
    return getattr(drawing(where), kind)(opened.directory)


def pull_slip_sinkage(run: Run) -> Figure:
    """Drawbar pull with its mean, slip and sinkage over time."""
    return _draw("charts", "pull_slip_sinkage", run._run)


def forces(run: Run) -> Figure:
    """Vertical force, forces along the travel and spindle torque over time."""
    return _draw("charts", "forces", run._run)


def ranks(run: Run) -> Figure:
    """How long each rank computed, communicated and waited."""
    return _draw("charts", "ranks", run._run)


def rut(run: Run) -> Figure:
    """The surface from above, across and along the path."""
    return _draw("ground", "rut", run._run)


def energy(run: Run) -> Figure:
    """The account of energy, over time and by mechanism."""
    return _draw("accounts", "energy", run._run)


def momentum(run: Run) -> Figure:
    """The account of momentum."""
    return _draw("accounts", "momentum", run._run)


def scene(run: Run) -> Figure:
    """The tire on the bed in the last frame."""
    return _draw("scene", "scene", run._run)


def curve(study: Study) -> Figure:
    """The curve that the study asks for, with intervals."""
    return _draw("sweep", "curve", _of("sweep", "Sweep", study))


def passes(study: Study) -> Figure:
    """Results pass by pass of several passes in one rut."""
    return _draw("sweep", "passes", _of("sweep", "Sweep", study))


def rut_along(study: Study) -> Figure:
    """The rut along the track, pass by pass."""
    return _draw("sweep", "rut_along", _of("sweep", "Sweep", study))


def beds(study: Study) -> Figure:
    """The results of each bed and their mean with its interval."""
    return _draw("sweep", "beds", _of("sweep", "Sweep", study))


def plate(soil: Soil) -> Figure:
    """Pressure against sinkage."""
    return _draw("soil", "plate", _of("soil", "Soil", soil))


def shear(soil: Soil) -> Figure:
    """Shear stress against displacement, and the strength."""
    return _draw("soil", "shear", _of("soil", "Soil", soil))


def cone(soil: Soil) -> Figure:
    """Cone resistance against depth."""
    return _draw("soil", "cone", _of("soil", "Soil", soil))


def repose(soil: Soil) -> Figure:
    """The slope that is left when a wall is taken away."""
    return _draw("soil", "repose", _of("soil", "Soil", soil))


def load_deflection(press: Press) -> Figure:
    """Force against deflection of a pressed tire."""
    return _draw("press", "load_deflection", _of("press", "Press", press))


def footprint(press: Press) -> Figure:
    """Contact pressure of a pressed tire."""
    return _draw("press", "footprint", _of("press", "Press", press))


def frequencies(modes: Modes) -> Figure:
    """Natural frequencies against the circumferential order."""
    return _draw("modes", "frequencies", _of("modes", "Modes", modes))


def mode_shapes(modes: Modes) -> Figure:
    """The first modes seen from the side."""
    return _draw("modes", "mode_shapes", _of("modes", "Modes", modes))


def mode_sections(modes: Modes) -> Figure:
    """Sections of the tire in the first modes."""
    return _draw("modes", "mode_sections", _of("modes", "Modes", modes))


def parallel(kinematics: Kinematics) -> Figure:
    """Suspensions against travel of both wheels of an axle."""
    return _draw("kinematics", "parallel", _of("kinematics", "Kinematics", kinematics))


def opposite(kinematics: Kinematics) -> Figure:
    """Suspensions against opposite travel of the wheels of an axle."""
    return _draw("kinematics", "opposite", _of("kinematics", "Kinematics", kinematics))


def steering(kinematics: Kinematics) -> Figure:
    """Suspensions against steering."""
    return _draw("kinematics", "steering", _of("kinematics", "Kinematics", kinematics))
