#!/usr/bin/env python3
"""Checks how the sources include each other: no circle, no arrow up, no folder that outgrew its purpose.

A unit is a header together with its source. Rooms are the folders of FLOORS, lowest first; a file belongs to the longest entry
that begins its path. A room may include itself, rooms of lower floors, and nothing else.

usage: scripts/check_includes.py [--summary]
Prints every offending include as FILE:LINE and exits with 1 if there is one.
"""
import argparse
import collections
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
    ["nodes/commands"],
    ["nodes"],
]
# Physics rooms do not know what crosses ranks: of protocol/ they may include core and files alone.
PHYSICS = ("tire", "terrain", "terrain/surface", "vehicle", "rigs")
LARGEST_FOLDER = 45  # sources

ROOT = pathlib.Path(__file__).resolve().parent.parent
FLOOR_OF = {room: floor for floor, rooms in enumerate(FLOORS) for room in rooms}


def sources():
    tops = sorted({room.split("/")[0] for room in FLOOR_OF})
    return [str(file.relative_to(ROOT)) for top in tops for file in sorted((ROOT / top).rglob("*.[ch]pp"))]


def room_of(file):
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


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--summary", action="store_true", help="print the figures even if all is well")
    summary = parser.parse_args().summary
    files = sources()
    known, problems, arrows_up = set(files), [], 0
    edges, lines = collections.defaultdict(set), {}
    for file in files:
        edges[unit_of(file)]
        for number, line in enumerate((ROOT / file).read_text().split("\n"), 1):
            match = re.match(r'#include "([^"]+)"', line)
            if not match or match[1] not in known:
                continue
            target = match[1]
            if unit_of(target) != unit_of(file):
                edges[unit_of(file)].add(unit_of(target))
                lines.setdefault((unit_of(file), unit_of(target)), f"{file}:{number}")
            here, there = room_of(file), room_of(target)
            if here != there and FLOOR_OF[there] >= FLOOR_OF[here]:
                problems.append(f"{file}:{number}: {here} includes {target} of {there}, which is not below it")
                arrows_up += 1
            elif here in PHYSICS and there == "protocol":
                problems.append(f"{file}:{number}: {here} includes {target}; physics may include only protocol/core and files")
                arrows_up += 1
    found = circles(edges)
    for members in found:
        inside = [f"  {lines[a, b]} includes {b}" for a in sorted(members) for b in sorted(edges[a] & members)]
        problems.append("circle of includes:\n" + "\n".join(inside))
    folders = collections.Counter(str(pathlib.Path(file).parent) for file in files)
    for folder, count in folders.items():
        if count > LARGEST_FOLDER:
            problems.append(f"{folder}: {count} sources, expected at most {LARGEST_FOLDER}")
    for file in files:
        if str(pathlib.Path(file).parent) == "nodes" and file != "nodes/main.cpp":
            problems.append(f"{file}: nodes/ itself holds main alone")
    for problem in problems:
        print(problem)
    if summary or problems:
        folder, count = folders.most_common(1)[0]
        print(f"{len(files)} sources, {len(edges)} units; circles: {len(found)}; arrows up: {arrows_up}; "
              f"largest folder: {folder}, {count}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
