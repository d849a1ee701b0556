#!/usr/bin/python3
"""Runs the reference cases with SOURCE_DIR/build/furrow and leaves all they write in OUT_DIR.

run_cases.py SOURCE_DIR OUT_DIR [--cases a,b] [--program FILE] [--scenarios DIR]

compare_cases.py compares two such folders, of two commits, to the bit. About 20 minutes on two cores.
"""
import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import provenance  # noqa: E402

MARK = "times.json"


def sets(**values):
    return [word for key, value in values.items() for word in ("--set", f"{key.replace('__', '.')}={value}")]


SHORT = sets(run__end=0.2, run__average_from=0.1, run__step="5e-5")
RUNS = {  # case: (scenario, more arguments)
    "first_look": ("first_look.json", []),
    "drawbar_pull_small": ("drawbar_pull_small_report_soil.json", sets(run__end=0.5, run__average_from=0.2)),
    "rigid_ground": ("rigid_ground.json", sets(run__end=0.25, run__average_from=0.1)),
    "four_wheels": ("four_wheels.json", sets(run__end=0.6, run__average_from=0.3)),
    "extra_hertz_tanh": ("first_look.json", SHORT + sets(terrain__law="hertz_tanh")),
    "extra_options": ("first_look.json", SHORT + sets(
        terrain__precision="double", terrain__rolling_friction=0.1, terrain__size_spread=0.2,
        terrain__sides="periodic", terrain__compaction_pressure="20e3", terrain__settling_friction=0.3,
        rig__toe_angle=0.1, rig__toe_time=0.1, rig__travel_sign=-1, rig__start=1.5)),
    "extra_tangent": ("drawbar_pull_tr.json", sets(
        run__end=0.1, run__average_from=0.05, terrain__radius=0.02, terrain__layers=5, terrain__substeps=2,
        tire__elements_circumference=40, tire__elements_width=8, tire__pressure="[[0,200e3],[0.1,150e3]]",
        tire__contact_tangent="true")),
}
COARSE = sets(tire__elements_circumference=40, tire__elements_width=8)
BENCHES = {
    "bench_grains_mindlin": ["grains", "--bed", "default", "--law", "mindlin", "--steps", "100", "--warm", "20"],
    "bench_grains_hertz_tanh": ["grains", "--bed", "default", "--law", "hertz_tanh", "--cohesion", "80e3",
                             "--steps", "100", "--warm", "20"],
    "bench_tire": ["tire", "--steps", "200", "--warm", "0.1"],
}
PASSES = {
    "format_version": 1, "description": "Two passes of a short first look.",
    "set": {"run.end": 0.5, "run.average_from": 0.3}, "passes": 2, "rest": 0.1,
}


class Failed(Exception):
    pass


class Maker:
    """Makes the cases: a method each, which takes the case's name."""

    def __init__(self, arguments):
        self.source, self.out = arguments.source.resolve(), arguments.out.resolve()
        self.program = (arguments.program or self.source / "build" / "furrow").resolve()
        self.rigs = (arguments.scenarios or self.source / "rigs").resolve()
        self.environment = dict(os.environ, FURROW_HOME=str(self.source), XDG_CACHE_HOME=str(self.out / "cache"),
                                OMP_NUM_THREADS="1", PYTHONDONTWRITEBYTECODE="1")
        self.log = None
        self.cases = {**dict.fromkeys(RUNS, self.run), "resumed": self.resumed, "passes": self.passes,
                      "extra_press": self.press, "extra_soil": self.soil, **dict.fromkeys(BENCHES, self.bench)}

    def start(self, *words, stdout=None):
        return subprocess.Popen([self.program, *map(str, words)], cwd=self.out, env=self.environment,
                                stdin=subprocess.DEVNULL, stdout=stdout or self.log, stderr=self.log)

    def furrow(self, *words, stdout=None):
        if code := self.start(*words, stdout=stdout).wait():
            raise Failed(f"exit code {code}, expected 0: furrow {' '.join(map(str, words))}")

    def run(self, name):
        scenario, more = RUNS[name]
        self.furrow("run", self.rigs / scenario, "--no-plots", "--out", self.out / name, *more)

    def resumed(self, name):
        folder = self.out / name
        process = self.start("run", self.rigs / "first_look.json", "--no-plots", "--out", folder)
        deadline = time.time() + 120
        while process.poll() is None and time.time() < deadline and len(list(folder.glob("frames*/*"))) < 20:
            time.sleep(0.005)
        if process.poll() is not None:
            raise Failed(f"the run ended with {process.returncode} before it could be interrupted")
        process.send_signal(signal.SIGTERM)
        if process.wait() != 75:
            raise Failed(f"the interrupted run ended with {process.returncode}, expected 75")
        if list(folder.glob("summary*.json")):
            raise Failed("the interrupted run left a summary: it had ended already")
        self.furrow("resume", folder, "--no-plots")

    def passes(self, name):
        study = self.out / "study_passes.json"
        study.write_text(json.dumps(dict(PASSES, scenario=str(self.rigs / "first_look.json")), indent=2) + "\n")
        self.furrow("sweep", study, "--out", self.out / name)

    def bench(self, name):
        (self.out / name).mkdir()
        with open(self.out / name / "bench.json", "w") as out:
            self.furrow("bench", *BENCHES[name], stdout=out)

    def press(self, name):
        self.furrow("press", self.rigs / "drawbar_pull_small_report_soil.json", "--out", self.out / name, "--on",
                    "cleat", "--points", "3", *COARSE)

    def soil(self, name):
        self.furrow("soil", self.rigs / "drawbar_pull_small_report_soil.json", "--out", self.out / name, "--quick",
                    "--only", "shear")

    def make(self, name):
        """The entry of times.json of a case, whose old output is replaced."""
        shutil.rmtree(self.out / name, ignore_errors=True)
        begin, entry = time.time(), {}
        with open(self.out / f"{name}.log", "w") as self.log:
            try:
                self.cases[name](name)
            except Failed as error:
                entry["problem"] = str(error)
        outcome = f"FAILED: {entry['problem']}" if entry else "ok"
        print(f"{name:24s} {time.time() - begin:7.1f} s  {outcome}", flush=True)
        return {"wall_s": round(time.time() - begin, 2), **entry}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--cases", help="these only, with commas between; their old output is replaced")
    parser.add_argument("--program", type=Path, help="default: SOURCE_DIR/build/furrow")
    parser.add_argument("--scenarios", type=Path, help="folder of the scenarios; default: SOURCE_DIR/rigs")
    arguments = parser.parse_args()
    maker = Maker(arguments)
    out, chosen = maker.out, arguments.cases.split(",") if arguments.cases else list(maker.cases)
    if unknown := [name for name in chosen if name not in maker.cases]:
        parser.error(f"unknown cases {unknown}, expected some of {', '.join(maker.cases)}")
    if not os.access(maker.program, os.X_OK):
        parser.error(f"{maker.program} is no program")
    if out.exists() and any(out.iterdir()):
        if not (out / MARK).exists():
            parser.error(f"{out} is not empty and no output of run_cases.py")
        if not arguments.cases:
            shutil.rmtree(out)
    out.mkdir(parents=True, exist_ok=True)
    times = {"cases": {}, **provenance.read_json(out / MARK), "program": str(maker.program), "made": {
        "commit": provenance.commit(maker.source), "compiler": provenance.compiler_of(maker.program),
        "processor": provenance.processor()}}
    for name in chosen:
        times["cases"][name] = maker.make(name)
        times["total_s"] = round(sum(entry["wall_s"] for entry in times["cases"].values()), 1)
        (out / MARK).write_text(json.dumps(times, indent=2) + "\n")
    if failed := [name for name in chosen if "problem" in times["cases"][name]]:
        sys.exit(f"FAILED: {', '.join(failed)}; see {out}/<case>.log")


if __name__ == "__main__":
    main()
