# SPDX-License-Identifier: Apache-2.0
# Sphinx' configuration of the site that scripts/site.sh builds.

import os
import re
from pathlib import Path

project = "kelpie"
copyright = "the kelpie developers"
root_doc = "index"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinxcontrib.bibtex"]
bibtex_bibfiles = ["docs/bibliography.bib"]
bibtex_default_style = "plain"
myst_heading_anchors = 5
suppress_warnings = ["myst.header", "misc.highlighting_failure"]
exclude_patterns = ["build"]
html_theme = "furo"
html_title = "kelpie"
html_copy_source = False
html_show_sourcelink = False
html_extra_path = [os.environ["KELPIE_SITE_EXTRA"]]
html_static_path = ["static"]
html_css_files = ["site.css"]
autodoc_member_order = "bysource"
autodoc_typehints = "none"
highlight_language = "text"
napoleon_use_ivar = True


def plain_docstring(app, what, name, obj, options, lines):
    """Names in single backticks become literals; bars of |x| are no substitutions."""
    text = re.sub(r"(?<!`)`([^`]+)`(?!`)", r"``\1``", "\n".join(lines))
    parts = re.split(r"(``.*?``)", text, flags=re.S)
    parts[::2] = [part.replace("|", "\\|") for part in parts[::2]]
    lines[:] = "".join(parts).split("\n")


def without_frameworks(app):
    """Neither Sphinx 5 nor Furo uses jQuery and underscore, which Sphinx 5 puts on every page."""
    unused = ("jquery", "underscore", "_sphinx_javascript_frameworks_compat")
    scripts = app.builder.script_files
    scripts[:] = [script for script in scripts if not any(name in script for name in unused)]


def self_contained(app, exception):
    """Debian's Furo loads a style sheet of the system, and a script as a module, which browsers
    load from servers alone: neither works from a folder."""
    static = Path(app.outdir) / "_static"
    begin = "@import url(/javascript/"
    for sheet in (static / "styles").glob("*.css"):
        text = sheet.read_text(encoding="utf-8")
        if text.startswith(begin):
            name, rest = text.removeprefix(begin).split(");", 1)
            other = Path("/usr/share/javascript", name).read_text(encoding="utf-8")
            sheet.write_text(other + rest, encoding="utf-8")
    for script in (static / "scripts").glob("*.js"):
        found = re.match(r'import \w+ from "\./(.+)";', script.read_text(encoding="utf-8"))
        if found:
            text = script.read_text(encoding="utf-8")[found.end():]
            module = (script.parent / found[1]).read_text(encoding="utf-8")
            script.write_text(module + text, encoding="utf-8")


def setup(app):
    app.connect("autodoc-process-docstring", plain_docstring, priority=1)
    app.connect("builder-inited", without_frameworks, priority=900)
    app.connect("build-finished", self_contained, priority=900)
