#!/usr/bin/python3
"""The engine and LIGGGHTS move the same: falling grains, a quarter of a minute. Exits 77 (skip) where LIGGGHTS is not installed.

With LIGGGHTS's tangential law in the place of the engine's, everything else — geometry, Hertz force and damper, contact arms,
integration, pair lists, the springs' bookkeeping, periodic sides, and the cohesion — must agree to round-off.
"""
import pathlib
import sys
import tempfile

try:
    import numpy

    from common import ALL_SWITCHES, FREE, RADIUS, liggghts, program, random_spheres, run_furrow, run_liggghts
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

SIDE, STEP = 12 * RADIUS, 2e-5
GRAINS, STEPS = 90, 6000
# Once grains touch, round-off grows by e every 2 ms or so.
END, MOST = 0.09, 1e-8  # s, m


def main():
    if not liggghts() or not program("peer_grains_switched"):
        print("skipped: needs the program liggghts (Debian: liggghts) and peer_grains_switched")
        return 77
    height = 3.6 * GRAINS * 4.0 * numpy.pi / 3.0 * RADIUS**3 / SIDE**2
    x = random_spheres(GRAINS, SIDE, SIDE, 1.2 * RADIUS, 1.2 * RADIUS + height, 1)
    kinds = [FREE] * GRAINS
    job = {"test": "fall", "length": SIDE, "width": SIDE, "step": STEP, "steps": STEPS, "every": 100, "precision": "double",
           "wall_friction": 0.0, "damper_mass": "full"}
    box = {"length": SIDE, "width": SIDE, "height": 2.0 * height}
    cases = {"no friction": {"friction": 0.0}, "friction": {}}
    if program("liggghts_with_pull"):
        cases["friction and cohesion"] = {"cohesion": 80e3}
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        for name, more in cases.items():
            mine, series = run_furrow(pathlib.Path(folder) / "furrow", job, kinds, x, switches=ALL_SWITCHES, **more)
            theirs, _ = run_liggghts(pathlib.Path(folder) / "liggghts", "deck_fall.in", kinds, x, box, step=STEP, steps=STEPS, every=100,
                                     **{"wall_friction": 0.0, **more})
            d = mine - theirs
            d[..., :2] -= SIDE * numpy.round(d[..., :2] / SIDE)
            most = numpy.sqrt((d * d).sum(axis=-1)).max(axis=1)
            until = round(END / STEP / 100)
            contacts = int(series["contacts"][:until].max())
            print(f"{name}: {most[until]:.2g} m apart after {END} s with {contacts} contacts, {most[-1]:.2g} m after {STEPS * STEP} s")
            failed |= not most[until] < MOST or contacts < GRAINS // 3
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
