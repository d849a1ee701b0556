#!/usr/bin/python3
"""Time that the ranks of a run take to begin and to end, of two builds in turn, and the time of a step beside what is
told.

usage: start_of_ranks.py PROGRAM [PROGRAM] [--wheels N]... [--rounds N]

Runs 300 steps of N rigid wheels in rows of four (default: 1, 4, 16, 64), which is N + 2 ranks. What the whole command
takes less its steps and its bed is the beginning and the end. Prints lines of CSV. Needs a machine that has nothing
else to do.
"""
import json
import os
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "studies"))
import driver  # noqa: E402

STEP, STEPS = 1e-4, 300


def scenario(wheels, steps=STEPS, **sections):
    places = [{"start": 0.7 + 1.1 * (k // 4), "lateral": -0.75 + 0.5 * (k % 4)} for k in range(wheels)]
    return {
        "format_version": 1,
        "rig": {"mode": "fixed_angular_speed", "angular_speed": 0.0, "slip": 0.0,
                "carrier_mass": 450, "wheels": places},
        "tire": {"file": "hmmwv_layered.json", "rigid": True},
        "terrain": {"radius": 0.03, "cohesion": 80e3, "layers": 4, "length": 1.4 + 1.1 * ((wheels + 3) // 4),
                    "width": 2.1},
        "run": {"step": STEP, "end": STEP * steps, "average_from": 0.5 * STEP * steps},
        "output": {"series_interval": 1e-3, "frame_interval": 0},
        "checkpoint": {"at_end": False}, **sections,
    }


def run(program, made, out):
    """(summary, wall time of the command in s, what `furrow validate` tells of its time)"""
    path = out.with_suffix(".json")
    path.write_text(json.dumps(made))
    cache, program = {"XDG_CACHE_HOME": str(out.parent / "cache")}, os.path.abspath(program)
    told = json.loads(driver.furrow("validate", path, "--json", program=program, **cache))
    _, _, wall = driver.timed("run", path, "--no-plots", "--quiet", "--out", out, program=program, **cache)
    return driver.summary(out), wall, told["time"]


def main():
    parser = driver.options(__doc__, rounds={"type": int, "default": 3}, wheels={"type": int, "action": "append"})
    parser.add_argument("program", nargs="+", help="builds of furrow to compare")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="start-of-ranks-") as folder:
        print("ranks,program,start_s,ms_per_step,told_start_s,told_ms_per_step")
        for wheels in arguments.wheels or [1, 4, 16, 64]:
            run(arguments.program[0], scenario(wheels), pathlib.Path(folder) / f"bed-{wheels}")
            for count in range(arguments.rounds):
                for number, program in enumerate(arguments.program):
                    out = pathlib.Path(folder) / f"run-{wheels}-{count}-{number}"
                    summary, wall, told = run(program, scenario(wheels), out)
                    found = (wall - summary["wall_s"] - summary["settle_wall_s"], 1e3 * summary["wall_s"] / STEPS,
                             told.get("start_s", 0.0), 1e3 * told["step_s"])
                    print(f"{wheels + 2},{program}," + ",".join(f"{value:.3g}" for value in found), flush=True)


if __name__ == "__main__":
    main()
