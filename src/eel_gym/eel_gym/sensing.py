# SPDX-License-Identifier: Apache-2.0
"""The readings of sensors that a policy of N swimmers observes: of each sensor the last one, 0 before the first.

`eel_dynamics.SensorSuite` reads at the ends of control steps. Each episode has its own noise.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from eel_dynamics.model.flow.flow import Flow
from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.sensors.encoders import Encoders
from eel_dynamics.sensors.imu import Imu
from eel_dynamics.sensors.pressure import Pressure
from eel_dynamics.sensors.sensor import SensorSettings
from eel_dynamics.sensors.suite import SensorSuite
from eel_dynamics.sensors.timing import Delay
from eel_dynamics.simulation.observations import Snapshot
from eel_dynamics.simulation.swimmer import Swimmer

from eel_gym.joint_action import ANGLE, RATE
from eel_gym.task import SPEED, SPIN, Observed

GRAVITY, DEPTH = 10.0, 1.0  # m/s^2, m: scales of a specific force and of a depth


def observed_by(settings: Sequence[SensorSettings], robot: Robot | None) -> tuple[Observed, ...]:
    """The numbers that a policy observes of sensors with these `settings`: names as of topics, units, scales."""
    seen: list[Observed] = []
    for each in settings:
        if not each.rate:
            continue
        for name in each.names:
            seen += [Observed(f"{name} {part}", unit, scale) for part, unit, scale in _parts(each, robot)]
    return tuple(seen)


def _parts(settings: SensorSettings, robot: Robot | None) -> list[tuple[str, str, float]]:
    if isinstance(settings, Imu):
        parts = [(f"specific force {axis}", "m/s^2", GRAVITY) for axis in "xyz"]
        parts += [(f"angular velocity {axis}", "rad/s", SPIN) for axis in "xyz"]
        return parts + [(f"orientation {axis}", "", 1.0) for axis in "xyzw" if settings.orientation]
    if isinstance(settings, Pressure):
        return [("depth", "m", DEPTH)]
    if isinstance(settings, Encoders):
        names = [joint.name for joint in robot.joints] if robot else []
        return [
            *((f"angle {name}", "rad", ANGLE) for name in names),
            *((f"rate {name}", "rad/s", RATE) for name in names),
        ]
    return [(f"velocity {axis}", "m/s", SPEED) for axis in "xyz"]


class Sensing:
    """The sensors with these `settings` of many `swimmers`, all alike: the `swimmer`.

    Attributes:
        values: (n, N) float64, the numbers that `observed_by` names.
    """

    def __init__(self, settings: Sequence[SensorSettings], swimmer: Swimmer, swimmers: int):
        self._settings, self._swimmer = tuple(settings), swimmer
        self._suites = [SensorSuite(self._settings, swimmer) for _ in range(swimmers)]
        self._late = [Delay() for _ in range(swimmers)]  # rows of `values`, and their numbers
        self.values = np.zeros((len(observed_by(settings, swimmer.robot)), swimmers))
        self._rows: dict[str, slice] = {}
        for name, sensor in self._suites[0].sensors.items():
            begin = max((rows.stop for rows in self._rows.values()), default=0)
            self._rows[name] = slice(begin, begin + len(_parts(sensor.settings, swimmer.robot)))

    def begin(self, index: int, random: np.random.Generator, flow: Flow | None) -> None:
        """Begin an episode of a swimmer in a `flow`, with noise drawn from its `random` numbers."""
        if self._settings:
            drawn = [replace(each, seed=int(random.integers(2**31))) for each in self._settings]
            self._suites[index] = SensorSuite(drawn, self._swimmer.unchecked(flow=flow))
            self.values[:, index] = 0.0
            self._late[index] = Delay()

    def look(self, index: int, observe: Callable[[], Snapshot]) -> None:
        """Read the sensors of a swimmer, and take over the readings whose latency is over."""
        if not self._settings:
            return
        snapshot, late = observe(), self._late[index]
        now = round(snapshot.time * 1e9)  # ns
        for name, (_, *parts) in self._suites[index].read(snapshot).items():
            settings = self._suites[index].sensors[name].settings
            seen = {Pressure: parts[1:], Encoders: parts[:2]}.get(type(settings), parts)  # the depth; no currents
            numbers = np.concatenate([np.atleast_1d(part) for part in seen if part is not None])
            late.put(now + round(settings.latency * 1e9), (self._rows[name], numbers))
        for rows, numbers in late.take(now):
            self.values[rows, index] = numbers
