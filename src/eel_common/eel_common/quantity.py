# SPDX-License-Identifier: Apache-2.0
"""Numbers with a unit, bounds and a one-line description. They are declared once and checked on entry.

A parameter set is a frozen, keyword-only dataclass. It derives from `Quantities`, and `quantity` makes its fields. A
ROS node declares its parameters from the same fields. Metadata of a field:

    unit, description, minimum, maximum (inclusive; either may be None)
    exclusive       the minimum itself is refused
    whole           a float that must be a whole number
    after           the name of a field that this one must exceed
    profile         a number, or a function along the body
    plain           not a number: the class checks it
    choices         the texts that are allowed
    number          a text or a number
    any_length      a row of numbers may have any length but 0
    changeable      a ROS parameter may change: while the node runs (True), or at the next reset (`AT_RESET`)
"""

import math
import os
from collections.abc import Collection, Mapping
from dataclasses import MISSING, Field, dataclass, field, fields
from pathlib import Path
from typing import Any, ClassVar, Self, TypeVar

import numpy as np

from eel_common.wording import not_one_of, shown

Value = TypeVar("Value")
Kind = TypeVar("Kind", bound=type)

AT_RESET = "at the next reset"  # when a change takes effect
FEW = 8  # numbers of a row shown in a message
LARGEST = 1e30  # bounds size to 1/LARGEST .. LARGEST, so that products of a few are finite


def quantity(
    default: Value,
    unit: str,
    description: str,
    minimum: float | None = None,
    maximum: float | None = None,
    compare: bool = True,
    **more: Any,
) -> Value:
    """A dataclass field with these metadata and `more`. compare: whether comparisons of two objects include it."""
    metadata = {"unit": unit, "description": description, "minimum": minimum, "maximum": maximum}
    return field(default=default, compare=compare, metadata=metadata | more)


def required(unit: str, description: str, minimum: float | None = None, **more: Any) -> Any:
    """As `quantity`, for a field without a default."""
    return quantity(MISSING, unit, description, minimum, **more)


@dataclass(frozen=True, kw_only=True)
class Quantities:
    """Base of parameter sets. Each field takes the type of its default; a `ValueError` names a bad one (`checked`).

    A field whose default is None may be None. `what` precedes the field names in errors. A subclass with
    `repr=False` prints only the fields that differ from their defaults.
    """

    what: ClassVar[str] = ""

    def __post_init__(self) -> None:
        for item in fields(self):
            value, about = getattr(self, item.name), item.metadata
            if value is item.default or about.get("plain") or (about.get("profile") and callable(value)):
                continue
            take = _in_bounds if item.default is None else checked
            object.__setattr__(self, item.name, take(item, value, f"{self.what} {item.name}".lstrip()))
        for later, before in ((item, item.metadata.get("after")) for item in fields(self)):
            if before and not getattr(self, later.name) > (least := getattr(self, before)):
                unit, got = later.metadata["unit"], getattr(self, later.name)
                raise ValueError(f"{later.name} must be > {before} ({least:g} {unit}), got {got}")

    def __repr__(self) -> str:
        values = ((item, getattr(self, item.name)) for item in fields(self))
        said = (
            f"{item.name}={value!r}" for item, value in values if value is not item.default and value != item.default
        )
        return f"{type(self).__name__}({', '.join(said)})"

    @classmethod
    def among(cls, values: Mapping[str, Any]) -> Self:
        """The set made from those of the `values` whose names are its fields."""
        return cls(**{item.name: values[item.name] for item in fields(cls) if item.name in values})


def limits(metadata: Mapping[str, Any]) -> str:
    """The bounds in a field's metadata as text, such as "> 0 Hz and <= 1000 Hz". Empty without bounds."""
    unit = f" {metadata['unit']}" if metadata.get("unit") else ""
    bounds = ((">" if metadata.get("exclusive") else ">=", metadata.get("minimum")), ("<=", metadata.get("maximum")))
    return " and ".join(f"{sign} {bound:g}{unit}" for sign, bound in bounds if bound is not None)


def described_fields(kind: type[Any]) -> str:
    """One line for each field of the dataclass `kind`: name, default, description, unit, and bounds or choices."""
    lines = []
    for item in fields(kind):
        about = item.metadata
        allowed = "one of " + ", ".join(about["choices"]) if "choices" in about else limits(about)
        unit = f" [{about['unit']}]" if about["unit"] else ""
        default = "" if item.default is MISSING else f" = {item.default!r}"
        lines.append(f"    {item.name}{default}: {about['description']}{unit}{f'; {allowed}' if allowed else ''}")
    return "\n".join(lines)


def documented(kind: Kind) -> Kind:
    """Decorator: append the `described_fields` to the docstring of the dataclass `kind`."""
    head = "    Fields, with default, meaning, unit, and bounds or choices:"
    kind.__doc__ = f"{(kind.__doc__ or '').rstrip()}\n\n{head}\n\n{described_fields(kind)}\n"
    return kind


# -- checks: a `ValueError` states what `name` must be, and the value given


def number(
    name: str,
    value: Any,
    unit: str = "",
    *,
    minimum: float | None = None,
    maximum: float | None = None,
    exclusive: bool = False,
) -> float:
    """`value` as a finite float within the bounds. A bool or a text is not a number."""
    try:
        if isinstance(value, (bool, str, bytes)):
            raise TypeError
        result = float(value)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name} must be a number, got {shown(value)}") from None
    if not math.isfinite(result):
        raise ValueError(f"{name} must be finite, got {result}")
    least = 1.0 / LARGEST if exclusive and minimum == 0.0 and result > 0.0 else 0.0
    if not least <= abs(result) <= LARGEST:
        raise ValueError(f"{name} must be {least:g} to {LARGEST:g} in size, got {shown(value)}")
    low = minimum is not None and (result <= minimum if exclusive else result < minimum)
    high = maximum is not None and result > maximum
    if low or high:
        got = value if type(value) is int else result  # not np.float64(1.0)
        broken = {"minimum": minimum, "exclusive": exclusive} if low else {"maximum": maximum}
        raise ValueError(f"{name} must be {limits({'unit': unit, **broken})}, got {shown(got)}")
    return result


def positive(name: str, value: Any, unit: str = "") -> float:
    """`value` as a finite float above 0."""
    return number(name, value, unit, minimum=0.0, exclusive=True)


def numbers(name: str, values: Any) -> np.ndarray:
    """`values` as a new array of floats, of any shape. Complex numbers are refused."""
    try:
        array = np.asarray(values)
        if array.dtype.kind == "c":
            raise TypeError
        return array.astype(float)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name} must be real numbers, got {shown(values)}") from None


def checked_row(name: str, values: Any, size: int | None) -> np.ndarray:
    """`values` as an array (size,) of finite floats. Any size fits where `size` is None."""
    array = numbers(name, values)
    if array.ndim != 1 or (size is not None and len(array) != size):
        got = shown(values)
        if array.ndim == 1:
            got = f"{len(array)}: {got}" if 0 < len(array) <= FEW else f"{len(array)}"
        raise ValueError(f"{name} must be {'a row of' if size is None else size} numbers, got {got}")
    good = np.abs(array) <= LARGEST
    if np.count_nonzero(good) < len(array):
        index = np.flatnonzero(~good)[0]
        rule = f"0 to {LARGEST:g} in size" if np.isfinite(array[index]) else "finite"
        raise ValueError(f"{name} must be {rule}, got {array[index]} at index {index}")
    return array


def checked_instance(name: str, value: Any, kind: type | tuple[type, ...]) -> Any:
    """`value`, if it is a `kind`, or one of several kinds."""
    if not isinstance(value, kind):
        kinds = kind if isinstance(kind, tuple) else (kind,)
        raise ValueError(f"{name} must be a {' or a '.join(each.__name__ for each in kinds)}, got {shown(value)}")
    return value


def checked_path(name: str, value: Any) -> Path:
    """`value` as a path."""
    return Path(checked_instance(name, value, (str, os.PathLike)))


def checked_choice(name: str, value: Any, known: Collection[str], *others: str) -> str:
    """`value`, if it is one of the names `known`. others: further allowed values, in words."""
    if not isinstance(value, str) or value not in known:
        raise ValueError(not_one_of(name, value, (*known, *others)))
    return value


def is_finite(value: Any) -> bool:
    """Whether `value` is one finite number. A bool or a text is not a number."""
    try:
        return math.isfinite(value) and not isinstance(value, bool) and not getattr(value, "ndim", 0)
    except (TypeError, ValueError, OverflowError):
        return False


def checked(item: Field[Any], value: Any, name: str) -> Any:
    """`value` converted to the type of the default of the field `item`, and checked against its metadata.

    A float may be given as an integer, a row of texts as one text with commas. If the default is None, 0 means None.
    """
    default, about = item.default, item.metadata
    if isinstance(default, bool):
        return bool(_of_kind(isinstance(value, (bool, np.bool_)), value, f"{name} must be true or false"))
    if isinstance(default, str):
        if about.get("number") and is_finite(value):
            return float(value)
        _of_kind(isinstance(value, str), value, f"{name} must be a text{' or a number' if about.get('number') else ''}")
        return checked_choice(name, value, about.get("choices", (value,)))
    if isinstance(default, tuple):
        return _checked_row(default, value, name, None if about.get("any_length") else len(default))
    if default is None and number(name, value) == 0.0:
        return None
    return _in_bounds(item, value, name)


def _in_bounds(item: Field[Any], value: Any, name: str) -> float:
    """`value` as a number within the bounds of the field `item`."""
    about, integer = item.metadata, isinstance(item.default, int)
    if integer and not about.get("whole"):
        _of_kind(isinstance(value, int) and not isinstance(value, bool), value, f"{name} must be an integer")
    bounds = {key: about[key] for key in ("minimum", "maximum", "exclusive") if key in about}
    result = number(name, value, about.get("unit", ""), **bounds)
    if about.get("whole") and result != int(result):
        raise ValueError(f"{name} must be a whole number, got {result:g}")
    return int(value) if integer else result


def _of_kind(good: bool, value: Any, rule: str) -> Any:
    if not good:
        raise ValueError(f"{rule}, got {shown(value)}")
    return value


def _checked_row(default: tuple[Any, ...], value: Any, name: str, size: int | None) -> tuple[Any, ...]:
    array = hasattr(value, "typecode")  # rclpy gives an array.array
    row = array or (isinstance(value, (list, tuple, np.ndarray)) and getattr(value, "ndim", 1) == 1)
    if isinstance(default[0], str):
        words: Any = value.split(",") if isinstance(value, str) else value if row else (None,)
        _of_kind(all(isinstance(word, str) for word in words), value, f"{name} must be a list of texts")
        return tuple(word.strip() for word in words)
    good = row and len(value) == (size or max(1, len(value))) and all(map(is_finite, value))
    _of_kind(good, value, f"{name} must be {size or 'a row of'} finite numbers")
    return tuple(checked_row(name, value, size).tolist())
