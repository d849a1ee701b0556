"""What happened in a vehicle's run and when, its axles beside each other, and what a change of gear needs; from the
series alone.

usage: python3 -m furrow events DIR [--from T] [--to T] [--json]

Exit codes: 0 done, 2 the window holds no means, 5 a file could not be read.
"""
import argparse
import json
import math
import pathlib
import sys

from .plot import axles, events, gear_balance
from .plot.run_data import PROBLEMS, Missing, Run, in_words, printable
from .plot.vehicle_run import VehicleRun


def number(value):
    """JSON has neither infinity nor NaN."""
    return value if math.isfinite(value) else None


def balance_or_none(v):
    """(balance, why there is none)."""
    try:
        return gear_balance.balance(v), ""
    except Missing as reason:
        return None, str(reason)


def as_json(v, found, compared, balance):
    def of(statistics):
        return {"mean": number(statistics.mean), "sem": number(statistics.sem), "n_eff": number(statistics.n_eff),
                "drifts": statistics.drifts}

    names = compared.names
    means = {row.what: {"unit": row.unit, **{name: of(one) for name, one in zip(names, row.axles)},
                        **{f"{behind} - {before}": of(one) for before,
                           behind, one in zip(names, names[1:], row.differences)}}
             for row in compared.rows}
    for row in compared.rows:
        for name, note in zip(names, row.notes):
            if note:
                means[row.what][name]["leaves_out"] = note
    return {"events": [{"time_s": e.time, "event": e.what, "of": e.subject, "value": number(float(e.value)),
                        "unit": e.unit, "threshold": e.threshold} for e in found], "weight_N": v.weight,
            "axles": {"from_s": compared.begin, "to_s": compared.end, "window": compared.chosen,
                      "steady": not compared.unsteady, "unsteady_because": compared.unsteady,
                      "share_in_ruts": dict(zip(names, compared.in_ruts)), "means": means},
            "gear_balance": balance and {"shift_wheel_speed_m_per_s": balance.shift_speed,
                                         "limit_over_weight": number(balance.limit), "throttle": balance.throttle,
                                         "largest_wheel_speed_m_per_s": balance.reached, "at_s": balance.time,
                                         "gross_traction_over_weight": balance.gross,
                                         "torque_over_radius_and_weight": balance.torque, "changed": balance.changed,
                                         "verdict": balance.verdict}}


def tell(options):
    v = VehicleRun(Run(options.directory))
    for name, value in (("--from", options.begin), ("--to", options.end)):
        if value is not None and not 0.0 <= value <= v.time[-1]:
            print(f"furrow: error: command line: key '{name}': is {value:g} s, expected 0 to {v.time[-1]:g} s, the end "
                  "of the series", file=sys.stderr)
            return 2
    found = events.events(v)
    try:
        compared = axles.compare(v, options.begin, options.end)
    except Missing as reason:
        if options.begin is not None or options.end is not None:
            print(f"furrow: error: command line: key '--from': {reason}", file=sys.stderr)
            return 2
        compared, why = None, str(reason)
    balance, no_balance = balance_or_none(v)
    if options.json:
        empty = axles.Comparison([], 0.0, 0.0, why, [why], [], []) if compared is None else compared
        print(json.dumps(as_json(v, found, empty, balance), indent=2, ensure_ascii=False))
        return 0
    print(v.title + "\n")
    print(events.text(found))
    print(axles.text(compared) if compared else f"No means of the axles: {why}\n")
    print(gear_balance.text(balance) if balance else f"No balance of a change of gear: {no_balance}",
          end="" if balance else "\n")
    return 0


def main():
    parser = argparse.ArgumentParser(description="Events of a vehicle's run.")
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("--from", dest="begin", type=float, help="beginning of the means, s")
    parser.add_argument("--to", dest="end", type=float, help="their end, s")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    try:
        return tell(options)
    except PROBLEMS as error:
        print(f"furrow: error: {printable(options.directory)}: {in_words(error)}", file=sys.stderr)
    return 5
