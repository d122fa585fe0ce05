# SPDX-License-Identifier: Apache-2.0
"""What sensors cost: `python benchmarks/run.py sensors`."""

from functools import partial
from typing import Any

from eel_dynamics.ros.messages import SampleMessages
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.ros.sensors import SensorMessages
from measuring import Lines, median_ratio, times_in_turn

from eel_dynamics import Imu, Pressure, SensorSuite, Simulation, Velocity
from eel_gaits import falling

RATE, SAMPLES = 200.0, 600  # Hz; of a repeat
IMU = Imu(rate=RATE, stations=(0.4,), accelerometer_noise=0.02, gyroscope_noise=0.001, orientation=True)
KINDS: dict[str, tuple[Any, ...]] = {
    "none": (),
    "an IMU": (IMU,),
    "IMU, pressure, velocity": (IMU, Pressure(rate=RATE, noise=50.0), Velocity(rate=RATE, noise=0.01)),
}


def sensors() -> Lines:
    """CPU time of a sample at 200 Hz with sensors of that rate, by one without, in turn. Library: advance, observe with
    wrench and loads (51 stations), read. Node: the same, and all messages made; what sending takes comes on top."""
    for place, action in (("library", _library), ("node", _node)):
        times = times_in_turn({name: partial(action, kinds) for name, kinds in KINDS.items()})
        yield f"{place}, a sample without sensors", 1e6 * min(times["none"]) / SAMPLES, "us"
        for name in list(KINDS)[1:]:
            yield f"{place} with {name}, by none", median_ratio(times[name], times["none"]), "times as long"


def _swimmer(kinds: tuple[Any, ...]) -> Simulation:
    return Simulation(law=falling(), sensors=sorted({station for each in kinds for station in each.stations}))


def _library(kinds: tuple[Any, ...]) -> None:
    swimmer = _swimmer(kinds)
    suite = SensorSuite(kinds, swimmer)
    for k in range(SAMPLES):
        swimmer.advance(k / RATE)
        suite.read(swimmer.observe())


def _node(kinds: tuple[Any, ...]) -> None:
    swimmer, parameters = _swimmer(kinds), DynamicsParameters(rate=RATE)
    messages, read = SampleMessages(swimmer, parameters), SensorMessages(kinds, swimmer, parameters)
    for k in range(SAMPLES):
        swimmer.advance(k / RATE)
        snapshot, stamp = swimmer.observe(), round(k * 1e9 / RATE)
        messages.set_time(stamp)
        for topic in messages.kinds:
            messages.fill(topic, snapshot)
        for _ in read.due(snapshot, stamp):
            pass
