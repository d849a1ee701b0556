#!/usr/bin/python3
"""Long and large runs: watches memory, open files and the time per step of every rank, from beginning to end.

usage: soak.py CASE [--scale S] [--every SECONDS] [--json FILE] [--keep DIR]

steps   5,000,000 communication steps of a small rig, with sleep and 100 checkpoints
grains  a wheel on 2,000,000 grains for the whole of its 1.5 s
wheels  64 wheels on the cores that there are
frames  100,000 frames in one folder
runs    a study of 1,000 runs

`--scale 0.01` makes a case that much shorter. Prints JSON, and writes it with its commit, processor and command to
FILE; exits with 1 when memory or open files grew, or a step came to take more than twice as long.
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

import driver
import provenance
from driver import ROOT, read_json

sys.path.insert(0, str(ROOT / "tests" / "campaign"))
from processes import living  # noqa: E402

PROGRAM = provenance.program()
STEP = 1e-4  # s
GROWN_MB, GROWN_SHARE = 1.0, 0.02  # of memory between the second and the last quarter of the samples
SLOWER = 2.0
RIG = {"slip": 0.3, "ramp": 0.05, "carrier_mass": 450}
WHEEL = {"file": "hmmwv_layered.json", "rigid": True}
SMALL = {"radius": 0.03, "cohesion": 80e3, "layers": 4, "length": 1.4, "width": 0.4}


def small(steps, **sections):
    end = steps * STEP
    return {"rig": {"mode": "fixed_speed", "speed": 0.3 / end, **RIG}, "tire": WHEEL, "terrain": SMALL,
            "run": {"step": STEP, "end": end, "average_from": 0.5 * end},
            "output": {"series_interval": max(end / 1000, 1e-3), "frame_interval": end / 20},
            "checkpoint": {"interval": end / 100, "wall_interval": 0}, **sections}


def case_steps(scale):
    return small(round(5_000_000 * scale))


def case_grains(scale):
    """2,000,000 grains of 10 mm: 40 m of bed, 3 m wide; the wheel runs as in drawbar_pull_small_report_soil."""
    scenario = read_json(ROOT / "rigs" / "drawbar_pull_small_report_soil.json")
    scenario.pop("expected")
    scenario["tire"]["rigid"] = True
    scenario["terrain"].update(length=47.0, width=3.0)
    scenario["run"].update(end=1.5 * scale, average_from=0.7 * scale)
    scenario["checkpoint"] = {"interval": 0.1 * scale, "wall_interval": 0, "keep": 2}
    scenario["output"]["frame_interval"] = 0.25 * scale
    return scenario


def case_wheels(scale):
    """Eight columns of eight, each standing on its own place."""
    places = [{"start": 0.7 + 1.1 * i, "lateral": -1.75 + 0.5 * j} for i in range(8) for j in range(8)]
    return small(round(1000 * scale), rig={**RIG, "slip": 0.0, "mode": "fixed_angular_speed", "angular_speed": 0.0,
                                           "wheels": places},
                 terrain={**SMALL, "length": 9.4, "width": 4.1})


def case_frames(scale):
    steps = round(100_000 * scale)
    return small(steps, output={"series_interval": 1e-3, "frame_interval": STEP})


def sample(pid):
    """(resident memory in MB of 2^20 bytes, open files)"""
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    resident = int(status.split("VmRSS:")[1].split()[0]) / 1024
    return resident, len(os.listdir(f"/proc/{pid}/fd"))


def newest_step(out):
    """Of the checkpoints; 0 before the first."""
    folder = out / "checkpoints"
    return max((int(name) for name in os.listdir(folder) if name.isdigit()), default=0) if folder.is_dir() else 0


def watch(command, mark, out, every):
    """@returns (samples (wall time, memory, open files) by process, [(wall time, step)], wall time) of the command"""
    samples, steps, begin = {}, [], time.monotonic()
    run = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while True:
        try:
            _, errors = run.communicate(timeout=every)
            break
        except subprocess.TimeoutExpired:
            pass
        ranks = {role: pid for pid, role in living(mark).items() if role.startswith("rank ")}
        for name, pid in {"furrow": run.pid, **ranks}.items():
            try:
                samples.setdefault(name, []).append((time.monotonic() - begin, *sample(pid)))
            except (OSError, IndexError):
                pass
        step = newest_step(out)
        if step and (not steps or step != steps[-1][1]):
            steps.append((time.monotonic() - begin, step))
    if run.returncode != 0:
        sys.exit(f"{command[1]} ended with {run.returncode}: {errors[-2000:]}")
    return samples, steps, time.monotonic() - begin


def early_and_late(series):
    """Of the second and the last quarter: least memory, fewest open files. They are what stays: what is there only
    while a checkpoint or a frame is written does not count."""
    later = series[len(series) // 4:]
    parts = later[: max(1, len(later) // 3)], later[-max(1, len(later) // 3):]
    return [tuple(min(s[k] for s in part) for k in (1, 2)) for part in parts]


def rates(ends):
    """Milliseconds per step of the second and of the last quarter. @param ends [(wall time in s, step)], growing"""
    quarter = len(ends) // 4
    spans = (ends[quarter], ends[2 * quarter]), (ends[-1 - quarter], ends[-1])
    return [round(1e3 * (b[0] - a[0]) / (b[1] - a[1]), 4) for a, b in spans]


def series_size(out):
    """MB of the series of a run, which the rig's rank holds until the end, 8 bytes for each number."""
    numbers = 0
    for path in out.glob("timeseries*.csv"):
        with open(path) as lines:
            numbers += sum(line.count(",") + 1 for line in lines if not line.startswith("#"))
    return 8e-6 * numbers


def judge(report, samples, what, ends, begin=0.0, series_MB=0.0):
    """@param ends: [(wall time in s, number done)] of each `what`, which is a step or a run
    @param begin: wall time in s at which the steps began; what a process holds before, while a bed settles, does not
    count
    @param series_MB: that the memory of rank 0 may grow by"""
    grew = False
    for name, seen in sorted(samples.items()):
        (memory, files), (memory_late, files_late) = early_and_late([s for s in seen if s[0] >= begin])
        allowed = GROWN_SHARE * memory + GROWN_MB + (series_MB if name == "rank 0" else 0.0)
        grew |= memory_late - memory > allowed or files_late > files
        report["processes"].append({"process": name, "samples": len(seen),
                                    "most_memory_MB": round(max(s[1] for s in seen), 1),
                                    "memory_MB_early": round(memory, 2), "memory_MB_late": round(memory_late, 2),
                                    "open_files_early": files, "open_files_late": files_late})
    if len(ends) >= 8:
        early, late = report[f"ms_per_{what}_early"], report[f"ms_per_{what}_late"] = rates(ends)
        grew |= late > SLOWER * early
    report["grew"] = grew


def run_case(scenario, folder, every):
    path, out = folder / "soak.json", folder / "out"
    path.write_text(json.dumps({"format_version": 1, **scenario}))
    check = subprocess.run([PROGRAM, "validate", str(path)], capture_output=True, text=True)
    samples, steps, wall = watch([PROGRAM, "run", str(path), "--out", str(out), "--no-plots"], str(folder), out, every)
    summary, files = driver.summary(out), [path for path in out.rglob("*") if path.is_file()]
    report = {"steps": round(summary["simulated_s"] / scenario["run"]["step"]), "wall_s": round(wall, 1),
              "settle_wall_s": round(summary["settle_wall_s"], 1), "run_wall_s": round(summary["wall_s"], 1),
              "grains": summary["grains"], "active_share_mean": summary["active_share_mean"],
              "series_MB": round(series_size(out), 2), "cores": os.cpu_count(), "files": len(files),
              "bytes": sum(path.stat().st_size for path in files),
              "said_before": [line for line in check.stdout.splitlines() if "core" in line or "memory" in line],
              "processes": []}
    judge(report, samples, "step", steps, wall - summary["wall_s"], report["series_MB"])
    return report, summary


def run_study(scale, folder, every):
    """Runs of at most a second each."""
    count, study, out = round(1000 * scale), folder / "study.json", folder / "out"
    scenario = small(200, output={"series_interval": 1e-3, "frame_interval": 0}, checkpoint={"at_end": False})
    (folder / "small.json").write_text(json.dumps({"format_version": 1, **scenario}))
    slips = [round(0.6 * k / count, 6) for k in range(count)]
    study.write_text(json.dumps({"scenario": "small.json", "grid": {"rig.slip": slips}}))
    command = [PROGRAM, "sweep", str(study), "--out", str(out)]
    samples, _, wall = watch(command, str(folder / "nobody"), out, every)
    begin = time.monotonic()
    again = subprocess.run(command, capture_output=True, text=True)
    done = sorted(out.glob("runs/*/summary.json"), key=lambda path: path.stat().st_mtime)
    report = {"runs": len((out / "sweep.csv").read_text().splitlines()) - 1, "wall_s": round(wall, 1),
              "again_wall_s": round(time.monotonic() - begin, 1), "again_exit_code": again.returncode, "processes": []}
    judge(report, samples, "run", [(path.stat().st_mtime, run) for run, path in enumerate(done, 1)])
    return report, read_json(done[0])


CASES = {"steps": case_steps, "grains": case_grains, "wheels": case_wheels, "frames": case_frames, "runs": None}


def main():
    parser = driver.options(
        __doc__, scale={"type": float, "default": 1.0},
        every={"type": float, "default": 2.0, "help": "wall seconds between samples"},
        json={"type": pathlib.Path, "help": "file that holds the reports of all cases; this one's is replaced"},
        keep={"type": pathlib.Path, "help": "work here and leave the results"})
    parser.add_argument("case", choices=CASES)
    arguments = parser.parse_args()
    folder = (arguments.keep or pathlib.Path(tempfile.mkdtemp(prefix="furrow_soak_"))).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    try:
        if arguments.case == "runs":
            report, summary = run_study(arguments.scale, folder, arguments.every)
        else:
            report, summary = run_case(CASES[arguments.case](arguments.scale), folder, arguments.every)
    finally:
        if not arguments.keep:
            shutil.rmtree(folder, ignore_errors=True)
    scale = f" --scale {arguments.scale:g}" if arguments.scale != 1.0 else ""
    report |= {"scale": arguments.scale,
               "made": {"commit": provenance.commit(), "compiler": summary["compiler"], "processor": summary["cpu"],
                        "command": f"soak.py {arguments.case}{scale}"}}
    print(json.dumps(report, indent=1))
    if arguments.json:
        reports = read_json(arguments.json) | {arguments.case: report}
        reports["made"] = {**report["made"], "command": "soak.py CASE --json FILE"}
        arguments.json.write_text(json.dumps(reports, indent=1) + "\n")
    return 1 if report["grew"] else 0


if __name__ == "__main__":
    sys.exit(main())
