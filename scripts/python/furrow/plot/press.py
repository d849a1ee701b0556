"""A tire pressed on a plate or a cleat: what `furrow press` leaves in its directory."""
import matplotlib.pyplot as plt
import numpy as np

from .chart_table import CENTRE_LINE, PRESS
from .soil import Soil
from .style import BLUE, GREY, ORANGE, heading


class Press(Soil):
    """summary.json and the tables beside it."""

    FIGURES = "summary.json"

    def title(self, figure, what):
        heading(figure, f"{self.values['scenario']} · {self.values['tire']} on a {self.values['obstacle']} · {what}",
                11)


def load_deflection(run):
    """Force against deflection of a pressed tire."""
    table = run.table("press.csv")
    figure, axis = plt.subplots(figsize=(7.2, 4.6))
    run.title(figure, PRESS.title)
    back = table["unloading"] > 0
    places, ((_, _, forces),) = PRESS.places(table), PRESS.curves(table)
    axis.plot(places[~back], forces[~back], "o-", color=BLUE, label="loading")
    axis.plot(places[back], forces[back], "x--", color=ORANGE, label="unloading")
    if run.values.get("deflection_m"):
        axis.axhline(1e-3 * run.values["load_N"], color=GREY, lw=0.8)
        axis.set_title(f"{1e-3 * run.values['load_N']:.3g} kN at {1e3 * run.values['deflection_m']:.2f} mm: "
                       f"secant {1e-3 * run.values['secant_stiffness_N_per_m']:.0f} kN/m")
    axis.set(xlabel=PRESS.x_label, ylabel=PRESS.label)
    axis.legend()
    return figure


def centre_line(axis, table, values):
    """Of a tire without points across."""
    axis.plot(CENTRE_LINE.places(table), CENTRE_LINE.values(table, "pressure_Pa"), ".-", color=BLUE)
    axis.set_ylim(bottom=0.0)
    axis.set(xlabel=CENTRE_LINE.x_label, ylabel=CENTRE_LINE.label, title=f"{1e-3 * values['force_N']:.3g} "
             f"kN: {1e3 * values['length_m']:.0f} mm long, mean {1e-3 * values['mean_pressure_Pa']:.0f} kPa")


def footprint(run):
    """Contact pressure of a pressed tire."""
    table = run.table("footprint.csv")
    values = run.values["footprint"]
    figure, axis = plt.subplots(figsize=(7.2, 4.6))
    run.title(figure, CENTRE_LINE.title)
    if not np.any(table["y_m"]):
        centre_line(axis, table, values)
        return figure
    points = axis.scatter(1e3 * table["y_m"], 1e3 * table["x_m"], c=1e-3 * table["pressure_Pa"], s=14, marker="s",
                          cmap="viridis", vmin=0, vmax=1e-3 * np.max(table["pressure_Pa"], initial=1.0))
    figure.colorbar(points, label="kPa")
    axis.set_aspect("equal")
    axis.set(xlabel="across, mm", ylabel="along, mm", title=f"{1e-3 * values['force_N']:.3g} kN: "
             f"{1e3 * values['length_m']:.0f} × {1e3 * values['width_m']:.0f} mm, mean "
             f"{1e-3 * values['mean_pressure_Pa']:.0f} kPa")
    return figure
