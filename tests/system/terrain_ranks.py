#!/usr/bin/python3
"""A terrain of three ranks, the strip mat of tests/dummies: results that do not depend on how many there are, each rank
killed and stopped, and what is refused."""
import shutil

from checkpoint_runs import INTERVAL, CheckpointTest, steps, summary, table
from program import changed, main, write_scenario

MAT = changed(rig={"touchdown_damping": 0}, terrain={"ground_stiffness": 4e7},
              run={"step": 2e-4, "end": 0.1, "average_from": 0.04, "peer_timeout": 20},
              output={"series_interval": 0.002, "frame_interval": 0.01}, checkpoint={"interval": 0.02, "keep": 3})
MAT["terrain"] = {"engine": "strip_mat", "ranks": 3, "length": 1.4, "width": 0.4, "ground_stiffness": 4e7}
RANKS = {"terrain 0": 2, "terrain 1": 3, "terrain 2": 4}


class TerrainRanks(CheckpointTest):
    SCENARIO = MAT

    def killed(self, point, count, step):
        for name, rank in RANKS.items():
            with self.subTest(f"{point} of {name}"):
                self.afresh()
                self.run_with_fault(point, rank, count, "kill",
                                    says=f"furrow: error: rank {rank} ({name}) was lost: killed by signal 9")
                self.assertEqual(steps(self.run_folder)[-1], step)
                self.continues()

    def test_killed_in_a_step(self):
        self.killed("step", 250, 200)

    def test_killed_in_a_checkpoint(self):
        self.killed("checkpoint.write", 2, 100)

    def test_killed_in_a_frame(self):
        self.killed("frame", 6, 200)  # of step 250

    def test_one_that_stops_is_named(self):
        for name, rank in list(RANKS.items())[1:]:
            with self.subTest(name):
                self.afresh()
                self.run_with_fault("step", rank, 250, "stop", flags=["--set", "run.peer_timeout=2"],
                                    matches=rf"furrow: error: .*waited 2 s for .*{name} does not answer")
        self.continues(leave_out=["scenario.json", "checkpoints/*/manifest.json"])  # they hold the key

    def test_stopped_by_a_signal_they_all_save_at_the_same_step(self):
        process = self.start_waiting("step", 3, 250)
        process.terminate()
        self.released(process, 75)
        self.assertGreater(steps(self.run_folder)[-1], 2 * INTERVAL)
        self.continues()

    def test_series_and_frames_do_not_depend_on_their_number(self):
        for ranks in (1, 2):
            with self.subTest(ranks):
                other = self.folder / f"of {ranks}"
                self.program("run", self.path, "--out", other, "--set", f"terrain.ranks={ranks}", "--no-plots")
                self.same_as_whole(run=other, leave_out=["scenario.json", "summary.json", "checkpoints/*",
                                                         "checkpoints/*/*", "results.h5"])
                self.assertEqual(summary(other)["drawbar_pull_N"], summary(self.whole)["drawbar_pull_N"])

    def test_each_is_in_the_summary_and_has_a_part_of_the_checkpoint(self):
        rows = {row["node"]: row for row in summary(self.whole)["ranks"]}
        self.assertEqual(list(rows), ["rig", "tire 0", *RANKS])
        self.assertEqual(sum(rows[name]["size"] for name in RANKS), summary(self.whole)["grains"])
        self.assertEqual(summary(self.whole)["terrain_ranks"], 3)
        sizes = [rows[name]["size"] for name in RANKS]
        uneven = max(sizes) * 3 / sum(sizes) - 1
        for when in ("begin", "end"):
            self.assertAlmostEqual(summary(self.whole)["terrain_imbalance"][when], uneven, delta=1e-12)
        parts = {path.name for path in (self.whole / "checkpoints").glob("*500/*")}
        self.assertEqual(parts, {"manifest.json", "rig.h5", "tire0.h5", "terrain.h5", "terrain1.h5", "terrain2.h5"})
        self.assertGreater(float(table(self.whole)[-1]["sinkage_m"]), 1e-4)

    def test_another_number_cannot_continue(self):
        run = self.copy_of_whole()
        manifests = sorted(run.glob("checkpoints/*/manifest.json"))
        shutil.rmtree(manifests[-1].parent)
        self.program("resume", run, "--set", "terrain.ranks=2", "--no-plots", code=2,
                     says="key 'terrain.ranks': is 2 but the run was computed with 3")

    def test_more_than_the_engine_can_use_are_refused(self):
        path = write_scenario(self.folder, changed(terrain={"ranks": 2}), "grains.json")
        self.program("run", path, "--out", self.run_folder, code=2,
                     says="key 'terrain.ranks': is 2, expected 1: engine 'dem' runs on one rank")


if __name__ == "__main__":
    main()
