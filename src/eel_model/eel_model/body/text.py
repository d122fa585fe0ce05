# SPDX-License-Identifier: Apache-2.0
"""Bodies as texts, for commands, scene files and nodes: a name, a file or links, and what differs from it.

boyer2010
fish.csv base_drag=0.2 appendages=arms.csv
links length=1.62 number=9 half_width=0.05 half_height=0.055 joints=0.65 mass=7.2

What may follow a name or file are the numbers of `Body`, joints (flush, or a number) with link_length, and appendages:
a table with the columns x, y, z, drag1, drag2, drag3 and law; what is left out is 0, and law axis.
"""

import os
import re
from pathlib import Path
from typing import Any

from eel_base.files.input_file import reading
from eel_base.files.table import split_name
from eel_base.files.tables import read_table
from eel_base.quantity import is_finite
from eel_base.wording import did_you_mean, not_one_of, shown

from eel_model.body.appendages import MOST_APPENDAGES, Appendage
from eel_model.body.body import NAMED, NUMBERS, PROFILES, Body
from eel_model.body.hull import BY_SHAPE
from eel_model.body.links import joint_drag_of

LINKS = "links"
OF_LINKS = "length", "number", "half_width", "half_height", "joints", "nose", "tail", "mass"
REQUIRED = OF_LINKS[:5]
OTHERS = (*NUMBERS, "link_length", "joints", "appendages")
COLUMNS = "x", "y", "z", "drag1", "drag2", "drag3", "law"


def body_of(text: str) -> Body:
    """The body of a `text`. `ValueError` names what does not fit; `OSError`: not readable."""
    if text in NAMED or Path(text).is_file():
        return _plain_body(text)
    what, *fields = re.split(r"\s+(?=\w+=)", text.strip())
    values: dict[str, Any] = {}
    for each in fields:
        name, _, value = each.partition("=")
        known = (*OF_LINKS, *OTHERS) if what == LINKS else OTHERS
        if name not in known or name in values:
            raise ValueError(
                f"body {shown(what)} must have NAME=VALUE of {', '.join(known)}, each once, got {shown(each)}"
                f"{did_you_mean(name, known)}"
            )
        values[name] = _value(name, value)
    if what != LINKS:
        body = _plain_body(what)
        if "joints" in values:
            values["joint_drag"] = joint_drag_of(values.pop("joints"))
        return body.changed(**values, name=text) if values else body
    for name in REQUIRED:
        if name not in values:
            raise ValueError(f"body links must have {name}, got {shown(text)}{_about(name)}")
    if "joint_drag" in values:
        raise ValueError(f"body links has joints in place of joint_drag, got {shown(text)}")
    return Body.of_links(**values, name=text)


def appendages_from_file(path: str | os.PathLike[str]) -> tuple[Appendage, ...]:
    """The appendages of a table, a row each. `ValueError` names line and column."""
    with reading(f"appendages {shown(str(path))}"):
        table = read_table(path, "appendages ")
        names = [split_name(name)[0] for name in table.head]
        for name in names:
            if name not in COLUMNS:
                raise ValueError(
                    f"column {shown(name)}{did_you_mean(name, COLUMNS)} must be one of {', '.join(COLUMNS)}"
                )
        if "x" not in names:
            raise ValueError(f"it must have a column x, got {shown(','.join(names))}")
        if len(table) > MOST_APPENDAGES:
            raise ValueError(f"it must have {MOST_APPENDAGES} rows at most")
        columns: dict[str, Any] = {
            name: table.texts(at) if name == "law" else table.numbers([at], "m" if name in "xyz" else "")[:, 0].tolist()
            for at, name in enumerate(names)
        }
        found: list[Appendage] = []
        for row in range(len(table)):
            given = {name: each[row] for name, each in columns.items() if each[row] == each[row] != ""}  # or NaN
            try:
                found.append(Appendage(**given))
            except (ValueError, TypeError) as error:
                raise table.error(str(error), row) from None
        table.tell()
    return tuple(found)


def _plain_body(text: str) -> Body:
    if text in NAMED:
        return Body.named(text)
    if not Path(text).suffix:
        raise ValueError(not_one_of("body", text, (*NAMED, f"{LINKS} with its numbers", "a file")))
    return Body.from_file(text)


def _value(name: str, text: str) -> Any:
    """A number; the words that some may be; or the appendages in a file."""
    if name == "appendages":
        return appendages_from_file(text)
    if name == "law" or (name in PROFILES and text == BY_SHAPE):
        return text
    try:
        value = float(text)
    except ValueError:
        if name in ("joints", "nose", "tail"):
            return text
        value = float("nan")
    if not is_finite(value):
        raise ValueError(f"body {name} must be a number, got {shown(text)}")
    return value


def _about(name: str) -> str:
    return "" if name != "joints" else ": flush, or the drag coefficient of a link by itself, 0 to 0.87"
