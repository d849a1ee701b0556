#!/usr/bin/python3
"""Quarter car and half car on a road of random heights beside the closed forms of vehicle/analysis/quarter_car.hpp and
half_car.hpp on the very same heights. Writes ride_transfer.csv (transfer functions), ride_transfer_figures.csv (errors)
and ride_transfer.png beside this script.

usage: ride_transfer.py [--finished]

With --finished nothing is computed but what is derived of runs that are there.

The road has the density of class B of ISO 8608, waves from 0.35 to 30 m, corners every 50 mm. The tire is the planar
one of rigs/rough_road.json, once held rigid (`tire.rigid`) and once as it is. The linear model of the rigid wheel has
no value that is fitted: on ground of the stiffness κ and damping d per area, with the radius R and the width b,
    F = (4/3) κ b √(2R) δ^1.5,   k_t = 3 F/(2 δ),   c_t = d b 2a,   a = √(2 R δ),
and its road is the mean height over the contact patch, from −a to a: each point of the patch bears κ times its depth.
The model of the elastic tire has its static stiffness at the load (`furrow press` on a plate) and the damper of
curb.py; its road is taken under the centre, and as the mean over the static footprint.

Two ways lead from (1) of the closed form to the body's acceleration: the heights' Fourier transform times the transfer
function, and integration in time (Runge and Kutta). Errors are the rms difference of run and model over the rms of the
run, of what lies below 20 Hz, from 1.5 s after the road begins.
"""
import numpy as np

import driver
from furrow.plot import style
import provenance
from cleat_roll import stiffness_of
from curb import TIRE_DAMPER
from furrow.plot.ride_values import ride_values

RESULTS = driver.RESULTS / "ride_transfer"
GRAVITY = 9.80665
SPEED, ROAD_FROM, ROAD_LENGTH, SPACING = 10.0, 8.0, 60.0, 0.05  # m/s, m
END = (ROAD_FROM + ROAD_LENGTH + 3.3 + 4.0) / SPEED  # s
BODY, UNSPRUNG, RIM, SUSPENSION, DAMPER = 1290.0, 1.0, 150.0, 115e3, 7.5e3  # of a quarter: kg, N/m, N s/m
WHEELBASE, PITCH_INERTIA = 3.3, 4200.0  # m, kg m²
# of tire and the ground under the rigid wheel: m, N/m³, N s/m³
RADIUS, WIDTH, STIFFNESS, DAMPING = 0.522, 1.0, 2e7, 1e4
BAND = 20.0  # Hz
SETTLED = 1.5  # s on the road, by when the body has forgotten that it was let down


def road():
    """Heights z (m) at x (m), level at both ends."""
    x = ROAD_FROM + SPACING * np.arange(int(ROAD_LENGTH / SPACING) + 1)
    draw = np.random.default_rng(8608)
    edges = np.geomspace(1.0 / 30.0, 1.0 / 0.35, 201)
    variance = 64e-6 * 0.1 ** 2 * (1.0 / edges[:-1] - 1.0 / edges[1:])
    waves = np.sqrt(edges[1:] * edges[:-1])
    z = sum(np.sqrt(2.0 * v) * np.cos(2.0 * np.pi * (n * x + draw.random())) for v, n in zip(variance, waves))
    ease = np.clip(np.minimum(x - x[0], x[-1] - x) / 5.0, 0.0, 1.0)
    return x, z * ease * ease * (3.0 - 2.0 * ease)


def scenario(kind, rigid):
    rig = {"type": kind, "speed": SPEED, "ramp": 0, "touchdown_time": 0.45, "suspension_stiffness": SUSPENSION,
           "suspension_damping": DAMPER, "unsprung_mass": UNSPRUNG, "rim_mass": RIM}
    rig |= {"body_mass": BODY} if kind == "quarter_car" else {
        "body_mass": 2 * BODY, "wheelbase": WHEELBASE, "pitch_inertia": PITCH_INERTIA}
    tire = {"file": "aligator_planar.json", "rigid": rigid, **({"elements_circumference": 240} if rigid else {})}
    return {
        "format_version": 1, "rig": rig, "tire": tire,
        "terrain": {"engine": "rigid", "friction": 0.8, "friction_velocity_scale": 20,
                    "profile_file": str(RESULTS / "road.csv"),
                    "ground_stiffness": STIFFNESS if rigid else 1e8, "ground_shear_stiffness": 5e6 if rigid else 2.5e7,
                    "ground_damping": DAMPING},
        "run": {"step": 1e-4 if rigid else 4e-5, "end": round(END, 3), "average_from": 0.75},
        "output": {"series_interval": 1e-3, "frame_interval": 0},
    }


class Linear:
    """(1) of half_car.hpp or quarter_car.hpp: M q̈ + C q̇ + K q = k_t r + c_t ṙ of each wheel."""

    def __init__(self, kind, wheel_mass, tire_stiffness, tire_damping):
        half = 0.5 * WHEELBASE
        masses, rows = (([BODY, wheel_mass], [[-1.0, 1.0]]) if kind == "quarter_car" else
                        ([2 * BODY, PITCH_INERTIA, wheel_mass, wheel_mass],
                         [[-1.0, half, 1.0, 0.0], [-1.0, -half, 0.0, 1.0]]))
        self.mass, self.tire = np.diag(masses), (tire_stiffness, tire_damping)
        self.push = np.eye(len(masses))[:, -len(rows):]  # the wheels are the last coordinates
        struts, wheels = sum(np.outer(row, row) for row in rows), self.push @ self.push.T
        self.spring = SUSPENSION * struts + tire_stiffness * wheels
        self.damper = DAMPER * struts + tire_damping * wheels

    def transfer(self, frequency):
        """q of each wheel's road of amplitude 1, frequency × coordinate × wheel."""
        omega = 2.0 * np.pi * np.asarray(frequency)[:, None, None]
        dynamic = self.spring - omega ** 2 * self.mass + 1j * omega * self.damper
        return np.linalg.solve(dynamic, np.broadcast_to(self.push, (len(omega), *self.push.shape))
                               * (self.tire[0] + 1j * omega * self.tire[1]))

    def by_frequency(self, step, heights):
        """q̈ over time on heights[wheel, time], which begin and end at 0."""
        count = 2 * heights.shape[1]
        frequency = np.fft.rfftfreq(count, step)
        q = np.einsum("fqw,wf->qf", self.transfer(frequency), np.fft.rfft(heights, count))
        return np.fft.irfft(-(2.0 * np.pi * frequency) ** 2 * q, count)[:, :heights.shape[1]]

    def by_time(self, step, heights, split=8):
        """The same by Runge and Kutta's rule, heights straight between the values."""
        size, h = len(self.mass), step / split
        inverse = np.linalg.inv(self.mass)
        state, out = np.zeros(2 * size), np.zeros((size, heights.shape[1]))

        def slope(s, r, rate):
            return np.concatenate([s[size:], inverse @ (self.push @ (self.tire[0] * r + self.tire[1] * rate)
                                                        - self.damper @ s[size:] - self.spring @ s[:size])])
        for k in range(heights.shape[1] - 1):
            rate = (heights[:, k + 1] - heights[:, k]) / step
            before = state[size:].copy()
            for i in range(split):
                r = heights[:, k] + rate * i * h
                a = slope(state, r, rate)
                b = slope(state + 0.5 * h * a, r + 0.5 * h * rate, rate)
                c = slope(state + 0.5 * h * b, r + 0.5 * h * rate, rate)
                d = slope(state + h * c, r + h * rate, rate)
                state = state + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
            out[:, k + 1] = (state[size:] - before) / step  # mean of the interval, as of the run
        return out


def below(step, values, limit=BAND):
    spectrum = np.fft.rfft(values)
    spectrum[np.fft.rfftfreq(len(values), step) > limit] = 0.0
    return np.fft.irfft(spectrum, len(values))


def patch_mean(x, z, half):
    """Mean height within ±half of a place, as a function of it."""
    grid = np.arange(x[0] - 2.0, x[-1] + 2.0, 1e-3)
    height = np.interp(grid, x, z, left=0.0, right=0.0)
    if half < 1e-3:
        return lambda at: np.interp(at, x, z, left=0.0, right=0.0)
    total = np.concatenate([[0.0], np.cumsum(0.5 * (height[1:] + height[:-1]) * 1e-3)])
    return lambda at: (np.interp(at + half, grid, total) - np.interp(at - half, grid, total)) / (2.0 * half)


def cross(step, road_heights, response, segments=6):
    """(Hz, transfer function) by Welch's cross-spectra, Hann windows that overlap by half."""
    length = 2 * (len(response) // (segments + 1))
    window, above, under = np.hanning(length + 1)[:-1], 0.0, 0.0
    for begin in range(0, len(response) - length + 1, length // 2):
        r, a = (np.fft.rfft(window * (v[begin:begin + length] - np.mean(v[begin:begin + length])))
                for v in (road_heights, response))
        above, under = above + np.conj(r) * a, under + np.abs(r) ** 2
    return np.fft.rfftfreq(length, step), above / under


class Case:
    def __init__(self, name, kind, folder, model, half, x, z):
        self.name, self.kind, self.model = name, kind, model
        quarter = kind == "quarter_car"
        wheel, body = (driver.series(folder, None if quarter else subject) for subject in ("wheel0", "body"))
        self.time, place = wheel["time_s"], wheel["position_m"]
        self.step = float(np.median(np.diff(self.time)))
        self.found = {"body's centre": body["body_acceleration_m_per_s2"]}
        if not quarter:
            self.found["pitch"] = body["pitch_acceleration_rad_per_s2"]
        places = [place] if quarter else [place, place - WHEELBASE]
        self.heights = {key: np.array([patch_mean(x, z, width)(p) for p in places])
                        for key, width in (("point", 0.0), ("patch", half))}
        self.on_road = (self.time > ROAD_FROM / SPEED + SETTLED) & (self.time < (ROAD_FROM + ROAD_LENGTH) / SPEED + 0.5)
        self.predicted = {(key, way): model_way(self.step, heights) for key, heights in self.heights.items()
                          for way, model_way in (("frequency", model.by_frequency), ("time", model.by_time))}

    def row(self, what):
        return list(self.found).index(what)

    def error(self, what, key, way):
        found, wanted = self.found[what], self.predicted[key, way][self.row(what)]
        if way == "frequency":  # instants at the ends of intervals; the run's are means over them
            wanted = 0.5 * (wanted + np.roll(wanted, 1))
        found, wanted = (below(self.step, values)[self.on_road] for values in (found, wanted))
        return float(np.sqrt(np.mean((found - wanted) ** 2)) / np.sqrt(np.mean(found ** 2)))

    def rms(self, what):
        return float(np.std(self.found[what][self.on_road]))

    def transfer(self, what):
        """(Hz, run's, model's) acceleration per height of the road under the front wheel, both estimated alike."""
        heights = self.heights["patch"][0][self.on_road]
        frequency, found = cross(self.step, heights, self.found[what][self.on_road])
        _, exact = cross(self.step, heights, self.predicted["patch", "frequency"][self.row(what)][self.on_road])
        return frequency, found, exact


def folder_of(kind, rigid, name=None, command="run", *words, finished_only=False):
    return driver.kept(RESULTS / (name or f"{kind}_{'rigid' if rigid else 'planar'}"), command, *words,
                       scenario=scenario(kind, rigid), finished_only=finished_only)


def plate(finished_only):
    """Static stiffness of the elastic tire at its load, N/m, and half the length of its footprint there, m."""
    load = (BODY + UNSPRUNG + RIM + 60.0) * GRAVITY
    folder = folder_of("quarter_car", False, "plate", "press", "--on", "plate", "--deflection", 0.04, "--points", 10,
                       "--load", f"{load:.0f}", finished_only=finished_only)
    if folder is None:
        return None
    foot = driver.columns(folder / "footprint.csv")
    return stiffness_of(folder, load)[0], 0.5 * float(np.ptp(foot["x_m"][foot["pressure_Pa"] > 0.0]))


def case_of(name, kind, rigid, x, z, finished_only):
    """None where --finished finds no runs."""
    folder = folder_of(kind, rigid, finished_only=finished_only)
    pressed = None if rigid else plate(finished_only)
    if not folder or not (rigid or pressed):
        return None
    summary = driver.summary(folder)
    load = summary.get("wheels", [summary])[0]["vertical_load_N"]
    wheel_mass = load / GRAVITY - BODY
    if rigid:
        deep = (load / (4.0 / 3.0 * STIFFNESS * WIDTH * np.sqrt(2.0 * RADIUS))) ** (2.0 / 3.0)
        half = np.sqrt(2.0 * RADIUS * deep)
        spring, damper = 1.5 * load / deep, DAMPING * WIDTH * 2.0 * half
    else:
        (spring, half), damper = pressed, TIRE_DAMPER
    return Case(name, kind, folder, Linear(kind, wheel_mass, spring, damper), half, x, z)


def draw(cases):
    figure, axes = driver.subplots(2, len(cases), figsize=(6.2 * len(cases), 8.5), layout="constrained", squeeze=False)
    for (top, bottom), case in zip(axes.T, cases):
        shown = case.on_road & (case.time < ROAD_FROM / SPEED + SETTLED + 2.0)
        closed = {"ls": "--", "color": style.ORANGE}
        top.plot(case.time[shown], below(case.step, case.found["body's centre"])[shown], color=style.BLUE, lw=1.6,
                 label="run")
        top.plot(case.time[shown], below(case.step, case.predicted["patch", "time"][0])[shown], lw=1.1,
                 label="closed form", **closed)
        driver.label(top, "time, s", "acceleration of the body, m/s²",
                     f"{case.name}; error {100 * case.error(list(case.found)[0], 'patch', 'time'):.1f} %", 8)
        fine = np.geomspace(0.5, 25.0, 400)
        q, late = case.model.transfer(fine), np.exp(-2j * np.pi * fine * WHEELBASE / SPEED)
        for what, colour in zip(case.found, (style.BLUE, style.GREEN)):
            frequency, found, _ = case.transfer(what)
            inner = (frequency > 0.5) & (frequency < 25.0)
            bottom.loglog(frequency[inner], np.abs(found[inner]), color=colour, lw=1.6, label=f"{what}, run")
            whole = q[:, case.row(what), 0] + (q[:, case.row(what), 1] * late if case.kind == "half_car" else 0.0)
            bottom.loglog(fine, np.abs((2 * np.pi * fine) ** 2 * whole), lw=1.0, label=f"{what}, closed form", **closed)
        driver.label(bottom, "frequency, Hz", "acceleration per height of the road, 1/s² and rad/(s² m)", None, 8)
    driver.save(figure, "ride_transfer", 62)


def figures_of(case):
    """(what, unit, value)"""
    yield "tire stiffness of the closed form", "N/m", case.model.tire[0]
    yield "tire damping of the closed form", "N s/m", case.model.tire[1]
    for what in case.found:
        yield f"{what}, rms", "m/s²" if what != "pitch" else "rad/s²", case.rms(what)
        for key, told in (("point", "heights under the centre"), ("patch", "heights over the patch")):
            for way in ("time", "frequency"):
                yield f"{what}, error, {told}, by {way}", "-", case.error(what, key, way)
        frequency, found, exact = case.transfer(what)
        for low, high in ((0.8, 3.0), (3.0, 8.0), (8.0, 15.0)):
            band = (frequency >= low) & (frequency < high)
            yield (f"{what}, transfer function, rms error from {low:g} to {high:g} Hz", "-",
                   np.sqrt(np.sum(np.abs(found - exact)[band] ** 2) / np.sum(np.abs(exact)[band] ** 2)))
    for of, values in (("run", case.found["body's centre"]), ("closed form", case.predicted["patch", "time"][0])):
        yield (f"body's centre, weighted by W_k, rms, {of}", "m/s²",
               ride_values(case.time[case.on_road], values[case.on_road])["weighted_rms"])


def curves_of(case):
    return [{"case": case.name, "what": what, "frequency_Hz": f"{f:.4g}", "run": abs(a), "closed_form": abs(b)}
            for what in case.found for f, a, b in zip(*case.transfer(what)) if 0.5 < f < 25.0]


def main():
    finished = driver.options(__doc__, finished={"action": "store_true"}).parse_args().finished
    RESULTS.mkdir(parents=True, exist_ok=True)
    made = provenance.made_here()
    x, z = road()
    (RESULTS / "road.csv").write_text("x_m,z_m\n" + "".join(f"{a:.3f},{b:.9f}\n" for a, b in zip(x, z)))
    cases = [case_of(*case, x, z, finished) for case in (("quarter car, rigid wheel", "quarter_car", True),
                                                         ("half car, rigid wheels", "half_car", True),
                                                         ("quarter car, planar tire", "quarter_car", False))]
    cases = [case for case in cases if case]
    driver.write("ride_transfer.csv", [row for case in cases for row in curves_of(case)], made, 5)
    driver.write("ride_transfer_figures.csv", [
        {"case": case.name, "what": what, "unit": unit, "value": float(value)} for case in cases
        for what, unit, value in figures_of(case)], made)
    draw(cases)


if __name__ == "__main__":
    main()
