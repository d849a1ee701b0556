"""The frames of a run, packed for the playback: tires as rigid motions with small deviations, the surface of the bed
from all grains, and as many grains as fit. source/unpack.js reads what is written here.

Grains: 16-bit positions in the box of the bed, as differences from frame to frame. A grain that moved less than STILL
of its radius since it was last written has not moved, so that a bed at rest costs next to nothing. A grain that can be
seen in no frame, because others cover it, is left out.
"""
import re

import h5py
import numpy as np

from ..plot.run_data import Damaged, Missing, table

from .blobs import Stream, shuffled

STILL = 0.04  # of a grain's radius
MOST_GRAINS = 40000
MOST_FRAMES = 400
MOST_READ = 40e6  # grains times frames that are read
MOST_SHOWN = 16e6  # grains times frames that a browser keeps
MOST_CELLS = 16000  # of the surface
SAMPLES = 6  # frames that decide which grains are shown
EMPTY = -32768  # height of a cell without grains


class Frames:
    """The frame files of a run by index."""

    def __init__(self, run):
        folder = run.directory / "frames"
        names = {int(match[1]) for path in folder.glob("tire*_*.h5")
                 if (match := re.match(r"tire(\d+)_\d+\.h5$", path.name))}
        self.tires = {k: run.frames(f"tire{k}") for k in sorted(names)}
        self.terrain = run.frames("terrain")
        kinds = [found for found in [*self.tires.values(), self.terrain] if found]
        self.indices = sorted(set.intersection(*map(set, kinds))) if kinds else []
        if not self.indices:
            raise Missing("there are no frames; output.frame_interval asks for them")


def read_grains(path):
    """(position, radius, speed, time)."""
    with h5py.File(path, "r") as file:
        position = table(file, "position", 3).astype(np.float32)
        radius = table(file, "radius", 0).astype(np.float32)
        speed = table(file, "speed", 0).astype(np.float32) if "speed" in file else np.zeros(len(radius), np.float32)
        time = float(np.asarray(file.attrs.get("time_s", np.nan), float).ravel()[0])
    if not len(position) == len(radius) == len(speed) or len(radius) == 0:
        raise Damaged(f"{path.name} holds no grains that could be drawn")
    return np.nan_to_num(position), np.nan_to_num(radius), np.nan_to_num(speed), time


def read_tire(path):
    """(position, triangle, length of force, length of velocity, strain, time); the strain is 0 of tires without it."""
    with h5py.File(path, "r") as file:
        position = np.nan_to_num(table(file, "position", 3).astype(float))
        triangle = table(file, "triangle", 3).astype(int)
        values = [np.linalg.norm(np.nan_to_num(table(file, name, 3).astype(float)), axis=1) if name in file
                  else np.zeros(len(position)) for name in ("force", "velocity")]
        values.append(np.nan_to_num(table(file, "strain", 0).astype(float)) if "strain" in file
                      else np.zeros(len(position)))
        time = float(np.asarray(file.attrs.get("time_s", np.nan), float).ravel()[0])
    if not (0 < len(position) <= 65000 and len(triangle)) or triangle.min() < 0 or triangle.max() >= len(position):
        raise Damaged(f"{path.name} holds no surface that could be drawn")
    if any(len(of) != len(position) for of in values) or np.abs(position).max() > 1e6:
        raise Damaged(f"{path.name} holds a damaged surface")
    return position, triangle, *values, time


def bytes_of(values):
    """(bytes, largest value): each byte is 255 times the root of the share of the largest."""
    largest = float(values.max(initial=0.0))
    if not 0.0 < largest < 1e30:
        return bytes(len(values)), 0.0
    return np.round(255.0 * np.sqrt(np.clip(values / largest, 0.0, 1.0))).astype(np.uint8).tobytes(), largest


def motion(reference, position):
    """(R, t) of the rigid motion from `reference` closest to `position` [Kabsch 1976]."""
    a, b = reference.mean(0), position.mean(0)
    u, _, v = np.linalg.svd((reference - a).T @ (position - b))
    turn = v.T @ np.diag([1.0, 1.0, np.sign(np.linalg.det(v.T @ u.T)) or 1.0]) @ u.T
    return turn, b - turn @ a


class Bed:
    """Which grains are shown, the grid of the surface, and how both become small numbers."""

    def __init__(self, frames, most):
        picked = sorted({frames.indices[k] for k in np.linspace(0, len(frames.indices) - 1, SAMPLES).astype(int)})
        centres = [read_tire(found[i])[0].mean(0)[:2] for found in frames.tires.values() for i in picked]
        position, radius, _, _ = read_grains(frames.terrain[picked[0]])
        self.total, self.largest = len(radius), float(radius.max())
        if not 0.0 < self.largest < 1e3 or np.abs(position).max() > 1e5:
            raise Damaged("the frames hold no grains that could be drawn")
        self.low = position.min(0) - 4.0 * self.largest
        high = position.max(0) + [4.0 * self.largest, 4.0 * self.largest, 40.0 * self.largest]
        self.scale = (high - self.low) / 65000.0
        area = float(np.prod((high - self.low)[:2]))
        self.cell = max(3.0 * self.largest, np.sqrt(area / MOST_CELLS))
        self.nx, self.ny = (int(n) + 1 for n in (high - self.low)[:2] / self.cell)
        seen = np.zeros(self.total, bool)
        for i in picked:
            position = self.checked(read_grains(frames.terrain[i]))[0]
            ix, iy = self.cells(position)
            seen |= position[:, 2] > self.top(position, ix, iy)[ix, iy] - 4.5 * self.largest
        edge = 2.5 * self.largest
        sides = (np.minimum(position[:, 0] - position[:, 0].min(), position[:, 0].max() - position[:, 0]) < edge) | \
                (np.minimum(position[:, 1] - position[:, 1].min(), position[:, 1].max() - position[:, 1]) < edge)
        far = np.full(self.total, np.inf)
        for centre in np.array(centres) if centres else position[:, :2].mean(0)[None]:
            far = np.minimum(far, ((position[:, :2] - centre) ** 2).sum(1))
        self.visible = int((seen | sides).sum())
        order = np.lexsort((far, np.where(seen, 0, np.where(sides, 1, 2))))[:min(most, self.visible)]
        self.shown = np.sort(order)
        self.radius = radius[self.shown]

    def checked(self, grains):
        if len(grains[1]) != self.total:
            raise Damaged("the frames differ in the number of their grains")
        return grains

    def cells(self, position):
        at = ((position[:, :2] - self.low[:2]) / self.cell).astype(int)
        return np.clip(at[:, 0], 0, self.nx - 1), np.clip(at[:, 1], 0, self.ny - 1)

    def top(self, position, ix, iy):
        top = np.full(self.nx * self.ny, -np.inf, np.float32)
        np.maximum.at(top, ix * self.ny + iy, position[:, 2])
        return top.reshape(self.nx, self.ny)

    def numbers(self, position):
        return np.clip(np.round((position - self.low) / self.scale), 0, 65535).astype(np.int32)


class Packing:
    """Streams of the frames `indices`, and what the page must know of them."""

    def __init__(self, frames, bed, indices):
        self.frames, self.bed, self.indices = frames, bed, indices
        self.stream = {name: Stream() for name in ("tires", "grains", "surface")}
        self.times, self.poses, self.speeds = [], [], []
        self.mesh = {}  # of each tire: reference and triangles
        self._last = self._last_surface = None
        first = {k: read_tire(found[indices[0]]) for k, found in frames.tires.items()}
        points = sum(len(tire[0]) for tire in first.values()) * len(indices)
        for k, (position, triangle, *_unused) in first.items():
            height = float(np.ptp(position[:, 2])) or 1.0
            self.mesh[k] = position, triangle, height / (8000.0 if points < 1e6 else 2000.0)

    def add(self, index):
        times = [self._tire(k, index) for k in self.mesh]
        if self.bed:
            times.append(self._grains(index))
        self.times.append(times[0])
        for stream in self.stream.values():
            stream.mark()

    @property
    def size(self):
        return sum(stream.size for stream in self.stream.values())

    def _tire(self, k, index):
        reference, triangle, quantum = self.mesh[k]
        position, other, *fields, time = read_tire(self.frames.tires[k][index])
        if position.shape != reference.shape or other.shape != triangle.shape:
            raise Damaged(f"the frames of tire {k} differ in the size of its surface")
        turn, shift = motion(reference, position)
        deviation = np.clip(np.round((position - reference @ turn.T - shift) / quantum), -32767, 32767).astype("<i2")
        stream = self.stream["tires"]
        for axis in range(3):
            stream.add(shuffled(deviation[:, axis]))
        largest = []
        for values in fields:
            data, most = bytes_of(values)
            stream.add(data)
            largest.append(most)
        self.poses.append([*turn.ravel(), *shift, *largest])
        return time

    def _grains(self, index):
        bed = self.bed
        position, _, speed, time = bed.checked(read_grains(self.frames.terrain[index]))
        heights = bed.top(position, *bed.cells(position)) + bed.largest
        now = np.where(np.isfinite(heights),
                       np.clip(np.round((heights - bed.low[2]) / bed.scale[2]) - 32767, -32767, 32767), EMPTY)
        now = now.astype(np.int32).ravel()
        if self._last_surface is not None:
            still = np.abs(now - self._last_surface) < 0.15 * bed.largest / bed.scale[2]
            now[still] = self._last_surface[still]
        self._difference("surface", now, self._last_surface)
        self._last_surface = now
        numbers = bed.numbers(position[bed.shown])
        if self._last is not None:
            moved = np.linalg.norm((numbers - self._last) * bed.scale, axis=1) > STILL * bed.radius
            numbers = np.where(moved[:, None], numbers, self._last)
        for axis in range(3):
            self._difference("grains", numbers[:, axis], None if self._last is None else self._last[:, axis])
        self._last = numbers
        shown = speed[bed.shown]
        data, largest = bytes_of(np.where(shown > 0.02 * shown.max(initial=0.0), shown, 0.0))
        self.stream["grains"].add(data)
        self.speeds.append(largest)
        return time

    def _difference(self, name, now, before):
        """Modulo 2¹⁶."""
        step = now if before is None else now - before
        self.stream[name].add(shuffled((step & 0xFFFF).astype("<u2")))


def strided(indices, stride):
    """Every `stride`-th index from the last one backwards, so that the last frame is shown."""
    return indices[::-1][::stride][::-1]


def pack(run, budget):
    """The Packing that fits into `budget` bytes. First every frame with MOST_GRAINS is tried; while that is too much,
    frames are left out down to sixty, then grains down to 8,000, then frames again."""
    frames = Frames(run)
    bed = Bed(frames, MOST_GRAINS) if frames.terrain else None
    stride = -(-len(frames.indices) // MOST_FRAMES)
    if bed:
        stride = max(stride, int(np.ceil(len(frames.indices) * bed.total / MOST_READ)),
                     int(np.ceil(len(frames.indices) * len(bed.shown) / MOST_SHOWN)))
    while True:
        indices = strided(frames.indices, stride)
        packing = Packing(frames, bed, indices)
        room = budget - 20 * sum(len(reference) for reference, *_ in packing.mesh.values())  # what the meshes take
        for index in indices:
            packing.add(index)
            if packing.size > room:
                break
        if packing.size <= room or len(indices) == 1:
            return packing
        if bed and len(indices) <= 60 and len(bed.shown) > 8000:
            bed = Bed(frames, int(0.6 * len(bed.shown)))
        else:
            stride *= 2
