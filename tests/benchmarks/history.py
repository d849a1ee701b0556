#!/usr/bin/python3
"""Adds a row to history.csv: how fast this commit is, beside the peers in the same run.

usage: history.py MILESTONE [--rounds 3] [--out history.csv]

Nothing else may run meanwhile; it takes some ten minutes, and more until the beds are in the cache. On two threads and
one bed, in turn, medians over rounds: `furrow bench grains` with the law mindlin in mixed and double precision and
LAMMPS, with hertz_tanh and LIGGGHTS, each with and without cohesion, then `furrow bench tire` and `furrow bench rig`. A
quick soil test and the ring pressed on a cleat are timed once. A peer that is not installed leaves its columns empty.
The other options make a row quickly, to try the script.
"""
import datetime
import json
import pathlib
import shutil
import statistics
import sys
import tempfile

import grains_and_peers as peers

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "studies"))
import driver  # noqa: E402
import provenance  # noqa: E402

THREADS = 2
CASES = {"mindlin": "furrow mindlin", "lammps": "LAMMPS gran/hertz/history",
         "mindlin_double": "furrow mindlin, double precision", "hertz_tanh": "furrow hertz_tanh, cohesion 80 kPa",
         "liggghts": "LIGGGHTS hertz/no_history", "hertz_tanh_free": "furrow hertz_tanh",
         "liggghts_sjkr2": "LIGGGHTS hertz/no_history, sjkr2"}
OVER = (("mindlin", "lammps"), ("mindlin_double", "lammps"), ("hertz_tanh", "liggghts"),
        ("hertz_tanh_free", "liggghts"), ("hertz_tanh", "liggghts_sjkr2"))
RING = ("--set", "tire.file=hmmwv_ring.json", "--set", "tire.elements_circumference=null",
        "--set", "tire.elements_width=null")


def is_here(case):
    return case not in peers.PEERS or shutil.which(peers.PEERS[case][0])


def grains(given, folder, rounds, steps):
    """The columns of grains, on this bed."""
    bed = folder / "bed.csv"
    peers.bench_grains(given, "mindlin", THREADS, 1, 1, "--save-bed", bed)
    peers.settle(bed, THREADS, folder)
    done = {name: [] for name, case in CASES.items() if is_here(case)}
    for _ in range(rounds):
        for name, of in done.items():
            of.append(peers.measure(CASES[name], THREADS, steps, folder))
    speed = {name: statistics.median(one["grain_steps_per_s"] for one in of) for name, of in done.items()}
    return {**{f"{name}_grain_steps_per_s": speed.get(name) for name in CASES},
            **{f"{ours}_over_{theirs}": speed[ours] / speed[theirs] if theirs in speed else None
               for ours, theirs in OVER},
            "bytes_per_grain": done["mindlin"][0]["bytes_per_grain"]}


def medians(rounds, keys, *words):
    """{column: median over rounds} of keys of what a benchmark prints."""
    printed = [json.loads(driver.furrow("bench", *words)) for _ in range(rounds)]
    return {column: statistics.median(driver.value_of(one, key) for one in printed) for column, key in keys.items()}


def main():
    parser = driver.options(
        __doc__, bed={"default": "default"}, rounds={"type": int, "default": 3}, steps={"type": int, "default": 1000},
        rig={"default": "drawbar_pull.json"}, rig_steps={"type": int, "default": 2000},
        rig_warm={"type": float, "default": 0.2},
        out={"type": pathlib.Path, "default": pathlib.Path(__file__).resolve().with_suffix(".csv")})
    parser.add_argument("milestone")
    arguments = parser.parse_args()
    made, rounds = provenance.made_here(), arguments.rounds
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        row = {"date": datetime.date.today().isoformat(), "commit": made["commit"], "milestone": arguments.milestone,
               "compiler": made["compiler"], "processor": made["processor"], "threads": THREADS,
               **grains(arguments.bed, folder, rounds, arguments.steps),
               **medians(rounds, {"tire_ms_per_step": "ms_per_step"}, "tire"),
               **medians(rounds, {"rig_s_per_simulated_s": "s_per_simulated_s", "rig_terrain_ms": "terrain_ms",
                                  "rig_tire_ms": "tire_ms", "rig_slower_of_both_ms": "slower_of_both_ms",
                                  "rig_p99_ms": "p99_ms", "rig_awake_share": "awake_share",
                                  "rig_tire_waiting_share": "waiting_share.tire 0"}, "rig", "--scenario",
                         arguments.rig, "--steps", arguments.rig_steps, "--warm", arguments.rig_warm)}
        for column, words in (("soil_quick_s", ("soil", "drawbar_pull_small_report_soil.json", "--quick")),
                              ("ring_press_s", ("press", "cleat_press.json", *RING))):
            row[column] = driver.timed(*words, "--out", folder / column, "--quiet")[2]
    before = provenance.read_table(arguments.out) if arguments.out.exists() else []
    driver.write(arguments.out.resolve(), [*before, row], made | {"note": "commit, compiler and processor of each row "
                                                                 "are its own"})
    print("\n".join(f"{key} {driver.short(value)}" for key, value in row.items()))


if __name__ == "__main__":
    main()
