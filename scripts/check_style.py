#!/usr/bin/env python3
"""Checks that no source line is wider than 120 columns and that the subjects of commits are short and name their area.

The subject of a commit is `area: imperative`, at most 72 letters. The commits looked at are those of one submission:
from the branch that it is for (origin/main) where HEAD is ahead of it, else from the commit that added this check.

usage: scripts/check_style.py [--root FOLDER] [--base COMMIT]
Prints every mistake and exits with 1 if there is one.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys

from check_includes import sources, width_problems

LETTERS = 72
SOURCE = re.compile(r"(\.(cpp|hpp|py|sh|cmake|mjs|js|css)|CMakeLists\.txt|\.ci/run)$")
MADE = ("scripts/python/furrow/page/bundle/",)  # by scripts/report/build.sh
SUBJECT = re.compile(r"[\w./*-]+(, [\w./*-]+)*: \S|Revert \"")
SELF = "scripts/check_style.py"


def git(root, *words):
    """Lines that git prints; none without git or outside of a checkout."""
    if not shutil.which("git"):
        return []
    done = subprocess.run(["git", "-C", root, *words], capture_output=True, text=True)
    return done.stdout.split("\n")[:-1] if done.returncode == 0 else []


def wide_lines(root):
    """Of what check_includes.py does not look at."""
    rest = set(git(root, "ls-files", "--cached", "--others", "--exclude-standard")) - set(sources(root))
    return width_problems(root, sorted(file for file in rest if SOURCE.search(file) and not file.startswith(MADE)
                                       and (root / file).is_file()))


def first_commit(root):
    """The last commit that this submission does not hold; none: there is nothing to look at."""
    if upstream := git(root, "rev-parse", "--verify", "-q", "origin/main"):
        if upstream != git(root, "rev-parse", "HEAD"):
            return git(root, "merge-base", "HEAD", *upstream)
    return git(root, "log", "--diff-filter=A", "--format=%H", "--", SELF)[-1:]


def bad_subjects(root, base):
    for line in git(root, "log", "--no-merges", "--format=%h %s", f"{base}..HEAD"):
        commit, subject = line.split(" ", 1)
        if len(subject) > LETTERS:
            yield f"commit {commit}: its subject has {len(subject)} letters, expected at most {LETTERS}: {subject}"
        elif not SUBJECT.match(subject):
            yield f"commit {commit}: expected a subject 'area: imperative': {subject}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    parser.add_argument("--base")
    arguments = parser.parse_args()
    base = [arguments.base] if arguments.base else first_commit(arguments.root)
    found = [*wide_lines(arguments.root), *(bad_subjects(arguments.root, base[0]) if base else ())]
    for problem in found:
        print(problem)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
