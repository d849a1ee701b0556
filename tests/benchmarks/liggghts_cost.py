#!/usr/bin/python3
"""What a step of the engine liggghts costs on the bed of the small rig, part by part, and on several ranks.

usage: liggghts_cost.py     takes about ten minutes, prints a table and writes liggghts_cost.csv beside this script

Nothing else may run meanwhile. For each number of ranks, in turn: stock LIGGGHTS (hertz, tangential history, walls),
our pair style with motion and lists alone in one `run N`, the same with walls and accounts, the same with a `run 1` and
the sums of a step for each step (tests/benchmarks/liggghts.cpp), and a whole run of Furrow with tire, protocol and
accounts: with the tire of the rig, and with a rigid one, which leaves the cores to the terrain. Rows have the median
over rounds and the range; `over_pairs` is the ratio to the pair style alone: of wall times, and for rows of processor
time of processor times. On a machine that does other work too, only processor times mean something, and of several
ranks not even those: they poll for each other. Of a whole run the rows are, each of the rank that has most of it:

    whole_run          wall time of computing and communicating over the steps, as the table of the nodes has it
    whole_run_cpu      processor time; what a rank spends in polling for others is part of it
    whole_run_waiting  wall time of waiting for tire, rig and, outside of LIGGGHTS, other ranks of the terrain
    whole_run: PART    processor time by part, from runs of their own under `perf record`, by the functions of PARTS

rigid_tire, rigid_tire: PART and so on are those of the run with the rigid tire. Of the parts, `over_pairs` is the ratio
to pairs, lists, motion and border grains of the same run together, that is to what `one run N` does, in the very steps
of that run; a bed at rest has fewer contacts and lists than one on which a wheel rolls, and the speed of a shared
machine drifts from run to run.

Ranks that are not --timed share cores: of these only the counts mean anything, and no time is given. ghosts and bytes
are of the rank that has most: position, velocity and spin of each ghost cross in every step.
"""
import csv
import io
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

import h5py

from grains_and_peers import driver, run_deck

HERE = pathlib.Path(__file__).resolve().parent
RIG = str(driver.ROOT / "rigs" / "drawbar_pull_small_report_soil.json")
STEP, RUN = 6e-5, 0.3  # s: of the rig; of the whole run, in which the wheel comes down and rolls
GHOST_BYTES = 9 * 8
ONE_THREAD = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1"}
ENVIRONMENT = {**os.environ, "FURROW_HOME": str(driver.ROOT), **ONE_THREAD}
STOCK = """
processors {ranks} 1 1
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
units si
read_data {data}
neighbor 0.002 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 2.49e7
fix m2 all property/global poissonsRatio peratomtype 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.2
fix m4 all property/global coefficientFriction peratomtypepair 1 0.9
pair_style gran model hertz tangential history
pair_coeff * *
timestep {step}
fix gravity all gravity 9.81 vector 0 0 -1
fix floor all wall/gran model hertz tangential history primitive type 1 zplane 0.0
fix side1 all wall/gran model hertz tangential history primitive type 1 yplane -0.3
fix side2 all wall/gran model hertz tangential history primitive type 1 yplane 0.3
fix end1 all wall/gran model hertz tangential history primitive type 1 xplane 0.0
fix end2 all wall/gran model hertz tangential history primitive type 1 xplane 3.0
fix move all nve/sphere
run 20
run {steps}
"""
# The first pattern that a function (or else its library) matches says to which part it belongs.
PARTS = [("pairs", r"PairFurrow::evaluate"),
         ("lists", r"PairLists::|FixFurrow::(make_lists|lists_due|strayed|pre_exchange|pre_neighbor|note_exchange|copy|"
                   r"pack_e|unpack_e)|Neighbor::|Comm::(exchange|borders)|AtomVec.*(exchange|border|copy)|Atom::|"
                   r"RankContacts::lists_made"),
         ("motion", r"FixFurrow::(move|final_integrate)|GrainMotion|force_clear|memset|Verlet::"),
         ("walls", r"WallContacts|RankContacts::add_forces|Carried"),
         ("tire_contact", r"SurfaceCollider|SurfaceGrid|touch_tire|closest_point|Facets::|push_out|ActiveWalls|"
                          r"angle_of|pseudo_inverse|share_depth|NodalForceSum|SurfaceTopology|on_edge|spin_about|"
                          r"RankContacts::(begin_|look|any_near)"),
         ("accounts", r"sample_of|SampleLanes|LiggghtsTerrain::state|state_report|terrain_state|EnergyAccounts|"
                      r"RankContacts::end_step|held"),
         ("border_grains", r"Comm::forward_comm|pack_comm|unpack_comm"),
         ("frames_and_files", r"Row\b|hdf5|H5|archive|checkpoint|add_file|state_hash"),
         ("messages_and_polling",
          r"mca_|libmpi|open-pal|open-rte|libevent|MpiWire|Transport|ByteWriter|ByteReader|PMPI|opal_|ompi_|MPI_|"
          r"share_reports|kernel|vdso|pthread_mutex")]
ENGINE = ("pairs", "lists", "motion", "border_grains")  # what `one run N` does
COLUMNS = ["part", "ranks", "grains", "steps", "rounds", "us_per_step", "lowest", "highest", "cpu_us_per_step",
           "ns_per_grain_step", "over_pairs", "grains_least", "grains_most", "ghosts_most", "bytes_per_step",
           "list_builds", "contacts"]
WHOLE = {"whole_run": False, "rigid_tire": True}  # whether the tire is rigid


def binding(ranks):
    """One rank per core; more ranks than cores share them politely."""
    alone = ranks <= (os.cpu_count() or 1)
    return ["--bind-to", "core"] if alone else ["--bind-to", "none", "--mca", "mpi_yield_when_idle", "1"]


def bench_command(ranks, start, steps, rounds):
    """bench_liggghts from a scenario or a run."""
    program = pathlib.Path(driver.provenance.program()).parent / "bench_liggghts"
    return ["mpirun", "--oversubscribe", *binding(ranks), "-np", str(ranks), str(program), str(start), str(steps),
            str(rounds)]


def bench_rows(ranks, steps):
    done = subprocess.run(bench_command(ranks, RIG, steps, 1), env=ENVIRONMENT, capture_output=True, text=True)
    # Open MPI 4.1's mpirun at times dies of a signal on its way out: what was printed counts.
    if done.returncode not in (0, 134):
        sys.exit(f"bench_liggghts on {ranks} ranks ended with {done.returncode}: {done.stderr[-500:]}")
    return csv.DictReader(io.StringIO(done.stdout))


def whole_run(ranks, out, rigid=False, before=()):
    """Of the ranks of the terrain, those that have most: µs a step by the name of the row."""
    keys = {"terrain.engine": "liggghts", "terrain.ranks": ranks, "run.end": RUN, "run.average_from": RUN - 0.05,
            **({"tire.rigid": True} if rigid else {})}
    driver.furrow("run", RIG, *driver.settings(keys), "--out", out, "--overwrite", "--no-plots", before=before,
                  **ONE_THREAD)
    rows = [row for row in driver.summary(out)["ranks"] if row["node"].startswith("terrain")]
    each = 1e6 / (RUN / STEP)
    return {"": each * max(row["compute_s"] + row["communicate_s"] for row in rows),
            "_cpu": each * max(row["cpu_s"] for row in rows), "_waiting": each * max(row["wait_s"] for row in rows)}


def profile(ranks, folder, rigid):
    """The processor time of the busiest rank of a whole run, by part."""
    data = str(folder / "perf.data")
    most = whole_run(ranks, folder / "run", rigid, before=("perf", "record", "-q", "-F", "499", "-o", data))["_cpu"]
    text = subprocess.run(["perf", "report", "-i", data, "--stdio", "-g", "none", "--sort", "pid,dso,sym",
                           "-F", "sample,pid,dso,sym", "-t", "|"], capture_output=True, text=True, check=True).stdout
    found = {}
    for line in text.splitlines():
        words = line.split("|")
        if line.startswith("#") or len(words) < 4:
            continue
        where = f"{words[2]} {'|'.join(words[3:])}"
        part = next((name for name, pattern in PARTS if re.search(pattern, where)), "other")
        rank = found.setdefault(words[1].strip(), {})
        rank[part] = rank.get(part, 0) + int(words[0])
    busiest = max((rank for rank in found.values() if rank.get("pairs")), key=lambda rank: sum(rank.values()))
    return {part: most * samples / sum(busiest.values()) for part, samples in busiest.items()}


def write_data(frame, file):
    with h5py.File(frame) as bed, open(file, "w", encoding="utf-8") as out:
        grains = list(zip(bed["position"][()], bed["radius"][()]))
        out.write(f"bed\n\n{len(grains)} atoms\n1 atom types\n\n-0.1 3.1 xlo xhi\n-0.4 0.4 ylo yhi\n-0.1 1 zlo "
                  f"zhi\n\nAtoms\n\n")
        for n, ((x, y, z), radius) in enumerate(grains, 1):
            out.write(f"{n} 1 {2 * radius:.9g} 2500 {x:.9g} {y:.9g} {z:.9g}\n")


def stock(ranks, steps, folder):
    deck = STOCK.format(ranks=ranks, data=folder / "bed.data", step=STEP, steps=steps)
    _, seconds, done, _, builds = run_deck("liggghts", deck, ranks, folder, *binding(ranks))
    return {"us_per_step": 1e6 * seconds / done, "list_builds": builds}


def measured(ranks, timed, rounds, steps, folder):
    """({part: its rows, one a round}, {run: µs a step of its parts that are ENGINE})"""
    found, engines = {}, {}
    for _ in range(rounds if timed else 1):
        for row in bench_rows(ranks, steps):
            found.setdefault(row["part"], []).append(row)
        if timed:
            for name, rigid in WHOLE.items():
                for kind, time in whole_run(ranks, folder / "run", rigid).items():
                    found.setdefault(name + kind, []).append({"us_per_step": time})
            found.setdefault("stock_liggghts", []).append(stock(ranks, steps, folder))
    for name, rigid in WHOLE.items() if timed else ():
        runs = [profile(ranks, folder, rigid) for _ in range(rounds)]
        engines[name] = statistics.median(sum(run.get(part, 0) for part in ENGINE) for run in runs)
        for part in sorted(set().union(*runs), key=lambda part: -runs[0].get(part, 0)):
            found[f"{name}: {part}"] = [{"us_per_step": run.get(part, 0)} for run in runs]
        found[f"{name}: all"] = [{"us_per_step": sum(run.values())} for run in runs]
    return found, engines


def rows_of(ranks, timed, steps, found, engines):
    def median(part, column):
        return statistics.median(float(row[column]) for row in found[part])
    grains = int(found["pairs"][0]["grains"])
    for part, rounds in found.items():
        whole = part.startswith(tuple(WHOLE))
        row = {column: rounds[0].get(column, "") for column in COLUMNS} | {
            "part": part, "ranks": ranks, "grains": grains, "rounds": len(rounds),
            "steps": round(RUN / STEP) if whole else steps}
        if row["ghosts_most"] != "":
            row["bytes_per_step"] = GHOST_BYTES * int(row["ghosts_most"])
        if timed:
            times, time = [float(one["us_per_step"]) for one in rounds], median(part, "us_per_step")
            over = (engines[part.split(": ")[0]] if ": " in part else
                    median("pairs", "cpu_us_per_step" if part.endswith("_cpu") else "us_per_step"))
            if row["cpu_us_per_step"] != "":
                row["cpu_us_per_step"] = f"{median(part, 'cpu_us_per_step'):.0f}"
            row |= {"us_per_step": f"{time:.0f}", "lowest": f"{min(times):.0f}", "highest": f"{max(times):.0f}",
                    "ns_per_grain_step": f"{1e3 * time / grains:.0f}", "over_pairs": f"{time / over:.3f}"}
        else:
            row |= dict.fromkeys(COLUMNS[5:11], "")
        yield row


def main():
    global RUN
    arguments = driver.options(
        __doc__, steps={"type": int, "default": 200}, rounds={"type": int, "default": 2},
        out={"type": lambda name: pathlib.Path(name).resolve(), "default": HERE / "liggghts_cost.csv"},
        ranks={"type": int, "nargs": "+", "default": [1, 2, 4]}, timed={"type": int, "nargs": "+", "default": [1, 2]},
        end={"type": float, "default": RUN, "help": "of the whole run, s"}).parse_args()
    RUN, steps = arguments.end, arguments.steps
    made, rows = driver.provenance.made_here(), []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        whole_run(1, folder / "run")
        write_data(folder / "run" / "frames" / "terrain_000000.h5", folder / "bed.data")
        for ranks in arguments.ranks:
            timed = ranks in arguments.timed
            found, engines = measured(ranks, timed, arguments.rounds, steps, folder)
            rows += rows_of(ranks, timed, steps, found, engines)
            driver.write(arguments.out, rows, made, names=COLUMNS)
    for row in rows:
        print(f"{row['ranks']} ranks, {row['part']:<38} {row['us_per_step']:>10} µs a step, "
              f"processor {row['cpu_us_per_step']:>10}, over pairs alone {row['over_pairs']}")


if __name__ == "__main__":
    main()
