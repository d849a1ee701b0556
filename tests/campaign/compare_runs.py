#!/usr/bin/python3
"""Compares two folders of results strictly: every file of either is accounted for, and whatever is not listed in
MAY_DIFFER below must be equal. HDF5 files are compared dataset for dataset with their types, shapes and attributes, and
floating-point numbers by their bits; all other files byte for byte.

usage: compare_runs.py DIR_A DIR_B
Either folder is that of a run or of a study. Prints every difference and exits with 1 if there is one, with 2 if a
Python module is missing.
"""
import argparse
import csv
import fnmatch
import json
import pathlib
import sys

try:
    import h5py
    import numpy as np
except ImportError as missing:
    sys.stderr.write(f"compare_runs.py: the Python module {missing.name} is missing, expected python3-h5py and "
                     "python3-numpy of the system: run it with /usr/bin/python3\n")
    sys.exit(2)

MAY_DIFFER = {  # what a run that was disturbed and continued need not have in common with one that was not
    "run.log", "runs/*.log", "seed*.log",  # what was said, and when
    "profile.json", "ranks.png",  # wall times
    ".furrow-run",  # the list of files made so far; a study and a run that was stopped make them in another order
    "report.html",  # wall times in the sections Ranks and Provenance; the page of a study holds none and is compared
}
STUDY = "sweep.csv"  # beside the page of a study
# A run that was stopped has checkpoints at other steps and so keeps others: those of the same step are compared, and
# the newest must be of the same step.
SUMMARY_WALL = {"wall_s", "settle_wall_s", "wall_s_per_simulated_s", "ranks", "segments", "cpu"}
# of a checkpoint; the parts' contents are compared themselves
MANIFEST_WALL = {"write_s", "segments", "checksum", "parts", "bytes", "cpu"}
STATE_WALL = ("state/run:cost:", "state/setup:settle_wall_s")  # of a checkpoint's parts; their checksums say the same
TABLE_WALL = {"wall_s"}  # columns of sweep.csv


def tail_matches(path, pattern):
    """Whether `path` ends in what the pattern stands for, part by part: the runs of a study are runs as well."""
    wanted = pattern.split("/")
    parts = path.split("/")[-len(wanted):]
    return len(parts) == len(wanted) and all(fnmatch.fnmatchcase(part, want) for part, want in zip(parts, wanted))


def may_differ(path, files):
    """@param files of either folder"""
    of_study = path.split("/")[-1] == "report.html" and path.removesuffix("report.html") + STUDY in files
    return not of_study and any(tail_matches(path, pattern) for pattern in MAY_DIFFER)


def files_of(folder):
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if not path.is_dir() or path.is_symlink()}


def only_in(first):
    return f"only in the {'first' if first else 'second'}"


def checkpoint_of(path):
    """("runs/1/", "000000000100") for a file of a complete checkpoint, else None."""
    parts = path.split("/")
    if "checkpoints" not in parts[:-1]:
        return None
    at = parts.index("checkpoints")
    return ("/".join(parts[:at + 1]), parts[at + 1]) if parts[at + 1].isdigit() and len(parts) > at + 2 else None


def json_differences(a, b, at=""):
    if isinstance(a, dict) and isinstance(b, dict):
        for key in {**a, **b}:
            if key not in a or key not in b:
                yield f"{at}{key}: {only_in(key in a)}"
            else:
                yield from json_differences(a[key], b[key], f"{at}{key}.")
    elif isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        for i, (x, y) in enumerate(zip(a, b)):
            yield from json_differences(x, y, f"{at}{i}.")
    elif json.dumps(a) != json.dumps(b):
        yield f"{at.rstrip('.')}: {str(a)[:60]} and {str(b)[:60]}"


def without(row, keys):
    return {key: value for key, value in row.items() if key not in keys}


def json_file(leave_out):
    return lambda a, b: list(json_differences(*(without(json.loads(path.read_text()), leave_out) for path in (a, b))))


def sweep_table(a, b):
    rows = [list(csv.DictReader(path.read_text().splitlines())) for path in (a, b)]
    return list(json_differences(*([without(row, TABLE_WALL) for row in table] for table in rows)))


def same_values(x, y):
    x, y = np.asarray(x), np.asarray(y)
    return x.dtype == y.dtype and x.shape == y.shape and x.tobytes() == y.tobytes()


def shown(x, y):
    """Where two arrays differ, in a few words."""
    x, y = np.asarray(x), np.asarray(y)
    if x.dtype.kind == y.dtype.kind == "U":
        return f"{x} and {y}"[:120]
    if x.dtype != y.dtype or x.shape != y.shape:
        return f"{x.dtype}{list(x.shape)} and {y.dtype}{list(y.shape)}"
    if x.size == 1 or x.dtype.kind not in "fiu":
        return f"{x.tolist()} and {y.tolist()}"[:120]
    off = x != y
    return f"{int(off.sum())} of {x.size} values, largest {x.max():.6g} and {y.max():.6g}"


def attribute_of(thing, name):
    """An attribute's value. References to other datasets, as those to the axes along which one lies, by their names."""
    value = thing.attrs[name]
    if np.asarray(value).dtype.kind != "O" and not (np.asarray(value).dtype.names or ()):
        return value

    def named(part):
        if isinstance(part, h5py.Reference):
            return thing.file[part].name
        return [named(one) for one in part] if isinstance(part, (list, tuple, np.ndarray, np.void)) else part
    return np.array(json.dumps(named(value), default=str))


def links_of(file):
    """{path: whether the link stays in the file}"""
    found = {}

    def take(name, info):
        found[name.decode(errors="surrogateescape")] = info.type == h5py.h5l.TYPE_HARD
    file.id.links.visit(take, info=True)
    return found


def h5_contents(file):
    """{path: the object}, groups too; a link that leads out of the file is no result."""
    return {"/": file} | {path: file[path] if inside else file.get(path, getlink=True)
                          for path, inside in links_of(file).items()}


def same_bytes(a, b):
    """Whether two HDF5 files are equal byte for byte and lead nowhere else, so that there is nothing to read."""
    if a.stat().st_size != b.stat().st_size or a.read_bytes() != b.read_bytes():
        return False
    with h5py.File(a, "r") as file:
        return all(links_of(file).values())


def h5_file(leave_out=()):
    """@param leave_out beginnings of names of datasets"""
    def attributes(x, y, path):
        names = set(x.attrs) | set(y.attrs)
        if leave_out:
            names.discard("checksum")
        for name in sorted(names):
            if name not in x.attrs or name not in y.attrs:
                yield f"attribute {path}@{name}: {only_in(name in x.attrs)}"
            elif not same_values(attribute_of(x, name), attribute_of(y, name)):
                yield f"attribute {path}@{name}: {shown(attribute_of(x, name), attribute_of(y, name))}"

    def compare(a, b):
        if same_bytes(a, b):
            return []
        found = []
        with h5py.File(a, "r") as first, h5py.File(b, "r") as second:
            left, right = h5_contents(first), h5_contents(second)
            for path in sorted(set(left) | set(right)):
                if path.startswith(leave_out):
                    continue
                x, y = left.get(path), right.get(path)
                if x is None or y is None:
                    found.append(f"{path}: {only_in(x is not None)}")
                elif isinstance(x, h5py.Dataset) and isinstance(y, h5py.Dataset):
                    if not same_values(x[()], y[()]):
                        found.append(f"dataset {path}: {shown(x[()], y[()])}")
                    found += attributes(x, y, path)
                elif isinstance(x, h5py.Group) and isinstance(y, h5py.Group):
                    found += attributes(x, y, path)
                else:
                    found.append(f"{path}: is not the same kind of thing in both, or no plain dataset")
        return found
    return compare


def bytes_of(a, b):
    x, y = a.read_bytes(), b.read_bytes()
    if x == y:
        return []
    at = next((i for i, (p, q) in enumerate(zip(x, y)) if p != q), min(len(x), len(y)))
    line = x[:at].count(b"\n") + 1
    return [f"differs from byte {at}, line {line}; {len(x)} and {len(y)} bytes"]


def comparison_of(path):
    name = path.split("/")[-1]
    if checkpoint_of(path):
        return json_file(MANIFEST_WALL) if name == "manifest.json" else h5_file(STATE_WALL)
    if name == "summary.json":
        return json_file(SUMMARY_WALL)
    if name == "sweep.csv":
        return sweep_table
    return h5_file() if name.endswith(".h5") else bytes_of


def checkpoint_differences(a_files, b_files):
    """@returns (differences, files of checkpoints that only one folder has and may have)"""
    steps = [{}, {}]
    for found, files in zip(steps, (a_files, b_files)):
        for path in files:
            if at := checkpoint_of(path):
                found.setdefault(at[0], set()).add(at[1])
    problems, single = [], set()
    for folder in sorted(set(steps[0]) | set(steps[1])):
        first, second = steps[0].get(folder, set()), steps[1].get(folder, set())
        if (max(first, default=None)) != (max(second, default=None)):
            problems.append(f"{folder}: the newest is {max(first, default='none')} and {max(second, default='none')}")
        alone = first ^ second
        single |= {path for path in a_files | b_files if (at := checkpoint_of(path))
                   and at[0] == folder and at[1] in alone}
    return problems, single


def differences(a, b, leave_out=()):
    """Everything in which two folders of results differ, as lines of text; empty when they hold the same.
    @param leave_out patterns of further files that differ by intent"""
    a, b = pathlib.Path(a), pathlib.Path(b)
    missing = [f"{folder} is not a folder" for folder in (a, b) if not folder.is_dir()]
    if missing:
        return missing
    a_files, b_files = files_of(a), files_of(b)
    found, single = checkpoint_differences(a_files, b_files)
    for path in sorted(a_files | b_files):
        intended = any(tail_matches(path, pattern) for pattern in leave_out)
        if intended or path in single or may_differ(path, a_files | b_files):
            continue
        if path not in a_files or path not in b_files:
            found.append(f"{path}: only in {a if path in a_files else b}")
            continue
        if (a / path).is_symlink() or (b / path).is_symlink():
            found.append(f"{path}: is a link, no result")
            continue
        try:
            found += [f"{path}: {text}" for text in comparison_of(path)(a / path, b / path)]
        except (OSError, ValueError) as error:
            found.append(f"{path}: cannot be read: {error}")
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("a", type=pathlib.Path, metavar="DIR_A")
    parser.add_argument("b", type=pathlib.Path, metavar="DIR_B")
    arguments = parser.parse_args()
    found = differences(arguments.a, arguments.b)
    for line in found:
        print(line)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
