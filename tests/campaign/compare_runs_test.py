#!/usr/bin/python3
"""compare_runs.py sees every difference that counts, and none of those that it lists."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

from compare_runs import differences

SUMMARY = {"state_hash": "a", "sinkage_m": 0.0, "wall_s": 1.0, "ranks": [{"cpu_s": 1.0}], "wheels": [{"slip": None}]}


def write_h5(path, **datasets):
    path.parent.mkdir(parents=True, exist_ok=True)
    with h5py.File(path, "w", track_order=False) as file:
        file.attrs["time_s"] = 0.1
        file.attrs["checksum"] = "1"
        for name, values in datasets.items():
            file.create_dataset(name.replace("__", "/"), data=np.asarray(values), track_times=False)


def write_checkpoint(run, step, **wall):
    folder = run / "checkpoints" / f"{step:012}"
    write_h5(folder / "tire0.h5", state__x=[1.0 * step], **{"state__run:cost:cpu_s": [wall.get("cpu", 1.0)]})
    (folder / "manifest.json").write_text(json.dumps({"step": step, "write_s": wall.get("write", 0.1), "parts": []}))


def write_run(run):
    run.mkdir(parents=True)
    (run / "timeseries.csv").write_text("time_s\n0.1\n")
    (run / "summary.json").write_text(json.dumps(SUMMARY))
    (run / "run.log").write_text("said")
    write_h5(run / "frames" / "tire0_000001.h5", force=np.float32([0.0, np.nan]))
    write_checkpoint(run, 100)
    write_checkpoint(run, 200)


class CompareRuns(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.a, self.b = pathlib.Path(holder.name) / "a", pathlib.Path(holder.name) / "b"
        write_run(self.a)
        self.again()

    def again(self):
        shutil.rmtree(self.b, ignore_errors=True)
        write_run(self.b)
        return self.b

    def found(self, words, leave_out=()):
        text = "\n".join(differences(self.a, self.b, leave_out))
        self.assertIn(words, text)
        self.assertEqual(text.count("\n"), 0, text)

    def test_axes_of_datasets_are_compared_by_their_names(self):
        def lay(run, along, padding):
            with h5py.File(run / "frames" / "terrain_000001.h5", "w", track_order=False) as file:
                file.create_dataset("padding", data=np.zeros(padding), track_times=False)  # moves what comes after it
                del file["padding"]
                for name in ("time_s", "place", "other"):
                    file.create_dataset(name, data=np.zeros(3), track_times=False)
                    if name != "other":
                        file[name].make_scale()
                file["other"].dims[0].attach_scale(file[along])
        lay(self.a, "time_s", 10)
        lay(self.b, "time_s", 1000)
        self.assertEqual(differences(self.a, self.b), [])
        lay(self.b, "place", 10)
        text = "\n".join(differences(self.a, self.b))
        self.assertIn("attribute other@DIMENSION_LIST: [[\"/time_s\"]] and [[\"/place\"]]", text)

    def test_equal_runs(self):
        self.assertEqual(differences(self.a, self.b), [])

    def test_what_may_differ(self):
        (self.b / "run.log").write_text("said otherwise")
        (self.b / "profile.json").write_text("{}")
        for folder in (self.a, self.b):
            (folder / "ranks.png").write_text(f"the wall times of {folder.name}")
            (folder / "report.html").write_text(f"the wall times of {folder.name}")
            (folder / "forces.png").write_text("forces")
        (self.b / "summary.json").write_text(json.dumps({**SUMMARY, "wall_s": 2.0, "ranks": [], "cpu": "another"}))
        write_checkpoint(self.b, 200, cpu=2.0, write=0.2)
        write_checkpoint(self.b, 150)
        shutil.rmtree(self.b / "checkpoints" / f"{100:012}")
        self.assertEqual(differences(self.a, self.b), [])

    def test_files(self):
        (self.b / "timeseries.csv").write_text("time_s\n0.2\n")
        self.found("timeseries.csv: differs from byte 9, line 2")
        self.found_after(lambda run: (run / "timeseries.csv").unlink(), "timeseries.csv: only in")
        self.found_after(lambda run: (run / ".summary.json.part").write_text(""), ".summary.json.part: only in")
        self.found_after(lambda run: (run / "checkpoints" / ".000000000200.part").write_text(""), ".part: only in")
        self.found_after(lambda run: (run / "checkpoints" / f"{100:012}" / "rig.h5").write_text(""), "rig.h5: only in")

    def found_after(self, change, words):
        change(self.again())
        self.found(words)

    def test_summary(self):
        for keys, words in (({"state_hash": "b"}, "summary.json: state_hash: a and b"),
                            ({"sinkage_m": -0.0}, "sinkage_m"),
                            ({"wheels": [{"slip": 0.1}]}, "wheels.0.slip: None and 0.1"),
                            ({"more": 1}, "more: only in the second")):
            self.found_after(lambda run, keys=keys: (run / "summary.json").write_text(json.dumps({**SUMMARY, **keys})),
                             words)

    def test_hdf5(self):
        frame = "frames/tire0_000001.h5"
        self.found_after(lambda run: write_h5(run / frame, force=np.float32([-0.0, np.nan])), "dataset force: ")
        self.found_after(lambda run: write_h5(run / frame, force=[0.0, np.nan]),
                         "dataset force: float32[2] and float64[2]")
        self.found_after(lambda run: write_h5(run / frame, force=np.float32([0.0, np.nan]), more=[1]),
                         "more: only in the second")

        def attribute(run):
            with h5py.File(run / frame, "a") as file:
                file.attrs["time_s"] = 0.2
        self.found_after(attribute, "attribute /@time_s")

    def test_checkpoints(self):
        self.found_after(lambda run: shutil.rmtree(run / "checkpoints" / f"{200:012}"),
                         "checkpoints: the newest is 000000000200")

        def other_state(run):
            with h5py.File(run / "checkpoints" / f"{200:012}" / "tire0.h5", "a") as file:
                file["state/x"][0] = 3.0
        self.found_after(other_state, "tire0.h5: dataset state/x")

    def test_a_run_of_a_study_and_files_left_out_by_intent(self):
        for folder in (self.a, self.b):
            shutil.copytree(folder, folder / "runs" / "1f")
            (folder / "sweep.csv").write_text(f"run,state,wall_s\n1,done,{folder.name}\n")
            (folder / "runs" / "1f.log").write_text(folder.name)
        (self.b / "runs" / "1f" / "run.log").write_text("otherwise")
        self.assertEqual(differences(self.a, self.b), [])
        (self.b / "runs" / "1f" / "scenario.json").write_text("{}")
        self.found("runs/1f/scenario.json: only in")
        self.assertEqual(differences(self.a, self.b, ["scenario.json"]), [])

    def test_other_plots_and_the_page_of_a_study_are_compared(self):
        self.found_after(lambda run: (run / "forces.png").write_text("other forces"), "forces.png: only in")
        for folder in (self.a, self.again()):
            shutil.copytree(folder, folder / "runs" / "1f")
            for of_run in (folder, folder / "runs" / "1f"):
                (of_run / "report.html").write_text(folder.name)
            (folder / "sweep.csv").write_text("run,state,wall_s\n1,done,1.0\n")
        self.found("report.html: differs from byte 0")

    def compared(self, *folders, **environment):
        return subprocess.run([sys.executable, pathlib.Path(__file__).with_name("compare_runs.py"), *folders],
                              capture_output=True, text=True,
                              env={**os.environ, **environment})

    def test_a_missing_module_is_told_in_one_line(self):
        self.assertEqual(self.compared(self.a, self.b).returncode, 0)
        for module in ("h5py", "numpy"):  # as with a Python that lacks it
            place = self.a.with_name(module)
            place.mkdir()
            (place / f"{module}.py").write_text(f"raise ImportError('No module named {module}', name='{module}')")
            done = self.compared(self.a, self.b, PYTHONPATH=str(place))
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertRegex(done.stderr,
                             rf"^compare_runs.py: the Python module (h5py|{module}) is missing, expected "
                             rf"[^\n]*/usr/bin/python3\n$")


if __name__ == "__main__":
    unittest.main()
