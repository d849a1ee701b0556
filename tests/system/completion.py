#!/usr/bin/python3
"""Completion scripts and the manual page: they know what the program's help knows, and the shells take them."""
import re
import shutil
import subprocess
import sys
import unittest

from program import PROGRAM, ROOT, SystemTest, furrow, main

DOCS = ROOT / "scripts" / "docs"
# The user's line, the place of the cursor at its end, as bash hands it to a completion.
ASK = """compopt() { :; }
source "$1"; shift
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
_furrow furrow "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD-1]}"
((${#COMPREPLY[@]} == 0)) || printf '%s\\n' "${COMPREPLY[@]}"
"""


def made(script, *arguments):
    return subprocess.run([sys.executable, "-B", DOCS / script, *arguments, "--program", PROGRAM], text=True,
                          check=True, capture_output=True).stdout


class Completion(SystemTest):
    @classmethod
    def setUpClass(cls):
        cls.commands = re.findall(r"^  ([a-z]+) {3,}", furrow("--help", cwd="/").stdout, re.MULTILINE)
        cls.bash = made("completion.py", "bash")

    def completed(self, *words):
        script = self.folder / "script"
        script.write_text(self.bash)
        done = subprocess.run(["bash", "-c", ASK, "bash", script, PROGRAM, *words],
                              cwd=self.folder, text=True, capture_output=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout.split()

    def test_every_command_and_every_option_of_its_help(self):
        self.assertEqual(self.completed(""), [*self.commands, "--help", "--version"])
        for command in self.commands:
            with self.subTest(command):
                text = furrow(command, "--help", cwd="/").stdout.split("\nExamples:")[0]
                options = {name for line in re.findall(r"^  (-\S+)", text, re.MULTILINE) for name in line.split(",")}
                self.assertEqual(set(self.completed(command, "-")), options)

    def test_values_that_the_help_lists(self):
        self.assertEqual(self.completed("soil", "--only", ""), ["plate", "shear", "cone", "repose", "interface"])
        self.assertEqual(self.completed("bench", ""), ["grains", "tire", "rig"])
        self.assertEqual(self.completed("bench", "rig", "--scenario", "first_l"), ["first_look.json"])
        self.assertEqual(self.completed("bench", "grains", "--pr"), ["--precision"])
        self.assertEqual(self.completed("bench", "grains", "--precision", "m"), ["mixed"])
        self.assertIn("hmmwv.json", self.completed("validate", "hmm"))
        self.assertEqual(self.completed("list", "s"), ["scenarios", "studies", "soils"])

    def test_names_of_shipped_files_keys_and_your_own_files(self):
        (self.folder / "first_mine.json").touch()
        (self.folder / "first_results").mkdir()
        self.assertEqual(sorted(self.completed("run", "first_")),
                         ["first_look.json", "first_mine.json", "first_results"])
        self.assertEqual(self.completed("resume", "first_"), ["first_results"])
        self.assertEqual(self.completed("run", "a.json", "--set", "rig.sl"), ["rig.slip=", "rig.slope="])
        self.assertEqual(self.completed("run", "--no-plots", "first_l"), ["first_look.json"], "a flag has no value")
        self.assertEqual(self.completed("explain", "terrain.coh"), ["terrain.cohesion"])
        self.assertEqual(self.completed("run", "a.json", "--seeds", ""), [])

    def test_the_other_shells_take_their_scripts(self):
        for shell in ("zsh", "fish"):
            script = self.folder / shell
            script.write_text(made("completion.py", shell))
            for command in self.commands:
                self.assertIn(command, script.read_text())
            if shutil.which(shell):
                done = subprocess.run([shell, "-n", script], text=True, capture_output=True)
                self.assertEqual((done.returncode, done.stderr), (0, ""))
        if shutil.which("fish"):
            asked = f"source '{self.folder / 'fish'}'; complete -C 'furrow soil --only '"
            done = subprocess.run(["fish", "-c", asked], text=True, capture_output=True, cwd=self.folder)
            self.assertEqual([line.split("\t")[0] for line in done.stdout.splitlines()],
                             ["cone", "plate", "repose", "shear"])

    def test_the_manual_page_names_every_command_option_and_exit_code(self):
        page = made("manual.py")
        for command in self.commands:
            self.assertIn(f"\n.SS {command} [OPTIONS]", page)
            for option in re.findall(r"^  (--\S+)", furrow(command, "--help", cwd="/").stdout, re.MULTILINE):
                self.assertIn(option.replace("-", "\\-"), page)
        for code in (0, 2, 3, 4, 5, 6, 70, 75):
            self.assertIn(f"\n\\fB{code}\\fR\n", page)
        for name in ("FURROW_HOME", "FURROW_LEVEL", "FURROW_MPIRUN", "FURROW_START_TIMEOUT", "XDG_CACHE_HOME"):
            self.assertIn(f"\n\\fB{name}\\fR\n", page)
        if shutil.which("man"):
            file = self.folder / "furrow.1"
            file.write_text(page)
            done = subprocess.run(["man", "--warnings", "-l", file], text=True, capture_output=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""))


if __name__ == "__main__":
    unittest.skipUnless(shutil.which("bash"), "needs bash")(Completion)
    main()
