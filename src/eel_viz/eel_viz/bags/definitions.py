# SPDX-License-Identifier: Apache-2.0
"""Classes, definitions and hashes of message types, from the packages installed here.

Every interface package installs `share/PACKAGE/msg/TYPE.msg` and `TYPE.json`. They define the types on the network.
"""

import importlib
import json
import pathlib
from collections.abc import Iterator
from typing import Any

from ament_index_python.packages import PackageNotFoundError, get_package_share_directory
from eel_common.wording import shown
from rosbags.interfaces import Nodetype
from rosbags.typesys import get_types_from_msg

_SEPARATOR = "=" * 80


def message_class(name: str) -> type[Any]:
    """The Python class of `name`, such as eel_msgs/msg/Backbone; `ValueError` if its package is not installed.

    Anybody on the network may name a type, so only modules of interface packages are imported.
    """
    package, _, kind = name.partition("/msg/")
    if not _file(name, "msg").is_file():
        raise _not_installed(name)
    try:
        found: type[Any] = getattr(importlib.import_module(f"{package}.msg"), kind)
    except (ImportError, AttributeError, ValueError) as error:
        raise _not_installed(name) from error
    return found


def definition(name: str) -> str:
    """The definition of type `name` and, after separators, of all types that it contains, as rosbag2 stores it."""
    texts: dict[str, str] = {}
    waiting = [name]
    for each in waiting:  # `waiting` grows in the loop
        if each not in texts:
            texts[each] = _file(each, "msg").read_text(encoding="utf8").removesuffix("\n") + "\n"
            waiting += _inner_types(each, texts[each])
    own, *others = texts
    parts = (f"{_SEPARATOR}\nMSG: {other.replace('/msg/', '/')}\n{texts[other]}" for other in others)
    return texts[own] + "".join(parts)


def type_hash(name: str) -> str:
    """The hash of type `name` (RIHS01_...), as in discovery."""
    hashes = json.loads(_file(name, "json").read_text(encoding="utf8"))["type_hashes"]
    return next(str(entry["hash_string"]) for entry in hashes if entry["type_name"] == name)


def _inner_types(name: str, text: str) -> Iterator[str]:
    """The types of the fields that are messages or arrays of messages."""
    fields: Any = get_types_from_msg(text, name)[name][1]  # nested tuples, too loosely typed
    for _, (node, value) in fields:
        if node in (Nodetype.ARRAY, Nodetype.SEQUENCE):
            node, value = value[0]
        if node == Nodetype.NAME:
            yield value


def _file(name: str, suffix: str) -> pathlib.Path:
    package, _, kind = name.partition("/msg/")
    try:
        return pathlib.Path(get_package_share_directory(package)) / "msg" / f"{kind}.{suffix}"
    except (PackageNotFoundError, ValueError) as error:
        raise _not_installed(name) from error


def _not_installed(name: str) -> ValueError:
    return ValueError(f"message type {shown(name)} is not installed here")
