# SPDX-License-Identifier: Apache-2.0
"""The readings of sensors on the swimmer of a run: `Run.imu` and the like.

A run does not keep the motion at all X, so its swim is marched again for a sensor, with equal results to the last bit.
"""

from functools import partial
from typing import Any

import numpy as np
from eel_common.cached import cached_property
from eel_common.wording import shown

from eel_dynamics.runs.observed_swim import observed_again
from eel_dynamics.runs.run_data import RunData
from eel_dynamics.sensors.encoders import Encoders, JointReadings
from eel_dynamics.sensors.imu import Imu, ImuReadings
from eel_dynamics.sensors.pressure import Pressure, PressureReadings
from eel_dynamics.sensors.sensor import Motion, Sensor, SensorSettings, Surroundings
from eel_dynamics.sensors.suite import check_settings, joints_of
from eel_dynamics.sensors.velocity import Velocity, VelocityReadings
from eel_dynamics.simulation.observations import Observations

SAME = 1e-9  # m: by how much the head may be elsewhere in a swim that is marched again


class SensedRun(RunData):
    """A run whose sensors can be read.

    rate: [Hz], at most that of the run's samples; None: theirs. settings: further ones of the kind of sensor, as
    `eel_dynamics.Imu` and the others document them. The node's sensors read the same with the same settings and
    samples; of joints, the signs of topics may be others. A latency changes nothing here: a reading has its own time.
    `ValueError` for a bad setting, and for a run that was not made by `simulate`.
    """

    def imu(self, station: float = 0.0, rate: float | None = None, **settings: Any) -> ImuReadings:
        """Readings of an IMU at X = `station` [m] (`eel_dynamics.Imu`)."""
        readings: ImuReadings = self._at(Imu, station, rate, settings)
        return readings

    def pressure(self, station: float = 0.0, rate: float | None = None, **settings: Any) -> PressureReadings:
        """Readings of a pressure gauge at X = `station` [m] (`eel_dynamics.Pressure`)."""
        readings: PressureReadings = self._at(Pressure, station, rate, settings)
        return readings

    def depth(self, station: float = 0.0, rate: float | None = None, **settings: Any) -> np.ndarray:
        """The depth (N,) [m] below the surface by the readings of `pressure`."""
        depth: np.ndarray = self.pressure(station, rate, **settings).depth
        return depth

    def velocity(self, station: float = 0.0, rate: float | None = None, **settings: Any) -> VelocityReadings:
        """Readings of a velocity log at X = `station` [m] (`eel_dynamics.Velocity`)."""
        readings: VelocityReadings = self._at(Velocity, station, rate, settings)
        return readings

    def encoders(self, rate: float | None = None, **settings: Any) -> JointReadings:
        """Readings of the encoders and ammeters of a robot's joints (`eel_dynamics.Encoders`)."""
        kind = self._made(Encoders, rate, settings)
        names = ("joint_angle", "joint_rate", "motor_torque")
        motion = joints_of(self.time, {name: getattr(self, name) for name in names}, self.robot)
        sensor = Sensor(kind, Surroundings.of(self.scene, self.flow), joints=motion.angle.shape[1])
        readings: JointReadings = sensor.readings(self.time, lambda rows: JointReadings(*(e[rows] for e in motion)))
        return readings

    def _at(self, kind: type[SensorSettings], station: float, rate: float | None, settings: dict[str, Any]) -> Any:
        if "stations" in settings:
            raise ValueError(f"stations must be one at a time, as station, got {shown(settings['stations'])}")
        made = self._made(kind, rate, {**settings, "stations": (station,)})
        (place,) = made.stations
        if place not in self._seen:
            self._seen[place] = seen_again(self, place)
        sensor = Sensor(made, Surroundings.of(self.scene, self.flow), place)
        return sensor.readings(self.time, partial(Motion.of, self._seen[place], 0))

    def _made(self, kind: Any, rate: float | None, settings: dict[str, Any]) -> Any:
        made = kind(rate=self._sample_rate if rate is None else rate, **settings)
        if not made.rate:
            raise ValueError(f"{made.what} rate must be > 0 Hz, got {made.rate:g}")
        check_settings(made, self.body, self.robot, self._sample_rate)
        return made

    @property
    def _sample_rate(self) -> float:
        """[Hz]; infinite of a run of one sample."""
        return float(1.0 / (self.time[1] - self.time[0])) if len(self.time) > 1 else np.inf

    @cached_property
    def _seen(self) -> dict[float, Observations]:
        """Observations by X [m], of the sensors that were read."""
        return {}


def seen_again(run: RunData, station: float) -> Observations:
    """The swim of a `run`, observed with a sensor at X = `station` [m]."""
    if not run.steps:
        raise ValueError("run must be made by simulate for its sensors to be read, got one from elsewhere")
    observed = observed_again(run, run.law, run.accuracy.as_it_is()).of_swimmer(sensors=(station,))
    out: Observations
    out, _, done, _ = observed.march().record(run.time, False, False)
    there = run.in_axes("rep103").position
    if done < len(run.time) or not np.allclose(out.position, there, rtol=0.0, atol=SAME):
        raise ValueError("run must be one that simulate repeats for its sensors to be read, got another motion")
    return out
