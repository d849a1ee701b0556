#!/usr/bin/python3
"""Time that the ranks of a run take to begin and to end, of two builds in turn, and the time of a step beside what is
told.

usage: start_of_ranks.py PROGRAM [PROGRAM] [--wheels N]... [--rounds N]

Runs 300 steps of N rigid wheels in rows of four (default: 1, 4, 16, 64), which is N + 2 ranks. What the whole command
takes less its steps and its bed is the beginning and the end. Prints lines of CSV. Needs a machine that has nothing
else to do.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

STEP, STEPS = 1e-4, 300


def scenario(wheels):
    places = [{"start": 0.7 + 1.1 * (k // 4), "lateral": -0.75 + 0.5 * (k % 4)} for k in range(wheels)]
    return {
        "format_version": 1,
        "rig": {"mode": "fixed_angular_speed", "angular_speed": 0.0, "slip": 0.0,
                "carrier_mass": 450, "wheels": places},
        "tire": {"file": "hmmwv_layered.json", "rigid": True},
        "terrain": {"radius": 0.03, "cohesion": 80e3, "layers": 4, "length": 1.4 + 1.1 * ((wheels + 3) // 4),
                    "width": 2.1},
        "run": {"step": STEP, "end": STEP * STEPS, "average_from": 0.5 * STEP * STEPS},
        "output": {"series_interval": 1e-3, "frame_interval": 0},
        "checkpoint": {"at_end": False},
    }


def times(program, path, out):
    """(wall time of beginning and end in s, of a step in ms, both as told by `furrow validate`)"""
    told = json.loads(subprocess.run([program, "validate", path, "--json"],
                                     capture_output=True, text=True, check=True).stdout)
    begin = time.monotonic()
    done = subprocess.run([program, "run", path, "--no-plots", "--out", out], capture_output=True, text=True)
    wall = time.monotonic() - begin
    if done.returncode != 0:
        sys.exit(f"{program}: {done.stderr}")
    summary = json.loads((out / "summary.json").read_text())
    return (wall - summary["wall_s"] - summary["settle_wall_s"], 1e3 * summary["wall_s"] / STEPS,
            told["time"].get("start_s", 0.0), 1e3 * told["time"]["step_s"])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", nargs="+", help="builds of furrow to compare")
    parser.add_argument("--wheels", type=int, action="append", help="may be repeated (default: 1, 4, 16 and 64)")
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="start-of-ranks-") as holder:
        folder = pathlib.Path(holder)
        os.environ["XDG_CACHE_HOME"] = str(folder / "cache")
        path = folder / "wheels.json"
        print("ranks,program,start_s,ms_per_step,told_start_s,told_ms_per_step")
        for wheels in arguments.wheels or [1, 4, 16, 64]:
            path.write_text(json.dumps(scenario(wheels)))
            times(arguments.program[0], path, folder / f"bed-{wheels}")
            for count in range(arguments.rounds):
                for number, program in enumerate(arguments.program):
                    found = times(program, path, folder / f"run-{wheels}-{count}-{number}")
                    print(f"{wheels + 2},{program}," + ",".join(f"{value:.3g}" for value in found), flush=True)


if __name__ == "__main__":
    main()
