#!/usr/bin/python3
"""Tables and plots of what bulk.py and trajectories.py left: table.py OUT [TO]

TO (default: this folder) receives bulk.csv, law_and_step.csv, trajectories.json and the plots. Columns hold
values with half their 95 % confidence interval (Student's t). Beds, plate: means over seeds, differences seed by seed,
for both started from the same positions. Shear: the line τ = c + σ tan φ through all tests, intervals from the scatter
about it; only tests that both have.
"""
import json
import math
import pathlib

import numpy

from common import RADIUS, driver, origin, provenance, read_series
from furrow.plot import style
from furrow.plot.student import half_interval, student

ENGINES = ("furrow", "liggghts")
COLUMNS = ["test", "quantity", "unit", "furrow", "furrow_ci95", "liggghts", "liggghts_ci95", "difference",
           "difference_ci95", "seeds"]
SPEEDS = (0.15, 0.4, 1.0)  # m/s
LOOKS = {"furrow": (style.BLUE, "o", "-", "Furrow"), "liggghts": (style.ORANGE, "s", "--", "LIGGGHTS 3.8")}


def rows_of(folder, test):
    file = folder / f"{test}.jsonl"
    return [json.loads(line) for line in file.read_text().splitlines()] if file.exists() else []


def compare(test, quantity, unit, values, scale=1.0):
    """values: engine → seed → value. Seeds that both have count."""
    seeds = sorted(set(values["furrow"]) & set(values["liggghts"]))
    if len(seeds) < 2:
        return None
    mine, theirs = ([scale * values[e][s] for s in seeds] for e in ENGINES)
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
                  ("coordination", "contacts per grain, middle half", "-", 1.0),
                  ("mean_overlap_m", "mean overlap", "µm", 1e6), ("floor_pressure_Pa", "floor pressure", "Pa", 1.0),
                  ("floor_share_of_weight", "floor force / weight", "-", 1.0),
                  ("side_pressure_Pa", "side wall pressure", "Pa", 1.0))
    for cohesion in sorted({r["cohesion_Pa"] for r in rows}):
        for key, name, unit, scale in quantities:
            values = {e: {r["seed"]: r[key] for r in rows if r["engine"] == e and r["cohesion_Pa"] == cohesion}
                      for e in ENGINES}
            yield compare(f"bed, {kilo(cohesion)}", name, unit, values, scale)


def plate_rows(folder):
    rows = rows_of(folder, "plate")
    for cohesion in sorted({r["cohesion_Pa"] for r in rows}):
        for depth in (1, 2, 3, 4):
            def near(row):
                z, p = numpy.array(row["sinkage_m"]) / RADIUS, numpy.array(row["pressure_Pa"])
                return float(p[(z > depth - 0.3) & (z < depth + 0.3)].mean())
            values = {e: {r["seed"]: near(r) for r in rows if r["engine"] == e and r["cohesion_Pa"] == cohesion}
                      for e in ENGINES}
            yield compare(f"plate, {kilo(cohesion)}", f"pressure at {depth} r", "kPa", values, 1e-3)


def coulomb(points):
    """Line through (σ, τ) points: (c, half interval) in kPa, (φ, half interval) in degrees."""
    sigma, tau = numpy.array(points).T / 1e3
    n, mean = len(sigma), sigma.mean()
    slope, offset = numpy.polyfit(sigma, tau, 1)
    spread = ((sigma - mean) ** 2).sum()
    scatter = ((tau - offset - slope * sigma) ** 2).sum() / (n - 2)
    t = student(n - 2)
    phi = (math.degrees(math.atan(slope)), math.degrees(t * math.sqrt(scatter / spread) / (1.0 + slope**2)))
    return (float(offset), t * math.sqrt(scatter * (1.0 / n + mean**2 / spread))), phi


def shear_rows(folder):
    rows = rows_of(folder, "shear")
    key = lambda r: (r["seed"], r["cohesion_Pa"], r["step_s"], r["pressure_Pa"])  # noqa: E731
    for cohesion in sorted({r["cohesion_Pa"] for r in rows}):
        cases = [(f"{v:g} m/s, step {h * 1e6:g} µs", h, (v,), "liggghts") for h in (4e-5, 2e-5) for v in SPEEDS]
        cases += [(f"all speeds, step {h * 1e6:g} µs", h, SPEEDS, "liggghts") for h in (4e-5, 2e-5)]
        cases += [("all speeds, step 40 µs, LIGGGHTS: sjkr", 4e-5, SPEEDS, "liggghts_sjkr")]
        for name, step, speeds, peer in cases:
            mine, theirs = ({key(r): r for r in rows if r["engine"] == e
                             and r["cohesion_Pa"] == cohesion and r["step_s"] == step}
                            for e in ("furrow", peer))
            both = sorted(set(mine) & set(theirs))
            compared = len(both) >= 4 and len({k[3] for k in both}) > 1
            if not compared and (len(mine) < 4 or peer != "liggghts"):
                continue
            # The speeds of one test are not independent: their mean is one point.
            fits = [coulomb([[numpy.mean([r[k][f"{what}_{v:g}_Pa"] for v in speeds]) for what in ("sigma", "tau")]
                             for k in (both if compared else r)]) for r in ((mine, theirs) if compared else (mine,))]
            for n, (quantity, unit) in enumerate((("c", "kPa"), ("φ", "°"))):
                row = dict.fromkeys(COLUMNS)
                row.update(test=f"shear, {kilo(cohesion)}, {name}", quantity=quantity, unit=unit,
                           seeds=len({k[0] for k in (both if compared else mine)}),
                           furrow=fits[0][n][0], furrow_ci95=fits[0][n][1])
                if compared:
                    row.update(liggghts=fits[1][n][0], liggghts_ci95=fits[1][n][1],
                               difference=fits[0][n][0] - fits[1][n][0],
                               difference_ci95=math.hypot(fits[0][n][1], fits[1][n][1]))
                yield row


def law_and_step(folder, to):
    """Shear stress under 100 kPa with cohesion 80 kPa, by tangential law and step: law_and_step.csv."""
    rows = [r for r in rows_of(folder, "shear") if r["cohesion_Pa"] == 80e3 and r["pressure_Pa"] == 100e3]
    with open(to / "law_and_step.csv", "w") as out:
        provenance.write_header(out, origin(folder))
        out.write("engine,step_us,seeds," + ",".join(f"tau_{v:g}_m_per_s_kPa,ci95" for v in SPEEDS)
                  + ",lid_sinks_mm,ci95\n")
        for engine, step in sorted({(r["engine"], r["step_s"]) for r in rows}):
            mine = [r for r in rows if (r["engine"], r["step_s"]) == (engine, step)]
            values = [[r[f"tau_{v:g}_Pa"] / 1e3 for r in mine] for v in SPEEDS] + [[-1e3 * r["rise_m"] for r in mine]]
            cells = ",".join(f"{numpy.mean(v):.3g},{half_interval(v):.2g}" for v in values)
            print(f"{engine},{1e6 * step:g},{len(mine)},{cells}")
            out.write(f"{engine},{1e6 * step:g},{len(mine)},{cells}\n")


def plot_trajectories(folder, to):
    series = read_series(folder / "trajectories.csv")
    shown = {"LIGGGHTS, bed shifted sideways": (style.GREY, "-"), "no friction": (style.GREEN, "-"),
             "tangential law of LIGGGHTS": (style.BLUE, "-"), "the same with cohesion 80 kPa": (style.SKY, "-"),
             "but not: springs end with contact": (style.PURPLE, "--"), "but not: damper of m*": (style.RED, "--"),
             "the engine as it is": (style.ORANGE, "-"), "mixed against double precision": ("black", ":")}
    figure, axis = driver.subplots(figsize=(7.5, 4.6))
    for name, (colour, line) in shown.items():
        if f"mean: {name}" in series:
            axis.semilogy(series["time_s"], numpy.maximum(series[f"mean: {name}"], 1e-18),
                          line, color=colour, label=name)
    axis.set(xlabel="time in s", ylabel="mean distance of the same grains in m", ylim=(1e-17, 1e-1),
             title="Falling grains, engine against LIGGGHTS from the same start")
    axis.legend(fontsize=7.5, loc="upper left")
    save(figure, to, "trajectories")


def plot_plate(folder, to):
    rows = rows_of(folder, "plate")
    figure, axis = driver.subplots(figsize=(6.4, 4.2))
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
    axis.set(xlabel="way of the plate in mm", ylabel="pressure in kPa",
             title="Plate 60 mm wide, 0.2 m/s; mean of the seeds, 95 % band")
    axis.legend()
    save(figure, to, "plate")


def plot_shear(folder, to):
    rows = rows_of(folder, "shear")
    figure, axes = driver.subplots(2, 3, figsize=(10.0, 6.6), sharex=True, sharey=True)
    for line_of_axes, step in zip(axes, (4e-5, 2e-5)):
        for axis, speed in zip(line_of_axes, SPEEDS):
            for e in ENGINES:
                colour, marker, line, name = LOOKS[e]
                for cohesion in sorted({r["cohesion_Pa"] for r in rows}):
                    points = [(r[f"sigma_{speed:g}_Pa"] / 1e3, r[f"tau_{speed:g}_Pa"] / 1e3) for r in rows
                              if (r["engine"], r["cohesion_Pa"], r["step_s"]) == (e, cohesion, step)]
                    if not points:
                        continue
                    sigma, tau = numpy.array(points).T
                    axis.plot(sigma, tau, marker, color=colour, ms=4, mfc=colour if cohesion else "none")
                    if len(points) < 4 or numpy.ptp(sigma) < 15.0:
                        continue
                    slope, offset = numpy.polyfit(sigma, tau, 1)
                    axis.plot([0, 110], [offset, offset + 110 * slope],
                              line, color=colour, label=f"{name}, {kilo(cohesion)}", lw=1)
            axis.set(title=f"{speed:g} m/s, step {1e6 * step:g} µs", xlim=(0, 112), ylim=(0, 70))
        line_of_axes[0].set_ylabel("shear stress in kPa")
    for axis in axes[1]:
        axis.set_xlabel("normal stress in kPa")
    axes[0][0].legend(fontsize=7.5)
    save(figure, to, "shear", 72)


def save(figure, to, name, dpi=90):
    figure.savefig(to / f"{name}.png", dpi=dpi)


def main():
    parser = driver.options(__doc__)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("to", type=pathlib.Path, nargs="?", default=pathlib.Path(__file__).resolve().parent)
    arguments = parser.parse_args()
    folder, to = arguments.out, arguments.to
    if not folder.is_dir():
        parser.error(f"{folder}: no such folder, expected what bulk.py left")
    table = [row for part in (bed_rows, plate_rows, shear_rows) for row in part(folder) if row]
    rows = [{k: row[k] for k in COLUMNS} for row in table]
    driver.write(to.resolve() / "bulk.csv", rows, origin(folder))
    compared = [row for row in rows if row["liggghts"] is not None]
    outside = [row for row in compared if abs(row["difference"]) > row["difference_ci95"]]
    for row in compared:
        cells = " | ".join(f"{row[name]:{form}} ± {row[f'{name}_ci95']:.2g}" for name, form in (
            ("furrow", ".4g"), ("liggghts", ".4g"), ("difference", "+.3g")))
        print(f"| {row['test']} | {row['quantity']}, {row['unit']} | {cells}{' *' if row in outside else ''} | "
              f"{row['seeds']} |")
    print(f"{len(outside)} of {len(compared)} differences outside their 95 % interval")
    law_and_step(folder, to)
    if (folder / "trajectories.csv").exists():
        plot_trajectories(folder, to)
        facts = json.loads((folder / "trajectories.json").read_text())
        (to / "trajectories.json").write_text(json.dumps({"made": origin(folder), **facts}, indent=1) + "\n")
    for test, plot in (("plate", plot_plate), ("shear", plot_shear)):
        if rows_of(folder, test):
            plot(folder, to)


if __name__ == "__main__":
    main()
