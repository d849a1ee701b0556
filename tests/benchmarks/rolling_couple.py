#!/usr/bin/python3
"""What the rolling couple between grains and a tire costs: small_wheel.json with it and without it in turn, by the
processor time of the terrain, which has one thread.

usage: rolling_couple.py [--rounds 3] [--end 1.0] [--csv FILE]

The bed is settled before. Without the couple the wheel pulls and sinks otherwise, so that it touches other grains: the
ratio holds for this wheel alone. Nothing else should run meanwhile.
"""
import pathlib
import statistics
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "studies"))
import driver  # noqa: E402

CASES = {"without": {"tire.rolling_friction": 0.0}, "with": {}}


def run(folder, end, case):
    """(processor time of the terrain, s; grain-steps) of one run"""
    out = folder / case
    words = driver.settings({"run.end": end, "run.average_from": 0.5 * end, "run.threads": 1,
                             "output.frame_interval": 0}, CASES[case])
    driver.furrow("run", "rigs/small_wheel.json", *words, "--no-plots", "--overwrite", "--out", out)
    summary = driver.summary(out)
    terrain = next(rank for rank in summary["ranks"] if rank["node"].startswith("terrain"))
    return terrain["cpu_s"], summary["grains"] * summary["simulated_s"] / terrain["step_s"]


def main():
    arguments = driver.options(__doc__, rounds={"type": int, "default": 3}, end={"type": float, "default": 1.0},
                               csv={"type": pathlib.Path}).parse_args()
    rows, ratios = [], []
    with tempfile.TemporaryDirectory() as name:
        run(pathlib.Path(name), 0.01, "with")
        for number in range(arguments.rounds):
            took = {}
            for case in sorted(CASES, reverse=number % 2 == 0):
                seconds, grain_steps = run(pathlib.Path(name), arguments.end, case)
                took[case] = seconds
                rows.append({"round": number, "couple": case, "terrain_cpu_s": f"{seconds:.3f}",
                             "ns_per_grain_step": f"{1e9 * seconds / grain_steps:.2f}"})
                print(rows[-1], flush=True)
            ratios.append(took["with"] / took["without"])
    print(f"with over without: {statistics.mean(ratios):.4f}, from {min(ratios):.4f} to {max(ratios):.4f}")
    if arguments.csv:
        driver.write(arguments.csv.absolute(), rows)


if __name__ == "__main__":
    main()
