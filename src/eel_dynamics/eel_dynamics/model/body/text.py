# SPDX-License-Identifier: Apache-2.0
"""Bodies as texts, for commands, scene files and nodes: a name, a file or links, followed by changes.

boyer2010
fish.csv base_drag=0.2 appendages=arms.csv
links length=1.62 number=9 half_width=0.05 half_height=0.055 joints=0.65 mass=7.2

After a name or file may follow numbers of `Body`, joints (flush, or a number) with link_length, and appendages: a table
with the columns x, y, z, drag1, drag2, drag3 and law. Missing columns are 0, or law axis.
"""

import os
from pathlib import Path
from typing import Any

from eel_common.files.input_file import reading
from eel_common.files.table import MISSING, split_name
from eel_common.files.tables import read_table
from eel_common.texts import made, named_fields, value_of
from eel_common.wording import did_you_mean, not_one_of, shown

from eel_dynamics.model.body.appendages import MOST_APPENDAGES, Appendage
from eel_dynamics.model.body.body import NAMED, NUMBERS, Body
from eel_dynamics.model.body.links import joint_drag_of

LINKS = "links"
OF_LINKS = "length", "number", "half_width", "half_height", "joints", "nose", "tail", "mass"
REQUIRED = OF_LINKS[:5]
OTHERS = (*NUMBERS, "link_length", "joints", "appendages")
COLUMNS = "x", "y", "z", "drag1", "drag2", "drag3", "law"


def body_of(text: str) -> Body:
    """The body of a `text`. `ValueError` names the fault; `OSError`: a file is not readable."""
    with reading("body"):
        given: dict[str, Any] = named_fields("body", "name", text)
        what = given.pop("name")
        links = what == LINKS
        for name, value in given.items():
            if name not in (known := (*OF_LINKS, *OTHERS) if links else OTHERS):
                hint = did_you_mean(name, known)
                raise ValueError(f"body {shown(what)} has no {shown(name)}{hint}, it has: {', '.join(known)}")
            given[name] = appendages_from_file(value) if name == "appendages" else value_of(value)
        if not links:
            body = _plain_body(what)
            if "joints" in given:
                given["joint_drag"] = joint_drag_of(given.pop("joints"))
            return body.changed(**given, name=text) if given else body
        for name in REQUIRED:
            if name not in given:
                raise ValueError(f"body links must have {name}, got {shown(text)}{_about(name)}")
        if "joint_drag" in given:
            raise ValueError(f"body links has joints in place of joint_drag, got {shown(text)}")
        return Body.of_links(**given, name=text)


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
        empty = [[cell.lower() in MISSING for cell in table.texts(at)] for at in range(len(names))]
        found: list[Appendage] = []
        for row in range(len(table)):
            given = {name: each[row] for (name, each), out in zip(columns.items(), empty, strict=True) if not out[row]}
            try:
                found.append(made(Appendage, given, "appendage"))
            except ValueError as error:
                raise table.error(str(error), row) from None
        table.tell()
    return tuple(found)


def _plain_body(text: str) -> Body:
    if text in NAMED:
        return Body.named(text)
    if not Path(text).suffix:
        raise ValueError(not_one_of("body", text, (*NAMED, f"{LINKS} with its numbers", "a file")))
    return Body.from_file(text)


def _about(name: str) -> str:
    return "" if name != "joints" else ": flush, or the drag coefficient of a link by itself, 0 to 0.87"
