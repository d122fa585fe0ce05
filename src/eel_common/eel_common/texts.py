# SPDX-License-Identifier: Apache-2.0
"""Objects from texts and plain values: NAME FIELD=VALUE ..., numbers, rows and words; objects of named fields.

Code that makes objects from a text runs within `reading` (files/input_file.py), which turns every error into one
`ValueError`.
"""

import os
import re
from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields
from typing import Any, TypeVar

from eel_common.files.input_file import number_of
from eel_common.wording import did_you_mean, shown

Made = TypeVar("Made")

JOINED = " + "  # joins texts that make one object each
TRUTH = {"true": True, "on": True, "false": False, "off": False}


def parts_of_text(text: str) -> list[str]:
    """The texts joined by " + ". The name of a file counts as one, whatever it holds."""
    parts = [text] if os.path.isfile(text) else text.split(JOINED)
    return [part.strip() for part in parts]


def named_fields(what: str, first: str, text: str) -> dict[str, str]:
    """The fields of a text NAME FIELD=VALUE ..., each once. NAME goes into the field `first`, and may hold spaces."""
    name, *given = [text] if os.path.isfile(text) else re.split(r"\s+(?=\w+=)", text.strip())
    found = {first: name}
    for each in given:
        field, _, value = each.partition("=")
        if not value or field in found:
            raise ValueError(f"{what} {shown(name)} must have fields NAME=VALUE, each once, got {shown(each)}")
        found[field] = value
    return found


def value_of(text: str) -> Any:
    """A boolean, a number, a row of numbers (commas), rows of these (semicolons), or the text itself."""
    for between in ";,":
        if between in text:
            return tuple(value_of(part) for part in text.split(between))
    if text.lower() in TRUTH:
        return TRUTH[text.lower()]
    try:
        return number_of(text)
    except ValueError:
        return text


def made(kind: Callable[..., Made], given: Mapping[str, Any], what: str) -> Made:
    """The dataclass `kind` from the fields `given`. `ValueError` names an unknown or a missing field of `what`."""
    known: Any = fields(kind)  # type: ignore[arg-type]
    names = [item.name for item in known if item.init]
    for name in given:
        if name not in names:
            hint = did_you_mean(name, names)
            raise ValueError(f"{what} has no field {shown(name)}{hint}, it has: {', '.join(names)}")
    for item in known:
        if item.init and item.default is MISSING and item.default_factory is MISSING and item.name not in given:
            raise ValueError(f"{what} {item.name} must be given")
    return kind(**given)
