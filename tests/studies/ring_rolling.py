#!/usr/bin/python3
"""The damping of the shipped ring from the rolling moment of the lumped shell, and that moment at other loads and
speeds.

    /usr/bin/python3 tests/studies/ring_rolling.py [--fit]

Both roll on hard ground by `furrow bench tire`, which ends with the moment about the axle, N m, of a tire that is not
driven. The shell is hmmwv_lumped.json of 90 × 24 elements, to which hmmwv_ring.json was fitted at rest. With --fit the
structural_damping of the ring is printed that has the moment of the shell under TARGET, by linear interpolation between
two runs. Writes ring_rolling.csv beside this script, of the file as it is shipped: `used` marks the row that the
damping was fitted to, the others were held out.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import provenance
from provenance import ROOT

DATA = ROOT / "tire" / "data"
SHELL = ("--tire", DATA / "hmmwv_lumped.json", "--elements-circumference", "90", "--elements-width", "24")
RING = DATA / "hmmwv_ring.json"
TARGET = (465, 8.56)  # kg, rad/s
CASES = [TARGET, (465, 4.28), (465, 17.1), (300, 8.56), (650, 8.56)]
TRIED = (1.5e-3, 3e-3)  # s


def moment(load, speed, *words):
    done = subprocess.run([provenance.program(), "bench", "tire", "--step",
                           "1e-4", "--warm", "0.6", "--steps", "3000", "--load", str(load),
                           "--speed", str(speed), *map(str, words)], check=True, stdout=subprocess.PIPE, text=True,
                          env={**os.environ, "FURROW_HOME": str(ROOT)})
    return -json.loads(done.stdout)["rolling_moment_Nm"]


def fit():
    """The damping that has the shell's moment, s."""
    ring, found = json.loads(RING.read_text()), []
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "ring.json"
        for damping in TRIED:
            file.write_text(json.dumps({**ring, "structural_damping": damping}))
            found.append(moment(*TARGET, "--tire", file))
    wanted = moment(*TARGET, *SHELL)
    return TRIED[0] + (wanted - found[0]) / (found[1] - found[0]) * (TRIED[1] - TRIED[0])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--fit", action="store_true")
    if parser.parse_args().fit:
        print(f"structural_damping {fit():.4g} s")
        return
    made, rows = provenance.made_here(), []
    for load, speed in CASES:
        shell, ring = moment(load, speed, *SHELL), moment(load, speed, "--tire", RING)
        rows.append({"load_kg": load, "speed_rad_s": speed, "shell_Nm": f"{shell:.4g}",
                     "ring_Nm": f"{ring:.4g}", "beside": f"{ring / shell - 1.0:.3f}",
                     "used": (load, speed) == TARGET,
                     "structural_damping_s": json.loads(RING.read_text())["structural_damping"]})
        print(rows[-1], file=sys.stderr, flush=True)
    provenance.write_table(pathlib.Path(__file__).with_suffix(".csv"), list(rows[0]), rows, made)


if __name__ == "__main__":
    main()
