"""Axle against axle: means over a stretch of the run in which they are steady enough, with their standard errors."""
import dataclasses
import math

import numpy as np

from . import events
from .digits import with_error
from .run_data import Missing
from .statistics import Statistics, statistics

# column of the wheels, what it is called, unit, factor, whether an axle has the sum of its wheels or their mean
QUANTITIES = [("iso_force_x_N", "net longitudinal force", "N", 1.0, True),
              ("tractive_effort_N", "tractive effort", "N", 1.0, True),
              ("terrain_resistance_N", "resistance", "N", 1.0, True),
              ("iso_force_z_N", "vertical load", "N", 1.0, True),
              ("spindle_torque_Nm", "torque at the spindles", "N m", 1.0, True),
              ("sinkage_m", "sinkage below the undisturbed surface", "mm", 1e3, False),
              ("sinkage_in_rut_m", "sinkage below the rut before", "mm", 1e3, False),
              ("slip", "slip", "–", 1.0, False)]
OF_SOIL = ("sinkage_m", "sinkage_in_rut_m", "terrain_resistance_N")
JUDGED = {"iso_force_x_N": 0.005, "sinkage_m": 0.02}  # a drift below this share, of load or of sinkage, is none
CANDIDATES, SHORTEST = 16, 0.5  # windows that are tried; s
LEAST_SAMPLES = 10.0
TURNS = 0.01  # in √(g R): a wheel whose circumference is slower stands or is locked, and has no slip


@dataclasses.dataclass
class Row:
    what: str
    unit: str
    axles: list  # Statistics by axle, from the front
    differences: list  # of each axle less the one before it
    notes: list = dataclasses.field(default_factory=list)  # by axle: what the mean leaves out; empty: nothing


@dataclasses.dataclass
class Comparison:
    names: list
    begin: float  # of the window, s
    end: float
    chosen: str  # how the window was found
    unsteady: list  # reasons; none: steady
    rows: list
    in_ruts: list  # share of the window that the axle's wheels roll in a rut, by axle; none on hard ground


def axle_series(v, axle, column, total):
    values = [wheel[column] for wheel in v.of_axle(axle)]
    return sum(values) if total else sum(values) / len(values)


def turning(v, axle):
    """Lines in which all wheels of an axle turn: the slip of others is not defined."""
    return np.all([np.abs(wheel["spin_rad_per_s"]) * wheel.radius >= TURNS * math.sqrt(events.GRAVITY * wheel.radius)
                   for wheel in v.of_axle(axle)], axis=0)


def still_note(v, axle, chosen):
    """How long wheels of an axle stand, or are locked while the vehicle moves; empty where all turn all the time."""
    still = chosen & ~turning(v, axle)
    if not still.any():
        return ""
    moves = np.any([np.abs(wheel["speed_m_per_s"]) >= TURNS * math.sqrt(events.GRAVITY * wheel.radius)
                    for wheel in v.of_axle(axle)], axis=0)
    shares = (("locked", (still & moves).sum() / chosen.sum()), ("standing", (still & ~moves).sum() / chosen.sum()))
    return ", ".join(f"{what} for {100 * share:.0f} % of the time" for what, share in shares if share > 0.0)


def slip_row(v, what, unit, chosen):
    """Means over the lines in which wheels turn."""
    turns = [chosen & turning(v, axle) for axle in v.order]
    slips = [axle_series(v, axle, "slip", False) for axle in v.order]
    return Row(what, unit, [statistics(slip[lines]) for slip, lines in zip(slips, turns)],
               [statistics((slips[k + 1] - slips[k])[turns[k + 1] & turns[k]]) for k in range(len(slips) - 1)],
               [still_note(v, axle, chosen) for axle in v.order])


def reasons(v, chosen):
    """Why means over these lines would not be found again."""
    found = []
    for column, small in JUDGED.items():
        if v.hard_ground and column == "sinkage_m":
            continue
        for axle in v.order:
            total = column != "sinkage_m"
            series = statistics(axle_series(v, axle, column, total)[chosen])
            load = sum(v.loads[wheel.index] for wheel in v.of_axle(axle))
            scale = small * (load if total else abs(series.mean))
            what = f"{v.axles[axle]} axle: " + ("net force" if total else "sinkage")
            if series.drifts and abs(series.change) > scale:
                change = f"{series.change:.3g} N" if total else f"{1e3 * series.change:.2g} mm"
                found.append(f"{what} drifts by {change} from the first to the second half")
            if total and series.n_eff < LEAST_SAMPLES and series.std > scale:
                found.append(f"{what} has {series.n_eff:.2g} independent samples, fewer than {LEAST_SAMPLES:.0f}")
    return found


def earliest(v):
    """When all axles roll in the ruts before them, or the vehicle moves at least, s; and which of the two."""
    touched = events.touch_downs(v)
    moved, _ = events.drive_off(v)
    if moved is None or None in touched:
        return None, ""
    begin = float(max(v.time[moved], max(v.time[at] for at in touched)))
    full = np.flatnonzero(v["throttle"] >= 0.99
                          * v["throttle"].max()) if "throttle" in v and v["throttle"].max() > 0.0 else []
    begin = max(begin, float(v.time[full[0]])) if len(full) else begin
    met = events.meetings(v, touched)
    if not v.hard_ground and len(met) == len(v.wheels) - 2 and met:
        last = max(met, key=lambda one: one[2])
        clear = events.first(last[0]["position_m"] >= last[0]["position_m"][last[2]] + 0.5 * last[0].radius)
        if clear is not None and v.time[-1] - v.time[clear] >= SHORTEST:
            return max(begin, float(v.time[clear])), "all axles behind are in the ruts"
    return begin, "the vehicle moves" + ("" if v.hard_ground
                                         else "; the axles behind have not rolled in the ruts for long")


def window(v, begin=None, end=None):
    """(from, to, how it was chosen): as asked for, or the longest stretch to the end of the run that is steady."""
    last = float(v.time[-1])
    if begin is not None or end is not None:
        begin = v.window[0] if begin is None and v.window else begin or float(v.time[0])
        return begin, last if end is None else end, "as asked for"
    first, why = earliest(v)
    if first is not None and last - first >= SHORTEST:
        for start in np.linspace(first, last - SHORTEST, CANDIDATES):
            if not reasons(v, v.time >= start):
                return float(start), last, f"the longest that is steady since {why}"
        if not v.window or first > v.window[0]:
            return first, last, f"since {why}"
    if v.window:
        return *v.window, "run.average_from to the end"
    raise Missing("the run is too short for means")


def compare(v, begin=None, end=None):
    begin, end, how = window(v, begin, end)
    chosen = (v.time >= begin) & (v.time <= end)
    if chosen.sum() < 4:
        raise Missing(f"there are {chosen.sum()} lines between {begin:g} and {end:g} s, too few for means")
    rows = []
    for column, what, unit, factor, total in QUANTITIES:
        if not all(column in wheel for wheel in v.wheels) or (v.hard_ground and column in OF_SOIL):
            continue
        if column == "slip":
            rows.append(slip_row(v, what, unit, chosen))
            continue
        series = [factor * axle_series(v, axle, column, total)[chosen] for axle in v.order]
        rows.append(Row(what, unit, [statistics(values) for values in series],
                        [statistics(behind - before) for before, behind in zip(series, series[1:])]))
    in_ruts = [float(np.mean([events.in_rut(wheel)[chosen].mean() for wheel in v.of_axle(axle)])) for axle in v.order]
    in_ruts = [] if v.hard_ground else in_ruts
    return Comparison([v.axles[axle] for axle in v.order], begin, end, how, reasons(v, chosen), rows, in_ruts)


def told(found: Statistics):
    if not math.isfinite(found.mean):
        return "not defined"
    return with_error(found.mean, found.sem) if math.isfinite(found.sem) else f"{found.mean:.4g}"


def text(c):
    """The comparison as lines for people."""
    names = c.names
    head = ["mean ± standard error", *(f"{name} axle" for name in names),
            *(f"{behind} − {before}" for before, behind in zip(names, names[1:]))]
    rows = [head] + [[f"{row.what}, {row.unit}" if row.unit != "–" else row.what,
                      *(told(found) for found in row.axles + row.differences)] for row in c.rows]
    if c.in_ruts:
        rows.append(["share of time in a rut", *(f"{100 * share:.0f} %" for share in c.in_ruts),
                     *[""] * (len(names) - 1)])
    widths = [max(len(row[i]) for row in rows) for i in range(len(head))]
    lines = [f"Axles from {c.begin:.3g} to {c.end:.3g} s ({c.chosen}); an axle has the sum of its wheels' forces"]
    lines += ["  ".join([f"{row[0]:<{widths[0]}}",
                         *(f"{cell:>{width}}" for cell, width in zip(row[1:], widths[1:]))]).rstrip()
              for row in rows]
    lines += [f"{row.what}, {name} axle: {note}; the mean leaves that out, a wheel that does not turn has no slip"
              for row in c.rows for name, note in zip(names, row.notes) if note]
    if c.unsteady:
        lines += ["NOT STEADY:", *(f"  {reason}" for reason in c.unsteady)]
    return "\n".join(lines) + "\n"
