"""Sphinx extension: formulas of a page ($…$, $$…$$) by KaTeX, from files beside the page, without the network."""
import html
import pathlib
import shutil

KATEX = pathlib.Path("/usr/share/javascript/katex")  # Debian's libjs-katex, with its fonts
START = """document.addEventListener("DOMContentLoaded", () => {
  for (const element of document.querySelectorAll(".katex-source"))
    katex.render(element.textContent, element, {displayMode: element.tagName === "DIV", throwOnError: false});
});
"""


def visit_inline(translator, node):
    translator.body.append(f'<span class="katex-source">{html.escape(node.astext())}</span>')
    raise translator_done()


def visit_block(translator, node):
    translator.body.append(f'<div class="katex-source">{html.escape(node.astext())}</div>\n')
    raise translator_done()


def translator_done():
    from docutils import nodes
    return nodes.SkipNode()


def copy_files(app):
    target = pathlib.Path(app.outdir) / "_static" / "katex"
    if not KATEX.is_dir():
        raise FileNotFoundError(f"{KATEX} is missing, expected Debian's libjs-katex (scripts/setup.sh --docs)")
    target.mkdir(parents=True, exist_ok=True)
    for name in ("katex.min.css", "katex.min.js"):
        shutil.copyfile(KATEX / name, target / name)
    shutil.copytree(KATEX / "fonts", target / "fonts", dirs_exist_ok=True)
    (target / "start.js").write_text(START)


def add_to_page(app, _page, _template, _context, doctree):
    from docutils import nodes
    if doctree and any(doctree.findall(lambda node: isinstance(node, (nodes.math, nodes.math_block)))):
        app.add_css_file("katex/katex.min.css")
        app.add_js_file("katex/katex.min.js")
        app.add_js_file("katex/start.js")


def setup(app):
    app.add_html_math_renderer("katex", (visit_inline, None), (visit_block, None))
    app.connect("builder-inited", lambda app: copy_files(app) if app.builder.format == "html" else None)
    app.connect("html-page-context", add_to_page)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
