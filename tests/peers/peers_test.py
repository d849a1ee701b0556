#!/usr/bin/python3
"""The engine and LIGGGHTS move the same: falling grains, and a plate of triangles pressed on them; seconds. Exits 77
(skip) where LIGGGHTS is not installed.

With LIGGGHTS's tangential law in the place of the engine's, everything else must agree to round-off: geometry, Hertz
force and damper, contact arms, integration, pair lists, the springs' bookkeeping, periodic sides, cohesion, triangles.
"""
import pathlib
import sys
import tempfile

try:
    import numpy

    from bulk import write_box
    from common import (ALL_SWITCHES, FREE, RADIUS, liggghts, nearest, program, random_spheres, run_furrow,
                        run_liggghts)
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

SIDE, STEP, GRAINS = 12 * RADIUS, 2e-5, 90
KINDS = [FREE] * GRAINS
COMMON = {"length": SIDE, "width": SIDE, "step": STEP, "precision": "double",
          "wall_friction": 0.0, "damper_mass": "full"}
HEIGHT = 3.6 * GRAINS * 4.0 / 3.0 * numpy.pi * RADIUS**3 / SIDE**2
TOP = 1.2 * RADIUS + HEIGHT
# Once grains touch, round-off grows by e every 2 ms or so; with the engine's own law the distance is 1e-6 m by then.
END, MOST = 0.09, 1e-8  # s, m


def falling(folder, x, **more):
    """Whether the greatest distance between the same grains is small at END, with grains in contact."""
    every, steps = 100, round(END / STEP)
    mine, series = run_furrow(folder / "furrow", {"test": "fall", "steps": steps, "every": every, **COMMON}, KINDS, x,
                              switches=ALL_SWITCHES, **more)
    box = {"length": SIDE, "width": SIDE, "height": 2.0 * HEIGHT}
    theirs, _ = run_liggghts(folder / "liggghts", "deck_fall.in", KINDS, x, box, step=STEP, steps=steps, every=every,
                             **{"wall_friction": 0.0, **more})
    d = nearest(mine - theirs, (SIDE, SIDE), (True, True))
    most, contacts = float(numpy.sqrt((d[-1] ** 2).sum(axis=-1)).max()), int(series["contacts"].max())
    print(f"falling, {more}: {most:.2g} m apart after {END} s, {contacts} contacts")
    return most < MOST and contacts > GRAINS // 3


def pressed(folder, x):
    """Whether the force of cohesive grains on a smooth box that comes down on them is the same, step by step."""
    side, height, speed, steps = 5 * RADIUS, 6 * RADIUS, 0.5, 6300
    low = TOP + speed * STEP * 3000
    job = {"test": "plate", "plate_side": side, "plate_height": height, "plate_z": low, "speed": speed, "rest_steps": 0,
           "steps": steps, "every": 1, "cohesion": 80e3, **COMMON}
    _, series = run_furrow(folder / "furrow", job, KINDS, x, switches=ALL_SWITCHES)
    (folder / "liggghts").mkdir(exist_ok=True)
    write_box(folder / "liggghts/plate.stl", 0.5 * SIDE, side, low, height)
    box = {"length": SIDE, "width": SIDE, "height": low + 2 * height}
    _, theirs = run_liggghts(folder / "liggghts", "deck_plate.in", KINDS,
                             x, box, 80e3, step=STEP, speed=speed, rest="", every=1,
                             steps=steps, wall_friction=0.0)
    # The engine evaluates at the start of a step, LIGGGHTS at its end.
    mine = numpy.array([series[f"force_{a}_N"][1:] for a in "xyz"])
    off = numpy.abs(mine - theirs[-steps:-1, 1:4].T).max()
    most = numpy.abs(mine).max()
    print(f"pressed: forces up to {most:.1f} N differ by {off:.2g} N; LIGGGHTS prints six digits")
    return off < 2e-4 and most > 20.0


def main():
    if not liggghts() or not program("peer_grains_switched"):
        print("skipped: needs the program liggghts (Debian: liggghts) and peer_grains_switched")
        return 77
    x = random_spheres(GRAINS, SIDE, SIDE, 1.2 * RADIUS, TOP, 1)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        good = [falling(folder, x, friction=0.0), falling(folder, x)]
        if program("liggghts_with_pull"):
            good += [falling(folder, x, cohesion=80e3), pressed(folder, x)]
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
