# SPDX-License-Identifier: Apache-2.0
"""Reads which names the parameter files of a command line set for all nodes: under `/**`, or another `*`.

ROS has read the files before. As there, an alias is an error, and so are many levels.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import yaml
from eel_base.files.input_file import InputFile

OPTION, VALUES = "--params-file", "ros__parameters"
MOST_BYTES = 200_000  # of a file: what follows is not read


def shared_names(words: Sequence[str]) -> set[str]:
    """The names that the files in the command line `words` set for all nodes. A file that cannot be read has none."""
    return {name for option, path in pairwise(words) if option == OPTION for name in _of_file(path)}


class _Texts(yaml.BaseLoader):
    """Leaves all values texts, and refuses aliases."""

    def compose_node(self, parent, index):
        if self.check_event(yaml.AliasEvent):
            raise yaml.YAMLError("a parameter file must have no alias")
        return super().compose_node(parent, index)


def _of_file(path: str) -> set[str]:
    try:
        with InputFile(path) as file:
            text = file.read(min(file.size, MOST_BYTES)).decode("utf-8", "ignore")
        content = yaml.load(text, Loader=_Texts)
    except Exception:  # PyYAML raises others than its own
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
