#!/usr/bin/python3
"""The commands of the tutorial, in their order, as a reader would type them."""
import csv
import os
import pathlib
import re
import subprocess
import unittest

from program import PROGRAM, ROOT, SystemTest, main

PAGE = ROOT / "scripts" / "docs" / "tutorial.md"


def blocks(text):
    """(line, commands) of the blocks of shell commands that are to be run."""
    for match in re.finditer(r"(<!-- not run: [^\n]* -->\n)?^```sh\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        if not match[1]:
            yield text.count("\n", 0, match.start(2)) + 1, match[2]


class Tutorial(SystemTest):
    def test_its_commands_end_with_a_curve(self):
        (self.folder / "bin").mkdir()
        (self.folder / "bin" / "furrow").symlink_to(pathlib.Path(PROGRAM).resolve())
        script = "set -euo pipefail\n"
        for line, commands in blocks(PAGE.read_text()):
            script += f"echo 'tutorial.md:{line}' >&2\n{commands}"
        environment = {**os.environ, "PATH": f"{self.folder / 'bin'}:{os.environ['PATH']}", "FURROW_HOME": str(ROOT)}
        done = subprocess.run(["bash", "-c", script], cwd=self.folder, env=environment, text=True, capture_output=True,
                              stdin=subprocess.DEVNULL, timeout=3000)
        print(done.stdout[-6000:], done.stderr[-6000:])
        self.assertEqual(done.returncode, 0, done.stderr)
        work = self.folder / "my_curve"
        for name in ("first_look/summary.json", "press/summary.json", "soil/soil.json", "curve/sweep.csv"):
            self.assertTrue((work / name).exists(), name)
        with open(work / "curve" / "sweep.csv") as table:
            self.assertEqual([run["state"] for run in csv.DictReader(table)], ["done"] * 4)


class Blocks(unittest.TestCase):
    def test_marked_ones_are_left_out_and_all_others_are_found(self):
        page = "```sh\na\n```\n\n<!-- not run: long -->\n```sh\nb\n```\n\n```json\nc\n```\n```sh\nd\ne\n```\n"
        self.assertEqual(list(blocks(page)), [(2, "a\n"), (14, "d\ne\n")])


if __name__ == "__main__":
    main()
