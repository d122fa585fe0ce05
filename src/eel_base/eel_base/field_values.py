# SPDX-License-Identifier: Apache-2.0
"""The value of a dataclass field as a user gives it, checked by the field's default and metadata.

The default gives the type; its metadata may have minimum, maximum, exclusive (the minimum itself is refused), unit,
choices (of a text) and number (a text or a number).
"""

from collections.abc import Mapping, Sequence
from dataclasses import Field
from typing import Any

from eel_base.quantity import check_bounds, is_finite
from eel_base.wording import shown


def checked(item: Field[Any], value: Any, name: str) -> Any:
    """`value` in the type of the field `item`; `ValueError` says what `name` must be, and what it got.

    A float may be given as an integer, a row of texts as one text with commas. For a default of None 0 is None.
    """
    default, about = item.default, item.metadata
    if isinstance(default, bool):
        return _of_kind(isinstance(value, bool), value, f"{name} must be true or false")
    if isinstance(default, str):
        return _checked_text(about, value, name)
    if isinstance(default, tuple):
        return _checked_row(default, value, name)
    if isinstance(default, int):
        _of_kind(isinstance(value, int) and not isinstance(value, bool), value, f"{name} must be an integer")
    else:
        _of_kind(_is_number(value), value, f"{name} must be a finite number")
        value = float(value)
        if default is None and value == 0.0:
            return None
    check_bounds(item, value, name)
    return value


def _of_kind(good: bool, value: Any, rule: str) -> Any:
    if not good:
        raise ValueError(f"{rule}, got {shown(value)}")
    return value


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and is_finite(value)


def _checked_text(about: Mapping[str, Any], value: Any, name: str) -> Any:
    if about.get("number") and _is_number(value):
        return float(value)
    _of_kind(isinstance(value, str), value, f"{name} must be a text{' or a number' if about.get('number') else ''}")
    choices = about.get("choices", (value,))
    return _of_kind(value in choices, value, f"{name} must be one of {', '.join(choices)}")


def _checked_row(default: tuple[Any, ...], value: Any, name: str) -> tuple[Any, ...]:
    row = isinstance(value, (list, tuple)) or hasattr(value, "typecode")  # of rclpy: an array.array
    if isinstance(default[0], str):
        words: Sequence[Any] = value.split(",") if isinstance(value, str) else value if row else (None,)
        _of_kind(all(isinstance(word, str) for word in words), value, f"{name} must be a list of texts")
        return tuple(word.strip() for word in words)
    good = row and len(value) == len(default) and all(_is_number(number) for number in value)
    _of_kind(good, value, f"{name} must be {len(default)} finite numbers")
    return tuple(float(number) for number in value)
