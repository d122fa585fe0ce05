# SPDX-License-Identifier: Apache-2.0
"""A joint: a short part of the body that bends as a whole, with spring, damper, stops and a motor.

Within `width` about `position` the curvature is angle / width; 0 for the links between. As the width goes to 0 the
joint becomes a hinge, and the motion converges to that of rigid links. The torque of a joint is

    stiffness (angle - rest_angle) + damping rate - tau,

tau is the motor's torque. At a depth > 0 beyond a limit the stop's torque is added, against the depth:

    depth max(0, stop_stiffness + stop_damping depth_rate / STOP_DEPTH).

It starts from zero at contact, as in Hunt and Crossley (J. Appl. Mech. 42 (1975)), so that no torque jumps, and a stop
never pulls. All angles are positive where the body bends to the left (yaw) or up (pitch), as the gaits' `left_bend`;
with the axis "-yaw" or "-pitch" to the right or down. With "z" or "y", as of a URDF, a positive angle turns the part
behind the joint about +z or +y (REP-103) of the part ahead: its tail end goes to the right, or up.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

from eel_common.quantity import checked_instance, documented, quantity, required
from eel_common.wording import shown

from eel_dynamics.model.body.body import Body
from eel_dynamics.model.robot.actuators import Actuator, Servo, Torque
from eel_dynamics.model.robot.part import AXES, HINGE, Part, checked_range

LONGEST_NAME = 100
LONE_WIDTH = 0.05  # of the length: width of the only joint in an axis
STOP_DEPTH = 0.01  # rad beyond a limit, where the stop has its `stop_damping`


@documented
@dataclass(frozen=True, repr=False)
class Joint(Part):
    """A joint. Immutable; `ValueError` names a bad field."""

    what: ClassVar[str] = "joint"
    key: ClassVar[str] = "joints"

    position: float = required("m", "X of its middle, from the nose", 0.0, exclusive=True)
    axis: str = quantity(
        "yaw",
        "",
        "yaw (positive: left), pitch (up), -yaw (right), -pitch (down); or z, y, -z, -y, as of a URDF",
        plain=True,
    )
    width: float | None = quantity(
        None, "m", "length that bends; None: half of the distance to the next joint", 0.0, exclusive=True
    )
    stiffness: float = quantity(0.0, "N m/rad", "of the spring in parallel with the motor", 0.0)
    damping: float = quantity(0.0, "N m s/rad", "of the damper in parallel", 0.0)
    rest_angle: float = quantity(0.0, "rad", "at which the spring has no torque")
    limits: tuple[float, float] | None = quantity(None, "", "angles of the hard stops [rad]; None: none", plain=True)
    armature: float = quantity(0.0, "kg m^2", "inertia of what turns with the angle besides the body", 0.0)
    actuator: Actuator | None = quantity(None, "", "a Servo or a Torque; None: passive", plain=True)
    name: str = quantity("", "", "in messages, commands and tables; empty: joint_1, joint_2, ...", plain=True)
    stop_stiffness: float = quantity(100.0, "N m/rad", "of the hard stops", 0.0, exclusive=True)
    stop_damping: float = quantity(0.1, "N m s/rad", "of the hard stops, 0.01 rad beyond the limit", 0.0)
    initial_angle: float | None = quantity(
        None, "rad", "at the start, at rest; None: the servo's reference, or where the spring rests, within the limits"
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.limits is not None:
            object.__setattr__(self, "limits", checked_range("joint limits", self.limits, "rad"))
        start = self.initial_angle
        if start is not None and self.limits is not None and not self.limits[0] <= start <= self.limits[1]:
            raise ValueError(f"joint initial_angle must lie within limits {self.limits} rad, got {start:g} rad")
        if self.actuator is not None:
            checked_instance("joint actuator", self.actuator, (Servo, Torque))
        if not isinstance(self.name, str) or len(self.name) > LONGEST_NAME:
            raise ValueError(f"joint name must be a text of at most {LONGEST_NAME} characters, got {shown(self.name)}")

    @property
    def support(self) -> tuple[float, float]:
        assert self.width is not None
        return self.position - 0.5 * self.width, self.position + 0.5 * self.width

    @property
    def sign(self) -> float:
        return float(AXES[self.axis][1])

    @property
    def place(self) -> float:
        return self.position

    @property
    def degrees(self) -> Sequence[int]:
        return (HINGE,)

    @property
    def geometry(self) -> tuple[Any, ...]:
        return type(self), self.position, self.width, self.axis, getattr(self.actuator, "has_spring", False)

    def located(self, beside: Sequence[float], body: Body) -> "Joint":
        if self.width is not None:
            return self
        nearest = min((abs(place - self.position) for place in beside), default=2.0 * LONE_WIDTH * body.length)
        if nearest == 0.0:
            raise ValueError(f"joints of one axis must have positions of their own, got {self.position:g} m twice")
        return replace(self, width=0.5 * nearest)

    def check_place(self, body: Body) -> None:
        called, (start, end) = f"joint {shown(self.name)} position and width", self.support
        said = f"got {start:g} to {end:g} m (position {self.position:g}, width {self.width:g})"
        if start <= 0.0 or end >= body.length:
            raise ValueError(f"{called} must lie inside (0, {body.length:g}) m, {said}")
        if not body.blunt_nose and start < body.panel_ends[0] - 1e-12 * body.length:
            behind = f"must lie behind the nose's first panel, from {body.panel_ends[0]:g} m on"
            raise ValueError(f"{called} {behind} (there is almost no inertia ahead), {said}")
