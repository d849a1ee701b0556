"""What a packing of equal spheres is like, from positions alone: the same measure for every program."""
import math

import numpy

from common import E_STAR, MASS, GRAVITY, RADIUS


def pairs(x, length, width, periodic=(True, True), reach=2.0 * RADIUS):
    """Index pairs of spheres nearer than `reach`, and their distance vectors (nearest image)."""
    size = numpy.array([length, width, x[:, 2].max() + 4.0 * RADIUS])
    cells = numpy.maximum(1, (size / reach).astype(int))
    low = numpy.array([0.0, -0.5 * width, -2.0 * RADIUS])
    at = ((x - low) / size * cells).astype(int)
    for a in range(3):
        at[:, a] = at[:, a] % cells[a] if a < 2 and periodic[a] else numpy.clip(at[:, a], 0, cells[a] - 1)
    grid = {}
    for g, c in enumerate(map(tuple, at)):
        grid.setdefault(c, []).append(g)
    found = []
    for c, mine in grid.items():
        for shift in numpy.ndindex(3, 3, 3):
            other = tuple((c[a] + shift[a] - 1) % cells[a] if a < 2 and periodic[a]
                          else c[a] + shift[a] - 1 for a in range(3))
            found += [(i, j) for i in mine for j in grid.get(other, ()) if i < j]
    if not found:
        return numpy.empty((0, 2), int), numpy.empty((0, 3))
    index = numpy.array(sorted(set(found)))
    d = x[index[:, 0]] - x[index[:, 1]]
    for a, side in ((0, length), (1, width)):
        if periodic[a]:
            d[:, a] -= side * numpy.round(d[:, a] / side)
    near = (d * d).sum(axis=1) < reach * reach
    return index[near], d[near]


def surface_height(x, length, width):
    """Mean over cells 2r wide of the highest sphere top, m."""
    nx, ny = int(length / (2 * RADIUS)), int(width / (2 * RADIUS))
    top = numpy.zeros((nx, ny))
    cx = numpy.clip((x[:, 0] / length * nx).astype(int), 0, nx - 1)
    cy = numpy.clip(((x[:, 1] / width + 0.5) * ny).astype(int), 0, ny - 1)
    numpy.maximum.at(top, (cx, cy), x[:, 2] + RADIUS)
    return float(top.mean())


def volume_between(z, low, high):
    """Of spheres with centres z, between two heights, m³."""
    a, b = numpy.clip((low - z) / RADIUS, -1, 1), numpy.clip((high - z) / RADIUS, -1, 1)
    return math.pi * RADIUS**3 * float(((b - b**3 / 3) - (a - a**3 / 3)).sum())


def measure(x, length, width, periodic):
    index, d = pairs(x, length, width, periodic)
    distance = numpy.sqrt((d * d).sum(axis=1))
    height = surface_height(x, length, width)
    low, high = 0.25 * height, 0.75 * height
    middle = 0.5 * (x[index[:, 0], 2] + x[index[:, 1], 2])
    overlap = 2.0 * RADIUS - distance
    lens = 2.0 / 3.0 * math.pi * (0.5 * overlap) ** 2 * (3.0 * RADIUS - 0.5 * overlap)  # two caps of height δ/2
    inside = (middle > low) & (middle < high)
    solid = (volume_between(x[:, 2], low, high) - lens[inside].sum()) / (length * width * (high - low))
    bulk = (x[:, 2] > low) & (x[:, 2] < high)
    touches = numpy.bincount(index.ravel(), minlength=len(x))
    wall = 4.0 / 3.0 * E_STAR * math.sqrt(RADIUS)

    def push(gap):
        """Σ of Hertz forces on a wall at these distances from the centres, N."""
        return float((wall * numpy.clip(RADIUS - gap, 0.0, None) ** 1.5).sum())

    weight = len(x) * MASS * GRAVITY
    out = {"height_m": height, "solid_fraction": float(solid), "coordination": float(touches[bulk].mean()),
           "mean_overlap_m": float(overlap.mean()), "floor_pressure_Pa": push(x[:, 2]) / (length * width),
           "floor_share_of_weight": push(x[:, 2]) / weight}
    if not periodic[1]:
        sides = push(x[:, 1] + 0.5 * width) + push(0.5 * width - x[:, 1])
        out["side_pressure_Pa"] = sides / (2.0 * length * height)
    return out
