# SPDX-License-Identifier: Apache-2.0
"""The messages of sensors, and their frames.

imu, pressure, depth, velocity, joint_states and motor_states are published at the sensor's rate. The stamp is the time
of the reading. A message is published with the first sample after its latency; those of t = 0 are published at once.
Each sensor at a station has a frame NAME_link below the head's frame: on /tf_static if the body ahead of it is rigid,
else on /tf with each sample.
"""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from eel_common.attitude import product
from eel_common.ros.headers import frame_in
from eel_common.ros.loop.serialised_message import SerialisedMessage
from geometry_msgs.msg import PoseWithCovarianceStamped, TransformStamped, TwistWithCovarianceStamped
from tf2_msgs.msg import TFMessage

from eel_dynamics.model.robot.joint_signs import message_signs
from eel_dynamics.ros.messages import SECOND, SampleMessages
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.runs.exchange.message_fields import OF_JOINTS
from eel_dynamics.sensors.encoders import Encoders, JointReadings
from eel_dynamics.sensors.imu import Imu, ImuReadings
from eel_dynamics.sensors.pressure import Pressure, PressureReadings
from eel_dynamics.sensors.sensor import Surroundings
from eel_dynamics.sensors.suite import SensorSuite
from eel_dynamics.sensors.timing import Delay
from eel_dynamics.sensors.velocity import VelocityReadings
from eel_dynamics.simulation.observations import Snapshot
from eel_dynamics.simulation.simulation import Simulation

FRAMES = "sensor_frames"  # key of the message for /tf
NOT_MEASURED = 1e6  # variance, in SI units, of a number in a message that the sensor does not measure


class SensorMessages:
    """The messages of the sensors of a `simulation` with these `settings`.

    sample: of the simulation. Encoders send its messages of joints, with their own angles, rates and currents.

    Attributes:
        kinds: message type by topic, and for `FRAMES` if a sensor moves relative to the head.
        static: transforms from the head to the other sensors, for /tf_static.
    """

    def __init__(
        self, settings: tuple[Any, ...], simulation: Simulation, parameters: DynamicsParameters, sample: SampleMessages
    ) -> None:
        self._suite, self._sample = SensorSuite(settings, simulation, message_signs(simulation.robot)), sample
        self._around = Surroundings.of(simulation.scene, simulation.flow)
        self._late = Delay()  # topics and messages
        self._messages: dict[str, SerialisedMessage] = {}
        self.static: list[TransformStamped] = []
        moving: list[TransformStamped] = []
        rigid = rigid_until(simulation) if self._suite.sensors else 0.0
        self._places: list[int] = []  # indices of the moving sensors in a snapshot
        space = parameters.head_frame.rpartition("/")[0]
        for name, sensor in self._suite.sensors.items():
            if isinstance(sensor.settings, Encoders):
                self._messages |= {topic: sample.message(topic) for topic in OF_JOINTS}
                continue
            frame = frame_in(space, f"{name}_link")
            made = _messages_of(name, sensor.settings, self._around, frame, parameters.world_frame)
            self._messages |= {topic: SerialisedMessage(message) for topic, message in made.items()}
            transform = TransformStamped(child_frame_id=frame)
            transform.header.frame_id = parameters.head_frame
            transform.transform.translation.x = 0.0 - sensor.station
            (self.static if sensor.station <= rigid else moving).append(transform)
            if sensor.station > rigid:
                self._places.append(simulation.swimmer.sensors.index(sensor.station))
        if moving:
            self._messages[FRAMES] = SerialisedMessage(TFMessage(transforms=moving))
        self.kinds: dict[str, Any] = {topic: message.kind for topic, message in self._messages.items()}

    def due(
        self, snapshot: Snapshot, nanoseconds: int, heard: Callable[[str], Any] = bool
    ) -> Iterator[tuple[str, bytes]]:
        """Topic and message of each message that is due at the sample of `nanoseconds`.

        Call this for each sample; at time 0 all sensors restart. heard: tells whether a topic has subscribers. A sensor
        without subscribers is read too, so that its noise continues, but its messages are not made.
        """
        if not self._messages:
            return
        if nanoseconds == 0:
            self._suite.begin()
            self._late = Delay()
        for name, readings in self._suite.read(snapshot).items():
            # No latency at the start: a controller that listens to sensors alone could not start the run otherwise.
            due = nanoseconds + (round(self._suite.sensors[name].settings.latency * 1e9) if nanoseconds else 0)
            for topic in _FILL[type(readings)](self, name, readings, snapshot):
                if heard(topic):
                    self._late.put(due, (topic, self._sealed(topic, nanoseconds)))
        yield from self._late.take(nanoseconds)
        if FRAMES in self._messages and heard(FRAMES):
            self._fill_frames(snapshot)
            yield FRAMES, self._sealed(FRAMES, nanoseconds)

    def _sealed(self, topic: str, nanoseconds: int) -> bytes:
        message = self._messages[topic]
        for stamp in message.stamps:
            stamp[:] = divmod(nanoseconds, SECOND)
        return message.data()

    def _fill_imu(self, name: str, readings: ImuReadings, snapshot: Snapshot) -> tuple[str, ...]:
        numbers = self._messages[name].numbers
        numbers["linear_acceleration"][:] = readings.specific_force
        numbers["angular_velocity"][:] = readings.angular_velocity
        if readings.orientation is not None:
            numbers["orientation"][:] = readings.orientation
        return (name,)

    def _fill_pressure(self, name: str, readings: PressureReadings, snapshot: Snapshot) -> tuple[str, ...]:
        depth = name.replace("pressure", "depth")
        self._messages[name].numbers[""][0] = readings.pressure
        self._messages[depth].numbers["pose.pose.position"][2] = self._around.surface - readings.depth
        return name, depth

    def _fill_velocity(self, name: str, readings: VelocityReadings, snapshot: Snapshot) -> tuple[str, ...]:
        self._messages[name].numbers["twist.twist.linear"][:] = readings.velocity
        return (name,)

    def _fill_joints(self, name: str, readings: JointReadings, snapshot: Snapshot) -> tuple[str, ...]:
        states, motors = (self._sample.filled(topic, snapshot).numbers for topic in OF_JOINTS)
        states["position"][:], states["velocity"][:], motors["current"][:] = readings[1:]
        return OF_JOINTS

    def _fill_frames(self, snapshot: Snapshot) -> None:
        """Set the transforms from the head to the moving sensors."""
        numbers = self._messages[FRAMES].numbers
        (x, y, z, w), places = snapshot.orientation.tolist(), snapshot.sensor_position - snapshot.position
        for k, place in enumerate(self._places):
            a, b, c = places[place].tolist()
            p, q, r = 2.0 * (z * b - y * c), 2.0 * (x * c - z * a), 2.0 * (y * a - x * b)
            turned = a + w * p + z * q - y * r, b + w * q + x * r - z * p, c + w * r + y * p - x * q
            numbers[f"transforms[{k}].transform.translation"][:] = turned
            there = snapshot.sensor_orientation[place].tolist()
            numbers[f"transforms[{k}].transform.rotation"][:] = product((-x, -y, -z, w), there)


_FILL: dict[type, Callable[..., tuple[str, ...]]] = {
    ImuReadings: SensorMessages._fill_imu,
    PressureReadings: SensorMessages._fill_pressure,
    VelocityReadings: SensorMessages._fill_velocity,
    JointReadings: SensorMessages._fill_joints,
}


def rigid_until(simulation: Simulation) -> float:
    """X [m] up to which the body is rigid with the head: 0, or up to the first part of a robot that bends."""
    modes = simulation.swimmer.modes
    if modes is None or not len(modes):
        return 0.0
    first = float(np.min(modes.start))
    return 0.0 if modes.imposed(np.linspace(0.0, first, 9)[1:]).any() else first


def _messages_of(name: str, settings: Any, around: Surroundings, frame: str, world: str) -> dict[str, Any]:
    """The messages of a sensor by topic, with their constant fields."""
    from sensor_msgs.msg import FluidPressure  # here: importing its package takes a tenth of the node's start
    from sensor_msgs.msg import Imu as ImuMessage

    noise = settings.spread(1).noise
    variance = np.square(noise)
    if isinstance(settings, Imu):
        message = ImuMessage()
        message.linear_acceleration_covariance, message.angular_velocity_covariance, message.orientation_covariance = (
            np.diag(rows).ravel() for rows in variance.reshape(3, 3)
        )
        if not settings.orientation:
            message.orientation_covariance[0] = -1.0
        found = {name: (message, frame)}
    elif isinstance(settings, Pressure):
        place, known = PoseWithCovarianceStamped(), around.depth_of(float(noise[0])) ** 2
        place.pose.covariance = np.diag([NOT_MEASURED, NOT_MEASURED, known, *[NOT_MEASURED] * 3]).ravel()
        gauge = FluidPressure(variance=float(variance[0]))
        found = {name: (gauge, frame), name.replace("pressure", "depth"): (place, world)}
    else:
        twist = TwistWithCovarianceStamped()
        twist.twist.covariance = np.diag([*variance, *[NOT_MEASURED] * 3]).ravel()
        found = {name: (twist, frame)}
    for message, frame_id in found.values():
        message.header.frame_id = frame_id
    return {topic: message for topic, (message, _) in found.items()}
