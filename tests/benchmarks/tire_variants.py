#!/usr/bin/python3
"""Cost of a tire's step by `furrow bench tire`: by layers and by branches of relaxation, in turn, and by step and
threads. Writes the tables beside this script. Nothing else may run meanwhile.

usage: tire_variants.py layers|prony|step [--rounds 3]

layers   tire_layers.csv: each layer of the layered tire whole, or cut into three; 60 × 12 elements
prony    tire_prony.csv: the layered tire with none, one and three branches
step     tire_step_*.json: 4e-5 and 1e-4 s, one and two threads, one revolution
"""
import itertools
import json
import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "studies"))
import driver  # noqa: E402

BRANCHES = [[0.1, 1e-3], [0.1, 1e-2], [0.1, 1e-1]]  # relative modulus, relaxation time in s
PARTS = ("force", "jacobian", "factorize", "solve", "other")


def layered():
    return driver.read_json(driver.ROOT / "tire" / "data" / "hmmwv_layered.json")


def cut(parts):
    """The layered tire with each layer cut into `parts` of the same material."""
    tire = layered()
    for section in tire["sections"].values():
        section["layers"] = [{**layer, "thickness": layer["thickness"] / parts}
                             for layer in section["layers"] for _ in range(parts)]
    return tire


def relaxing(count):
    names = ("relative_modulus", "relaxation_time")
    return {**layered(), "prony": [dict(zip(names, branch)) for branch in BRANCHES[:count]]}


# table: (name of what varies, {its value: tire}, words, times, other figures)
TABLES = {
    "layers": ("layers", lambda: {len(cut(k)["sections"]["tread"]["layers"]): cut(k) for k in (1, 3)},
               ("--elements-circumference", "60", "--elements-width", "12", "--warm", "0.05", "--steps", "1500"),
               ("processor_ms_per_step", "median_ms"), ("factorizations", "deflection_m")),
    "prony": ("branches", lambda: {count: relaxing(count) for count in (0, 1, 3)},
              ("--warm", "0.1", "--steps", "2000"), ("ms_per_step", "median_ms"), ("newton_iterations_mean",)),
}


def bench(*words):
    return json.loads(driver.furrow("bench", "tire", *words))


def step():
    for size, threads in itertools.product(("4e-5", "1e-4"), (1, 2)):
        told = bench("--step", size, "--threads", threads, "--warm", "0.4")
        file = HERE / f"tire_step_{size}{'' if threads == 1 else f'_{threads}'}.json"
        file.write_text(json.dumps({"made": driver.provenance.made_here(), **told}, indent=2) + "\n")


def main():
    parser = driver.options(__doc__, rounds={"type": int, "default": 3})
    parser.add_argument("what", choices=(*TABLES, "step"))
    arguments = parser.parse_args()
    if arguments.what == "step":
        step()
        return
    column, variants, words, times, figures = TABLES[arguments.what]
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for number in range(1, arguments.rounds + 1):
            for value, tire in variants().items():
                file = pathlib.Path(folder) / f"{value}.json"
                file.write_text(json.dumps(tire))
                told = bench("--tire", file, *words)
                rows.append({column: value, "round": number, **{key: float(told[key]) for key in times},
                             **{f"{key}_ms": float(told["parts_ms"][key]) for key in PARTS},
                             **{key: f"{told[key]:.6g}" for key in figures}})
    driver.write(HERE / f"tire_{arguments.what}.csv", rows, told=True)


if __name__ == "__main__":
    main()
