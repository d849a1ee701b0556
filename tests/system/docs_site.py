#!/usr/bin/python3
"""The documentation site: it is built without a warning, all of its links lead somewhere, and none needs the
network."""
import html.parser
import os
import pathlib
import shutil
import subprocess
import sys
import urllib.parse

from program import PROGRAM, ROOT, SystemTest, main

EXTERNAL = ("http:", "https:", "mailto:", "data:")


class Page(html.parser.HTMLParser):
    """What a page links to, what it loads, and which of its parts can be linked to."""

    def __init__(self, path):
        super().__init__()
        self.links, self.loaded, self.ids = set(), set(), set()
        self.feed(path.read_text())

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.ids.update(given[name] for name in ("id", "name") if given.get(name))
        if tag == "a" and given.get("href"):
            self.links.add(given["href"])
        if tag == "link" and given.get("rel") == "stylesheet":
            self.loaded.add(given["href"])
        if tag in ("img", "script") and given.get("src"):
            self.loaded.add(given["src"])


class Site(SystemTest):
    def test_it_is_built_and_every_link_leads_somewhere(self):
        done = subprocess.run([ROOT / "scripts" / "docs.sh", "--out", self.folder / "docs"], text=True,
                              capture_output=True, env={**os.environ, "FURROW": PROGRAM, "FURROW_NO_SETUP": "1"})
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        site = pathlib.Path(done.stdout.strip()).parent
        pages = {path: Page(path) for path in site.rglob("*.html")}
        self.assertGreater(len(pages), 40)
        problems = [f"{path.relative_to(site)}: {problem}" for path in pages for problem in self.problems(pages, path)]
        self.assertEqual(problems, [])
        for page in ROOT.glob("scripts/docs/*.md"):
            self.assertIn(site / f"{page.stem}.html", pages)
        self.assertIn("katex.min.js", (site / "theory.html").read_text(), "formulas are drawn")
        self.assertTrue((site / "_static" / "katex" / "fonts").is_dir())
        self.assertNotRegex((site / "_static" / "scripts" / "furo.js").read_text(),
                            r"(?m)^import ", "a plain script of one piece")
        for sheet in site.rglob("*.css"):
            self.assertNotRegex(sheet.read_text(), r"""(@import\s+|url\()\s*["']?(/|https?:)""", sheet)
        self.assertIn("prefers-color-scheme: dark", (site / "_static" / "styles" / "furo.css").read_text())

    def problems(self, pages, path):
        page = pages[path]
        yield from (f"loads '{name}' from the network" for name in page.loaded
                    if name.startswith(EXTERNAL[:2]) or name.startswith("//"))
        for link in page.links | page.loaded:
            if link.startswith(EXTERNAL):
                continue
            target, _, part = link.partition("#")
            file = (path.parent / urllib.parse.unquote(target.partition("?")[0])).resolve() if target else path
            if not file.exists():
                yield f"'{link}' leads nowhere"
            elif part and file in pages and urllib.parse.unquote(part) not in pages[file].ids:
                yield f"'{link}': the page has no such part"


if __name__ == "__main__":
    if not (shutil.which("sphinx-build") and shutil.which("doxygen")):
        print("needs the packages of scripts/setup.sh --docs")
        sys.exit(77)
    main()
