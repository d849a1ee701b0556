#!/usr/bin/python3
"""Every file of a run that was continued is that of the run that was not interrupted, also where a frame falls on the
step of the checkpoint, for every kind of tire. tests/campaign/compare_runs.py compares them."""
import csv
import sys

import h5py

from checkpoint_runs import CheckpointTest, steps, summary
from program import ROOT, main

sys.path.insert(0, str(ROOT / "tests" / "campaign"))
from scenarios import SHELL, SINGLE, run_of  # noqa: E402


def kept(name):
    """A scenario of the campaign that keeps all its checkpoints."""
    scenario = SINGLE[name]
    return {**scenario, "checkpoint": {**scenario["checkpoint"], "keep": 1000}}


# A run of 400 steps, with a checkpoint and a frame every 50, that keeps all of them.
QUICK = {"format_version": 1, "run": {"step": 2e-4, "end": 0.08, "average_from": 0.04, "peer_timeout": 20},
         "output": {"series_interval": 0.002, "frame_interval": 0.01}, "checkpoint": {"interval": 0.01, "keep": 1000}}
HARD_GROUND = {"engine": "rigid", "ground_stiffness": 2e7, "ground_shear_stiffness": 5e6, "ground_damping": 5e3}


class Exact:
    """Frames and checkpoints fall on the same steps. `LOADED`: that the terrain pushes at the frame of this number.
    Every kind of rank is killed on grains; elsewhere the rank that has something of its own to save."""
    WHEELS = 1
    KILLED = (1,)  # ranks
    LOADED = 4

    def test_the_terrain_pushes_in_the_frames_of_the_checkpoints(self):
        for wheel in range(self.WHEELS):
            with h5py.File(self.whole / "frames" / f"tire{wheel}_{self.LOADED:06}.h5") as frame:
                self.assertGreater(abs(frame["force"][()]).max(), 1.0)

    def test_from_a_checkpoint_whose_step_has_a_frame(self):
        all_steps = steps(self.whole)
        interval = all_steps[0]
        for step in (interval * self.LOADED, all_steps[-1]):
            with self.subTest(step=step):
                self.cut_to(step)
                self.continues()

    def test_after_kill_of_a_rank(self):
        interval = steps(self.whole)[0]
        for rank in self.KILLED:
            with self.subTest(rank=rank):
                self.afresh()
                self.run_with_fault("step", rank, interval * self.LOADED + 7, "kill")
                self.continues()

    def test_a_finished_run_with_a_later_end(self):
        end = self.SCENARIO["run"]["end"]
        interval = self.SCENARIO["checkpoint"]["interval"]
        self.program("run", self.path, "--out", self.run_folder, "--no-plots",
                     "--set", f"run.end={interval * self.LOADED:.3g}")
        self.resume("--until", end)
        self.same_as_whole(leave_out=["checkpoints/*/manifest.json"])  # those of the first part hold the earlier end


class RigidTireOnGrains(Exact, CheckpointTest):
    SCENARIO = kept("rigid")
    KILLED = (0, 1, 2)
    LOADED = 7


class FlexibleTireUnderAPressureSchedule(Exact, CheckpointTest):
    SCENARIO = kept("shell")


class FlexibleRing(Exact, CheckpointTest):
    """On grains, while its pressure falls."""
    SCENARIO = run_of(0.1, rig={"touchdown_damping": 0}, checkpoint={"interval": 0.01, "keep": 1000},
                      tire={"file": "hmmwv_ring.json", "rigid": False, "elements_circumference": 60,
                            "pressure": [[0, 200e3], [0.08, 120e3]]})
    LOADED = 7


class ContactTangents(Exact, CheckpointTest):
    SCENARIO = kept("tangents")
    LOADED = 6


class SeveralWheels(Exact, CheckpointTest):
    SCENARIO = kept("wheels")
    WHEELS = 2
    KILLED = (2, 3)
    LOADED = 6


class EmpiricalSoil(Exact, CheckpointTest):
    """A flexible tire presses, shears and lets rebound the nodes of the soil."""
    SCENARIO = {
        **QUICK,
        "rig": {"type": "drawbar", "slip": 0.3, "angular_speed": 4.28, "ramp": 0.01, "carrier_mass": 450,
                "touchdown_damping": 0},
        "tire": SHELL,
        "terrain": {"engine": "scm", "material": "dry_sand.json", "length": 1.4, "width": 0.5, "grid_spacing": 0.02},
        "run": {**QUICK["run"], "end": 0.06, "average_from": 0.02},
    }
    KILLED = (2,)


class Vehicle(Exact, CheckpointTest):
    """It lands, shifts and turns its wheels at the checkpoints."""
    SCENARIO = {
        **QUICK,
        "rig": {"type": "vehicle", "vehicle": "hmmwv.json", "drop_height": 0.005,
                "driver": {"inputs": {"throttle": [[0, 0], [0.02, 1]], "gear": [[0, 1], [0.045, 2]],
                                      "steering": [[0, 0], [0.05, 0.5]]}}},
        "tire": {"rigid": True, "elements_circumference": 40},
        "terrain": HARD_GROUND,
    }
    WHEELS = 4
    KILLED = (0, 4)  # rig and a rear tire
    LOADED = 5

    def test_after_a_stop_of_a_rank(self):
        for rank, name in ((0, "rig"), (5, "terrain")):
            with self.subTest(name):
                self.afresh()
                self.run_with_fault("step", rank, 257, "stop", flags=["--set", "run.peer_timeout=5"],
                                    matches=rf"furrow: error: .*waited 5 s for .*{name} does not answer")
                self.continues(leave_out=["scenario.json", "checkpoints/*/manifest.json"])  # they hold the key

    def test_after_a_signal(self):
        process = self.start_waiting("step", 0, 257)
        self.told_to_stop(process)
        self.released(process, 75)
        self.assertIn(steps(self.run_folder)[-1], range(257, 277))
        self.continues()


def on_a_curb(rig, **tire):
    """A quick run over a curb that keeps all its checkpoints."""
    return {**QUICK, "rig": {"speed": 4.0, "ramp": 0.01, "rim_mass": 15, "rim_spin_inertia": 0.7, **rig},
            "tire": {"file": "hmmwv_lumped.json", **tire},
            "terrain": {**HARD_GROUND, "profile": [[0.2, 0], [0.2, 0.02]]}}


class QuarterCar(Exact, CheckpointTest):
    SCENARIO = on_a_curb({"type": "quarter_car", "body_mass": 400}, rigid=True, elements_circumference=40)
    KILLED = (0,)
    LOADED = 6


class HalfCar(Exact, CheckpointTest):
    """The front wheel has met the curb, the rear one has not."""
    SCENARIO = on_a_curb({"type": "half_car", "body_mass": 800, "wheelbase": 1.5, "front_share": 0.6},
                         rigid=True, elements_circumference=40)
    WHEELS = 2
    KILLED = (0,)
    LOADED = 6


class CleatStand(Exact, CheckpointTest):
    """The stop takes hold of the axle between two checkpoints."""
    SCENARIO = on_a_curb({"type": "cleat_stand", "carrier_mass": 400, "hold_axle_from": 0.045},
                         rigid=True, elements_circumference=40)
    KILLED = (0,)
    LOADED = 6


class BeforeTheWall(CheckpointTest):
    """A vehicle comes near the end wall: the rig knows two steps before the end, the tires too, the terrain one."""
    SCENARIO = {
        "format_version": 1,
        "rig": {"type": "vehicle", "vehicle": "hmmwv.json", "start": 2.15, "start_speed": 2.0, "stop_before_wall": 1.21,
                "driver": {"speed": {"target": 2.0}}},
        "tire": {"rigid": True, "elements_circumference": 40},
        "terrain": {"engine": "dem", "radius": 0.05, "layers": 2, "length": 5.5, "width": 2.6, "cohesion": 1e4},
        "run": {"step": 2e-4, "end": 0.04, "average_from": 0.03, "peer_timeout": 20},
        "output": {"series_interval": 6e-4, "frame_interval": 0.002},
        "checkpoint": {"interval": 2e-4, "keep": 1000},
    }

    def test_the_run_is_complete_before_its_planned_end(self):
        told = summary(self.whole)
        end = steps(self.whole)[-1]
        self.assertEqual(told["end_reason"], "end_wall")
        self.assertAlmostEqual(told["end_time_s"], 2e-4 * end, delta=1e-12)
        self.assertAlmostEqual(told["average_from_s"], 0.75 * told["end_time_s"], delta=1e-12)
        self.assertFalse((self.whole / "summary_failed.json").exists())
        with open(self.whole / "timeseries_wheel0.csv", newline="") as file:
            position = [float(line["position_m"]) for line in csv.DictReader(file)]
        self.assertAlmostEqual(5.5 - position[-1] - 0.4673 - 1.21, 0.0, delta=2e-3)
        self.program("resume", self.whole,
                     "--no-plots", matches=r"is finished: it ended at 0\.\d+ s; there is nothing to do")

    def test_from_every_checkpoint_around_the_end(self):
        all_steps = steps(self.whole)
        end = all_steps[-1]
        self.assertLess(end, 200)
        for step in range(end - 2, end + 1):
            with self.subTest(step=step):
                self.cut_to(step)
                self.resume(says="a tire came near the end wall")
                self.same_as_whole()


if __name__ == "__main__":
    main()
