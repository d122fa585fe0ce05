# SPDX-License-Identifier: Apache-2.0
"""Numbers with a unit, bounds and a one-line description. They are declared once and checked on entry.

A parameter set is a frozen, keyword-only dataclass. It derives from `Quantities`, and `quantity` makes its fields. A
ROS node declares its parameters from the same fields.
"""

import math
from collections.abc import Mapping
from dataclasses import Field, dataclass, field, fields
from typing import Any, TypeVar

import numpy as np

from eel_base.wording import shown

Value = TypeVar("Value")
Kind = TypeVar("Kind", bound=type)


def quantity(default: Value, *, unit: str, description: str, minimum: float, maximum: float, **more: Any) -> Value:
    """A dataclass field that carries its own unit, description and inclusive bounds as metadata, and what is `more`."""
    metadata = {"unit": unit, "description": description, "minimum": minimum, "maximum": maximum}
    return field(default=default, metadata=metadata | more)


def limits(metadata: Mapping[str, Any]) -> str:
    """The bounds in a field's metadata as text, such as "> 0 Hz and <= 1000 Hz". Empty without bounds.

    Metadata: minimum, maximum (each may be absent or None), exclusive (the minimum itself is refused), unit.
    """
    unit = f" {metadata['unit']}" if metadata.get("unit") else ""
    bounds = ((">" if metadata.get("exclusive") else ">=", metadata.get("minimum")), ("<=", metadata.get("maximum")))
    return " and ".join(f"{sign} {bound:g}{unit}" for sign, bound in bounds if bound is not None)


def check_bounds(item: Field[Any], value: Any, name: str) -> None:
    """`ValueError` where the number `value` is not within a bound of the field `item`, which it names."""
    low, high = (item.metadata.get(bound) for bound in ("minimum", "maximum"))
    broken = {}
    if low is not None and not (value > low if item.metadata.get("exclusive") else value >= low):
        broken = {"maximum": None}
    elif high is not None and not value <= high:
        broken = {"minimum": None}
    if broken:
        raise ValueError(f"{name} must be {limits(item.metadata | broken)}, got {shown(value)}")


def described_fields(kind: type[Any]) -> str:
    """One line for each field of the dataclass `kind`: name, default, description, unit, and bounds or choices."""
    lines = []
    for item in fields(kind):
        about = item.metadata
        allowed = "one of " + ", ".join(about["choices"]) if "choices" in about else limits(about)
        unit = f" [{about['unit']}]" if about["unit"] else ""
        lines.append(
            f"    {item.name} = {item.default!r}: {about['description']}{unit}{f'; {allowed}' if allowed else ''}"
        )
    return "\n".join(lines)


def documented(kind: Kind) -> Kind:
    """Decorator: append the `described_fields` to the docstring of the dataclass `kind`."""
    kind.__doc__ = f"{(kind.__doc__ or '').rstrip()}\n\n{described_fields(kind)}\n"
    return kind


def is_finite(value: Any) -> bool:
    """Whether `value` is one finite number. A text is not a number."""
    try:
        return math.isfinite(value) and not getattr(value, "ndim", 0)
    except (TypeError, ValueError, OverflowError):
        return False


def number(name: str, value: Any) -> float:
    """`value` as a finite float. `ValueError` names anything else. A bool or a text is not a number."""
    try:
        if isinstance(value, (bool, str, bytes)):
            raise TypeError
        result = float(value)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name} must be a number, got {shown(value)}") from None
    if not math.isfinite(result):
        raise ValueError(f"{name} must be finite, got {result}")
    return result


def numbers(name: str, values: Any) -> np.ndarray:
    """`values` as a new array of floats, of any shape. `ValueError` names anything else, complex numbers too."""
    try:
        if np.iscomplexobj(values):
            raise TypeError
        return np.array(values, dtype=float)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name} must be real numbers, got {shown(values)}") from None


@dataclass(frozen=True, kw_only=True)
class Quantities:
    """Base of parameter sets. Every field becomes a float within its bounds, or a `ValueError` names it."""

    def __post_init__(self) -> None:
        for entry in fields(self):
            value = number(entry.name, getattr(self, entry.name))
            check_bounds(entry, value, entry.name)
            object.__setattr__(self, entry.name, value)
