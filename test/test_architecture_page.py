# SPDX-License-Identifier: Apache-2.0
"""The pages architecture and misprints of docs/explanation name files and functions that exist; the examples apply."""

import ast
import os
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "explanation" / "architecture.md"
MISPRINTS = ROOT / "docs" / "explanation" / "misprints.md"
EXAMPLES = sorted((ROOT / "docs" / "examples").glob("*.diff"))
SOURCES = (".py", ".hpp", ".cpp", ".msg")
NEAR = 3  # files more or fewer than the table says: it tells how large a folder is


def linked(line: str) -> list[Path]:
    """Targets inside the repository that a line of the page links."""
    targets = re.findall(r"\]\(([^)]+)\)", line)
    return [(PAGE.parent / target).resolve() for target in targets if "://" not in target]


def python_names(source: str) -> set[str]:
    """Functions, classes and methods ("Class.method") of a module."""
    names = set()
    for node in ast.parse(source).body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            names.add(node.name)
        if isinstance(node, ast.ClassDef):
            names |= {f"{node.name}.{each.name}" for each in node.body if isinstance(each, ast.FunctionDef)}
    return names


def stands_in(name: str, path: Path) -> bool:
    """Whether the file defines a function, class or method: "name", "Class.name" (Python) or "Class::name" (C++)."""
    source = path.read_text()
    if path.suffix == ".py":
        return name in python_names(source)
    *outer, last = name.split("::")
    classes = all(re.search(rf"\b(struct|class) {each}\b", source) for each in outer)
    defined = rf"\b(struct|class) {last}\b|^[^/\n]*(?<!return)(?<=[\w>&*]) {last}\("
    return classes and re.search(defined, source, re.MULTILINE) is not None


def applied(example: Path) -> subprocess.CompletedProcess:
    """`git apply --check` of an example to this tree, also where it lies within another repository."""
    return subprocess.run(
        ["git", "apply", "--check", example],
        cwd=ROOT,
        env={**os.environ, "GIT_CEILING_DIRECTORIES": str(ROOT.parent)},
        capture_output=True,
        text=True,
    )


@pytest.mark.parametrize(("page", "least"), [(PAGE, 50), (MISPRINTS, 12)], ids=lambda value: getattr(value, "stem", ""))
def test_links_lead_to_files_and_folders(page, least):
    targets = [target for target in linked(page.read_text()) if "#" not in target.name]
    assert len(targets) > least
    assert [str(target) for target in targets if not target.exists()] == []


@pytest.mark.parametrize(("page", "least"), [(PAGE, 40), (MISPRINTS, 12)], ids=lambda value: getattr(value, "stem", ""))
def test_functions_stand_in_the_files_linked_on_their_line(page, least):
    checked, missing = 0, []
    for line in page.read_text().splitlines():
        files = [target for target in linked(line) if target.suffix in (".py", ".hpp", ".cpp")]
        for name in re.findall(r"`([A-Za-z_][\w.:]*)`", line) if files else []:
            checked += 1
            if not any(stands_in(name, path) for path in files):
                missing.append(f"{name}: {line[:60]}")
    assert checked > least
    assert missing == []


def test_functions_that_are_not_defined_are_found_out():
    folder = ROOT / "src" / "eel_core" / "include" / "eel_core"
    assert stands_in("configure", folder / "kinematics.hpp")
    assert not stands_in("configure", folder / "algorithm.hpp")  # which only calls it
    assert not stands_in("Law.combine", ROOT / "src" / "eel_gaits" / "eel_gaits" / "laws" / "law.py")


def test_table_tells_the_size_of_folders():
    rows = re.findall(r"^\| \[[^]]+\]\(([^)]+)\) \|.*\| (\d+) \|$", PAGE.read_text(), re.MULTILINE)
    assert len(rows) > 15
    for folder, count in rows:
        files = [
            path
            for path in (PAGE.parent / folder).resolve().rglob("*")
            if path.suffix in SOURCES and path.name != "__init__.py"
        ]
        assert abs(len(files) - int(count)) <= NEAR, f"{folder}: {len(files)} files, the page says {count}"


def test_page_links_every_example():
    assert EXAMPLES
    assert {target for target in linked(PAGE.read_text()) if target.suffix == ".diff"} == set(EXAMPLES)


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_example_applies(example):
    done = applied(example)
    assert done.returncode == 0, done.stderr


def test_example_of_another_tree_does_not_apply(tmp_path):
    stale = tmp_path / "stale.diff"
    text = EXAMPLES[0].read_text()
    removed = re.search(r"^-(?!--).*$", text, re.MULTILINE)
    stale.write_text(text.replace(removed[0], "-what no file has"))
    assert applied(stale).returncode != 0
