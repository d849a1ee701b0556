#!/usr/bin/python3
"""HDF5 files and results of strangers: no memory beyond the file's size, no other file, one message; and summaries,
frames and height fields of any content before `furrow report`."""
import os
import resource
import subprocess

import h5py
import numpy as np

from program import PROGRAM, ROOT, SystemTest, changed, furrow, main, write_json, write_scenario

ENOUGH = 2 << 30  # bytes of address space; a bomb asks for more
PACKAGE = ROOT / "scripts" / "python" / "furrow"


def positions(file, name="position"):
    file[name] = np.array([[0.1, 0.0, 0.05], [0.3, 0.0, 0.05]])


class Beds(SystemTest):
    def setUp(self):
        super().setUp()
        self.scenario = write_scenario(self.folder, changed(terrain={"bed": "bed.h5"}))

    def made(self):
        return h5py.File(self.folder / "bed.h5", "w")

    def refused(self, expected, commands=("validate", "bed", "run")):
        for command in commands:
            done = subprocess.run([PROGRAM, command, str(self.scenario)], cwd=self.folder, capture_output=True,
                                  text=True, timeout=60, stdin=subprocess.DEVNULL,
                                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (ENOUGH, ENOUGH)))
            lines = done.stderr.splitlines()
            self.assertIn(done.returncode, (2, 5), done.stderr)
            self.assertEqual(done.stdout, "")
            self.assertEqual(len(lines), 1, done.stderr)
            self.assertTrue(lines[0].startswith("furrow: error: "), lines[0])
            self.assertIn(str(self.folder / "bed.h5"), lines[0])
            self.assertIn(expected, lines[0])

    def test_what_h5py_writes_by_itself_is_a_bed(self):
        with self.made() as file:
            file.create_dataset("position", data=np.array([[0.1, 0.0, 0.05], [0.3, 0.0, 0.05]]),
                                compression="gzip", shuffle=True)
        self.furrow("validate", self.scenario)

    def test_declared_huge_positions(self):
        with self.made() as file:
            file.create_dataset("position", shape=(4 * 10 ** 8, 3), dtype="f8", chunks=(1024, 3))
        self.refused("'position' is said to have 9600000000 bytes, but 0 are stored")

    def test_attribute_of_a_thousand_numbers(self):
        with self.made() as file:
            positions(file)
            file.attrs["format_version"] = np.ones(1000, "i8")
        self.refused("holds the attribute 'format_version' as something else than one number", commands=("bed",))

    def test_texts_for_numbers(self):
        with self.made() as file:
            file["position"] = [["x", "y", "z"]]
        self.refused("dataset 'position'': expected N × 3 numbers, m")

    def test_cut_short_anywhere(self):
        with self.made() as file:
            positions(file)
        whole = (self.folder / "bed.h5").read_bytes()
        for length in range(8, len(whole), 97):
            (self.folder / "bed.h5").write_bytes(whole[:length])
            self.refused("bed.h5", commands=("bed",))


class Reports(SystemTest):
    """What python3 -m furrow report says of results that are none; it is what `furrow report` runs."""

    def setUp(self):
        super().setUp()
        self.run = self.folder / "run"
        (self.run / "frames").mkdir(parents=True)
        write_json(self.run / "scenario.json", changed())
        self.summary({})

    def summary(self, values):
        usual = {"format_version": 1, "scenario": "small", "terrain_engine": "dem", "law": "mindlin", "slip": 0.3,
                 "vertical_load_N": 4600.0,
                 "drawbar_pull_N": {"mean": 100.0, "sem": 5.0, "from_s": 0.02, "to_s": 0.05, "steady": True},
                 "net_terrain_force_N": [100.0, 0.0, 4600.0], "surface_height_m": 0.1}
        write_json(self.run / "summary.json", {**usual, **values})

    def report(self, *arguments, **expected):
        done = subprocess.run(["/usr/bin/python3", PACKAGE, "report", str(self.run), *arguments],
                              capture_output=True, text=True, timeout=120,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (2 * ENOUGH, 2 * ENOUGH)),
                              env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})
        return self.expect(done, **expected)

    def told(self, expected, *arguments):
        return self.report(*arguments, code=5, says=expected, lacks="Traceback").stderr

    def test_wrong_types_in_the_summary_are_named(self):
        for values, expected in (({"drawbar_pull_N": 3}, "key 'drawbar_pull_N': is 3, expected an object"),
                                 ({"drawbar_pull_N": {"mean": "much"}},
                                  "summary.json: key 'drawbar_pull_N': key 'mean': is \"much\", expected a number"),
                                 ({"drawbar_pull_N": {"mean": 1.0}}, "lacks from_s and to_s"),
                                 ({"drawbar_pull_N": {"mean": 10 ** 400}}, "expected a number"),
                                 ({"wheels": [3]}, "key 'wheels.0': is 3, expected an object"),
                                 ({"wheels": 3}, "key 'wheels': is 3, expected a list"),
                                 ({"slip": [1]}, "key 'slip': is [1], expected a number"),
                                 ({"scenario": {}}, "key 'scenario': is {}, expected a text"),
                                 ({"net_terrain_force_N": 3}, "key 'net_terrain_force_N': is 3, expected a list"),
                                 ({"accounts": {"energy": 3}}, "key 'energy': is 3, expected an object")):
            with self.subTest(values):
                self.summary(values)
                lines = [line for line in self.told(expected).splitlines() if line.startswith("furrow: error: ")]
                self.assertEqual(len([line for line in lines if "nothing to plot" not in line]), 1, lines)

    def test_the_command_says_once_why_there_are_no_plots(self):
        self.summary({"drawbar_pull_N": 3})
        (self.folder / "empty").mkdir()
        write_json(self.folder / "empty" / "scenario.json", changed())
        taken = self.folder / "taken"
        taken.mkdir()
        (taken / ".furrow-run").write_text("furrow-run 1\n")
        (taken / "report.html").write_text("the user's own")
        (self.run / "timeseries.csv").write_text("time_s,position_m\n0,0\n1,1\n")
        for arguments, expected in (([self.run], "key 'drawbar_pull_N': is 3, expected an object"),
                                    ([self.folder / "empty"], "holds nothing to plot"),
                                    ([self.folder / "empty", self.run, "--out", "both"], "holds no results of a run")):
            with self.subTest(arguments):
                self.furrow("report", *arguments, code=5, prints="", says=expected, errors=1)
        self.summary({})
        done = furrow("report", self.run, self.run, "--out", taken, cwd=self.folder)
        self.assertEqual((done.returncode, done.stdout, done.stderr.count("furrow: error: ")), (5, "", 1), done.stderr)
        self.assertIn("taken/report.html: was not written", done.stderr)
        self.assertEqual((taken / "report.html").read_text(), "the user's own")

    def test_a_table_that_was_cut_short_is_told(self):
        table = self.run / "timeseries.csv"
        table.write_text("time_s,position_m\n" + "".join(f"{k / 100},0\n" for k in range(1, 101)))
        for end, lines, told in ((1.0, 101, False), (1.0, 50, True), (1.0, 1, False)):
            self.summary({"end_time_s": end})
            table.write_text("\n".join(table.read_text().split("\n")[:lines]) + "\n0.5")
            done = self.report("--only", "forces", code=5)
            words = "the table of the wheel ends at 0.49 s and the run at 1 s: it was cut short"
            self.assertEqual(words in done.stderr, told, done.stderr)

    def test_summary_that_is_none(self):
        for text in ("[1, 2]", "{", "", '{"a": ' + "[" * 100000 + "]" * 100000 + "}"):
            (self.run / "summary.json").write_text(text)
            self.told("summary.json")

    def test_nothing_was_measured(self):
        self.summary({"net_terrain_force_N": [0.0, 0.0, 0.0],
                      "drawbar_pull_N": {"mean": 0.0, "sem": 0.0, "from_s": 0.0, "to_s": 0.01}})
        self.assertNotIn("0.0 ± 0.0", self.told("nothing was measured"))

    def test_reasons_are_shown_and_not_obeyed(self):
        self.summary({"drawbar_pull_N": {"mean": 1.0, "from_s": 0.0, "to_s": 0.01,
                                         "unsteady_because": ["\x1b]0;owned\x07"]}})
        self.assertNotIn("\x1b", self.told("NOT STEADY: \\x1b]0;owned\\x07"))

    def test_height_fields_that_are_none(self):
        (self.run / "timeseries.csv").write_text("time_s,position_m\n0,0\n1,1\n")

        def tell(make, expected):
            with h5py.File(self.run / "results.h5", "w") as file:
                for when in ("before", "after"):
                    make(file, f"terrain/height_{when}")
                    file[f"terrain/height_{when}_grid"] = [0.0, 0.0, 0.1]
            self.told("report: no rut.png: " + expected, "--only", "rut")

        tell(lambda file, name: file.create_dataset(name, shape=(10 ** 6, 10 ** 6), dtype="f8", chunks=(1, 1024)),
             "results.h5: the dataset 'terrain/height_before' is said to have 1000000000000 numbers, but 0 bytes are "
             "stored")
        tell(lambda file, name: file.__setitem__(name, ["a", "b"]),
             "results.h5: the dataset 'terrain/height_before' holds no plain numbers")
        tell(lambda file, name: file.__setitem__(name, [1.0, 2.0]), "results.h5 holds no height field")

    def test_frames_that_are_none(self):
        triangle = np.array([[0, 1, 2]])
        vertex = np.array([[0.0, 0, 0], [1, 0, 0], [0, 0, 1]])
        for content, expected in (
                ({"position": vertex, "triangle": triangle + 7}, "holds no surface that could be drawn"),
                ({"position": vertex * np.nan, "triangle": triangle}, "holds no surface that could be drawn"),
                ({"position": vertex[:, :2], "triangle": triangle}, "has the shape (3, 2), expected N × 3"),
                ({"position": vertex}, "the dataset 'triangle' is missing")):
            with h5py.File(self.run / "frames" / "tire0_000000.h5", "w") as file:
                file.attrs["time_s"] = 0.0
                for name, values in content.items():
                    file[name] = values
            self.told("tire0_000000.h5", "--only", "scene")
            self.told(expected, "--only", "scene")
        (self.run / "frames" / "tire0_000000.h5").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(500))
        self.told("is damaged", "--only", "scene")


if __name__ == "__main__":
    main()
