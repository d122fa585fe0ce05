# SPDX-License-Identifier: Apache-2.0
"""Definitions and hashes of message types, as bags store them.

Both are read from the files that every interface package installs (`share/PACKAGE/msg/TYPE.msg` and `.json`), so they
are those of the types on the network.
"""

import importlib
import json
import pathlib
from collections.abc import Iterator
from typing import Any

from ament_index_python.packages import PackageNotFoundError, get_package_share_directory
from eel_base.wording import shown
from rosbags.interfaces import Nodetype
from rosbags.typesys import get_types_from_msg

_SEPARATOR = "=" * 80


def message_class(name: str) -> type:
    """The Python class of `name`, such as eel_msgs/msg/Backbone; `ValueError` if its package is not installed."""
    package, _, kind = name.partition("/msg/")
    try:
        return getattr(importlib.import_module(f"{package}.msg"), kind)
    except (ImportError, AttributeError, ValueError) as error:
        raise ValueError(f"message type {shown(name)} is not installed here") from error


def definition(name: str) -> str:
    """The definition of type `name` and, after separators, of all types that it contains, as rosbag2 stores it."""
    texts = {name: _text(name)}
    waiting = [name]
    while waiting:
        for inner in _inner_types(waiting[0], texts[waiting[0]]):
            if inner not in texts:
                texts[inner] = _text(inner)
                waiting.append(inner)
        waiting.pop(0)
    first, *others = texts
    parts = [texts[first]]
    for other in others:
        parts.append(f"{_SEPARATOR}\nMSG: {other.replace('/msg/', '/')}\n{texts[other]}")
    return "".join(part if part.endswith("\n") else part + "\n" for part in parts)


def type_hash(name: str) -> str:
    """The hash of type `name` (RIHS01_...), as endpoints announce it."""
    described = json.loads(_file(name, "json").read_text(encoding="utf8"))
    return next(entry["hash_string"] for entry in described["type_hashes"] if entry["type_name"] == name)


def _inner_types(name: str, text: str) -> Iterator[str]:
    """The types of the fields that are messages themselves, or arrays of messages."""
    fields: Any = get_types_from_msg(text, name)[name][1]  # nested tuples, which its types do not tell apart
    for _, (node, value) in fields:
        if node in (Nodetype.ARRAY, Nodetype.SEQUENCE):
            node, value = value[0]
        if node == Nodetype.NAME:
            yield value


def _text(name: str) -> str:
    return _file(name, "msg").read_text(encoding="utf8")


def _file(name: str, suffix: str) -> pathlib.Path:
    package, _, kind = name.partition("/msg/")
    try:
        return pathlib.Path(get_package_share_directory(package)) / "msg" / f"{kind}.{suffix}"
    except (PackageNotFoundError, ValueError) as error:
        raise ValueError(f"message type {shown(name)} is not installed here") from error
