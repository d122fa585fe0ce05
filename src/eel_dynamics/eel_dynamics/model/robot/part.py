# SPDX-License-Identifier: Apache-2.0
"""The base of a robot's bending parts: an axis, and a support along the body."""

from collections.abc import Sequence
from typing import Any, ClassVar, Self

from eel_common.quantity import Quantities, checked_choice, number
from eel_common.wording import shown
from eel_gaits.laws.law import Law

from eel_dynamics.model.body.body import Body

AXES = {"yaw": (2, -1), "-yaw": (2, 1), "pitch": (1, -1), "-pitch": (1, 1)}
AXES |= {"z": (2, 1), "-z": (2, -1), "y": (1, -1), "-y": (1, 1)}
"""Axis of a part: the curvature's component in section axes, and the sign of that component for a positive angle.

"z" and "y" are those of a URDF: a positive angle turns the part behind about +z or +y (REP-103) of the part ahead.
"""

MOST_MODES = 12  # modes of a continuous part
HINGE = -1  # degree of a joint's mode


class Part(Quantities):
    """Base of joints, passive tails and muscles. Errors name the part, the field and the value.

    What the mechanics ask of a part are the properties below. A new kind derives from it, and is a line of `kinds.py`.
    """

    key: ClassVar[str]  # of the list of its kind, in files and in `Robot.changed`
    axis: str
    name: str
    actuator: Any = None  # of a joint
    moment: Law | None = None  # of a muscle

    def __post_init__(self) -> None:
        super().__post_init__()
        checked_choice(f"{self.what} axis", self.axis, AXES)

    @property
    def component(self) -> int:
        """Component of the curvature in section axes: 1 pitch, 2 yaw."""
        return AXES[self.axis][0]

    @property
    def sign(self) -> float:
        """Sign of the curvature's component for a positive angle."""
        return 1.0

    @property
    def place(self) -> float:
        """X [m] by which parts are ordered."""
        raise NotImplementedError

    @property
    def support(self) -> tuple[float, float]:
        """X [m] of its beginning and end, if both are known."""
        raise NotImplementedError

    @property
    def degrees(self) -> Sequence[int]:
        """Of its modes: degrees of Legendre polynomials, or `HINGE` alone."""
        raise NotImplementedError

    @property
    def geometry(self) -> tuple[Any, ...]:
        """What must stay where its other numbers change in a march."""
        raise NotImplementedError

    def located(self, beside: Sequence[float], body: Body) -> Self:
        """The part with the width or end that follows from the `body`, and from X [m] of its axis' other joints."""
        raise NotImplementedError

    def check_place(self, body: Body) -> None:
        """`ValueError` for a located part that does not lie inside the `body`."""
        raise NotImplementedError


def checked_range(name: str, values: Any, unit: str) -> tuple[float, float]:
    """`values` as two finite numbers that rise."""
    if isinstance(values, (list, tuple)) and len(values) == 2:
        low, high = (number(name, value, unit) for value in values)
        if low < high:
            return low, high
        values = list(values)
    raise ValueError(f"{name} must be two numbers that rise, got {shown(values)}")
