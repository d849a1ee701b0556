"""Puts a page together and writes it."""
import json
import pathlib
import sys

from ..plot.own_files import write_whole
from ..plot.run_data import PROBLEMS, Missing, Run, in_words, printable, why_no_folder

from . import kinds, run_page
from .blobs import Arrays
from .playback import playback

NAME = "report.html"
LARGEST = 14.6e6  # bytes of a page
BUNDLE = pathlib.Path(__file__).resolve().parent / "bundle"

HEAD = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline';
  style-src 'unsafe-inline'; img-src data: blob:">
<meta name="generator" content="furrow report">
"""


def inert(text):
    """JSON that ends no script element and starts no comment."""
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def finite(value):
    """The value with null for numbers that JSON does not have."""
    if isinstance(value, float):
        return value if abs(value) < 1e300 else None
    if isinstance(value, dict):
        return {key: finite(inner) for key, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(inner) for inner in value]
    return value.item() if hasattr(value, "item") else value


def sections(page, makers):
    """Of each maker its section; one whose data are missing or damaged leaves a line at the end instead."""
    for title, make in makers:
        try:
            section = make()
        except Missing as reason:
            page["left_out"].append(f"{title}: {printable(reason)}.")
            continue
        except PROBLEMS as error:
            page["left_out"].append(f"{title}: could not be read: {in_words(error)}.")
            continue
        if section and section["blocks"]:
            page["sections"].append(section)


def html(page, arrays, blobs):
    title = printable(page["title"]).replace("&", "&amp;").replace("<", "&lt;")
    parts = [HEAD, f"<title>{title}</title>\n<style>\n", (BUNDLE / "report.css").read_text(encoding="utf-8"),
             "</style>\n</head>\n<body>\n",
             "<noscript>This page needs JavaScript.</noscript>\n<main id=\"page\"></main>\n"]
    page["arrays"] = arrays.places
    parts.append(f'<script type="application/json" '
                 f'id="document">{inert(json.dumps(finite(page), ensure_ascii=False))}</script>\n')
    for name, data in {"numbers": arrays.base64(), **blobs}.items():
        parts.append(f'<script type="text/plain" id="{name}">{data}</script>\n')
    parts += ["<script>\n", (BUNDLE / "report.js").read_text(encoding="utf-8"), "</script>\n</body>\n</html>\n"]
    return "".join(parts)


def write(folder, runs, may_write):
    """Writes `folder`/report.html of one or more runs and returns its name in a list; on a problem says why not, and
    returns an empty list. `may_write`: that of own_files.py, which says itself why not."""
    try:
        content = page_of(runs).encode("utf-8")
        if not may_write(folder, NAME):
            return []
        write_whole(folder / NAME, content)
    except PROBLEMS as error:
        print(f"report: no {NAME}: {in_words(error)}", file=sys.stderr)
        return []
    return [NAME]


def compare(directories, folder, may_write):
    """The page of several runs; the exit code."""
    runs = []
    for directory in directories:
        try:
            runs.append(Run(directory))
        except PROBLEMS as error:
            print(f"furrow: error: {directory}: {in_words(error)}", file=sys.stderr)
            return 5
        if not runs[-1].scenario or not run_page.wheel_tables(runs[-1]):
            print(f"furrow: error: {directory}: holds no results of a run, expected scenario.json and a table of a "
                  f"wheel", file=sys.stderr)
            return 5
    if why := why_no_folder(folder):
        print(f"furrow: error: {printable(folder)}: {why}", file=sys.stderr)
        return 5
    written = write(folder, runs, may_write)
    print(json.dumps(written))
    if not written:
        print(f"furrow: error: {folder / NAME}: was not written", file=sys.stderr)
    return 0 if written else 5


def page_of(runs):
    """The page of a folder's results, or of several runs compared. `runs`: what report.py read, one or more."""
    arrays, blobs = Arrays(), {}
    page = {"title": "", "badges": [], "sections": [], "left_out": []}
    kinds.fill(page, arrays, runs, sections)
    run = runs[0]
    if len(runs) == 1 and kinds.has_frames(run):
        taken = len(html(dict(page), arrays_so_far(arrays), {}).encode())
        made = []

        def play():
            section, packed = playback(run, arrays, 0.74 * (LARGEST - taken - 0.3e6))
            blobs.update(packed)
            made.append(section)
            return None
        sections(page, [("playback", play)])
        page["sections"][1:1] = made
    if not page["sections"]:
        raise Missing("there is nothing that it could show")
    return html(page, arrays, blobs)


class arrays_so_far:
    """Arrays whose size alone counts."""

    def __init__(self, arrays):
        self.places, self._size = arrays.places, arrays.size

    def base64(self):
        return "x" * int(1.34 * self._size)
