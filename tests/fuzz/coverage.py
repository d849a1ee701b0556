#!/usr/bin/python3
"""Lines of the reader files that the corpora of the fuzzing targets reach, as a table.

usage: coverage.py --out DIR [--build DIR] [--table FILE]

DIR is what run_targets.py filled. Every target reads its corpus once more, from a build of the preset fuzz; the table
says how many lines of each file are code, and how many of them were run by any target. Files that no target has are
named beside it.
"""
import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from hours import provenance
from run_targets import ROOT, TARGETS, environment

READERS = """
nodes/scenario/load_scenario.cpp nodes/scenario/model_keys.cpp nodes/scenario/scenario_checks.cpp nodes/scenario/schema.cpp
nodes/scenario/soil_material.cpp nodes/study/study.cpp
protocol/files/archive_file.cpp protocol/files/csv_file.cpp protocol/files/data_files.cpp protocol/files/hdf5_reader.cpp protocol/files/json_reader.cpp
protocol/files/json_text.cpp protocol/files/printable.cpp protocol/files/text_file.cpp
rigs/drawbar_spec.cpp rigs/rigs.cpp
terrain/dem/beds/bed_cache.cpp terrain/dem/beds/bed_csv.cpp terrain/dem/beds/bed_positions_h5.cpp
terrain/dem/dem_spec.cpp terrain/dem/grain_solver_state.cpp terrain/dem/solver_state_check.cpp
terrain/rigid/roads/open_crg.cpp terrain/rigid/roads/read_road.cpp terrain/terrains.cpp
tire/ancf/shell_spec.cpp tire/handling/sweep_table.cpp tire/handling/tir_file.cpp tire/planar/planar_spec.cpp tire/pressure_schedule.cpp tire/read_tire_file.cpp
tire/ring/ring_spec.cpp
tire/tire_file.cpp tire/tire_file_chrono.cpp tire/tire_file_reader.cpp tire/tire_profile.cpp tire/tires.cpp
vehicle/driver/read_driver.cpp vehicle/driver/read_points.cpp vehicle/spec/driveline_rules.cpp
vehicle/spec/read_vehicle.cpp vehicle/spec/spec_reader.cpp vehicle/spec/spec_rules.cpp vehicle/spec/value_rules.cpp
""".split()


def replay(target, options, folder):
    profile = folder / f"{target}.profraw"
    corpus = options.out / target / "corpus"
    corpus.mkdir(parents=True, exist_ok=True)
    with subprocess.Popen([str(options.build / f"fuzz_{target}"), "-runs=0", "-timeout=60", str(corpus)],
                          cwd=folder, stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL,
                          env={**environment(folder), "LLVM_PROFILE_FILE": str(profile)}) as process:
        process.wait()
    shutil.rmtree(f"/dev/shm/furrow_fuzz_{process.pid}", ignore_errors=True)
    if process.returncode != 0 or not profile.exists():
        raise SystemExit(f"coverage.py: fuzz_{target} ended with {process.returncode} on its corpus")
    return profile


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build-fuzz")
    parser.add_argument("--table", type=pathlib.Path, default=ROOT / "tests/fuzz/coverage.csv")
    options = parser.parse_args()
    options.out, options.build = options.out.resolve(), options.build.resolve()
    if gone := [reader for reader in READERS if not (ROOT / reader).is_file()]:
        raise SystemExit(f"coverage.py: READERS names what does not exist: {', '.join(gone)}")
    targets = [target for target in TARGETS if (options.build / f"fuzz_{target}").exists()]
    if not targets:
        raise SystemExit(f"coverage.py: {options.build} holds no target, expected cmake --preset fuzz && ninja -C "
                         f"build-fuzz fuzz")
    if len(targets) < len(TARGETS):
        print(f"coverage.py: not built: {', '.join(sorted(set(TARGETS) - set(targets)))}", file=sys.stderr)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        profiles = [replay(target, options, folder) for target in targets]
        merged = folder / "all.profdata"
        subprocess.run(["llvm-profdata", "merge", *map(str, profiles), "-o", str(merged)], check=True)
        programs = [str(options.build / f"fuzz_{target}") for target in targets]
        objects = [argument for program in programs[1:] for argument in ("-object", program)]
        shown = subprocess.run(["llvm-cov", "export", "-summary-only",
                                f"-instr-profile={merged}", programs[0], *objects,
                                *(str(ROOT / reader) for reader in READERS)],
                               check=True, capture_output=True, text=True).stdout
    lines = []
    files = {os.path.relpath(file["filename"], ROOT): file["summary"]["lines"]
             for file in json.loads(shown)["data"][0]["files"]}
    for name, of in sorted(files.items()):
        lines.append(f"{name},{of['count']},{of['covered']},{of['percent']:.0f}")
    if absent := sorted(set(READERS) - set(files)):
        print(f"coverage.py: in no target: {', '.join(absent)}", file=sys.stderr)
    made = {"commit": provenance.commit(), "compiler": provenance.compiler_of(programs[0]),
            "processor": provenance.processor(),
            "command": provenance.command(), "note": f"of the corpora of {', '.join(targets)}"}
    with open(options.table, "w", newline="", encoding="utf-8") as table:
        provenance.write_header(table, made)
        table.write("\n".join(["file,lines,covered,percent", *lines]) + "\n")
    print(options.table.read_text(), end="")


if __name__ == "__main__":
    sys.exit(main())
