#!/usr/bin/python3
"""Grains on a GPU, by the emulation of its library: exact resume, another pass, what is refused, and what is left when
the device fails (failing_gpu.cpp)."""
import pathlib
import shutil
import tempfile

from checkpoint_runs import FAULTY, CheckpointTest, steps
from exact_resume import Exact
from program import SystemTest, changed, main, read_json, rows_of, write_json, write_scenario
from scenarios import SHELL, SMALL_BED, run_of  # found since exact_resume was imported

NAME = "libfurrow_gpu.so"
EMULATION, FAILING = [pathlib.Path(FAULTY).parent / folder / NAME for folder in ("gpu_emulation", "gpu_failing")]
# Of a call: terrain/gpu/gpu_interface.hpp.
NO_DEVICE, MEMORY, FAILED = 1, 2, 3


def beside(library, holder):
    """The program in a new folder in `holder`, with this library, which it finds before any other."""
    folder = pathlib.Path(tempfile.mkdtemp(dir=holder))
    if library:
        shutil.copy(library, folder / NAME)
    return shutil.copy(FAULTY, folder)


def on_gpu(tire, **terrain):
    return run_of(0.08, rig={"touchdown_damping": 0, "carrier_mass": 100}, tire=tire,
                  terrain={**SMALL_BED, "device": "gpu", **terrain}, checkpoint={"interval": 0.01, "keep": 1000})


def fault(interval, status):
    return {"FURROW_GPU_LIBRARY": str(EMULATION), "FURROW_GPU_FAULT": f"{interval}:{status}"}


class FlexibleTire(Exact, CheckpointTest):
    SCENARIO = on_gpu(SHELL)
    LOADED = 6
    KILLED = (2,)

    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory(prefix="furrow gpu ")
        cls.addClassCleanup(holder.cleanup)
        cls.PROGRAM, cls.failing = beside(EMULATION, holder.name), beside(FAILING, holder.name)
        super().setUpClass()

    def test_its_accounts_close(self):
        self.accounts_close(read_json(self.whole / "summary.json"))

    def test_a_device_that_fails_leaves_the_last_checkpoint(self):
        interval = steps(self.whole)[0]
        for status, code, words in ((FAILED, 4, "the GPU failed: as a test wants it"),
                                    (MEMORY, 6, "the GPU ran out of memory: as a test wants it; expected fewer")):
            with self.subTest(code):
                self.afresh()
                self.furrow("run", self.path, "--out", self.run_folder, "--no-plots", program=self.failing, code=code,
                            errors=1, says=(words, f"furrow resume '{self.run_folder}'"),
                            env=fault(interval * self.LOADED + 7, status))
                self.no_process_left()
                self.assertEqual(steps(self.run_folder)[-1], interval * self.LOADED)
                self.continues()


class Passes(SystemTest):
    def test_begin_on_the_bed_that_the_last_one_left(self):
        write_scenario(self.folder, on_gpu({"rigid": True}), "rigid.json")
        study = write_json(self.folder / "study.json", {"scenario": "rigid.json", "passes": 2, "rest": 0.01})
        self.furrow("sweep", study, "--out", "out", program=beside(EMULATION, self.folder))
        rows = rows_of(self.folder / "out" / "sweep.csv")
        self.assertEqual([(row["pass"], row["state"]) for row in rows], [("1", "done"), ("2", "done")])
        first, second = [read_json(self.folder / "out" / row["folder"] / "summary.json") for row in rows]
        for key in ("grains", "surface_height_m"):
            self.assertEqual(first[key], second[key])
        self.assertNotEqual(first["state_hash"], second["state_hash"])


class Refused(SystemTest):
    def refused(self, library, words, env=None, tire=None, **terrain):
        scenario = changed(tire=tire or {}, terrain={"device": "gpu", **terrain})
        return self.furrow("run", write_scenario(self.folder, scenario), "--out", "out", "--no-plots", env=env, code=2,
                           errors=1, says=f": key '{words}", program=beside(library, self.folder))

    def refused_at_once(self, library, words, **sections):
        done = self.refused(library, words, **sections)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertFalse((self.folder / "out").exists())
        return done.stderr

    def test_what_it_does_not_do_is_an_error_that_names_the_key(self):
        for key, value, text in (("size_spread", 0.2, "0.2"), ("precision", "double", "'double'")):
            self.refused_at_once(EMULATION, f"terrain.{key}': is {text} with terrain.device 'gpu', expected",
                                 **{key: value})
        self.refused_at_once(EMULATION, "tire.contact_tangent': is true, expected false: grains on a GPU",
                             tire={**SHELL, "contact_tangent": True})
        self.refused_at_once(EMULATION, "terrain.device': is 'tpu', expected", device="tpu")

    def test_a_library_that_is_missing_or_cut_short(self):
        self.refused_at_once(None, f"terrain.device': is 'gpu', but {NAME} is not beside this program")
        cut = self.folder / "cut"
        cut.write_bytes(EMULATION.read_bytes()[:100000])
        said = self.refused_at_once(cut, "terrain.device': is 'gpu', but ")
        self.assertIn("has 100000 bytes, expected ", said)

    def test_a_machine_without_a_device(self):
        self.refused(FAILING, "terrain.device': is 'gpu', but as a test wants it; expected 'cpu', or an NVIDIA driver",
                     env=fault(0, NO_DEVICE))


if __name__ == "__main__":
    main()
