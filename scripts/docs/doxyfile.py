#!/usr/bin/env python3
"""Prints the settings by which Doxygen reads the headers that scripts/docs/api.md shows.

usage: scripts/docs/doxyfile.py --out FOLDER [--root ROOT]
"""
import argparse
import pathlib
import re

SETTINGS = """PROJECT_NAME = Furrow
OUTPUT_DIRECTORY = {out}
INPUT = {inputs}
STRIP_FROM_PATH = {root}
STRIP_FROM_INC_PATH = {root}
FULL_PATH_NAMES = YES
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
XML_PROGRAMLISTING = NO
MARKDOWN_SUPPORT = NO
AUTOLINK_SUPPORT = NO
JAVADOC_AUTOBRIEF = YES
EXTRACT_ALL = YES
EXTRACT_PRIVATE = NO
HIDE_FRIEND_COMPOUNDS = YES
QUIET = YES
WARNINGS = NO
"""


def headers(page):
    return re.findall(r"^### `(\S+)`$", page.read_text(), re.MULTILINE)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2])
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    root = options.root.resolve()
    inputs = [f'"{root / name}"' for name in headers(root / "scripts/docs/api.md")]
    print(SETTINGS.format(out=f'"{options.out.resolve()}"', root=f'"{root}"', inputs=" ".join(inputs)))


if __name__ == "__main__":
    main()
