"""The pages of soil tests, of a pressed tire, of its frequencies and of a vehicle's suspensions."""
import numpy as np

from ..plot.chart_table import CENTRE_LINE, MODES, MOTIONS, PRESS
from ..plot.chart_table import SOIL as CHARTS
from ..plot.run_data import Missing
from ..plot.soil import runs
from ..plot.units import is_number, naming

from . import blocks, scenario

# Soil values: key, words, unit, factor.
SOIL = (("k_c", "k_c", "kN/mⁿ⁺¹", 1e-3), ("k_phi", "k_φ", "kN/mⁿ⁺²", 1e-3), ("n", "sinkage exponent n", "", 1.0),
        ("cohesion_Pa", "cohesion c", "kPa", 1e-3), ("friction_angle_deg", "friction angle φ", "°", 1.0),
        ("janosi_K_m", "shear modulus K", "mm", 1e3),
        ("final_cohesion_Pa", "cohesion at the end", "kPa", 1e-3),
        ("final_friction_angle_deg", "friction angle at the end", "°", 1.0),
        ("cone_index_Pa", "cone index", "kPa", 1e-3), ("repose_angle_deg", "angle of repose", "°", 1.0),
        ("repose_angle_without_cohesion_deg", "angle of repose without cohesion", "°", 1.0))
FOOTPRINT = ("force_N", "length_m", "width_m", "mean_pressure_Pa", "max_pressure_Pa")


def line(arrays, label, x, y, style="line"):
    return {"label": label, "x": arrays.add(x, exact=True), "y": arrays.add(y), "style": style}


def soil_values(soil):
    rows = []
    errors, intervals = (soil.values.get(key) or {} for key in ("standard_error", "interval_95"))
    for key, words, unit, factor in SOIL:
        value, error, interval = soil.values.get(key), errors.get(key), intervals.get(key)
        if is_number(value):
            known = isinstance(interval, list) and len(interval) == 2 and all(map(is_number, interval))
            rows.append([words, f"{factor * value:.4g}", f"{factor * error:.2g}" if is_number(error) else "–",
                         f"{factor * interval[0]:.3g} … {factor * interval[1]:.3g}" if known else "–", unit])
    made = [blocks.table(["parameter", "value", "standard error", "95 % interval", "unit"], rows)] if rows else []
    if soil.values.get("quick"):
        made.insert(0, blocks.text("A quick look with few and small tests: no result to quote.", "warn"))
    return {"id": "answer", "title": "Result", "blocks": made}


def soil_volumes(soil):
    """Where the soil under each plate went, means over the beds."""
    rows = []
    for plate in (soil.values.get("plate") or {}).get("plates") or []:
        tests = plate["tests"]
        depth, displaced = (sum(test[key] for test in tests) / len(tests) for key in ("bed_depth_m", "displaced_m3"))
        row = [plate["shape"], f"{1e3 * plate['size_m']:.4g}", f"{1e3 * depth:.3g}", f"{1e6 * displaced:.3g}"]
        for of in ("", "unloaded_"):
            for share in ("heaved_share", "compacted_share", "volume_residual_share"):
                value = plate.get(of + share)
                row.append(f"{100 * value:.0f} %" if is_number(value) else "–")
        rows.append(row)
    if not rows:
        raise Missing("no plate was pushed in")
    head = ["plate", "size, mm", "bed, mm", "displaced, cm³", "heaved", "compacted", "not accounted for",
            "unloaded: heaved", "compacted", "not accounted for"]
    return {"id": "volumes", "title": "Displaced volume", "blocks": [blocks.table(head, rows)]}


def soil_cones(soil):
    rows = []
    for cone in (soil.values.get("cone") or {}).get("cones") or []:
        values = [(cone[key], factor) for key, factor in (("index_Pa", 1e-3), ("mean_Pa", 1e-3),
                                                          ("gradient_Pa_per_m", 1e-6))]
        rows.append([f"{1e3 * cone['base_diameter_m']:.4g}", f"{cone['base_diameter_grains']:.3g}",
                     *(f"{factor * value:.4g}" if is_number(value) else "–" for value, factor in values)])
    if not rows:
        raise Missing("no cone was pushed in")
    head = ["base, mm", "base, grains", "index, kPa", "mean, kPa", "gradient, MPa/m"]
    return {"id": "cones", "title": "Cones of several sizes", "blocks": [blocks.table(head, rows)]}


def soil_curves(soil, arrays):
    items = []
    for test, (chart, keys) in CHARTS.items():
        try:
            table = soil.table(f"{test}.csv")
        except Missing:
            continue
        (_, _, values), = chart.curves(table)
        keys += tuple(key for key in ("diameter_m", "bed_depth_m") if key in table)
        lines = []
        for mark, which in runs(table, *keys):
            label = ", ".join(f"{name.replace('nominal ', '')} {scale * value:g} {of}".strip()
                              for (name, of, scale), value in zip(map(naming, keys), mark))
            lines.append(line(arrays, label, chart.places(table)[which], values[which]))
        items.append({**blocks.of(chart, lines[:40]), "wide": True})
    if not items:
        raise Missing("there is no table of a test")
    return {"id": "series", "title": "Curves", "blocks": [blocks.charts(items)]}


def kept_scenario(directory):
    from ..plot.run_data import read_object
    path = directory / "scenario.json"
    return scenario.section(read_object(path)) if path.is_file() else None


def provenance(values):
    kept = [(key, value) for key, value in values.items() if isinstance(value, (str, int, float))]
    return {"id": "provenance", "title": "All values", "blocks": [blocks.values_table(kept)]}


def soil(page, arrays, run, sections):
    page["title"] = f"{run.values.get('scenario', run.directory.name)} · soil tests"
    page["badges"] = [{"text": "quick look", "kind": "warn"}] if run.values.get("quick") else []
    sections(page, [("result", lambda: soil_values(run)), ("displaced volume", lambda: soil_volumes(run)),
                    ("cones", lambda: soil_cones(run)), ("curves", lambda: soil_curves(run, arrays)),
                    ("scenario", lambda: kept_scenario(run.directory)), ("all values", lambda: provenance(run.values))])


def stability(values):
    """(sentence, tone) on the equilibria of a press; older results say nothing of the way."""
    if not values["statically_stable"]:
        return ("The tire wrinkles under its pressure before it is pressed: its equilibria need not be the only ones.",
                "warn")
    if values.get("stable_while_pressed") is False:
        return ("The inflated tire is stable, and buckles while it is pressed: its equilibria need not be the only "
                "ones.", "warn")
    return ("The tire is statically stable along the whole curve." if values.get("stable_while_pressed") else
            "The inflated tire is statically stable before it is pressed."), "good"


def press_answer(run):
    values, items = run.values, []
    for key in ("load_N", "deflection_m", "secant_stiffness_N_per_m", "tangent_stiffness_N_per_m", "pressure_Pa"):
        if is_number(values.get(key)):
            value, unit = blocks.quantity(key, values[key])
            items.append(blocks.card(naming(key)[0], value, unit))
    for key in FOOTPRINT:
        if is_number((values.get("footprint") or {}).get(key)):
            value, unit = blocks.quantity(key, values["footprint"][key])
            items.append(blocks.card(f"footprint {naming(key)[0]}", value, unit))
    made = [blocks.cards(items)]
    if is_number(values.get("deflection_m")) and is_number(values.get("load_N")):
        made.insert(0, blocks.text(f"Under {values['load_N']:.4g} N the tire deflects by "
                                   f"{1e3 * values['deflection_m']:.4g} mm.", "lead"))
    if isinstance(values.get("statically_stable"), bool):
        made.append(blocks.text(*stability(values)))
    return {"id": "answer", "title": "Result", "blocks": made}


def press_curves(run, arrays):
    table = run.table("press.csv")
    back = table["unloading"] > 0
    order = np.argsort(table["deflection_m"], kind="stable")
    lines = []
    for name, which, dash in (("loading", ~back, None), ("unloading", back, [6, 6])):
        if which.any():
            rising = order[which[order]]
            lines.append({**line(arrays, name, PRESS.places(table)[rising],
                                 PRESS.values(table, "force_N")[rising], "points"), "dash": dash})
    return {"id": "series", "title": PRESS.title,
            "blocks": [blocks.charts([{**blocks.of(PRESS, lines), "wide": True}])]}


def footprint(run, arrays):
    table = run.table("footprint.csv")
    if np.any(table["y_m"]):
        return {"id": "footprint", "title": "Footprint", "blocks": [{
            "type": "scatter", "x": arrays.add(1e3 * table["x_m"]), "y": arrays.add(1e3 * table["y_m"]),
            "values": arrays.add(1e-3 * table["pressure_Pa"]), "label": "contact pressure", "unit": "kPa"}]}
    lines = [line(arrays, CENTRE_LINE.y, CENTRE_LINE.places(table), CENTRE_LINE.values(table, "pressure_Pa"), "points")]
    return {"id": "footprint", "title": "Footprint",
            "blocks": [blocks.charts([{**blocks.of(CENTRE_LINE, lines), "wide": True}])]}


def flat(values, **groups):
    """The values with those of nested groups beside them, each group's words before their keys."""
    return {**values, **{f"{words} {key}": value for group, words in groups.items() for key,
                         value in (values.get(group) or {}).items()}}


def press(page, arrays, run, sections):
    page["title"] = (f"{run.values.get('scenario', '')} · {run.values.get('tire', '')} on a "
                     f"{run.values.get('obstacle', '')}")
    sections(page, [("result", lambda: press_answer(run)), ("load and deflection", lambda: press_curves(run, arrays)),
                    ("footprint", lambda: footprint(run, arrays)), ("scenario", lambda: kept_scenario(run.directory)),
                    ("all values", lambda: provenance(flat(run.values, footprint="footprint",
                                                           sticking_stiffness="sticking stiffness")))])


def mode_frequencies(run, arrays):
    found = run.frequencies()
    lines = []
    for number in sorted({number for _, number in found}):
        orders = sorted(order for order, which in found if which == number)
        lines.append(line(arrays, f"frequency {number}", np.array(orders, dtype=float),
                          np.array([found[order, number] for order in orders]), "points"))
    return {"id": "series", "title": MODES.title,
            "blocks": [blocks.charts([{**blocks.of(MODES, lines), "wide": True}])]}


def modes(page, arrays, run, sections):
    page["title"] = f"{run.values.get('tire', '')} · {MODES.title.lower()} {MODES.sign}"
    sections(page, [("frequencies", lambda: mode_frequencies(run, arrays)),
                    ("all values",
                     lambda: provenance({key: value for key, value in run.values.items() if key != "modes"}))])


def motion(run, arrays, name):
    """The plots of one motion of the suspensions."""
    if name not in run.motions:
        raise Missing(f"no axle of this vehicle has the motion '{name}'")
    items = []
    for chart in run.charts(name):
        column, = chart.lines
        places = {wheel: chart.places({chart.x: values}) for wheel, values in run.curves(name, chart.x)}
        items.append(blocks.of(chart, [line(arrays, wheel, places[wheel], chart.values({column: values}, column))
                                       for wheel, values in run.curves(name, column) if np.isfinite(values).any()]))
    return {"id": name, "title": MOTIONS[name][0], "blocks": [blocks.charts(items)]}


def kinematics(page, arrays, run, sections):
    page["title"] = f"{run.values.get('vehicle', '')} · suspensions"
    sections(page, [(name, lambda name=name: motion(run, arrays, name)) for name in MOTIONS if name in run.motions]
             + [("all values", lambda: provenance(run.values))])
