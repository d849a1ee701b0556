"""Units of columns, which their names end in: `drawbar_pull_N`, `speed_m_per_s`."""
from __future__ import annotations

# As results.h5 has them, longest first.
ENDINGS = {"kg_m_per_s": "kg m/s", "rad_per_s": "rad/s", "m_per_s2": "m/s2", "m_per_s": "m/s", "m_s": "m/s",
           "rpm": "1/min", "N_per_m": "N/m", "rad": "rad", "Nm": "N m", "Ns": "N s", "Pa": "Pa", "kg": "kg", "s": "s",
           "m": "m", "N": "N", "J": "J", "W": "W"}


def _ending(name: str) -> str | None:
    """Of a key such as drawbar_pull_N.mean, that of the last part that has one."""
    for part in reversed(name.split(".")):
        for ending in ENDINGS:
            if part.endswith(f"_{ending}"):
                return ending
    return None


def unit(name: str) -> str:
    """The unit of a column or of a key of a summary; "1" for a number without one.

    >>> unit("spindle_torque_Nm"), unit("slip"), unit("drawbar_pull_N.mean")
    ('N m', '1', 'N')
    """
    ending = _ending(name)
    return ENDINGS[ending] if ending else "1"


def long_name(name: str) -> str:
    """The name in words, without its unit.

    >>> long_name("spindle_force_x_N")
    'spindle force x'
    """
    ending = _ending(name)
    return (name.removesuffix(f"_{ending}") if ending else name).replace("_", " ")
