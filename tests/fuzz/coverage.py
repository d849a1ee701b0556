#!/usr/bin/python3
"""Lines of the reader files that the corpora of the fuzzing targets reach, as a table.

usage: coverage.py --out DIR [--build DIR] [--table FILE]

DIR is what run_targets.py filled. Every target reads its corpus once more, from a build of the preset fuzz; the table
says how many lines of each file are code, and how many of them were run by any target.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

from run_targets import ROOT, TARGETS, run_program

sys.path.insert(0, str(ROOT / "tests" / "studies"))
import provenance  # noqa: E402

READERS = """
nodes/checkpoint/checkpoint.cpp nodes/checkpoint/resume.cpp nodes/checkpoint/run_summary.cpp
nodes/checkpoint/segment.hpp nodes/launch/run_list.cpp nodes/output/table.cpp nodes/scenario/load_scenario.cpp
nodes/scenario/model_keys.cpp nodes/scenario/scenario_checks.cpp nodes/scenario/schema.cpp
nodes/scenario/soil_material.cpp nodes/study/study.cpp protocol/files/archive_file.cpp protocol/files/csv_file.cpp
protocol/files/data_files.cpp protocol/files/hdf5_reader.cpp protocol/files/json_reader.cpp
protocol/files/json_text.cpp protocol/files/printable.cpp protocol/files/text_file.cpp rigs/drawbar_spec.cpp
rigs/rigs.cpp terrain/dem/beds/bed_cache.cpp terrain/dem/beds/bed_csv.cpp 
terrain/dem/beds/bed_positions_h5.cpp terrain/dem/dem_spec.cpp terrain/dem/grain_solver_state.cpp
terrain/dem/solver_state_check.cpp terrain/liggghts/saved_grains.cpp terrain/rigid/roads/open_crg.cpp
terrain/rigid/roads/read_road.cpp terrain/soil/soil_estimate.cpp terrain/terrains.cpp tire/ancf/shell_spec.cpp
tire/handling/sweep_table.cpp tire/handling/tir_file.cpp tire/planar/planar_spec.cpp tire/pressure_schedule.cpp
tire/read_tire_file.cpp tire/ring/ring_spec.cpp tire/tire_file.cpp tire/tire_file_chrono.cpp tire/tire_file_reader.cpp
tire/tire_profile.cpp tire/tires.cpp vehicle/driver/read_driver.cpp vehicle/driver/read_points.cpp
vehicle/spec/driveline_rules.cpp vehicle/spec/read_vehicle.cpp vehicle/spec/spec_reader.cpp
vehicle/spec/spec_rules.cpp vehicle/spec/value_rules.cpp""".split()


def replay(target, options, folder):
    """The profile of a target that reads its corpus once."""
    corpus, profile = options.out / target / "corpus", folder / f"{target}.profraw"
    corpus.mkdir(parents=True, exist_ok=True)
    code = run_program([options.build / f"fuzz_{target}", "-runs=0", "-timeout=60", corpus], folder,
                       {"LLVM_PROFILE_FILE": str(profile)})
    if code != 0 or not profile.exists():
        sys.exit(f"coverage.py: fuzz_{target} ended with {code} on its corpus")
    return profile


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=lambda name: pathlib.Path(name).resolve(), required=True)
    parser.add_argument("--build", type=lambda name: pathlib.Path(name).resolve(), default=ROOT / "build-fuzz")
    parser.add_argument("--table", type=pathlib.Path, default=ROOT / "tests/fuzz/coverage.csv")
    options = parser.parse_args()
    if gone := [reader for reader in READERS if not (ROOT / reader).is_file()]:
        sys.exit(f"coverage.py: READERS names what does not exist: {', '.join(gone)}")
    targets = [target for target in TARGETS if (options.build / f"fuzz_{target}").exists()]
    if not targets:
        sys.exit(f"coverage.py: {options.build} holds no target, expected cmake --preset fuzz && ninja -C build-fuzz "
                 f"fuzz")
    with tempfile.TemporaryDirectory() as name:
        profiles = [str(replay(target, options, pathlib.Path(name))) for target in targets]
        merged = f"{name}/all.profdata"
        subprocess.run(["llvm-profdata", "merge", *profiles, "-o", merged], check=True)
        first, *others = (str(options.build / f"fuzz_{target}") for target in targets)
        shown = subprocess.run(["llvm-cov", "export", "-summary-only", f"-instr-profile={merged}", first,
                                *(word for program in others for word in ("-object", program)),
                                *(str(ROOT / reader) for reader in READERS)],
                               check=True, capture_output=True, text=True).stdout
    rows = [{"file": os.path.relpath(file["filename"], ROOT), "lines": lines["count"], "covered": lines["covered"],
             "percent": f"{lines['percent']:.0f}"} for file in json.loads(shown)["data"][0]["files"]
            for lines in [file["summary"]["lines"]]]
    made = provenance.made_here(first) | {"note": f"of the corpora of {', '.join(targets)}"}
    provenance.write_table(options.table, list(rows[0]), sorted(rows, key=lambda row: row["file"]), made)
    print(options.table.read_text(), end="")


if __name__ == "__main__":
    main()
