"""Sphinx extension: the parts that Debian's package of furo leaves to a build step which it does not run.

Its script is a module that imports another one, and its page loads it as a plain script, so that neither the theme
button nor the marked heading in "On this page" works. Its style sheet has dark colours for the theme "dark", and none
for a browser that prefers dark pages, although the colours of code follow the browser. It also takes a second sheet
from a web server's root. All three are mended in the built site; a furo without them is left as it is.
"""
import pathlib
import re
import shutil

JAVASCRIPT = pathlib.Path("/usr/share/javascript")  # what a Debian web server has under /javascript
SHEET = re.compile(r"""@import (?:url\()?["']?/javascript/([\w./-]+)["']?\)?;\n?""")
IMPORT = re.compile(r'^import Gumshoe from "\./gumshoe-patched\.js";\n', re.MULTILINE)
DARK = re.compile(r'body\[data-theme="dark"\] (\{[^}]*\})')


def one_script(scripts):
    """furo.js with the module that it imports before it; that module defines `Gumshoe` for plain scripts too."""
    script = scripts / "furo.js"
    text = script.read_text()
    if IMPORT.search(text):
        script.write_text((scripts / "gumshoe-patched.js").read_text() + "\n" + IMPORT.sub("", text))


def dark_for_dark_browsers(sheet):
    text = sheet.read_text()
    colours = DARK.search(text)
    if colours and "prefers-color-scheme" not in text:
        sheet.write_text(text + '\n@media not print { @media (prefers-color-scheme: dark) {\n  '
                         'body:not([data-theme="light"]) ' + colours[1]
                         + '\n  html body:not([data-theme="light"]) .only-light { display: none !important; }\n'
                         + '  body:not([data-theme="light"]) .only-dark { display: block !important; } } }\n')


def sheets_beside(sheet):
    """Sheets that are imported from the root of a web server come into the site, or are left out where Debian has
    none."""
    def beside(found):
        source = JAVASCRIPT / found[1]
        if not source.is_file():
            return ""
        shutil.copyfile(source, sheet.parent / source.name)
        return f'@import "{source.name}";\n'
    sheet.write_text(SHEET.sub(beside, sheet.read_text()))


def finished(app, error):
    static = pathlib.Path(app.outdir) / "_static"
    if error is None and app.builder.format == "html":
        one_script(static / "scripts")
        sheets_beside(static / "styles" / "furo.css")
        dark_for_dark_browsers(static / "styles" / "furo.css")


def setup(app):
    app.connect("build-finished", finished)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
