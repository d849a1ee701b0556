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
    "drawbar_pull_small": ("drawbar_pull_small.json", sets(run__end=0.5, run__average_from=0.2)),
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
    def __init__(self, arguments):
        self.source = Path(arguments.source).resolve()
        self.out = Path(arguments.out).resolve()
        self.program = Path(arguments.program).resolve() if arguments.program else self.source / "build" / "furrow"
        self.rigs = Path(arguments.scenarios).resolve() if arguments.scenarios else self.source / "rigs"
        self.environment = dict(os.environ, FURROW_HOME=str(self.source), XDG_CACHE_HOME=str(self.out / "cache"),
                                OMP_NUM_THREADS="1", PYTHONDONTWRITEBYTECODE="1")
        self.log = None

    def start(self, words, stdout):
        return subprocess.Popen([str(self.program), *map(str, words)], cwd=self.out, env=self.environment,
                                stdin=subprocess.DEVNULL, stdout=stdout, stderr=self.log)

    def furrow(self, *words, stdout=None, expected=0):
        rc = self.start(words, stdout or self.log).wait()
        if rc != expected:
            raise Failed(f"exit code {rc}, expected {expected}: furrow {' '.join(map(str, words))}")

    def run(self, name):
        scenario, more = RUNS[name]
        self.furrow("run", self.rigs / scenario, "--no-plots", "--out", self.out / name, *more)

    def resumed(self, name):
        folder = self.out / name
        process = self.start(["run", self.rigs / "first_look.json", "--no-plots", "--out", folder], self.log)
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
        folder = self.out / name
        folder.mkdir()
        with open(folder / "bench.json", "w") as out:
            self.furrow("bench", *BENCHES[name], stdout=out)

    def press(self, name):
        self.furrow("press", self.rigs / "drawbar_pull_small.json", "--out", self.out / name, "--on", "cleat",
                    "--points", "3", *COARSE)

    def soil(self, name):
        self.furrow("soil", self.rigs / "drawbar_pull_small.json", "--out", self.out / name, "--quick",
                    "--only", "shear")


def cases(maker):
    table = {name: maker.run for name in RUNS}
    table["resumed"] = maker.resumed
    table["passes"] = maker.passes
    table["extra_press"] = maker.press
    table["extra_soil"] = maker.soil
    table.update({name: maker.bench for name in BENCHES})
    return table


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source")
    parser.add_argument("out")
    parser.add_argument("--cases", help="these only, with commas between; their old output is replaced")
    parser.add_argument("--program", help="default: SOURCE_DIR/build/furrow")
    parser.add_argument("--scenarios", help="folder of the scenarios; default: SOURCE_DIR/rigs")
    arguments = parser.parse_args()
    maker = Maker(arguments)
    table = cases(maker)
    chosen = arguments.cases.split(",") if arguments.cases else list(table)
    if unknown := [name for name in chosen if name not in table]:
        parser.error(f"unknown cases {unknown}, expected some of {', '.join(table)}")
    if not os.access(maker.program, os.X_OK):
        parser.error(f"{maker.program} is no program")
    out = maker.out
    if out.exists() and any(out.iterdir()):
        if not (out / MARK).exists():
            parser.error(f"{out} is not empty and no output of run_cases.py")
        if not arguments.cases:
            shutil.rmtree(out)
    out.mkdir(parents=True, exist_ok=True)
    times = json.loads((out / MARK).read_text()) if (out / MARK).exists() else {"cases": {}}
    times["program"] = str(maker.program)
    times["made"] = {"commit": provenance.commit(maker.source), "compiler": provenance.compiler_of(maker.program),
                     "processor": provenance.processor()}
    (out / MARK).write_text(json.dumps(times, indent=2) + "\n")

    failed = []
    begin_all = time.time()
    for name in chosen:
        shutil.rmtree(out / name, ignore_errors=True)
        with open(out / f"{name}.log", "w") as maker.log:
            begin, problem = time.time(), ""
            try:
                table[name](name)
            except Failed as error:
                problem = str(error)
            wall = time.time() - begin
        entry = {"wall_s": round(wall, 2)}
        if problem:
            entry["problem"] = problem
            failed.append(name)
        times["cases"][name] = entry
        (out / MARK).write_text(json.dumps(times, indent=2) + "\n")
        print(f"{name:24s} {wall:7.1f} s  {problem and 'FAILED: ' + problem or 'ok'}", flush=True)
    times["total_s"] = round(sum(entry["wall_s"] for entry in times["cases"].values()), 1)
    (out / MARK).write_text(json.dumps(times, indent=2) + "\n")
    print(f"{'total':24s} {time.time() - begin_all:7.1f} s")
    if failed:
        print(f"FAILED: {', '.join(failed)}; see {out}/<case>.log", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
