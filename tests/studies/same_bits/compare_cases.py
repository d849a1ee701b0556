#!/usr/bin/python3
"""Compares two outputs of run_cases.py exactly: A is the baseline, B the build under test.

compare_cases.py OUT_A OUT_B [--cases a,b] [--all] [--ignore-state] [--least-share 0.5] [--csv FILE]

Exit status 0 only if all that both have by name is equal bit for bit, and nothing that A has of files, frames and
frame datasets lacks in B. Columns, keys and arrays that only one has are listed, and do not count as long as the
common ones are at least --least-share of A's.
"""
import argparse
import csv
import json
import re
import sys
from pathlib import Path

import h5py
import numpy as np

TESTS = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(TESTS / "studies"), str(TESTS / "campaign")]
import provenance  # noqa: E402
from compare_runs import attribute_of  # noqa: E402

NAME_ALIASES = {  # old or new name of a column, dataset or key: common name; e.g. "pull_N": "drawbar_pull_N"
}
NOT_COMPARED = re.compile(
    r"(^|_)wall_s|cpu|^ranks$|^segments$|digest|state_hash|version|^compiler$|^build|^threads$|^folder$|checksum"
    r"|^processor_|^parts_ms$|^median_ms$|^p99_ms$|^ms_per_step$|^ns_per_contact$|^grain_steps_per_s$"
    r"|^bytes_per_grain$|^node_cost$|^run:cost|^arrays$|^run/cost$")
SKIPPED_FILES = {"scenario.json", "manifest.json", "times.json", "sweep.json", "profile.json"}
COUNTS = {"csv": "columns", "json": "values", "h5": "arrays", "frames": "arrays", "state": "state"}


class Number(str):
    """As it is written in the file."""


def leaves(value, path=""):
    if isinstance(value, (dict, list)):
        for key, inner in value.items() if isinstance(value, dict) else enumerate(value):
            yield from leaves(inner, f"{path}.{key}".lstrip("."))
    elif value is None or isinstance(value, bool):
        yield path, Number(value)
    elif isinstance(value, Number):
        yield path, value


def columns(file):
    with open(file, newline="") as text:
        header, *body = list(csv.reader(text)) or [[]]
    return {name: np.array([row[k] if k < len(row) else "<no cell>" for row in body], dtype=str)
            for k, name in enumerate(header)}


def arrays(file):
    found = {}

    def take(name, thing):
        if isinstance(thing, h5py.Dataset):
            found[name] = np.asarray(thing[()])
        for key in thing.attrs:
            if not isinstance(value := attribute_of(thing, key), (str, bytes)):
                found[f"{name}/@{key}".lstrip("/")] = np.asarray(value)
    with h5py.File(file, "r") as h5:
        take("", h5)
        h5.visititems(take)
    return found


def contents(file):
    """{name: value} of what is compared: columns of a CSV file, numbers of a JSON file, arrays of an HDF5 file."""
    if file.suffix == ".json":
        found = dict(leaves(json.loads(file.read_text(), parse_float=Number, parse_int=Number, parse_constant=Number)))
    else:
        found = columns(file) if file.suffix == ".csv" else arrays(file)
    parts = {name: [NAME_ALIASES.get(part, part) for part in re.split(r"([/.])", name)] for name in found}
    return {"".join(parts[name]): value for name, value in found.items()
            if not any(NOT_COMPARED.search(part.replace("@", "")) for part in parts[name])}


def same_number(a, b):
    try:
        return repr(float(a)) == repr(float(b))
    except ValueError:
        return False


def difference(a, b):
    """What differs between two values; empty: nothing, to the bit."""
    if isinstance(a, Number):
        return "" if a == b else f"{a} | {b}{' (same number, other text)' if same_number(a, b) else ''}"
    text = a.dtype.kind == b.dtype.kind == "U"  # a column of a table, whose width does not count
    if not text and a.dtype != b.dtype:
        return f"type {a.dtype} | {b.dtype}"
    if a.shape != b.shape:
        return f"shape {a.shape} | {b.shape}"
    if text or a.dtype.kind not in "fiub":
        a, b = np.atleast_1d(a), np.atleast_1d(b)
        if not len(at := np.flatnonzero(a != b)):
            return ""
        same = text and all(same_number(a[k], b[k]) for k in at)
        first = f", first in line {at[0] + 2}: {a[at[0]]} | {b[at[0]]}" if text else ""
        return f"{'text differs, same numbers' if same else 'differs'} in {len(at)} of {a.size} lines{first}"
    if a.tobytes() == b.tobytes():
        return ""
    bytes_a, bytes_b = (np.ascontiguousarray(x).reshape(-1).view(np.uint8).reshape(-1, x.dtype.itemsize)
                        for x in (a, b))
    at, flat_a, flat_b = np.flatnonzero((bytes_a != bytes_b).any(axis=1)), a.reshape(-1), b.reshape(-1)
    with np.errstate(all="ignore"):
        largest = np.nanmax(np.abs(flat_a[at].astype(float) - flat_b[at].astype(float)))
    return f"{len(at)} of {a.size} values differ, by {largest:.3g} at most; first {flat_a[at[0]]!r} | {flat_b[at[0]]!r}"


def files_of(folder, state):
    """Of a run or another case: kind -> name -> file."""
    found = {kind: {} for kind in COUNTS}
    last = max((p.name for p in folder.glob("checkpoints/*") if p.name.isdigit()), key=int, default="")
    for file in sorted(folder.rglob("*")):
        name, kind = file.relative_to(folder).as_posix(), file.suffix.lstrip(".")
        if not file.is_file() or file.name in SKIPPED_FILES or name.startswith(("runs/", "beds/")):
            continue
        if name.startswith("checkpoints/"):  # an earlier one stands where the run was interrupted, which is chance
            if state and kind == "h5" and file.parent.name == last:
                found["state"][f"checkpoint/{file.name}"] = file
        elif kind in found:
            found["frames" if re.search(r"_\d{4,}\.h5$", name) else kind][name] = file
    return found


def runs_of_sweep(folder):
    """The folders of a sweep's runs in the order of its table; the folders are named after digests."""
    with open(folder / "sweep.csv", newline="") as text:
        return [folder / cell for row in list(csv.reader(text))[1:] for cell in row if cell.startswith("runs/")]


class Row:
    """What became of one case."""

    def __init__(self, name, least):
        self.name, self.least = name, least
        self.counts = dict.fromkeys(("columns", "frames", "values", "arrays", "state"), 0)
        self.differences, self.notes = [], []

    def common(self, what, a, b, least, missing_fails):
        """@returns the names that both have"""
        only_a, only_b = [n for n in a if n not in b], [n for n in b if n not in a]
        if only_a:
            (self.differences if missing_fails else self.notes).append(f"{what}: only in A: {', '.join(only_a)}")
        if only_b:
            self.notes.append(f"{what}: only in B: {', '.join(only_b)}")
        for old in only_a:
            if isinstance(a[old], np.ndarray) and a[old].size > 1 and (a[old] != a[old].flat[0]).any():
                if new := [n for n in only_b if not difference(a[old], b[n])]:
                    self.notes.append(f"{what}: {old} of A equals {', '.join(new)} of B throughout: renamed?")
        shared = [name for name in a if name in b]
        if a and len(shared) < least * len(a):
            self.differences.append(f"{what}: only {len(shared)} of {len(a)} of A's names are in B")
        return shared

    def compare(self, what, file_a, file_b, kind):
        a, b = contents(file_a), contents(file_b)
        self.counts["frames"] += kind == "frames"
        for name in self.common(what, a, b, self.least, kind == "frames"):
            self.counts[COUNTS[kind]] += 1
            if text := difference(a[name], b[name]):
                self.differences.append(f"{what}: {name}: {text}")

    def compare_folders(self, prefix, a, b, state):
        files_a, files_b = files_of(a, state), files_of(b, state)
        for kind in COUNTS:
            for name in self.common(f"{prefix}{kind} files", files_a[kind], files_b[kind], 0.0, kind != "state"):
                self.compare(prefix + name, files_a[kind][name], files_b[kind][name], kind)


def compare_case(name, a, b, least, state):
    row = Row(name, least)
    row.compare_folders("", a, b, state)
    if (a / "sweep.csv").exists() and (b / "sweep.csv").exists():
        runs_a, runs_b = runs_of_sweep(a), runs_of_sweep(b)
        if len(runs_a) != len(runs_b):
            row.differences.append(f"{len(runs_a)} runs in A, {len(runs_b)} in B")
        for k, pair in enumerate(zip(runs_a, runs_b), 1):
            row.compare_folders(f"run {k}: ", *pair, state)
        beds = [sorted(x.glob("beds/*.h5")) for x in (a, b)]
        for k, pair in enumerate(zip(*beds) if state and len(beds[0]) == len(beds[1]) else (), 2):
            row.compare(f"bed of pass {k}", *pair, "state")
    if not any(row.counts.values()):
        row.differences.append("nothing was compared")
    return row


def compare_beds(a, b, least):
    """Settled beds in the two caches; named after digests of what decides their bits, which may change."""
    row = Row("(settled beds)", least)
    beds = [{f.name: f for f in (x / "cache/furrow/beds").glob("*.h5")} for x in (a, b)]
    for name in row.common("beds", *beds, 0.0, False):
        row.compare(name, beds[0][name], beds[1][name], "state")
    return row


def write_table(file, rows, both):
    made = {key: " and ".join(one.get("made", {}).get(key, provenance.UNKNOWN) for one in both)
            for key in ("commit", "compiler", "processor")} | {"command": provenance.command()}
    provenance.write_table(file, ["case", *rows[0].counts, "differences", "first_difference"], [
        {"case": row.name, **row.counts, "differences": len(row.differences),
         "first_difference": "".join(row.differences[:1])} for row in rows], made)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("a", type=Path)
    parser.add_argument("b", type=Path)
    parser.add_argument("--cases", help="these only, with commas between")
    parser.add_argument("--all", action="store_true", help="list every difference and note, not the first 12 of a case")
    parser.add_argument("--ignore-state", action="store_true", help="leave checkpoints and settled beds out")
    parser.add_argument("--least-share", type=float, default=0.5, help="of A's names that B must have in a file")
    parser.add_argument("--csv", type=Path, help="write the table of cases to this file, too")
    arguments = parser.parse_args()
    a, b, least, state = arguments.a, arguments.b, arguments.least_share, not arguments.ignore_state
    both = [json.loads((x / "times.json").read_text()) for x in (a, b)]
    names = arguments.cases.split(",") if arguments.cases else list(both[0]["cases"])
    rows = []
    for name in names:
        cases = {side: times["cases"].get(name, {"problem": "case was not run"}) for side, times in zip("AB", both)}
        if problems := [f"{side}: {case['problem']}" for side, case in cases.items() if "problem" in case]:
            rows.append(Row(name, least))
            rows[-1].differences += problems
        else:
            rows.append(compare_case(name, a / name, b / name, least, state))
    if state:
        rows.append(compare_beds(a, b, least))
    for side, folder in (("A", a), ("B", b)):
        if {"first_look", "resumed"} <= set(names) and all((folder / n).exists() for n in ("first_look", "resumed")):
            rows.append(compare_case(f"({side}: resumed = whole)", folder / "first_look", folder / "resumed", least,
                                     state))

    print(" | ".join([f"{'case':24s}", *(f"{count:>7s}" for count in rows[0].counts), "verdict"]))
    for row in rows:
        equal = "equal" if any(row.counts.values()) else "-"
        verdict = f"DIFFERENT ({len(row.differences)})" if row.differences else equal
        print(" | ".join([f"{row.name:24s}", *(f"{count:7d}" for count in row.counts.values()), verdict]))
    if arguments.csv:
        write_table(arguments.csv, rows, both)
    print("columns: of CSV files; frames: HDF5 files; values: numbers in JSON files; arrays: datasets and attributes "
          "of frames and results.h5; state: those of the last checkpoint and of settled beds")
    for title in ("differences", "notes"):
        for row in rows:
            texts = getattr(row, title)
            shown = texts if arguments.all else texts[:12]
            if texts:
                print(f"\n{row.name}: {title}{', not counted' if title == 'notes' else ''}", *shown, sep="\n  ")
            if len(texts) > len(shown):
                print(f"  … and {len(texts) - len(shown)} more (--all)")
    different = any(row.differences for row in rows)
    print("\nDIFFERENT" if different else "\nall equal")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
