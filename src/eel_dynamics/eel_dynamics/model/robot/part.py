# SPDX-License-Identifier: Apache-2.0
"""The base of a robot's bending parts: an axis, and a support along the body."""

from typing import Any

from eel_common.quantity import Quantities, checked_choice, number
from eel_common.wording import shown

AXES = {"yaw": (2, -1), "-yaw": (2, 1), "pitch": (1, -1), "-pitch": (1, 1)}
AXES |= {"z": (2, 1), "-z": (2, -1), "y": (1, -1), "-y": (1, 1)}
"""Axis of a part: the curvature's component in section axes, and the sign of that component for a positive angle.

"z" and "y" are those of a URDF: a positive angle turns the part behind about +z or +y (REP-103) of the part ahead.
"""

MOST_MODES = 12  # modes of a continuous part


class Part(Quantities):
    """Base of joints, passive tails and muscles. Errors name the part, the field and the value."""

    axis: str
    name: str

    def __post_init__(self) -> None:
        super().__post_init__()
        checked_choice(f"{self.what} axis", self.axis, AXES)

    @property
    def component(self) -> int:
        """Component of the curvature in section axes: 1 pitch, 2 yaw."""
        return AXES[self.axis][0]

    @property
    def support(self) -> tuple[float, float]:
        """X [m] of its beginning and end, if both are known."""
        raise NotImplementedError


def checked_range(name: str, values: Any, unit: str) -> tuple[float, float]:
    """`values` as two finite numbers that rise."""
    if isinstance(values, (list, tuple)) and len(values) == 2:
        low, high = (number(name, value, unit) for value in values)
        if low < high:
            return low, high
        values = list(values)
    raise ValueError(f"{name} must be two numbers that rise, got {shown(values)}")
