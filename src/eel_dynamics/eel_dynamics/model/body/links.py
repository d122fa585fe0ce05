# SPDX-License-Identifier: Apache-2.0
"""Bodies of links, like those of robots: one elliptic section, joints with drag, blunt ends unless they have a cap.

Their hull coefficients (hull.py): cross flow and added mass by the section's shape, drag of the links and of the ends.
For the ends c_p + c_b is 0.6: a blunt cylinder along the flow has 0.81 and 0.99 (Hoerner), minus friction of 0.2 to
0.3. A coasting robot gave 0.61 above laminar friction and 0.40 above turbulent (docs/explanation/life.md). The split of
2 to 1 is our own.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from eel_common.quantity import is_finite, number, positive
from eel_common.wording import shown
from numpy.typing import ArrayLike

from eel_dynamics.model.body.hull import BY_SHAPE, SEPARATED

FLUSH, ALONE = "flush", 0.87  # joints that add no drag of links; c_s of isolated blunt cylinders
BASE = 0.2  # c_b
BLUNT = "blunt"
MOST_LINKS = 64
OF_LINKS: dict[str, Any] = {"lateral_drag": BY_SHAPE, "vertical_drag": BY_SHAPE, "round_added_mass": SEPARATED}


@dataclass(frozen=True)
class LinkHalfAxis:
    """A half-axis of one `size` [m] along a `length` [m]. At X = 0 it begins with a quarter ellipse of `cap` [m], and
    at the tail it ends with a straight edge of `edge` [m]; 0 for none."""

    size: float
    length: float
    cap: float = 0.0
    edge: float = 0.0

    def __call__(self, x: ArrayLike) -> np.ndarray:
        """[m] at `x` [m]."""
        x = np.asarray(x, dtype=float)
        ahead = np.clip(1.0 - x / self.cap, 0.0, 1.0) if self.cap else np.zeros_like(x)
        left = np.clip((self.length - x) / self.edge, 0.0, 1.0) if self.edge else np.ones_like(x)
        return np.asarray(self.size * np.sqrt(1.0 - ahead**2) * left)


def joint_drag_of(joints: Any) -> float:
    """c_s of `joints`: "flush", or a number from 0 to 0.87, or its text. `ValueError` for anything else."""
    if isinstance(joints, str) and joints == FLUSH:
        return 0.0
    try:
        return number("joints", float(joints) if isinstance(joints, str) else joints, minimum=0.0, maximum=ALONE)
    except ValueError:
        raise ValueError(
            f"joints must be {FLUSH}, or the drag coefficient of a link by itself, 0 (a smooth body) to {ALONE} (each "
            f"link a blunt cylinder alone), got {shown(joints)}"
        ) from None


def arguments_of_links(
    length: float,
    number: int,
    half_width: float,
    half_height: float,
    joints: Any,
    nose: Any = BLUNT,
    tail: Any = BLUNT,
) -> dict[str, Any]:
    """The arguments of a `Body` of links; the parameters are those of `Body.of_links`. `ValueError` names a bad one."""
    length, half_width = positive("body length", length, "m"), positive("body half_width", half_width, "m")
    half_height = positive("body half_height", half_height, "m")
    if not is_finite(number) or number != int(number) or not 1 <= number <= MOST_LINKS:
        raise ValueError(f"body number of links must be a whole number, 1 to {MOST_LINKS}, got {shown(number)}")
    cap, edge = (_end(what, given, length) for what, given in (("nose", nose), ("tail", tail)))
    return {
        "length": length,
        "half_width": LinkHalfAxis(half_width, length, cap, edge),
        "half_height": LinkHalfAxis(half_height, length, cap),
        "kinks": (*((cap,) if cap else ()), *((length - edge,) if edge else ())),
        "blunt_nose": not cap,
        "base_drag": 0.0 if edge else BASE,
        "joint_drag": joint_drag_of(joints),
        "link_length": length / number,
        "name": "links",
        **OF_LINKS,
    }


def _end(what: str, given: Any, length: float) -> float:
    """The length [m] of a cap or an edge; 0 for a blunt end."""
    if isinstance(given, str) and given == BLUNT:
        return 0.0
    try:
        value = positive(f"body {what}", given, "m")
    except ValueError:
        value = length
    if not value < 0.5 * length:
        raise ValueError(
            f"body {what} must be {BLUNT}, or a length above 0 and below half the body's, {0.5 * length:g} m, got "
            f"{shown(given)}"
        )
    return value
