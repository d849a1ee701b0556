#!/usr/bin/python3
"""What the documentation site is made from: links for their new places, and pages made from schemas, sources and
help."""
import pathlib
import re
import subprocess
import sys
import tempfile

from program import PROGRAM, ROOT, SystemTest, furrow, main, read_json, write_json

DOCS = ROOT / "scripts" / "docs"


class Stage(SystemTest):
    def staged(self, **files):
        root = self.folder / "root"
        for name, text in files.items():
            path = root / name.replace("__", "/").replace("_dot_", ".")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        done = subprocess.run([sys.executable, "-B", DOCS / "stage.py", self.folder / "site", "--root", root],
                              text=True, capture_output=True)
        return done

    def page(self, name):
        return (self.folder / "site" / name).read_text()

    def test_links_lead_to_where_pages_stand_in_the_site(self):
        done = self.staged(README_dot_md="[a](scripts/docs/one.md#x), [tire](tire/), [sources](protocol), "
                                         "[data](tire/a.csv), [w](https://a.b)",
                           scripts__docs__one_dot_md="[back](../../README.md) [`t.md`\nor "
                                                     "so](../../tire/README.md#part) [here](#x)",
                           tire__README_dot_md="![p](p.png) `[no](link.md)`\n```\n[no](link.md)\n```\n[data](a.csv)\n",
                           tire__a_dot_csv="1", tire__p_dot_png="1", protocol__a_dot_cpp="")
        self.assertEqual(done.stderr, "")
        self.assertEqual(self.page("README.md"),
                         "[a](one.md#x), [tire](tire/README.md), sources, [data](tire/a.csv), [w](https://a.b)")
        self.assertEqual(self.page("one.md"), "[back](README.md) [`t.md`\nor so](tire/README.md#part) [here](#x)")
        self.assertEqual(self.page("tire/README.md"),
                         "![p](p.png) `[no](link.md)`\n```\n[no](link.md)\n```\n[data](a.csv)\n")
        self.assertEqual((self.page("tire/a.csv"), self.page("tire/p.png")), ("1", "1"))

    def test_links_that_lead_nowhere_are_errors(self):
        for link, told in (("a.csv", "'a.csv' is linked to, but there is no such file"),
                           ("../b.md", "outside of the repository")):
            done = self.staged(README_dot_md=f"[x]({link})")
            self.assertEqual(done.returncode, 1)
            self.assertIn(told, done.stderr)

    def test_pages_that_are_gone_leave_the_site(self):
        self.staged(README_dot_md="a", GLOSSARY_dot_md="b")
        (self.folder / "root" / "GLOSSARY.md").unlink()
        self.staged(README_dot_md="a")
        self.assertFalse((self.folder / "site" / "GLOSSARY.md").exists())


class Reference(SystemTest):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, "-B", DOCS / "reference.py", folder, "--root", ROOT, "--program", PROGRAM],
                           check=True)
            cls.pages = {path.stem: path.read_text() for path in pathlib.Path(folder).iterdir()}

    def page(self, name):
        return self.pages[name]

    def test_every_key_that_the_program_explains(self):
        page = self.page("scenario_keys")
        keys = re.findall(r"^([a-z]\S*)", furrow("explain", cwd=self.folder).stdout, re.MULTILINE)
        self.assertGreater(len(keys), 90)
        for key in keys:
            if key not in ("tires", "rig.wheels"):
                self.assertRegex(page, rf"\| `{re.escape(key)}(\[k\]\.\w+)?` \|")
        self.assertIn("| `terrain.cohesion` | `0` | Pa | number, from 0 to 1e+09 |", page)

    def test_every_column_of_a_run(self):
        columns = re.findall(r"^\| `(\w+)` \|", self.page("columns"), re.MULTILINE)
        for name in ("time_s", "sinkage_m", "drawbar_pull_N", "iso_force_x_N",
                     "suspension_travel_m", "spring_energy_J"):
            self.assertIn(name, columns)
        scenario = {"tire": {"file": "rigid_drum.json", "rigid": True}, "terrain": {"engine": "rigid"},
                    "rig": {"load": 25}, "run": {"end": 0.01, "average_from": 0}, "output": {"frame_interval": 0}}
        write_json(self.folder / "a.json", scenario)
        self.furrow("run", "a.json", "--out", "a", "--no-plots")
        written = (self.folder / "a" / "timeseries.csv").read_text().split("\n")[0].split(",")
        self.assertEqual(set(written) - set(columns), set())

    def test_every_command_and_exit_code(self):
        page = self.page("commands")
        for command in re.findall(r"^  ([a-z]+) {3,}", furrow("--help", cwd="/").stdout, re.MULTILINE):
            self.assertIn(f"\n### furrow {command}\n", page)
        self.assertIn("\n#### furrow bench grains\n", page)
        self.assertEqual(re.findall(r"^\| (\d+) \|", self.page("exit_codes"), re.MULTILINE),
                         ["0", "2", "3", "4", "5", "6", "70", "75"])

    def test_every_definition_of_files(self):
        for name, schema in (("tire_files", "tire/data/tire.schema.json"),
                             ("vehicle_files", "vehicle/data/vehicle.schema.json")):
            content = read_json(ROOT / schema)
            for definition, entry in content["definitions"].items():
                for key in entry.get("properties", {}):
                    self.assertIn(f"| `{key}` |", self.page(name))


if __name__ == "__main__":
    main()
