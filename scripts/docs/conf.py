"""Settings of the documentation site: see scripts/docs.sh, which puts the pages together and calls Sphinx."""
import os
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

project = "Furrow"
author = "The Furrow authors"
copyright = author
version = release = re.search(r"project\(furrow VERSION ([\d.]+)", (HERE.parents[1] / "CMakeLists.txt").read_text())[1]

extensions = ["myst_parser", "breathe", "katex_math", "furo_whole"]
source_suffix = {".md": "markdown"}
root_doc = "index"
nitpicky = False

# Pages are also read where the repository is looked at: headings get the anchors that are used there.
myst_heading_anchors = 4
myst_enable_extensions = ["dollarmath"]
myst_dmath_double_inline = True
# A room's page may begin a level deeper than the one before; examples of JSON leave things out with "…".
suppress_warnings = ["myst.header", "misc.highlighting_failure"]
highlight_language = "none"

breathe_projects = {"furrow": os.environ.get("FURROW_DOXYGEN_XML", "doxygen/xml")}
breathe_default_project = "furrow"
breathe_default_members = ("members",)
primary_domain = "cpp"

html_theme = "furo"
html_title = f"Furrow {version}"
html_static_path = [str(HERE / "static")]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sphinx = False
html_last_updated_fmt = None
html_math_renderer = "katex"
