#!/usr/bin/python3
"""Time that a run takes to write frames and checkpoints, beside what is told.

usage: writing_time.py [PROGRAM] [--wheels N]... [--rounds N]

Runs 600 steps of N rigid wheels in rows of four (default: 1, 16, 64), without frames and checkpoints, with 60 frames,
and with 60 checkpoints. Prints lines of CSV. Needs a machine that has nothing else to do.
"""
import argparse
import json
import os
import pathlib
import subprocess
import tempfile

import start_of_ranks

STEPS, EVERY = 600, 10
ROOT = pathlib.Path(__file__).resolve().parents[2]


def scenario(wheels, frames, checkpoints):
    step = start_of_ranks.STEP
    return {**start_of_ranks.scenario(wheels),
            "run": {"step": step, "end": step * STEPS, "average_from": 0.5 * step * STEPS},
            "output": {"series_interval": 1e-3, "frame_interval": EVERY * step if frames else 0},
            "checkpoint": {"interval": EVERY * step if checkpoints else 0, "wall_interval": 0, "at_end": False}}


def times(program, path, out):
    """(wall time of the steps in s, what `furrow validate` tells of writing in s)"""
    told = json.loads(subprocess.run([program, "validate", path, "--json"],
                                     capture_output=True, text=True, check=True).stdout)
    subprocess.run([program, "run", path, "--no-plots", "--quiet", "--out", out], stdout=subprocess.DEVNULL, check=True)
    return json.loads((out / "summary.json").read_text())["wall_s"], told["time"]["writing_s"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", nargs="?", default=ROOT / "build" / "furrow")
    parser.add_argument("--wheels", type=int, action="append", help="may be repeated (default: 1, 16 and 64)")
    parser.add_argument("--rounds", type=int, default=2)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="writing-time-") as holder:
        folder = pathlib.Path(holder)
        os.environ["XDG_CACHE_HOME"] = str(folder / "cache")
        path = folder / "wheels.json"
        print("ranks,written,count,wall_s,without_s,told_s")
        for wheels in arguments.wheels or [1, 16, 64]:
            for count in range(arguments.rounds):
                path.write_text(json.dumps(scenario(wheels, False, False)))
                without, _ = times(arguments.program, path, folder / f"none-{wheels}-{count}")
                for what in ("frames", "checkpoints"):
                    path.write_text(json.dumps(scenario(wheels, what == "frames", what == "checkpoints")))
                    wall, told = times(arguments.program, path, folder / f"{what}-{wheels}-{count}")
                    number = STEPS // EVERY + (what == "frames")
                    print(f"{wheels + 2},{what},{number},{wall:.3g},{without:.3g},{told:.3g}", flush=True)


if __name__ == "__main__":
    main()
