#!/usr/bin/python3
"""scripts/python/furrow as users import it, and results in xarray without it. Exit code 77: its Debian packages are
missing (scripts/setup.sh --python)."""
import doctest
import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys

from program import ROOT, SMALL, SystemTest, changed, main, read_json, write_scenario

NEEDED = ("pandas", "xarray", "h5netcdf")
if not all(importlib.util.find_spec(name) for name in NEEDED):
    print(f"skipped: needs Debian's {', '.join(f'python3-{name}' for name in NEEDED)}")
    sys.exit(77)
sys.path.insert(0, str(ROOT / "scripts" / "python"))
os.environ.setdefault("MPLBACKEND", "Agg")

import matplotlib.image  # noqa: E402
import numpy as np  # noqa: E402
import xarray as xr  # noqa: E402

STYLE = dict(matplotlib.rcParams)
import furrow  # noqa: E402
from furrow import units  # noqa: E402


class Package(SystemTest):
    """One small run that all look at."""

    @classmethod
    def setUpClass(cls):
        import tempfile
        cls.holder = tempfile.TemporaryDirectory(prefix="furrow test ")
        cls.addClassCleanup(cls.holder.cleanup)
        cls.path = pathlib.Path(cls.holder.name) / "out"
        cls.run_ = furrow.run(SMALL, out=cls.path, progress=False, rig__slip=0.4,
                              run__end=0.1, output__frame_interval=0.05)

    def test_a_run_is_what_its_files_say(self):
        run = self.run_
        self.assertEqual(run.state, "done")
        self.assertIsNone(run.failure)
        self.assertEqual(run.summary, read_json(self.path / "summary.json"))
        self.assertEqual(run.scenario["rig"]["slip"], 0.4)
        self.assertEqual(run.number("drawbar_pull_N.mean"), run.summary["drawbar_pull_N"]["mean"])
        self.assertEqual(run.number("wheels.0.slip"), 0.4)
        self.assertRaisesRegex(TypeError, "the key is 3, expected a text", run.number, 3)
        self.assertRaisesRegex(KeyError, "no key 'pull.mean'", run.number, "pull.mean")
        self.assertRaisesRegex(TypeError, "the key is 3, expected a text", run.number, 3)
        self.assertEqual(run.subjects, ["wheel0", "accounts"])
        series = run.series()
        self.assertEqual((series.index.name, len(series)), ("time_s", 100))
        self.assertEqual(series.attrs["units"]["drawbar_pull_N"], "N")
        self.assertEqual(len(run.wheels), 1)
        self.assertIn("sliding_loss_J", run.accounts.columns)
        self.assertRaisesRegex(furrow.Missing, "no table of 'vehicle', expected one of: wheel0, accounts",
                               lambda: run.vehicle)

    def test_heights_of_a_file_that_was_cut_short_are_damaged(self):
        copy = pathlib.Path(self.holder.name) / "cut"
        shutil.copytree(self.path, copy)
        self.addCleanup(shutil.rmtree, copy)
        (copy / "results.h5").write_bytes((self.path / "results.h5").read_bytes()[:2000])
        self.assertRaisesRegex(furrow.Damaged, "results.h5 cannot be read", lambda: furrow.open(copy).heights)

    def test_packages_that_are_missing_are_named_at_once(self):
        done = self.call([sys.executable, "-c", "import importlib.util as u\nfind = u.find_spec\n"
                          "u.find_spec = lambda name, *more: None if name in ('pandas', 'xarray') else find(name, "
                          "*more)\nimport furrow\nfurrow.open"],
                         env={**os.environ, "PYTHONPATH": str(ROOT / "scripts" / "python")}, code=1)
        self.assertTrue(done.stderr.endswith("ImportError: the package 'furrow' needs what is not installed: "
                                             "apt install python3-pandas python3-xarray\n"), done.stderr)

    def test_frames_are_found_by_index_and_time(self):
        tire, grains = self.run_.tire(), self.run_.grains
        self.assertEqual(len(tire), 3)
        self.assertEqual(tire.at(0.055).index, 1)
        for time in (99, -5, float("nan")):
            self.assertRaisesRegex(ValueError, "expected 0 to 0.1 s", tire.at, time)
            self.assertRaisesRegex(ValueError, "where there are frames", self.run_.footprint, time=time)
        self.assertEqual(tire[-1].time, grains[-1].time)
        self.assertEqual(tire[0].position.shape, tire[0].force.shape)
        self.assertLess(tire[0].triangle.max(), len(tire[0].position))
        self.assertEqual(grains[0].position.shape, (self.run_.summary["grains"], 3))
        self.assertAlmostEqual(float(grains[0].radius.max()), 0.03, places=5)
        self.assertRaisesRegex(furrow.Missing, "has no wheel 3, expected 0 to 0", self.run_.tire, 3)
        patch = self.run_.footprint()
        self.assertGreater(len(patch), 0)
        np.testing.assert_allclose(patch["force_z_N"].sum(), tire[-1].force[:, 2].sum(dtype=float), rtol=1e-5)

    def test_results_open_in_xarray_without_us(self):
        for subject in self.run_.subjects:
            for name, column in xr.open_dataset(self.path / "results.h5", group=f"series/{subject}").variables.items():
                self.assertEqual(column.dims, ("time_s",), name)
                self.assertEqual(column.attrs["units"], units.unit(name), name)
                self.assertEqual(column.attrs["long_name"], units.long_name(name), name)
        alone = xr.open_dataset(self.path / "results.h5", group="series/wheel0").load()
        xr.testing.assert_equal(alone, self.run_.xarray())
        self.assertEqual(alone["slip"].attrs["cell_methods"], "time_s: mean")
        ground = xr.open_dataset(self.path / "results.h5", group="terrain")
        xr.testing.assert_allclose(ground[["height_before", "height_after"]].load(), self.run_.heights, rtol=1e-14)
        self.assertEqual(ground["x_m"].attrs["units"], "m")
        frame = xr.open_dataset(self.path / "frames" / "tire0_000002.h5")
        self.assertEqual((frame["position"].dims, frame["triangle"].dims), (("node", "xyz"), ("face", "corner")))
        np.testing.assert_array_equal(frame["force"], self.run_.tire()[2].force)
        self.assertEqual(xr.open_dataset(self.path / "frames" / "terrain_000000.h5")["speed"].attrs["units"], "m/s")

    def test_plots_are_those_of_the_report_and_leave_the_users_style_alone(self):
        for draw in (furrow.plots.pull_slip_sinkage, furrow.plots.forces,
                     furrow.plots.ranks, furrow.plots.energy, furrow.plots.momentum):
            with self.subTest(draw.__name__):
                self.assertGreater(len(draw(self.run_).axes), 0)
                matplotlib.pyplot.close()
        self.assertEqual({key: value for key, value in matplotlib.rcParams.items() if STYLE[key] != value}, {})

    def test_vtk_files_hold_the_frames(self):
        folder = self.run_.write_vtk(self.folder / "vtk")
        self.assertEqual(len(list(folder.glob("tire0_*.vtp"))), 3)
        self.assertEqual((folder / "terrain.pvd").read_text().count("<DataSet "), 3)
        done = subprocess.run(["/usr/bin/python3", "-c", (
            "import sys\ntry: from vtkmodules.vtkIOXML import vtkXMLPolyDataReader as Reader\nexcept ImportError: "
            "sys.exit(77)\n"
            "for name in sys.argv[1:]:\n"
            "  r = Reader(); r.SetFileName(name); r.Update(); d = r.GetOutput(); a = d.GetPointData().GetArray(0)\n"
            "  print(d.GetNumberOfPoints(), d.GetNumberOfCells(), a.GetName(), a.GetMaxNorm(), *d.GetPoint(7))"),
            folder / "tire0_000002.vtp", folder / "terrain_000002.vtp"], text=True, capture_output=True)
        if done.returncode == 77:
            self.skipTest("no VTK")
        self.assertEqual(done.returncode, 0, done.stderr)
        tire, grains = [line.split() for line in done.stdout.splitlines()]
        frame, ground = self.run_.tire()[2], self.run_.grains[2]
        self.assertEqual(tire[:3], [str(len(frame.position)), str(len(frame.triangle)), "velocity"])
        self.assertEqual(grains[:3], [str(len(ground.radius)), str(len(ground.radius)), "radius"])
        np.testing.assert_allclose([float(x) for x in tire[4:]], frame.position[7], rtol=1e-6)
        self.assertAlmostEqual(float(grains[3]), float(ground.radius.max()), places=6)

    def test_paraview_shows_the_frames(self):
        if not shutil.which("pvpython") or not shutil.which("xvfb-run"):
            self.skipTest("no pvpython or xvfb-run")
        folder, picture = self.run_.write_vtk(self.folder / "vtk"), self.folder / "run.png"
        self.call(["xvfb-run", "-a", "-s", "-noreset", "pvpython", ROOT / "scripts" / "python" / "paraview_run.py",
                   folder, "--picture", picture])
        seen = matplotlib.image.imread(picture)[100:-100, 200:-200, :3]
        self.assertGreater(float(seen.std()), 0.03, "nothing but the background")

    def test_errors_are_the_programs_own(self):
        with self.assertRaises(furrow.BadInput) as caught:
            furrow.run(SMALL, out=self.folder / "bad", progress=False, rig__slip="fast")
        self.assertEqual(caught.exception.exit_code, 2)
        self.assertIn("key 'rig.slip': is 'fast', expected a number", str(caught.exception))
        self.assertTrue(str(caught.exception).startswith("scenario: key"), caught.exception)
        self.assertIsNone(caught.exception.directory)
        self.assertEqual(self.names(), [])
        self.assertRaisesRegex(TypeError, "section__key", furrow.run, SMALL, slip=0.5)
        self.assertRaises(FileNotFoundError, furrow.open, self.folder / "none")
        self.assertRaisesRegex(ValueError, "holds no results of furrow", furrow.open, self.folder)
        (self.folder / "summary.json").write_text("[1]")
        self.assertRaisesRegex(furrow.Damaged, "summary.json is not a JSON object", furrow.open, self.folder)

    def test_a_run_that_failed_is_opened_from_its_error(self):
        soft = changed(terrain={"young_modulus": 1e3}, rig={"carrier_mass": 20000}, run={"end": 0.2})
        with self.assertRaises(furrow.PhysicsFailed) as caught:
            furrow.run(soft, out=self.folder / "out", progress=False)
        failed = furrow.open(caught.exception.directory)
        self.assertEqual((failed.state, failed.failure["exit_code"]), ("failed", 3))
        self.assertEqual(failed.failure["error"], str(caught.exception))
        self.assertIsInstance(failed.summary, dict)

    def test_a_study_gives_its_points(self):
        scenario = write_scenario(self.folder, changed(output={"frame_interval": 0}))
        study = {"scenario": str(scenario), "set": {"run.end": 0.03},
                 "grid": {"rig.slip": [0.1, 0.4], "run.seed": [1, 2]},
                 "plot": {"x": "rig.slip", "y": "drawbar_pull_N.mean", "mean_over": "run.seed"}}
        swept = furrow.sweep(study, out=self.folder / "study", jobs=2, progress=False)
        self.assertEqual(len(swept.runs), 4)
        with self.assertRaisesRegex(ValueError, "runs with the same exit_code differ in rig.slip"):
            swept.points("exit_code", "drawbar_pull_N.mean", mean_over="run.seed")
        points = swept.points("rig.slip", "drawbar_pull_N.mean", mean_over="run.seed")
        self.assertEqual(list(points["rig.slip"]), [0.1, 0.4])
        pulls = [run.number("drawbar_pull_N.mean") for run in swept.runs if run.scenario["rig"]["slip"] == 0.1]
        self.assertAlmostEqual(points["drawbar_pull_N.mean"][0], np.mean(pulls))
        self.assertAlmostEqual(points["half_bar"][0], 12.706 * abs(pulls[1] - pulls[0]) / 2, delta=1e-3 * abs(pulls[0]))
        one = swept.points("rig.slip", "drawbar_pull_N.mean", run__seed=2)
        self.assertTrue(np.isnan(one["half_bar"]).all())
        self.assertRaisesRegex(KeyError, "no column 'pull'", swept.points, "rig.slip", "pull")
        self.assertGreater(len(furrow.plots.curve(swept).axes), 0)
        matplotlib.pyplot.close()

    def test_pressed_tires_and_soil_are_opened(self):
        pressed = furrow.press("first_look", out=self.folder / "press", progress=False, points=3, tire__rigid=False,
                               tire__file="hmmwv_ring.json")
        self.assertEqual(pressed.curve.attrs["units"]["force_N"], "N")
        self.assertGreater(pressed.footprint["pressure_Pa"].max(), 0)
        modes = furrow.modes("aligator_planar.json", out=self.folder / "modes", orders=2, count=2, progress=False)
        self.assertEqual(list(modes.frequencies["order"]), [0, 0, 1, 1, 2, 2])
        self.assertGreater(len(furrow.plots.mode_shapes(modes).axes), 0)
        matplotlib.pyplot.close()
        soil = furrow.soil("first_look", out=self.folder / "soil", quick=True, only="repose", progress=False)
        self.assertGreater(len(soil.repose), 0)
        self.assertRaisesRegex(furrow.Missing, "no plate.csv", lambda: soil.plate)

    def test_calibrations_and_suspensions_are_opened(self):
        fitted = furrow.calibrate("calibrate_handling", out=self.folder / "fit", progress=False)
        self.assertIsInstance(furrow.open(self.folder / "fit"), furrow.Calibration)
        self.assertAlmostEqual(fitted.parameters.loc["PKX1", "value"], fitted.summary["parameters"]["PKX1"]["value"])
        self.assertIn("model", fitted.fit.columns)
        self.assertTrue(fitted.file.is_file())
        self.assertEqual(fitted.warnings, fitted.summary["warnings"])
        moved = furrow.kc("rover.json", out=self.folder / "kc", points=3, progress=False)
        self.assertGreater(len(moved.curves), 3)

    def test_examples_and_types(self):
        self.assertEqual(doctest.testmod(units).failed, 0)
        if not importlib.util.find_spec("mypy"):
            self.skipTest("no mypy")
        self.call(["/usr/bin/python3", "-m", "mypy", "--config-file", "pyproject.toml", "--cache-dir", self.folder
                               / "cache", "furrow"], cwd=ROOT / "scripts" / "python")


if __name__ == "__main__":
    main()
