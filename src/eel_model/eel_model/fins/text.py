# SPDX-License-Identifier: Apache-2.0
"""Fins as texts, for commands and nodes: pair, left or right, with numbers; several are joined by " + ".

pair station=0.5 area=0.0015 aspect_ratio=2.5 k_p=4 k_d=0.5 time_constant=0.05
left station=0.5 area=0.0005 aspect_ratio=3 angle=commanded time_constant=0.1

k_p and k_d make a `RollHold` of the angle. angle=commanded: the topic fin_command gives it. name=NAME: in topics.
"""

from dataclasses import fields
from typing import Any

from eel_base.quantity import is_finite
from eel_base.wording import not_one_of, shown

from eel_model.fins.fins import COMMANDED, SIDES, Fin, RollHold

JOINED, PAIR = " + ", "pair"
NAME = "name"
NUMBERS = tuple(item.name for item in fields(Fin) if item.name not in ("side", NAME))
GAINS = "k_p", "k_d"


def fins_from_text(text: str) -> tuple[Fin, ...]:
    """The fins of a `text`; none of an empty one. `ValueError` names what does not fit."""
    return tuple(fin for part in text.split(JOINED) if part.strip() for fin in _part(part.strip()))


def _part(text: str) -> tuple[Fin, ...]:
    name, *given = text.split()
    if name not in (PAIR, *SIDES):
        raise ValueError(not_one_of("fins", name, (PAIR, *SIDES)))
    fields: dict[str, Any] = {}
    for each in given:
        field, _, value = each.partition("=")
        if field not in (*NUMBERS, *GAINS, NAME) or field in fields:
            known = ", ".join((*NUMBERS, *GAINS, NAME))
            raise ValueError(f"fins {name} must have fields FIELD=VALUE of {known}, each once, got {shown(each)}")
        fields[field] = value if field == NAME or value == COMMANDED else _number(f"fin {field}", value)
    gains = {field: fields.pop(field) for field in GAINS if field in fields}
    if gains:
        fields["angle"] = RollHold(**gains)
    for field in NUMBERS[:3]:
        if field not in fields:
            raise ValueError(f"fin {field} must be given, got {shown(text)}")
    return Fin.pair(**fields) if name == PAIR else (Fin(side=name, **fields),)


def _number(name: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not is_finite(value):
        raise ValueError(f"{name} must be a number, got {shown(text)}")
    return value


def text_of_fins(fins: tuple[Fin, ...]) -> str:
    """The text of `fins`. `ValueError` for one whose angle is a table."""
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
