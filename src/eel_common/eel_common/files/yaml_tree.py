# SPDX-License-Identifier: Apache-2.0
"""Reads a YAML file into mappings, lists and scalars that know their lines. Size, levels and aliases are bounded."""

import os
import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NoReturn, TypeVar

import yaml

from eel_common.files.input_file import InputFile, Misplaced, is_number, reading
from eel_common.wording import did_you_mean, shown

Made = TypeVar("Made")

MOST_BYTES, MOST_NODES, DEEPEST = 500_000, 20_000, 32
LONGEST_SCALAR = 1000  # characters of a number or a date


class Entries(dict[str, Any]):
    """A mapping of the file: keys to values. `line` is its own line, `lines` those of its keys."""

    def __init__(self, line: int) -> None:
        super().__init__()
        self.line = line
        self.lines: dict[str, int] = {}


def read_yaml(path: str | os.PathLike[str]) -> Any:
    """The document in a YAML file: `Entries`, a list, a scalar, or None.

    `Misplaced` for invalid YAML, or beyond the bounds; otherwise `ValueError`, `OSError`.
    """
    with InputFile(path, MOST_BYTES) as file:
        return from_yaml(file.read().decode("utf-8"))


def from_yaml(text: str, most: int = MOST_NODES) -> Any:
    """The document in a YAML `text` of at most `most` values. Errors as in `read_yaml`."""
    try:
        loader = _Loader(text, most)
        node = loader.get_single_node()
        return None if node is None else loader.value(node, 1)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        rule = getattr(error, "problem", None) or str(error)
        raise (ValueError(rule) if mark is None else Misplaced(f"line {mark.line + 1}", rule)) from None


class _Loader(yaml.SafeLoader):
    """PyYAML's safe loader, with bounds on levels and nodes. A node counts each time an alias names it."""

    def __init__(self, text: str, most: int) -> None:
        super().__init__(text)
        self._most = most
        self._depth = self._nodes = self._values = 0

    def compose_node(self, parent: Any, index: Any) -> Any:
        self._depth, self._nodes = self._depth + 1, self._nodes + 1
        self._check(self._depth, self._nodes, self.peek_event().start_mark)
        node = super().compose_node(parent, index)
        self._depth -= 1
        return node

    def value(self, node: Any, depth: int) -> Any:
        """The value of a node. An alias counts as all the nodes it names."""
        self._values += 1
        self._check(depth, self._values, node.start_mark)
        if isinstance(node, yaml.SequenceNode):
            return [self.value(each, depth + 1) for each in node.value]
        if isinstance(node, yaml.ScalarNode):
            return self._scalar(node)
        entries = Entries(node.start_mark.line + 1)
        for key_node, value_node in node.value:
            key, line = self.value(key_node, depth + 1), key_node.start_mark.line + 1
            if not isinstance(key, str) or key in entries:
                wrong = "comes twice" if isinstance(key, str) else "is no text"
                raise Misplaced(f"line {line}, key {shown(key)}", wrong)
            entries[key], entries.lines[key] = self.value(value_node, depth + 1), line
        return entries

    def _scalar(self, node: Any) -> Any:
        line = node.start_mark.line + 1
        if node.tag != "tag:yaml.org,2002:str" and len(node.value) > LONGEST_SCALAR:
            rule = f"a value must have at most {LONGEST_SCALAR} characters, got {len(node.value)}"
            raise Misplaced(f"line {line}", rule)
        try:
            value = self.construct_object(node)
        except yaml.YAMLError:
            raise
        except Exception as error:  # the tag does not fit the value
            rule = f"{shown(node.value)} is no {node.tag.rpartition(':')[2]}: {error}"
            raise Misplaced(f"line {line}", rule) from None
        if isinstance(value, str) and node.style is None and is_number(value):
            return float(value)  # such as 1e-3, a text in YAML 1.1
        return value

    def _check(self, depth: int, nodes: int, mark: Any) -> None:
        if depth > DEEPEST or nodes > self._most:
            rule = "too many levels" if depth > DEEPEST else f"more than {self._most} values, with all aliases"
            raise Misplaced(f"line {mark.line + 1}", rule)


# -- errors in objects built from a document; only a file's mapping has lines


def fail(entries: Mapping[str, Any], key: str, reason: object) -> NoReturn:
    """`Misplaced` at the `key` of a mapping, or at the mapping where the key is empty."""
    line = [f"line {entries.lines.get(key, entries.line)}"] if isinstance(entries, Entries) else []
    place = ", ".join([*line, *([f"key {shown(key)}"] if key else [])])
    raise Misplaced(place or "document", str(reason)) from None


def check_keys(entries: Mapping[str, Any], known: Iterable[str]) -> None:
    """`Misplaced` for a key that is none of those `known`."""
    names = list(known)
    for key in entries:
        if key not in names:
            fail(entries, key, f"is unknown, must be one of {', '.join(names)}{did_you_mean(key, names)}")


def tried(entries: Mapping[str, Any], key: str, make: Callable[..., Made], *arguments: Any, **options: Any) -> Made:
    """Call `make` on the arguments. Its error is reported at the `key`, or at the first key that its text names."""
    try:
        with reading(""):
            return make(*arguments, **options)
    except Misplaced:
        raise
    except ValueError as error:
        named = (word for word in re.findall(r"\w+", str(error)) if word in entries)
        fail(entries, key or next(named, ""), error)
