#!/usr/bin/python3
"""How much faster or slower one build is than another: both in turn, A B B A …, on one core, ratio pair by pair.

paired_speed.py SOURCE_A SOURCE_B [--rounds 100] [--bench grains,tire] [--core 1] [--csv FILE]

SOURCE_A and SOURCE_B are checkouts with a build in build/. `grains` steps 63,360 grains on a lattice, every grain in
every step; `tire` rolls the layered tire. The ratio is exp(mean of log(B/A)) with its 95 % interval over the pairs.
Nothing else may compute on the machine meanwhile.
"""
import json
import math
import statistics
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "studies"))
import driver  # noqa: E402
import provenance  # noqa: E402


def write_lattice(file):
    """A lattice of grains that nearly touch; bench grains' radius is 6 mm."""
    with open(file, "w") as out:
        out.write("x_m,y_m,z_m\n")
        out.writelines(f"{0.006 + 0.0119 * i:.6f},{0.007 + 0.0122 * j:.6f},{0.0059 + 0.0118 * k:.6f}\n"
                       for k in range(20) for i in range(66) for j in range(48))


def milliseconds(source, words, core):
    result = json.loads(driver.furrow("bench", *words, program=source / "build" / "furrow", OMP_NUM_THREADS="1",
                                      before=["taskset", "-c", core], FURROW_HOME=str(source)))
    return result.get("ms_per_step") or result["median_ms"]


def main():
    parser = driver.options(__doc__, rounds={"type": int, "default": 100}, bench={"default": "grains,tire"},
                            core={"type": int, "default": 1}, csv={"type": Path, "help": "write every pair to it"})
    for name in "ab":
        parser.add_argument(name, type=lambda text: Path(text).resolve(), metavar=f"SOURCE_{name.upper()}")
    arguments = parser.parse_args()
    sources, rows = {"a": arguments.a, "b": arguments.b}, []
    with tempfile.TemporaryDirectory() as folder:
        bed = Path(folder) / "lattice.csv"
        write_lattice(bed)
        benches = {"grains": ["grains", "--bed", bed, "--threads", "1", "--steps", "400", "--warm", "50"],
                   "tire": ["tire", "--threads", "1", "--steps", "400", "--warm", "0.02"]}
        for name in arguments.bench.split(","):
            pairs = []
            for number in range(arguments.rounds):
                took = {side: milliseconds(sources[side], benches[name], arguments.core)
                        for side in ("ab" if number % 2 == 0 else "ba")}
                pairs.append((took["a"], took["b"]))
                rows.append({"bench": name, "pair": number, "a_ms": took["a"], "b_ms": took["b"]})
            logs = [math.log(b / a) for a, b in pairs]
            mean, error = statistics.mean(logs), statistics.stdev(logs) / math.sqrt(len(logs))
            print(f"{name}: median {statistics.median(a for a, _ in pairs):.4g} and "
                  f"{statistics.median(b for _, b in pairs):.4g} ms per step; B/A {math.exp(mean):.4f}, 95 % "
                  f"{math.exp(mean - 1.96 * error):.4f} to {math.exp(mean + 1.96 * error):.4f}, {len(logs)} pairs")
    if arguments.csv:
        compilers = {provenance.compiler_of(source / "build" / "furrow") for source in sources.values()}
        driver.write(arguments.csv.resolve(), rows, {
            "commit": " and ".join(provenance.commit(source) for source in sources.values()),
            "compiler": " and ".join(sorted(compilers)), "processor": provenance.processor(),
            "command": provenance.command()}, None)


if __name__ == "__main__":
    main()
