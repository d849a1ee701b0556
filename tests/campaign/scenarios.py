"""What the campaign runs: scenarios and studies of about a second, on beds that are settled once."""
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "system"))
from program import changed  # noqa: E402

# Frames and checkpoints fall on the same steps: what either leaves out of the state shows.
OFTEN = {"output": {"series_interval": 1e-3, "frame_interval": 0.01}, "checkpoint": {"interval": 0.01, "keep": 3}}
SHELL = {"file": "hmmwv_layered.json", "rigid": False, "elements_circumference": 30, "elements_width": 12}
SMALL_BED = {"layers": 3, "length": 1.2}


def run_of(end, **sections):
    """Keys that are None belong to another engine."""
    scenario = changed(**{**OFTEN, "run": {"step": 2e-4, "end": end, "average_from": 0.02, "peer_timeout": 20},
                          **sections})
    return {name: {k: v for k, v in part.items() if v is not None} if isinstance(part, dict) else part
            for name, part in scenario.items()}


SINGLE = {
    "rigid": run_of(0.1, rig={"touchdown_damping": 0}),
    "shell": run_of(0.06, tire={**SHELL, "pressure": [[0, 200e3], [0.05, 120e3]]},
                    terrain={"engine": "rigid", "radius": None, "cohesion": None,
                             "layers": None, "length": None, "width": None}),
    "tangents": run_of(0.08, rig={"touchdown_damping": 0, "carrier_mass": 100}, tire={**SHELL, "contact_tangent": True},
                       terrain=SMALL_BED),
    "wheels": run_of(0.08, rig={"touchdown_damping": 0,
                                "wheels": [{"lateral": -0.23, "carrier_mass": 300}, {"lateral": 0.23}]},
                     terrain={**SMALL_BED, "width": 0.95}),
}
SHORT = {"run.end": 0.06}
STUDIES = {
    "passes": ({"passes": 2, "rest": 0.01, "set": SHORT}, []),
    "sweep": ({"grid": {"rig.slip": [0.1, 0.4]}, "set": SHORT}, []),
    "jobs": ({"grid": {"rig.slip": [0.1, 0.2, 0.4]}, "set": SHORT}, ["--jobs", "2"]),
}
NAMES = [*SINGLE, *STUDIES]


def commands(name, inputs, out):
    """(first command, command to continue, command to start again) without the program's name. Writes their files."""
    inputs.mkdir(parents=True, exist_ok=True)
    for scenario, contents in SINGLE.items():
        (inputs / f"{scenario}.json").write_text(json.dumps(contents))
    if name in SINGLE:
        run = ["run", str(inputs / f"{name}.json"), "--out", str(out), "--no-plots"]
        return run, ["resume", str(out), "--no-plots"], [*run, "--overwrite"]
    study, flags = STUDIES[name]
    path = inputs / f"{name}_study.json"
    path.write_text(json.dumps({"scenario": "rigid.json", **study}))
    sweep = ["sweep", str(path), "--out", str(out), *flags]
    return sweep, sweep, sweep
