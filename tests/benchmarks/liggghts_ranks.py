#!/usr/bin/python3
"""How many ranks a bed needs: estimates, not measurements. Writes liggghts_ranks.csv beside this script.

usage: liggghts_ranks.py [--grains 1e6 1e7 1e8 1e9] [--nodes 1 4 16 64]

The bed is that of drawbar_pull_small, 3 × 0.6 m, of smaller and smaller grains; its step goes with their radius. What
one rank computes in a step, its ghosts, memory and sizes of files are those of `furrow validate`, for the machine that
this runs on (terrain/liggghts/rank_cost.hpp: measured on 1 and 2 ranks with 24,340 grains). Added here, and assumed,
not measured: nodes of 32 cores that are as fast as this one's; two messages a step with 72 bytes for each ghost (that
size is measured) over a network of 5 µs and 10 GB/s; sums over all ranks once a step, 5 µs for each doubling of their
number. Engine dem has 32 threads of one node without loss. A tire is not in these figures, nor is the making of the
bed.
"""
import argparse
import json
import math
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "studies"))
import provenance  # noqa: E402
from provenance import ROOT  # noqa: E402

RIG = str(ROOT / "rigs" / "drawbar_pull_small.json")
GRAINS, RADIUS, STEP = 24330, 0.01, 6e-5  # of that rig: grains, m, s
CORES = 32  # of a node
LATENCY, BANDWIDTH, GHOST = 5e-6, 1e10, 72  # s, bytes/s, bytes
LEAST_PART = 6.0  # radii: nodes/scenario/scenario_checks.cpp
COLUMNS = ["engine", "nodes", "ranks", "grains", "radius_mm", "step_s",
           "own_per_rank", "ghosts_per_rank", "compute_ms", "messages_ms",
           "wall_h_per_simulated_s", "memory_per_rank_GB", "first_rank_at_start_GB", "checkpoint_GB", "frame_GB"]


def validated(grains, *keys):
    """(report of `furrow validate`, radius, step)"""
    finer = (grains / GRAINS) ** (1 / 3)
    radius, step = RADIUS / finer, STEP / finer
    settings = [f"terrain.radius={radius:.8g}", f"terrain.layers={round(9 * finer)}", f"run.step={step:.8g}", *keys]
    command = [provenance.program(), "validate", "--json", RIG]
    for key in settings:
        command += ["--set", key]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(done.stderr)
    return json.loads(done.stdout), radius, step


def row(engine, nodes, grains):
    ranks = nodes * CORES if engine == "liggghts" else 1
    radius = RADIUS / (grains / GRAINS) ** (1 / 3)
    if ranks * LEAST_PART * radius > 3.0:
        return None  # parts thinner than three grains are refused
    keys = ["terrain.engine=liggghts", f"terrain.ranks={ranks}"] if engine == "liggghts" else \
        ["terrain.activity=false", "terrain.precision=double", f"run.threads={CORES}"]
    told, radius, step = validated(grains, *keys)
    time, terrain = told["time"], told["terrain"]
    if engine == "liggghts":
        compute = time["terrain_s"]
        messages = 0.0 if ranks == 1 else 2 * (LATENCY + GHOST * time["ghosts_per_rank"]
                                               / 2 / BANDWIDTH) + LATENCY * math.log2(ranks)
    else:
        compute, messages = time["terrain_s"] * min(CORES, time["cores"]) / CORES, 0.0
    return {"engine": engine, "nodes": nodes, "ranks": ranks, "grains": told["grains"],
            "radius_mm": 1e3 * radius, "step_s": step,
            "own_per_rank": told["grains"] / ranks, "ghosts_per_rank": time["ghosts_per_rank"],
            "compute_ms": 1e3 * compute,
            "messages_ms": 1e3 * messages, "wall_h_per_simulated_s": (compute + messages) / step / 3600,
            "memory_per_rank_GB": 1e-9 * terrain["memory_per_rank_bytes"],
            "first_rank_at_start_GB": 1e-6 * told["grains"] if engine == "liggghts" else "",
            "checkpoint_GB": 1e-9 * terrain["checkpoint_bytes"], "frame_GB": 1e-9 * terrain["frame_bytes"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--grains", nargs="+", type=float, default=[1e6, 1e7, 1e8, 1e9])
    parser.add_argument("--nodes", nargs="+", type=int, default=[1, 4, 16, 64])
    arguments = parser.parse_args()
    made = provenance.made_here()
    rows = []
    for grains in arguments.grains:
        rows.append(row("dem", 1, grains))
        rows += [one for nodes in arguments.nodes if (one := row("liggghts", nodes, grains))]
    text = [{key: f"{value:.3g}" if isinstance(value, float) else value for key, value in one.items()} for one in rows]
    provenance.write_table(HERE / "liggghts_ranks.csv", COLUMNS, text, made)


if __name__ == "__main__":
    main()
