"""The page of a study, of passes or of a run on several beds."""
import math

import numpy as np

from ..plot import sweep as studies
from ..plot.digits import with_error
from ..plot.keys import named
from ..plot.run_data import Missing

from . import blocks

PASSES = (("drawbar_pull_N.mean", "drawbar_pull_N.sem"), ("sinkage_m", ""), ("rut_depth_m", ""),
          ("tractive_efficiency", ""))
MOST_ROWS = 2000
# sweep.csv has them; without them a study that was interrupted has the page of one that was not
WALL_TIMES = {"wall_s"}


def line(arrays, label, x, y, half, factor):
    made = {"label": label, "x": arrays.add(x, exact=True), "y": arrays.add(factor * np.asarray(y)), "style": "points"}
    if half is not None and np.isfinite(half).any():
        half = np.nan_to_num(half)
        made["low"], made["high"] = (arrays.add(factor * (np.asarray(y) + sign * half)) for sign in (-1, 1))
    return made


def whiskers(plot):
    if plot.get("mean_over"):
        return f"Points: means over {plot['mean_over']}. Whiskers: their 95 % intervals."
    return "Whiskers: standard error of each run." if plot.get("error") else ""


def curve(sweep, arrays):
    """y over x as the study's plot says."""
    plot = sweep.plot
    if not plot.get("x") or not plot.get("y") or not sweep.rows:
        raise Missing("the study asks for no plot" if sweep.rows else "no run is done")
    words, unit, factor = named(plot["y"])
    keys = studies.keys_of(sweep)
    x_words, x_unit, x_factor = named(plot["x"], keys)
    groups = {}
    for row in sweep.rows:
        groups.setdefault(row.get(plot.get("lines", ""), ""), []).append(row)
    lines, unsteady, points = [], 0, 0
    for label, rows in groups.items():
        x, y, half, which = studies.points(rows, plot["x"], plot["y"], plot.get("error", ""), plot.get("mean_over"))
        unsteady += int(np.asarray(which, bool).sum())
        points += len(x)
        lines.append(line(arrays, studies.group_label(plot, label) if label else words, x_factor * x, y, half, factor))
    made = [blocks.charts([{**blocks.chart(words.capitalize(), x_words, x_unit, unit, lines), "wide": True}],
                          whiskers(plot))]
    if description := sweep.values.get("description"):
        made.insert(0, blocks.text(str(description), "lead"))
    if unsteady:
        made.append(blocks.text(f"{unsteady} of {points} points include a run whose pull is not steady: such a point "
                                f"is not to be quoted.", "warn"))
    return {"id": "curve", "title": "Result", "blocks": made}


def passes(sweep, arrays):
    """Pull, sinkage and rut over the number of the pass."""
    groups, over, items = studies.chains(sweep), sweep.plot.get("mean_over"), []
    for key, sem in PASSES:
        words, unit, factor = named(key)
        lines = []
        for label, rows in groups.items():
            if any(math.isfinite(studies.number(row.get(key))) for row in rows):
                x, y, half, _ = studies.points(rows, "pass", key, sem, over)
                lines.append(line(arrays, label or words, x, y, half, factor))
        if lines:
            items.append(blocks.chart(words.capitalize(), "pass", "", unit, lines))
    made = [blocks.charts(items, f"Whiskers: 95 % interval of the mean over {over}."
                          if over else "Whiskers: standard error of each run.")]
    if unsteady := sum(map(studies.unsteady, sweep.rows)):
        made.insert(0, blocks.text(f"The pull is not steady in {unsteady} of {len(sweep.rows)} passes: its error is "
                                   "too small there.", "warn"))
    return {"id": "passes", "title": "Passes", "blocks": made}


def beds(sweep, arrays):
    """Every bed with its own standard error, and the mean over beds with its 95 % interval."""
    if not sweep.rows:
        raise Missing("no bed is done")
    at = np.array([studies.number(row["folder"].removeprefix("seed")) for row in sweep.rows])
    items, cards = [], []
    for key, sem in studies.OF_BEDS:
        what, unit, factor = named(key)
        values, errors = (factor * np.array([studies.number(row.get(name)) for row in sweep.rows])
                          for name in (key, sem))
        known = values[np.isfinite(values)]
        if not len(known):
            continue
        mean, half = studies.mean_and_interval(known)
        cards.append(blocks.card(what, with_error(mean, half), unit, "95 %",
                                 explanation=f"mean over {len(known)} beds"))
        items.append(blocks.chart(what.capitalize(), "bed", "", unit,
                                  [line(arrays, "a bed, its own standard error", at, values, errors, 1.0)],
                                  levels=[{"y": mean, "half": half if math.isfinite(half) else None,
                                           "label": "mean over beds, 95 %"}]))
    words = blocks.text("The interval is the 95 % confidence interval of the mean over beds [Student's t]: of the "
                        "intervals that such sets of beds give, 95 % hold the true mean.", "note")
    made = [blocks.cards(cards), words, blocks.charts(items)]
    if unsteady := sum(map(studies.unsteady, sweep.rows)):
        made.insert(0, blocks.text(f"The pull is not steady on {unsteady} of {len(sweep.rows)} beds: the means are "
                                   "over these beds too.", "warn"))
    return {"id": "beds", "title": "Result", "blocks": made}


def rows_of(sweep):
    """The table of all runs."""
    rows = sweep.rows + sweep.failed
    if not rows:
        raise Missing("no run is done")
    columns = [name for name in rows[0] if name and name not in WALL_TIMES and any(row.get(name) for row in rows)]
    named_columns = [named(name, studies.keys_of(sweep)) for name in columns]
    cells = [[studies.cell(row.get(name), factor) for name, (_, _, factor) in zip(columns, named_columns)]
             for row in rows[:MOST_ROWS]]
    failed = [k for k, row in enumerate(rows[:MOST_ROWS]) if row["state"] == "failed"]
    return {"id": "runs", "title": "Runs",
            "blocks": [blocks.table([", ".join(filter(None, (words, unit.replace(" ", "\u00a0"))))
                                     for words, unit, _ in named_columns], cells, marked=failed,
                                    note="Highlighted: failed." if failed else "")]}


def fill(page, arrays, sweep, sections):
    page["title"] = str(sweep.title())
    done = {"text": f"{len(sweep.rows)} done", "kind": "good"}
    page["badges"] = [done] + ([{"text": f"{len(sweep.failed)} failed", "kind": "bad"}] if sweep.failed else [])
    of_beds = sweep.values.get("beds")
    sections(page, [
        ("beds", lambda: beds(sweep, arrays) if of_beds else None),
        ("curve", lambda: curve(sweep, arrays) if sweep.plot.get("x") and not of_beds else None),
        ("passes", lambda: passes(sweep, arrays) if sweep.values.get("passes") else None),
        ("runs", lambda: rows_of(sweep)),
    ])
