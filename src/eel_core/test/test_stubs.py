# SPDX-License-Identifier: Apache-2.0
"""The type stubs name what the compiled module has, no more and no less."""

import ast
from pathlib import Path

import eel_core

STUBS = Path(eel_core.__file__).with_name("_core.pyi")


def stub_names(body: list[ast.stmt]) -> dict[str, ast.stmt]:
    """Public names that statements of a stub file define."""
    named = {}
    for node in body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            named[node.name] = node
        elif isinstance(node, ast.AnnAssign):
            named[node.target.id] = node
    return {name: node for name, node in named.items() if not name.startswith("_")}


def public_names(thing: object) -> set[str]:
    return {name for name in vars(thing) if not name.startswith("_")}


def test_stubs_name_what_the_module_has():
    stubs = stub_names(ast.parse(STUBS.read_text()).body)
    assert set(stubs) == public_names(eel_core._core)
    for name, node in stubs.items():
        if isinstance(node, ast.ClassDef):
            assert set(stub_names(node.body)) == public_names(getattr(eel_core._core, name)), name


def test_stubs_name_the_arguments_of_each_function():
    """pybind11 writes the signature into the first line of a docstring."""
    for name, node in stub_names(ast.parse(STUBS.read_text()).body).items():
        if isinstance(node, ast.FunctionDef):
            signature = getattr(eel_core._core, name).__doc__.splitlines()[0]
            for argument in node.args.posonlyargs + node.args.args + node.args.kwonlyargs:
                assert f"{argument.arg}:" in signature, f"{name}: {signature}"


def test_package_is_marked_as_typed():
    assert STUBS.with_name("py.typed").exists()
