"""The page of a model fitted to data."""
import numpy as np

from ..plot.calibrate import quantity
from ..plot.units import is_number

from . import blocks

MOST_LINES = 40  # of one chart


def text_of(value, form=".4g"):
    return f"{value:{form}}" if is_number(value) else "–"


def shares(entries):
    """Largest errors over the peaks, %, of the targets that have one."""
    found = [entry.get("largest_error_of_peak") for entry in entries]
    return [100.0 * share for share in found if is_number(share)]


def counted(entries, what):
    return f"{len(entries)} {what}{'' if len(entries) == 1 else 's'}"


def words(run):
    """The result in one or two sentences."""
    fitted, predicted = (run.values.get(key) or [] for key in ("targets", "held_out_targets"))
    parameters = run.values.get("parameters") or {}
    text = f"{counted(parameters, 'parameter')} fitted to {counted(fitted, 'target')}"
    text += f": the largest error is {max(shares(fitted)):.2g} % of the peak." if shares(fitted) else "."
    if shares(predicted):
        text += (f" {counted(predicted, 'held-out target')} predicted, which were not fitted: "
                 f"the largest error is {max(shares(predicted)):.2g} % of the peak.")
    return text


def answer(run):
    rows = []
    for name, p in (run.values.get("parameters") or {}).items():
        interval = p.get("interval_95")
        rows.append([name, text_of(p.get("value")), text_of(p.get("standard_error"), ".2g"),
                     f"{interval[0]:.4g} … {interval[1]:.4g}" if isinstance(interval, list)
                     and all(map(is_number, interval)) else "–",
                     p.get("unit", ""), f"at its {p['at_bound']} bound" if p.get("at_bound") else ""])
    made = [blocks.text(words(run), "lead")]
    made += [blocks.text(str(warning), "warn") for warning in run.values.get("warnings") or []]
    made.append(blocks.table(["parameter", "value", "standard error", "95 % interval", "unit", ""], rows))
    return {"id": "answer", "title": "Result", "blocks": made}


def targets(run):
    rows = []
    for key, how in (("targets", "fitted"), ("held_out_targets", "predicted")):
        for target in run.values.get(key) or []:
            share, error = target.get("largest_error_of_peak"), target.get("largest_error")
            _, unit, factor = quantity(str(target.get("y", "")))
            rows.append([target.get("name", ""), target.get("what", ""), how, text_of(target.get("r_squared"), ".5f"),
                         text_of(factor * error if is_number(error) else None, ".3g"), unit,
                         text_of(100.0 * share if is_number(share) else None, ".2g"), str(target.get("problem", ""))])
    return {"id": "targets", "title": "Targets",
            "blocks": [blocks.table(["target", "what", "", "R²", "largest error", "unit", "% of the peak", ""], rows)]}


def figures(run):
    """What was reached of targets that are figures with names, beside what was wanted."""
    rows = []
    for key in ("targets", "held_out_targets"):
        for target in run.values.get(key) or []:
            for f in target.get("figures") or []:
                surrogate, span = f.get("surrogate") or {}, f.get("evaluations_span") or []
                rows.append([f.get("label", ""), text_of(f.get("target")), text_of(f.get("sigma"), ".2g"),
                             text_of(f.get("evaluated")), text_of(f.get("standard_error"), ".2g"),
                             text_of(surrogate.get("value")), text_of(surrogate.get("standard_error"), ".2g"),
                             " … ".join(text_of(value) for value in span),
                             str(f.get("state", "" if key == "targets" else "held out"))])
    if not rows:
        return None
    return blocks.table(["figure", "target", "±", "evaluated", "±", "all evaluations together",
                         "±", "evaluations span", ""], rows)


def curves(run, arrays):
    groups = {}
    for target in run.targets():
        if any(target["labels"]):
            continue
        groups.setdefault((target["x_name"], target["y_name"]), []).append(target)
    items = []
    for (x, y), members in groups.items():
        (x_words, x_unit, x_factor), (words, unit, factor) = quantity(x), quantity(y)
        lines = []
        for target in members:
            place = arrays.add(x_factor * target["x"], exact=True)
            lines.append({"label": f"{target['name']}, data", "x": place,
                          "y": arrays.add(factor * target["data"]), "style": "points"})
            if np.isfinite(target["model"]).all():
                lines.append({"label": f"{target['name']}, {'predicted' if target['held_out'] else 'fitted'}",
                              "x": place, "y": arrays.add(factor * target["model"]), "style": "line"})
        items.append({**blocks.chart(words.capitalize(), x_words, x_unit, unit, lines[:MOST_LINES]), "wide": True})
    table = figures(run)
    return {"id": "series", "title": "Data and model",
            "blocks": ([table] if table else []) + ([blocks.charts(items)] if items else [])}


def starts(run):
    rows = []
    for k, start in enumerate(run.values.get("starts") or []):
        end = ", ".join(f"{name} {value:.4g}" for name, value in (start.get("end") or {}).items())
        rows.append([str(k + 1), text_of(start.get("sum_of_squares"), ".6g"),
                     str(start.get("iterations", "")), str(start.get("ended", "")), end])
    singular = (run.values.get("identifiability") or {}).get("singular_values") or []
    return {"id": "starts", "title": "Starts",
            "blocks": [blocks.table(["start", "sum of squares", "iterations", "ended", "at"], rows),
                       blocks.text("Singular values of the Jacobian over the deviation of the residuals, parameters on "
                                   "their scales: " + ", ".join(text_of(value, ".3g") for value in singular))]}


def fill(page, arrays, run, sections):
    page["title"] = f"{run.values.get('study', '')} · calibration of {run.values.get('start', '')}"
    page["badges"] = [{"text": "with warnings", "kind": "warn"}] if run.values.get("warnings") else []
    sections(page, [("parameters", lambda: answer(run)), ("targets", lambda: targets(run)),
                    ("curves", lambda: curves(run, arrays)), ("starts", lambda: starts(run))])
