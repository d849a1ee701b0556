#!/usr/bin/python3
"""A tire rolls over a cleat with its axle at a fixed height, as on a cleat test stand (rigs/cleat_roll.json): the
lumped shell and beside it a planar tire of the same size and mass, whose modulus gives it the shell's static stiffness.
Writes cleat_roll.csv (forces on the axle against the way), cleat_roll_figures.csv (what is derived) and cleat_roll.png
beside this script.

usage: cleat_roll.py [--finished]

With --finished nothing is computed but what is derived of runs that are there.

"light" is the shell with a structural damping of 0.2 ms in place of its file's 5 ms, with which nothing above 64 Hz can
ring.

A cleat of 25 mm length and 20 or 25 mm height, at 10, 30 and 60 km/h (the shell over 25 mm at 30 km/h alone): the wheel
is let down on its load while it rolls, its axle is then held at that height, and it meets the cleat half a metre later.
Forces are what the axle feels, less their means before the cleat. Peaks are those of the vertical force's spectrum
while the tire rings after the cleat, from where the contact has left it for 0.2 s; beside them stand the frequencies of
`furrow modes` on a rim at rest without ground, order 0 (the belt turns against the rim) and 1 (the belt moves against
the rim).

What is checked: impulses of ground, axle and weight over the passage add up to what the tire's momentum changed; at 0.5
m/s the planar tire's force is that of `furrow press --on profile` at each place, without friction there and here.
"""
import csv
import json

import numpy as np

import driver
from furrow.plot import style
import provenance
from driver import ROOT, read_json

RESULTS = driver.RESULTS / "cleat_roll"
LOAD, LENGTH, GRAVITY = 4562.0, 0.025, 9.80665  # N, m, m/s²
SPEEDS, HEIGHTS = (10.0, 30.0, 60.0), (0.020, 0.025)  # km/h, m
CASES = [(tire, speed, height) for tire in ("planar", "shell") for height in HEIGHTS for speed in SPEEDS
         if tire == "planar" or height == HEIGHTS[0] or speed == SPEEDS[1]]
CASES += [("light", speed, HEIGHTS[0]) for speed in SPEEDS[1:]]
LIGHT = 2e-4  # s, structural damping of the shell "light": 6 % of critical at 100 Hz
SETTLED, BEFORE, AFTER, RINGS = 0.4, 0.5, 0.5, 0.22  # s, m, m, s
REACH = 0.3  # m from the cleat's middle, beyond which the tire does not touch it
SLOW = 0.5  # m/s
SHELL_MESH = (60, 12)
PLANAR = {
    "format_version": 1, "model": "planar", "name": "Planar tire of the size of hmmwv_lumped.json",
    "source": "Radii, mass and rim of hmmwv_lumped.json; modulus from the static stiffness of that shell at 4562 N "
              "(cleat_roll.py)",
    "radius": 0.4673, "rim_radius": 0.2683, "width": 0.24, "elements_circumference": 96, "elements_radial": 6,
    "rim": {"mass": 15, "spin_inertia": 0.7, "diametral_inertia": 0.4, "carrier_mass": 450},
    "disc": {"density": 276, "young_modulus": 1e8, "poisson_ratio": 0.3, "viscosity": 0},
    "tire": {"density": 104, "young_modulus": 1e6, "poisson_ratio": 0.45, "viscosity": 500},
    "law": "consistent", "volume": "element", "integrator": "semi_implicit_euler",
    "step_share": 0.5, "contact_stiffness": 2e7,
    "contact": {"young_modulus": 2.47e7, "poisson_ratio": 0.45, "friction": 0.9, "restitution": 0.2,
                "normal_stiffness": 2.0e6, "normal_damping": 13},
}
COLOURS = {"shell": style.BLUE, "light": style.SKY, "planar": style.ORANGE}


def scenario(tire, speed, height, friction=0.8):
    planar = tire == "planar"
    at = speed * SETTLED + BEFORE
    step = 2e-5 if planar else 1e-4
    ground = {"ground_damping": 2e4} if planar else {}  # what its light nodes bear at this step
    mesh = {"file": "planar.json"} if planar else {
        "file": "hmmwv_lumped.json", "elements_circumference": SHELL_MESH[0], "elements_width": SHELL_MESH[1]}
    if tire == "light":
        mesh["structural_damping"] = LIGHT
    end = SETTLED + (BEFORE + AFTER) / speed + (RINGS if speed > 1.0 else 0.0)
    return {
        "format_version": 1,
        "rig": {"type": "cleat_stand", "speed": speed, "ramp": 0, "load": LOAD, "hold_axle_from": SETTLED},
        "tire": mesh,
        "terrain": {"engine": "rigid", "friction": friction, "friction_velocity_scale": 20, **ground,
                    "profile": [[at, 0], [at, height], [at + LENGTH, height], [at + LENGTH, 0]]},
        "run": {"step": step, "end": round(end, 4), "average_from": SETTLED},
        "output": {"series_interval": 2e-4 if speed > 1.0 else 2e-3, "frame_interval": 0},
    }


def run(name, *case, finished_only=False, **more):
    return driver.kept(RESULTS / name, "run", scenario=scenario(*case, **more), finished_only=finished_only)


def stiffness_of(folder, load):
    """(N/m, m) of `furrow press` at a load."""
    curve = driver.press_curve(folder)
    deflection, force = curve["deflection_m"], curve["force_N"]
    at, near = np.interp(load, force, deflection), 1e-3
    return (np.interp(at + near, deflection, force) - np.interp(at - near, deflection, force)) / (2 * near), at


def static_deflection(tire, planar=None):
    """m under LOAD, by `furrow press` on a plate."""
    if planar:
        write_planar(planar)
    folder = driver.kept(RESULTS / (f"plate_{tire}" + (f"_{planar:.0f}" if planar else "")), "press", "--on", "plate",
                         "--deflection", 0.03 if planar else 0.018, "--points", 6, scenario=scenario(tire, 10.0, 0.02))
    return stiffness_of(folder, LOAD)[1]


def write_planar(modulus):
    RESULTS.mkdir(parents=True, exist_ok=True)
    made = PLANAR | {"tire": PLANAR["tire"] | {"young_modulus": modulus}}
    (RESULTS / "planar.json").write_text(json.dumps(made))


def fitted_planar():
    """Modulus, Pa, with which the planar tire deflects under LOAD as much as the shell does, and that deflection, m."""
    wanted, modulus = static_deflection("shell"), PLANAR["tire"]["young_modulus"]
    for _ in range(3):
        modulus *= static_deflection("planar", modulus) / wanted
    modulus = float(f"{modulus:.4g}")
    write_planar(modulus)
    return modulus, wanted


class Passage:
    """Of one run: way of the axle from the cleat's middle (m) and forces (N)."""

    def __init__(self, folder, speed):
        made, series = read_json(folder / "scenario.json"), driver.series(folder)
        self.speed, self.held = speed, made["rig"]["hold_axle_from"]
        self.time = series["time_s"]
        self.way = series["position_m"] - made["terrain"]["profile"][0][0] - 0.5 * LENGTH
        self.height = float(series["axle_height_m"][-1])
        self.sag = float(np.ptp(series["axle_height_m"][self.time > self.held + 1e-3]))
        self.x, self.z = series["spindle_force_x_N"], series["spindle_force_z_N"]
        self.momentum = series["tire_momentum_travel_kg_m_per_s"]
        plate = (next(RESULTS.glob("plate_planar_*/summary.json")) if "planar" in folder.name
                 else RESULTS / "plate_shell" / "summary.json")
        self.mass = read_json(plate)["mass_kg"]
        self.around = PLANAR["elements_circumference"] if "planar" in folder.name else SHELL_MESH[0]
        self.ground = {"x": series["force_x_N"], "z": series["force_z_N"]}
        calm = (self.time > self.held) & (self.way < -REACH)
        self.mean = {"x": float(np.mean(self.x[calm])), "z": float(np.mean(self.z[calm]))}
        self.near = (self.way > -0.45) & (self.way < 0.45)

    def force(self, axis):
        """Of the axle beyond its mean before the cleat, N."""
        return (self.x if axis == "x" else self.z) - self.mean[axis]

    def spectrum(self, axis, ringing=False):
        """(Hz, N s): amplitudes of the Fourier transform of the passage, or of what rings after the cleat."""
        if ringing:
            part = (self.way > REACH) & (self.time < self.time[self.way > REACH][0] + 0.2)
        else:
            part = self.way > -REACH
        values = self.force(axis)[part]
        if ringing:
            values = (values - np.mean(values)) * np.hanning(2 * len(values))[len(values):]
        step = float(np.median(np.diff(self.time)))
        count = 1 << 15
        return np.fft.rfftfreq(count, step), np.abs(np.fft.rfft(values, count)) * step

    def facets(self):
        """Hz at which the sides of the tire's mesh pass."""
        return self.around * self.speed / (2.0 * np.pi * PLANAR["radius"])

    def peaks(self, axis, most=2):
        """Hz of the largest peaks of what rings, from 20 to 150 Hz, without those of the mesh."""
        frequency, size = self.spectrum(axis, ringing=True)
        peaks = 1 + np.flatnonzero((size[1:-1] > size[:-2]) & (size[1:-1] > size[2:]))
        inner = [k for k in peaks if 20 < frequency[k] < 150 and abs(frequency[k] / self.facets() - 1.0) > 0.08]
        strong = [k for k in inner if size[k] > 0.3 * np.max(size[inner])]
        return sorted(frequency[k] for k in sorted(strong, key=lambda k: -size[k])[:most])

    def impulse(self, axis):
        """(of the axle's force beyond its mean over the passage; what the ground gave the tire and the axle took from
        it, less the weight's and what the tire's momentum changed), N s. Of the vertical momentum both ends are taken
        as alike."""
        part = np.flatnonzero(self.way > -REACH)
        step = float(np.median(np.diff(self.time)))
        axle = self.x if axis == "x" else self.z
        left = float(np.sum((self.ground[axis] - axle)[part]) * step)
        left -= (self.momentum[part[-1]] - self.momentum[part[0] - 1] if axis == "x"
                 else self.mass * GRAVITY * step * len(part))
        return float(np.sum(self.force(axis)[part]) * step), left


def modes_of(tire):
    """Hz of the lowest mode of each order that moves the section as a whole in the wheel's plane: neither sideways nor
    tilting."""
    file = RESULTS / "planar.json" if tire == "planar" else ROOT / "tire" / "data" / "hmmwv_lumped.json"
    folder = driver.kept(RESULTS / f"modes_{tire}", "modes", "--orders", 3, "--count", 3, scenario=read_json(file))
    shapes, modes = (list(csv.DictReader(open(folder / name, newline=""))) for name in ("shapes.csv", "modes.csv"))
    found = {}
    for row in modes:
        nodes = [shape for shape in shapes if (shape["order"], shape["number"]) == (row["order"], row["number"])]
        along, out, across = (np.array([float(node[name]) + 1j * float(node[f"{name}_imaginary"]) for node in nodes])
                              for name in ("tangential", "radial", "axial"))
        if abs(np.mean(along)) + abs(np.mean(out)) > np.mean(abs(across)):
            found.setdefault(int(row["order"]), float(row["frequency_Hz"]))
    return found


def statically(axle_height, cleat_height, place):
    """N on the planar tire with the axle at a height, the cleat's middle at `place` ahead of it."""
    profile = RESULTS / f"profile_{1e3 * place:+.0f}.csv"
    left, right = place - 0.5 * LENGTH, place + 0.5 * LENGTH
    points = [(-1.0, 0.0), (left, 0.0), (left + 1e-5, cleat_height), (right, cleat_height),
              (right + 1e-5, 0.0), (1.0, 0.0)]
    profile.write_text("x_m,z_m\n" + "".join(f"{x:.6f},{z:.6f}\n" for x, z in points))
    deflection = cleat_height + PLANAR["radius"] - axle_height
    folder = driver.kept(RESULTS / f"static_{1e3 * place:+.0f}", "press", "--on", "profile", "--profile", profile,
                         "--deflection", f"{deflection:.7f}", "--points", 6,
                         scenario=scenario("planar", 10.0, cleat_height))
    return float(driver.press_curve(folder)["force_N"][-1])


def draw(passages, slow, still, modes):
    """Forces against the way at each speed, their spectra below."""
    figure, axes = driver.subplots(4, len(SPEEDS), figsize=(15, 13), layout="constrained")
    for column, speed in zip(axes.T, SPEEDS):
        for (tire, kmh, height), passage in passages.items():
            if kmh != speed:
                continue
            look = {"color": COLOURS[tire], "ls": "-" if height == HEIGHTS[0] else "--", "lw": 1.1,
                    "label": f"{'shell, lightly damped' if tire == 'light' else tire}, {1e3 * height:.0f} mm"}
            for over, under, axis in zip(column[:2], column[2:], "zx"):
                over.plot(passage.way[passage.near], 1e-3 * passage.force(axis)[passage.near], **look)
                frequency, size = passage.spectrum(axis)
                shown = (frequency > 2) & (frequency < 160)
                under.semilogy(frequency[shown], size[shown], **look)
        for over, under, axis in zip(column[:2], column[2:], ("vertical", "longitudinal")):
            driver.label(over, "way from the cleat's middle, m", f"{axis} force on the axle, kN", f"{speed:g} km/h",
                         legend=None)
            driver.label(under, "frequency, Hz", f"spectrum, {axis}, N s", legend=None, xlim=(2, 160))
            for tire, rows in modes.items():
                for order, dots in enumerate((":", "-.")):
                    under.axvline(rows[order], color=COLOURS[tire], lw=0.9, ls=dots)
    if slow is not None:
        axes[0, 0].plot(slow.way[slow.near], 1e-3 * slow.force("z")[slow.near],
                        color=style.GREEN, lw=1.0, label=f"planar, 20 mm, {SLOW:g} m/s, no friction")
        force = [1e-3 * (still[place] - slow.mean["z"] - GRAVITY * slow.mass) for place in still]
        axes[0, 0].plot([-place for place in still], force, "o", ms=3.5, mfc="none", color=style.RED,
                        label="planar, 20 mm, static")
    named = {label: line for axis in axes[0] for line, label in zip(*axis.get_legend_handles_labels())}
    figure.get_layout_engine().set(rect=(0, 0.07, 1, 0.93))
    figure.legend(named.values(), named, loc="lower center", ncols=4, title_fontsize=9, title="vertical lines: modes "
                  "on a fixed rim in the tire's colour, order 0 dotted, order 1 dash-dotted")
    driver.save(figure, "cleat_roll", 62)


def figures_of(p):
    """(what, unit, value) of a passage"""
    yield "sides of the mesh pass", "Hz", p.facets()
    yield "mean force before the cleat, vertical", "N", p.mean["z"]
    yield "axle moves while it is held, at most", "m", p.sag
    for axis, name in (("z", "vertical"), ("x", "longitudinal")):
        whole, left = p.impulse(axis)
        yield f"largest force beyond the mean, {name}", "N", np.max(p.force(axis)[p.near])
        yield f"least force beyond the mean, {name}", "N", np.min(p.force(axis)[p.near])
        yield f"impulse of the passage on the axle, {name}", "N s", whole
        yield f"impulse that ground, axle, weight and the tire's momentum leave over, {name}", "N s", left
        for k, peak in enumerate(p.peaks(axis)):
            yield f"peak {k + 1} of what rings after the cleat, {name}", "Hz", peak


def main():
    finished = driver.options(__doc__, finished={"action": "store_true"}).parse_args().finished
    made = provenance.made_here()
    modulus, deflection = fitted_planar()
    modes = {tire: modes_of(tire) for tire in ("shell", "planar")}
    passages, rows = {}, []
    figures = [{"tire": "planar", "what": "modulus for the shell's deflection at 4562 N", "unit": "Pa",
                "value": modulus},
               {"tire": "shell", "what": "static deflection at 4562 N", "unit": "mm", "value": 1e3 * deflection}]
    figures += [{"tire": tire, "what": f"mode of order {order} on a fixed rim", "unit": "Hz", "value": table[order]}
                for tire, table in modes.items() for order in (0, 1)]
    for tire, speed, height in CASES:
        folder = run(f"{tire}_{1e3 * height:.0f}_{speed:.0f}", tire, speed / 3.6, height, finished_only=finished)
        if not folder:
            continue
        p = passages[tire, speed, height] = Passage(folder, speed / 3.6)
        case = {"tire": tire, "cleat_mm": f"{1e3 * height:.0f}", "speed_km_per_h": f"{speed:.0f}"}
        rows += [{**case, "way_m": f"{way:.2f}", "vertical_N": f"{np.interp(way, p.way, p.force('z')):.0f}",
                  "longitudinal_N": f"{np.interp(way, p.way, p.force('x')):.0f}"}
                 for way in np.arange(-0.4, 0.4001, 0.01)]
        figures += [{**case, "what": what, "unit": unit, "value": value} for what, unit, value in figures_of(p)]
    slow, still = None, {}
    if folder := run("planar_slow", "planar", SLOW, HEIGHTS[0], friction=0.0, finished_only=finished):
        slow = Passage(folder, SLOW)
        still = {place: statically(slow.height, HEIGHTS[0], place) for place in (0.0, 0.04, 0.08, 0.12, 0.16)}
        still |= {-place: force for place, force in still.items()}  # the tire is alike in front and behind
        found = np.array([np.interp(-place, slow.way, slow.ground["z"]) for place in still])
        wanted = np.array(list(still.values()))
        figures.append({"tire": "planar", "cleat_mm": "20", "speed_km_per_h": f"{3.6 * SLOW:.2f}",
                        "what": "largest difference from the static force, of the largest rise of force", "unit": "-",
                        "value": f"{np.max(np.abs(found - wanted)) / (np.max(wanted) - LOAD):.3g}"})
    driver.write("cleat_roll.csv", rows, made)
    driver.write("cleat_roll_figures.csv", figures, made,
                 names=["tire", "cleat_mm", "speed_km_per_h", "what", "unit", "value"])
    draw(passages, slow, still, modes)


if __name__ == "__main__":
    main()
