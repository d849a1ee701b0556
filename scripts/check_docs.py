#!/usr/bin/env python3
"""Checks the pages: no prose line over 120 columns, no relative link and no path in backticks that leads nowhere.

Tables, code blocks and lines without a space to break at may be longer. A link's #part must be a heading of the page
that it names. A path in backticks counts if it begins with a folder of the top level; `*` and `{a,b}` are expanded, and
`<name>` stands for any name. Every term of the glossary names at least one file, and
every recipe of CONTRIBUTING.md at most five.

usage: scripts/check_docs.py [PAGE ...]
Prints every mistake as PAGE:LINE and exits with 1 if there is one. Without arguments it reads all pages.
"""
import pathlib
import re
import sys

WIDTH = 120
ROOT = pathlib.Path(__file__).resolve().parent.parent
LINK = re.compile(r"\]\(([^)\s]+)\)")
CODE = re.compile(r"`([^`]+)`")
MOST_FILES = 5  # of a recipe
TOP = {"nodes", "protocol", "tire", "terrain", "vehicle", "rigs", "tests", "scripts"}
PATH = re.compile(r"[\w.<>*{},-]+(/[\w.<>*{},-]+)+/?$")


def pages():
    return sorted(ROOT.glob("*.md")) + [page for folder in sorted(TOP) for page in sorted((ROOT / folder).rglob("*.md"))]


def lines_of(page):
    """@returns (number, text, kind) with kind 'prose', 'table' or 'code'"""
    fenced, before = False, "blank"
    for number, text in enumerate(page.read_text().splitlines(), 1):
        if text.lstrip().startswith("```"):
            fenced, kind = not fenced, "code"
        elif fenced:
            kind = "code"
        elif not text.strip():
            kind = "blank" if before != "code" else "code"
        elif text.startswith("    ") and before in ("blank", "code"):
            kind = "code"
        else:
            kind = "table" if text.lstrip().startswith("|") else "prose"
        before = "blank" if fenced is False and text.lstrip().startswith("```") else kind
        if text.strip():
            yield number, text, kind


def anchors(page):
    """The parts of a page that a link may name, as GitHub makes them from headings."""
    found = set()
    for _, text, kind in lines_of(page):
        if kind == "prose" and text.startswith("#"):
            title = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text.lstrip("#").strip()).lower()
            slug = re.sub(r"[^\w\- ]", "", title).replace(" ", "-")
            found.add(slug if slug not in found else f"{slug}-{sum(name.startswith(slug) for name in found)}")
    return found


def link_problem(page, target):
    if re.match(r"[a-z]+:", target):
        return ""
    path, _, part = target.partition("#")
    file = (page.parent / path).resolve() if path else page
    if not file.exists():
        return f"link to '{target}', which does not exist"
    if part and part not in anchors(file):
        return f"link to '{target}', but {file.relative_to(ROOT)} has no such heading"
    return ""


def alternatives(path):
    """`a.{hpp,cpp}` as a.hpp and a.cpp."""
    match = re.search(r"\{([^}]*)\}", path)
    if not match:
        return [path]
    return [name for word in match[1].split(",") for name in alternatives(path[:match.start()] + word + path[match.end():])]


def path_problem(text):
    if not PATH.match(text) or text.split("/")[0] not in TOP:
        return ""
    for name in alternatives(re.sub(r"<[^>]*>", "*", text.rstrip("/"))):
        if not any(ROOT.glob(name)):
            return f"names '{name}', which does not exist"
    return ""


def problems(page):
    for number, text, kind in lines_of(page):
        if kind == "prose" and len(text) > WIDTH and " " in text.strip():
            yield number, f"is {len(text)} columns wide, expected at most {WIDTH}"
        if kind == "code":
            continue
        for target in LINK.findall(CODE.sub("", text)):
            if problem := link_problem(page, target):
                yield number, problem
        for code in CODE.findall(text):
            if problem := path_problem(code):
                yield number, problem
        if page == ROOT / "GLOSSARY.md" and kind == "table" and not re.match(r"\| term \||\|-", text):
            if not any((ROOT / code).is_file() for code in CODE.findall(text.rsplit("|", 2)[1])):
                yield number, "names no file"


def recipe_problems(page):
    """Recipes are the sections 'Add …': a numbered list whose entries begin with a file."""
    title, count = None, 0
    for number, text, kind in lines_of(page):
        if kind == "prose" and text.startswith("#"):
            title, count = text.lstrip("# "), 0
        if title and title.startswith("Add ") and re.match(r"\d+\. ", text):
            count += 1
            if not re.match(r"\d+\. `[^`]*/[^`]*`", text):
                yield number, "begins with no file"
            if count > MOST_FILES:
                yield number, f"is file {count} of '{title}', expected at most {MOST_FILES}"


def main():
    chosen = [pathlib.Path(name).resolve() for name in sys.argv[1:]] or pages()
    found = [f"{page.relative_to(ROOT)}:{number}: {text}" for page in chosen for number, text in problems(page)]
    found += [f"CONTRIBUTING.md:{number}: {text}" for number, text in recipe_problems(ROOT / "CONTRIBUTING.md")]
    print("\n".join(found), end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
