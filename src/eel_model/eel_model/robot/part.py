# SPDX-License-Identifier: Apache-2.0
"""What the parts of a robot share: numbers with bounds, checked on entry, and names of axes."""

from dataclasses import MISSING, dataclass, field, fields
from typing import Any, ClassVar

from eel_base.quantity import number
from eel_base.wording import not_one_of, shown

AXES = {"yaw": (2, -1), "-yaw": (2, 1), "pitch": (1, -1), "-pitch": (1, 1)}
"""Axis of a part: the curvature's component in section axes, and the sign of that component for a positive angle."""

MOST_MODES = 12  # of a continuous part


def required(unit: str, description: str, minimum: float | None = None, **more: Any) -> Any:
    """A dataclass field as of `quantity`, without a default."""
    return field(metadata={"unit": unit, "description": description, "minimum": minimum, "maximum": None} | more)


@dataclass(frozen=True)
class Part:
    """Base of a robot's parts: every field with a unit is a finite number within its bounds, or None by default.

    `ValueError` names the part, the field and the value. A field that is marked `profile` may be a function of X; one
    that is marked `plain` is no number.
    """

    what: ClassVar[str] = "part"

    def __post_init__(self) -> None:
        for item in fields(self):
            about, value = item.metadata, getattr(self, item.name)
            if "unit" not in about or about.get("plain") or (value is None and item.default is None):
                continue
            if about.get("profile") and callable(value):
                continue
            bounds = {key: about[key] for key in ("minimum", "maximum", "exclusive") if about.get(key) is not None}
            checked = number(f"{self.what} {item.name}", value, about["unit"], **bounds)
            if about.get("whole"):
                if checked != int(checked):
                    raise ValueError(f"{self.what} {item.name} must be a whole number, got {checked:g}")
                checked = int(checked)
            object.__setattr__(self, item.name, checked)

    def __repr__(self) -> str:
        values = {item.name: getattr(self, item.name) for item in fields(self)}
        said = (f"{item.name}={values[item.name]!r}" for item in fields(self) if _differs(item, values[item.name]))
        return f"{type(self).__name__}({', '.join(said)})"


def _differs(item: Any, value: Any) -> bool:
    return item.default is MISSING or (value is not item.default and value != item.default)


def checked_axis(what: str, axis: Any) -> str:
    """`axis`, if it is one of `AXES`."""
    if not isinstance(axis, str) or axis not in AXES:
        raise ValueError(not_one_of(f"{what} axis", axis, AXES))
    return axis


def checked_range(name: str, values: Any, unit: str) -> tuple[float, float]:
    """`values` as two finite numbers that rise."""
    if not isinstance(values, (list, tuple)) or len(values) != 2:
        raise ValueError(f"{name} must be two numbers that rise, got {shown(values)}")
    low, high = (number(name, value, unit) for value in values)
    if not low < high:
        raise ValueError(f"{name} must be two numbers that rise, got {shown(list(values))}")
    return low, high
