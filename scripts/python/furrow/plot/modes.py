"""Natural frequencies of a tire on a rim at rest: what `furrow modes` leaves in its directory."""
import matplotlib.pyplot as plt
import numpy as np

from .chart_table import MODES
from .run_data import Missing
from .soil import COLOURS, Soil
from .style import BLUE, GREY, RED, heading

MOST_ORDERS, MOST_NUMBERS = 6, 3  # of one picture
AMPLITUDE = 0.12                  # of the largest radius, of a picture
AROUND = np.linspace(0.0, 2.0 * np.pi, 361)
SPOKES = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)


class Modes(Soil):
    """summary.json and the tables beside it."""

    FIGURES = "summary.json"

    def title(self, figure, what):
        heading(figure, f"{self.values.get('tire', self.directory.name)} · {what}", 11)

    def frequencies(self):
        """{(order, number): Hz}"""
        table = self.table("modes.csv")
        return {(int(order), int(number)): value
                for order, number, value in zip(table["order"], table["number"], table["frequency_Hz"])}

    def shapes(self):
        """{(order, number): columns of its nodes, with complex amplitudes}"""
        table = self.table("shapes.csv")
        marks = np.stack([table["order"], table["number"]], axis=1).astype(int)
        found = {}
        for mark in dict.fromkeys(map(tuple, marks)):
            rows = np.all(marks == mark, axis=1)
            shape = {name: table[name][rows] for name in ("y_m", "radius_m")}
            for name in ("tangential", "axial", "radial"):
                shape[name] = table[name][rows] + 1j * table[f"{name}_imaginary"][rows]
            found[mark] = shape
        return found


def frequencies(run):
    """Natural frequencies against the circumferential order."""
    found = run.frequencies()
    figure, axis = plt.subplots(figsize=(7.2, 4.6))
    run.title(figure, f"{MODES.title} {MODES.sign}")
    for k, number in enumerate(sorted({number for _, number in found})):
        orders = sorted(order for order, which in found if which == number)
        values = np.array([found[order, number] for order in orders])
        axis.plot(orders, values, "o-", ms=4, color=COLOURS[k % len(COLOURS)])
        axis.plot(np.array(orders)[values < 0], values[values < 0], "x",
                  color=RED, label="not stable: growth rate / 2π" if np.any(values < 0) else None)
    axis.axhline(0.0, color=GREY, lw=0.6)
    if axis.get_legend_handles_labels()[0]:
        axis.legend()
    axis.xaxis.get_major_locator().set_params(integer=True)
    axis.set(xlabel=MODES.x_label, ylabel=MODES.label)
    return figure


def panels(run, what, height):
    """A panel for each of the first modes, lowest orders and numbers, with its frequency."""
    found, shapes = run.frequencies(), run.shapes()
    orders = sorted({order for order, _ in shapes})[:MOST_ORDERS]
    numbers = sorted({number for _, number in shapes})[:MOST_NUMBERS]
    if not orders:
        raise Missing("shapes.csv has no modes")
    figure, axes = plt.subplots(len(numbers), len(orders),
                                figsize=(2.3 * len(orders) + 0.3, height * len(numbers) + 0.5), squeeze=False)
    run.title(figure, what)
    for row, number in zip(axes, numbers):
        for axis, order in zip(row, orders):
            axis.set_axis_off()
            if (order, number) not in shapes:
                continue
            axis.set_title(f"order {order}: {found[order, number]:.4g} Hz", fontsize=8.5)
            axis.set_aspect("equal")
            yield figure, axis, order, shapes[order, number]


def displaced(shape, j, angles, order, scale):
    """x forward and z up of node j at these angles from the top, in the mode."""
    wave = scale * np.exp(1j * order * angles)
    at, turn = shape["radius_m"][j] + (wave * shape["radial"][j]).real, (wave * shape["tangential"][j]).real
    s, c = np.sin(angles), np.cos(angles)
    return at * s + turn * c, at * c - turn * s


def mode_shapes(run):
    """The tire from its side: the line of the largest radius, and spokes along the section from the rim up to it."""
    figure = None
    for figure, axis, order, shape in panels(run, "seen from the side, modes by number from above", 2.3):
        outer = int(np.argmax(shape["radius_m"]))
        scale = AMPLITUDE * shape["radius_m"][outer]
        still = dict.fromkeys(("radial", "tangential"), np.zeros(outer + 1)) | {"radius_m": shape["radius_m"]}
        for of, colour, width in ((still, GREY, 0.5), (shape, BLUE, 1.2)):
            axis.plot(*displaced(of, outer, AROUND, order, scale), color=colour, lw=width)
            spokes = np.array([displaced(of, j, SPOKES, order, scale) for j in range(outer + 1)])
            axis.plot(spokes[:, 0], spokes[:, 1], color=colour, lw=0.5 * width)
    return figure


def mode_sections(run):
    """Sections of a shell where their motion in the section is largest."""
    if not np.any(run.table("section.csv")["y_m"]):
        raise Missing("this tire is alike across its width")
    figure = None
    for figure, axis, _, shape in panels(run, "sections, modes by number from above", 1.6):
        inside = np.concatenate([shape["axial"], shape["radial"]])
        largest = inside[np.argmax(np.abs(inside))]
        phase = np.conj(largest) / abs(largest) if abs(largest) > 0 else 1.0
        scale = AMPLITUDE * np.max(shape["radius_m"])
        axis.plot(shape["y_m"], shape["radius_m"], color=GREY, lw=0.8)
        for sign, line in ((1.0, "-"), (-1.0, ":")):
            axis.plot(shape["y_m"] + sign * scale * (phase * shape["axial"]).real,
                      shape["radius_m"] + sign * scale * (phase * shape["radial"]).real, line, color=BLUE, lw=1.2)
    return figure
