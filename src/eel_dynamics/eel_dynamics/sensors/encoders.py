# SPDX-License-Identifier: Apache-2.0
"""Encoders and ammeters of a robot's joints: angle, rate, and the current of each motor.

    current = torque / (gear * torque_constant)

The current is NaN for a motor without a torque constant.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from eel_common.quantity import documented, quantity

from eel_dynamics.sensors.noise import Spread
from eel_dynamics.sensors.sensor import Components, SensorSettings, Surroundings


class JointReadings(NamedTuple):
    """Readings, or true values, of the joints of a robot, each (N, J); (J,) of one reading."""

    time: Any  # (N,) s
    angle: np.ndarray  # rad
    rate: np.ndarray  # rad/s
    current: np.ndarray  # A, of the motors


@documented
@dataclass(frozen=True, kw_only=True, repr=False)
class Encoders(SensorSettings):
    """Encoders and ammeters of all joints of a robot."""

    what, number = "encoders", 4

    resolution: float = quantity(0.0, "rad", "step of a reading of the angle; 0: none", 0.0)
    angle_noise: float = quantity(0.0, "rad", "standard deviation of a reading, before it is rounded", 0.0)
    angle_bias: float = quantity(0.0, "rad", "constant")
    angle_walk: float = quantity(0.0, "rad/sqrt(s)", "standard deviation of the bias after 1 s", 0.0)
    rate_noise: float = quantity(0.0, "rad/s", "standard deviation of a reading of the rate", 0.0)
    current_noise: float = quantity(0.0, "A", "standard deviation of a reading", 0.0)
    current_bias: float = quantity(0.0, "A", "constant")

    def spread(self, joints: int) -> Spread:
        return Spread.of(
            (self.angle_noise, self.angle_bias, self.angle_walk, joints),
            (self.rate_noise, 0.0, 0.0, joints),
            (self.current_noise, self.current_bias, 0.0, joints),
        )

    def read(self, time: Any, motion: JointReadings, around: Surroundings, errors: Components) -> JointReadings:
        of_angle, of_rate, of_current = (each.T for each in np.split(np.array(errors), 3))
        angle, step = motion.angle + of_angle, self.resolution
        if step:
            angle = step * np.round(angle / step)
        return JointReadings(time, angle, motion.rate + of_rate, motion.current + of_current)
