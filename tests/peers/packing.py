"""What a packing of equal spheres is like, from positions alone: the same measure for every program."""
import math

import numpy

from common import E_STAR, GRAVITY, MASS, RADIUS, nearest


def pairs(x, length, width, periodic=(True, True), reach=2.0 * RADIUS):
    """Index pairs of spheres nearer than `reach`, and their distance vectors (nearest image)."""
    index = numpy.argwhere(numpy.triu(numpy.ones((len(x), len(x)), bool), 1))
    d = nearest(x[index[:, 0]] - x[index[:, 1]], (length, width), periodic)
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
