#!/usr/bin/env python3
"""What the same rig costs on grains and on empirical soil: processor time for a simulated second, of the terrain's rank
and of all ranks, in runs that take turns. Writes soil_cost.csv beside this script. Nothing else may run meanwhile.

usage: soil_cost.py [--rigs small full] [--tires rigid ring lumped layered] [--rounds 1]

The rig of drawbar_pull_small.json runs for 0.7 s, that of drawbar_pull.json, at full size, for 0.5 s; both engines have
the tire and the ground's plan of the file. The bed of grains is settled before and not counted. The empirical soil is
that of drawbar_pull_scm.json, with nodes 10 mm apart; it runs with the step of the grains, and with its own, that of
that file. `ratio_terrain` and `ratio_all` are grains over empirical soil.
"""
import argparse
import copy
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

RIGS = {"small": ("drawbar_pull_small.json", 0.7), "full": ("drawbar_pull.json", 0.5)}
TIRES = {"rigid": {"rigid": True}, "ring": {"file": "hmmwv_ring.json"},
         "lumped": {"file": "hmmwv_lumped.json"}, "layered": {}}
COLUMNS = ("rig", "tire", "round", "grains_step_s", "soil_step_s", "grains",
           "grains_terrain_cpu_s_per_s", "soil_terrain_cpu_s_per_s", "ratio_terrain",
           "grains_all_cpu_s_per_s", "soil_all_cpu_s_per_s", "ratio_all", "grains_wall_s_per_s", "soil_wall_s_per_s")


def scenarios(rig, tire):
    """A rig on its grains, and on the soil of drawbar_pull_scm.json of the same length and width with both steps."""
    file, end = RIGS[rig]
    base = json.loads((ROOT / "rigs" / file).read_text())
    base.pop("expected", None)
    base["output"] = {"frame_interval": 0}
    base["run"] |= {"end": end, "average_from": end - 0.2}
    # Mesh and pressure of the scenario are those of its own tire.
    base["tire"] = TIRES[tire] if "file" in TIRES[tire] else base["tire"] | TIRES[tire]
    scm = json.loads((ROOT / "rigs" / "drawbar_pull_scm.json").read_text())
    same = base | {"terrain": scm["terrain"] | {key: base["terrain"][key] for key in ("length", "width")}}
    own = copy.deepcopy(same)
    own["run"]["step"] = scm["run"]["step"]
    return base, [same, own]


def run(scenario, folder):
    """The summary of a run."""
    file = folder / "scenario.json"
    file.write_text(json.dumps(scenario), encoding="utf-8")
    subprocess.run([provenance.program(), "run", file, "--out", folder / "run", "--overwrite", "--no-plots"],
                   check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env={**os.environ, "FURROW_HOME": str(ROOT)})
    return json.loads((folder / "run" / "summary.json").read_text())


def costs(summary, end):
    """Terrain, all ranks, wall: seconds for a simulated one."""
    ranks = summary["ranks"]
    terrain = sum(rank["cpu_s"] for rank in ranks if rank["node"].startswith("terrain"))
    return [seconds / end for seconds in (terrain, sum(rank["cpu_s"] for rank in ranks), summary["wall_s"])]


def rows_of(rig, tire, number, folder):
    on_grains, on_soil = scenarios(rig, tire)
    end, summary = on_grains["run"]["end"], run(on_grains, folder)
    grains = costs(summary, end)
    for scenario in on_soil:
        soil = costs(run(scenario, folder), end)
        values = (grains[0], soil[0], grains[0] / soil[0], grains[1], soil[1], grains[1] / soil[1], grains[2], soil[2])
        line = {"rig": rig, "tire": tire, "round": number, "grains_step_s": on_grains["run"]["step"],
                "soil_step_s": scenario["run"]["step"],
                "grains": summary["grains"]}
        line |= dict(zip(COLUMNS[6:], (f"{value:.4g}" for value in values)))
        print(", ".join(f"{key} {value}" for key, value in line.items()), file=sys.stderr, flush=True)
        yield line


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rigs", nargs="+", choices=RIGS, default=list(RIGS))
    parser.add_argument("--tires", nargs="+", choices=TIRES, default=list(TIRES))
    parser.add_argument("--rounds", type=int, default=1)
    arguments = parser.parse_args()
    made = provenance.made_here()
    with tempfile.TemporaryDirectory() as folder:
        rows = [row for rig in arguments.rigs for tire in arguments.tires for number in range(1, arguments.rounds + 1)
                for row in rows_of(rig, tire, number, pathlib.Path(folder))]
    provenance.write_table(HERE / "soil_cost.csv", COLUMNS, rows, made)


if __name__ == "__main__":
    main()
