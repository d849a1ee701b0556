"""Several runs on one page: their answers with intervals beside each other, and their curves laid over each other."""
from ..plot.chart_table import WHEEL
from ..plot.digits import digits
from ..plot.run_data import Missing
from ..plot.units import is_number, naming

from . import blocks, curves, run_page, scenario

KEYS = ("drawbar_pull_N", "sinkage_m", "rut_depth_m", "drawbar_coefficient", "drive_torque_Nm", "tractive_efficiency",
        "vertical_load_N")


def names(runs):
    """A name for each run: its folder, with the parent's where folders are called alike."""
    plain = [run.directory.resolve().name for run in runs]
    return [f"{run.directory.resolve().parent.name}/{name}" if plain.count(name) > 1 else name for run,
            name in zip(runs, plain)]


def mean_and_half(summary, key):
    """(mean, half its 95 % interval or None)."""
    value = summary.get(key)
    if isinstance(value, dict):
        return value.get("mean"), blocks.half_95(value.get("sem"), value.get("n_eff"))
    stem = key.removesuffix("_m")
    return value, blocks.half_95(summary.get(f"{stem}_sem_m"), summary.get(f"{stem}_n_eff"), blocks.LEAST_SAMPLES)


def results(runs, arrays):
    rows, items, missing = [], [], []
    called = names(runs)
    for key in KEYS:
        found = [mean_and_half(run.summary, key) for run in runs]
        if not any(is_number(mean) for mean, _ in found):
            continue
        words, unit, factor = naming(key)
        rows.append([words] + [blocks.quantity(key, mean, half)[0] for mean, half in found] + [unit])
        lines = []
        for k, (mean, half) in enumerate(found):
            if is_number(mean):
                one = {"label": called[k], "x": arrays.add([k + 1], exact=True),
                       "y": arrays.add([factor * mean]), "style": "points"}
                if half is not None:
                    one["low"], one["high"] = (arrays.add([factor * (mean + sign * half)]) for sign in (-1, 1))
                lines.append(one)
        items.append(blocks.chart(words.capitalize(), "run", "", unit, lines))
    missing = [name for name, run in zip(called, runs) if not run.summary]
    made = [blocks.table(["quantity", *called, "unit"], rows)] if rows else []
    for name, run in zip(called, runs):
        pull = run.summary.get("drawbar_pull_N") or {}
        if is_number(pull.get("mean")) and not pull.get("steady"):
            made.append(blocks.text(f"The pull of {name} is not steady: its interval is too small.", "warn"))
    if missing:
        made.append(blocks.text(f"Without a summary (failed, stopped or still running): {', '.join(missing)}.", "warn"))
    if items:
        made.append(blocks.charts(items, "Whiskers: 95 % interval of each run's own mean. It does not cover the "
                                  "scatter between beds."))
    return {"id": "answer", "title": "Results", "blocks": made}


def overlay(runs, arrays):
    """The columns of wheel 0 of each run laid over each other."""
    tables = {}
    for name, run in zip(names(runs), runs):
        wheels = run_page.wheel_tables(run)
        if wheels:
            tables[name] = curves.Table(run, next(iter(wheels.values())), arrays)
    columns = dict.fromkeys(name for chart in WHEEL.values() for name in chart.lines)
    items = []
    for column in columns:
        lines = [table.line(column, name) for name, table in tables.items() if not curves.empty(table, column)]
        if lines:
            words, unit, _ = naming(column)
            items.append(blocks.chart(words.capitalize(), "time", "s", unit, lines))
            curves.limit_slip(items[-1], column, *tables.values())
    if not items:
        raise Missing("no run has a table of a wheel")
    return {"id": "series", "title": "Curves", "blocks": [blocks.charts(items, "Wheel 0 of each run.")]}


def differences(runs):
    """The keys in which the scenarios differ."""
    found = [{key: scenario.shown(value) for key, value, _ in scenario.flat(run.scenario, {}, {}, "")} for run in runs]
    keys = [key for key in dict.fromkeys(key for one in found for key in one)
            if key not in ("description", "completed_by")
            and len({one.get(key) for one in found}) > 1]
    return {"id": "scenario", "title": "Scenarios", "blocks": [
        blocks.table(["key", *names(runs)], [[key, *(one.get(key, "–") for one in found)] for key in keys],
                     note="Only keys that differ." if keys else "The scenarios are the same.")]}


def provenance(runs):
    keys = [key for key in run_page.PROVENANCE if any(run.summary.get(key) is not None for run in runs)]
    rows = [[key.replace("_", " "), *(digits(v) if isinstance(v := run.summary.get(key), float)
                                      else str("–" if v is None else v) for run in runs)]
            for key in keys]
    return {"id": "provenance", "title": "Provenance", "blocks": [blocks.table(["", *names(runs)], rows)]}


def fill(page, arrays, runs, sections):
    page["title"] = " · ".join(names(runs))
    page["badges"] = [{"text": f"{len(runs)} runs", "kind": "good"}]
    sections(page, [("results", lambda: results(runs, arrays)), ("curves", lambda: overlay(runs, arrays)),
                    ("scenarios", lambda: differences(runs)), ("provenance", lambda: provenance(runs))])
