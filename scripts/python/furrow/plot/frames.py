"""What tires and grains looked like at single instants: files of <run>/frames, read when they are asked for."""
from __future__ import annotations

import pathlib
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Generic, TypeVar

import h5py
import numpy as np
from numpy.typing import NDArray

from .run_data import Missing, table


class Frame:
    """One instant of a tire or of the grains. Arrays are read when they are first used."""

    def __init__(self, path: pathlib.Path, index: int) -> None:
        self.path = path
        self.index = index

    @cached_property
    def time(self) -> float:
        """Time, s."""
        with h5py.File(self.path, "r") as file:
            return float(file.attrs["time_s"])

    def dataset(self, name: str, columns: int) -> NDArray[np.generic]:
        """An array of the file; of shape (n,) where `columns` is 0. Raises Damaged (a ValueError)."""
        with h5py.File(self.path, "r") as file:
            return table(file, name, columns)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.index} at {self.time:g} s>"


def _dataset(name, columns, about):
    """An array of a frame, read when it is first used."""
    def read(frame):
        return frame.dataset(name, columns)
    read.__doc__ = about
    return cached_property(read)


class TireFrame(Frame):
    """A tire's surface, world axes: x forward, y left, z up."""

    position = _dataset("position", 3, "Nodes, shape (n, 3), m.")
    velocity = _dataset("velocity", 3, "Of the nodes, shape (n, 3), m/s.")
    force = _dataset("force", 3, "On the nodes by the terrain, shape (n, 3), N.")
    triangle = _dataset("triangle", 3, "Indices of the nodes of each triangle, shape (m, 3).")

    @cached_property
    def strain(self) -> NDArray[np.generic] | None:
        """Largest principal strain of the surface at the nodes, shape (n,); None of other tires than shells."""
        with h5py.File(self.path, "r") as file:
            return table(file, "strain", 0) if "strain" in file else None


class GrainFrame(Frame):
    """All grains of the terrain."""

    position = _dataset("position", 3, "Centres, shape (n, 3), m.")
    speed = _dataset("speed", 0, "Shape (n,), m/s.")
    radius = _dataset("radius", 0, "Shape (n,), m.")


F = TypeVar("F", bound=Frame)


class Frames(Sequence[F], Generic[F]):
    """The frames of one tire or of the grains in order of time: `frames[0]`, `frames[-1]`, `frames.at(0.8)`."""

    def __init__(self, kind: type[F], files: Mapping[int, pathlib.Path]) -> None:
        self._frames = [kind(files[index], index) for index in sorted(files)]

    def __len__(self) -> int:
        return len(self._frames)

    def __getitem__(self, at: int | slice) -> F | list[F]:
        return self._frames[at]

    @property
    def times(self) -> NDArray[np.float64]:
        """Times of all frames, s."""
        return np.array([frame.time for frame in self._frames])

    def at(self, time: float) -> F:
        """The frame nearest to a time in s. Raises Missing if there are none, ValueError for a time without frames:
        farther before the first or after the last than frames are apart."""
        if not self._frames:
            raise Missing("there are no frames: output.frame_interval was 0, or nothing was written yet")
        times = self.times
        apart = float(np.max(np.diff(times))) if len(times) > 1 else np.inf
        if not times[0] - apart <= time <= times[-1] + apart:
            raise ValueError(f"the time is {time:g} s, expected {times[0]:g} to {times[-1]:g} s, "
                             "where there are frames")
        return self._frames[int(np.argmin(np.abs(times - time)))]

    def __repr__(self) -> str:
        return f"<{len(self)} frames>"
