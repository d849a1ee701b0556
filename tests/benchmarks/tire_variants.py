#!/usr/bin/env python3
"""Cost of a tire's step by `furrow bench tire`: by layers and by branches of relaxation, in turn, and by step and
threads. Writes the tables beside this script. Nothing else may run meanwhile.

usage: tire_variants.py layers|prony|step [--rounds 3]

layers   tire_layers.csv: each layer of the layered tire whole, or cut into three; 60 × 12 elements
prony    tire_prony.csv: the layered tire with none, one and three branches
step     tire_step_*.json: 4e-5 and 1e-4 s, one and two threads, one revolution
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(ROOT / "tests" / "studies"))
import provenance  # noqa: E402

BRANCHES = [[0.1, 1e-3], [0.1, 1e-2], [0.1, 1e-1]]  # relative modulus, relaxation time in s
PARTS = ("force", "jacobian", "factorize", "solve", "other")


def layered():
    return json.loads((ROOT / "tire" / "data" / "hmmwv_layered.json").read_text())


def cut(tire, parts):
    """The tire with each layer cut into `parts` of the same material."""
    for section in tire["sections"].values():
        section["layers"] = [{**layer, "thickness": layer["thickness"] / parts}
                             for layer in section["layers"] for _ in range(parts)]
    return tire


def bench(*words):
    done = subprocess.run([provenance.program(), "bench", "tire", *words],
                          check=True, stdout=subprocess.PIPE, text=True,
                          env={**os.environ, "FURROW_HOME": str(ROOT)})
    return json.loads(done.stdout)


def in_turn(variants, rounds, *words):
    """(name of a variant, round, what the benchmark told) of every run."""
    with tempfile.TemporaryDirectory() as folder:
        files = {}
        for name, tire in variants.items():
            files[name] = pathlib.Path(folder) / f"{name}.json"
            files[name].write_text(json.dumps(tire))
        for number in range(1, rounds + 1):
            for name, file in files.items():
                told = bench("--tire", str(file), *words)
                print(name, number, f"{told['ms_per_step']:.4g} ms", file=sys.stderr, flush=True)
                yield name, number, told


def figures(told, keys):
    return {f"{key}_ms": f"{told['parts_ms'][key]:.4g}" for key in PARTS} | {key: f"{told[key]:.6g}" for key in keys}


def layers(rounds):
    whole = len(layered()["sections"]["tread"]["layers"])
    rows = []
    for parts, number, told in in_turn({1: cut(layered(), 1), 3: cut(layered(), 3)},
                                       rounds, "--elements-circumference", "60",
                                       "--elements-width", "12", "--warm", "0.05", "--steps", "1500"):
        rows.append({"layers": whole * parts, "round": number,
                     "processor_ms_per_step": f"{told['processor_ms_per_step']:.4g}",
                     "median_ms": f"{told['median_ms']:.4g}", **figures(told, ("factorizations", "deflection_m"))})
    provenance.write_table(HERE / "tire_layers.csv", list(rows[0]), rows, provenance.made_here())


def prony(rounds):
    branches = ("relative_modulus", "relaxation_time")
    variants = {n: {**layered(), "prony": [dict(zip(branches, branch)) for branch in BRANCHES[:n]]} for n in (0, 1, 3)}
    rows = []
    for count, number, told in in_turn(variants, rounds, "--warm", "0.1", "--steps", "2000"):
        rows.append({"branches": count, "round": number, "ms_per_step": f"{told['ms_per_step']:.4g}",
                     "median_ms": f"{told['median_ms']:.4g}", **figures(told, ("newton_iterations_mean",))})
    provenance.write_table(HERE / "tire_prony.csv", list(rows[0]), rows, provenance.made_here())


def step(_):
    for size in ("4e-5", "1e-4"):
        for threads in (1, 2):
            told = bench("--step", size, "--threads", str(threads), "--warm", "0.4")
            file = HERE / f"tire_step_{size}{'' if threads == 1 else f'_{threads}'}.json"
            file.write_text(json.dumps({"made": provenance.made_here(), **told}, indent=2) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("layers", "prony", "step"))
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    {"layers": layers, "prony": prony, "step": step}[arguments.what](arguments.rounds)


if __name__ == "__main__":
    main()
