# SPDX-License-Identifier: Apache-2.0
"""External wrenches as texts, for commands and nodes: section or world, with numbers; several are joined by " + ".

section station=0 force=2,0,0
world station=1 force=0,0,1;0,0,3 time=0,5
section station=0.5

The last one is zero. It lets a panel end at its station.
"""

from dataclasses import fields
from typing import Any

from eel_common.files.input_file import reading
from eel_common.quantity import checked_choice
from eel_common.texts import JOINED, made, named_fields, parts_of_text, value_of

from eel_dynamics.model.wrenches.external_wrench import FRAMES, ExternalWrench, plain_wrench

FRAME, TIME = "frame", "time"


def wrenches_from_text(text: str) -> tuple[ExternalWrench, ...]:
    """The wrenches of a `text`; none for an empty one. `ValueError` names the fault."""
    with reading("external wrench"):
        return tuple(_part(part) for part in parts_of_text(text) if part)


def _part(text: str) -> ExternalWrench:
    given = named_fields("external wrench", FRAME, text)
    frame = checked_choice("external wrench", given.pop(FRAME), FRAMES)
    values: dict[str, Any] = {field: value_of(value) for field, value in given.items()}
    if TIME in values and not isinstance(values[TIME], tuple):  # one instant
        values = {field: (value,) if field != "station" else value for field, value in values.items()}
    return made(ExternalWrench, values | {FRAME: frame}, "external wrench")


def text_of_wrenches(wrenches: tuple[ExternalWrench, ...]) -> str:
    """The text of `wrenches`. `ValueError` for one that is a function."""
    parts = []
    for wrench in wrenches:
        plain = plain_wrench(wrench)
        default = {item.name: item.default for item in fields(wrench)}
        given = [name for name in plain if name != FRAME and plain[name] != default[name]]
        parts.append(" ".join((wrench.frame, *(f"{name}={_written(plain[name])}" for name in given))))
    return JOINED.join(parts)


def _written(value: Any) -> str:
    if not isinstance(value, tuple):
        return repr(value)
    return (";" if isinstance(value[0], tuple) else ",").join(map(_written, value))
