# SPDX-License-Identifier: Apache-2.0
"""docs/appendix/transcript.md is of the present sections of tools/transcript, which `make transcript` runs."""

import ast
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def test_the_page_has_each_section_once():
    parsed = ast.parse((ROOT / "tools/transcript/sections.py").read_text())
    headings = {each.name: ast.get_docstring(each) for each in parsed.body if isinstance(each, ast.FunctionDef)}
    (names,) = (each.value.elts for each in parsed.body if ast.unparse(each).startswith("SECTIONS ="))
    page = (ROOT / "docs/appendix/transcript.md").read_text()
    found = [line for line in page.splitlines() if line.startswith("## ")]
    assert found == [f"## {number}. {headings[name.id]}" for number, name in enumerate(names, 1)]
    assert "Traceback" not in page and "status 1\n" not in page.partition("## 5.")[0]
