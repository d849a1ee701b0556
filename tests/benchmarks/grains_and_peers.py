#!/usr/bin/env python3
"""Times `furrow bench grains` beside LIGGGHTS and LAMMPS on one bed and the same cores, in turn.

usage: grains_and_peers.py BED.csv OUT.csv [--threads 2] [--steps 1000] [--rounds 3]

BED.csv: positions x_m,y_m,z_m of spheres of radius 6 mm that came to rest without cohesion; floor z = 0, walls y = 0
and 0.6 m, periodic along x over whole metres. Every engine first steps the bed with the law that is timed. LIGGGHTS and
LAMMPS are Debian's packages `liggghts` and `lammps`; MPI ranks are bound to the same cores that furrow's threads get.
Nothing else may run meanwhile. One row per engine and law: the median over rounds, its range, and the ratios.
"""
import argparse
import csv
import json
import math
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "studies"))
import provenance  # noqa: E402

RADIUS, DENSITY, STEP = 0.006, 2500.0, 4e-5  # m, kg/m³, s
WARM = 500  # steps before the clock starts

COMMON = """
processors {ranks} 1 1
atom_style {style}
atom_modify map array
boundary p f f
newton off
{ghosts}
units si
read_data {data}
neighbor 0.002 bin
neigh_modify delay 0
{law}
timestep {step}
fix gravity all gravity 9.81 vector 0 0 -1
{walls}
fix move all nve/sphere
compute touching all contact/atom
compute contacts all reduce sum c_touching
thermo_style custom step atoms ke c_contacts
thermo 1000000
thermo_modify lost error norm no
run {warm}
run {steps}
"""

# Hertz with the reference grains: E = 2.49e7 Pa, ν = 0.3, e = 0.2, μ = 0.9.
LIGGGHTS_LAW = """
fix m1 all property/global youngsModulus peratomtype 2.49e7
fix m2 all property/global poissonsRatio peratomtype 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.2
fix m4 all property/global coefficientFriction peratomtypepair 1 0.9
pair_style gran model hertz tangential {tangential}
pair_coeff * *
"""
LIGGGHTS_WALLS = """
fix floor all wall/gran model hertz tangential {tangential} primitive type 1 zplane 0.0
fix side1 all wall/gran model hertz tangential {tangential} primitive type 1 yplane 0.0
fix side2 all wall/gran model hertz tangential {tangential} primitive type 1 yplane 0.6
"""
# K_n = 4/3 E*, K_t = 8 G* of two such grains; the damping gives e ≈ 0.2 at the overlaps of the bed.
LAMMPS_HERTZ = "hertz/history 1.8242e7 2.2536e7 7.5e6 NULL 0.9 1"


def write_data(positions, file, lammps):
    length = math.ceil(max(p[0] for p in positions))
    with open(file, "w") as out:
        out.write(f"spheres\n\n{len(positions)} atoms\n1 atom types\n\n0 {length} xlo xhi\n0 0.6 ylo yhi\n")
        out.write("-0.001 1 zlo zhi\n\nAtoms\n\n")
        for n, (x, y, z) in enumerate(positions, 1):
            out.write(f"{n} 1 {2 * RADIUS} {DENSITY} {x:.10g} {y:.10g} {z:.10g}\n")


def run_peer(program, tangential, data, ranks, steps, folder):
    lammps = program == "lmp"
    text = COMMON.format(
        ranks=ranks, data=data, step=STEP, warm=WARM, steps=steps,
        style="sphere" if lammps else "granular",
        ghosts="comm_modify mode single vel yes" if lammps else "communicate single vel yes",
        law=f"pair_style gran/{LAMMPS_HERTZ}\npair_coeff * *" if lammps else LIGGGHTS_LAW.format(tangential=tangential),
        walls=(f"fix floor all wall/gran {LAMMPS_HERTZ} zplane 0.0 NULL\n"
               f"fix sides all wall/gran {LAMMPS_HERTZ} yplane 0.0 0.6" if lammps
               else LIGGGHTS_WALLS.format(tangential=tangential)))
    deck, log = folder / "deck.in", folder / "deck.log"
    deck.write_text(text)
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")
    subprocess.run(["mpirun", "--oversubscribe", "--bind-to", "core", "-np",
                    str(ranks), program, "-in", deck, "-log", log,
                    "-screen", "none"], check=True, env=environment, stdout=subprocess.DEVNULL)
    text = log.read_text()
    seconds, done, atoms = re.findall(r"Loop time of (\S+) on \d+ procs for (\d+) steps with (\d+) atoms", text)[-1]
    rebuilds = re.findall(r"Neighbor list builds = (\d+)", text)[-1]
    contacts = float(re.findall(r"^\s*\d+\s+\d+\s+\S+\s+(\S+)\s*$", text, re.M)[-1])
    return {"grains": int(atoms), "grain_steps_per_s": int(atoms) * int(done) / float(seconds),
            "coordination": contacts / int(atoms), "list_rebuilds": int(rebuilds)}


def run_furrow(law, cohesion, precision, bed, threads, steps, *more):
    command = [provenance.program(), "bench", "grains", "--bed", bed, "--law",
               law, "--cohesion", str(cohesion), "--precision",
               precision, "--threads", str(threads), "--steps", str(steps), "--warm", str(WARM), *more]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bed", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    with open(arguments.bed) as file:
        positions = [(float(r["x_m"]), float(r["y_m"]), float(r["z_m"])) for r in csv.DictReader(file)]
    results = {}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_data(positions, folder / "bed.data", False)
        n, steps = arguments.threads, arguments.steps
        hertz_tanh, mindlin = folder / "hertz_tanh.csv", folder / "mindlin.csv"
        run_furrow("hertz_tanh", 80e3, "mixed", arguments.bed, n, 1, "--settle", "0.3", "--save-bed", hertz_tanh)
        run_furrow("mindlin", 0.0, "mixed", arguments.bed, n, 1, "--settle", "0.3", "--save-bed", mindlin)
        cases = {
            "furrow hertz_tanh, cohesion 80 kPa": lambda: run_furrow("hertz_tanh", 80e3, "mixed", hertz_tanh, n, steps),
            "LIGGGHTS hertz/no_history": lambda: run_peer("liggghts", "no_history",
                                                          folder / "bed.data", n, steps, folder),
            "furrow mindlin": lambda: run_furrow("mindlin", 0.0, "mixed", mindlin, n, steps),
            "LAMMPS gran/hertz/history": lambda: run_peer("lmp", "", folder / "bed.data", n, steps, folder),
            "furrow mindlin, double precision": lambda: run_furrow("mindlin", 0.0, "double", mindlin, n, steps),
            "LIGGGHTS hertz/history": lambda: run_peer("liggghts", "history", folder / "bed.data", n, steps, folder),
        }
        for k in range(arguments.rounds):
            for case, run in cases.items():
                results.setdefault(case, []).append(run())
                print(f"round {k + 1}: {case}: {results[case][-1]['grain_steps_per_s']:.3g} grain-steps/s", flush=True)
    median = {case: statistics.median(r["grain_steps_per_s"] for r in runs) for case, runs in results.items()}
    with open(arguments.out, "w", newline="") as file:
        provenance.write_header(file, provenance.made_here())
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["engine", "threads", "grains", "steps", "rounds",
                      "grain_steps_per_s", "lowest", "highest", "coordination",
                      "list_rebuilds", "bytes_per_grain", "over_LIGGGHTS_no_history", "over_LAMMPS_history"])
        for case, runs in results.items():
            speeds, last = [r["grain_steps_per_s"] for r in runs], runs[-1]
            out.writerow([case, n, last["grains"], steps, len(runs)]
                         + [f"{v:.4g}" for v in (median[case], min(speeds), max(speeds))] +
                         [f"{last['coordination']:.3f}", f"{last['list_rebuilds']:.2f}",
                          f"{last['bytes_per_grain']:.0f}" if "bytes_per_grain" in last else "",
                          f"{median[case] / median['LIGGGHTS hertz/no_history']:.2f}",
                          f"{median[case] / median['LAMMPS gran/hertz/history']:.2f}"])
    print(arguments.out.read_text())


if __name__ == "__main__":
    main()
