#!/usr/bin/python3
"""The HMMWV at full size on several beds: axle means and events of each, and their mean with half of the 95 % interval.

    /usr/bin/python3 tests/studies/run_study.py tests/studies/vehicle_straight_beds.json
    /usr/bin/python3 tests/studies/vehicle_straight_beds.py

Bed 1 is the case `lumped` of vehicle_straight.json, from its committed tables, vehicle_straight_axles.csv and
vehicle_straight_events.csv; the commit of each bed stands beside it. Writes beside this script
vehicle_straight_beds_axles.csv: of every axle, and of the rear less the front one, the mean of each bed over its own
steady stretch, and over the beds the mean and half of its 95 % interval [Student's t]; and
vehicle_straight_beds_events.csv: when the events that every bed has came, likewise.
"""
import json
import pathlib

import driver
import provenance
from furrow.plot import axles, events
from furrow.plot.run_data import Run
from furrow.plot.vehicle_run import VehicleRun

STUDY = pathlib.Path(__file__).with_suffix(".json")
AXLES, EVENTS_OF_FIRST = (driver.HERE / f"vehicle_straight_{name}.csv" for name in ("axles", "events"))
CASE = "lumped"
EVENTS = ("settled", "drives off", "pitch changes", "gear 1 to 2", "ends before run.end = 5.2 s")


def first_bed():
    """(window, {(axle, quantity): mean}, {event: time}) of the committed tables."""
    rows, events_of = ([row for row in provenance.read_table(file) if row["case"] == CASE]
                       for file in (AXLES, EVENTS_OF_FIRST))
    means = {(axle, row["quantity"], row["unit"]): float(row[column]) for row in rows for axle, column in
             (("front", "front"), ("rear", "rear"), ("rear less front", "rear_less_the_one_before"))}
    window = float(rows[-1]["from_s"]), float(rows[-1]["to_s"]), rows[-1]["steady"] == "True"
    return window, means, {row["event"]: float(row["time_s"]) for row in events_of if row["event"] in EVENTS}


def of_run(folder):
    v = VehicleRun(Run(folder))
    compared = axles.compare(v)
    means = {(name, row.what, row.unit): one.mean for row in compared.rows for name, one in
             (("front", row.axles[0]), ("rear", row.axles[1]), ("rear less front", row.differences[0]))}
    times = {event.what: event.time for event in events.events(v) if event.what in EVENTS}
    return (compared.begin, compared.end, not compared.unsteady), means, times


def over_beds(values):
    """{column: text} of the beds, their mean and its interval."""
    mean, half = driver.over_beds(values)
    return {f"bed_{k}": value for k, value in enumerate(values, 1)} | {"mean": mean, "half_interval_95": f"{half:.3g}"}


def main():
    results = driver.options(__doc__, results={"type": pathlib.Path, "default": driver.RESULTS / STUDY.stem})
    folders = driver.finished_runs(results.parse_args().results, json.loads(STUDY.read_text())["cases"]).values()
    beds = [first_bed(), *map(of_run, folders)]
    origin = provenance.origin_of_runs(folders)
    origin["note"] = f"bed 1 is of {provenance.read_origin(AXLES)['commit']}; steady from " + "; ".join(
        f"{begin:.3g} to {end:.3g} s{'' if steady else ' (not steady)'}" for (begin, end, steady), _, _ in beds)
    rows = [{"axle": key[0], "quantity": key[1], "unit": key[2], **over_beds([means[key] for _, means, _ in beds])}
            for key in beds[0][1]]
    driver.write(f"{STUDY.stem}_axles.csv", rows, origin, 5, told=True)
    rows = [{"event": what, "unit": "s", **over_beds([times[what] for _, _, times in beds])} for what in EVENTS
            if all(what in times for _, _, times in beds)]
    driver.write(f"{STUDY.stem}_events.csv", rows, origin, 5, told=True)


if __name__ == "__main__":
    main()
