# SPDX-License-Identifier: Apache-2.0
"""The site of these pages, built by Sphinx: `make docs` leaves it in out/docs."""

import re
from importlib.metadata import files
from pathlib import Path

project = "Eel simulator"
manifest = Path(__file__).parents[1] / "src" / "eel_dynamics" / "package.xml"
version = re.findall(r"<version>(.*)</version>", manifest.read_text())[0]
author = "Eel simulator maintainers"
copyright = "Eel simulator maintainers, Apache-2.0"
extensions = [
    "myst_nb",  # Markdown, and the notebook as it stands
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.mathjax",
]
root_doc = "index"
exclude_patterns = ["requirements.*", "examples", "site"]
nb_execution_mode = "off"  # `make notebook` runs it
nb_merge_streams = True
myst_heading_anchors = 3
myst_enable_extensions = ["dollarmath"]
napoleon_use_ivar = True
default_role = "code"
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # signatures stay readable; docstrings give shapes and units
html_theme = "furo"
html_title = f"{project} {version}"
html_copy_source = False
html_show_sphinx = False
mathjax_path = "tex-svg.js"  # shipped by the package: one file with its fonts, nothing from the network
(mathjax,) = (str(path.locate()) for path in files("sphinx-mathjax-offline") or () if path.name == mathjax_path)
html_static_path = ["site", mathjax]
html_css_files, html_js_files = ["site.css"], ["tables.js", "copy.js", ("swims.js", {"defer": "defer"})]
html_search_scorer = str(Path(__file__).with_name("site") / "search.js")
# Rerun's web viewer would ask other servers for its newest release, and tell them of its use
POLICY = """<meta http-equiv="Content-Security-Policy" content="connect-src 'self'">"""
LINK_OUT = re.compile(r"\[([^\]]+)\]\((\.\./[^)#]+)\)")


def without_links_to_folders(app, name, source):
    """Outside docs/ the site offers single files of code; folders and pages there are named, not linked."""
    folder, root = (Path(app.srcdir) / name).parent, Path(app.srcdir).resolve()

    def shown(link: re.Match) -> str:
        target = (folder / link[2]).resolve()
        named = root not in target.parents and (target.is_dir() or target.suffix == ".md")
        return link[1] if named else link[0]

    source[0] = LINK_OUT.sub(shown, source[0])


def with_policy(app, name, template, context, tree):
    """A page's scripts reach the site itself alone."""
    context["metatags"] = context.get("metatags", "") + POLICY


def setup(app):
    """What Sphinx calls first."""
    app.connect("source-read", without_links_to_folders)
    app.connect("html-page-context", with_policy)
