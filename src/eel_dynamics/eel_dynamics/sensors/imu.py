# SPDX-License-Identifier: Apache-2.0
"""An inertial measurement unit: specific force, angular velocity and, where it estimates one, orientation.

    f = a - g,   at rest 9.80665 m/s^2 upwards, whatever the body weighs

a is the true acceleration of the section's centre. The orientation is that of the sensor in the world, as of an
attitude filter within the unit, with an error that is a small rotation about each axis.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from eel_common.quantity import documented, quantity

from eel_dynamics.sensors.noise import Spread
from eel_dynamics.sensors.sensor import Motion, StationedSettings, Surroundings

NONE = (0.0, 0.0, 0.0)


class ImuReadings(NamedTuple):
    """Readings of an IMU, in its axes."""

    time: np.ndarray  # (N,) s
    specific_force: np.ndarray  # (N, 3) m/s^2
    angular_velocity: np.ndarray  # (N, 3) rad/s
    orientation: np.ndarray | None  # (N, 4) x y z w, world from sensor


@documented
@dataclass(frozen=True, kw_only=True, repr=False)
class Imu(StationedSettings):
    """An IMU. The noise of a reading is the noise density of a data sheet times sqrt(rate)."""

    what, number = "imu", 1

    orientation: bool = quantity(False, "", "whether it gives an orientation")
    accelerometer_noise: float = quantity(0.0, "m/s^2", "standard deviation of a reading", 0.0)
    accelerometer_bias: tuple[float, float, float] = quantity(NONE, "m/s^2", "constant, along x, y, z")
    accelerometer_walk: float = quantity(0.0, "m/s^2/sqrt(s)", "standard deviation of the bias after 1 s", 0.0)
    gyroscope_noise: float = quantity(0.0, "rad/s", "standard deviation of a reading", 0.0)
    gyroscope_bias: tuple[float, float, float] = quantity(NONE, "rad/s", "constant, about x, y, z")
    gyroscope_walk: float = quantity(0.0, "rad/s/sqrt(s)", "standard deviation of the bias after 1 s", 0.0)
    orientation_noise: float = quantity(0.0, "rad", "standard deviation of a reading, about each axis", 0.0, 0.5)

    def spread(self, joints: int) -> Spread:
        return Spread.of(
            (self.accelerometer_noise, self.accelerometer_bias, self.accelerometer_walk, 3),
            (self.gyroscope_noise, self.gyroscope_bias, self.gyroscope_walk, 3),
            (self.orientation_noise, 0.0, 0.0, 3),
        )

    def read(self, time: np.ndarray, motion: Motion, around: Surroundings, errors: np.ndarray) -> ImuReadings:
        force = motion.acceleration[:, 3:] + around.gravity * up(motion.orientation) + errors[:, :3]
        turned = turned_by(motion.orientation, errors[:, 6:]) if self.orientation else None
        return ImuReadings(time, force, motion.twist[:, :3] + errors[:, 3:6], turned)


def up(orientation: np.ndarray) -> np.ndarray:
    """The world's z (N, 3) in the axes of a frame, by its `orientation` (N, 4) x y z w, world from frame."""
    x, y, z, w = orientation.T
    return np.stack((2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)), axis=1)


def turned_by(orientation: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """Orientations (N, 4) x y z w, turned by small `angles` (N, 3) [rad] about their own axes."""
    x, y, z, w = orientation.T
    a, b, c = 0.5 * angles.T
    d = np.sqrt(np.maximum(0.0, 1.0 - (a * a + b * b + c * c)))
    rows = (
        w * a + x * d + y * c - z * b,
        w * b - x * c + y * d + z * a,
        w * c + x * b - y * a + z * d,
        w * d - x * a - y * b - z * c,
    )
    return np.stack(rows, axis=1)
