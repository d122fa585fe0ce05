# SPDX-License-Identifier: Apache-2.0
"""The actuators of a joint: a servo that follows the law, or a torque given over time.

Angles, speeds and torques are those of the joint, after the gear, in the joint's sign. A servo's torque is

    tau = clip(kp (reference - angle) + kd (reference rate - rate), low, high),
    high = torque_limit clip(1 - rate/speed_limit, 0, 1),   low = -torque_limit clip(1 + rate/speed_limit, 0, 1).

The rotor adds gear^2 rotor_inertia to the joint's inertia. With a series spring the rotor has its own angle th:

    gear^2 rotor_inertia thdd = tau - tau_joint - friction thd,
    tau_joint = series_stiffness (th - angle) + series_damping (thd - rate);

The servo's feedback then uses th.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from eel_common.quantity import Quantities, checked_row, documented, is_finite, quantity
from eel_common.wording import shown


@documented
@dataclass(frozen=True, kw_only=True, repr=False)
class Servo(Quantities):
    """A motor that follows the law by its own feedback. Immutable; `ValueError` names a bad field."""

    what: ClassVar[str] = "servo"

    kp: float = quantity(10.0, "N m/rad", "stiffness of the feedback", 0.0)
    kd: float = quantity(0.2, "N m s/rad", "damping of the feedback, on the error of the rate", 0.0)
    torque_limit: float | None = quantity(None, "N m", "greatest torque, at rest; None: none", 0.0, exclusive=True)
    speed_limit: float | None = quantity(
        None, "rad/s", "speed at which no torque is left; None: none", 0.0, exclusive=True
    )
    gear: float = quantity(1.0, "", "reduction: turns of the rotor for one of the joint", 1.0)
    rotor_inertia: float = quantity(0.0, "kg m^2", "of the rotor itself, ahead of the gear", 0.0)
    friction: float = quantity(0.0, "N m s/rad", "viscous friction of motor and gear, at the joint", 0.0)
    series_stiffness: float | None = quantity(
        None, "N m/rad", "of the spring between gear and joint; None: stiff", 0.0, exclusive=True
    )
    series_damping: float = quantity(0.0, "N m s/rad", "of that spring", 0.0)
    torque_constant: float | None = quantity(
        None, "N m/A", "torque of the rotor by its current, ahead of the gear; None: not known", 0.0, exclusive=True
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.series_stiffness is not None and self.rotor_inertia == 0.0:
            raise ValueError("servo rotor_inertia must be > 0 kg m^2 with a series spring, got 0.0")
        if self.series_stiffness is None and self.series_damping:
            raise ValueError(f"servo series_damping goes with series_stiffness, got {self.series_damping:g} alone")

    @property
    def reflected_inertia(self) -> float:
        """gear^2 rotor_inertia [kg m^2]: the rotor's inertia at the joint."""
        return self.gear**2 * self.rotor_inertia

    @property
    def has_spring(self) -> bool:
        """Whether there is a series spring between gear and joint: the motor then has its own angle."""
        return self.series_stiffness is not None


@dataclass(frozen=True, repr=False)
class Torque(Quantities):
    """A torque [N m] on a joint, given over time.

    Args:
        torque: a function of the time [s], or values (n,) at `time`.
        time: (n,) [s], rising, two or more; with values only. They are interpolated by a cubic spline; the first and
            the last value are held.

    `ValueError` names a bad argument.
    """

    torque: Callable[[float], float] | tuple[float, ...]
    time: tuple[float, ...] | None = None

    def __post_init__(self) -> None:
        if self.time is None:
            if not callable(self.torque):
                raise ValueError(
                    f"torque must be a function of the time, or values with time=, got {shown(self.torque)}"
                )
            return
        time, values = checked_row("torque time", self.time, None), checked_row("torque", self.torque, None)
        if len(time) < 2 or not (np.diff(time) > 0.0).all():
            raise ValueError(f"torque time must be two instants or more that rise, got {shown(time.tolist())}")
        if len(values) != len(time):
            raise ValueError(f"torque must have as many values as time, {len(time)}, got {len(values)}")
        object.__setattr__(self, "time", tuple(time.tolist()))
        object.__setattr__(self, "torque", tuple(values.tolist()))

    @cached_property
    def spline(self) -> Any:
        """The spline through the values; None for a function."""
        from scipy.interpolate import CubicSpline

        return None if self.time is None else CubicSpline(self.time, self.torque)

    def at(self, time: Any) -> np.ndarray:
        """The torque [N m] at `time` [s], one or (n,). `ValueError` if a function gives no finite number."""
        instants = np.asarray(time, dtype=float)
        if self.spline is not None:
            return np.asarray(self.spline(np.clip(instants, self.spline.x[0], self.spline.x[-1])))
        values = np.array([self.called(float(each)) for each in instants.ravel()])
        return values.reshape(instants.shape)

    def called(self, time: float) -> float:
        """The torque [N m] of a function at `time` [s]. `ValueError` as in `at`."""
        assert callable(self.torque)
        value: Any = self.torque(time)
        if not is_finite(value):
            raise ValueError(f"torque must give one finite number, got {shown(value)} at {time:.6g} s")
        return float(value)

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "spline"}


Actuator = Servo | Torque
AT_LIMIT = 1.0 - 1e-9  # of a servo's greatest torque at its speed: above this it counts as at its limit


def most_torque(servos: Sequence[Servo | None], torque: np.ndarray, power: np.ndarray) -> np.ndarray:
    """Greatest possible torques (..., J) [N m] of motors at their present speeds, which follow from their `torque`
    [N m] and `power` [W]; inf: no limit."""
    limit, fastest = (
        np.array([np.inf if each is None else getattr(each, name) or np.inf for each in servos])
        for name in ("torque_limit", "speed_limit")
    )
    along = np.divide(power, np.abs(torque), out=np.zeros(torque.shape), where=torque != 0.0)  # rate along the torque
    left = np.clip(1.0 - along / fastest, 0.0, 1.0)
    return np.asarray(np.multiply(limit, left, out=np.full(torque.shape, np.inf), where=np.isfinite(limit)))


def current_by_torque(servos: Sequence[Servo | None]) -> np.ndarray:
    """Current per torque at the joint (J,) [A/(N m)] of motors; NaN without a torque constant."""
    constants = [each and each.torque_constant and 1.0 / (each.gear * each.torque_constant) for each in servos]
    return np.array([np.nan if each is None else each for each in constants], dtype=float)


def at_limit(servos: Sequence[Servo | None], torque: np.ndarray, power: np.ndarray) -> np.ndarray:
    """Whether motors (..., J) with this `torque` [N m] and `power` [W] are at their limits. None: no servo."""
    return np.asarray(np.abs(torque) >= AT_LIMIT * most_torque(servos, torque, power))
