# SPDX-License-Identifier: Apache-2.0
"""An estimate of the error of a run, from its distance to a companion: the same swimmer with coarser settings.

The companion has another grid, a looser tolerance and longer longest steps, and so about ten times the error of the
run. Their distance is thus a conservative estimate of the run's error. It is not scaled by an order of convergence:
observed orders are 2.3 to 4.9. It includes the growth of errors, which the error of a single step does not.

The two are compared in runs/companion.py, and those of a node in simulation/error_meter.py. The error of a single step
is `error_by_tolerance` in eel_core/steppers/step_control.hpp.
"""

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

ROUND_OFF = 2e-16  # relative error of the arithmetic; it grows with the motion's sensitivity
ROUND_OFF_SHARE = 0.1  # most of the target that grown round-off may use
# Part of body length and path: a larger distance of two runs is saturated, and no longer grows.
SMALL = 0.03
FIRST_PART = 0.2  # share of a run in which the distance grows from zero, and does not show the sensitivity
# Growth of errors over a run, above which its motion is called sensitive: step errors add up to t or t^2 at most,
# and their logarithm rises by 1.8 or 3.6 in a line through the later 80 %.
SENSITIVE = np.log(100.0)
LEAST_SAMPLES = 5  # of a fit of the growth rate
# Floors of relative errors: this part of m (l/T)^2 for torques, l/T for speeds, 1/T for rates; m mass, l length, T the
# shortest period or the run's duration. Below it, a relative error would be one of round-off.
FLOOR = 1e-3
PROMISED = "position", "torque"  # the errors that a target bounds
MEASURED = *PROMISED, "orientation", "twist", "joint_angle", "joint_rate"


@dataclass(frozen=True)
class ErrorEstimate:
    """Errors of a run, infinite if unknown. A target bounds only those of position and torque.

    position, torque: relative, as accuracy targets define them; torque is None for a run without internal wrench or
    stations. growth_rate [1/s]: the distance of two runs grows by a factor of e in 1/growth_rate; 0 if no growth is
    seen. evaluations: of the head's dynamics for the estimate, in addition to the run's; cost: the same, each times the
    nodes along the body. resampling: the part of the errors of position and torque that comes from the rows of a
    `SampledLaw`; None for a law in closed form.

    The others are the greatest over all samples; None without such a quantity, and in older files. orientation [rad]:
    of the head. twist: of its velocity, relative to the greatest speed of the run, or likewise of its angular velocity,
    whichever is greater. joint_angle [rad]: of a robot's joints, and of the modes of tails and muscles, times their
    length. joint_rate: of their rates, relative to the greatest.
    """

    position: float
    torque: float | None
    growth_rate: float = 0.0
    evaluations: int = 0
    cost: int = 0
    resampling: float | None = None
    orientation: float | None = None
    twist: float | None = None
    joint_angle: float | None = None
    joint_rate: float | None = None

    @property
    def errors(self) -> dict[str, float]:
        """The known errors among `MEASURED`, by name."""
        found = {name: getattr(self, name) for name in MEASURED}
        return {name: value for name, value in found.items() if value is not None}

    @property
    def worst(self) -> float:
        """The greater error of position and torque."""
        return max(self.position, self.torque or 0.0)

    def with_torque(self, least: float) -> "ErrorEstimate":
        """The same, with the error of the torque, if any, at least `least`."""
        return self if self.torque is None else replace(self, torque=max(self.torque, least))

    def at_least(self, share: float, other: "ErrorEstimate") -> "ErrorEstimate":
        """The same, with each error at least `share` of that of `other`, if known."""
        least = {name: value for name, value in other.errors.items() if np.isfinite(value)}
        changes: dict[str, Any] = {
            name: max(value, share * least[name]) for name, value in self.errors.items() if name in least
        }
        return replace(self, **changes)

    def round_off(self, duration: float) -> float:
        """The relative error to which round-off has grown after `duration` [s] at the `growth_rate`."""
        with np.errstate(over="ignore"):
            return float(ROUND_OFF * np.exp(self.growth_rate * duration))

    def sensitive(self, duration: float) -> bool:
        """Whether errors grow so much in `duration` [s] that the motion itself amplifies them."""
        return bool(self.growth_rate * duration > SENSITIVE)

    def hopeless(self, target: float, duration: float) -> bool:
        """Whether grown round-off exceeds `ROUND_OFF_SHARE` of the `target`: then no settings help."""
        return self.round_off(duration) > ROUND_OFF_SHARE * target

    def over_target(self, target: float | None, duration: float) -> str:
        """One line if the error is above the `target`, otherwise empty."""
        if target is None or self.worst <= target:
            return ""
        if not np.isfinite(self.worst):
            return f"the error is not known: a run with coarser settings stopped; the target is {target:g}"
        line = f"the error is estimated at {self.worst:.1e}, above the target {target:g}"
        if self.resampling is not None and self.resampling > 0.5 * self.worst:
            return f"{line}: most of it comes from the rows of the law, which are too far apart"
        if not self.sensitive(duration):
            return line
        line += f": the motion is sensitive, and errors grow by a factor of e in {1.0 / self.growth_rate:.2g} s"
        if self.hopeless(target, duration):
            line += ", so that round-off alone may spoil it"
        return line


class HeadErrors(NamedTuple):
    """Errors of the head's motion: greatest differences from the companion's, or infinite if unknown."""

    relative: float  # -, of the position, as in `ErrorEstimate`
    position: float  # m
    orientation: float  # rad
    velocity: float  # m/s
    angular_velocity: float  # rad/s


class Floors(NamedTuple):
    """Floors: the relative errors of smaller values refer to these."""

    torque: float  # N m
    speed: float  # m/s
    rate: float  # rad/s


def floors_of(law, mass: float, length: float, duration: float) -> Floors:
    """The floors of a run of `duration` [s] by `law` (or None), of a body of `mass` [kg] and `length` [m]."""
    periods = [term.period for term in law.waves] if law is not None else []
    return floors(mass, length, min(periods, default=max(duration, 1.0)))


def floors(mass: float, length: float, time: float) -> Floors:
    """The floors for a `mass` [kg] that moves by `length` [m] in a `time` [s]; infinite if a power would overflow."""
    fast = length / time
    return Floors(FLOOR * mass * (fast * fast), FLOOR * fast, FLOOR / time)


def twist_size(twist: np.ndarray) -> np.ndarray:
    """(2,) m/s, rad/s: the greatest speed and angular speed in twists (..., 6) or their differences."""
    sizes = np.linalg.norm(twist.reshape(-1, 2, 3), axis=2).max(axis=0)
    return np.asarray(sizes[::-1])


def angle_between(one: np.ndarray, two: np.ndarray) -> np.ndarray:
    """(...) rad: the angle between two unit quaternions (..., 4), the same for q and -q."""
    same, opposite = (np.linalg.norm(one + sign * two, axis=-1) for sign in (-1.0, 1.0))
    return np.asarray(4.0 * np.arcsin(np.minimum(1.0, np.minimum(same, opposite) / 2.0)))


def growth_rate_of(time: np.ndarray, distance: np.ndarray, small: float) -> float:
    """Slope [1/s] of the logarithm of the `distance` (T,) over `time` (T,), while it is `small`; or 0."""
    grown = distance >= small
    growing = (distance > 0.0) & (np.arange(len(time)) < (np.argmax(grown) if grown.any() else len(time)))
    counts = growing & (time >= FIRST_PART * time[-1])
    if counts.sum() < LEAST_SAMPLES:
        counts = growing  # it has grown within the first part
    if counts.sum() < LEAST_SAMPLES:
        return 0.0
    since_mean = time[counts] - time[counts].mean()
    return max(0.0, float(since_mean @ np.log(distance[counts]) / (since_mean @ since_mean)))
