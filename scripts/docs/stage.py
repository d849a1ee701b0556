#!/usr/bin/env python3
"""Puts the pages of this repository together for Sphinx: usage: scripts/docs/stage.py FOLDER [--root ROOT]

Every Markdown page of a room keeps its path; those of scripts/docs/ go to the top. Relative links are rewritten for the
new places: a link to a page or a picture stays one, a link to a folder leads to its README.md, and any other file that
a page links to is copied so that the site offers it. Links of pages work in the repository and in the site alike.
"""
import argparse
import os
import pathlib
import re
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import check_docs

HOME = pathlib.PurePosixPath("scripts/docs")  # its pages stand at the top of the site
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
CODE = re.compile(r"(`[^`]+`)")
FENCE = re.compile(r"\s*(```|~~~|:::)")


def place(page):
    """Where a page of the repository is in the site."""
    return page.relative_to(HOME) if page.is_relative_to(HOME) else page


class Stage:
    def __init__(self, root, folder):
        self.root, self.folder = root, folder
        self.pages = [pathlib.PurePosixPath(page.relative_to(root)) for page in check_docs.pages(root)]
        self.others = set()  # files that pages link to

    def target(self, page, link):
        """What a link of the page becomes; empty where the site has nothing to link to."""
        path, _, part = link.partition("#")
        if re.match(r"[a-z]+:", link) or not path:
            return link
        full = os.path.normpath(page.parent / path)
        if full.startswith(".."):
            raise ValueError(f"{page}: links to '{link}', which is outside of the repository")
        goal = pathlib.PurePosixPath(full)
        if (self.root / goal).is_dir():
            goal = goal / "README.md"
            if goal not in self.pages:
                return ""
        if goal not in self.pages:
            self.others.add(goal)
        new = os.path.relpath(place(goal), place(page).parent)
        return f"{new}#{part}" if part else new

    def rewritten(self, page, text):
        def link(match):
            target = self.target(page, match[3])
            return f"{match[1]}[{match[2]}]({target})" if target else match[2]

        def prose(line):
            # Code in backticks is kept, but a link may have code for its text.
            kept = []
            def keep(match):
                kept.append(match[0])
                return f"\0{len(kept) - 1}\0"
            line = LINK.sub(link, CODE.sub(keep, line))
            return re.sub(r"\0(\d+)\0", lambda match: kept[int(match[1])], line)

        # Prose is rewritten by stretches, since a link's text may go over the end of a line.
        stretches, fence = [(False, [])], ""
        for line in text.splitlines(keepends=True):
            mark = FENCE.match(line)
            if fence or (mark and not fence):
                begins = not fence
                if begins:
                    stretches.append((True, []))
                    fence = mark[1]
                stretches[-1][1].append(line)
                if not begins and mark and mark[1] == fence and line.strip() == fence:
                    fence = ""
                    stretches.append((False, []))
                continue
            stretches[-1][1].append(line)
        return "".join("".join(lines) if code else prose("".join(lines)) for code, lines in stretches)

    def write(self):
        for page in self.pages:
            write_if_changed(self.folder / place(page), self.rewritten(page, (self.root / page).read_text()))
        for other in sorted(self.others):
            source, target = self.root / other, self.folder / place(other)
            if not source.is_file():
                raise ValueError(f"'{other}' is linked to, but there is no such file")
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target)
        wanted = {self.folder / place(page) for page in self.pages}
        for old in self.folder.rglob("*.md"):
            if old not in wanted and not old.is_relative_to(self.folder / "reference"):
                old.unlink()


def write_if_changed(path, text):
    """Sphinx reads again what has a new time."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.is_file() or path.read_text() != text:
        path.write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2])
    options = parser.parse_args()
    try:
        Stage(options.root.resolve(), options.folder.resolve()).write()
    except ValueError as error:
        print(f"docs: error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
