# SPDX-License-Identifier: Apache-2.0
"""Fins as texts, for commands and nodes: pair, left or right, with numbers; several are joined by " + ".

pair station=0.5 area=0.0015 aspect_ratio=2.5 k_p=4 k_d=0.5 time_constant=0.05
left station=0.5 area=0.0005 aspect_ratio=3 angle=commanded time_constant=0.1

k_p and k_d make the angle a `RollHold`. With angle=commanded, the topic fin_command sets it. name=NAME: in topics.
"""

from dataclasses import fields
from typing import Any

from eel_common.files.input_file import reading
from eel_common.quantity import checked_choice
from eel_common.texts import JOINED, made, named_fields, parts_of_text, value_of

from eel_dynamics.model.fins.fins import SIDES, Fin, RollHold

PAIR = "pair"
NAME = "name"
NUMBERS = tuple(item.name for item in fields(Fin) if item.name not in ("side", NAME))
GAINS = "k_p", "k_d"


def fins_from_text(text: str) -> tuple[Fin, ...]:
    """The fins of a `text`; none for an empty one. `ValueError` names the fault."""
    with reading("fin"):
        return tuple(fin for part in parts_of_text(text) if part for fin in _part(part))


def _part(text: str) -> tuple[Fin, ...]:
    given = named_fields("fins", "side", text)
    side = given.pop("side")
    checked_choice("fins", side, (PAIR, *SIDES))
    values: dict[str, Any] = {field: value if field == NAME else value_of(value) for field, value in given.items()}
    if gains := {field: values.pop(field) for field in GAINS if field in values}:
        values["angle"] = RollHold(**gains)
    fin = made(Fin, values | {"side": "left" if side == PAIR else side}, "fin")
    return Fin.pair(**values) if side == PAIR else (fin,)


def text_of_fins(fins: tuple[Fin, ...]) -> str:
    """The text of `fins`. `ValueError` for a fin whose angle is a table."""
    parts = []
    for fin in fins:
        if isinstance(fin.angle, tuple):
            raise ValueError(f"fin {fin.name} has no text: its angle is a table")
        held = isinstance(fin.angle, RollHold)
        values = {name: getattr(fin, name) for name in NUMBERS if not (held and name == "angle")}
        values |= {name: getattr(fin.angle, name) for name in GAINS} if held else {}
        written = [f"{name}={value}" for name, value in values.items() if value is not None]
        named = [f"{NAME}={fin.name}"] if fin.name else []
        parts.append(" ".join((fin.side, *written, *named)))
    return JOINED.join(parts)
