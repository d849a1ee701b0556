#!/usr/bin/python3
"""Rows of a tire file's `profile` from points of the mid-surface's half meridian, as measured in a drawing.

The input is a CSV file, or - for standard input, with the columns height_m (above the rim radius) and axial_m (from the
mid-plane, either sign), from the bead to the crown, where axial_m is 0. The other half is its mirror image. t is the
length along the points, so that equal steps of t are equal widths of elements."""
import argparse
import csv
import json
import math
import sys


def fail(what):
    sys.exit(f"tire_profile.py: {what}")


def read_points(stream):
    table = csv.DictReader(stream, skipinitialspace=True)
    if not {"height_m", "axial_m"} <= set(table.fieldnames or ()):
        fail(f"the first line is '{','.join(table.fieldnames or ())}', expected height_m,axial_m")
    points = []
    for row in table:
        try:
            point = float(row["height_m"]), abs(float(row["axial_m"]))
        except (TypeError, ValueError):
            fail(f"line {table.line_num}: expected two numbers, m")
        if not (-0.2 < point[0] < 1.0 and point[1] < 1.0):
            fail(f"line {table.line_num}: {point[0]:g}, {point[1]:g} is no place on a tire, expected metres, both "
                 f"below 1")
        if points and point == points[-1]:
            fail(f"line {table.line_num}: the point before once more, expected another one")
        points.append(point)
    if len(points) < 3:
        fail("fewer than three points, expected some from the bead to the crown")
    if points[-1][1] != 0.0:
        fail(f"the last point has axial_m = {points[-1][1]:g}, expected the crown, 0")
    if abs(points[0][0]) > 1e-9:
        fail(f"the first point has height_m = {points[0][0]:g}, expected the bead, 0")
    return points


def profile(points):
    """Rows [t, x, y] from the left bead (y < 0) to the right one."""
    whole = [(x, 0.0 - y) for x, y in points] + [(x, y) for x, y in reversed(points[:-1])]
    length = [0.0]
    for a, b in zip(whole, whole[1:]):
        length.append(length[-1] + math.dist(a, b))
    return [[s / length[-1], x, y] for s, (x, y) in zip(length, whole)], length[-1]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("points", help="CSV file, - for standard input")
    arguments = parser.parse_args()
    if arguments.points == "-":
        points = read_points(sys.stdin)
    else:
        try:
            with open(arguments.points, newline="", encoding="utf-8-sig") as file:
                points = read_points(file)
        except (OSError, UnicodeDecodeError) as error:
            fail(f"{arguments.points} cannot be read: {error}")
    rows, length = profile(points)
    print(f"meridian {1e3 * length:.1f} mm long; t, height and axial place of your points:", file=sys.stderr)
    for t, x, y in rows[:len(points)]:
        print(f"  {t:.4f}  {1e3 * x:7.2f} mm  {1e3 * y:7.2f} mm", file=sys.stderr)
    text = ",\n".join("    " + json.dumps([round(t, 9), round(x, 7), round(y, 7)]) for t, x, y in rows)
    print(f'  "profile": [\n{text}\n  ]')


if __name__ == "__main__":
    main()
