#!/usr/bin/python3
"""Time that a run takes to write frames and checkpoints, beside what is told.

usage: writing_time.py [PROGRAM] [--wheels N]... [--rounds N]

Runs 600 steps of N rigid wheels in rows of four (default: 1, 16, 64), without frames and checkpoints, with 60 frames,
and with 60 checkpoints. Prints lines of CSV. Needs a machine that has nothing else to do.
"""
import pathlib
import tempfile

from start_of_ranks import STEP, driver, run, scenario

STEPS, EVERY = 600, 10


def times(program, wheels, what, out):
    """(wall time of the steps in s, what `furrow validate` tells of writing in s)"""
    made = scenario(wheels, STEPS,
                    output={"series_interval": 1e-3, "frame_interval": EVERY * STEP if what == "frames" else 0},
                    checkpoint={"interval": EVERY * STEP if what == "checkpoints" else 0, "wall_interval": 0,
                                "at_end": False})
    summary, _, told = run(program, made, out / f"{what}-{wheels}")
    return summary["wall_s"], told["writing_s"]


def main():
    parser = driver.options(__doc__, rounds={"type": int, "default": 2}, wheels={"type": int, "action": "append"})
    parser.add_argument("program", nargs="?", default=driver.ROOT / "build" / "furrow")
    arguments = parser.parse_args()
    print("ranks,written,count,wall_s,without_s,told_s")
    for wheels in arguments.wheels or [1, 16, 64]:
        for _ in range(arguments.rounds):
            with tempfile.TemporaryDirectory(prefix="writing-time-") as folder:
                found = {what: times(arguments.program, wheels, what, pathlib.Path(folder))
                         for what in ("none", "frames", "checkpoints")}
            for what in ("frames", "checkpoints"):
                number, (wall, told) = STEPS // EVERY + (what == "frames"), found[what]
                print(f"{wheels + 2},{what},{number},{wall:.3g},{found['none'][0]:.3g},{told:.3g}", flush=True)


if __name__ == "__main__":
    main()
