# SPDX-License-Identifier: Apache-2.0
"""A velocity log: the sensor's velocity over ground, or through the water, in its own axes.

The velocity through the water is relative to the undisturbed flow at the sensor, including the current.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

from eel_common.quantity import documented, quantity

from eel_dynamics.sensors.noise import Spread
from eel_dynamics.sensors.sensor import Components, Motion, StationedSettings, Surroundings, as_rows


class VelocityReadings(NamedTuple):
    """Readings of a velocity log, in its axes. A single reading has no dimension N, and a tuple of floats."""

    time: Any  # (N,) s
    velocity: Any  # (N, 3) m/s


@documented
@dataclass(frozen=True, kw_only=True, repr=False)
class Velocity(StationedSettings):
    """A velocity log, such as a Doppler log (DVL)."""

    what, number = "velocity", 3

    through_water: bool = quantity(False, "", "relative to the water; off: over ground")
    noise: float = quantity(0.0, "m/s", "standard deviation of a reading", 0.0)
    bias: tuple[float, float, float] = quantity((0.0, 0.0, 0.0), "m/s", "constant, along x, y, z")
    walk: float = quantity(0.0, "m/s/sqrt(s)", "standard deviation of the bias after 1 s", 0.0)

    def spread(self, joints: int) -> Spread:
        return Spread.of((self.noise, self.bias, self.walk, 3))

    def read(self, time: Any, motion: Motion, around: Surroundings, errors: Components) -> VelocityReadings:
        water = motion.water if self.through_water else (0.0, 0.0, 0.0)
        return VelocityReadings(
            time, as_rows([v - u + e for v, u, e in zip(motion.twist[3:], water, errors, strict=True)])
        )
