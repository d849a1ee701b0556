#!/usr/bin/python3
"""scripts/check_includes.py, check_headers.py, check_docs.py, check_prose.py on small trees: what they must notice."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"


class Check(unittest.TestCase):
    script = ""

    def told(self, prepare=lambda root: None, **files):
        """What the script prints of a tree with these files, by names in which '__' is '/' and '_dot_' is '.'."""
        with tempfile.TemporaryDirectory() as name:
            root = pathlib.Path(name)
            for file, text in files.items():
                path = root / file.replace("__", "/").replace("_dot_", ".")
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            prepare(root)
            done = subprocess.run([sys.executable, "-B", SCRIPTS / self.script, "--root", root], text=True,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            self.assertEqual(done.returncode, 1 if done.stdout else 0, done.stdout)
            return done.stdout


class Includes(Check):
    script = "check_includes.py"
    def test_every_way_to_write_an_include_is_seen(self):
        for line in ('#include "nodes/scenario/b.hpp"', "#include <nodes/scenario/b.hpp>",
                     '  #  include "nodes/scenario/b.hpp"', '#include "../nodes/scenario/b.hpp"'):
            told = self.told(tire__a_dot_hpp="\n" + line, nodes__scenario__b_dot_hpp="")
            self.assertIn("tire/a.hpp:2: tire includes nodes/scenario/b.hpp of nodes/scenario, which is not below",
                          told)
        self.assertIn("expected the path from the root", self.told(tire__a_dot_hpp='#include "../protocol/core/a.hpp"',
                                                                   protocol__core__a_dot_hpp=""))
        self.assertEqual(self.told(tire__a_dot_hpp='#include "protocol/core/a.hpp"', protocol__core__a_dot_hpp=""), "")

    def test_lines_that_are_too_wide_are_named(self):
        self.assertEqual(self.told(tire__a_dot_hpp="// " + "·" * 117), "")
        self.assertIn("tire/a.hpp:2: has 121 columns, expected at most 120",
                      self.told(tire__a_dot_hpp="\n// " + "·" * 118))

    def test_tests_and_mpi_stay_outside(self):
        self.assertIn("tire includes tests/x.hpp",
                      self.told(tire__a_dot_hpp='#include "tests/x.hpp"', tests__x_dot_hpp=""))
        self.assertIn("only protocol/ and terrain/liggghts/plugin/ know MPI",
                      self.told(rigs__a_dot_cpp="#include <mpi.h>"))
        self.assertEqual(self.told(protocol__a_dot_cpp="#include <mpi.h>"), "")

    def test_new_folders_must_be_named(self):
        self.assertIn("weather/: holds sources", self.told(weather__rain_dot_cpp=""))
        self.assertIn("nodes/plots/a.cpp: is in no room", self.told(nodes__plots__a_dot_cpp=""))
        self.assertEqual(self.told(nodes__main_dot_cpp="", tests__a_dot_cpp=""), "")

    def test_dummies_obey_the_rules_of_the_room_that_they_would_stand_in(self):
        told = self.told(tests__dummies__spring_wheel_dot_hpp='#include "tire/tires.hpp"', tire__tires_dot_hpp="")
        self.assertIn("circle of includes", told)
        told = self.told(tests__dummies__held_hub_dot_hpp='#include "nodes/scenario/b.hpp"',
                         nodes__scenario__b_dot_hpp="")
        self.assertIn("rigs includes nodes/scenario/b.hpp", told)


class Headers(Check):
    script = "check_headers.py"
    LIST = "set(_headers <vector> <algorithm>\n <nlohmann/json.hpp>)\n target_precompile_headers(x <gtest/gtest.h>)"

    def said(self, headers=LIST, **files):
        return self.told(scripts__cmake__FurrowCompiler_dot_cmake=headers, **files)

    def test_a_name_needs_its_header(self):
        self.assertIn("tire/a.cpp:2: uses std::vector without #include <vector>",
                      self.said(tire__a_dot_cpp="\nstd::vector<int> a;"))
        self.assertIn("uses std::ranges::sort without", self.said(tire__a_dot_cpp="std::ranges::sort(a);"))
        self.assertIn("uses TEST without #include <gtest/gtest.h>", self.said(tests__a_dot_cpp="TEST(A, b) {}"))
        self.assertEqual(self.said(tire__a_dot_cpp="#include <vector>\nstd::vector<int> a;"), "")
        self.assertEqual(self.said(tire__a_dot_cpp="// std::vector\nconst char* a = \"std::vector\"; std::string b;"),
                         "")

    def test_a_header_of_the_project_brings_what_it_includes(self):
        uses = '#include "tire/b.hpp"\nnlohmann::json a;'
        self.assertEqual(self.said(tire__a_dot_cpp=uses, tire__b_dot_hpp='#include "tire/c.hpp"',
                                   tire__c_dot_hpp="#include <nlohmann/json_fwd.hpp>"), "")
        self.assertIn("without #include <nlohmann/json.hpp>", self.said(tire__a_dot_cpp=uses, tire__b_dot_hpp=""))

    def test_a_precompiled_header_of_unknown_names(self):
        self.assertIn("precompiles <map>", self.said("set(_headers <map>)"))


class Docs(Check):
    script = "check_docs.py"

    def test_paths_that_lead_nowhere(self):
        self.assertIn("names line 999 of 'tire/x.cpp'",
                      self.told(A_dot_md="`tire/x.cpp:999`", tire__x_dot_cpp="1\n2\n"))
        self.assertEqual(self.told(A_dot_md="`tire/x.cpp:2`, `x.cpp`", tire__x_dot_cpp="1\n2\n"), "")
        self.assertIn("names 'y.hpp'", self.told(A_dot_md="`y.hpp`", tire__x_dot_cpp=""))
        self.assertEqual(self.told(A_dot_md="`shell/x.cpp`", tire__shell__x_dot_cpp=""), "")
        self.assertIn("names 'ring/x.cpp'", self.told(A_dot_md="`ring/x.cpp`", tire__shell__x_dot_cpp=""))

    def test_comments_that_name_sources_which_there_are_not(self):
        source = "int x = 1;  // see shell/x.cpp and {}\n"
        self.assertEqual(self.told(tire__shell__x_dot_cpp=source.format("tire/shell/x.cpp")), "")
        self.assertIn("tire/shell/x.cpp:1: names 'y.cpp'", self.told(tire__shell__x_dot_cpp=source.format("y.cpp")))
        self.assertIn("names 'tire/x.cpp'", self.told(tire__shell__x_dot_cpp=source.format("tire/x.cpp")))

    def test_figures_of_the_headline_run_are_those_of_its_scenario(self):
        expected = {"drawbar_pull": 1400, "drawbar_pull_spread": 150, "sinkage": 0.021, "sinkage_spread": 0.003,
                    "rut_depth": 0.018, "rut_depth_spread": 0.006}
        said = "It pulls 1400 ± 150 N, sinks by 21 ±\n3 mm and leaves a rut of 18 ± 6 mm.\n"
        files = {"rigs__drawbar_pull_small_dot_json": json.dumps({"expected": expected})}
        self.assertEqual(self.told(README_dot_md=said, **files), "")
        self.assertIn("README.md: does not say '1400 ± 150 N', which rigs/drawbar_pull_small.json expects as "
                      "drawbar_pull", self.told(README_dot_md=said.replace("1400", "1500"), **files))

    def test_a_sixth_file_within_a_step_of_a_recipe(self):
        names = [f"tire/{letter}.cpp" for letter in "abcdef"]
        files = {name.replace("/", "__").replace(".", "_dot_"): "" for name in names}
        steps = "".join(f"{k}. `{name}`: this\n" for k, name in enumerate(names[:5], 1))
        recipe = "## Add a thing\n\n" + steps
        self.assertEqual(self.told(CONTRIBUTING_dot_md=recipe, **files), "")
        self.assertEqual(self.told(CONTRIBUTING_dot_md=recipe + "   (see `tire/f.cpp`)\n", **files), "")
        self.assertIn("names file 6 of 'Add a thing'",
                      self.told(CONTRIBUTING_dot_md=recipe + "   and `tire/f.cpp`\n", **files))

    def test_tables_that_do_not_say_with_what_they_were_made(self):
        head = "# commit: 1a2b3c4d\n# compiler: g++ 12.2.0\n# processor: a processor\n# command: run_study.py a.json\n"
        made = '{"commit": "1a2b3c4d", "compiler": "g++ 12.2.0", "processor": "a processor", "command": "soak.py"}'
        page = {"A_dot_md": "a.csv b.json soil.json"}
        table, results, soil = "tests__x__a_dot_csv", "tests__studies__b_dot_json", "terrain__data__soil_dot_json"
        self.assertEqual(self.told(**page, **{table: head + "x\n1\n", results: f'{{"made": {made}, "x": 1}}',
                                              soil: f'{{"measured": {{"made": {made}}}}}'}), "")
        self.assertIn("tests/x/a.csv:1: does not say with what it was made: expected processor",
                      self.told(**page, **{table: head.replace("# processor: a processor\n", "") + "x\n1\n"}))
        self.assertIn("tests/x/a.csv:1: does not say with what it was made: expected command",
                      self.told(**page, **{table: head.replace(": run_study.py a.json", ":") + "x\n1\n"}))
        self.assertIn("tests/studies/b.json:1: does not say", self.told(**page, **{results: '{"x": 1}'}))
        self.assertIn("terrain/data/soil.json:1: does not say", self.told(**page, **{soil: '{"measured": {"n": 1}}'}))
        self.assertEqual(self.told(**{results: '{"scenario": "a.json", "cases": {}}'}), "")
        self.assertIn("tests/x/a.csv:1: is named on no page", self.told(**{table: head + "x\n1\n"}))

    @unittest.skipUnless(shutil.which("git"), "needs git")
    def test_commits_that_are_not_in_the_history(self):
        def history(root):
            for command in (["init", "-q"], ["-c", "user.name=A", "-c",
                                             "user.email=a@example", "commit", "-q", "--allow-empty", "-m", "a"]):
                dates = dict.fromkeys(("GIT_AUTHOR_DATE", "GIT_COMMITTER_DATE"), "1700000000 +0000")  # one name
                subprocess.run(["git", "-C", root, *command], check=True, env={**os.environ, **dates})
            name = subprocess.run(["git", "-C", root, "rev-parse", "HEAD"],
                                  check=True, text=True, capture_output=True).stdout[:8]
            page = root / "A.md"
            page.write_text(page.read_text().replace("HEAD", name))
        head = "# commit: 1a2b3c4d and 1a2b3c4e\n# compiler: c\n# processor: p\n# command: x.py\n"
        page = "Mended at 1a2b3c4f. It was 12345678 bytes of a facade at HEAD (`a.csv`).\n\n    1a2b3c4a of code\n"
        self.assertEqual(self.told(A_dot_md=page, tests__a_dot_csv=head), "")  # no repository
        # a squashed one
        self.assertEqual(self.told(history, A_dot_md=page.replace("HEAD", "a page"), tests__a_dot_csv=head), "")
        said = self.told(history, A_dot_md=page, tests__a_dot_csv=head).splitlines()
        self.assertEqual(said, ["A.md:1: names commit 1a2b3c4f, which is not in the history",
                                "tests/a.csv:1: names commit 1a2b3c4d, which is not in the history",
                                "tests/a.csv:1: names commit 1a2b3c4e, which is not in the history"])

    def test_shipped_scenarios_that_the_gallery_leaves_out(self):
        files = {"rigs__a_dot_json": "{}", "rigs__scenario_dot_schema_dot_json": "{}"}
        self.assertEqual(self.told(scripts__docs__gallery_dot_md="`a.json`", **files), "")
        self.assertIn("scripts/docs/gallery.md:1: does not list rigs/a.json",
                      self.told(scripts__docs__gallery_dot_md="a page", **files))


class Prose(Check):
    script = "check_prose.py"

    def test_long_sentences_and_replaced_words(self):
        words = "one two three four five six seven "
        long = (words * 6)[:-1] + "."
        self.assertIn("A.md:3: has a sentence of 42 words, expected at most 35: 'one two three four five six …'",
                      self.told(A_dot_md=f"A page.\n\n{long}\n"))
        page = f"```\n{long}\n```\n\n| {long} |\n\n{words}[{words}](a.md). Then `{long}`.\n"
        self.assertEqual(self.told(A_dot_md=page), "")
        self.assertIn("A.md:1: has 'is no file', expected 'is not a …'", self.told(A_dot_md="This is no file.\n"))
        self.assertEqual(self.told(A_dot_md="There is no file. It is no longer here.\n"), "")


if __name__ == "__main__":
    unittest.main()
