#!/usr/bin/python3
"""Tables and plots of what bulk.py and trajectories.py left: table.py OUT [TO]

TO (default: this folder) receives bulk.csv, bulk.json, trajectories.json and the plots. Both columns are means over seeds with
half their 95 % confidence interval (Student's t); the difference is taken seed by seed, for both started from the same positions.
"""
import json
import math
import pathlib
import shutil
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy

from common import RADIUS, ROOT, half_interval, read_series

sys.path.insert(0, str(ROOT / "scripts"))
from plot import style  # noqa: E402

ENGINES = ("furrow", "liggghts")
COLUMNS = ["test", "quantity", "unit", "furrow", "furrow_ci95", "liggghts", "liggghts_ci95", "difference", "difference_ci95", "seeds"]
SPEEDS = (0.15, 0.4, 1.0)  # m/s
LOOKS = {"furrow": (style.BLUE, "o", "-", "Furrow"), "liggghts": (style.ORANGE, "s", "--", "LIGGGHTS 3.8")}


def rows_of(folder, test):
    file = folder / f"{test}.jsonl"
    return [json.loads(line) for line in file.read_text().splitlines()] if file.exists() else []


def compare(test, quantity, unit, values, scale=1.0, peer="liggghts"):
    """values: engine → seed → value. Seeds that both have count."""
    seeds = sorted(set(values["furrow"]) & set(values[peer]))
    if len(seeds) < 2:
        return None
    mine, theirs = ([scale * values[e][s] for s in seeds] for e in ("furrow", peer))
    apart = [m - t for m, t in zip(mine, theirs)]
    row = {"test": test, "quantity": quantity, "unit": unit, "seeds": len(seeds)}
    for name, v in (("furrow", mine), ("liggghts", theirs), ("difference", apart)):
        row[name], row[name + "_ci95"] = float(numpy.mean(v)), half_interval(v)
    return row


def kilo(cohesion):
    return f"cohesion {cohesion / 1e3:g} kPa"


def bed_rows(folder):
    rows = rows_of(folder, "bed")
    quantities = (("height_m", "height", "mm", 1e3), ("solid_fraction", "solid fraction, middle half", "-", 1.0),
                  ("coordination", "contacts per grain, middle half", "-", 1.0), ("mean_overlap_m", "mean overlap", "µm", 1e6),
                  ("floor_pressure_Pa", "floor pressure", "Pa", 1.0), ("floor_share_of_weight", "floor force / weight", "-", 1.0),
                  ("side_pressure_Pa", "side wall pressure", "Pa", 1.0))
    for cohesion in sorted({r["cohesion_Pa"] for r in rows}):
        for key, name, unit, scale in quantities:
            values = {e: {r["seed"]: r[key] for r in rows if r["engine"] == e and r["cohesion_Pa"] == cohesion} for e in ENGINES}
            yield compare(f"bed, {kilo(cohesion)}", name, unit, values, scale)


def plate_rows(folder):
    rows = rows_of(folder, "plate")
    for cohesion in sorted({r["cohesion_Pa"] for r in rows}):
        for depth in (1, 2, 3, 4):
            def near(row):
                z, p = numpy.array(row["sinkage_m"]) / RADIUS, numpy.array(row["pressure_Pa"])
                return float(p[(z > depth - 0.3) & (z < depth + 0.3)].mean())
            values = {e: {r["seed"]: near(r) for r in rows if r["engine"] == e and r["cohesion_Pa"] == cohesion} for e in ENGINES}
            yield compare(f"plate, {kilo(cohesion)}", f"pressure at {depth} r", "kPa", values, 1e-3)


def coulomb(points):
    """c and φ of the line through (σ, τ): Pa, degrees."""
    slope, offset = numpy.polyfit(*zip(*points), 1)
    return float(offset), math.degrees(math.atan(slope))


def strength(rows, engine, cohesion, steps, speeds):
    """c and φ per seed, of the line through all points: Pa, degrees."""
    mine = [r for r in rows if r["engine"] == engine and r["cohesion_Pa"] == cohesion and r["step_s"] in steps]
    c, phi = {}, {}
    for seed in sorted({r["seed"] for r in mine}):
        points = [(r[f"sigma_{v:g}_Pa"], r[f"tau_{v:g}_Pa"]) for r in mine if r["seed"] == seed for v in speeds]
        if len(points) == 3 * len(speeds) * len(steps):
            c[seed], phi[seed] = coulomb(points)
    return c, phi


def shear_rows(folder):
    rows = rows_of(folder, "shear")
    all_steps = sorted({r["step_s"] for r in rows}, reverse=True)
    for cohesion in sorted({r["cohesion_Pa"] for r in rows}):
        cases = [(f"{v:g} m/s, step {h * 1e6:g} µs", (h,), (v,), "liggghts") for h in all_steps for v in SPEEDS]
        cases += [(f"all speeds, step {h * 1e6:g} µs", (h,), SPEEDS, "liggghts") for h in all_steps]
        cases += [("all speeds and steps", tuple(all_steps), SPEEDS, "liggghts")]
        cases += [("all speeds, step 40 µs, LIGGGHTS: sjkr", (4e-5,), SPEEDS, "liggghts_sjkr")]
        for name, steps, speeds, peer in cases:
            c, phi = {}, {}
            for e in ("furrow", peer):
                c[e], phi[e] = strength(rows, e, cohesion, steps, speeds)
            yield compare(f"shear, {kilo(cohesion)}, {name}", "c", "kPa", c, 1e-3, peer)
            yield compare(f"shear, {kilo(cohesion)}, {name}", "φ", "°", phi, 1.0, peer)


def plot_trajectories(folder, to):
    series = read_series(folder / "trajectories.csv")
    shown = {"LIGGGHTS, bed shifted sideways": (style.GREY, "-"), "no friction": (style.GREEN, "-"),
             "tangential law of LIGGGHTS": (style.BLUE, "-"), "the same with cohesion 80 kPa": (style.SKY, "-"),
             "but not: springs end with contact": (style.PURPLE, "--"), "but not: damper of m*": (style.RED, "--"),
             "the engine as it is": (style.ORANGE, "-"), "mixed against double precision": ("black", ":")}
    figure, axis = plt.subplots(figsize=(7.5, 4.6))
    for name, (colour, line) in shown.items():
        if f"mean: {name}" in series:
            axis.semilogy(series["time_s"], numpy.maximum(series[f"mean: {name}"], 1e-18), line, color=colour, label=name)
    axis.set(xlabel="time in s", ylabel="mean distance of the same grains in m", ylim=(1e-17, 1e-1),
             title="Falling grains, engine against LIGGGHTS from the same start")
    axis.legend(fontsize=7.5, ncol=2)
    save(figure, to, "trajectories")


def plot_plate(folder, to):
    rows = rows_of(folder, "plate")
    figure, axis = plt.subplots(figsize=(6.4, 4.2))
    for cohesion in sorted({r["cohesion_Pa"] for r in rows}):
        for e in ENGINES:
            mine = [r for r in rows if r["engine"] == e and r["cohesion_Pa"] == cohesion]
            if len(mine) < 2:
                continue
            colour, _, line, name = LOOKS[e]
            p = numpy.array([r["pressure_Pa"] for r in mine]) / 1e3
            z = numpy.array(mine[0]["sinkage_m"]) * 1e3
            mean, half = p.mean(axis=0), [half_interval(list(column)) for column in p.T]
            axis.plot(z, mean, line, color=colour, label=f"{name}, {kilo(cohesion)}")
            axis.fill_between(z, mean - half, mean + half, color=colour, alpha=0.15, lw=0)
    axis.set(xlabel="way of the plate in mm", ylabel="pressure in kPa", title="Plate 60 mm wide, 0.2 m/s; mean of the seeds, 95 % band")
    axis.legend()
    save(figure, to, "plate")


def plot_shear(folder, to):
    rows = [r for r in rows_of(folder, "shear") if r["step_s"] == 4e-5]
    figure, axes = plt.subplots(1, 3, figsize=(10.5, 4.0), sharey=True)
    for axis, speed in zip(axes, SPEEDS):
        for e in ENGINES:
            colour, marker, line, name = LOOKS[e]
            for cohesion in sorted({r["cohesion_Pa"] for r in rows}):
                points = [(r[f"sigma_{speed:g}_Pa"] / 1e3, r[f"tau_{speed:g}_Pa"] / 1e3) for r in rows
                          if r["engine"] == e and r["cohesion_Pa"] == cohesion]
                if len(points) < 3:
                    continue
                sigma, tau = numpy.array(points).T
                slope, offset = numpy.polyfit(sigma, tau, 1)
                axis.plot(sigma, tau, marker, color=colour, ms=4, mfc=colour if cohesion else "none")
                axis.plot([0, 110], [offset, offset + 110 * slope], line, color=colour, label=f"{name}, {kilo(cohesion)}", lw=1)
        axis.set(xlabel="normal stress in kPa", title=f"{speed:g} m/s", xlim=(0, 112), ylim=(0, None))
    axes[0].set_ylabel("shear stress in kPa")
    axes[0].legend(fontsize=7.5)
    save(figure, to, "shear")


def save(figure, to, name):
    figure.savefig(to / f"{name}.png", dpi=100)
    plt.close(figure)


def main():
    folder = pathlib.Path(sys.argv[1])
    to = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else pathlib.Path(__file__).resolve().parent
    table = [row for part in (bed_rows, plate_rows, shear_rows) for row in part(folder) if row]
    (to / "bulk.json").write_text(json.dumps([{k: row[k] for k in COLUMNS} for row in table], indent=0, ensure_ascii=False) + "\n")
    with open(to / "bulk.csv", "w") as out:
        out.write(",".join(COLUMNS) + "\n")
        for row in table:
            out.write(",".join(f'"{row[k]}"' if isinstance(row[k], str) else f"{row[k]:.4g}" for k in COLUMNS) + "\n")
    outside = 0
    for row in table:
        differs = abs(row["difference"]) > row["difference_ci95"]
        outside += differs
        print(f"| {row['test']} | {row['quantity']}, {row['unit']} | {row['furrow']:.4g} ± {row['furrow_ci95']:.2g} | "
              f"{row['liggghts']:.4g} ± {row['liggghts_ci95']:.2g} | {row['difference']:+.3g} ± {row['difference_ci95']:.2g}"
              f"{' *' if differs else ''} | {row['seeds']} |")
    print(f"{outside} of {len(table)} differences outside their 95 % interval")
    if (folder / "trajectories.csv").exists():
        plot_trajectories(folder, to)
        shutil.copyfile(folder / "trajectories.json", to / "trajectories.json")
    if rows_of(folder, "plate"):
        plot_plate(folder, to)
    if rows_of(folder, "shear"):
        plot_shear(folder, to)


if __name__ == "__main__":
    main()
