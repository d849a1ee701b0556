#!/usr/bin/python3
"""What `furrow validate` estimates of scenarios beside what their runs take, as a table on standard output.

usage: estimates.py [SCENARIO...]

The bed is made first, then the run. Times of a step are processor times of the ranks, which other programs change less
than wall times: of the slowest tire, and of the terrain on all its threads. `ratio` is estimate over run of bed and run
together, in wall time: nothing else may run meanwhile.
"""
import json
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "studies"))
import driver  # noqa: E402

SCENARIOS = ("first_look", "four_wheels", "drawbar_pull_small_report_soil", "drawbar_pull_small", "hmmwv_small",
             "rover_small", "hmmwv_turn", "small_wheel")


def estimated(words):
    found = json.loads(driver.furrow("validate", *words, "--json"))
    time = found["time"]
    return {"sinkage_mm": 1e3 * found["wheels"][0]["expected_sinkage_m"], "awake": time["awake_share"],
            "refined": time["refined_share"], "tire_ms": 1e3 * time["slowest_tire_s"],
            "terrain_ms": 1e3 * time["terrain_s"] * time["terrain_threads"], "all_s": time["all_s"]}


def measured(words, folder):
    cold = {"XDG_CACHE_HOME": str(folder / "cache")}
    bed_s = json.loads(driver.furrow("bed", *words, "--quiet", **cold))["wall_s"]
    _, _, wall = driver.timed("run", *words, "--out", folder / "run", "--no-plots", "--quiet", **cold)
    summary = driver.summary(folder / "run")
    steps = summary["simulated_s"] / summary["ranks"][0]["step_s"]
    cpu = [(rank["node"].split()[0], 1e3 * rank["cpu_s"] / steps) for rank in summary["ranks"]]
    return {"sinkage_mm": 1e3 * summary["wheels"][0]["sinkage_m"], "awake": summary["active_share_mean"],
            "refined": summary["substeps_refined_share"], "tire_ms": max(ms for node, ms in cpu if node == "tire"),
            "terrain_ms": sum(ms for node, ms in cpu if node == "terrain"), "all_s": bed_s + wall}


def main():
    parser = driver.options(__doc__)
    parser.add_argument("names", nargs="*", metavar="SCENARIO")
    with tempfile.TemporaryDirectory() as name:
        for scenario in parser.parse_args().names or SCENARIOS:
            file = scenario.removesuffix(".json") + ".json"
            guess = estimated([file, "--set", "terrain.cache=false"])
            found = measured([file], pathlib.Path(name) / scenario)
            print(f"{scenario}: ratio {guess['all_s'] / found['all_s']:.2f}")
            for key, value in guess.items():
                print(f"  {key:11} {value:8.3g} {found[key]:8.3g}", flush=True)


if __name__ == "__main__":
    main()
