# SPDX-License-Identifier: Apache-2.0
"""The site of these pages, built by Sphinx: `make docs` leaves it in out/docs."""

project = "Eel simulator"
author = "Eel simulator maintainers"
copyright = "Eel simulator maintainers, Apache-2.0"
extensions = [
    "myst_nb",  # Markdown, and the notebook as it stands
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinxcontrib.mermaid",
]
root_doc = "index"
exclude_patterns = ["requirements.*", "examples"]
nb_execution_mode = "off"  # `make notebook` runs it
nb_merge_streams = True
myst_heading_anchors = 3
myst_fence_as_directive = ["mermaid"]
default_role = "code"
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # signatures stay readable; docstrings give shapes and units
html_theme = "furo"
html_title = project
html_copy_source = False
html_show_sphinx = False
html_static_path = []
