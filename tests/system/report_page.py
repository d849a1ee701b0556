#!/usr/bin/python3
"""report.html of runs of known contents: what it holds, that it asks for nothing from outside, and that its frames are
those of the run."""
import base64
import json
import pathlib
import re
import shutil
import sys
import unittest
import zlib

import h5py
import numpy as np

from program import ROOT, SystemTest, main, read_json, write_json, write_scenario

sys.path.insert(0, str(ROOT / "scripts" / "python"))
from furrow import page  # noqa: E402
from furrow.page import frames  # noqa: E402
from furrow.page.blobs import Arrays, thin  # noqa: E402
from furrow.plot import own_files  # noqa: E402
from furrow.plot.press import Press  # noqa: E402
from furrow.plot.run_data import Run  # noqa: E402
from furrow.plot.sweep import Sweep  # noqa: E402

FRAMES, GRAINS, STEP = 5, 900, 0.05
RADIUS = 0.02

# What accounts and ranks are drawn from.
ACCOUNTED = {"accounts": {"energy": {"closes": True, "residual_share": 1e-4, "turnover": 100.0, "residual": 0.01,
                                     "work": {"drive_work": 90.0}}},
             "ranks": [{"rank": 0, "node": "rig", "threads": 1, "compute_s": 1.0, "wait_s": 3.0, "cpu_s": 1.0,
                        "busy_share": 0.25}]}


def document(path):
    """(description of the page, bytes of its element `name`)."""
    text = path.read_text(encoding="utf-8")

    def element(name):
        return re.search(rf'<script type="[^"]*" id="{name}">([^<]*)</script>', text)[1]
    return json.loads(element("document")), lambda name: zlib.decompress(base64.b64decode(element(name)))


def planes(data, count, size):
    """Numbers whose bytes stand by significance."""
    return np.frombuffer(data, np.uint8)[:count * size].reshape(size, count).T.copy()


def array(about, numbers, which):
    first, count = about["arrays"][which]
    return planes(numbers[4 * first:4 * (first + count)], count, 4).view("<f4").ravel()


def blocks_of(about, kind):
    return [block for section in about["sections"] for block in section["blocks"] if block["type"] == kind]


def wheel(turned, shift, dent):
    """A coarse cylinder, turned about y, with one dented point."""
    angle = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    points = np.array([[0.4 * np.cos(a + turned), y, 0.4 * np.sin(a + turned)] for a in angle for y in (-0.1, 0.1)])
    points[7] *= 1 - dent
    triangle = [t for k in range(24) for a in [2 * k] for b in [2 * ((k + 1) % 24)]
                for t in ((a, b, a + 1), (a + 1, b, b + 1))]
    return points + shift, np.array(triangle)


def known_run(folder, count=FRAMES, grains=GRAINS, shake=0.0):
    """A run of known contents; the positions of its grains by frame. `shake`: how far every grain moves at random
    between frames, m, which no packing makes small."""
    (folder / "frames").mkdir(parents=True)
    write_json(folder / "scenario.json", {"description": "</script><img src=x onerror=alert(1)>",
                                                      "rig": {"slip": 0.2}, "run": {"end": 1.5, "average_from": 0.1},
                                                      "expected": {"drawbar_pull": 100.0, "drawbar_pull_spread": 5.0}})
    write_json(folder / "summary.json", {
        "scenario": "known", "slip": 0.2, "simulated_s": 0.25, "net_terrain_force_N": [100.0, 0.0, 4000.0],
        "terrain_engine": "dem",
        "drawbar_pull_N": {"mean": 110.0, "sem": 4.0, "n_eff": 9.0, "steady": False, "unsteady_because": ["it drifts"],
                           "from_s": 0.1, "to_s": 0.25},
        "ranks": [{"rank": 0, "node": "rig", "threads": 1, "busy_share": 0.25}]})
    time = np.arange(0, 0.25, 1e-3)
    (folder / "timeseries.csv").write_text("time_s,drawbar_pull_N,sinkage_m\n"
                                           + "".join(f"{t},{100 * t},{t}\n" for t in time))
    chance = np.random.default_rng(1)
    position = np.column_stack([chance.uniform(0, 2, grains), chance.uniform(-0.3, 0.3, grains), np.full(grains, 0.05)])
    kept = []
    for k in range(count):
        position[:grains // 3, 2] -= 0.004  # a third sinks
        position[-1, 0] += 1e-4  # and one creeps
        if shake:
            position[:, :2] += chance.normal(0.0, shake, (grains, 2))
        kept.append(position.astype("f4"))
        with h5py.File(folder / "frames" / f"terrain_{k:06d}.h5", "w") as file:
            file.attrs["time_s"] = STEP * k
            file["position"], file["radius"] = kept[-1], np.full(grains, RADIUS, "f4")
            file["speed"] = np.linspace(0, 1, grains, dtype="f4")
        with h5py.File(folder / "frames" / f"tire0_{k:06d}.h5", "w") as file:
            points, triangle = wheel(0.7 * k, [0.5 + 0.1 * k, 0.0, 0.5], 0.02 * k)
            file.attrs["time_s"] = STEP * k
            file["position"], file["triangle"] = points.astype("f4"), triangle.astype("i4")
            file["force"] = np.tile([3.0, 0.0, 4.0], (len(points), 1)).astype("f4")
            file["velocity"] = np.zeros((len(points), 3), "f4")
            file["strain"] = np.full(len(points), 0.02, "f4")
    return kept


class Packing(unittest.TestCase):
    def test_arrays_come_back_to_15_bits_or_exactly(self):
        arrays, values = Arrays(), np.array([1.0, np.pi, -1e-7, np.nan, 0.0])
        numbers = [arrays.add(values), arrays.add(values, exact=True), arrays.add(values)]
        self.assertEqual(numbers, [0, 1, 0])  # the same array is stored once
        data, about = zlib.decompress(base64.b64decode(arrays.base64())), {"arrays": arrays.places}
        np.testing.assert_allclose(array(about, data, 0), values, rtol=3.1e-5)
        np.testing.assert_array_equal(array(about, data, 1), values.astype("f4"))

    def test_thinned_curves_keep_their_extremes(self):
        time = np.arange(100000.0)
        values = np.sin(time)
        values[54321], values[77777] = 9.0, -7.0
        at, columns, bucket = thin(time, {"a": values})
        self.assertEqual((columns["a"].max(), columns["a"].min()), (9.0, -7.0))
        self.assertLessEqual(len(at), 3000)
        self.assertEqual(len(at), len(columns["a"]))
        self.assertGreater(bucket, 60)


class Page(SystemTest):
    def setUp(self):
        super().setUp()
        self.run_folder = self.folder / "run"
        self.positions = known_run(self.run_folder)

    def page_of(self, kind, folder):
        """What `document` says of the page of a folder."""
        self.assertEqual(page.write(folder, [kind(folder)], lambda *_: True), ["report.html"])
        return document(folder / "report.html")

    def page_of_run(self):
        return self.page_of(Run, self.run_folder)

    def study(self, table, name="study", **asked):
        folder = self.folder / name
        folder.mkdir(parents=True)
        write_json(folder / "sweep.json", {"study": "slips", "plot": {}, "results": [], **asked})
        (folder / "sweep.csv").write_text(table)
        return folder

    def test_it_asks_for_nothing_from_outside_and_runs_nothing_of_the_results(self):
        self.page_of_run()
        text = (self.run_folder / "report.html").read_text(encoding="utf-8")
        self.assertIn("default-src 'none'", text)
        self.assertNotRegex(text.split("<script")[0], r"(src|href)\s*=")
        self.assertNotIn("<img", text)
        self.assertEqual(text.count("</script>"), text.count("<script"))

    def test_answer_expectation_and_defaults(self):
        about, _ = self.page_of_run()
        words = " ".join(block["text"] for block in blocks_of(about, "text"))
        # 2.306 standard errors of 4 N, 8 degrees of freedom
        self.assertIn("110.0 ± 9.2 N at 20 % slip (95 % interval", words)
        self.assertIn("Not steady: it drifts", words)
        self.assertIn("differs from what the scenario's author expects", words)
        scenario = next(section for section in about["sections"] if section["id"] == "scenario")["blocks"][-1]
        marked = {scenario["rows"][k][0] for k in scenario["marked"]}
        self.assertIn("rig.slip", marked)  # 0.2, the default is 0.3
        self.assertNotIn("run.end", marked)  # 1.5 is the default
        self.assertEqual(about["badges"], [{"text": "not steady", "kind": "warn"}])

    def test_curves_are_those_of_the_table(self):
        about, part = self.page_of_run()
        (pull,) = (chart for block in blocks_of(about, "charts") for chart in block["charts"]
                   if chart["title"] == "Drawbar pull")
        self.assertEqual((pull["unit"], pull["window"]), ("N", [0.1, 0.25]))
        x, y = (array(about, part("numbers"), pull["lines"][0][axis]) for axis in "xy")
        np.testing.assert_allclose(y, 100 * x, rtol=1e-4, atol=1e-6)

    def test_grains_and_tires_are_where_the_frames_have_them(self):
        about, part = self.page_of_run()
        (block,) = blocks_of(about, "playback")
        bed, numbers = block["bed"], part("numbers")
        self.assertEqual(bed["grains"], GRAINS)
        np.testing.assert_allclose(block["times"], STEP * np.arange(FRAMES))
        data, at, last = part("grains"), 0, np.zeros((GRAINS, 3), np.uint16)
        for k in range(FRAMES):
            for axis in range(3):
                last[:, axis] += planes(data[at:at + 2 * GRAINS], GRAINS, 2).view("<u2").ravel()
                at += 2 * GRAINS
            at += GRAINS  # speeds
            off = np.linalg.norm(last * bed["scale"] + bed["low"] - self.positions[k], axis=1)
            self.assertLess(off.max(), frames.STILL * RADIUS + np.linalg.norm(bed["scale"]))
        self.assertEqual(at, len(data))
        tire, data = block["tires"][0], part("tires")
        count = tire["vertices"]
        reference = array(about, numbers, tire["reference"]).reshape(-1, 3)
        poses = array(about, numbers, block["poses"]).reshape(FRAMES, 15)
        for k in range(FRAMES):
            at = 9 * count * k  # positions, force, speed, strain
            deviation = np.column_stack([planes(data[at + 2 * count * a:at + 2 * count * (a + 1)],
                                                count, 2).view("<i2").ravel() for a in range(3)])
            shown = reference @ poses[k, :9].reshape(3, 3).T + poses[k, 9:12] + tire["quantum"] * deviation
            points, _ = wheel(0.7 * k, [0.5 + 0.1 * k, 0.0, 0.5], 0.02 * k)
            np.testing.assert_allclose(shown, points, atol=tire["quantum"])
            np.testing.assert_allclose(poses[k, 12:], [5.0, 0.0, 0.02], rtol=1e-6)

    def test_frames_are_left_out_until_the_rest_fits(self):
        run = Run(self.run_folder)
        whole = frames.pack(run, 1e9)
        part = frames.pack(run, 0.6 * whole.size)
        self.assertEqual(whole.indices, list(range(FRAMES)))
        self.assertIn(len(part.indices), (1, 2, 3))
        self.assertEqual(part.indices[-1], FRAMES - 1)

    def test_a_failed_run_and_one_without_frames(self):
        (self.run_folder / "summary.json").unlink()
        failed = {"scenario": "known", "failed": {"error": "too hard", "time_s": 0.2}}
        write_json(self.run_folder / "summary_failed.json", failed)
        for path in (self.run_folder / "frames").iterdir():
            path.unlink()
        self.furrow("report", self.run_folder, prints=f"{self.run_folder}/report.html\n")
        about, _ = document(self.run_folder / "report.html")
        self.assertEqual(about["badges"], [{"text": "failed", "kind": "bad"}])
        self.assertIn("failed at t = 0.2 s: too hard", " ".join(block["text"] for block in blocks_of(about, "text")))
        self.assertIn("playback: there are no frames", " ".join(about["left_out"]))

    def test_accounts_and_ranks_of_a_failed_run_are_shown(self):
        (self.run_folder / "summary.json").unlink()
        shutil.rmtree(self.run_folder / "frames")
        write_json(self.run_folder / "summary_failed.json", {
            "scenario": "known", "failed": {"error": "too hard", "time_s": 0.2}, **ACCOUNTED})
        done = self.furrow("report", self.run_folder)
        names = {pathlib.Path(name).name for name in done.stdout.splitlines()}
        self.assertLessEqual({"energy.png", "ranks.png", "report.html"}, names, done.stderr)
        self.assertIn("no momentum.png: summary_failed.json has no account of momentum", done.stderr)
        about, _ = document(self.run_folder / "report.html")
        words = " ".join(block["text"] for block in blocks_of(about, "text"))
        self.assertIn("The account of energy closes. 0.0100 % of what was turned over", words)
        self.assertIn("Rank 0 · rig sets the pace", words)
        self.assertIn("failed at t = 0.2 s: too hard", words)

    def test_several_runs_beside_each_other(self):
        other = self.folder / "other"
        known_run(other)
        write_json(other / "scenario.json", {"rig": {"slip": 0.25}})
        self.furrow("report", self.run_folder, other, code=2, says="'--out'")
        (self.folder / "file").write_text("")
        for runs in ([self.run_folder], [self.run_folder, other]):
            self.furrow("report", *runs, "--out", "file", code=2,
                        says="furrow: error: file: is a file, expected a folder")
        self.furrow("report", self.run_folder, other, "--out", "both", prints="both/report.html\n")
        about, _ = document(self.folder / "both" / "report.html")
        tables = blocks_of(about, "table")
        self.assertEqual(tables[0]["rows"][0], ["drawbar pull", "110.0 ± 9.2", "110.0 ± 9.2", "N"])
        self.assertIn(["rig.slip", "0.2", "0.25"], tables[1]["rows"])
        (pull,) = (chart for chart in blocks_of(about, "charts")[1]["charts"] if chart["title"] == "Drawbar pull")
        self.assertEqual([line["label"] for line in pull["lines"]], ["run", "other"])

    def test_a_table_of_a_study_that_is_none_is_named(self):
        self.furrow("report", self.study("garbage\n"), code=5,
                    says="sweep.csv has no column 'folder', expected the table that furrow sweep wrote")

    def test_the_page_of_a_study_does_not_tell_how_long_its_runs_took(self):
        pages = []
        for wall in ("1.25", "12.5"):
            study = self.study("folder,state,exit_code,rig.slip,sinkage_m,wall_s\n"
                               f"runs/1,done,0,0.2,0.021,{wall}\n", f"{wall}/study", results=["sinkage_m", "wall_s"])
            about, _ = self.page_of(Sweep, study)
            pages.append((study / "report.html").read_bytes())
        self.assertEqual(*pages)
        (table,) = blocks_of(about, "table")
        self.assertEqual(table["columns"][3:], ["rig.slip", "sinkage, mm"])
        self.assertEqual(table["rows"], [["runs/1", "done", "0", "0.2", "21"]])

    def test_the_page_of_a_study_says_what_it_is_about_and_its_keys_have_units(self):
        results = ["drawbar_pull_N.mean", "drawbar_pull_N.sem", "drawbar_pull_N.steady"]
        study = self.study(f"folder,state,exit_code,rig.slip,terrain.cohesion,{','.join(results)}\n"
                           "runs/1,done,0,0.2,40000.0,120,4,true\nruns/2,done,0,0.3,40000.0,130,5,false\n",
                           description="Two soils.", results=results,
                           plot={"x": "rig.slip", "y": results[0], "error": results[1], "lines": "terrain.cohesion"})
        about, _ = self.page_of(Sweep, study)
        self.assertEqual([block["text"] for block in blocks_of(about, "text")],
                         ["Two soils.",
                          "1 of 2 points include a run whose pull is not steady: such a point is not to be quoted."])
        (charts,) = blocks_of(about, "charts")
        self.assertEqual(charts["note"], "Whiskers: standard error of each run.")
        self.assertEqual([line["label"] for line in charts["charts"][0]["lines"]], ["terrain.cohesion = 40000 Pa"])
        (table,) = blocks_of(about, "table")
        self.assertEqual(table["columns"][3:], ["rig.slip", "terrain.cohesion, Pa", "drawbar pull, N",
                                                "drawbar pull standard error, N", "drawbar pull steady"])
        self.assertEqual(table["rows"][0][4:], ["40000", "120", "4", "true"])

    def test_all_values_of_a_pressed_tire_have_units(self):
        folder = self.folder / "press"
        folder.mkdir()
        write_json(folder / "summary.json", {
            "obstacle": "plate", "load_N": 4600.0, "deflection_m": 0.0128, "pressure_Pa": 2e5,
            "statically_stable": True,
            "sticking_stiffness": {"lateral_N_per_m": 1.5e5, "torsional_Nm_per_rad": 2500.0}})
        (folder / "press.csv").write_text("deflection_m,force_N,unloading\n"
                                         "0,0,0\n0.01,3000,0\n0.02,7000,0\n0.01,2990,1\n0,0,1\n")
        about, part = self.page_of(Press, folder)
        rows = blocks_of(about, "table")[-1]["rows"]
        for row in (["load", "4600", "N"], ["deflection", "12.8", "mm"],
                    ["pressure", "200", "kPa"], ["statically stable", "yes", ""],
                    ["sticking stiffness lateral", "150", "kN/m"], ["sticking stiffness torsional", "2500", "N m/rad"]):
            self.assertIn(row, rows)
        loading, unloading = blocks_of(about, "charts")[0]["charts"][0]["lines"]
        self.assertEqual(len(unloading["dash"]), 2, "it mostly lies on the curve of loading")
        np.testing.assert_allclose(array(about, part("numbers"), unloading["x"]), [0, 10])
        np.testing.assert_allclose(array(about, part("numbers"), loading["y"]), [0, 3, 7], rtol=1e-4)

    def test_frames_as_vtp_files(self):
        out = self.folder / "vtk"
        done = self.furrow("report", self.run_folder, "--vtk", out)
        self.assertEqual(done.stdout.splitlines()[:2], [str(out / "tire0.pvd"), str(out / "terrain.pvd")])
        self.assertEqual(len(list(out.glob("*.vtp"))), 2 * FRAMES)
        listed = re.findall(r'timestep="([^"]+)" file="([^"]+)"', (out / "terrain.pvd").read_text())
        self.assertEqual([name for _, name in listed], [f"terrain_{k:06d}.vtp" for k in range(FRAMES)])
        np.testing.assert_allclose([float(time) for time, _ in listed], STEP * np.arange(FRAMES))
        packed = re.search(r'Name="position" NumberOfComponents="3" format="binary">([^<]+)<',
                           (out / listed[-1][1]).read_text())[1]
        head = np.frombuffer(base64.b64decode(packed[:44]), "<u8")  # 32 bytes: blocks, bytes, rest, bytes compressed
        np.testing.assert_array_equal(np.frombuffer(zlib.decompress(base64.b64decode(packed[44:])),
                                                    "<f4").reshape(-1, 3), self.positions[-1])
        self.assertEqual(list(head[:3]), [1, self.positions[-1].nbytes, 0])
        again = self.furrow("report", self.run_folder, "--vtk", out, "--quiet", code=2)
        self.assertEqual(again.stderr, f"furrow: error: command line: key '--vtk': {out} exists and is not an empty "
                         "folder, expected a new one\n")
        damaged = self.run_folder / "frames" / "terrain_000001.h5"
        damaged.write_bytes(b"")
        self.furrow("report", self.run_folder, "--vtk", self.folder / "part", code=5,
                    says=f"furrow: error: {damaged}: ")
        self.assertEqual(list((self.folder / "part").iterdir()), [])
        for frame in (self.run_folder / "frames").iterdir():
            frame.unlink()
        self.furrow("report", self.run_folder, "--vtk", self.folder / "none", code=2,
                    says="has no frames, expected a run with output.frame_interval above 0")
        self.assertFalse((self.folder / "none").exists())


class OwnFiles(SystemTest):
    """Files of the user's own at the places of plots and of the page."""

    def setUp(self):
        super().setUp()
        self.run_folder, self.out = self.folder / "run", self.folder / "own"
        known_run(self.run_folder, count=0)
        # two plots that are quickly drawn: ranks.png and energy.png
        write_json(self.run_folder / "summary.json", {**read_json(self.run_folder / "summary.json"), **ACCOUNTED})
        self.out.mkdir()

    def report(self, *arguments, **expected):
        done = self.furrow("report", *arguments, **expected)
        return [pathlib.Path(line).name for line in done.stdout.splitlines()]

    def parts(self):
        return list(self.folder.rglob(".*.part"))

    def test_a_page_in_the_folder_of_a_run_stays(self):
        (self.run_folder / ".furrow-run").write_text("furrow-run 1\nsummary.json\n")
        (self.run_folder / "report.html").write_text("mine")
        self.report("run", says=["no report.html: furrow did not write the file of that name in this folder"])
        self.assertEqual((self.run_folder / "report.html").read_text(), "mine")

    def test_they_stay_in_any_folder_and_the_rest_can_be_made_again(self):
        mine = ("report.html", "rut.png", "ranks.png", ".report.html.part")
        for name in mine:
            (self.out / name).write_text("mine")
        told = [f"no {name}: furrow did not write the file of that name in this folder"
                for name in ("report.html", "ranks.png")]
        made = self.report("run", "--out", "own", says=told)
        self.assertEqual(made, ["energy.png"])
        (self.out / "energy.png").write_text("of an earlier report")
        self.assertEqual(self.report("run", "--out", "own", says=told), made)
        self.assertTrue((self.out / "energy.png").read_bytes().startswith(b"\x89PNG"))
        self.assertEqual([(self.out / name).read_text() for name in mine], ["mine"] * len(mine))
        self.assertEqual({path.name for path in self.out.iterdir()}, {*mine, *made, ".furrow-report"})

    def test_they_stay_where_runs_are_compared(self):
        (self.out / "report.html").write_text("mine")
        self.report("run", "run", "--out", "own", code=5, says=["own/report.html: was not written"])
        self.assertEqual([path.name for path in self.out.iterdir()], ["report.html"])
        self.assertEqual((self.out / "report.html").read_text(), "mine")
        for _ in range(2):
            self.assertEqual(self.report("run", "run", "--out", "new"), ["report.html"])
        self.assertGreater((self.folder / "new" / "report.html").stat().st_size, 10000)

    def test_where_all_names_are_taken_it_is_told(self):
        made = self.report("run", "--out", "other")
        self.assertEqual(made, ["ranks.png", "energy.png", "report.html"])
        for name in made:
            (self.out / name).write_text("mine")
        self.report("run", "--out", "own", code=5,
                    says=["own: no plot was written, as other files have their names, expected another folder"])
        self.assertEqual({path.name for path in self.out.iterdir()}, set(made))

    def test_links_are_neither_followed_nor_replaced(self):
        (self.folder / "precious").write_text("precious")
        self.report("run", "--out", "own")
        (self.run_folder / ".furrow-run").write_text("furrow-run 1\nsummary.json\nenergy.png\nreport.html\n")
        for folder, arguments in ((self.run_folder, ["run"]), (self.out, ["run", "--out", "own"])):
            with self.subTest(folder.name):
                for name, to in (("energy.png", "precious"), ("report.html", "nowhere")):
                    (folder / name).unlink(missing_ok=True)
                    (folder / name).symlink_to(self.folder / to)
                made = self.report(*arguments, says=[
                    f"no {name}: the file of that name in this folder is a link, which furrow does not follow"
                    for name in ("energy.png", "report.html")])
                self.assertEqual(made, ["ranks.png"])
                self.assertTrue((folder / "energy.png").is_symlink() and (folder / "report.html").is_symlink())
                self.assertEqual((self.folder / "precious").read_text(), "precious")
                self.assertFalse((self.folder / "nowhere").exists())
        self.assertEqual(self.parts(), [])

    def test_plots_make_no_run_of_a_folder(self):
        (self.out / "notes.txt").write_text("mine")
        self.report("run", "--out", "own")
        names = {path.name for path in self.out.iterdir()}
        self.furrow("run", write_scenario(self.folder), "--out", "own", "--overwrite", code=2,
                    says="own: key '--out': holds no run's list of its files (.furrow-run)")
        self.assertEqual({path.name for path in self.out.iterdir()}, names)

    def test_a_list_that_was_cut_short_or_is_a_link(self):
        listed = self.out / ".furrow-run"
        listed.write_text("furrow-run 1\nold.png\nfurrow-run 1\nrun.log\nenergy.p")
        self.assertTrue(own_files.may_write(self.out, "energy.png"))
        self.assertEqual(listed.read_text(), "furrow-run 1\nold.png\nfurrow-run 1\nrun.log\nenergy.png\n")
        self.assertEqual(own_files.names_in(listed), ["run.log", "energy.png"])
        listed.write_text("")  # killed before its first line
        self.assertTrue(own_files.may_write(self.out, "energy.png"))
        self.assertEqual(listed.read_text(), "furrow-run 1\nenergy.png\n")
        listed.unlink()
        (self.folder / "precious").write_text("precious\n")
        (self.out / ".furrow-report").symlink_to(self.folder / "precious")
        with self.assertRaises(OSError):
            own_files.may_write(self.out, "energy.png")
        self.assertEqual((self.folder / "precious").read_text(), "precious\n")

    def test_a_file_that_cannot_be_written_leaves_the_earlier_one(self):
        picture = self.out / "energy.png"
        picture.write_bytes(b"earlier")
        with self.assertRaises(TypeError):
            own_files.write_whole(picture, None)
        self.assertEqual((picture.read_bytes(), self.parts()), (b"earlier", []))


if __name__ == "__main__":
    main()
