#!/usr/bin/python3
"""What the coupling costs the engine liggghts while a wheel rolls: a run against the pair style alone on the same bed.

usage: liggghts_rolling.py     takes about ten minutes, prints a table and writes liggghts_rolling.csv beside this
script

Nothing else may run meanwhile. The rig drawbar_pull_small runs to --at and keeps a checkpoint. From it go on, --rounds
times,

    pairs            our pair style, motion and lists alone in `run N`, on the grains of the checkpoint with their
    histories,
                     without tires and walls (bench_liggghts)
    walls_accounts   the same with walls and accounts
    each_step        the same with one `run 1` for each step
    whole_run        the run itself, with tire, protocol, accounts and files: the processor time of the terrain

Beyond the processor's own caches the speed of a shared machine drifts by half within seconds. So bench_liggghts and the
run take turns of a tenth of a second: one is stopped by a signal while the other goes on. The parts of bench_liggghts
take turns too. What counts is the ratio within a round to `pairs`, and to `walls_accounts`: a bed has walls in any
engine. The table has the means of both over the rounds, each with half of its 95 % interval. `contacts` and
`list_builds` say how alike the beds are: the soil under a wheel that is taken away comes to rest again.
"""
import argparse
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

from liggghts_cost import ENVIRONMENT, HERE, RIG, STEP, bench_command, provenance

sys.path.insert(0, str(HERE.parents[1] / "scripts"))
sys.path.insert(0, str(HERE.parent / "campaign"))
import processes  # noqa: E402
from plot.student import half_interval  # noqa: E402

COLUMNS = ["part", "ranks", "tire", "grains", "steps", "rounds", "us_per_step",
           "over_pairs", "half_interval", "over_walls", "half_interval_of_it",
           "contacts", "list_builds"]
TIRES = {"shell": [], "rigid": ["tire.rigid=true"]}
TURN = 0.1  # s


def furrow(verb, *words):
    return [provenance.program(), verb, *map(str, words), "--no-plots", "--quiet"]


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
        one, other = subprocess.Popen(first, stdout=subprocess.DEVNULL,
                                      **quiet), subprocess.Popen(second, stdout=printed, **quiet)
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
    rows = in_turns(furrow("resume", copy, "--until", f"{arguments.at + arguments.steps * STEP:.9g}"), str(copy),
                    bench_command(ranks, run, arguments.alone, 1000), str(run))
    found, about = {}, {}
    for row in rows:
        found.setdefault(row["part"], []).append(float(row["cpu_us_per_step"]))
        about[row["part"]] = row
    times = {part: statistics.mean(values) for part, values in found.items()}
    times["whole_run"] = max(1e6 * (b - a) / arguments.steps for a, b in zip(before, terrain_times(copy, ranks)))
    return times, about


def measure(ranks, tire, arguments, folder):
    run, rounds = folder / "run", []
    shutil.rmtree(run, ignore_errors=True)
    keys = ["terrain.engine=liggghts", f"terrain.ranks={ranks}", f"run.end={arguments.at}",
            f"run.average_from={arguments.at - 0.05}",
            "checkpoint.at_end=true", *TIRES[tire]]
    subprocess.run(furrow("run", RIG, *(word for key in keys for word in ("--set", key)), "--out", run),
                   check=True, env=ENVIRONMENT,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    for _ in range(arguments.rounds):
        times, about = one_round(run, folder / "copy", ranks, arguments)
        rounds.append(times)
    rows = []
    for part in rounds[0]:
        over = {of: [times[part] / times[of] for times in rounds] for of in ("pairs", "walls_accounts")}
        row = about.get(part, {})
        rows.append({"part": part, "ranks": ranks, "tire": tire, "grains": about["pairs"]["grains"],
                     "rounds": len(rounds),
                     "steps": arguments.steps if part == "whole_run" else arguments.alone,
                     "us_per_step": f"{statistics.mean(times[part] for times in rounds):.0f}",
                     "over_pairs": f"{statistics.mean(over['pairs']):.3f}",
                     "half_interval": f"{half_interval(over['pairs']):.3f}",
                     "over_walls": f"{statistics.mean(over['walls_accounts']):.3f}",
                     "half_interval_of_it": f"{half_interval(over['walls_accounts']):.3f}",
                     "contacts": row.get("contacts", ""), "list_builds": row.get("list_builds", "")})
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--at", type=float, default=0.3, help="the moment of the checkpoint, s")
    parser.add_argument("--steps", type=int, default=1000, help="of the run from there on")
    parser.add_argument("--alone", type=int, default=200, help="steps of the pair style alone")
    parser.add_argument("--rounds", type=int, default=8)
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--tires", nargs="+", choices=TIRES, default=list(TIRES))
    parser.add_argument("--out", type=pathlib.Path, default=HERE / "liggghts_rolling.csv")
    arguments = parser.parse_args()
    made, rows = provenance.made_here(), []
    with tempfile.TemporaryDirectory() as name:
        for ranks in arguments.ranks:
            for tire in arguments.tires:
                new = measure(ranks, tire, arguments, pathlib.Path(name))
                rows += new
                provenance.write_table(arguments.out, COLUMNS, rows, made)
                print(f"\n{ranks} rank(s), {tire} tire".ljust(32) + "us a step   over pairs     over pairs and walls",
                      flush=True)
                for row in new:
                    print(f"{row['part']:<32} {row['us_per_step']:>8} {row['over_pairs']:>9} ± {row['half_interval']} "
                          f"{row['over_walls']:>9} ± {row['half_interval_of_it']}", flush=True)


if __name__ == "__main__":
    main()
