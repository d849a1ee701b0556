"""The plots of `furrow report` as functions: each takes what furrow.open returns and gives a matplotlib Figure.

Raises Missing when what a plot shows is not there, Damaged (a ValueError) when a file does not hold what it should.
"""
from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import matplotlib
from matplotlib.figure import Figure

from .opening import Opened

with matplotlib.rc_context():  # the import sets the look of these plots; for those of the user all stays as it is
    from .plot import kinds, style
    from .plot import sweep as sweep
    from .plot.run_data import Missing

__all__ = sorted(kinds.ALL)


@functools.cache
def __getattr__(name: str) -> Callable[[Opened], Figure]:
    if name not in kinds.ALL:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}', expected one of {', '.join(__all__)}")

    def plot(opened: Opened) -> Figure:
        folder: Any = getattr(opened, "_run", None) or kinds.opened(opened.directory)
        plots = kinds.plots_of(folder)
        if name not in plots:
            raise Missing(f"{opened.directory} has no plot '{name}', expected one of {', '.join(plots)}")
        with matplotlib.rc_context(style.LOOK):
            return plots[name](folder)
    plot.__name__, plot.__doc__ = name, kinds.ALL[name].__doc__
    return plot


def __dir__() -> list[str]:
    return list(__all__)
