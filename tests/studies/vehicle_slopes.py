#!/usr/bin/python3
"""Which slopes the HMMWV climbs on hard ground: go or no-go, its speed made good, and the steepest by bisection.

usage: vehicle_slopes.py [--results DIR] [--jobs N]      writes vehicle_slopes.csv beside this script

rigs/hmmwv_slope.json on rigid wheels: held by its brakes until 0.5 s, then full throttle to the end. Speed made good is
the way uphill from then on over the time; `speed at the end` is a mean over the last 0.5 s. It goes where it is further
up at the end than 1 s before; otherwise it stands with spinning wheels, or slides. Between the last slope that it
climbs and the first that it does not, bisection comes to 1 %.
"""
import concurrent.futures
import math
import pathlib
import sys

import numpy as np

import driver
import provenance

GRID = (0, 10, 20, 30, 40, 50, 60, 70, 80)  # per cent
BEGIN, END = 0.5, 5.0  # s
SET = {"tire.rigid": True, "run.step": 4e-4, "output.frame_interval": 0, "output.series_interval": 0.01, "run.end": END,
       "run.average_from": END - 1.0,
       "rig.driver": {"inputs": {"throttle": [[0, 0], [BEGIN, 0], [BEGIN + 0.2, 1]],
                                 "brake": [[0, 1], [BEGIN, 1], [BEGIN + 0.2, 0]]}}}
FINEST = 1.0  # per cent


def finished(results, percent):
    """The folder of the run on a slope; it is run unless this program has made it before."""
    words = [str(driver.ROOT / "rigs" / "hmmwv_slope.json"),
             *driver.settings(SET, {"rig.slope": math.atan(0.01 * percent)})]
    return driver.finished_case(f"{percent:g} %", words, results / f"{percent:g}_percent")


def line_of(folder, percent, how):
    v, *wheels = (driver.series(folder, name) for name in ("vehicle", "wheel0", "wheel1", "wheel2", "wheel3"))
    time, x = v["time_s"], v["x_m"]
    last = time > time[-1] - 0.5
    slip = [np.mean([np.mean(wheel["slip"][last]) for wheel in wheels[k:k + 2]]) for k in (0, 2)]
    made_good = (x[-1] - np.interp(BEGIN, time, x)) / (time[-1] - BEGIN)
    return {"slope_percent": f"{percent:g}", "go": "yes" if x[-1] > np.interp(time[-1] - 1.0, time, x) else "no",
            "speed_made_good_m_s": made_good, "speed_at_the_end_m_s": np.mean(v["speed_m_s"][last]),
            "gear_at_the_end": v["gear"][-1], "slip_front": slip[0], "slip_rear": slip[1], "found_by": how}


def main():
    arguments = driver.options(
        __doc__, jobs={"type": int, "default": 1, "help": "runs of the grid at a time"},
        results={"type": pathlib.Path, "default": driver.RESULTS / "vehicle_slopes"}).parse_args()
    arguments.results.mkdir(parents=True, exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        folders = dict(zip(GRID, pool.map(lambda percent: finished(arguments.results, percent), GRID)))
    lines = {percent: line_of(folder, percent, "grid") for percent, folder in folders.items()}
    goes = max(percent for percent in GRID if lines[percent]["go"] == "yes")
    stays = min(percent for percent in GRID if lines[percent]["go"] == "no")
    if goes > stays:
        sys.exit(f"it climbs {goes} % and not {stays} %, expected one limit")
    while stays - goes > FINEST:
        percent = 0.5 * (goes + stays)
        folders[percent] = finished(arguments.results, percent)
        lines[percent] = line_of(folders[percent], percent, "bisection")
        goes, stays = (percent, stays) if lines[percent]["go"] == "yes" else (goes, percent)
    driver.write("vehicle_slopes.csv", [lines[percent] for percent in sorted(lines)],
                 provenance.origin_of_runs(folders.values()) | {"command": "vehicle_slopes.py"}, digits=3, told=True)
    print(f"climbs {goes:g} %, not {stays:g} %")


if __name__ == "__main__":
    main()
