#!/usr/bin/python3
"""Bulk tests in the engine and in LIGGGHTS from the same positions: settled beds, plate sinkage, direct shear.

usage: bulk.py OUT bed|plate|shear [--seeds 5] [--engine ENGINE] …

Appends one JSON line per run to OUT/<test>.jsonl and skips what is there: it can be stopped and started again, and the
two engines run side by side (table.py makes the tables). Seeds differ in the random start. Material: common.py.

bed    1200 grains fall between rough walls y = ±10 r, periodic along x, floor rough; 0.6 s; cohesion 0 and 80 kPa.
plate  2500 grains on 36 r × 36 r, periodic, settled in the engine; a box of triangles 10 r wide goes in by 4 r at
       0.2 m/s.
shear  650 grains on 24 r × 14 r, periodic, between plates of grains: direct shear under 20, 50, 100 kPa, on the plateau
       at three speeds one after the other, with two steps, cohesion 0 and 80 kPa. More engines: furrow_switched,
       furrow_spring, furrow_damper, with LIGGGHTS's tangential law or a part of it in the engine; liggghts_sjkr, with
       LIGGGHTS's own cohesion in the place of the constant pull, which must differ.
"""
import argparse
import json
import math
import pathlib
import time

import numpy

from common import (ALL_SWITCHES, BASE, FREE, LID, MASS, RADIUS, random_spheres, record_program, run_furrow,
                    run_liggghts)
from packing import measure

STEP = 4e-5  # s
FILL = 0.28  # share of the space that the spheres take at the start
R = RADIUS


def space_for(count, area):
    return count * 4.0 / 3.0 * math.pi * R**3 / (FILL * area)


class Rows:
    """Results of one test: a line of JSON each."""

    def __init__(self, file):
        self.file = file
        self.done = [json.loads(line) for line in file.read_text().splitlines()] if file.exists() else []

    def has(self, key):
        return any(all(row.get(k) == v for k, v in key.items()) for row in self.done)

    def add(self, key, values, begun):
        row = {**key, **values, "wall_s": round(time.monotonic() - begun, 2)}
        with open(self.file, "a") as out:
            out.write(json.dumps(row) + "\n")
        print(json.dumps(row), flush=True)


def cases(a, rows, test):
    """(key of a row, folder of the run, starting time) of every seed, cohesion and engine that has no row yet."""
    for seed in range(1, a.seeds + 1):
        for cohesion in (0.0, 80e3):
            for engine in a.engines:
                key = {"engine": engine, "seed": seed, "cohesion_Pa": cohesion}
                if not rows.has(key):
                    yield key, a.out / f"runs/{test}-{engine}-{seed}-{cohesion:g}", time.monotonic()


def bed(a, rows):
    length, width, count, steps = 20 * R, 20 * R, 1200, 15000
    height, kinds = space_for(count, length * width), [FREE] * count
    for key, folder, begun in cases(a, rows, "bed"):
        x = random_spheres(count, length, width, 1.5 * R, 1.5 * R + height, key["seed"], (True, False))
        cell, share = {"length": length, "width": width, "periodic_y": False}, None
        if key["engine"] == "furrow":
            job = {"test": "fall", "step": STEP, "steps": steps, "every": steps, "cohesion": key["cohesion_Pa"], **cell}
            frames, series = run_furrow(folder, job, kinds, x)
            share = float(series["floor_N"][-1])
        else:
            frames, _ = run_liggghts(folder, "deck_settle.in", kinds, x, {"height": height + 10 * R, **cell},
                                     key["cohesion_Pa"], step=STEP, steps=steps)
        values = measure(frames[-1], length, width, (True, False))
        if share is not None:
            values["floor_force_over_overlaps"] = share / (values["floor_pressure_Pa"] * length * width)
        rows.add(key, values, begun)


def write_box(file, middle, side, low, height):
    """A closed box as STL, the mesh of peer_grains."""
    h = 0.5 * side
    at = [(middle + a, b, z) for z in (low, low + height) for a, b in ((-h, -h), (h, -h), (h, h), (-h, h))]
    quads = [(0, 3, 2, 1), (4, 5, 6, 7)] + [(k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k) for k in range(4)]
    with open(file, "w") as out:
        out.write("solid plate\n")
        for q in quads:
            for t in ((q[0], q[1], q[2]), (q[0], q[2], q[3])):
                p = [numpy.array(at[k]) for k in t]
                n = numpy.cross(p[1] - p[0], p[2] - p[0])
                n /= numpy.linalg.norm(n)
                out.write("facet normal %.9g %.9g %.9g\nouter loop\n" % tuple(n))
                out.writelines("vertex %.12g %.12g %.12g\n" % tuple(v) for v in p)
                out.write("endloop\nendfacet\n")
        out.write("endsolid plate\n")


def settled_grains(a, side, key, common):
    """Those of a seed and cohesion, settled in the engine, which both engines press."""
    count, folder = 2500, a.out / f"runs/plate-bed-{key['seed']}-{key['cohesion_Pa']:g}"
    kept, height = folder / "settled.npy", space_for(count, side * side)
    if not kept.exists():
        x = random_spheres(count, side, side, 1.5 * R, 1.5 * R + height, key["seed"])
        job = {"test": "fall", "steps": 15000, "every": 15000, **common}
        numpy.save(kept, run_furrow(folder / key["engine"], job, [FREE] * count, x)[0][-1])
    y = numpy.load(kept)
    y[:, 0] %= side
    y[:, 1] = (y[:, 1] / side + 0.5) % 1.0 * side - 0.5 * side
    return y


def plate(a, rows):
    side, speed, sinkage = 36 * R, 0.2, 4 * R
    plate_side, plate_height, samples, rest = 10 * R, 7 * R, 50, 1000
    every = round(sinkage / speed / STEP / samples)
    for key, folder, begun in cases(a, rows, "plate"):
        common = {"length": side, "width": side, "step": STEP, "cohesion": key["cohesion_Pa"]}
        y = settled_grains(a, side, key, common)
        kinds = [FREE] * len(y)
        near = (abs(y[:, 0] - 0.5 * side) < 0.5 * plate_side + R) & (abs(y[:, 1]) < 0.5 * plate_side + R)
        low = float(y[near, 2].max() + R)
        if key["engine"] == "furrow":
            job = {"test": "plate", "plate_side": plate_side, "plate_height": plate_height, "plate_z": low,
                   "speed": speed, "rest_steps": rest, "steps": every * samples, "every": every, **common}
            force = run_furrow(folder, job, kinds, y, half_step_start=False)[1]["force_z_N"]
        else:
            folder.mkdir(parents=True, exist_ok=True)
            write_box(folder / "plate.stl", 0.5 * side, plate_side, low, plate_height)
            box = {"length": side, "width": side, "height": low + plate_height + 5 * R}
            rest_here = -(-rest // every) * every  # the samples of ave/time start at multiples of `every`
            _, series = run_liggghts(folder, "deck_plate.in", kinds, y, box, key["cohesion_Pa"], step=STEP, speed=speed,
                                     rest=f"run {rest_here}", every=every, steps=every * samples)
            force = series[-samples:, 3]
        pressure = numpy.asarray(force) / plate_side**2
        rows.add(key, {"sinkage_m": [round((k + 0.5) * every * STEP * speed, 7) for k in range(samples)],
                       "pressure_Pa": [round(float(p), 1) for p in pressure]}, begun)


SHEAR_CELL = (24 * R, 14 * R)
SHEAR_FREE = 650  # grains between the plates
# Speed, m/s, and travel, r: first on to the plateau, then one after the other there.
STAGES = ((0.4, 5), (0.15, 4), (0.4, 4), (1.0, 4))
# Energy density of LIGGGHTS's cohesion model sjkr, J/m³, with which two grains rest at the overlap that 80 kPa gives
# ours: k π (r² − d²/4) = F_c = K δ^{3/2}, d = 2 r − δ. It parts at 1.4 N, not at 9.0 N.
SJKR = 1.127e6
# The engine with parts of LIGGGHTS's tangential law: all of it, its spring alone, its damper alone.
VARIANTS = {"furrow_switched": {"switches": ALL_SWITCHES, "damper_mass": "full"},
            "furrow_spring": {"switches": ALL_SWITCHES}, "furrow_damper": {"switches": 0, "damper_mass": "full"}}
LID_SPEED = 0.4  # at which the lid falls under its load, m/s


def shear_start(seed):
    """Base, lid and free grains; the plates are square lattices, each grain up to r out of line."""
    length, width = SHEAR_CELL
    generator = numpy.random.default_rng(1000 + seed)
    top = 3.5 * R + space_for(SHEAR_FREE, length * width) + 3.5 * R

    def lattice(z, sign):
        return [((2 * k + 1) * R, (2 * m + 1) * R - 0.5 * width, z + sign * generator.random() * R)
                for k in range(12) for m in range(7)]

    base, lid = lattice(1.01 * R, 1), lattice(top, -1)
    free = random_spheres(SHEAR_FREE, length, width, 4.1 * R, top - 3.1 * R, seed)
    kinds = [BASE] * len(base) + [LID] * len(lid) + [FREE] * SHEAR_FREE
    return kinds, numpy.vstack([base, lid, free])


def shear(a, rows):
    for step in a.steps:
        for seed in range(1, a.seeds + 1):
            kinds, x = shear_start(seed)
            for cohesion in a.cohesions:
                for pressure in a.pressures:
                    for engine in a.engines:
                        key = {"engine": engine, "seed": seed, "cohesion_Pa": cohesion,
                               "step_s": step, "pressure_Pa": pressure}
                        if not rows.has(key):
                            begun = time.monotonic()
                            rows.add(key, one_shear(a, key, kinds, x), begun)


def one_shear(a, key, kinds, x):
    (length, width), step = SHEAR_CELL, key["step_s"]
    area, every = length * width, round(4e-3 / step)

    def whole(seconds):
        return max(1, round(seconds / step / every)) * every

    stages = [{"speed": v, "steps": whole(way * R / v), "ramp_steps": every} for v, way in STAGES]
    damping = key["pressure_Pa"] * area / LID_SPEED
    phases = {"settle_steps": whole(0.12), "load_steps": whole(0.1), "hold_steps": whole(0.26),
              "every": every, "step": step}
    folder = a.out / f"runs/shear-{key['engine']}"
    if key["engine"].startswith("furrow"):
        law = VARIANTS.get(key["engine"], {})
        job = {"test": "shear", "length": length, "width": width, "cohesion": key["cohesion_Pa"],
               "pressure": key["pressure_Pa"], "lid_damping": damping, "stages": stages, **phases}
        _, series = run_furrow(folder, job, kinds, x, **law)
        tau, sigma, rise = series["shear_N"] / area, series["normal_N"] / area, series["lid_m"]
    else:
        box = {"length": length, "width": width, "height": float(x[:, 2].max()) + 5 * R}
        lines, speed = [], 0.0
        for s in stages:
            push = MASS * (s["speed"] - speed) / (s["ramp_steps"] * step)
            for force, steps in ((push, s["ramp_steps"]), (0.0, s["steps"] - s["ramp_steps"])):
                lines += ["unfix lid_x", f"fix lid_x lid setforce {force!r} 0.0 NULL", f"run {steps}"]
            speed = s["speed"]
        kind = {"sjkr": SJKR} if key["engine"] == "liggghts_sjkr" else {"cohesion": key["cohesion_Pa"]}
        _, series = run_liggghts(folder, "deck_shear.in", kinds, x, box, **kind, load=key["pressure_Pa"] * area,
                                 lid_damping=damping, n_base=kinds.count(BASE), stages="\n".join(lines), **phases)
        series = series[-sum(s["steps"] for s in stages) // every:]
        tau, sigma, rise = -series[:, 1] / area, series[:, 2] / area, series[:, 3]
    out, begun = {}, 0
    for n, s in enumerate(stages):
        part = slice(begun + s["steps"] // every // 4, begun + s["steps"] // every)
        begun += s["steps"] // every
        if n > 0:
            out |= {f"{name}_{s['speed']:g}_Pa": float(values[part].mean())
                    for name, values in (("tau", tau), ("sigma", sigma))}
    return {**out, "rise_m": float(rise[-1] - rise[0]), "tau_curve_Pa": [round(float(t)) for t in tau]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("test", choices=("bed", "plate", "shear"))
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--engine", choices=("furrow", "liggghts", "liggghts_sjkr", *VARIANTS))
    parser.add_argument("--steps", type=float, nargs="+", default=[STEP, 0.5 * STEP], help="of shear, s")
    parser.add_argument("--cohesions", type=float, nargs="+", default=[0.0, 80e3], help="of shear, Pa")
    parser.add_argument("--pressures", type=float, nargs="+", default=[20e3, 50e3, 100e3], help="of shear, Pa")
    a = parser.parse_args()
    a.out = a.out.resolve()
    a.out.mkdir(parents=True, exist_ok=True)
    record_program(a.out)
    a.engines = [a.engine] if a.engine else ["furrow", "liggghts"]
    rows = Rows(a.out / f"{a.test}.jsonl")
    {"bed": bed, "plate": plate, "shear": shear}[a.test](a, rows)


if __name__ == "__main__":
    main()
