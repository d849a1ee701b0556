#!/usr/bin/python3
"""Runs the fuzzing targets one after another, on one core, and counts what they did.

usage: run_targets.py --out DIR [--seconds S] [--total S] [--only TARGET ...] [--build DIR]

Each target runs for S seconds more, unless it has had its total of processor time: on a busy machine that is less than what
the clock says. DIR/<target>/ keeps corpus/, findings/ (inputs that ended in
a crash, in silence, in too much time or memory) and log; DIR/counts.json what was done so far. Interrupted, it goes on where
it was. `run_targets.py --out DIR --list` prints the table.
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
TARGETS = ["scenario", "grammar", "tire", "bed", "hdf5", "states", "checkpoint", "run_list", "study", "soil", "summary", "vehicle"]
LONGEST = 20  # s that an input may take
MEMORY = 3000  # MB that a target may have
INTERRUPTED = 72  # libFuzzer's exit code
TRIES = 5  # to continue after a finding, within the seconds of a call


def environment(folder):
    return {**os.environ, "FURROW_HOME": str(ROOT), "XDG_CACHE_HOME": str(folder / "cache"), "OMP_NUM_THREADS": "1",
            "LLVM_PROFILE_FILE": "/dev/null", "UBSAN_OPTIONS": "print_stacktrace=1", "ASAN_OPTIONS": "detect_leaks=1"}


def cpu_of_children():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run_once(program, folder, seconds):
    """(seconds of the clock, of the processor, executions, edges, features, exit code)"""
    command = [str(program), f"-max_total_time={int(seconds)}", f"-timeout={LONGEST}", f"-rss_limit_mb={MEMORY}", "-print_final_stats=1",
               f"-artifact_prefix={folder}/findings/", "-reload=0", str(folder / "corpus")]
    begin, used = time.monotonic(), cpu_of_children()
    with open(folder / "log", "ab") as log, subprocess.Popen(command, stdout=log, stderr=log, cwd=folder, env=environment(folder)) as process:
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
    return time.monotonic() - begin, cpu_of_children() - used, executions, edges, features, process.returncode


def counts_of(out):
    file = out / "counts.json"
    return json.loads(file.read_text()) if file.exists() else {}


def run_target(target, options):
    folder = options.out / target
    (folder / "findings").mkdir(parents=True, exist_ok=True)
    seeds.make(target, ROOT, folder / "corpus")
    left = options.seconds
    for _ in range(TRIES):
        counts = counts_of(options.out)
        have = counts.setdefault(target, {"cpu_seconds": 0.0, "executions": 0, "edges": 0, "features": 0, "findings": 0})
        if left < 1 or have["cpu_seconds"] >= options.total:
            return
        seconds, used, executions, edges, features, code = run_once(options.build / f"fuzz_{target}", folder, left)
        have["cpu_seconds"] = round(have["cpu_seconds"] + used, 1)
        have["executions"] += executions
        have["edges"], have["features"] = max(have["edges"], edges), max(have["features"], features)
        have["findings"] = len(list((folder / "findings").iterdir()))
        (options.out / "counts.json").write_text(json.dumps(counts, indent=1) + "\n")
        left -= seconds
        if code == INTERRUPTED:
            raise KeyboardInterrupt
        if code == 0:
            return


def table(counts):
    lines = ["target,cpu_seconds,executions,edges,features,findings"]
    for target, have in counts.items():
        lines.append(f"{target},{have['cpu_seconds']:.0f},{have['executions']},{have['edges']},{have['features']},{have['findings']}")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--build", type=lambda name: pathlib.Path(name).resolve(), default=ROOT / "build-fuzz")
    parser.add_argument("--seconds", type=float, default=600, help="of each target, now")
    parser.add_argument("--total", type=float, default=3600, help="of the processor, of each target, in all")
    parser.add_argument("--only", nargs="*", default=TARGETS, choices=TARGETS)
    parser.add_argument("--list", action="store_true", help="print the table and end")
    options = parser.parse_args()
    options.out = options.out.resolve()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the target is interrupted, and what it did is counted
    if not options.list:
        for target in options.only:
            run_target(target, options)
    print(table(counts_of(options.out)))


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
