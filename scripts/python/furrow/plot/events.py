"""What happened in a vehicle's run and when: from its series alone, each event with the threshold that decides it."""
import dataclasses
import math

import numpy as np

from .vehicle_run import GRAVITY, running_mean

TOUCH = 0.02  # of the load at rest: below it a wheel carries nothing
LIFT = 0.02  # s that a wheel must carry nothing to count as lifted
SETTLED, SETTLED_FOR = 0.10, 0.25  # band about the weight; s that the sum of the vertical forces stays in it
PEDAL = 0.01  # of its way
SPEED, MOVES = 0.1, 0.2  # in √(g R); s: a vehicle that is faster for as long moves
RUT = 0.02  # in tire radii: a rut that is noticed
PITCH_SPAN = 0.25  # s before and after, over which mean pitches are compared
PITCH_SEARCH = (-0.4, 0.8)  # s about the meeting by position, where the change of pitch is looked for
PITCH_NOISE = 3.0  # such changes elsewhere, root mean square, that count as noise


@dataclasses.dataclass
class Event:
    time: float  # s
    what: str
    subject: str  # "vehicle", or a wheel's or an axle's name
    value: float  # what was found, in `unit`
    unit: str
    threshold: str  # how it was decided


def first(condition):
    """The first index at which it holds; None if there is none."""
    found = np.flatnonzero(condition)
    return int(found[0]) if len(found) else None


def stretches(condition):
    """[(first, one past the last)] of unbroken runs of truth."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], np.asarray(condition, int), [0]])))
    return list(zip(edges[::2], edges[1::2]))


def touch_downs(v):
    """Index of each wheel's first contact; None for a wheel without one."""
    return [first(wheel["force_z_N"] > TOUCH * load) for wheel, load in zip(v.wheels, v.loads)]


def contact_events(v, touched):
    for wheel, load, at in zip(v.wheels, v.loads, touched):
        if at is None:
            continue
        threshold = f"vertical force above {100 * TOUCH:.0f} % of the load at rest"
        yield Event(v.time[at], "touch-down", wheel.name, wheel["force_z_N"][at], "N", threshold)
        for begin, end in stretches(wheel["force_z_N"][at:] < TOUCH * load):
            begin, end = begin + at, end + at
            closes = v.time[min(end, len(v.time) - 1)]
            if closes - v.time[begin] >= LIFT:
                yield Event(v.time[begin], "wheel lifts", wheel.name, closes - v.time[begin], "s",
                            f"vertical force below {100 * TOUCH:.0f} % of the load for {LIFT:g} s or more; value: how "
                            f"long")


def settled_at(v, touched):
    """Index from which the ground carries the weight quietly; None if it does not come to that."""
    if None in touched:
        return None
    total = running_mean(v.time, sum(wheel["force_z_N"] for wheel in v.wheels))
    quiet = np.abs(total - v.weight) < SETTLED * v.weight
    quiet[:max(touched)] = False
    for begin, end in stretches(quiet):
        if v.time[end - 1] - v.time[begin] >= SETTLED_FOR:
            return int(begin)
    return None


def settling_events(v, touched):
    at = settled_at(v, touched)
    if at is not None:
        yield Event(v.time[at], "settled", "vehicle", 1e3 * v["z_m"][at], "mm",
                    f"sum of vertical forces (mean of 50 ms) stays within {100 * SETTLED:.0f} % of the weight for "
                    f"{SETTLED_FOR:g} s; value: height of the chassis' origin")


def pedal_events(v):
    for pedal in ("throttle", "brake"):
        if pedal not in v:
            continue
        values = v[pedal]
        for begin, end in stretches(values > PEDAL):
            if begin > 0 or values[0] <= PEDAL:
                yield Event(v.time[begin], f"{pedal} on", "vehicle", values[begin:end].max(), "",
                            f"{pedal} above {PEDAL:g}; value: its largest until it is off")
            if end < len(values):
                yield Event(v.time[end], f"{pedal} off", "vehicle", values[end], "", f"{pedal} below {PEDAL:g}")


def drive_off(v):
    """(index at which the vehicle moves, None if it does not; the speed that decides it)."""
    limit = SPEED * math.sqrt(GRAVITY * v.wheels[0].radius)
    for begin, end in stretches(np.abs(running_mean(v.time, v["speed_m_s"])) > limit):
        if v.time[end - 1] - v.time[begin] >= MOVES:
            return int(begin), limit
    return None, limit


def driving_events(v):
    at, limit = drive_off(v)
    if at is not None:
        yield Event(v.time[at], "drives off", "vehicle", v["speed_m_s"][at], "m/s",
                    f"speed (mean of 50 ms) above {SPEED:g} √(g R) = {limit:.2f} m/s for {MOVES:g} s")
    gear = v["gear"] if "gear" in v else np.zeros(0)
    for at in np.flatnonzero(np.diff(gear)) + 1:
        yield Event(v.time[at], f"gear {gear[at - 1]:.0f} to {gear[at]:.0f}", "vehicle", wheel_speed(v)[at], "m/s",
                    "column gear; value: mean ω R of the driven wheels")
    for begin, end in stretches(v["shifting"] > 0.0 if "shifting" in v else np.zeros(1)):
        if end < len(v.time):
            yield Event(v.time[end], "shift is done", "vehicle", v.time[end] - v.time[begin], "s",
                        "column shifting back to 0; value: how long it took")


def driven_wheels(v):
    """Those with a torque beside the brake's; all where there is none or it is not known."""
    return [wheel for wheel in v.wheels if "brake_torque_Nm" in wheel
            and np.any(wheel["spindle_torque_Nm"] != wheel["brake_torque_Nm"])] or v.wheels


def wheel_speed(v):
    """Mean circumferential speed of the driven wheels, m/s."""
    driven = driven_wheels(v)
    return sum(wheel["spin_rad_per_s"] * wheel.radius for wheel in driven) / len(driven)


def meetings(v, touched):
    """[(axle behind, axle before, index)]: each axle but the first reaches the place where the one before it came
    down."""
    found = []
    for before, behind in zip(v.order, v.order[1:]):
        for leading, following in zip(v.of_axle(before), v.of_axle(behind)):
            at = touched[leading.index]
            if at is None:
                continue
            reached = first(following["position_m"] >= leading["position_m"][at])
            if reached is not None:
                found.append((following, leading, reached))
    return found


def in_rut(wheel):
    """When it rolls where another wheel has left a rut that is noticed."""
    if "sinkage_in_rut_m" not in wheel:
        return np.zeros(len(wheel["sinkage_m"]), bool)
    return wheel["sinkage_m"] - wheel["sinkage_in_rut_m"] > RUT * wheel.radius


def rut_events(v, touched):
    met = meetings(v, touched)
    for following, leading, at in met:
        yield Event(v.time[at], "reaches the place of touch-down", following.name, following["position_m"][at], "m",
                    "position at or beyond that of the wheel before it when that touched down")
        begin = first(in_rut(following))
        if begin is not None:
            depth = following["sinkage_m"][begin] - following["sinkage_in_rut_m"][begin]
            yield Event(v.time[begin], "rolls in a rut", following.name, 1e3 * depth, "mm",
                        f"a rut deeper than {1e3 * RUT * following.radius:.1f} mm ({RUT:g} R) under it; value: that "
                        f"rut's depth")
    yield from pitch_events(v, met)


def pitch_change(v):
    """Mean pitch of the next PITCH_SPAN less that of the last one, rad; NaN near the ends."""
    step = float(np.median(np.diff(v.time)))
    half = max(int(round(PITCH_SPAN / step)), 1)
    total = np.concatenate([[0.0], np.cumsum(v["pitch_rad"])])
    change = np.full(len(v.time), np.nan)
    index = np.arange(half, len(v.time) - half)
    change[index] = (total[index + half] - 2.0 * total[index] + total[index - half]) / half
    return change


def pitch_events(v, met):
    """The change of pitch that is steepest near the meeting, if it rises above those of other times since driving
    off."""
    moved, _ = drive_off(v)
    if not met or moved is None or len(v.time) < 10:
        return
    change = pitch_change(v)
    seen = set()
    for following, leading, at in met:
        if following.axle in seen:
            continue
        seen.add(following.axle)
        near = (v.time >= v.time[at] + PITCH_SEARCH[0]) & (v.time <= v.time[at] + PITCH_SEARCH[1]) & np.isfinite(change)
        elsewhere = ~near & np.isfinite(change) & (v.time > v.time[moved] + PITCH_SPAN)
        if not near.any() or elsewhere.sum() < 10:
            continue
        here = int(np.argmax(np.where(near, np.abs(change), -1.0)))
        noise = float(np.sqrt(np.mean(change[elsewhere] ** 2)))
        seen_it = abs(change[here]) > PITCH_NOISE * noise
        yield Event(v.time[here], "pitch changes" if seen_it else "pitch changes (not above its noise)",
                    f"{v.axles[following.axle]} axle", math.degrees(change[here]), "°",
                    f"steepest within {PITCH_SEARCH[0]:g} to {PITCH_SEARCH[1]:g} s of the axle's meeting; value: mean "
                    f"of {PITCH_SPAN:g} s after less that before, nose down positive; elsewhere "
                    f"{math.degrees(noise):.2g}° (rms)")


def sinkage_events(v, touched):
    for wheel, at in zip(v.wheels, touched):
        if at is None or not wheel["sinkage_m"].max() > 0.0:
            continue
        deepest = int(np.argmax(wheel["sinkage_m"]))
        yield Event(v.time[deepest], "largest sinkage", wheel.name, 1e3 * wheel["sinkage_m"][deepest], "mm",
                    "maximum of sinkage_m, below the undisturbed surface")
        inside = in_rut(wheel)
        if inside.any():
            deepest = int(np.argmax(np.where(inside, wheel["sinkage_in_rut_m"], -np.inf)))
            yield Event(v.time[deepest], "largest sinkage in a rut", wheel.name,
                        1e3 * wheel["sinkage_in_rut_m"][deepest], "mm",
                        "maximum of sinkage_in_rut_m, below the rut's bottom, while it rolls in one")


def path_events(v):
    if "cross_track_error_m" in v and np.abs(v["cross_track_error_m"]).max() > 0.0:
        at = int(np.argmax(np.abs(v["cross_track_error_m"])))
        yield Event(v.time[at], "largest error across the path", "vehicle", v["cross_track_error_m"][at], "m",
                    "maximum of |cross_track_error_m|")


def end_event(v):
    end = (v.run.scenario.get("run") or {}).get("end")
    last = v.time[-1]
    interval = float(np.median(np.diff(v.time))) if len(v.time) > 1 else 0.0
    early = end is not None and last < end - 1.5 * interval
    distance = v["distance_m"][-1]
    yield Event(last, f"ends before run.end = {end:g} s" if early else "end", "vehicle", distance, "m",
                "last line; value: distance driven")


def events(v):
    """All events, in order of time."""
    touched = touch_downs(v)
    found = [*contact_events(v, touched), *settling_events(v, touched), *pedal_events(v), *driving_events(v),
             *path_events(v), *end_event(v)]
    if not v.hard_ground:
        found += [*rut_events(v, touched), *sinkage_events(v, touched)]
    return sorted(found, key=lambda event: event.time)


def significant(value):
    """Three significant digits without an exponent."""
    if not math.isfinite(value) or value == 0.0:
        return f"{value:g}"
    return f"{value:.{min(max(2 - math.floor(math.log10(abs(value))), 0), 6)}f}"


def text(found):
    """The events as lines for people, and below them how each kind was decided."""
    rows = [("time, s", "event", "of", "value")]
    rows += [(f"{e.time:.3f}", e.what, e.subject, f"{significant(e.value)} {e.unit}".rstrip()) for e in found]
    widths = [max(len(row[i]) for row in rows) for i in range(4)]
    lines = [f"{row[0]:>{widths[0]}}  {row[1]:<{widths[1]}}  {row[2]:<{widths[2]}}  {row[3]:>{widths[3]}}"
             for row in rows]
    kinds = dict(sorted((e.what, e.threshold) for e in found))
    return "\n".join([*lines, "", *(f"{what}: {threshold}" for what, threshold in kinds.items())]) + "\n"
