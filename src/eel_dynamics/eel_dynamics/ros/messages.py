# SPDX-License-Identifier: Apache-2.0
"""Makes messages of snapshots and of the simulation: samples, the body, transforms, diagnostics.

Poses, twists and the backbone are in REP-103 axes; section quantities have the paper's section axes: 1 = -x, 2 = -y,
3 = +z of the section, turned as base_link. The library has the same axes. `joint_signs` has the signs of joints.
"""

import array
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from eel_common.attitude import heading
from eel_common.ros.headers import stamp_of
from eel_common.ros.loop.serialised_message import SerialisedMessage
from eel_common.topics import ENERGY_FIELDS
from geometry_msgs.msg import PoseStamped, TransformStamped, TwistStamped, Vector3Stamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from tf2_msgs.msg import TFMessage

from eel_dynamics.accuracy.error_estimate import HeadErrors
from eel_dynamics.analysis.joint_demand import Joints
from eel_dynamics.model.axes import with_section_axes
from eel_dynamics.model.flow.flow import lattice_around, velocities_at
from eel_dynamics.model.robot.actuators import current_by_torque, most_torque
from eel_dynamics.model.robot.joint_signs import OF_SECTIONS, message_signs
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.ros.wrench_frames import wrench_frames
from eel_dynamics.runs.exchange.message_fields import FIELDS, LINEAR, OF_JOINTS, SIGNED
from eel_dynamics.runs.exchange.messages_of_run import fields_of_fins, fields_of_joints, numbers_of_appendages, outline
from eel_dynamics.simulation.observations import Snapshot
from eel_dynamics.simulation.simulation import Simulation
from eel_msgs import msg

Numbers = dict[str, np.ndarray]  # of a SerialisedMessage, by path
SECOND = 1_000_000_000  # ns


class SampleMessages:
    """The serialised messages of one sample of a `simulation`: `fill` returns that of a topic, `tick` that of /clock.

    Attributes:
        kinds: message type by topic.
    """

    def __init__(self, simulation: Simulation, parameters: DynamicsParameters) -> None:
        self._nanoseconds, self._simulation = (0, 0), simulation
        x, scene = simulation.x, simulation.scene
        self._errors: HeadErrors | None = None  # errors that the covariances of odom hold at present
        world, head, section = parameters.world_frame, parameters.head_frame, parameters.section_frame
        topics: dict[str, tuple[Any, str]] = {
            "head_pose": (PoseStamped(), world),
            "head_twist": (TwistStamped(), head),
            "odom": (Odometry(child_frame_id=head), world),
            "backbone": (msg.Backbone(), world),
            "curvature": (msg.Curvature(), section),
            "internal_wrench": (msg.InternalWrench(), section),
            "hydrodynamic_load": (msg.HydrodynamicLoad(fin_name=[fin.name for fin in simulation.fins]), section),
            "energy": (msg.EnergyLedger(), world),
            "swim_state": (msg.SwimState(), world),
            "flow_at_head": (Vector3Stamped(), world),
        }
        for name, computed in (("internal_wrench", scene.internal_wrench), ("energy", scene.ledger)):
            if not computed:
                del topics[name]
        for message, frame in topics.values():
            message.header.frame_id = frame
            _lengthen(message, np.asarray(x, dtype=float), len(simulation.fins))
        if (flow := simulation.flow) is not None:
            zero = array.array("d", bytes(8 * lattice_around(np.zeros(3), simulation.body.length, flow).size))
            vectors = msg.FlowVectors(position=zero, velocity=zero)
            vectors.header.frame_id = world
            topics["flow_vectors"] = vectors, world
        self._tf_stations = len(x) if parameters.publish_tf_stations else 0
        frames = {frame: station for frame, station in wrench_frames(parameters).items() if frame != head}
        self._wrench_places = [simulation.swimmer.sensors.index(station) for station in frames.values()]
        children = [head, *(f"{section}_{k}" for k in range(self._tf_stations)), *frames]
        transforms = [TransformStamped(child_frame_id=child) for child in children]
        for transform in transforms:
            transform.header.frame_id = world
        topics["/tf"] = TFMessage(transforms=transforms), world
        yaw, pitch = parameters.yaw_joints, parameters.pitch_joints
        robots = (2, slice(0, yaw), yaw), (1, slice(yaw, yaw + pitch), pitch)  # section axis, place, number of joints
        self._joints = [(axis, place, Joints(x, float(x[-1]), count)) for axis, place, count in robots if count]
        robot = simulation.robot
        if self._joints or robot is not None:
            from sensor_msgs.msg import JointState  # here, for its package takes a tenth of the node's start

            names = [f"{name}_{k + 1}" for name, count in (("yaw", yaw), ("pitch", pitch)) for k in range(count)]
            if robot is not None:
                names = [joint.name for joint in robot.joints]
            zeros = [0.0] * len(names)
            effort = zeros if scene.internal_wrench or robot is not None else []
            joint_state = JointState(name=names, position=zeros, velocity=zeros, effort=effort)
            topics["joint_states"] = joint_state, ""
            if robot is not None and robot.joints:
                motors = msg.MotorStates(name=names, torque=zeros, limit=zeros, power=zeros, current=zeros)
                topics["motor_states"] = motors, ""
        if simulation.fins:
            from sensor_msgs.msg import JointState

            count = [0.0] * len(simulation.fins)
            names = [fin.name for fin in simulation.fins]
            topics["fin_states"] = JointState(name=names, position=count, effort=[]), ""
        self.kinds = {name: type(message) for name, (message, _) in topics.items()}
        self._further: dict[str, Callable[[Numbers, Snapshot], None]] = {  # fields that are not in `FIELDS`
            "odom": self._fill_covariances,
            "hydrodynamic_load": self._without_minus_zeros,
            "energy": self._fill_energy,
            "swim_state": self._fill_state,
            "flow_at_head": self._fill_flow,
            "flow_vectors": self._fill_vectors,
            "/tf": self._fill_transform,
            "motor_states": self._fill_limits,
        }
        own = dict(FIELDS)
        if robot is None:
            self._further["joint_states"], own["joint_states"] = self._fill_joints, {}
        signs = message_signs(robot)
        self._signs = signs if (signs < 0.0).any() else None
        self._signed: dict[str, list[np.ndarray]] = {}  # by topic: numbers to be multiplied by the signs of joints
        self._topics: dict[str, tuple[SerialisedMessage, list[tuple[str, list[tuple[np.ndarray, Any]]]]]] = {}
        for name, (message, _) in topics.items():
            numbers = (serialised := SerialisedMessage(message)).numbers
            fields = [(path, each) for path, each in own.get(name, {}).items() if path in numbers]
            places: dict[str, list[tuple[np.ndarray, Any]]] = {each.quantity: [] for _, each in fields}
            for path, each in fields:
                places[each.quantity].append((numbers[path], (..., each.components)))
            if name in OF_JOINTS and self._signs is not None:
                self._signed[name] = [numbers[path] for path, each in fields if each.quantity in SIGNED]
            self._topics[name] = serialised, list(places.items())
        self._clock = SerialisedMessage(Clock())

    def set_time(self, nanoseconds: int) -> None:
        """Set the simulation time [ns] of all messages, including /clock's."""
        self._nanoseconds = divmod(nanoseconds, SECOND)

    def tick(self) -> bytes:
        """The message of /clock."""
        return self._sealed(self._clock)

    def fill(self, name: str, snapshot: Snapshot) -> bytes:
        """The message of topic `name`, filled from `snapshot`."""
        return self._sealed(self.filled(name, snapshot))

    def message(self, name: str) -> SerialisedMessage:
        """The message of topic `name`, which `filled` fills."""
        return self._topics[name][0]

    def filled(self, name: str, snapshot: Snapshot) -> SerialisedMessage:
        """The same without its stamp; its numbers may be replaced."""
        message, fields = self._topics[name]
        quantity = snapshot.joints.__getitem__ if name in OF_JOINTS else snapshot.__getattribute__
        for each, places in fields:
            values = quantity(each)
            for place, components in places:
                place[:] = values[components].ravel()
        for place in self._signed.get(name, ()):
            place *= self._signs
            place += 0.0  # no minus zeros
        if name in self._further:
            self._further[name](message.numbers, snapshot)
        return message

    def _sealed(self, message: SerialisedMessage) -> bytes:
        for stamp in message.stamps:
            stamp[:] = self._nanoseconds
        return message.data()

    def _fill_covariances(self, numbers: Numbers, snapshot: Snapshot) -> None:
        errors = self._simulation.head_errors or NO_ERRORS
        if errors != self._errors:  # they change ten times a second
            self._errors, known = errors, math.isfinite(errors.position)
            pose, twist = np.square((errors[1:3], errors[3:5]))
            for name, variances in (("pose.covariance", pose), ("twist.covariance", twist)):
                numbers[name][:] = np.diag(np.repeat(variances, 3)).ravel() if known else UNKNOWN

    def _fill_transform(self, numbers: Numbers, snapshot: Snapshot) -> None:
        numbers["transforms[0].transform.translation"][:] = snapshot.position
        numbers["transforms[0].transform.rotation"][:] = snapshot.orientation
        poses: list[Any] = []
        if self._tf_stations:
            poses += zip(snapshot.backbone, with_section_axes(snapshot.section_orientation), strict=True)
        poses += [
            (snapshot.sensor_position[place], snapshot.sensor_orientation[place]) for place in self._wrench_places
        ]
        for k, (position, rotation) in enumerate(poses, start=1):
            numbers[f"transforms[{k}].transform.translation"][:] = position
            numbers[f"transforms[{k}].transform.rotation"][:] = rotation

    def _without_minus_zeros(self, numbers: Numbers, snapshot: Snapshot) -> None:
        for name in ("tail_force", "nose_force", "wake_momentum_rate"):
            numbers[name] += 0.0

    def _fill_energy(self, numbers: Numbers, snapshot: Snapshot) -> None:
        numbers[""][:] = [getattr(snapshot.energy, name) for name in ENERGY_FIELDS]

    def _fill_state(self, numbers: Numbers, snapshot: Snapshot) -> None:
        errors = self._simulation.head_errors
        numbers[""][:] = (  # in the order of the fields
            np.linalg.norm(snapshot.twist[LINEAR]),
            -snapshot.position[2],
            heading(snapshot.orientation),
            math.nan if snapshot.torque is None else np.max(np.abs(snapshot.torque)),
            math.nan if snapshot.actuator_work is None else snapshot.actuator_work,
            math.nan if errors is None else errors.relative,
        )

    def _fill_flow(self, numbers: Numbers, snapshot: Snapshot) -> None:
        numbers["vector"][:] = self._simulation.water_at(snapshot.position)

    def _fill_vectors(self, numbers: Numbers, snapshot: Snapshot) -> None:
        simulation, flow = self._simulation, self._simulation.flow
        assert flow is not None
        points = lattice_around(snapshot.backbone.mean(axis=0), simulation.body.length, flow)
        velocity = velocities_at(flow, points, simulation.time) + simulation.swimmer.current
        numbers["position"][:], numbers["velocity"][:] = points.ravel(), velocity.ravel()

    def _fill_joints(self, numbers: Numbers, snapshot: Snapshot) -> None:
        for axis, place, joints in self._joints:
            sign = OF_SECTIONS[axis]
            numbers["position"][place] = sign * joints.angle(snapshot.curvature)[:, axis] + 0.0
            numbers["velocity"][place] = sign * joints.angle(snapshot.curvature_rate)[:, axis] + 0.0
            if "effort" in numbers:
                numbers["effort"][place] = sign * joints.motor_torque(snapshot.torque)[:, axis] + 0.0

    def _fill_limits(self, numbers: Numbers, snapshot: Snapshot) -> None:
        assert self._simulation.robot is not None
        servos, torque = self._simulation.robot.servos, numbers["torque"]
        numbers["limit"][:] = most_torque(servos, torque, numbers["power"])
        numbers["current"][:] = torque * current_by_torque(servos)


def _lengthen(message: Any, x: np.ndarray, fins: int) -> None:
    """Set the length of each sequence in a `message` for this number of `fins` and the stations `x` (M,) [m]."""
    for field, kind in message.get_fields_and_field_types().items():
        if kind == "sequence<double>":
            count = 3 * fins if field == "fin_force" else {"position": 3, "orientation": 4}.get(field, 1) * len(x)
            setattr(message, field, array.array("d", x.tolist() if field == "x" else bytes(8 * count)))


NO_ERRORS = HeadErrors(*[math.inf] * 5)
UNKNOWN = np.array([-1.0, *[0.0] * 35])  # a covariance


def root_transform(parameters: DynamicsParameters) -> TransformStamped:
    """The transform from `root_frame` to `world_frame`, which coincide."""
    transform = TransformStamped(child_frame_id=parameters.world_frame)
    transform.header.frame_id = parameters.root_frame
    return transform


def body_message(simulation: Simulation, section_frame: str) -> msg.BodyGeometry:
    """The body's outline at the stations and at points in between, which are denser at the nose; fins and joints."""
    body = simulation.body
    message = msg.BodyGeometry(
        length=float(body.length),
        mass=float(body.mass_in(simulation.scene.density)),
        fins=[msg.FinGeometry(**fields) for fields in fields_of_fins(simulation.fins)],
        joints=[msg.JointGeometry(**fields) for fields in fields_of_joints(simulation.robot)],
    )
    message.header.frame_id = section_frame
    message.appendages = array.array("f", numbers_of_appendages(body))
    for name, values in outline(body, simulation.x).items():
        setattr(message, name, array.array("d", values.tolist()))
    return message


def diagnostic_array(time: float, name: str, level: int, text: str, values: dict[str, Any]) -> DiagnosticArray:
    """A DiagnosticArray with one status of the node `name` at simulation time `time` [s]."""
    status = DiagnosticStatus(level=bytes([level]), name=name, message=text, hardware_id="simulation")
    status.values = [
        KeyValue(key=key, value=f"{value:.9g}" if isinstance(value, float) else str(value))
        for key, value in values.items()
    ]
    message = DiagnosticArray(status=[status])
    message.header.stamp = stamp_of(time)
    return message


def values_of_status(status: DiagnosticStatus) -> dict[str, str]:
    """The values of a status by key."""
    return {pair.key: pair.value for pair in status.values}
