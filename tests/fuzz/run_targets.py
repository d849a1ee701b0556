#!/usr/bin/python3
"""Runs the fuzzing targets one after another, on one core, and counts what they did.

usage: run_targets.py --out DIR [--seconds S] [--total S] [--only TARGET ...] [--patience S] [--build DIR] [--hours
FILE]
       run_targets.py --table [--hours FILE]

Each target is built, and runs for S seconds more by the clock, unless it has had its total of processor time; on a busy
machine that takes longer. DIR/<target>/ keeps corpus/, findings/ (inputs that ended in a crash, in silence, in too much
time or memory) and log. What ran is added to FILE, tests/fuzz/hours.csv, every half hour; --table prints the totals of
it. Interrupted, the same command goes on where it was. Several calls may run at a time, of different targets.
"""
import argparse
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import time

import hours
import seeds

ROOT = pathlib.Path(__file__).resolve().parents[2]
TARGETS = ["scenario", "grammar", "tire", "handling", "bed", "road", "hdf5",
           "states", "study", "soil", "vehicle"]
LONGEST = 20  # s by the clock that an input may take; more on a busy machine
MEMORY = 3000  # MB that a target may have
INTERRUPTED = 72  # libFuzzer's exit code
TRIES = 5  # to continue after a finding, within the seconds of a call
PART = 1800  # s by the clock, after which what ran is counted; each part begins by reading the corpus


def environment(folder):
    return {**os.environ, "FURROW_HOME": str(ROOT), "XDG_CACHE_HOME": str(folder / "cache"), "OMP_NUM_THREADS": "1",
            "LLVM_PROFILE_FILE": "/dev/null", "UBSAN_OPTIONS": "print_stacktrace=1", "ASAN_OPTIONS": "detect_leaks=1"}


def cpu_of_children():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run_once(program, folder, seconds, patience):
    """(seconds of the clock, exit code, what is to be counted)"""
    found = len(list((folder / "findings").iterdir()))
    command = [str(program), f"-max_total_time={int(seconds)}", f"-timeout={int(patience)}",
               f"-report_slow_units={int(patience)}",
               f"-rss_limit_mb={MEMORY}", "-print_final_stats=1", f"-artifact_prefix={folder}/findings/",
               "-reload=0", str(folder / "corpus")]
    begin, used = time.monotonic(), cpu_of_children()
    with open(folder / "log", "ab") as log, subprocess.Popen(command, stdout=log, stderr=log,
                                                             cwd=folder, env=environment(folder)) as process:
        at = (folder / "log").stat().st_size
        process.wait()
    shutil.rmtree(f"/dev/shm/furrow_fuzz_{process.pid}", ignore_errors=True)
    with open(folder / "log", "rb") as log:
        log.seek(at)
        text = log.read().decode(errors="replace")
    last = re.findall(r"^#(\d+)\t.*?cov: (\d+) ft: (\d+)", text, re.M)
    units = re.findall(r"stat::number_of_executed_units: (\d+)", text)
    executions = int(units[-1]) if units else int(last[-1][0]) if last else 0
    edges, features = (int(last[-1][1]), int(last[-1][2])) if last else (0, 0)
    return time.monotonic() - begin, process.returncode, {
        "processor_s": round(cpu_of_children() - used, 1), "executions": executions,
        "edges": edges, "features": features,
        "findings": len(list((folder / "findings").iterdir())) - found,
        "corpus_inputs": len(list((folder / "corpus").iterdir()))}


def run_target(target, options):
    folder, program = options.out / target, options.build / f"fuzz_{target}"
    (folder / "findings").mkdir(parents=True, exist_ok=True)
    seeds.make(target, ROOT, folder / "corpus")
    commit = hours.build(program, options.hours)
    left, failed = options.seconds, 0
    while left >= 1 and failed < TRIES and hours.totals(options.hours).get(target,
                                                                           {}).get("processor_s", 0) < options.total:
        seconds, code, counted = run_once(program, folder, min(left, PART), options.patience)
        hours.add(options.hours, program, {"target": target, "commit": commit, **counted})
        left -= seconds
        failed += code != 0
        if code == INTERRUPTED:
            raise KeyboardInterrupt


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=lambda name: pathlib.Path(name).resolve())
    parser.add_argument("--build", type=lambda name: pathlib.Path(name).resolve(), default=ROOT / "build-fuzz")
    parser.add_argument("--seconds", type=float, default=600, help="of each target, now")
    parser.add_argument("--total", type=float, default=hours.OWED, help="of the processor, of each target, in all")
    parser.add_argument("--only", nargs="*", default=TARGETS, choices=TARGETS)
    parser.add_argument("--patience", type=float, default=LONGEST, help="s by the clock that an input may take")
    parser.add_argument("--hours", type=lambda name: pathlib.Path(name).resolve(),
                        default=hours.TABLE, help="the table that is added to")
    parser.add_argument("--table", action="store_true", help="print the totals and end")
    options = parser.parse_args()
    if not options.table and options.out is None:
        parser.error("--out DIR is missing, expected the folder of corpora and findings")
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the target is interrupted, and what it did is counted
    if not options.table:
        for target in options.only:
            run_target(target, options)
    print(hours.told(options.hours, TARGETS))


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
