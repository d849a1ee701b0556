#!/usr/bin/python3
"""A long run of a small rig: a million communication steps by default, with checkpoints. Watches memory and open files of
every rank, and the diagnostics at the end; prints JSON, and exits with 1 when something grew."""
import argparse
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import provenance

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("FURROW", str(ROOT / "build" / "furrow"))
STEP = 1e-4  # s


def scenario(steps):
    end = steps * STEP
    return {"rig": {"mode": "fixed_speed", "speed": 0.3 / end, "slip": 0.3, "ramp": 0.05, "carrier_mass": 450},
            "tire": {"file": "hmmwv_layered.json", "rigid": True},
            "terrain": {"radius": 0.03, "cohesion": 80e3, "layers": 4, "length": 1.4, "width": 0.4},
            "run": {"step": STEP, "end": end, "average_from": 0.5 * end},
            "output": {"series_interval": max(end / 1000, 1e-3), "frame_interval": end / 20},
            "checkpoint": {"interval": end / 100, "wall_interval": 0}}


def ranks(mark):
    """{rank: pid} of the ranks whose command line holds `mark`."""
    found = {}
    for entry in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if mark not in (entry / "cmdline").read_bytes().decode(errors="replace"):
                continue
            for variable in (entry / "environ").read_bytes().split(b"\0"):
                if variable.startswith(b"OMPI_COMM_WORLD_RANK="):
                    found[int(variable.split(b"=")[1])] = int(entry.name)
        except OSError:
            continue
    return found


def sample(pid):
    """(resident memory in MB, open files)"""
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    resident = int(status.split("VmRSS:")[1].split()[0]) / 1024
    return resident, len(os.listdir(f"/proc/{pid}/fd"))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=int, default=1_000_000)
    parser.add_argument("--every", type=float, default=2.0, help="wall seconds between samples")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="furrow_soak_") as folder:
        path = pathlib.Path(folder) / "soak.json"
        path.write_text(json.dumps(scenario(arguments.steps)))
        out = pathlib.Path(folder) / "out"
        run = subprocess.Popen([PROGRAM, "run", str(path), "--out", str(out), "--no-plots"], stderr=subprocess.PIPE, text=True)
        samples = {}
        while run.poll() is None:
            time.sleep(arguments.every)
            for rank, pid in ranks(folder).items():
                try:
                    samples.setdefault(rank, []).append(sample(pid))
                except (OSError, IndexError):
                    pass
        if run.returncode != 0:
            sys.exit(run.stderr.read())
        summary = json.loads((out / "summary.json").read_text())
        with open(out / "timeseries.csv", newline="") as file:
            rows = list(csv.DictReader(file))
    made = {"commit": provenance.commit(), "compiler": summary["compiler"], "processor": summary["cpu"], "command": provenance.command()}
    report = {"made": made, "steps": arguments.steps, "wall_s": summary["wall_s"], "checkpoints": 100, "ranks": []}
    grew = False
    for rank, series in sorted(samples.items()):
        half = series[len(series) // 4:]
        first, last = half[: max(1, len(half) // 4)], half[-max(1, len(half) // 4):]
        mean = [sum(s[0] for s in part) / len(part) for part in (first, last)]
        files = [max(s[1] for s in part) for part in (first, last)]
        grew |= mean[1] > 1.02 * mean[0] + 1.0 or files[1] > files[0]
        report["ranks"].append({"node": summary["ranks"][rank]["node"], "samples": len(series), "memory_MB_early": round(mean[0], 2),
                                "memory_MB_late": round(mean[1], 2), "open_files_early": files[0], "open_files_late": files[1]})
    for key in ("momentum_residual", "transfer_force_residual", "transfer_moment_residual", "vertical_balance_residual"):
        report[key] = summary[key]
    report["energy_error_J_half_and_end"] = [float(rows[len(rows) // 2]["energy_error_J"]), float(rows[-1]["energy_error_J"])]
    report["grew"] = grew
    print(json.dumps(report, indent=1))
    return 1 if grew else 0


if __name__ == "__main__":
    sys.exit(main())
