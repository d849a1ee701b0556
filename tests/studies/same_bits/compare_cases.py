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

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import provenance  # noqa: E402

# ---- what may be named differently; the right side is the common name -----------------------------------------------
FILE_ALIASES = [  # of a path relative to the run's folder; all are applied, in order
    (r"(?:^|.*/)wheel_?(\d+)/(timeseries|summary)\.(csv|json)$", r"\2_wheel\1.\3"),  # a folder per wheel
    (r"^(timeseries|summary)_(?:wheel_|wheel|tire|)(\d+)\.(csv|json)$", r"\1_wheel\2.\3"),
    (r"^(timeseries|summary)\.(csv|json)$", r"\1_wheel0.\2"),  # a file that names its wheel takes precedence
    (r"^(frames/)?tire_(\d{4,})\.h5$", r"\1tire0_\2.h5"),
]
NAME_ALIASES = {  # old or new name of a column, dataset or key: common name; e.g. "pull_N": "drawbar_pull_N"
}
# ---- what is not compared -------------------------------------------------------------------------------------------
NOT_COMPARED = re.compile(
    r"(^|_)wall_s|cpu|^ranks$|^segments$|digest|state_hash|version|^compiler$|^build|^threads$|^folder$|checksum"
    r"|^processor_|^parts_ms$|^median_ms$|^p99_ms$|^ms_per_step$|^ns_per_contact$|^grain_steps_per_s$"
    r"|^bytes_per_grain$|^node_cost$|^run:cost$|^arrays$|^run/cost$")
SKIPPED_FILES = {"scenario.json", "manifest.json", "times.json", "sweep.json", "profile.json"}


def common_file(name):
    for pattern, text in FILE_ALIASES:
        name = re.sub(pattern, text, name)
    return name


def common_name(name):
    return NAME_ALIASES.get(name, name)


def compared(path):
    return not any(NOT_COMPARED.search(part) for part in re.split(r"[/.]", path))


class Number:
    """As it is in the file."""

    def __init__(self, text):
        self.text = text


def read_json(file):
    return json.loads(file.read_text(), parse_float=Number, parse_int=Number, parse_constant=Number)


class Row:
    """What became of one case."""

    def __init__(self, name):
        self.name = name
        self.counts = dict.fromkeys(("columns", "frames", "values", "arrays", "state"), 0)
        self.differences, self.notes = [], []

    def check_names(self, what, a, b, least, missing_fails=False, only=None):
        """@returns the names that both have"""
        common = [name for name in a if name in b]
        only_a, only_b = [n for n in a if n not in b], [n for n in b if n not in a]
        if only_a:
            text = f"{what}: only in A: {', '.join(only_a)}"
            (self.differences if missing_fails else self.notes).append(text)
        if only_b:
            self.notes.append(f"{what}: only in B: {', '.join(only_b)}")
        if only is not None:
            for old in only_a:
                new = [n for n in only_b if only(old, n)]
                if new:
                    self.notes.append(f"{what}: {old} of A equals {', '.join(new)} of B throughout: renamed?")
        if a and len(common) < least * len(a):
            self.differences.append(f"{what}: only {len(common)} of {len(a)} of A's names are in B")
        return common


def read_columns(file):
    with open(file, newline="") as text:
        rows = list(csv.reader(text))
    header = [common_name(name) for name in rows[0]] if rows else []
    body = rows[1:]
    return {name: [row[k] if k < len(row) else "<no cell>" for row in body] for k, name in enumerate(header)}


def same_number(a, b):
    try:
        return repr(float(a)) == repr(float(b))
    except ValueError:
        return False


def compare_csv(row, what, file_a, file_b, least):
    a, b = ({n: c for n, c in read_columns(f).items() if compared(n)} for f in (file_a, file_b))
    telling = lambda old, new: a[old] == b[new] and len(set(a[old])) > 1  # noqa: E731
    for name in row.check_names(f"{what}: columns", a, b, least, only=telling):
        row.counts["columns"] += 1
        if a[name] == b[name]:
            continue
        if len(a[name]) != len(b[name]):
            row.differences.append(f"{what}: {name}: {len(a[name])} lines in A, {len(b[name])} in B")
            continue
        lines = [k for k, (x, y) in enumerate(zip(a[name], b[name])) if x != y]
        k = lines[0]
        kind = "text differs, same numbers" if all(same_number(a[name][i], b[name][i]) for i in lines) else "differs"
        row.differences.append(f"{what}: {name}: {kind} in {len(lines)} of {len(a[name])} lines, first in line "
                               f"{k + 2}: "
                               f"{a[name][k]} | {b[name][k]}")


def leaves(value, path=""):
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from leaves(inner, f"{path}.{common_name(key)}" if path else common_name(key))
    elif isinstance(value, list):
        for k, inner in enumerate(value):
            yield from leaves(inner, f"{path}.{k}")
    elif value is None or isinstance(value, bool):
        yield path, repr(value)
    elif isinstance(value, Number):
        yield path, value.text


def hashes(value):
    return [value["state_hash"]] if isinstance(value, dict) and "state_hash" in value else []


def summaries(files):
    """JSON files of a case: common name -> content; the wheels of one summary as a summary each."""
    contents = {name: read_json(file) for name, file in files.items()}
    whole = contents.get("summary_wheel0.json", {})
    wheels = whole.pop("wheels", []) if isinstance(whole, dict) else []
    for k, wheel in enumerate(wheels if len(wheels) > 1 else []):
        contents[f"summary_wheel{k}.json"] = {**whole, **wheel}
    return contents


def compare_json(row, what, whole_a, whole_b, least):
    a, b = ({n: v for n, v in leaves(whole) if compared(n)} for whole in (whole_a, whole_b))
    for name in row.check_names(f"{what}: keys", a, b, least):
        row.counts["values"] += 1
        if a[name] != b[name]:
            same = " (same number, other text)" if same_number(a[name], b[name]) else ""
            row.differences.append(f"{what}: {name}: {a[name]} | {b[name]}{same}")
    if hashes(whole_a) != hashes(whole_b):
        row.notes.append(f"{what}: state_hash: {hashes(whole_a)} | {hashes(whole_b)} (not counted)")


def read_arrays(file):
    arrays = {}
    with h5py.File(file, "r") as h5:
        def take(name, thing):
            if isinstance(thing, h5py.Dataset):
                arrays["/".join(common_name(part) for part in name.split("/"))] = thing[()]
            for key, value in thing.attrs.items():
                if not isinstance(value, (str, bytes)):
                    arrays[f"{name}/@{key}".lstrip("/")] = value
        take("", h5)
        h5.visititems(take)
    return {name: np.asarray(value) for name, value in arrays.items() if compared(name.replace("@", ""))}


def difference(a, b):
    """What differs between two arrays; empty: nothing, to the bit."""
    if a.dtype != b.dtype:
        return f"type {a.dtype} | {b.dtype}"
    if a.shape != b.shape:
        return f"shape {a.shape} | {b.shape}"
    if a.tobytes() == b.tobytes():
        return ""
    if a.dtype.kind not in "fiub":
        return "other values" if not np.array_equal(a, b) else ""
    bytes_a, bytes_b = (np.ascontiguousarray(x).reshape(-1).view(np.uint8).reshape(-1, x.dtype.itemsize)
                        for x in (a, b))
    at = np.flatnonzero((bytes_a != bytes_b).any(axis=1))
    flat_a, flat_b = a.reshape(-1), b.reshape(-1)
    with np.errstate(all="ignore"):
        largest = np.nanmax(np.abs(flat_a[at].astype(float) - flat_b[at].astype(float)))
    return f"{len(at)} of {a.size} values differ, by {largest:.3g} at most; first {flat_a[at[0]]!r} | {flat_b[at[0]]!r}"


def compare_h5(row, what, file_a, file_b, least, kind, missing_fails=False):
    a, b = read_arrays(file_a), read_arrays(file_b)
    for name in row.check_names(f"{what}: arrays", a, b, least, missing_fails):
        row.counts[kind] += 1
        if text := difference(a[name], b[name]):
            row.differences.append(f"{what}: {name}: {text}")


def files_of(folder):
    """Of a run or another case: kind -> common name -> file."""
    found = {kind: {} for kind in ("csv", "json", "frames", "h5", "state")}
    steps = [int(p.name) for p in folder.glob("checkpoints/*") if p.name.isdigit()]
    last = max(steps, default=-1)  # an earlier one stands where the run was interrupted, which is chance
    explicit = set()
    for file in sorted(folder.rglob("*")):
        relative = file.relative_to(folder).as_posix()
        if not file.is_file() or file.name in SKIPPED_FILES or relative.split("/")[0] in ("runs", "beds"):
            continue
        name = common_file(relative)
        if relative.startswith("checkpoints/"):
            if file.suffix == ".h5" and file.parent.name.isdigit() and int(file.parent.name) == last:
                found["state"]["checkpoint/" + file.name] = file
            continue
        kind = {".csv": "csv", ".json": "json", ".h5": "h5"}.get(file.suffix)
        if not kind:
            continue
        if kind == "h5" and re.search(r"_\d{4,}\.h5$", name):
            kind = "frames"
        if name in found[kind] and name in explicit:
            continue
        found[kind][name] = file
        if name == relative:
            explicit.add(name)
    return found


def runs_of_sweep(folder):
    """The folders of a sweep's runs in the order of its table; the folders are named after digests."""
    with open(folder / "sweep.csv", newline="") as text:
        rows = list(csv.reader(text))[1:]
    return [folder / cell for row in rows for cell in row if cell.startswith("runs/")]


def compare_folder(row, prefix, a, b, least, state):
    files_a, files_b = files_of(a), files_of(b)
    files_a["json"], files_b["json"] = summaries(files_a["json"]), summaries(files_b["json"])
    for kind, missing_fails in (("csv", True), ("json", True), ("h5", True), ("frames", True), ("state", False)):
        if kind == "state" and not state:
            continue
        for name in row.check_names(f"{prefix}{kind} files", files_a[kind], files_b[kind], 0.0, missing_fails):
            what, pair = prefix + name, (files_a[kind][name], files_b[kind][name])
            if kind == "csv":
                compare_csv(row, what, *pair, least)
            elif kind == "json":
                compare_json(row, what, *pair, least)
            elif kind == "frames":
                row.counts["frames"] += 1
                compare_h5(row, what, *pair, least, "arrays", True)
            else:
                compare_h5(row, what, *pair, least, "state" if kind == "state" else "arrays")


def compare_case(name, a, b, least, state):
    row = Row(name)
    compare_folder(row, "", a, b, least, state)
    if (a / "sweep.csv").exists() and (b / "sweep.csv").exists():
        runs_a, runs_b = runs_of_sweep(a), runs_of_sweep(b)
        if len(runs_a) != len(runs_b):
            row.differences.append(f"{len(runs_a)} runs in A, {len(runs_b)} in B")
        for k, (run_a, run_b) in enumerate(zip(runs_a, runs_b), 1):
            compare_folder(row, f"run {k}: ", run_a, run_b, least, state)
        beds = [sorted(x.glob("beds/*.h5")) for x in (a, b)]
        if state and len(beds[0]) == len(beds[1]):
            for k, pair in enumerate(zip(*beds), 1):
                compare_h5(row, f"bed of pass {k + 1}", *pair, least, "state")
    if not any(row.counts.values()):
        row.differences.append("nothing was compared")
    return row


def compare_beds(a, b, least):
    """Settled beds in the two caches; named after digests of what decides their bits, which may change."""
    row = Row("(settled beds)")
    beds = [{f.name: f for f in (x / "cache/furrow/beds").glob("*.h5")} for x in (a, b)]
    for name in row.check_names("beds", *beds, 0.0):
        compare_h5(row, name, beds[0][name], beds[1][name], least, "state")
    return row


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
    times_a, times_b = (json.loads((x / "times.json").read_text())["cases"] for x in (a, b))
    names = arguments.cases.split(",") if arguments.cases else list(times_a)
    rows = []
    for name in names:
        problems = [f"{side}: {times[name]['problem'] if name in times else 'case was not run'}"
                    for side, times in (("A", times_a), ("B", times_b))
                    if name not in times or "problem" in times[name]]
        if problems:
            rows.append(Row(name))
            rows[-1].differences += problems
        else:
            rows.append(compare_case(name, a / name, b / name, least, state))
    if state:
        rows.append(compare_beds(a, b, least))
    for side, folder in (("A", a), ("B", b)):
        if {"first_look", "resumed"} <= set(names) and all((folder / n).exists() for n in ("first_look", "resumed")):
            rows.append(compare_case(f"({side}: resumed = whole)", folder / "first_look",
                                     folder / "resumed", least, state))

    print(f"{'case':24s} | {'columns':>7s} | {'frames':>6s} | {'values':>6s} | {'arrays':>6s} | {'state':>5s} | "
          f"verdict")
    for row in rows:
        c = row.counts
        verdict = f"DIFFERENT ({len(row.differences)})" if row.differences else "equal" if any(c.values()) else "-"
        print(f"{row.name:24s} | {c['columns']:7d} | {c['frames']:6d} | {c['values']:6d} | {c['arrays']:6d} | "
              f"{c['state']:5d} | {verdict}")
    if arguments.csv:
        both = [json.loads((x / "times.json").read_text()).get("made", {}) for x in (a, b)]
        made = {key: " and ".join(one.get(key, provenance.UNKNOWN) for one in both)
                for key in ("commit", "compiler", "processor")}
        made["command"] = provenance.command()
        with open(arguments.csv, "w", newline="") as out:
            provenance.write_header(out, made)
            table = csv.writer(out, lineterminator="\n")
            table.writerow(["case", *rows[0].counts, "differences", "first_difference"])
            for row in rows:
                table.writerow([row.name, *row.counts.values(), len(row.differences), "".join(row.differences[:1])])
    print("columns: of CSV files; frames: HDF5 files; values: numbers in JSON files; arrays: datasets and attributes "
          "of frames and results.h5; state: those of the last checkpoint and of settled beds")
    most = None if arguments.all else 12
    for title, lists in (("differences", [(r.name, r.differences) for r in rows]),
                         ("notes, not counted", [(r.name, r.notes) for r in rows])):
        for name, texts in lists:
            if texts:
                print(f"\n{name}: {title}")
                for text in texts[:most]:
                    print(f"  {text}")
                if len(texts) > len(texts[:most]):
                    print(f"  … and {len(texts) - len(texts[:most])} more (--all)")
    different = any(row.differences for row in rows)
    print("\nDIFFERENT" if different else "\nall equal")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
