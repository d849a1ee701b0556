#!/usr/bin/python3
"""What the same rig costs on grains and on empirical soil: processor time for a simulated second, of the terrain's rank
and of all ranks, in runs that take turns. Writes soil_cost.csv beside this script. Nothing else may run meanwhile.

usage: soil_cost.py [--rigs small full] [--tires rigid ring lumped layered] [--rounds 1]

The rig of drawbar_pull_small_report_soil.json runs for 0.7 s, that of drawbar_pull.json, at full size, for 0.5 s; both
engines have the tire and the ground's plan of the file. The bed of grains is settled before and not counted. The
empirical soil is that of drawbar_pull_scm.json, with nodes 10 mm apart; it runs with the step of the grains, and with
its own, that of that file. `ratio_terrain` and `ratio_all` are grains over empirical soil.
"""
import json
import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "studies"))
import driver  # noqa: E402
import provenance  # noqa: E402

RIGS = {"small": ("drawbar_pull_small_report_soil.json", 0.7), "full": ("drawbar_pull.json", 0.5)}
TIRES = {"rigid": {"rigid": True}, "ring": {"file": "hmmwv_ring.json"},
         "lumped": {"file": "hmmwv_lumped.json"}, "layered": {}}
COSTS = ("terrain_cpu", "all_cpu", "wall")


def rig_of(file):
    return driver.read_json(driver.ROOT / "rigs" / file)


def scenarios(rig, tire):
    """A rig on its grains, and on the soil of drawbar_pull_scm.json of the same length and width with both steps."""
    file, end = RIGS[rig]
    base, scm = rig_of(file), rig_of("drawbar_pull_scm.json")
    base.pop("expected", None)
    base["output"] = {"frame_interval": 0}
    base["run"] |= {"end": end, "average_from": end - 0.2}
    # Mesh and pressure of the scenario are those of its own tire.
    base["tire"] = TIRES[tire] if "file" in TIRES[tire] else base["tire"] | TIRES[tire]
    same = base | {"terrain": scm["terrain"] | {key: base["terrain"][key] for key in ("length", "width")}}
    return base, same, same | {"run": same["run"] | {"step": scm["run"]["step"]}}


def costs(scenario, folder):
    """(grains, {cost: seconds for a simulated one})"""
    file = folder / "scenario.json"
    file.write_text(json.dumps(scenario), encoding="utf-8")
    driver.furrow("run", file, "--out", folder / "run", "--overwrite", "--no-plots")
    summary = driver.summary(folder / "run")
    by_rank = [(rank["node"], rank["cpu_s"]) for rank in summary["ranks"]]
    seconds = (sum(cpu for node, cpu in by_rank if node.startswith("terrain")), sum(cpu for _, cpu in by_rank),
               summary["wall_s"])
    return summary.get("grains"), {cost: value / scenario["run"]["end"] for cost, value in zip(COSTS, seconds)}


def rows_of(rig, tire, number, folder):
    on_grains, *on_soil = scenarios(rig, tire)
    count, grains = costs(on_grains, folder)
    for scenario in on_soil:
        _, soil = costs(scenario, folder)
        line = {"rig": rig, "tire": tire, "round": number, "grains_step_s": str(on_grains["run"]["step"]),
                "soil_step_s": str(scenario["run"]["step"]), "grains": count}
        for cost in COSTS:
            line |= {f"grains_{cost}_s_per_s": grains[cost], f"soil_{cost}_s_per_s": soil[cost]}
            if cost != "wall":
                line[f"ratio_{cost.removesuffix('_cpu')}"] = grains[cost] / soil[cost]
        yield line


def main():
    arguments = driver.options(__doc__, rigs={"nargs": "+", "choices": RIGS, "default": list(RIGS)},
                               tires={"nargs": "+", "choices": TIRES, "default": list(TIRES)},
                               rounds={"type": int, "default": 1}).parse_args()
    made = provenance.made_here()
    with tempfile.TemporaryDirectory() as folder:
        rows = [row for rig in arguments.rigs for tire in arguments.tires for number in range(1, arguments.rounds + 1)
                for row in rows_of(rig, tire, number, pathlib.Path(folder))]
    driver.write(HERE / "soil_cost.csv", rows, made, told=True)


if __name__ == "__main__":
    main()
