"""Virtual soil tests: what `furrow soil` leaves in its directory."""
import matplotlib.pyplot as plt
import numpy as np

from .chart_table import SOIL
from .run_data import Missing, read_object, read_table
from .style import BLUE, GREEN, GREY, ORANGE, PURPLE, RED, heading

COLOURS = [BLUE, ORANGE, GREEN, RED, PURPLE]


class Soil:
    """A file of figures and the tables beside it."""

    FIGURES = "soil.json"

    def __init__(self, directory):
        self.directory = directory
        self.values = read_object(directory / self.FIGURES)

    def table(self, name):
        """The columns of a CSV file as arrays."""
        path = self.directory / name
        if not path.exists():
            raise Missing(f"this test was not run: there is no {name}")
        return read_table(path)

    def text(self, name, factor=1.0, form=".3g"):
        """value ± standard error."""
        value, error = self.values.get(name), (self.values.get("standard_error") or {}).get(name)
        if value is None:
            return "?"
        return f"{factor * value:{form}}" + (f" ± {factor * error:.2g}" if error is not None else "")

    def figure(self, test, columns=1, height=4.6):
        figure, axes = plt.subplots(1, columns, figsize=(6.4 * columns if columns > 1 else 8.4, height), squeeze=False)
        grains = self.values.get("grains") or {}
        note = ", quick look: no result to quote" if self.values.get("quick") else ""
        heading(figure, f"{self.values.get('scenario', self.directory.name)} · {SOIL[test][0].title} · grains of "
                        f"{1e3 * grains.get('radius_m', np.nan):g} mm, cohesion "
                        f"{1e-3 * grains.get('cohesion_Pa', np.nan):g} kPa{note}", 11)
        return figure, axes[0]


def labels_of(test):
    chart, _ = SOIL[test]
    return {"xlabel": chart.x_label, "ylabel": chart.label}


def runs(table, *keys):
    """(key values, rows) of each run in a table, in order of first appearance."""
    marks = np.stack([table[key] for key in keys], axis=1)
    for mark in dict.fromkeys(map(tuple, marks)):
        yield mark, np.all(marks == mark, axis=1)


def plate(soil):
    """Pressure against sinkage."""
    table = soil.table("plate.csv")
    if "diameter_m" in table:
        return plates_in_metres(soil, table)
    figure, (axis,) = soil.figure("plate")
    widths = list(dict.fromkeys(table["width_m"]))
    for (_, width), rows in runs(table, "seed", "width_m"):
        axis.plot(1e3 * table["sinkage_m"][rows], 1e-3 * table["pressure_Pa"][rows], lw=0.8, alpha=0.55,
                  color=COLOURS[widths.index(width) % len(COLOURS)])
    n, k_c, k_phi = (soil.values.get(name) for name in ("n", "k_c", "k_phi"))
    z = np.linspace(0.0, table["sinkage_m"].max(), 200)[1:]
    for i, width in enumerate(widths):
        if n is not None:
            axis.plot(1e3 * z, 1e-3 * (k_c / width + k_phi) * z**n, color=COLOURS[i % len(COLOURS)], lw=2.2,
                      label=f"strip {1e3 * width:g} mm wide")
    axis.set(xlim=0.0, ylim=0.0, **labels_of("plate"))
    axis.set_title(f"Thin: each bed. Thick: p = (k_c/b + k_φ) zⁿ, n {soil.text('n')}, k_c {soil.text('k_c', 1e-3)} "
                   f"kN/mⁿ⁺¹, k_φ {soil.text('k_phi', 1e-3)} kN/mⁿ⁺²", fontsize=9)
    axis.legend(loc="upper left")
    return figure


def plates_in_metres(soil, table):
    """Discs and strips, on beds of several depths: each bed's curve with the power law of its size."""
    figure, (axis,) = soil.figure("plate")
    plates = (soil.values.get("plate") or {}).get("plates") or []
    for i, plate in enumerate(plates):
        colour, depths = COLOURS[i % len(COLOURS)], [test["bed_depth_m"] for test in plate["tests"]]
        diameter = plate["size_m"] if plate["shape"] == "disc" else 0.0
        for depth in depths:
            rows = (np.isclose(table["width_m"], plate["b_m"]) & np.isclose(table["diameter_m"], diameter)
                    & np.isclose(table["bed_depth_m"], depth))
            axis.plot(1e3 * table["sinkage_m"][rows], 1e-3 * table["pressure_Pa"][rows], lw=0.8, alpha=0.55,
                      color=colour)
        if plate["n"] is not None:
            z = np.linspace(0.0, table["sinkage_m"].max(), 200)[1:]
            axis.plot(1e3 * z, 1e-3 * plate["k"] * z**plate["n"], color=colour, lw=2.2,
                      label=f"{plate['shape']} {1e3 * plate['size_m']:g} mm, bed {1e3 * np.mean(depths):.0f} mm deep, "
                      f"n {plate['n']:.3g}")
    axis.set(xlim=0.0, ylim=0.0, **labels_of("plate"),
             title="Thin: each bed. Thick: p = k zⁿ of each size and depth")
    axis.legend(loc="lower right")
    return figure


def shear(soil):
    """Shear stress against displacement, and the strength."""
    table = soil.table("shear.csv")
    figure, (left, right) = soil.figure("shear", columns=2)
    loads = list(dict.fromkeys(table["nominal_normal_stress_Pa"]))
    for (_, load), rows in runs(table, "seed", "nominal_normal_stress_Pa"):
        left.plot(1e3 * table["travel_m"][rows], 1e-3 * table["shear_stress_Pa"][rows], lw=0.8, alpha=0.5,
                  color=COLOURS[loads.index(load) % len(COLOURS)])
    tests = (soil.values.get("shear") or {}).get("tests") or []
    j = np.linspace(0.0, table["travel_m"].max(), 200)
    for i, load in enumerate(loads):
        near = [t for t in tests if abs(t["normal_stress_Pa"] - load) < 0.2 * load]
        if not near:
            continue
        tau, travel = (np.mean([t[name] for t in near]) for name in ("tau_max_Pa", "janosi_K_m"))
        left.plot(1e3 * j, 1e-3 * tau * -np.expm1(-j / travel), color=COLOURS[i % len(COLOURS)], lw=2.2,
                  label=f"normal stress {1e-3 * load:g} kPa")
    left.set(xlim=0.0, ylim=0.0, **labels_of("shear"),
             title=f"Thin: each bed. Thick: τ_max (1 − exp(−j/K)), K {soil.text('janosi_K_m', 1e3)} mm")
    left.legend(loc="upper left")
    sigma = 1e-3 * np.array([t["normal_stress_Pa"] for t in tests])
    right.plot(sigma, [1e-3 * t["tau_max_Pa"] for t in tests], "o", color=BLUE, label="fitted τ_max")
    right.plot(sigma, [1e-3 * t["final_shear_stress_Pa"] for t in tests],
               "x", color=GREY, label="at the end of the travel")
    c, phi = soil.values.get("cohesion_Pa"), soil.values.get("friction_angle_deg")
    if c is not None and len(sigma):
        x = np.linspace(0.0, 1.05 * sigma.max(), 2)
        right.plot(x, 1e-3 * c + x * np.tan(np.radians(phi)), color=BLUE, label="c + σ tan φ")
    right.set(xlim=0.0, ylim=0.0, xlabel="normal stress, kPa",
              title=f"c {soil.text('cohesion_Pa', 1e-3)} kPa, φ {soil.text('friction_angle_deg')}°")
    right.legend(loc="upper left")
    return figure


def cone(soil):
    """Cone resistance against depth."""
    table = soil.table("cones.csv" if (soil.directory / "cones.csv").exists() else "cone.csv")
    figure, (axis,) = soil.figure("cone")
    about = soil.values.get("cone") or {}
    keys = ["base_diameter_m", "seed"] if "base_diameter_m" in table else ["seed"]  # earlier results have one cone
    sizes = list(dict.fromkeys(table[keys[0]])) if len(keys) > 1 else []
    for (size, *_), rows in runs(table, *keys):
        i = sizes.index(size) if sizes else 0
        first = bool(sizes) and not any(line.get_color() == COLOURS[i % len(COLOURS)] for line in axis.lines)
        axis.plot(1e-3 * table["pressure_Pa"][rows], 1e3 * table["depth_m"][rows], lw=1.0, alpha=0.6,
                  color=COLOURS[i % len(COLOURS)], label=f"base {1e3 * size:.4g} mm" if first else None)
    if about.get("index_depth_m"):
        axis.axhspan(*(1e3 * depth for depth in about["index_depth_m"]), color=BLUE, alpha=0.08, lw=0,
                     label="cone index: mean over this depth")
        axis.legend(loc="lower right")
    axis.invert_yaxis()
    axis.set(xlim=0.0, xlabel=SOIL["cone"][0].label, ylabel=SOIL["cone"][0].x_label,
             title=f"30° cone, base {1e3 * about.get('base_diameter_m', np.nan):g} mm "
             f"({about.get('base_diameter_grains', np.nan):g} grains): cone index {soil.text('cone_index_Pa', 1e-3)} "
             "kPa")
    return figure


def repose(soil):
    """The slope that is left when a wall is taken away."""
    table = soil.table("repose.csv")
    figure, (axis,) = soil.figure("repose", height=3.9)
    cohesions = list(dict.fromkeys(table["cohesion_Pa"]))
    names = ["repose_angle_deg", "repose_angle_without_cohesion_deg"]
    labelled = set()
    for (_, cohesion), rows in runs(table, "seed", "cohesion_Pa"):
        i = cohesions.index(cohesion)
        label = f"cohesion {1e-3 * cohesion:g} kPa: {soil.text(names[min(i, 1)])}°"
        axis.plot(table["x_m"][rows], table["height_after_m"][rows], lw=1.0, alpha=0.7, color=COLOURS[i % len(COLOURS)],
                  label=None if label in labelled else label)
        labelled.add(label)
    _, first = next(runs(table, "seed", "cohesion_Pa"))
    axis.plot(table["x_m"][first], table["height_before_m"][first], color=GREY, lw=1.0, ls="--", label="before")
    axis.set(aspect="equal", xlim=0.0, ylim=0.0, **labels_of("repose"),
             title="Surface after half of the bed was taken away")
    axis.legend(loc="upper right")
    return figure
