#!/usr/bin/env python3
"""Checks the pages: no prose line over 120 columns, no relative link and no path in backticks that leads nowhere.

Tables, code blocks and lines without a space to break at may be longer. A link's #part must be a heading of the page
that it names. A path in backticks counts if it begins with a folder of the top level; `*` and `{a,b}` are expanded,
`<name>` stands for any name, and `path:12` must have such a line. A source or script without its folder, or with the
last of its folders, must exist somewhere; so must one that a comment of a C++ source names. The figures of the headline
run stand in README.md as its scenario states them. Every term of the glossary names at least one file, and every recipe
of CONTRIBUTING.md at most five; what a step names in parentheses is to be read, not touched, and does not count.

A commit that a page or a table names is in the history, where the checkout has all of it. What is taken for one: words
of seven or eight hexadecimal digits, both letters and numbers among them.

The gallery leaves out none of the shipped scenarios, studies and calibrations. Every CSV file under tests/,
every JSON file of results under tests/studies, tests/benchmarks and tests/peers, and what a soil file says was
measured, names commit, compiler, processor and command of its making (tests/studies/provenance.py), and some page names
the file.

usage: scripts/check_docs.py [--root FOLDER] [PAGE ...]
Prints every mistake as PAGE:LINE and exits with 1 if there is one. Without arguments it reads all pages.
"""
import argparse
import fnmatch
import json
import pathlib
import re
import shutil
import subprocess
import sys

WIDTH = 120
LINK = re.compile(r"\]\(([^)\s]+)\)")
CODE = re.compile(r"`([^`]+)`")
MOST_FILES = 5  # of a recipe
ORIGIN = ("commit", "compiler", "processor", "command")  # of a table
COMMIT = re.compile(r"(?<![\w.-])(?=\d*[a-f])(?=[a-f]*\d)[0-9a-f]{7,8}\b(?!-|\.\d)")
TOP = {"nodes", "protocol", "tire", "terrain", "vehicle", "rigs", "tests", "scripts"}
PATH = re.compile(r"([\w.<>*{},-]+(?:/[\w.<>*{},-]+)+/?)(?::(\d+))?$")
SOURCE = r"[\w-]+(?:/[\w-]+)*\.(?:cpp|hpp|py|sh)"
GENERATED = {"cpu_features.hpp"}  # while the program is built
LISTS = ("scripts/docs/gallery.md",)  # of all that rigs/ ships
HEADLINE = "rigs/drawbar_pull_small.json"
STATED = (("drawbar_pull", 1.0, "N"), ("sinkage", 1e3, "mm"), ("rut_depth", 1e3, "mm"))  # keys of its `expected`


def pages(root):
    return sorted(root.glob("*.md")) + [page for folder in sorted(TOP)
                                        for page in sorted((root / folder).rglob("*.md"))]


def names_of_sources(root):
    """Of all sources and scripts: their names, without their folders and with the last of them."""
    names = set(GENERATED)
    for folder in TOP:
        for file in (root / folder).rglob("*"):
            if re.fullmatch(SOURCE, file.name):
                parts = file.relative_to(root).parts
                names.update("/".join(parts[k:]) for k in range(len(parts)))
    return names


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


def link_problem(root, page, target):
    if re.match(r"[a-z]+:", target):
        return ""
    path, _, part = target.partition("#")
    file = (page.parent / path).resolve() if path else page
    if not file.exists():
        return f"link to '{target}', which does not exist"
    if part and part not in anchors(file):
        return f"link to '{target}', but {file.relative_to(root)} has no such heading"
    return ""


def alternatives(path):
    """`a.{hpp,cpp}` as a.hpp and a.cpp."""
    match = re.search(r"\{([^}]*)\}", path)
    if not match:
        return [path]
    return [name for word in match[1].split(",")
            for name in alternatives(path[:match.start()] + word + path[match.end():])]


def path_problem(root, text, sources):
    if re.fullmatch(SOURCE, text) and text.split("/")[0] not in TOP and text not in sources:
        return f"names '{text}', which does not exist in any folder"
    match = PATH.match(text)
    if not match or text.split("/")[0] not in TOP:
        return ""
    for name in alternatives(re.sub(r"<[^>]*>", "*", match[1].rstrip("/"))):
        found = list(root.glob(name))
        if not found:
            return f"names '{name}', which does not exist"
        if match[2] and not any(file.is_file() and len(file.read_text().splitlines()) >= int(match[2])
                                for file in found):
            return f"names line {match[2]} of '{name}', which has no such line"
    return ""


def problems(root, page, sources):
    for number, text, kind in lines_of(page):
        if kind == "prose" and len(text) > WIDTH and " " in text.strip():
            yield number, f"is {len(text)} columns wide, expected at most {WIDTH}"
        if kind == "code":
            continue
        for target in LINK.findall(CODE.sub("", text)):
            if problem := link_problem(root, page, target):
                yield number, problem
        for code in CODE.findall(text):
            if problem := path_problem(root, code, sources):
                yield number, problem
        if page == root / "GLOSSARY.md" and kind == "table" and not re.match(r"\| term \||\|-", text):
            if not any((root / code).is_file() for code in CODE.findall(text.rsplit("|", 2)[1])):
                yield number, "names no file"


def comment_problems(root, sources):
    """(file, number, problem) of the comments of C++ sources."""
    for folder in sorted(TOP):
        for file in sorted((root / folder).rglob("*.[ch]pp")):
            for number, text in enumerate(file.read_text().splitlines(), 1):
                comment = re.search(r"(?:^|\s)//(.*)", text)
                for name in re.findall(rf"(?<![\w./<>-]){SOURCE}\b", comment[1]) if comment else []:
                    if name not in sources:
                        yield file, number, f"names '{name}', which does not exist"


def touched(text):
    """Files that the text of a step names outside parentheses."""
    return {code for code in CODE.findall(re.sub(r"\([^()]*\)", "", text)) if PATH.match(code)}


def recipe_problems(page):
    """Recipes are the sections 'Add …': a numbered list whose entries begin with a file."""
    title, files, step = None, set(), False
    for number, text, kind in lines_of(page):
        if kind == "prose" and text.startswith("#"):
            title, files = text.lstrip("# "), set()
        begins = re.match(r"\d+\. ", text)
        step = bool(begins) or (step and text.startswith("   "))
        if not (title and title.startswith("Add ") and step):
            continue
        if begins and not re.match(r"\d+\. `[^`]*/[^`]*`", text):
            yield number, "begins with no file"
        before, files = len(files), files | touched(text)
        if len(files) > max(before, MOST_FILES):
            yield number, f"names file {len(files)} of '{title}', expected at most {MOST_FILES}"


def headline_problems(root):
    """What the scenario of the headline run expects, and README.md does not say."""
    expected = json.loads((root / HEADLINE).read_text()).get("expected", {})
    text = " ".join((root / "README.md").read_text().split())
    for key, scale, unit in STATED:
        if key not in expected:
            continue
        figure = f"{scale * expected[key]:.4g} ± {scale * expected[key + '_spread']:.4g} {unit}"
        if figure not in text:
            yield f"does not say '{figure}', which {HEADLINE} expects as {key}"


def origin_of_table(text):
    """{key: value} of the comment lines at the head of a CSV file."""
    head = [line[1:].strip() for line in text.splitlines() if line.startswith("#")]
    return dict(line.split(": ", 1) for line in head if ": " in line)


def is_study(content):
    """Of a JSON file: that it says what to run, and holds no results."""
    return isinstance(content, dict) and isinstance(content.get("scenario"),
                                                    str) and bool({"cases", "list", "grid"} & content.keys())


def tables(root):
    """(file, origin) of every table that is kept."""
    for file in sorted((root / "tests").rglob("*.csv")):
        yield file, origin_of_table(file.read_text())
    for folder in ("studies", "benchmarks", "peers"):
        for file in sorted((root / "tests" / folder).rglob("*.json")):
            content = json.loads(file.read_text())
            if not is_study(content):
                yield file, content.get("made", {}) if isinstance(content, dict) else {}
    for file in sorted((root / "terrain" / "data").glob("*.json")):
        if measured := json.loads(file.read_text()).get("measured"):
            yield file, measured.get("made", {})


def table_problems(root):
    text = "".join(page.read_text() for page in pages(root))
    patterns = re.findall(r"[\w-]+\*\.(?:csv|json)", text)
    for file, origin in tables(root):
        missing = [key for key in ORIGIN if not str(origin.get(key, "")).strip()]
        if missing:
            yield file, f"does not say with what it was made: expected {', '.join(missing)}"
        if file.name not in text and not any(fnmatch.fnmatch(file.name, pattern) for pattern in patterns):
            yield file, "is named on no page"


def git(root, *arguments, **options):
    """What git prints; nothing where it is not installed."""
    if not shutil.which("git"):
        return ""
    return subprocess.run(["git", "-C", str(root), *arguments], capture_output=True,
                          text=True, check=False, **options).stdout


def commits_named(root):
    """(file, number, name) of every commit on pages and in tables."""
    for page in pages(root):
        for number, text, kind in lines_of(page):
            yield from ((page, number, name) for name in COMMIT.findall(text) if kind != "code")
    for file, origin in tables(root):
        yield from ((file, 1, name) for name in re.findall(r"\b[0-9a-f]{7,40}\b", str(origin.get("commit", ""))))


def commit_problems(root):
    if git(root, "rev-parse", "--show-toplevel", "--is-shallow-repository").split() != [str(root), "false"]:
        return
    named = list(commits_named(root))  # none of them is in a history that begins anew, for example a squashed one
    asked = "".join(f"{name}^{{commit}}\n" for _, _, name in named)
    unknown = [answer.endswith(" missing") for answer in git(root, "cat-file",
                                                             "--batch-check", input=asked).splitlines()]
    if not all(unknown):
        for (file, number, name), gone in zip(named, unknown):
            if gone:
                yield file, number, f"names commit {name}, which is not in the history"


def unlisted(root):
    """(page, file) of every shipped scenario, study and calibration that a list of them leaves out."""
    shipped = [file.name for file in sorted((root / "rigs").glob("*.json")) if not file.name.endswith(".schema.json")]
    for page in map(root.joinpath, LISTS):
        if page.exists():
            text = page.read_text()
            yield from ((page, name) for name in shipped if f"`{name}`" not in text)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    parser.add_argument("pages", nargs="*", type=pathlib.Path)
    options = parser.parse_args()
    root = options.root.resolve()
    sources = names_of_sources(root)
    chosen = [page.resolve() for page in options.pages] or pages(root)
    found = [f"{page.relative_to(root)}:{number}: {text}" for page in chosen for number,
             text in problems(root, page, sources)]
    if (root / "CONTRIBUTING.md").exists():
        found += [f"CONTRIBUTING.md:{number}: {text}" for number, text in recipe_problems(root / "CONTRIBUTING.md")]
    if (root / HEADLINE).exists():
        found += [f"README.md: {text}" for text in headline_problems(root)]
    if not options.pages:
        found += [f"{file.relative_to(root)}:1: {text}" for file, text in table_problems(root)]
        found += [f"{file.relative_to(root)}:{number}: {text}" for file,
                  number, text in comment_problems(root, sources)]
        found += [f"{file.relative_to(root)}:{number}: {text}" for file, number, text in commit_problems(root)]
        found += [f"{page.relative_to(root)}:1: does not list rigs/{name}" for page, name in unlisted(root)]
    print("\n".join(found), end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
