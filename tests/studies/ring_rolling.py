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
import json
import pathlib
import tempfile

import driver
import provenance
from driver import read_json

DATA = driver.ROOT / "tire" / "data"
SHELL = (DATA / "hmmwv_lumped.json", "--elements-circumference", "90", "--elements-width", "24")
RING = DATA / "hmmwv_ring.json"
TARGET = (465, 8.56)  # kg, rad/s
CASES = [TARGET, (465, 4.28), (465, 17.1), (300, 8.56), (650, 8.56)]
TRIED = (1.5e-3, 3e-3)  # s


def moment(load, speed, tire, *words):
    told = driver.furrow("bench", "tire", "--step", "1e-4", "--warm", "0.6", "--steps", "3000", "--load", load,
                         "--speed", speed, "--tire", tire, *words)
    return -json.loads(told)["rolling_moment_Nm"]


def fit():
    """The damping that has the shell's moment, s."""
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for damping in TRIED:
            file = pathlib.Path(folder) / "ring.json"
            file.write_text(json.dumps({**read_json(RING), "structural_damping": damping}))
            found.append(moment(*TARGET, file))
    return TRIED[0] + (moment(*TARGET, *SHELL) - found[0]) / (found[1] - found[0]) * (TRIED[1] - TRIED[0])


def main():
    if driver.options(__doc__, fit={"action": "store_true"}).parse_args().fit:
        print(f"structural_damping {fit():.4g} s")
        return
    made, rows = provenance.made_here(), []
    for load, speed in CASES:
        shell, ring = moment(load, speed, *SHELL), moment(load, speed, RING)
        rows.append({"load_kg": load, "speed_rad_s": str(speed), "shell_Nm": shell, "ring_Nm": ring,
                     "beside": f"{ring / shell - 1.0:.3f}", "used": (load, speed) == TARGET,
                     "structural_damping_s": str(read_json(RING)["structural_damping"])})
    driver.write("ring_rolling.csv", rows, made, told=True)


if __name__ == "__main__":
    main()
