# SPDX-License-Identifier: Apache-2.0
"""An inertial measurement unit: specific force, angular velocity and, if wanted, orientation.

    f = a - g

a is the acceleration of the section's centre. At rest f is 9.80665 m/s^2 upwards, for any weight of the body. The
orientation is that of the sensor in the world, as an attitude filter in the unit estimates it. Its error is a small
rotation about each axis.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

from eel_common.attitude import product
from eel_common.quantity import documented, quantity

from eel_dynamics.sensors.noise import Spread
from eel_dynamics.sensors.sensor import Components, Motion, StationedSettings, Surroundings, as_rows

NONE = (0.0, 0.0, 0.0)


class ImuReadings(NamedTuple):
    """Readings of an IMU, in its axes. A single reading has no dimension N, and tuples of floats."""

    time: Any  # (N,) s
    specific_force: Any  # (N, 3) m/s^2
    angular_velocity: Any  # (N, 3) rad/s
    orientation: Any  # (N, 4) x y z w, world from sensor; None for a unit without


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

    def read(self, time: Any, motion: Motion, around: Surroundings, errors: Components) -> ImuReadings:
        (_, _, _, *acceleration), (*turning, _, _, _) = motion.acceleration, motion.twist
        upward = up(motion.orientation)
        force = [a + around.gravity * u + e for a, u, e in zip(acceleration, upward, errors[:3], strict=True)]
        angular = [w + e for w, e in zip(turning, errors[3:6], strict=True)]
        turned = as_rows(turned_by(motion.orientation, errors[6:])) if self.orientation else None
        return ImuReadings(time, as_rows(force), as_rows(angular), turned)


def up(orientation: Components) -> tuple[Any, Any, Any]:
    """The world's z axis in a frame with this `orientation` x y z w, world from frame."""
    x, y, z, w = orientation
    return 2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)


def turned_by(orientation: Components, angles: Components) -> tuple[Any, Any, Any, Any]:
    """An orientation x y z w, turned by small `angles` (3,) [rad] about its own axes."""
    a, b, c = (0.5 * angle for angle in angles)
    return product(orientation, (a, b, c, abs(1.0 - (a * a + b * b + c * c)) ** 0.5))
