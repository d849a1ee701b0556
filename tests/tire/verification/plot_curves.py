#!/usr/bin/python3
"""Charts of curves.csv, beside it: load_deflection.png, layered_stability.png."""
import csv
import io
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from PIL import Image

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[2] / "scripts" / "python"))
from furrow.plot import style  # noqa: E402

COLOURS = [style.SKY, style.ORANGE, style.BLUE]


def save(figure, name):
    """With a palette: a third of the size."""
    memory = io.BytesIO()
    figure.savefig(memory, dpi=80)
    Image.open(memory).convert("RGB").quantize(64).save(HERE / name, optimize=True)


def curves():
    """case → curve → list of (load, deflection, reference or None)."""
    cases = {}
    with open(HERE / "curves.csv") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            points = cases.setdefault(row["case"], {}).setdefault(row["curve"], [])
            points.append((float(row["load"]), float(row["deflection"]),
                           float(row["reference"]) if row["reference"] else None))
    return cases


def deflections(axis, lines, title, label):
    """Deflection right, load up; the reference gives deflections at the same loads."""
    meshes = list(dict.fromkeys(name.split(", ")[1] for name in lines))
    for name, points in lines.items():
        quantity, mesh = name.split(", ")
        axis.plot([0] + [p[1] for p in points], [0] + [p[0] for p in points], ".-", ms=3,
                  color=COLOURS[len(COLOURS) - len(meshes) + meshes.index(mesh)],
                  label=mesh if quantity == list(lines)[0].split(", ")[0] else None)
        if mesh == meshes[-1]:
            axis.plot([p[2] for p in points], [p[0] for p in points], "o", mfc="none", color=style.RED, ms=6)
            axis.annotate(quantity, (points[-1][1], points[-1][0]), textcoords="offset points", xytext=(-4, 5),
                          ha="right", fontsize=8)
    axis.set(title=title, xlabel=label, ylabel="P / Pmax", ylim=(0, 1.12))
    axis.legend(loc="upper left", title="elements", title_fontsize=8, fontsize=8)


def load_deflection(cases):
    figure, axes = plt.subplots(2, 3, figsize=(12.5, 7.4))
    flat = axes.ravel()
    deflections(flat[0], cases["cantilever, end force"], "Cantilever, end force", "deflection, shortening; L = 10")
    deflections(flat[1], cases["slit annular plate"], "Slit annular plate, edge lifted", "deflection; radii 6 and 10")
    deflections(flat[2], cases["pinched hemisphere"], "Hemisphere with a hole, pinched", "deflection; radius 10")
    deflections(flat[3], cases["pull-out of a cylinder"], "Open cylinder, pulled", "deflection; radius 4.953")
    for name, colour in zip(["isotropic", "0/90/0", "90/0/90"], [style.BLUE, style.ORANGE, style.GREEN]):
        lines = cases[f"hinged roof, {name}"]
        points = lines["16 x 16"]
        flat[4].plot([0] + [p[1] for p in points], [0] + [p[0] for p in points], ".-", ms=3, color=colour, label=name)
        flat[4].plot([p[1] for p in points], [p[2] for p in points], "o", mfc="none", color=style.RED, ms=6)
    flat[4].set(title="Hinged roof, 16 x 16 of a quarter", xlabel="central deflection; radius 2540, h = 12.7",
                ylabel="P / 3000")
    flat[4].legend(fontsize=8)
    for colour, (name, points) in zip(COLOURS, cases["strip rolled up"].items()):
        flat[5].plot([0] + [p[0] for p in points], [0] + [p[1] for p in points],
                     color=colour, label=name.split(", ")[1])
    flat[5].plot([0, 1], [0, 1], "--", color=style.RED, label="M = E I κ")
    flat[5].set(title="Strip rolled up", xlabel="end rotation / 2π", ylabel="end moment / (2π E I/L)")
    flat[5].legend(fontsize=8)
    figure.suptitle("Lines: this element.  Circles: Sze, Liu & Lo 2004", x=0.01, ha="left", fontsize=11)
    save(figure, "load_deflection.png")


def layered(cases):
    figure, axes = plt.subplots(1, 3, figsize=(12.5, 3.8))
    for axis, mesh in zip(axes, ["90 x 24", "180 x 48"]):
        lines = {n: p for n, p in cases["layered tire, lowest frequency by order, Hz"].items() if n.endswith(mesh)}
        for colour, (name, points) in zip([style.GREY, style.SKY, style.ORANGE, style.RED][-len(lines):],
                                          lines.items()):
            axis.plot([p[0] for p in points], [p[1] for p in points], ".-",
                      ms=3, color=colour, label=name.split(", ")[0])
        axis.axhline(0, color="black", lw=0.8)
        axis.set(title=f"Layered tire, {mesh}", xlabel="circumferential order", ylim=(-3500, 1500),
                 ylabel="lowest frequency, Hz; below 0: growth rate / 2π")
        axis.legend(fontsize=8)
    for name, points in cases["inflation"].items():
        tire, quantity = name.split(", ")[:2]
        axes[2].plot([p[0] for p in points], [p[1] for p in points], marker=".", ms=6,
                     color=style.BLUE if "layered" in tire else style.ORANGE,
                     ls="-" if "crown" in quantity else "--",
                     label=f"{tire.split('_')[1].split('.')[0]}, {quantity}")
    axes[2].set(title="Inflation, 90 x 24", xlabel="pressure, kPa", ylabel="mm")
    axes[2].legend(fontsize=8)
    save(figure, "layered_stability.png")


if __name__ == "__main__":
    data = curves()
    load_deflection(data)
    layered(data)
