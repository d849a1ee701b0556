"""Units of columns, which their names end in: `drawbar_pull_N`, `speed_m_per_s`."""
from __future__ import annotations

from typing import Any

from .plot.units import ending_of


def _ending(name: str) -> Any:
    """Of a key such as drawbar_pull_N.mean, that of the last part that has one."""
    return next(filter(None, map(ending_of, reversed(name.split(".")))), None)


def unit(name: str) -> str:
    """The unit of a column or of a key of a summary; "1" for a number without one.

    >>> unit("spindle_torque_Nm"), unit("slip"), unit("drawbar_pull_N.mean")
    ('N m', '1', 'N')
    """
    ending = _ending(name)
    return str(ending[1]) if ending else "1"


def long_name(name: str) -> str:
    """The name in words, without its unit.

    >>> long_name("spindle_force_x_N")
    'spindle force x'
    """
    ending = _ending(name)
    return (name.removesuffix(f"_{ending[0]}") if ending else name).replace("_", " ")
