# SPDX-License-Identifier: Apache-2.0
"""Reads which names the parameter files of a command line set for all nodes: under `/**`, or another `*`."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from pathlib import Path

import yaml

OPTION, VALUES = "--params-file", "ros__parameters"


def shared_names(words: Sequence[str]) -> set[str]:
    """The names that the files in the command line `words` set for all nodes. A file that cannot be read has none."""
    return {name for option, path in pairwise(words) if option == OPTION for name in _of_file(path)}


def _of_file(path: str) -> set[str]:
    try:
        content = yaml.safe_load(Path(path).read_text())
    except (OSError, UnicodeDecodeError, yaml.YAMLError):
        return set()
    return {name for node, names in _nodes(content, "") if "*" in node for name in names}


def _nodes(content, name: str) -> Iterator[tuple[str, list[str]]]:
    """Each node's name and the names of its parameters, below the namespace or node `name`."""
    for key, value in content.items() if isinstance(content, dict) else ():
        if key == VALUES:
            yield name.rpartition("/")[2], list(_names(value, ""))
        else:
            yield from _nodes(value, f"{name}/{key}")


def _names(values, prefix: str) -> Iterator[str]:
    for key, value in values.items() if isinstance(values, dict) else ():
        if isinstance(value, dict):
            yield from _names(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}"
