#!/usr/bin/python3
"""The package furrow installed by pip, without a network and far from the checkout. Exit code 77: pip, setuptools or
what the package needs is missing."""
import importlib.util
import json
import os
import pathlib
import re
import shutil
import sys

from program import ROOT, SystemTest, main, write_json

PACKAGE = ROOT / "scripts" / "python"
PYTHON = "/usr/bin/python3"
MISSING = [name for name in ("pip", "setuptools", "wheel", "h5py", "matplotlib", "pandas", "xarray")
           if not importlib.util.find_spec(name)]
LOOK = """
import importlib.metadata, json, furrow
run = furrow.open("run")
axes = furrow.plots.pull_slip_sinkage(run).axes
print(json.dumps([furrow.__file__, importlib.metadata.version("furrow"), run.number("drawbar_pull_N.mean"),
                  [axis.get_ylabel() for axis in axes]]))
"""


class Install(SystemTest):
    def setUp(self):
        super().setUp()
        self.env = {name: value for name, value in os.environ.items() if not name.startswith(("FURROW", "PYTHON"))}
        self.env |= {"PYTHONPATH": str(self.folder / "site"), "MPLBACKEND": "Agg", "PATH": "/usr/bin:/bin"}
        shutil.copytree(PACKAGE, self.folder / "source",
                        ignore=shutil.ignore_patterns("__pycache__", "build", "*-info"))
        self.call([PYTHON, "-m", "pip", "install", "--quiet", "--no-index", "--no-build-isolation", "--no-deps",
                   "--no-cache-dir", "--disable-pip-version-check", "--target", "site", "./source"], env=self.env)
        shutil.rmtree(self.folder / "source")

    def small_run(self):
        run = self.folder / "run"
        run.mkdir()
        write_json(run / "scenario.json", {"rig": {"slip": 0.2}, "terrain": {"friction": 0.5}})
        write_json(run / "summary.json", {
            "scenario": "known", "slip": 0.2, "simulated_s": 0.2, "terrain_engine": "dem",
            "net_terrain_force_N": [100.0, 0.0, 4000.0],
            "drawbar_pull_N": {"mean": 100.0, "sem": 4.0, "n_eff": 12.0, "steady": True, "from_s": 0.1, "to_s": 0.2}})
        (run / "timeseries.csv").write_text("time_s,drawbar_pull_N,slip,sinkage_m\n" + "".join(
            f"{0.01 * k:g},100,0.2,0.02\n" for k in range(21)))
        return run

    def test_it_opens_draws_and_makes_the_page(self):
        run = self.small_run()
        file, version, pull, labels = json.loads(self.call([PYTHON, "-B", "-c", LOOK], env=self.env).stdout)
        self.assertTrue(pathlib.Path(file).is_relative_to(self.folder / "site"), file)
        stated = re.search(r"project\(furrow VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]
        self.assertEqual((version, pull, labels), (stated, 100.0, ["drawbar pull, N", "slip", "sinkage, mm"]))
        done = self.call([PYTHON, "-B", "-m", "furrow", "report", "run"], env=self.env)
        self.assertEqual(json.loads(done.stdout), ["pull_slip_sinkage.png", "report.html"], done.stderr)
        page = (run / "report.html").read_text(encoding="utf-8")
        self.assertTrue(".uplot{" in page, "the bundle is part of it")
        self.assertTrue(re.search(r'"rig.slip", "0.2", "[^"]*", "0.3"', page), "the default is that of the schema")


if __name__ == "__main__":
    if MISSING:
        print("skipped: needs Debian's", ", ".join(f"python3-{name}" for name in MISSING))
        sys.exit(77)
    main()
