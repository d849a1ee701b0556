#!/usr/bin/python3
"""Time of a communication step beside busy processes, of two builds in turn.

usage: oversubscribed.py PROGRAM [PROGRAM] [--busy N]... [--rounds N] [--scenario FILE] [--set KEY=VALUE]...

Starts N busy processes per core (default: 0, then 4), runs a short scenario under each program in turn, `--rounds`
times, and prints one line per run and the median of each. The bed settles in the first run and comes from the cache in
the others. The busy processes do nothing but arithmetic. Needs a machine that has nothing else to do.

A run among B busy processes per core has a fair share of 1 / (1 + B) of the cores, when its own ranks are as many as
these; so the step may become about 1 + B times as long. What it becomes longer than that is lost in waiting for a core.
"""
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

from start_of_ranks import driver

SMALL = {
    "format_version": 1,
    "rig": {"type": "drawbar", "slip": 0.3, "angular_speed": 4.28, "ramp": 0.01, "carrier_mass": 450},
    "tire": {"file": "hmmwv_layered.json", "rigid": True},
    "terrain": {"radius": 0.03, "cohesion": 80e3, "layers": 4, "length": 1.4, "width": 0.4},
    "run": {"step": 1e-4, "end": 0.2, "average_from": 0.1}, "output": {"series_interval": 1e-3, "frame_interval": 0},
    "checkpoint": {"at_end": False},
}
BUSY = "while True: pass"


def milliseconds_per_step(program, words, out):
    """Wall time of the run without settling over its steps, and processor time of all its processes, s."""
    _, processor, _ = driver.timed("run", *words, "--no-plots", "--out", out, program=os.path.abspath(program),
                                   XDG_CACHE_HOME=str(out.parent / "cache"))
    run = driver.read_json(out / "scenario.json")["run"]
    return 1e3 * driver.summary(out)["wall_s"] / round(run["end"] / run["step"]), processor


def main():
    parser = driver.options(
        __doc__, busy={"type": int, "action": "append", "help": "busy processes per core; default: 0 and 4"},
        rounds={"type": int, "default": 5}, set={"action": "append", "default": [], "metavar": "KEY=VALUE"},
        scenario={"type": os.path.abspath, "help": "default: a rigid wheel on a few large grains, 2000 steps"})
    parser.add_argument("program", nargs="+", help="builds of furrow to compare")
    arguments = parser.parse_args()
    cores, medians = len(os.sched_getaffinity(0)), {}
    with tempfile.TemporaryDirectory(prefix="oversubscribed-") as holder:
        folder = pathlib.Path(holder)
        (folder / "small.json").write_text(json.dumps(SMALL))
        words = [arguments.scenario or folder / "small.json"]
        words += [word for setting in arguments.set for word in ("--set", setting)]
        for number, program in enumerate(arguments.program):
            milliseconds_per_step(program, words, folder / f"warm-{number}")
        print("busy per core, program, ms per step, processor time of the run s")
        for busy in arguments.busy or [0, 4]:
            crowd = [subprocess.Popen([sys.executable, "-c", BUSY]) for _ in range(busy * cores)]
            try:
                taken = {program: [] for program in arguments.program}
                for count in range(arguments.rounds):
                    for number, program in enumerate(arguments.program):
                        step, processor = milliseconds_per_step(program, words, folder / f"run-{busy}-{count}-{number}")
                        taken[program].append(step)
                        print(f"{busy}, {program}, {step:.3f}, {processor:.2f}", flush=True)
            finally:
                for process in crowd:
                    process.kill()
                    process.wait()
            medians[busy] = {program: statistics.median(steps) for program, steps in taken.items()}
    for busy, steps in medians.items():
        for program, step in steps.items():
            alone = medians.get(0, {}).get(program)
            share = f", {step / alone:.1f} times as long as alone" if alone and busy else ""
            print(f"median beside {busy} busy processes per core: {step:.3f} ms per step, {program}{share}")


if __name__ == "__main__":
    main()
