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
import statistics
import sys

import provenance
from provenance import ROOT, read_origin, read_table

sys.path.insert(0, str(ROOT / "scripts"))
from plot import axles, events  # noqa: E402
from plot.run_data import Run  # noqa: E402
from plot.student import half_interval  # noqa: E402
from plot.vehicle_run import VehicleRun  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
STUDY = pathlib.Path(__file__).with_suffix(".json")
FIRST = HERE / "vehicle_straight_axles.csv", HERE / "vehicle_straight_events.csv"
CASE = "lumped"
EVENTS = ("settled", "drives off", "pitch changes", "gear 1 to 2", "ends before run.end = 5.2 s")


def first_bed():
    """(window, {(axle, quantity): mean}, {event: time}) of the committed tables."""
    means, window = {}, None
    for row in read_table(FIRST[0]):
        if row["case"] != CASE:
            continue
        window = float(row["from_s"]), float(row["to_s"]), row["steady"] == "True"
        unit = row["unit"]
        for axle, column in (("front", "front"), ("rear", "rear"), ("rear less front", "rear_less_the_one_before")):
            means[axle, row["quantity"], unit] = float(row[column])
    return window, means, {row["event"]: float(row["time_s"]) for row in read_table(FIRST[1])
                           if row["case"] == CASE and row["event"] in EVENTS}


def of_run(folder):
    v = VehicleRun(Run(folder))
    compared, means = axles.compare(v), {}
    for row in compared.rows:
        for name, one in (("front", row.axles[0]), ("rear", row.axles[1]), ("rear less front", row.differences[0])):
            means[name, row.what, row.unit] = one.mean
    times = {event.what: event.time for event in events.events(v) if event.what in EVENTS}
    return (compared.begin, compared.end, not compared.unsteady), means, times


def over_beds(values):
    """{column: text} of the beds, their mean and its interval."""
    found = {f"bed_{k + 1}": f"{value:.5g}" for k, value in enumerate(values)}
    return found | {"mean": f"{statistics.mean(values):.5g}", "half_interval_95": f"{half_interval(values):.3g}"}


def main():
    results = ROOT / "results" / "studies" / STUDY.stem
    folders = [results / case for case in json.loads(STUDY.read_text())["cases"]
               if (results / case / "summary.json").exists()]
    if not folders:
        raise SystemExit(f"{results}: holds no finished case, expected those of run_study.py {STUDY.name}")
    beds = [first_bed(), *map(of_run, folders)]
    origin = provenance.origin_of_runs(folders)
    first = read_origin(FIRST[0])
    origin["note"] = f"bed 1 is of {first['commit']}; steady from " + "; ".join(
        f"{window[0]:.3g} to {window[1]:.3g} s{'' if window[2] else ' (not steady)'}" for window, _, _ in beds)
    rows = [{"axle": key[0], "quantity": key[1], "unit": key[2], **over_beds([means[key] for _, means, _ in beds])}
            for key in beds[0][1]]
    provenance.write_table(STUDY.with_name(f"{STUDY.stem}_axles.csv"), list(rows[0]), rows, origin)
    rows = [{"event": what, "unit": "s", **over_beds([times[what] for _, _, times in beds])} for what in EVENTS
            if all(what in times for _, _, times in beds)]
    provenance.write_table(STUDY.with_name(f"{STUDY.stem}_events.csv"), list(rows[0]), rows, origin)
    for name in ("axles", "events"):
        print((STUDY.with_name(f"{STUDY.stem}_{name}.csv")).read_text(), file=sys.stderr)


if __name__ == "__main__":
    main()
