# SPDX-License-Identifier: Apache-2.0
"""From texts and plain values to objects: NAME FIELD=VALUE ..., numbers, rows and words; objects of named fields.

What makes objects of a text stands within `reading` (files/input_file.py), which turns whatever is raised into one
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

JOINED = " + "  # between texts of which each makes an object
TRUTH = {"true": True, "on": True, "false": False, "off": False}


def parts_of_text(text: str) -> list[str]:
    """The texts that are joined by " + "; the name of a file is one."""
    parts = [text] if os.path.isfile(text) else text.split(JOINED)
    return [part.strip() for part in parts]


def named_fields(what: str, first: str, text: str) -> dict[str, str]:
    """The fields of a text NAME FIELD=VALUE ..., each once. The name is that called `first`; it may hold spaces."""
    name, *given = [text] if os.path.isfile(text) else re.split(r"\s+(?=\w+=)", text.strip())
    found = {first: name}
    for each in given:
        field, _, value = each.partition("=")
        if not value or field in found:
            raise ValueError(f"{what} {shown(name)} must have fields NAME=VALUE, each once, got {shown(each)}")
        found[field] = value
    return found


def value_of(text: str) -> Any:
    """A truth, a number, a row of them (commas), rows of these (semicolons), or the text itself."""
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
    """`kind`, a dataclass, of the fields `given`. `ValueError` names one that `what` has not, or that is missing."""
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
