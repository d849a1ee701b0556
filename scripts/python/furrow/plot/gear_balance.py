"""What a change of gear needs: the traction that the wheels still take must fall below what engine and gears still give
at the speed of the change. Both as shares of the weight against the circumferential speed of the wheels."""
import dataclasses

import numpy as np

from .events import wheel_speed
from .run_data import Damaged, Missing
from .vehicle_run import running_mean

RPM = np.pi / 30.0
WIDTH = 0.1  # s, of running means
BLEND = 0.02  # about speed ratio 1, as vehicle/driveline/torque_converter.hpp has it


def pairs(value, name):
    """A table's arguments and values."""
    found = np.array(value, float) if isinstance(value, list) else np.zeros(0)
    if found.ndim != 2 or found.shape[1] != 2 or not np.isfinite(found).all():
        raise Damaged(f"the vehicle's {name} is no table of pairs")
    return found[:, 0], found[:, 1]


@dataclasses.dataclass
class Driveline:
    """Of the lowest gear: what the wheels get at full or part throttle against their speed."""
    engine: dict
    converter: dict
    ratio: float  # wheel over turbine
    shift: float  # turbine speed at which it changes up, rad/s

    def engine_torque(self, crank, throttle):
        full, losses = (pairs(self.engine[key], key) for key in ("torque", "losses"))
        return throttle * np.interp(crank / RPM, *full) + np.interp(crank / RPM, *losses)

    def converter_torque(self, crank, turbine):
        """(impeller, turbine)."""
        ratio = turbine / crank
        capacity, gain = (pairs(self.converter[name], name) for name in ("capacity", "torque_ratio"))
        low = min(ratio, 1.0 - BLEND)
        if ratio <= 1.0 - BLEND:
            taken = (crank / np.interp(ratio, *capacity)) ** 2
            return taken, taken * np.interp(ratio, *gain)
        if ratio <= 1.0:  # a straight line to zero
            taken = (crank / np.interp(low, *capacity)) ** 2 * (1.0 - ratio) / BLEND
            return taken, taken * np.interp(ratio, *gain)
        high = max(ratio, 1.0 + BLEND)
        taken = (turbine / np.interp(1.0 / high, *capacity)) ** 2 * min((ratio - 1.0) / BLEND, 1.0)
        return -taken, -taken

    def wheel_torque(self, wheel, throttle):
        """On all wheels together at their speed, rad/s, in steady running, N m."""
        turbine = wheel / self.ratio
        top = 1.2 * RPM * max(pairs(self.engine["torque"], "torque")[0])
        low, high = 1.0, max(top, 2.0 * turbine)
        for _ in range(60):  # the engine's torque less the converter's falls with the crank's speed
            crank = 0.5 * (low + high)
            if self.engine_torque(crank, throttle) > self.converter_torque(crank, turbine)[0]:
                low = crank
            else:
                high = crank
        return self.converter_torque(crank, turbine)[1] / self.ratio


def to_wheels(driveline, shaft, seen=()):
    """Ratio of a wheel's speed to that of `shaft`, along gears and through boxes of differentials; None: no way."""
    if shaft in seen:
        return None
    if any(wheel["shaft"] == shaft for wheel in driveline.get("wheels", [])):
        return 1.0
    ways = [(gear["out"], gear["ratio"]) for gear in driveline.get("gears", []) if gear["in"] == shaft]
    ways += [(out, 1.0) for one in driveline.get("differentials", []) if one["box"] == shaft for out in one["outputs"]]
    for out, ratio in ways:
        rest = to_wheels(driveline, out, (*seen, shaft))
        if rest is not None:
            return ratio * rest
    return None


def driveline(v):
    """Of the vehicle's file; Missing where it has no engine with converter and gearbox."""
    found = v.data.get("driveline")
    if not found or not all(found.get(key) for key in ("engine", "converter", "gearbox")):
        raise Missing("the vehicle's file is not found or has no engine with converter and gearbox")
    gearbox = found["gearbox"]
    if len(gearbox["ratios"]) < 2 or gearbox["in"] != found["converter"]["out"]:
        raise Missing("the gearbox has one gear only or does not follow the converter")
    rest = to_wheels(found, gearbox["out"])
    if not rest or "up_rpm" not in gearbox:
        raise Missing("the driveline has no way from gearbox to wheels, or its gears are not changed by speed")
    return Driveline(found["engine"], found["converter"], gearbox["ratios"][0] * rest, gearbox["up_rpm"] * RPM)


@dataclasses.dataclass
class Balance:
    shift_speed: float  # of the wheels at which the gearbox changes up, m/s
    limit: float  # traction over weight that engine and gears give there
    throttle: float
    reached: float  # largest wheel speed in the lowest gear, m/s
    time: float  # of it, s
    torque: float  # torque at the wheels over radius and weight then
    gross: float  # tractive effort over weight then
    changed: bool  # the first gear was left upward

    @property
    def verdict(self):
        if self.changed:
            return f"the gear was changed, gross traction {self.gross:.3f} beside {self.limit:.3f}"
        if self.gross < self.limit:
            return (f"gross traction {self.gross:.3f} is below {self.limit:.3f}: the wheels gain speed, but the run "
                    f"ends before the change")
        return f"gross traction {self.gross:.3f} is above {self.limit:.3f}: at this traction no change of gear comes"


def demand(v):
    """(wheel speed, torque over radius and weight, tractive effort over weight) against time, running means."""
    torque = sum(wheel["spindle_torque_Nm"] / wheel.radius for wheel in v.wheels) / v.weight
    gross = sum(wheel["tractive_effort_N"] for wheel in v.wheels) / v.weight
    return tuple(running_mean(v.time, values, WIDTH) for values in (wheel_speed(v), torque, gross))


def balance(v):
    line = driveline(v)
    radius = sum(wheel.radius for wheel in v.wheels) / len(v.wheels)
    speed, torque, gross = demand(v)
    throttle = float(v["throttle"].max())
    if not throttle > 0.0:
        raise Missing("the throttle stays closed")
    lowest = v["gear"] == 1
    up = np.flatnonzero((v["gear"][:-1] == 1) & (v["gear"][1:] > 1))
    lowest[up[0] + 1 if len(up) else len(lowest):] = False
    if not lowest.any():
        raise Missing("the lowest gear is not used")
    at = int(np.argmax(np.where(lowest, speed, -np.inf)))
    shift = line.shift * line.ratio * radius
    return Balance(shift, line.wheel_torque(shift / radius, throttle) / radius / v.weight, throttle, float(speed[at]),
                   float(v.time[at]), float(torque[at]), float(gross[at]), bool(len(up)))


def text(b):
    return (f"Change of gear: at {b.shift_speed:.2f} m/s of the wheels (ω R), where engine and gears give "
            f"{b.limit:.3f} of the weight "
            f"at throttle {b.throttle:.2g}\n"
            f"  largest wheel speed in the lowest gear {b.reached:.2f} m/s at {b.time:.3f} s; there gross traction "
            f"{b.gross:.3f}, "
            f"torque over radius {b.torque:.3f} of the weight\n"
            f"  {b.verdict}\n")
