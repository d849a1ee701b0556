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
import argparse
import csv
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
RESULTS = ROOT / "results" / "studies" / "cleat_roll"
sys.path.insert(0, str(ROOT / "scripts"))
import plot.style as style  # noqa: E402
import provenance  # noqa: E402
from kept_results import KeptResults, furrow  # noqa: E402

KEPT = KeptResults(RESULTS)

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
    "contact": {"young_modulus": 2.47e7, "poisson_ratio": 0.45, "friction": 0.9,
                "restitution": 0.2, "normal_stiffness": 2.0e6,
                "normal_damping": 13},
}
COLOURS = {"shell": style.BLUE, "light": style.SKY, "planar": style.ORANGE}


def scenario(tire, speed, height, settled=SETTLED, friction=0.8):
    planar = tire == "planar"
    at = speed * settled + BEFORE
    step = 2e-5 if planar else 1e-4
    ground = {"ground_damping": 2e4} if planar else {}  # what its light nodes bear at this step
    mesh = {"file": "planar.json"} if planar else {"file": "hmmwv_lumped.json", "elements_circumference": SHELL_MESH[0],
                                                   "elements_width": SHELL_MESH[1]}
    if tire == "light":
        mesh["structural_damping"] = LIGHT
    end = settled + (BEFORE + AFTER) / speed + (RINGS if speed > 1.0 else 0.0)
    return {
        "format_version": 1,
        "rig": {"type": "cleat_stand", "speed": speed, "ramp": 0, "load": LOAD, "hold_axle_from": settled},
        "tire": mesh,
        "terrain": {"engine": "rigid", "friction": friction, "friction_velocity_scale": 20, **ground,
                    "profile": [[at, 0], [at, height], [at + LENGTH, height], [at + LENGTH, 0]]},
        "run": {"step": step, "end": round(end, 4), "average_from": settled},
        "output": {"series_interval": 2e-4 if speed > 1.0 else 2e-3, "frame_interval": 0},
    }


def stiffness(tire, planar):
    """(N/m at LOAD, m there) by `furrow press` on a plate."""
    made = scenario(tire, 10.0, 0.02)
    if tire == "planar":
        write_planar(planar)
    folder = KEPT.folder_of(f"plate_{tire}" + (f"_{planar:.0f}" if planar else ""), made,
                            "press", "--on", "plate", "--deflection", 0.018 if tire == "shell" else 0.03, "--points", 6)
    rows = [row for row in csv.DictReader(open(folder / "press.csv", newline="")) if row["unloading"] == "0"]
    deflection, force = (np.array([float(row[key]) for row in rows]) for key in ("deflection_m", "force_N"))
    at = np.interp(LOAD, force, deflection)
    near = 1e-3
    return (np.interp(at + near, deflection, force) - np.interp(at - near, deflection, force)) / (2 * near), at


def write_planar(modulus):
    made = json.loads(json.dumps(PLANAR))
    made["tire"]["young_modulus"] = modulus
    RESULTS.mkdir(parents=True, exist_ok=True)
    (RESULTS / "planar.json").write_text(json.dumps(made))


def fitted_planar():
    """Modulus, Pa, with which the planar tire deflects under LOAD as much as the shell does."""
    _, wanted = stiffness("shell", None)
    modulus = PLANAR["tire"]["young_modulus"]
    for _ in range(3):
        _, found = stiffness("planar", modulus)
        modulus *= found / wanted
    modulus = float(f"{modulus:.4g}")
    write_planar(modulus)
    return modulus, wanted


class Passage:
    """Of one run: way of the axle from the cleat's middle (m) and forces (N)."""

    def __init__(self, folder, speed):
        made = json.loads((folder / "scenario.json").read_text())
        series = np.genfromtxt(folder / "timeseries.csv", delimiter=",", names=True)
        self.speed, self.held = speed, made["rig"]["hold_axle_from"]
        self.time = series["time_s"]
        self.way = series["position_m"] - made["terrain"]["profile"][0][0] - 0.5 * LENGTH
        self.height = float(series["axle_height_m"][-1])
        self.sag = float(np.ptp(series["axle_height_m"][self.time > self.held + 1e-3]))
        self.x, self.z = series["spindle_force_x_N"], series["spindle_force_z_N"]
        self.momentum = series["tire_momentum_travel_kg_m_per_s"]
        plate = (next(RESULTS.glob("plate_planar_*/summary.json")) if "planar" in folder.name
                 else RESULTS / "plate_shell" / "summary.json")
        self.mass = json.loads(plate.read_text())["mass_kg"]
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
        inner = (np.flatnonzero((size[1:-1] > size[:-2]) & (size[1:-1] > size[2:]) & (frequency[1:-1] < 150) & (frequency[1:-1] > 20)) + 1)
        inner = [k for k in inner if abs(frequency[k] / self.facets() - 1.0) > 0.08]
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
        left -= self.momentum[part[-1]] - self.momentum[part[0]
                                                        - 1] if axis == "x" else self.mass * GRAVITY * step * len(part)
        return float(np.sum(self.force(axis)[part]) * step), left


def modes_of(tire):
    """Hz of the lowest mode of each order that moves the section as a whole in the wheel's plane: neither sideways nor
    tilting."""
    file = RESULTS / "planar.json" if tire == "planar" else ROOT / "tire" / "data" / "hmmwv_lumped.json"
    folder, stamp = RESULTS / f"modes_{tire}", RESULTS / f"modes_{tire}.stamp"
    key = json.dumps([provenance.build_of(provenance.program()), file.read_text()])
    if not stamp.exists() or stamp.read_text() != key:
        furrow("modes", file, "--orders", 3, "--count", 3, "--out", folder, "--overwrite", "--quiet")
        stamp.write_text(key)
    shapes = list(csv.DictReader(open(folder / "shapes.csv", newline="")))
    found = {}
    for row in csv.DictReader(open(folder / "modes.csv", newline="")):
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
    made = scenario("planar", 10.0, cleat_height)
    folder = KEPT.folder_of(f"static_{1e3 * place:+.0f}", made, "press", "--on", "profile", "--profile", profile,
                       "--deflection", f"{deflection:.7f}", "--points", 6)
    rows = [row for row in csv.DictReader(open(folder / "press.csv", newline="")) if row["unloading"] == "0"]
    return float(rows[-1]["force_N"])


def draw(passages, slow, still, modes):
    """Forces against the way at each speed, their spectra below."""
    figure, axes = plt.subplots(4, len(SPEEDS), figsize=(15, 13), layout="constrained")
    for column, speed in enumerate(SPEEDS):
        for (tire, kmh, height), passage in passages.items():
            if kmh != speed:
                continue
            look = {"color": COLOURS[tire], "ls": "-" if height == HEIGHTS[0] else "--", "lw": 1.1}
            label = f"{'shell, lightly damped' if tire == 'light' else tire}, {1e3 * height:.0f} mm"
            for row, axis in ((0, "z"), (1, "x")):
                axes[row, column].plot(passage.way[passage.near], 1e-3 * passage.force(axis)[passage.near],
                                       label=label, **look)
                frequency, size = passage.spectrum(axis)
                shown = (frequency > 2) & (frequency < 160)
                axes[row + 2, column].semilogy(frequency[shown], size[shown], label=label, **look)
        for row, axis in ((0, "vertical"), (1, "longitudinal")):
            axes[row, column].set(xlabel="way from the cleat's middle, m",
                                  ylabel=f"{axis} force on the axle, kN", title=f"{speed:g} km/h")
            axes[row + 2, column].set(xlabel="frequency, Hz", ylabel=f"spectrum, {axis}, N s")
            axes[row + 2, column].set_xlim(2, 160)
            for tire, rows in modes.items():
                for order in (0, 1):
                    axes[row + 2, column].axvline(rows[order], color=COLOURS[tire],
                                                  lw=0.9, ls=":" if order == 0 else "-.")
    if slow is not None:
        axes[0, 0].plot(slow.way[slow.near], 1e-3 * slow.force("z")[slow.near],
                        color=style.GREEN, lw=1.0, label=f"planar, 20 mm, {SLOW:g} m/s, no friction")
        axes[0, 0].plot([-place for place in still], [1e-3 * (still[place] - slow.mean["z"] - GRAVITY * slow.mass)
                                                      for place in still], "o", ms=3.5, mfc="none", color=style.RED,
                        label="planar, 20 mm, static")
    axes[0, 0].legend(fontsize=7.5)
    axes[2, 0].legend(fontsize=7.5, title="vertical lines: modes on a fixed rim,\norder 0 dotted, order 1 dash-dotted",
                      title_fontsize=7.5)
    figure.savefig(HERE / "cleat_roll.png", dpi=62)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--finished", action="store_true", help="only what is there")
    KEPT.finished_only = parser.parse_args().finished
    RESULTS.mkdir(parents=True, exist_ok=True)
    made = provenance.made_here()
    modulus, deflection = fitted_planar()
    modes = {tire: modes_of(tire) for tire in ("shell", "planar")}
    passages = {}
    for tire, speed, height in CASES:
        folder = KEPT.folder_of(f"{tire}_{1e3 * height:.0f}_{speed:.0f}",
                                scenario(tire, speed / 3.6, height), "run", "--no-plots")
        if folder:
            passages[tire, speed, height] = Passage(folder, speed / 3.6)
    folder = KEPT.folder_of("planar_slow", scenario("planar", SLOW, HEIGHTS[0], friction=0.0), "run", "--no-plots")
    slow = Passage(folder, SLOW) if folder else None
    still = {place: statically(slow.height, HEIGHTS[0], place)
             for place in (0.0, 0.04, 0.08, 0.12, 0.16)} if slow else {}
    still |= {-place: force for place, force in still.items()}  # the tire is alike in front and behind
    rows = []
    for (tire, speed, height), passage in passages.items():
        case = {"tire": tire, "cleat_mm": f"{1e3 * height:.0f}", "speed_km_per_h": f"{speed:.0f}"}
        grid = np.arange(-0.4, 0.4001, 0.01)
        rows += [{**case, "way_m": f"{way:.2f}", "vertical_N": f"{np.interp(way, passage.way, passage.force('z')):.0f}",
                  "longitudinal_N": f"{np.interp(way, passage.way, passage.force('x')):.0f}"} for way in grid]
    provenance.write_table(HERE / "cleat_roll.csv", list(rows[0]), rows, made)
    figures = [{"tire": "planar", "what": "modulus for the shell's deflection at 4562 N",
                "unit": "Pa", "value": f"{modulus:.4g}"},
               {"tire": "shell", "what": "static deflection at 4562 N",
                "unit": "mm", "value": f"{1e3 * deflection:.4g}"}]
    for tire, table in modes.items():
        for order in (0, 1):
            figures.append({"tire": tire, "what": f"mode of order {order} on a fixed rim",
                            "unit": "Hz", "value": f"{table[order]:.4g}"})
    for (tire, speed, height), p in passages.items():
        case = {"tire": tire, "cleat_mm": f"{1e3 * height:.0f}", "speed_km_per_h": f"{speed:.0f}"}

        def add(what, unit, value):
            figures.append({**case, "what": what, "unit": unit, "value": f"{value:.4g}"})
        add("sides of the mesh pass", "Hz", p.facets())
        add("mean force before the cleat, vertical", "N", p.mean["z"])
        add("axle moves while it is held, at most", "m", p.sag)
        for axis, name in (("z", "vertical"), ("x", "longitudinal")):
            add(f"largest force beyond the mean, {name}", "N", np.max(p.force(axis)[p.near]))
            add(f"least force beyond the mean, {name}", "N", np.min(p.force(axis)[p.near]))
            whole, left = p.impulse(axis)
            add(f"impulse of the passage on the axle, {name}", "N s", whole)
            add(f"impulse that ground, axle, weight and the tire's momentum leave over, {name}", "N s", left)
            for k, peak in enumerate(p.peaks(axis)):
                add(f"peak {k + 1} of what rings after the cleat, {name}", "Hz", peak)
    if slow:
        found = np.array([np.interp(-place, slow.way, slow.ground["z"]) for place in still])
        wanted = np.array(list(still.values()))
        figures.append({"tire": "planar", "cleat_mm": "20", "speed_km_per_h": f"{3.6 * SLOW:.2f}",
                        "what": "largest difference from the static force, of the largest rise of force",
                        "unit": "-", "value": f"{np.max(np.abs(found - wanted)) / (np.max(wanted) - LOAD):.3g}"})
    columns = ["tire", "cleat_mm", "speed_km_per_h", "what", "unit", "value"]
    provenance.write_table(HERE / "cleat_roll_figures.csv", columns,
                           [{**dict.fromkeys(columns, ""), **row} for row in figures], made)
    draw(passages, slow, still, modes)


if __name__ == "__main__":
    main()
