#!/usr/bin/python3
"""The installed tree: it runs from wherever it is moved to, and takes the build for this processor."""
import importlib.util
import os
import pathlib
import shutil
import unittest

from program import PROGRAM, ROOT, SystemTest, main, write_scenario

BUILD = pathlib.Path(PROGRAM).parent


class Install(SystemTest):
    def setUp(self):
        super().setUp()
        self.call(["cmake", "--install", str(BUILD), "--prefix", str(self.folder / "first")])
        self.tree = self.folder / "moved tree"
        (self.folder / "first").rename(self.tree)
        self.builds = self.tree / "libexec" / "furrow"

    def run_installed(self, *arguments, env=(), **expected):
        environment = {name: value for name, value in os.environ.items() if not name.startswith("FURROW")}
        return self.call([self.tree / "bin" / "furrow", *map(str, arguments)], env={**environment, **dict(env)},
                         **expected)

    def test_a_moved_tree_runs_and_finds_its_files(self):
        self.run_installed("validate", write_scenario(self.folder))
        done = self.run_installed("run", self.folder / "small.json", "--out", "out", "--set", "terrain.engine=rigid",
                                  "--set", "run.end=0.004", "--set", "run.average_from=0")
        self.assertTrue(list((self.folder / "out").glob("*.png")) or "no plots" in done.stderr, done.stderr)
        self.assertTrue((self.tree / "share/furrow/rigs/scenario.schema.json").exists())
        if importlib.util.find_spec("matplotlib") and importlib.util.find_spec("h5py"):
            self.run_installed("report", "out")
            self.assertTrue((self.folder / "out" / "report.html").exists())
        self.run_installed("events", "out", code=5, says="is not the run of a vehicle")

    def test_completion_scripts_and_the_manual_page_come_with_it(self):
        for name in ("bash-completion/completions/furrow", "zsh/vendor-completions/_furrow",
                     "fish/vendor_completions.d/furrow.fish", "man/man1/furrow.1"):
            text = (self.tree / "share" / name).read_text()
            self.assertIn("bit-identical to that of an uninterrupted run"
                          if "man" in name or "fish" in name else "resume", text.replace("\\-", "-"))
            self.assertNotIn(str(ROOT), text)

    def test_a_batch_script_names_the_command_that_suits_every_node(self):
        self.run_installed("ranks", "--slurm", write_scenario(self.folder), shows=f"program='{self.tree}/bin/furrow'\n")

    def test_the_richest_level_is_taken_and_another_can_be_asked_for(self):
        shutil.rmtree(self.builds)
        for level in ("any", "x86-64-v2", "x86-64-v3", "x86-64-v4", "m68k"):
            program = self.builds / level / "furrow"
            program.parent.mkdir(parents=True)
            program.write_text(f"#!/bin/sh\necho {level}: \"$@\"\n")
            program.chmod(0o755)
        flags = pathlib.Path("/proc/cpuinfo").read_text().split()
        taken = next((level for level, flag in (("x86-64-v4", "avx512vl"),
                                                ("x86-64-v3", "avx2"), ("x86-64-v2", "popcnt"))
                      if flag in flags), "any")
        self.assertEqual(self.run_installed("run", "a b").stdout, f"{taken}: run a b\n")
        self.assertEqual(self.run_installed(env={"FURROW_LEVEL": "any"}).stdout, "any:\n")
        shutil.rmtree(self.builds / taken)
        self.assertNotEqual(self.run_installed().stdout, f"{taken}:\n")
        for level in self.builds.iterdir():
            if level.name != "m68k":
                shutil.rmtree(level)
        self.run_installed(code=2, says="has builds for: m68k, expected one for: ")


if __name__ == "__main__":
    unittest.skipUnless(shutil.which("cmake"), "needs cmake")(Install)
    main()
