#!/usr/bin/python3
"""How many ranks a bed needs: estimates, not measurements. Writes liggghts_ranks.csv beside this script.

usage: liggghts_ranks.py [--grains 1e6 1e7 1e8 1e9] [--nodes 1 4 16 64]

The bed is that of drawbar_pull_small_report_soil, 3 × 0.6 m, of smaller and smaller grains; its step goes with their
radius. What one rank computes in a step, its ghosts, memory and sizes of files are those of `furrow validate`, for the
machine that this runs on (terrain/liggghts/rank_cost.hpp: measured on 1 and 2 ranks with 24,340 grains). Added here,
and assumed, not measured: nodes of 32 cores that are as fast as this one's; two messages a step with 72 bytes for each
ghost (that size is measured) over a network of 5 µs and 10 GB/s; sums over all ranks once a step, 5 µs for each
doubling of their number. Engine dem has 32 threads of one node without loss. A tire is not in these figures, nor is the
making of the bed.
"""
import json
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "studies"))
import driver  # noqa: E402

GRAINS, RADIUS, STEP = 24330, 0.01, 6e-5  # of drawbar_pull_small_report_soil: grains, m, s
CORES = 32  # of a node
LATENCY, BANDWIDTH, GHOST = 5e-6, 1e10, 72  # s, bytes/s, bytes
LEAST_PART = 6.0  # radii: nodes/scenario/scenario_checks.cpp


def row(engine, nodes, grains):
    """None where parts would be thinner than three grains, which is refused."""
    peer, finer = engine == "liggghts", (grains / GRAINS) ** (1 / 3)
    radius, step, ranks = RADIUS / finer, STEP / finer, nodes * CORES if peer else 1
    if ranks * LEAST_PART * radius > 3.0:
        return None
    keys = {"terrain.engine": engine, "terrain.ranks": ranks} if peer else \
        {"terrain.activity": False, "terrain.precision": "double", "run.threads": CORES}
    told = json.loads(driver.furrow("validate", "--json", "rigs/drawbar_pull_small_report_soil.json", *driver.settings(
        {"terrain.radius": radius, "terrain.layers": round(9 * finer), "run.step": step}, keys)))
    time, terrain = told["time"], told["terrain"]
    compute, ghosts = time["terrain_s"], time["ghosts_per_rank"]
    if not peer:
        compute *= min(CORES, time["cores"]) / CORES
    messages = 2 * (LATENCY + GHOST * ghosts / 2 / BANDWIDTH) + LATENCY * math.log2(ranks) if ranks > 1 else 0.0
    return {"engine": engine, "nodes": nodes, "ranks": ranks, "grains": told["grains"], "radius_mm": 1e3 * radius,
            "step_s": step, "own_per_rank": told["grains"] / ranks, "ghosts_per_rank": ghosts,
            "compute_ms": 1e3 * compute, "messages_ms": 1e3 * messages,
            "wall_h_per_simulated_s": (compute + messages) / step / 3600,
            "memory_per_rank_GB": 1e-9 * terrain["memory_per_rank_bytes"],
            "first_rank_at_start_GB": 1e-6 * told["grains"] if peer else "",
            "checkpoint_GB": 1e-9 * terrain["checkpoint_bytes"], "frame_GB": 1e-9 * terrain["frame_bytes"]}


def main():
    arguments = driver.options(__doc__, grains={"nargs": "+", "type": float, "default": [1e6, 1e7, 1e8, 1e9]},
                               nodes={"nargs": "+", "type": int, "default": [1, 4, 16, 64]}).parse_args()
    rows = [row(*case, grains) for grains in arguments.grains
            for case in (("dem", 1), *(("liggghts", nodes) for nodes in arguments.nodes))]
    driver.write(HERE / "liggghts_ranks.csv", [one for one in rows if one], digits=3)


if __name__ == "__main__":
    main()
