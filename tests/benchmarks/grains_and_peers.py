#!/usr/bin/env python3
"""Times `furrow bench grains` beside LIGGGHTS and LAMMPS on one bed and the same cores, in turn.

usage: grains_and_peers.py BED.csv OUT.csv [--threads 2] [--steps 1000] [--rounds 3]

BED.csv: positions x_m,y_m,z_m of spheres of radius 6 mm that came to rest without cohesion; floor z = 0, walls y = 0
and 0.6 m, periodic along x over whole metres. Every engine first steps the bed with the law that is timed. LIGGGHTS and
LAMMPS are Debian's packages `liggghts` and `lammps`; MPI ranks are bound to the same cores that furrow's threads get.
Nothing else may run meanwhile. One row per engine and law: the median over rounds, its range, and the ratios.
"""
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

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "studies"))
import driver  # noqa: E402

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
{cohesion}
pair_style gran model hertz tangential {tangential}
pair_coeff * *
"""
# F = k A with A = 4π δ R*, LIGGGHTS' nearest to a constant force.
LIGGGHTS_COHESION = "fix m5 all property/global cohesionEnergyDensity peratomtypepair 1 {density}"
LIGGGHTS_WALLS = """
fix floor all wall/gran model hertz tangential {tangential} primitive type 1 zplane 0.0
fix side1 all wall/gran model hertz tangential {tangential} primitive type 1 yplane 0.0
fix side2 all wall/gran model hertz tangential {tangential} primitive type 1 yplane 0.6
"""
# K_n = 4/3 E*, K_t = 8 G* of two such grains; the damping gives e ≈ 0.2 at the overlaps of the bed.
LAMMPS_HERTZ = "hertz/history 1.8242e7 2.2536e7 7.5e6 NULL 0.9 1"


# furrow's law, cohesion in Pa and precision
FURROW = {"furrow hertz_tanh, cohesion 80 kPa": ("hertz_tanh", 80e3, "mixed"),
          "furrow hertz_tanh": ("hertz_tanh", 0.0, "mixed"),
          "furrow mindlin": ("mindlin", 0.0, "mixed"), "furrow mindlin, double precision": ("mindlin", 0.0, "double")}
# program, tangential model and cohesion energy density in J/m³
PEERS = {"LIGGGHTS hertz/no_history, sjkr2": ("liggghts", "no_history", 4e5),
         "LIGGGHTS hertz/no_history": ("liggghts", "no_history"), "LAMMPS gran/hertz/history": ("lmp", ""),
         "LIGGGHTS hertz/history": ("liggghts", "history")}
CASES = [case for pair in zip(FURROW, PEERS) for case in pair]  # in turn


def write_data(positions, file):
    length = math.ceil(max(p[0] for p in positions))
    with open(file, "w") as out:
        out.write(f"spheres\n\n{len(positions)} atoms\n1 atom types\n\n0 {length} xlo xhi\n0 0.6 ylo yhi\n")
        out.write("-0.001 1 zlo zhi\n\nAtoms\n\n")
        for n, (x, y, z) in enumerate(positions, 1):
            out.write(f"{n} 1 {2 * RADIUS} {DENSITY} {x:.10g} {y:.10g} {z:.10g}\n")


def run_deck(program, text, ranks, folder, *options):
    """The log of LIGGGHTS or LAMMPS: what it says of the last `run`."""
    deck, log = folder / "deck.in", folder / "deck.log"
    deck.write_text(text)
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")
    subprocess.run(["mpirun", "--oversubscribe", *options, "-np", str(ranks), program, "-in", deck, "-log", log,
                    "-screen", "none"], check=True, env=environment, stdout=subprocess.DEVNULL)
    text = log.read_text()
    seconds, done, atoms = re.findall(r"Loop time of (\S+) on \d+ procs for (\d+) steps with (\d+) atoms", text)[-1]
    return text, float(seconds), int(done), int(atoms), re.findall(r"Neighbor list builds = (\d+)", text)[-1]


def run_peer(program, tangential, ranks, steps, folder, cohesion=0.0):
    lammps = program == "lmp"
    sticky = {"tangential": tangential + (" cohesion sjkr2" if cohesion else ""),
              "cohesion": LIGGGHTS_COHESION.format(density=cohesion) if cohesion else ""}
    deck = COMMON.format(
        ranks=ranks, data=folder / "bed.data", step=STEP, warm=WARM, steps=steps,
        style="sphere" if lammps else "granular",
        ghosts="comm_modify mode single vel yes" if lammps else "communicate single vel yes",
        law=f"pair_style gran/{LAMMPS_HERTZ}\npair_coeff * *" if lammps else LIGGGHTS_LAW.format(**sticky),
        walls=(f"fix floor all wall/gran {LAMMPS_HERTZ} zplane 0.0 NULL\n"
               f"fix sides all wall/gran {LAMMPS_HERTZ} yplane 0.0 0.6" if lammps
               else LIGGGHTS_WALLS.format(**sticky)))
    text, seconds, done, atoms, rebuilds = run_deck(program, deck, ranks, folder, "--bind-to", "core")
    contacts = float(re.findall(r"^\s*\d+\s+\d+\s+\S+\s+(\S+)\s*$", text, re.M)[-1])
    return {"grains": atoms, "grain_steps_per_s": atoms * done / seconds, "coordination": contacts / atoms,
            "list_rebuilds": int(rebuilds)}


def bench_grains(bed, law, threads, steps, warm=WARM, *more):
    return json.loads(driver.furrow("bench", "grains", "--bed", bed, "--law", law, "--threads", threads, "--steps",
                                    steps, "--warm", warm, *more))


def run_furrow(law, cohesion, precision, bed, threads, steps, *more):
    return bench_grains(bed, law, threads, steps, WARM, "--cohesion", cohesion, "--precision", precision, *more)


def settle(bed, threads, folder):
    """Leaves in `folder` what measure() needs: the positions of a bed for the peers, and settled by furrow's laws."""
    with open(bed) as file:
        write_data([tuple(float(row[f"{axis}_m"]) for axis in "xyz") for row in csv.DictReader(file)],
                   folder / "bed.data")
    for law, cohesion, precision in list(FURROW.values())[:3]:
        run_furrow(law, cohesion, precision, bed, threads, 1, "--settle", "0.3", "--save-bed",
                   folder / f"{law}_{cohesion}.csv")


def measure(case, threads, steps, folder):
    if case in PEERS:
        program, tangential, *cohesion = PEERS[case]
        return run_peer(program, tangential, threads, steps, folder, *cohesion)
    law, cohesion, precision = FURROW[case]
    return run_furrow(law, cohesion, precision, folder / f"{law}_{cohesion}.csv", threads, steps)


def options(doc, **more):
    """The beds and tables of this script and of grains_scaling.py."""
    parser = driver.options(doc, **more)
    parser.add_argument("bed", type=lambda name: pathlib.Path(name).resolve())
    parser.add_argument("out", type=lambda name: pathlib.Path(name).resolve())
    return parser.parse_args()


def main():
    arguments = options(__doc__, threads={"type": int, "default": 2}, steps={"type": int, "default": 1000},
                        rounds={"type": int, "default": 3})
    n, steps, results = arguments.threads, arguments.steps, {case: [] for case in CASES}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        settle(arguments.bed, n, folder)
        for k in range(arguments.rounds):
            for case in CASES:
                results[case].append(measure(case, n, steps, folder))
                print(f"round {k + 1}: {case}: {results[case][-1]['grain_steps_per_s']:.3g} grain-steps/s", flush=True)
    median = {case: statistics.median(r["grain_steps_per_s"] for r in runs) for case, runs in results.items()}
    rows = []
    for case, runs in results.items():
        speeds, last = [r["grain_steps_per_s"] for r in runs], runs[-1]
        rows.append({
            "engine": case, "threads": n, "grains": last["grains"], "steps": steps, "rounds": len(runs),
            "grain_steps_per_s": median[case], "lowest": min(speeds), "highest": max(speeds),
            "coordination": f"{last['coordination']:.3f}", "list_rebuilds": f"{last['list_rebuilds']:.2f}",
            "bytes_per_grain": f"{last['bytes_per_grain']:.0f}" if "bytes_per_grain" in last else "",
            "over_LIGGGHTS_sjkr2": f"{median[case] / median['LIGGGHTS hertz/no_history, sjkr2']:.2f}",
            "over_LIGGGHTS_no_history": f"{median[case] / median['LIGGGHTS hertz/no_history']:.2f}",
            "over_LAMMPS_history": f"{median[case] / median['LAMMPS gran/hertz/history']:.2f}"})
    driver.write(arguments.out, rows, told=True)


if __name__ == "__main__":
    main()
