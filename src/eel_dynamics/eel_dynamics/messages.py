"""The node's messages: the run's samples as ROS messages, built once and refilled, and what comes in.

Library (the paper's) frames become REP-103 frames here and nowhere else, by `turn_vector` and `turn_quaternion`; fields
that are kept in section axes (1 = -x, 2 = -y, 3 = +z of base_link) pass unchanged.
"""

import array
import struct
from collections.abc import Callable
from dataclasses import Field

import numpy as np
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from eel_gaits.law import MAXIMUM_TERMS
from geometry_msgs.msg import PoseStamped, TransformStamped, TwistStamped
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.serialization import deserialize_message
from rosgraph_msgs.msg import Clock

from eel_msgs.msg import (
    Backbone,
    BodyGeometry,
    Curvature,
    CurvatureLaw,
    CurvatureSamples,
    EnergyLedger,
    HydrodynamicLoad,
    InternalWrench,
)

from .frames import turn_quaternion, turn_vector
from .parameters import limits
from .records import outline
from .scene import Scene

try:
    from tf2_msgs.msg import TFMessage
except ImportError:  # not part of every ROS 2 installation
    TFMessage = None

SECOND = 1_000_000_000  # ns


def seconds_of(time: Time) -> float:
    """A stamp in s."""
    return time.sec + 1e-9 * time.nanosec


class Sample:
    """One message per topic of samples; `fill` overwrites the message `name` from a snapshot, in place.

    A float64[] field is an `array.array`, which a numpy view fills without a copy in Python.
    """

    def __init__(self, x: np.ndarray, scene: Scene, world_frame: str, head_frame: str):
        self._time = Time()  # shared by all
        self._x = np.ascontiguousarray(x, dtype=float)
        self.clock = Clock(clock=self._time)
        self.messages = {
            "head_pose": PoseStamped(),
            "head_twist": TwistStamped(),
            "odom": Odometry(child_frame_id=head_frame),
            "backbone": Backbone(),
            "curvature": Curvature(),
            "internal_wrench": InternalWrench(),
            "hydrodynamic_load": HydrodynamicLoad(),
            "energy": EnergyLedger(),
        }
        for name, computed in (("internal_wrench", scene.internal_wrench), ("energy", scene.ledger)):
            if not computed:
                del self.messages[name]
        in_world = ("head_pose", "odom", "backbone", "energy")
        self._views = {}
        for name, message in self.messages.items():
            message.header.stamp = self._time
            message.header.frame_id = world_frame if name in in_world else head_frame
            self._views[name] = self._buffers_of(message)
        self.transform = TransformStamped(child_frame_id=head_frame)
        self.transform.header.stamp = self._time
        self.transform.header.frame_id = world_frame
        if TFMessage is not None:
            self.messages["/tf"] = TFMessage(transforms=[self.transform])
        self._fill = {
            "head_pose": self._fill_pose,
            "head_twist": self._fill_twist,
            "odom": self._fill_odometry,
            "backbone": self._fill_backbone,
            "curvature": self._fill_curvature,
            "internal_wrench": self._fill_wrench,
            "hydrodynamic_load": self._fill_load,
            "energy": self._fill_energy,
            "/tf": self._fill_transform,
        }

    def set_time(self, nanoseconds: int):
        """The simulation time [ns] of all messages, /clock's too."""
        self._time.sec, self._time.nanosec = divmod(nanoseconds, SECOND)

    def fill(self, name: str, snapshot):
        """The message of topic `name`, overwritten with `snapshot`."""
        self._fill[name](snapshot)
        return self.messages[name]

    def _buffers_of(self, message) -> dict[str, np.ndarray]:
        views = {}
        for field, kind in message.get_fields_and_field_types().items():
            if kind == "sequence<double>":
                count = {"position": 3, "orientation": 4}.get(field, 1) * len(self._x)
                setattr(message, field, array.array("d", bytes(8 * count)))
                views[field] = np.frombuffer(getattr(message, field), dtype=float)  # the message may have copied it
        if "x" in views:
            views["x"][:] = self._x
        return views

    def _fill_pose(self, snapshot):
        pose = self.messages["head_pose"].pose
        _set(pose.position, "xyz", turn_vector(snapshot.position))
        _set(pose.orientation, "xyzw", turn_quaternion(snapshot.orientation))

    def _fill_twist(self, snapshot):
        twist = self.messages["head_twist"].twist
        _set(twist.angular, "xyz", turn_vector(snapshot.twist[:3]))
        _set(twist.linear, "xyz", turn_vector(snapshot.twist[3:]))

    def _fill_odometry(self, snapshot):
        message = self.messages["odom"]
        _set(message.pose.pose.position, "xyz", turn_vector(snapshot.position))
        _set(message.pose.pose.orientation, "xyzw", turn_quaternion(snapshot.orientation))
        _set(message.twist.twist.angular, "xyz", turn_vector(snapshot.twist[:3]))
        _set(message.twist.twist.linear, "xyz", turn_vector(snapshot.twist[3:]))

    def _fill_transform(self, snapshot):
        _set(self.transform.transform.translation, "xyz", turn_vector(snapshot.position))
        _set(self.transform.transform.rotation, "xyzw", turn_quaternion(snapshot.orientation))

    def _fill_backbone(self, snapshot):
        views = self._views["backbone"]
        views["position"].reshape(-1, 3)[:] = turn_vector(snapshot.backbone) + 0.0
        views["orientation"].reshape(-1, 4)[:] = turn_quaternion(snapshot.section_orientation) + 0.0

    def _fill_curvature(self, snapshot):
        views = self._views["curvature"]
        views["pitch"][:], views["yaw"][:] = snapshot.curvature[:, 1], snapshot.curvature[:, 2]
        views["pitch_rate"][:], views["yaw_rate"][:] = snapshot.curvature_rate[:, 1], snapshot.curvature_rate[:, 2]

    def _fill_wrench(self, snapshot):
        views = self._views["internal_wrench"]
        for axis in range(3):
            views[f"torque_{axis + 1}"][:] = snapshot.torque[:, axis]
            views[f"force_{axis + 1}"][:] = snapshot.force[:, axis]

    def _fill_load(self, snapshot):
        views, message = self._views["hydrodynamic_load"], self.messages["hydrodynamic_load"]
        for axis in range(3):
            views[f"force_{axis + 1}"][:] = snapshot.fluid_force[:, axis]
            views[f"resistive_{axis + 1}"][:] = snapshot.resistive_force[:, axis]
        _set(message.tail_force, "xyz", snapshot.tail_force)
        _set(message.nose_force, "xyz", snapshot.nose_force)

    def _fill_energy(self, snapshot):
        message = self.messages["energy"]
        for name in ENERGY_FIELDS:
            setattr(message, name, float(getattr(snapshot.energy, name)))


ENERGY_FIELDS = tuple(name for name, kind in EnergyLedger.get_fields_and_field_types().items() if kind == "double")


def body_message(body, scene: Scene, x: np.ndarray, head_frame: str) -> BodyGeometry:
    """The body's outline at the stations `x` [m] and, graded towards the nose where it rounds off, in between."""
    message = BodyGeometry(length=float(body.length), mass=float((scene.density or body.density) * body.volume))
    message.header.frame_id = head_frame
    for name, values in outline(body, x).items():
        setattr(message, name, array.array("d", values.tolist()))
    return message


def opened_law(data: bytes) -> tuple[str, Callable[[], CurvatureLaw]]:
    """The name of a CurvatureLaw as it came over the network, and what makes the message of the rest.

    Making a message of 10^5 terms would hold the process up for a second, so that terms are counted before: ValueError
    of the second where there are too many. The layout is CDR's (RTPS 2.5, 10.5): 4 bytes that tell it, then header,
    name and number of terms, each number on a multiple of its size.
    """
    order = "<" if data[1:2] == b"\x01" else ">"

    def number(place: int) -> tuple[int, int]:
        place += -place % 4
        try:
            return struct.unpack_from(order + "I", data, 4 + place)[0], place + 4
        except struct.error:
            raise ValueError("it ends before its terms") from None

    def make() -> CurvatureLaw:
        if terms > MAXIMUM_TERMS:
            raise ValueError(f"terms must be at most {MAXIMUM_TERMS}, got {terms}")
        return deserialize_message(data, CurvatureLaw)

    size, place = number(8)  # after the stamp: frame_id
    size, place = number(place + size)  # name
    name = data[4 + place : 4 + place + size].rstrip(b"\0").decode(errors="replace")
    terms, _ = number(place + size)
    return name, make


def samples_from_message(message: CurvatureSamples) -> dict[str, np.ndarray | float]:
    """The arguments of `Simulation.add_samples`: time [s], x [m], curvatures and two time derivatives, section axes."""
    names = ("x", "pitch", "pitch_rate", "pitch_accel", "yaw", "yaw_rate", "yaw_accel")
    return {"time": seconds_of(message.header.stamp)} | {name: np.array(getattr(message, name)) for name in names}


def diagnostic_array(time: float, name: str, level: int, text: str, values: dict) -> DiagnosticArray:
    """One status of the node `name` at simulation time `time` [s], its values as text."""
    status = DiagnosticStatus(level=bytes([level]), name=name, message=text, hardware_id="simulation")
    status.values = [
        KeyValue(key=key, value=f"{value:.9g}" if isinstance(value, float) else str(value))
        for key, value in values.items()
    ]
    message = DiagnosticArray(status=[status])
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(round(time * SECOND), SECOND)
    return message


def descriptor_of(item: Field) -> ParameterDescriptor:
    """The ROS description of a parameter that a dataclass field declares."""
    metadata = item.metadata
    unit = f" [{metadata['unit']}]" if metadata.get("unit") else ""
    none = "; 0: not overridden" if item.default is None else ""
    descriptor = ParameterDescriptor(
        description=metadata["description"] + unit + none, read_only=not metadata.get("changeable")
    )
    if "choices" in metadata:
        descriptor.additional_constraints = "one of " + ", ".join(metadata["choices"])
    elif "minimum" in metadata:
        descriptor.additional_constraints = limits(metadata)
        low, high = metadata["minimum"], metadata.get("maximum")
        if isinstance(item.default, int):
            descriptor.integer_range = [IntegerRange(from_value=int(low), to_value=int(high))]
        else:
            descriptor.floating_point_range = [
                FloatingPointRange(from_value=float(low), to_value=float("inf") if high is None else float(high))
            ]
    return descriptor


def _set(target, names: str, values):
    """Sets the components of a geometry message to a row of numbers."""
    for name, value in zip(names, (values + 0.0).tolist(), strict=True):  # + 0.0: no minus zero
        setattr(target, name, value)
