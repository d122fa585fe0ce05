# SPDX-License-Identifier: Apache-2.0
"""What all sensors have in common: settings, the motion that they measure, and their readings.

A sensor sits on the backbone at a station X. Its axes turn with the section there: x forward, y left, z up, as those
of the head. The core computes its motion by the integrals that give all profiles (`show_sensors` in
eel_core/march/observe.hpp). So its acceleration is that of the equations of motion, not a difference of velocities.
"""

from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np
from eel_common.quantity import Quantities, quantity

from eel_dynamics.model.flow.flow import Flow
from eel_dynamics.model.scene import Scene
from eel_dynamics.model.section_data import GRAVITY
from eel_dynamics.sensors.noise import Errors, Spread
from eel_dynamics.sensors.timing import Timing, readings_among
from eel_dynamics.simulation.observations import SENSORS, Observations, Snapshot

SIZES = tuple(zip(SENSORS, (3, 4, 6, 6, 3), strict=True))  # of each quantity, how many numbers
Components = Sequence[Any]  # of a vector: floats at one instant, or arrays (N,) at N instants


class Motion(NamedTuple):
    """The motion of one sensor at one instant, or at N; quantities and axes as in `Observations`."""

    position: Components
    orientation: Components
    twist: Components
    acceleration: Components
    water: Components

    @staticmethod
    def of(seen: Observations, index: int, rows: Any = slice(None)) -> "Motion":
        """The motion of the sensor number `index`: at some `rows` of a run's samples, or in a snapshot."""
        if isinstance(seen, Snapshot):
            places = ((seen.places[name][0].start + index * n, n) for name, n in SIZES)
            return Motion(*(seen.whole[begin : begin + n].tolist() for begin, n in places))
        return Motion(*(getattr(seen, name)[rows, index].T for name in SENSORS))


def as_rows(components: Components) -> Any:
    """(3,) floats of one reading as a tuple; (N, 3) of several as an array."""
    return np.stack(components, axis=1) if isinstance(components[0], np.ndarray) else tuple(components)


class Surroundings(NamedTuple):
    """Density [kg/m^3] of the water, height [m] of its surface in the world, gravity [m/s^2]."""

    density: float
    surface: float
    gravity: float = GRAVITY

    @staticmethod
    def of(scene: Scene, flow: Flow | None) -> "Surroundings":
        """The surroundings in a scene. The surface is that of the `flow`, if it has one; else z = 0."""
        height = np.inf if flow is None else flow.traits.surface_height
        return Surroundings(scene.fluid_density, float(height) if np.isfinite(height) else 0.0)

    def depth_of(self, pressure: Any) -> Any:
        """Depth [m] of water whose weight gives a `pressure` [Pa]; 0 where the water has no density."""
        by_depth = self.density * self.gravity
        return pressure / by_depth if by_depth else 0.0 * pressure


@dataclass(frozen=True, kw_only=True, repr=False)
class SensorSettings(Quantities):
    """Settings of a kind of sensor. Immutable; `ValueError` names an invalid field."""

    number: ClassVar[int]  # of the kind, as a part of seeds

    rate: float = quantity(0.0, "Hz", "readings per simulated second, at samples of the run; 0: no sensor", 0.0)
    latency: float = quantity(0.0, "s", "from a reading to its message, whose stamp is that of the reading", 0.0, 60.0)
    seed: int = quantity(0, "", "of the noise: an equal seed gives equal readings to the last bit", 0, 2**31 - 1)

    @property
    def names(self) -> tuple[str, ...]:
        """Name of each sensor, as of its topic: `imu`, or `imu_1`, `imu_2` ... of several stations."""
        return (self.what,)

    @abstractmethod
    def spread(self, joints: int) -> Spread:
        """Noise, bias and walk of a reading, on a robot with this number of `joints`."""

    @abstractmethod
    def read(self, time: Any, motion: Any, around: Surroundings, errors: Components) -> Any:
        """The reading at `time` [s], or those at `time` (N,) [s], with these `errors`: a NamedTuple, time first."""


@dataclass(frozen=True, kw_only=True, repr=False)
class StationedSettings(SensorSettings):
    """Settings of a kind of sensor that sits at stations."""

    stations: tuple[float, ...] = quantity((0.0,), "m", "X of each sensor, from the nose", any_length=True)

    @property
    def names(self) -> tuple[str, ...]:
        many = len(self.stations) > 1
        return tuple(f"{self.what}_{k}" if many else self.what for k in range(1, 1 + len(self.stations)))


class Sensor:
    """One sensor at X = `station` [m], or on all `joints` of a robot. It reads a whole run, or sample by sample."""

    def __init__(self, settings: SensorSettings, around: Surroundings, station: float = 0.0, joints: int = 0):
        self.settings, self.station, self._around, self._joints = settings, station, around, joints
        self.begin()

    def begin(self) -> None:
        """Restart: the same readings follow."""
        settings = self.settings
        seed = settings.seed, settings.number, round(self.station * 1e9)
        self._errors, self._timing = Errors(settings.spread(self._joints), seed), Timing(settings.rate)

    def readings(self, times: np.ndarray, motion_at: Callable[[np.ndarray], Any]) -> Any:
        """All readings of a run with samples at `times` (T,) [s]. motion_at: gives the motion at indices of samples."""
        rows, gaps = readings_among(times, self.settings.rate)
        self.begin()
        return self.settings.read(times[rows], motion_at(rows), self._around, self._errors.all(gaps))

    def reading(self, time: float, motion: Callable[[], Any]) -> Any:
        """The reading at the next sample, at `time` [s]; None if none is due. motion: gives the present motion."""
        gap = self._timing.gap(time)
        return None if gap is None else self.settings.read(time, motion(), self._around, self._errors.one(gap))
