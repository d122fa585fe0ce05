# SPDX-License-Identifier: Apache-2.0
"""A pressure gauge, and the depth by its reading.

    p = p_surface + rho_f g depth,   depth = z_surface - z

This is the hydrostatic pressure. Left out are the stagnation pressure and the pressure field of the body (both of the
order rho_f V^2 / 2: 0.5 kPa at 1 m/s, or 5 cm of water) and that of waves. z_surface is the flow's, or 0. The water of
the model has no upper end: above the surface the depth is negative.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

from eel_common.quantity import documented, quantity

from eel_dynamics.sensors.noise import Spread
from eel_dynamics.sensors.sensor import Components, Motion, StationedSettings, Surroundings


class PressureReadings(NamedTuple):
    """Readings of a pressure gauge, each (N,); or floats, of a single reading."""

    time: Any  # s
    pressure: Any  # Pa
    depth: Any  # m, below the surface


@documented
@dataclass(frozen=True, kw_only=True, repr=False)
class Pressure(StationedSettings):
    """A pressure gauge."""

    what, number = "pressure", 2

    surface_pressure: float = quantity(101325.0, "Pa", "of the air on the water", 0.0)
    noise: float = quantity(0.0, "Pa", "standard deviation of a reading", 0.0)
    bias: float = quantity(0.0, "Pa", "constant")
    walk: float = quantity(0.0, "Pa/sqrt(s)", "standard deviation of the bias after 1 s", 0.0)

    def spread(self, joints: int) -> Spread:
        return Spread.of((self.noise, self.bias, self.walk, 1))

    def read(self, time: Any, motion: Motion, around: Surroundings, errors: Components) -> PressureReadings:
        gauge = around.density * around.gravity * (around.surface - motion.position[2]) + errors[0]
        return PressureReadings(time, self.surface_pressure + gauge, around.depth_of(gauge))
