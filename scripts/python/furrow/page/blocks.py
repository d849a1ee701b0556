"""The blocks that a page is made of; source/main.js draws each kind."""
from ..plot.digits import digits, with_error
from ..plot.run_data import printable
from ..plot.student import student
from ..plot.units import is_number, naming



def text(words, kind="plain"):
    """A paragraph; kinds: plain, note, good, warn, bad."""
    return {"type": "text", "text": printable(words), "kind": kind}


def card(name, value, unit, interval="", kind="plain", explanation=""):
    """One answer: its value, its interval and what that means."""
    return {"name": name, "value": value, "unit": unit, "interval": interval, "kind": kind, "explanation": explanation}


def cards(items):
    return {"type": "cards", "cards": items}


def table(columns, rows, note="", marked=(), only_marked=""):
    """Rows of texts. With `only_marked` (the words beside a box to tick) the marked rows can be shown alone."""
    return {"type": "table", "columns": columns, "rows": [[printable(cell) for cell in row] for row in rows],
            "note": note, "marked": list(marked), "only_marked": only_marked}


def bars(rows, note=""):
    """Shares of 1 as bars: (label, share, words)."""
    return {"type": "bars", "rows": [{"label": printable(a), "share": b, "text": printable(c)} for a, b, c in rows],
            "note": note}


def chart(title, x_label, x_unit, y_unit, lines, window=None, levels=(), note=""):
    """A plot. Lines: {label, x, y, style: line | points, low, high}, where x, y, low and high are numbers of arrays."""
    return {"title": title, "x": x_label, "x_unit": x_unit, "unit": y_unit, "lines": lines, "window": window,
            "levels": list(levels), "note": note}


def of(known, lines, window=None, levels=()):
    """The plot of a chart of chart_table.py."""
    words, *scale = naming(known.x)
    return chart(known.title, known.x_words or words, (known.x_unit or scale)[0], known.scale[0], lines, window, levels,
                 known.sign)


def charts(items, note=""):
    return {"type": "charts", "charts": items, "note": note}


LEAST_SAMPLES = 10  # fewer independent values do not tell how large an error is (nodes/output/steadiness.hpp)


def half_95(sem, count, least=2):
    """Half the 95 % interval of a mean with this standard error from as many independent values.
    @returns None where they are fewer than `least`"""
    if not (is_number(sem) and is_number(count)) or count < least:
        return None
    return student(max(int(count) - 1, 1)) * sem


def values_table(pairs):
    """A table of names such as `wall_s`, their values and units."""
    rows = []
    for name, value in pairs:
        words, unit, factor = naming(name)
        if isinstance(value, bool):
            rows.append([words, "yes" if value else "no", ""])
        elif isinstance(value, float) or (isinstance(value, int) and unit):
            rows.append([words, f"{value * factor:.6g}", unit])
        else:
            rows.append([words, str(value), ""])
    return table(["", "", ""], rows)


def quantity(name, value, half=None):
    """(value, unit) as texts in the unit that `name` is shown in."""
    if not is_number(value):
        return "–", ""
    _, unit, factor = naming(name)
    value *= factor
    return (with_error(value, half * factor) if half is not None else digits(value)), unit
