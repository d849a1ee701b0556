#!/usr/bin/python3
"""What the coupling costs the engine liggghts while a wheel rolls: a run against the pair style alone on the same bed.

usage: liggghts_rolling.py     takes ten minutes, prints a table and writes liggghts_rolling.csv beside this script

Nothing else may run meanwhile. The rig drawbar_pull_small_report_soil runs to --at and keeps a checkpoint. From it go
on, --rounds times,
    pairs            our pair style, motion and lists alone in `run N`, on the grains of the checkpoint with their
                     histories, without tires and walls (bench_liggghts)
    walls_accounts   the same with walls and accounts
    each_step        the same with one `run 1` for each step
    whole_run        the run itself, with tire, protocol, accounts and files: the processor time of the terrain

Beyond the processor's own caches the speed of a shared machine drifts by half within seconds. So bench_liggghts and the
run take turns of a tenth of a second: one is stopped by a signal while the other goes on. The parts of bench_liggghts
take turns too. What counts is the ratio within a round to `pairs`, and to `walls_accounts`: a bed has walls in any
engine. The table has the means of both over the rounds, each with half of its 95 % interval. `contacts` and
`list_builds` say how alike the beds are: the soil under a wheel that is taken away comes to rest again.
"""
import csv
import pathlib
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import time

import h5py

from liggghts_cost import ENVIRONMENT, HERE, ONE_THREAD, RIG, STEP, bench_command, driver

sys.path.insert(0, str(HERE.parent / "campaign"))
import processes  # noqa: E402

COLUMNS = ["part", "ranks", "tire", "grains", "steps", "rounds", "us_per_step", "over_pairs", "half_interval",
           "over_walls", "half_interval_of_it", "contacts", "list_builds"]
TIRES = {"shell": {}, "rigid": {"tire.rigid": True}}
TURN = 0.1  # s


def terrain_times(run, ranks):
    """Processor time of each rank until the last checkpoint, s."""
    folder = max((run / "checkpoints").iterdir())
    times = []
    for file in [folder / "terrain.h5"] if ranks == 1 else sorted(folder.glob("terrain*.h5")):
        with h5py.File(file) as part:
            times.append(float(part["state/run:cost:cpu_s"][0]))
    return times


def tell(mark, sign):
    for number in processes.living(mark):
        processes.send(number, sign)


def in_turns(first, of_first, second, of_second):
    """Until the first command has ended; the second is ended with it. Each is known by a word of its command lines.
    @returns what the second printed"""
    with tempfile.TemporaryFile("w+") as printed:
        quiet = {"env": ENVIRONMENT, "stderr": subprocess.DEVNULL}
        one = subprocess.Popen(first, stdout=subprocess.DEVNULL, **quiet)
        other = subprocess.Popen(second, stdout=printed, **quiet)
        now, waits = of_second, of_first
        while one.poll() is None:
            tell(waits, signal.SIGSTOP)
            tell(now, signal.SIGCONT)
            time.sleep(TURN)
            now, waits = waits, now
        for sign in (signal.SIGCONT, signal.SIGTERM):
            tell(of_second, sign)
        other.wait()
        if one.returncode != 0:
            sys.exit(f"{' '.join(first)} ended with {one.returncode}")
        printed.seek(0)
        return list(csv.DictReader(printed))


def one_round(run, copy, ranks, arguments):
    """µs a step by part, and the last row of each part of bench_liggghts."""
    shutil.rmtree(copy, ignore_errors=True)
    shutil.copytree(run, copy)
    before = terrain_times(copy, ranks)
    until = f"{arguments.at + arguments.steps * STEP:.9g}"
    resume = [driver.provenance.program(), "resume", str(copy), "--until", until, "--no-plots", "--quiet"]
    rows = in_turns(resume, str(copy), bench_command(ranks, run, arguments.alone, 1000), str(run))
    found, about = {}, {}
    for row in rows:
        found.setdefault(row["part"], []).append(float(row["cpu_us_per_step"]))
        about[row["part"]] = row
    times = {part: statistics.mean(values) for part, values in found.items()}
    times["whole_run"] = max(1e6 * (b - a) / arguments.steps for a, b in zip(before, terrain_times(copy, ranks)))
    return times, about


def measure(ranks, tire, arguments, folder):
    run = folder / "run"
    shutil.rmtree(run, ignore_errors=True)
    keys = {"terrain.engine": "liggghts", "terrain.ranks": ranks, "run.end": arguments.at,
            "run.average_from": arguments.at - 0.05, "checkpoint.at_end": True, **TIRES[tire]}
    driver.furrow("run", RIG, *driver.settings(keys), "--out", run, "--no-plots", "--quiet", **ONE_THREAD)
    rounds, about = zip(*(one_round(run, folder / "copy", ranks, arguments) for _ in range(arguments.rounds)))
    about = about[-1]
    for part in rounds[0]:
        row = {"part": part, "ranks": ranks, "tire": tire, "grains": about["pairs"]["grains"], "rounds": len(rounds),
               "steps": arguments.steps if part == "whole_run" else arguments.alone,
               "us_per_step": f"{statistics.mean(times[part] for times in rounds):.0f}",
               **{key: about.get(part, {}).get(key, "") for key in ("contacts", "list_builds")}}
        for of, over, half in (("pairs", "over_pairs", "half_interval"),
                               ("walls_accounts", "over_walls", "half_interval_of_it")):
            mean, width = driver.over_beds([times[part] / times[of] for times in rounds])
            row |= {over: f"{mean:.3f}", half: f"{width:.3f}"}
        yield row


def main():
    arguments = driver.options(
        __doc__, at={"type": float, "default": 0.3, "help": "the moment of the checkpoint, s"},
        steps={"type": int, "default": 1000, "help": "of the run from there on"},
        alone={"type": int, "default": 200, "help": "steps of the pair style alone"},
        rounds={"type": int, "default": 8}, ranks={"type": int, "nargs": "+", "default": [1, 2]},
        tires={"nargs": "+", "choices": TIRES, "default": list(TIRES)},
        out={"type": lambda name: pathlib.Path(name).resolve(), "default": HERE / "liggghts_rolling.csv"}).parse_args()
    made, rows = driver.provenance.made_here(), []
    with tempfile.TemporaryDirectory() as name:
        for ranks in arguments.ranks:
            for tire in arguments.tires:
                rows += measure(ranks, tire, arguments, pathlib.Path(name))
                driver.write(arguments.out, rows, made, names=COLUMNS)
    for row in rows:
        print(f"{row['ranks']} rank(s), {row['tire']:<5} tire, {row['part']:<16} {row['us_per_step']:>8} µs a step, "
              f"over pairs {row['over_pairs']} ± {row['half_interval']}, over pairs and walls {row['over_walls']} ± "
              f"{row['half_interval_of_it']}")


if __name__ == "__main__":
    main()
