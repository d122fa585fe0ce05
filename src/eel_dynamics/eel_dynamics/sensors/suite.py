# SPDX-License-Identifier: Apache-2.0
"""All sensors of a swimmer by name, read sample by sample."""

import math
from collections.abc import Iterable
from functools import partial
from typing import Any

import numpy as np
from eel_common.quantity import checked_instance
from numpy.typing import ArrayLike

from eel_dynamics.model.body.body import Body
from eel_dynamics.model.robot.actuators import current_by_torque
from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.sensors.encoders import Encoders, JointReadings
from eel_dynamics.sensors.imu import Imu
from eel_dynamics.sensors.pressure import Pressure
from eel_dynamics.sensors.sensor import Motion, Sensor, SensorSettings, StationedSettings, Surroundings
from eel_dynamics.sensors.timing import check_rate
from eel_dynamics.sensors.velocity import Velocity
from eel_dynamics.simulation.observations import Snapshot
from eel_dynamics.simulation.simulation import Simulation
from eel_dynamics.simulation.swimmer import Swimmer

KINDS: dict[str, type[SensorSettings]] = {"imu": Imu, "pressure": Pressure, "velocity": Velocity, "encoders": Encoders}


class SensorSuite:
    """The sensors of a `Simulation` with these `settings`: `Imu`, `Pressure`, `Velocity`, `Encoders`.

    `Simulation(sensors=)` must have their stations. signs: (J,) or one, factor of each joint's angle, rate and current
    in readings of encoders: 1, or the sign in messages. `ValueError` for settings that do not fit the simulation.

    Attributes:
        sensors: `Sensor` by name (`SensorSettings.names`), of the settings with a rate.
    """

    def __init__(self, settings: Iterable[SensorSettings], simulation: Simulation | Swimmer, signs: ArrayLike = 1.0):
        self.sensors: dict[str, Sensor] = {}
        swimmer = simulation if isinstance(simulation, Swimmer) else simulation.swimmer
        self._robot, self._signs, places = swimmer.robot, np.asarray(signs), swimmer.sensors
        self._index: dict[str, int] = {}  # of sensors at stations: place in a snapshot
        kinds = set[str]()
        for each in settings:
            check_settings(each, swimmer.body, self._robot, math.inf)
            if not each.rate:
                continue
            if each.what in kinds:
                raise ValueError(f"sensors must be one of each kind, with all its stations, got {each.what} twice")
            kinds.add(each.what)
            around = Surroundings.of(swimmer.scene, swimmer.flow)
            if not isinstance(each, StationedSettings):
                self.sensors[each.what] = Sensor(each, around, joints=len(self._robot.joints) if self._robot else 0)
                continue
            for name, station in zip(each.names, each.stations, strict=True):
                if station not in places:
                    raise ValueError(f"sensors of the simulation must have {station:g} m, for {name}, got {places}")
                self.sensors[name], self._index[name] = Sensor(each, around, station), places.index(station)

    def begin(self) -> None:
        """Restart: the same readings follow."""
        for sensor in self.sensors.values():
            sensor.begin()

    def read(self, snapshot: Snapshot) -> dict[str, Any]:
        """The readings at the `snapshot` by name, of sensors that are due. Call this once for each sample, in order."""
        found = {}
        for name, sensor in self.sensors.items():
            if name in self._index:
                motion: Any = partial(Motion.of, snapshot, self._index[name])
            else:
                motion = partial(joints_of, snapshot.time, snapshot.joints, self._robot, self._signs)
            if (reading := sensor.reading(snapshot.time, motion)) is not None:
                found[name] = reading
        return found


def places_of(settings: Iterable[SensorSettings]) -> tuple[float, ...]:
    """Stations (S,) [m] of the sensors with a rate, ascending, each once."""
    on_body = [each for each in settings if isinstance(each, StationedSettings) and each.rate]
    return tuple(sorted({station for each in on_body for station in each.stations}))


def joints_of(
    time: Any, arrays: dict[str, np.ndarray], robot: Robot | None, signs: np.ndarray | float = 1.0
) -> JointReadings:
    """The true values of the joints of a `robot`, times `signs`. arrays: by name, (T, J) of a run or (J,) of a
    snapshot."""
    current = arrays["motor_torque"] * current_by_torque(robot.servos if robot else ())
    values = arrays["joint_angle"], arrays["joint_rate"], current
    return JointReadings(time, *(signs * each + 0.0 for each in values))  # no minus zeros


def check_settings(settings: SensorSettings, body: Body, robot: Robot | None, rate: float) -> None:
    """`ValueError` for `settings`, with a rate, that do not fit a swimmer, or its samples at `rate` [Hz]."""
    checked_instance("sensor", settings, SensorSettings)
    if not settings.rate:
        return
    check_rate(f"{settings.what} rate", settings.rate, rate)
    if isinstance(settings, Encoders) and (robot is None or not robot.joints):
        raise ValueError("encoders need a robot with joints")
    if isinstance(settings, StationedSettings):
        for station in settings.stations:
            if not 0.0 <= station <= body.length:
                raise ValueError(f"{settings.what} stations must lie within 0 to {body.length:g} m, got {station:g} m")
        if len(set(settings.stations)) < len(settings.stations):
            raise ValueError(f"{settings.what} stations must differ, got {list(settings.stations)}")
