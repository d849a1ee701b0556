#!/usr/bin/python3
"""Grains in LIGGGHTS: the same numbers as those of our own engine, on any number of ranks; exact resume; faults of the
ranks and of LIGGGHTS itself; what is refused. Skipped where the engine was not built.

The test tests_system_liggghts (label system) runs a part of it, cluster_liggghts (label cluster) the whole."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

import h5py

from checkpoint_runs import FAULTY, CheckpointTest, steps, summary, table
from exact_resume import Exact, kept
from program import changed, main, write_scenario
from scenarios import SMALL_BED, run_of  # found since exact_resume was imported

LIBRARY = pathlib.Path(FAULTY).parent / "libfurrow_liggghts.so"


def on_liggghts(scenario, ranks, **terrain):
    """The scenario with the other engine."""
    return {**scenario, "terrain": {**scenario["terrain"], "engine": "liggghts", "ranks": ranks, **terrain}}


def on_dem(scenario):
    terrain = {k: v for k, v in scenario["terrain"].items() if k not in ("engine", "ranks")}
    return {**scenario, "terrain": {**terrain, "precision": "double", "activity": False}}


class RigidTire(Exact, CheckpointTest):
    """On two ranks; the wheel stands on their border."""
    SCENARIO = on_liggghts(kept("rigid"), 2)
    LOADED = 7
    KILLED = (2, 3)


class FlexibleTire(Exact, CheckpointTest):
    SCENARIO = on_liggghts(kept("tangents"), 2)
    LOADED = 6
    KILLED = (3,)


class SeveralWheels(Exact, CheckpointTest):
    SCENARIO = on_liggghts(kept("wheels"), 2)
    WHEELS = 2
    KILLED = (3,)


class SameNumbers(CheckpointTest):
    """As those of engine dem in double precision without sleep. Chaos multiplies round-off: the comparison is of the
    tenth of a second after which it is still small."""
    ON, RANKS = kept("rigid"), (1, 2, 3, 4)
    SCENARIO = on_dem(ON)
    COLUMNS = ("force_x_N", "force_y_N", "force_z_N", "spindle_torque_Nm", "terrain_kinetic_energy_J",
               "terrain_potential_energy_J", "terrain_elastic_energy_J", "soil_dissipation_J")

    def differs_from_whole_by(self, scenario):
        run = self.folder / "other"
        self.program("run", write_scenario(self.folder, scenario, "other.json"),
                     "--out", run, "--no-plots", "--overwrite")
        ours, theirs = table(self.whole), table(run)
        self.assertEqual(len(ours), len(theirs))
        worst = 0.0
        for column in self.COLUMNS:
            scale = max(abs(float(row[column])) for row in ours)
            self.assertGreater(scale, 0.0, column)
            worst = max(worst, *(abs(float(a[column]) - float(b[column])) / scale for a, b in zip(ours, theirs)))
        self.assertLess(summary(run)["transfer_force_residual"], 1e-12)
        self.assertLess(summary(run)["accounts"]["momentum"]["residual_share"], 1e-11)
        return worst

    def test_on_every_number_of_ranks(self):
        for ranks in self.RANKS:
            with self.subTest(ranks):
                self.assertLess(self.differs_from_whole_by(on_liggghts(self.ON, ranks)), 1e-9)


def soil(**terrain):
    return {**kept("rigid"), "terrain": {**kept("rigid")["terrain"], **terrain}}


def under(tire, **terrain):
    return run_of(0.06, rig={"touchdown_damping": 0}, checkpoint={"interval": 0.01, "keep": 1000}, tire=tire,
                  terrain={**SMALL_BED, **terrain})


class SameNumbersOfOtherSoils(SameNumbers):
    """Sizes, rolling resistance, cohesion and periodic sides."""
    ON, RANKS = soil(size_spread=0.2, rolling_friction=0.1, cohesion=2e4, sides="periodic"), (1, 3)
    SCENARIO = on_dem(ON)


class SameNumbersOfTheReportsLaw(SameNumbers):
    ON, RANKS = soil(law="hertz_tanh"), (2,)
    SCENARIO = on_dem(ON)


class SameNumbersUnderARing(SameNumbers):
    ON, RANKS = under({"file": "hmmwv_ring.json", "rigid": False, "elements_circumference": 60}), (2,)
    SCENARIO = on_dem(ON)


class SameNumbersUnderAPlanarTire(SameNumbers):
    """It is 1 m wide."""
    ON, RANKS = under({"file": "aligator_planar.json", "rigid": False}, length=1.6, width=1.1), (2,)
    SCENARIO = on_dem(ON)


class BordersThatMove(CheckpointTest):
    """A heavy wheel that slips pushes grains over the borders of four ranks. After 1000 steps one has 5 % more than the
    mean."""
    SCENARIO = {
        "format_version": 1,
        "rig": {"type": "drawbar", "slip": 0.5, "angular_speed": 8, "ramp": 0.01,
                "carrier_mass": 450, "touchdown_damping": 0},
        "tire": {"file": "hmmwv_layered.json", "rigid": True},
        "terrain": {"engine": "liggghts", "ranks": 4, "radius": 0.03, "layers": 4, "length": 1.6, "width": 0.4},
        "run": {"step": 2e-4, "end": 0.208, "average_from": 0.1, "peer_timeout": 60},
        "output": {"series_interval": 0.002, "frame_interval": 0.02},
        "checkpoint": {"interval": 0.02, "keep": 1000},
    }
    MOVED = 1000

    def borders(self, step):
        with h5py.File(self.whole / "checkpoints" / f"{step:012}" / "terrain.h5") as file:
            return list(file["state"]["terrain:borders"][()])

    def test_a_run_goes_on_from_the_step_in_which_they_moved(self):
        self.assertEqual(self.borders(self.MOVED - 100), self.borders(100))
        self.assertNotEqual(self.borders(self.MOVED), self.borders(100))
        for step in (self.MOVED, self.MOVED - 100):
            with self.subTest(step):
                self.cut_to(step)
                self.continues()

    def test_the_summary_tells_the_imbalance(self):
        told = summary(self.whole)
        sizes = [row["size"] for row in told["ranks"] if row["node"].startswith("terrain")]
        self.assertEqual(sum(sizes), told["grains"])
        self.assertAlmostEqual(told["terrain_imbalance"]["end"], max(sizes) * 4 / sum(sizes) - 1, delta=1e-12)
        self.assertLess(told["terrain_imbalance"]["begin"], 0.05)
        self.assertLess(told["terrain_imbalance"]["end"], 0.05)


class Faults(CheckpointTest):
    SCENARIO = on_liggghts(kept("rigid"), 2)
    RANKS = {"terrain 0": 2, "terrain 1": 3}

    def test_ranks_killed_in_a_step_a_checkpoint_and_a_frame(self):
        for point, count in (("step", 250), ("checkpoint.write", 3), ("frame", 5)):
            for name, rank in self.RANKS.items():
                with self.subTest(f"{name}, {point}"):
                    self.afresh()
                    self.run_with_fault(point, rank, count, "kill",
                                        says=f"rank {rank} ({name}) was lost: killed by signal 9")
                    self.continues()

    def test_one_that_stops_ends_the_run(self):
        for name, rank in self.RANKS.items():
            with self.subTest(name):
                self.afresh()
                self.run_with_fault("step", rank, 250, "stop", flags=["--set", "run.peer_timeout=2"],
                                    matches=r"furrow: error: .*terrain 0 does not answer; .*one of terrain 1 to 1")
                self.continues(leave_out=["scenario.json", "checkpoints/*/manifest.json"])

    def test_a_command_that_liggghts_refuses_on_all_ranks(self):
        self.run_with_fault("liggghts", "*", 250, "say fix nonsense all nonsense",
                            says='LIGGGHTS failed: Invalid fix style: "nonsense"')
        self.continues()

    def test_a_file_that_one_rank_misses(self):
        self.run_with_fault("liggghts", "*", 250, "say include no_such_file",
                            matches="terrain 0: LIGGGHTS failed on this rank: .*no_such_file")
        self.continues()

    def test_another_number_of_ranks_cannot_continue(self):
        run = self.copy_of_whole()
        shutil.rmtree(run / "checkpoints" / f"{steps(run)[-1]:012}")
        self.program("resume", run, "--set", "terrain.ranks=3", "--no-plots", code=2,
                     says="key 'terrain.ranks': is 3 but the run was computed with 2")


class Refused(CheckpointTest):
    SCENARIO = on_liggghts(changed(run={"step": 2e-4, "end": 0.01, "average_from": 0.0}), 1)

    def test_keys_that_it_cannot_honour(self):
        for key, value in (("activity", False), ("activity", True), ("precision", "double"), ("precision", "mixed"),
                           ("ground_stiffness", 1e8)):
            with self.subTest(key):
                path = write_scenario(self.folder, on_liggghts(self.SCENARIO, 1, **{key: value}), "wrong.json")
                self.program("run", path, "--out", self.run_folder, code=2, says=f"key 'terrain.{key}'")

    def test_parts_thinner_than_grains(self):
        self.program("run", self.path, "--out", self.run_folder, "--set", "terrain.ranks=20", code=2,
                     says="key 'terrain.ranks': is 20, expected 7 or fewer: of a bed of 1.4 m each would have a part")

    def test_what_it_does_without_is_said(self):
        done = self.program("validate", self.path, "--set", "terrain.ranks=3", "--threads", 4,
                            "--json",
                            says="key 'run.threads': is 4: engine 'liggghts' uses them to make the bed, then one core")
        told = json.loads(done.stdout)
        self.assertEqual(told["time"]["terrain_threads"], 1)
        self.assertGreater(told["time"]["ghosts_per_rank"], 0)
        if len(os.sched_getaffinity(0)) < 3:
            self.assertIn("key 'terrain.ranks': is 3, this machine has ", done.stderr)

    def test_ranks_that_share_cores_yield_while_they_poll(self):
        launcher, told = self.folder / "launcher", self.folder / "told"
        launcher.write_text(f'#!/bin/sh\necho "$OMPI_MCA_mpi_yield_when_idle" > "{told}"\nexit 1\n')
        launcher.chmod(0o755)
        core = str(min(os.sched_getaffinity(0)))
        for ranks, yields in ((1, ""), (2, "1")):
            with self.subTest(ranks):
                subprocess.run(["taskset", "-c", core, FAULTY, "run", self.path,
                                "--set", f"terrain.ranks={ranks}", "--out", self.run_folder,
                                "--overwrite"], env={**os.environ, "FURROW_MPIRUN": str(launcher)},
                               capture_output=True, check=False)
                self.assertEqual(told.read_text().strip(), yields)

    def test_without_its_library(self):
        program = self.folder / "alone" / "in" / "some" / "folder" / "furrow"
        program.parent.mkdir(parents=True)
        shutil.copy2(FAULTY, program)
        for command in (["run", self.path, "--out", self.run_folder], ["validate", self.path],
                        ["ranks", "--slurm", self.path]):
            done = self.furrow(*command, program=str(program), code=2, matches="key 'terrain.engine': 'liggghts' is "
                               "not part of this program: .*libliggghts-dev")
            self.assertEqual(len(re.findall("error", done.stderr)), 1, done.stderr)
        self.assertFalse(self.run_folder.exists())
        with open(LIBRARY, "rb") as whole:
            (program.parent / LIBRARY.name).write_bytes(whole.read(100_000))
        self.furrow("run", self.path, "--out", self.run_folder, program=str(program), code=2,
                    matches=f"{LIBRARY.name} has 100000 bytes, expected [0-9]+ or more: it is cut short")
        self.assertFalse(self.run_folder.exists())


if __name__ == "__main__":
    if not LIBRARY.exists():
        print(f"skipped: {LIBRARY.name} was not built")
        sys.exit(77)
    if sys.argv[1:] == ["--short"]:
        sys.argv[1:] = ["SameNumbersOfTheReportsLaw", "RigidTire.test_from_a_checkpoint_whose_step_has_a_frame",
                        "Refused", "Faults.test_a_command_that_liggghts_refuses_on_all_ranks",
                        "Faults.test_a_file_that_one_rank_misses"]
    main()
