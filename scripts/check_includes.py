#!/usr/bin/env python3
"""Checks how the sources include each other: no circle, no arrow up, no folder that outgrew its purpose, no line too
wide.

A unit is a header together with its source. Rooms are the folders of FLOORS, lowest first; a file belongs to the
longest entry that begins its path. A room may include itself, rooms of lower floors, and nothing else; of tests
nothing. MPI is the business of protocol/ alone. The dummies of tests/dummies/ follow the rules of the room that they
would belong to.

usage: scripts/check_includes.py [--summary] [--root FOLDER]
Prints every offending include as FILE:LINE and exits with 1 if there is one.
"""
import argparse
import collections
import os.path
import pathlib
import re
import sys

# Lowest floor first. Rooms of one floor know nothing of each other.
FLOORS = [
    ["protocol/core"],
    ["protocol/files"],
    ["terrain/surface", "protocol"],
    ["tire", "terrain", "vehicle"],
    ["rigs"],
    ["nodes/scenario"],
    ["nodes/launch"],
    ["nodes/checkpoint"],
    ["nodes/output"],
    ["nodes/ranks"],
    ["nodes/study"],
    ["nodes/calibrate"],
    ["nodes/commands"],
    ["nodes"],
]
# Physics rooms do not know what crosses ranks: of protocol/ they may include core and files alone.
PHYSICS = ("tire", "terrain", "terrain/surface", "vehicle", "rigs")
LARGEST_FOLDER = 45  # sources
WIDTH = 120  # columns
# Top-level folders that hold no room.
NO_ROOMS = {"tests", "scripts"}
# Dummies of models: the room that each would be in, and the unit with the table that would list it.
DUMMIES = {
    "tests/dummies/spring_wheel": ("tire", "tire/tires"),
    "tests/dummies/spring_mat": ("terrain", "terrain/terrains"),
    "tests/dummies/strip_mat": ("terrain", "terrain/terrains"),
    "tests/dummies/held_hub": ("rigs", "rigs/rigs"),
}
KNOW_MPI = ("protocol/", "terrain/liggghts/plugin/")
INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')

FLOOR_OF = {room: floor for floor, rooms in enumerate(FLOORS) for room in rooms}
TOPS = sorted({room.split("/")[0] for room in FLOOR_OF})


def sources(root):
    found = [str(file.relative_to(root)) for top in TOPS for file in sorted((root / top).rglob("*.[ch]pp"))]
    return found + [unit + end for unit in DUMMIES for end in (".hpp", ".cpp") if (root / (unit + end)).exists()]


def room_of(file):
    if unit_of(file) in DUMMIES:
        return DUMMIES[unit_of(file)][0]
    return max((room for room in FLOOR_OF if file.startswith(room + "/")), key=len)


def unit_of(file):
    return file.rsplit(".", 1)[0]


def circles(edges):
    """Strongly connected components of more than one unit [Tarjan 1972], without recursion."""
    index, low, on_stack, stack, found = {}, {}, set(), [], []
    for root in sorted(edges):
        if root in index:
            continue
        work = [(root, iter(sorted(edges[root])))]
        index[root] = low[root] = len(index)
        stack.append(root)
        on_stack.add(root)
        while work:
            unit, targets = work[-1]
            for target in targets:
                if target not in index:
                    index[target] = low[target] = len(index)
                    stack.append(target)
                    on_stack.add(target)
                    work.append((target, iter(sorted(edges[target]))))
                    break
                if target in on_stack:
                    low[unit] = min(low[unit], index[target])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[unit])
                if low[unit] == index[unit]:
                    members = set()
                    while unit not in members:
                        members.add(stack.pop())
                    on_stack -= members
                    if len(members) > 1:
                        found.append(members)
    return found


def includes(root, files):
    """@returns (file, line number, included file as written, the same from the root)"""
    for file in files:
        for number, line in enumerate((root / file).read_text().split("\n"), 1):
            if match := INCLUDE.match(line):
                beside = os.path.normpath(os.path.join(os.path.dirname(file), match[2]))
                by_place = match[1] == '"' and not (root / match[2]).is_file() and (root / beside).is_file()
                yield file, number, match[2], beside if by_place else os.path.normpath(match[2])


def include_problems(root, files, edges, lines):
    for file, number, written, target in includes(root, files):
        here, place = room_of(file), f"{file}:{number}"
        if re.match(r"(open)?mpi(ext)?\.h$|mpi/", written) and not file.startswith(KNOW_MPI):
            yield f"{place}: {here} includes <{written}>; only {' and '.join(KNOW_MPI)} know MPI"
        if not (root / target).is_file():
            continue
        if written != target:
            yield f"{place}: includes \"{written}\", expected the path from the root: \"{target}\""
        if target.startswith("tests/") and unit_of(target) != unit_of(file):
            yield f"{place}: {here} includes {target}; tests are no part of the program"
        if target not in files:
            continue
        if unit_of(target) != unit_of(file):
            edges[unit_of(file)].add(unit_of(target))
            lines.setdefault((unit_of(file), unit_of(target)), place)
        there = room_of(target)
        if here != there and FLOOR_OF[there] >= FLOOR_OF[here]:
            yield f"{place}: {here} includes {target} of {there}, which is not below it"
        elif here in PHYSICS and there == "protocol":
            yield f"{place}: {here} includes {target}; physics may include only protocol/core and files"


def circle_problems(edges, lines):
    for unit, (_, table) in DUMMIES.items():  # as if it stood in its room
        if unit in edges and table in edges:
            edges[table].add(unit)
            lines.setdefault((table, unit), f"{table}.cpp")
    for members in circles(edges):
        inside = [f"  {lines[a, b]} includes {b}" for a in sorted(members) for b in sorted(edges[a] & members)]
        yield "circle of includes:\n" + "\n".join(inside)


def folder_problems(root, files):
    for folder in sorted(path for path in root.iterdir() if path.is_dir() and not path.name.startswith(".")):
        if folder.name in NO_ROOMS or folder.name in TOPS or folder.name.startswith("build"):
            continue
        if any(folder.rglob("*.[ch]pp")):
            yield f"{folder.name}/: holds sources, but FLOORS does not say on which floor it is"
    for folder, count in collections.Counter(str(pathlib.Path(file).parent) for file in files).items():
        if count > LARGEST_FOLDER:
            yield f"{folder}: {count} sources, expected at most {LARGEST_FOLDER}"
    for file in files:
        if file.startswith("nodes/") and room_of(file) == "nodes" and file != "nodes/main.cpp":
            yield f"{file}: is in no room of nodes/ that FLOORS lists; nodes/ itself holds main alone"


def width_problems(root, files):
    for file in files:
        for number, line in enumerate((root / file).read_text().split("\n"), 1):
            if len(line) > WIDTH:
                yield f"{file}:{number}: has {len(line)} columns, expected at most {WIDTH}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--summary", action="store_true", help="print the figures even if all is well")
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    options = parser.parse_args()
    files = sources(options.root)
    edges, lines = collections.defaultdict(set, {unit_of(file): set() for file in files}), {}
    arrows_up = list(include_problems(options.root, files, edges, lines))
    found = list(circle_problems(edges, lines))
    problems = arrows_up + found + list(folder_problems(options.root,
                                                        files)) + list(width_problems(options.root, files))
    for problem in problems:
        print(problem)
    if (options.summary or problems) and files:
        folder, count = collections.Counter(str(pathlib.Path(file).parent) for file in files).most_common(1)[0]
        print(f"{len(files)} sources, {len(edges)} units; circles: {len(found)}; arrows up: {len(arrows_up)}; "
              f"largest folder: {folder}, {count}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
