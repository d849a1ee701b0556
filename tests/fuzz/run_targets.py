#!/usr/bin/python3
"""Runs the fuzzing targets one after another, on one core, and counts what they did.

usage: run_targets.py --out DIR [--seconds S] [--total S] [--only TARGET ...] [--patience S] [--build DIR] [--table]

Each target is built, and runs for S seconds more by the clock, unless it has had its total of processor time; on a busy
machine that takes longer. DIR/<target>/ keeps corpus/, findings/ (inputs that ended in a crash, in silence, in too much
time or memory), log, and done.json: what ran so far, added every half hour. --table only prints that. Interrupted, the
same command goes on where it was. Several calls may run at a time, of different targets.
"""
import argparse
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import time

import seeds

ROOT = pathlib.Path(__file__).resolve().parents[2]
TARGETS = ["scenario", "grammar", "tire", "handling", "bed", "road", "hdf5",
           "states", "study", "soil", "vehicle"]
LONGEST = 20  # s by the clock that an input may take; more on a busy machine
MEMORY = 3000  # MB that a target may have
OWED = 3600  # s of the processor, of each target
INTERRUPTED = 72  # libFuzzer's exit code
TRIES = 5  # to continue after a finding, within the seconds of a call
PART = 1800  # s by the clock, after which what ran is counted; each part begins by reading the corpus


def environment(folder):
    return {**os.environ, "FURROW_HOME": str(ROOT), "XDG_CACHE_HOME": str(folder / "cache"), "OMP_NUM_THREADS": "1",
            "LLVM_PROFILE_FILE": "/dev/null", "UBSAN_OPTIONS": "print_stacktrace=1", "ASAN_OPTIONS": "detect_leaks=1"}


def run_program(command, folder, more=()):
    """Of a target: its exit code."""
    with open(folder / "log", "ab") as log:
        process = subprocess.Popen(list(map(str, command)), stdout=log, stderr=log, cwd=folder,
                                   env={**environment(folder), **dict(more)})
        process.wait()
    shutil.rmtree(f"/dev/shm/furrow_fuzz_{process.pid}", ignore_errors=True)
    return process.returncode


def cpu_of_children():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def inside(folder, name):
    return len(list((folder / name).iterdir()))


def done(folder):
    """What a target has done so far."""
    file = folder / "done.json"
    return json.loads(file.read_text()) if file.exists() else {"processor_s": 0.0, "executions": 0, "edges": 0,
                                                               "features": 0}


def run_once(program, folder, seconds, patience):
    """Adds to done.json. @returns the exit code"""
    at = (folder / "log").stat().st_size if (folder / "log").exists() else 0
    used, so_far = cpu_of_children(), done(folder)
    code = run_program([program, f"-max_total_time={int(seconds)}", f"-timeout={int(patience)}",
                        f"-report_slow_units={int(patience)}", f"-rss_limit_mb={MEMORY}", "-print_final_stats=1",
                        f"-artifact_prefix={folder}/findings/", "-reload=0", folder / "corpus"], folder)
    text = (folder / "log").read_bytes()[at:].decode(errors="replace")
    counts = [tuple(map(int, found)) for found in re.findall(r"^#(\d+)\t.*?cov: (\d+) ft: (\d+)", text, re.M)]
    units = re.findall(r"stat::number_of_executed_units: (\d+)", text)
    executions, edges, features = counts[-1] if counts else (0, 0, 0)
    (folder / "done.json").write_text(json.dumps({
        "processor_s": round(so_far["processor_s"] + cpu_of_children() - used, 1),
        "executions": so_far["executions"] + (int(units[-1]) if units else executions),
        "edges": max(so_far["edges"], edges), "features": max(so_far["features"], features)}))
    return code


def run_target(target, options):
    folder, program = options.out / target, options.build / f"fuzz_{target}"
    (folder / "findings").mkdir(parents=True, exist_ok=True)
    seeds.make(target, ROOT, folder / "corpus")
    subprocess.run(["ninja", "-C", str(options.build), program.name], stdout=subprocess.DEVNULL, check=True)
    end, failed = time.monotonic() + options.seconds, 0
    while (left := end - time.monotonic()) >= 1 and failed < TRIES and done(folder)["processor_s"] < options.total:
        code = run_once(program, folder, min(left, PART), options.patience)
        failed += code != 0
        if code == INTERRUPTED:
            raise KeyboardInterrupt


def table(out):
    """In Markdown."""
    yield "| target | processor time (s) | executions | edges | features | findings | corpus |"
    yield "|---|--:|--:|--:|--:|--:|--:|"
    for target in TARGETS:
        if (folder := out / target).is_dir():
            row = done(folder)
            yield (f"| `{target}` | {row['processor_s']:.0f} | {row['executions']:,} | {row['edges']:,} | "
                   f"{row['features']:,} | {inside(folder, 'findings')} | {inside(folder, 'corpus'):,} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=lambda name: pathlib.Path(name).resolve(), required=True)
    parser.add_argument("--build", type=lambda name: pathlib.Path(name).resolve(), default=ROOT / "build-fuzz")
    parser.add_argument("--seconds", type=float, default=600, help="of each target, now")
    parser.add_argument("--total", type=float, default=OWED, help="of the processor, of each target, in all")
    parser.add_argument("--only", nargs="*", default=TARGETS, choices=TARGETS)
    parser.add_argument("--patience", type=float, default=LONGEST, help="s by the clock that an input may take")
    parser.add_argument("--table", action="store_true", help="print what ran and end")
    options = parser.parse_args()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the target is interrupted, and what it did is counted
    for target in [] if options.table else options.only:
        run_target(target, options)
    print("\n".join(table(options.out)))


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
