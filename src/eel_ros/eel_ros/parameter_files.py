# SPDX-License-Identifier: Apache-2.0
"""Reads which names the parameter files of a command line set for all nodes: under `/**`, or another `*`."""

import contextlib
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

from eel_base.files.yaml_tree import read_yaml

OPTION, VALUES = "--params-file", "ros__parameters"


def shared_names(words: Sequence[str]) -> set[str]:
    """The names that the files in the command line `words` set for all nodes. A file that cannot be read has none."""
    names: set[str] = set()
    for option, path in pairwise(words):
        if option == OPTION:
            with contextlib.suppress(ValueError, OSError):  # ROS has read it before
                names |= set(_names(read_yaml(path), "", ""))
    return names


def _names(content: Any, node: str, prefix: str) -> Iterator[str]:
    """The names below a namespace or `node`, or below its parameters that begin with the `prefix`."""
    for key, value in content.items() if isinstance(content, dict) else ():
        if prefix and not isinstance(value, dict):
            yield f"{prefix}{key}"[1:]
        elif prefix or (key == VALUES and "*" in node):
            yield from _names(value, node, f"{prefix}{key}." if prefix else ".")
        else:
            yield from _names(value, str(key), "")
