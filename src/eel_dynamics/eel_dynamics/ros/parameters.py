# SPDX-License-Identifier: Apache-2.0
"""The dynamics node's parameters with default, unit, bounds and description.

The node declares its ROS parameters from these fields (and from `Scene`'s, as `scene.*`) and applies the user's
overrides. Poses and velocities are in ROS (REP-103) frames: world `odom`, head `base_link`. Where the node has a
namespace, the defaults of its frames begin with it.
"""

import math
from dataclasses import dataclass, field, fields

from eel_base.attitude import unit_quaternion
from eel_base.quantity import checked
from eel_base.wording import shown
from eel_ros.parameters import AT_RESET

from eel_dynamics.accuracy.step_bounds import MOST_EVALUATIONS
from eel_dynamics.analysis.actuators import MOST_JOINTS

FRAMES = ("world_frame", "head_frame", "section_frame")
ROOT = "world"  # the frame that swimmers in namespaces share
MOST_FRAMES = 1000  # of sections on /tf


def _parameter(default, description, unit="", **bounds):
    return field(default=default, metadata={"description": description, "unit": unit, **bounds})


@dataclass(frozen=True, kw_only=True)
class DynamicsParameters:
    """The node's parameters except the scene. Made by `from_values`, which checks each value.

    Metadata of a field: unit, description; minimum, maximum, exclusive (the minimum itself is refused), choices,
    number (a text or a number), changeable (at run time: True, or AT_RESET).
    """

    accuracy: str = _parameter(
        "standard",
        "preset (draft, standard, fine, reference) or a target relative error of a run of that duration, or of 10 s",
        number=True,
        changeable=AT_RESET,
    )
    rate: float = _parameter(
        100.0,
        "samples published per simulated second",
        "Hz",
        minimum=0.0,
        exclusive=True,
        maximum=1e4,
        changeable=AT_RESET,
    )
    real_time_factor: float = _parameter(
        1.0,
        "simulated seconds per second; 0: as fast as possible, fixed at start",
        minimum=0.0,
        maximum=1e6,
        changeable=True,
    )
    duration: float = _parameter(
        0.0, "simulated time after which the node ends with status 0; 0: no end", "s", minimum=0.0, maximum=1e9
    )
    stations: int = _parameter(
        51, "points along the backbone at which profiles are published", minimum=2, maximum=10_000, changeable=AT_RESET
    )
    most_evaluations: float = _parameter(
        MOST_EVALUATIONS,
        "evaluations of the head's dynamics per simulated second; a law that needs more is refused, or stopped",
        minimum=0.0,
        exclusive=True,
    )
    estimate_error: bool = _parameter(
        True, "measure the run's own error by a companion with coarser settings; shown in /diagnostics"
    )
    body: str = _parameter(
        "boyer2010",
        "name of a body, or a .csv or .npz file with columns x, half_width, half_height [m]",
        changeable=AT_RESET,
    )
    default_transition: float = _parameter(
        1.0, "blending time of a law that names none", "s", minimum=0.0, exclusive=True, maximum=1e4
    )
    initial_position: tuple = _parameter(
        (0.0, 0.0, 0.0), "of the head at the start, in the world frame", "m", changeable=AT_RESET
    )
    initial_orientation: tuple = _parameter(
        (0.0, 0.0, 0.0, 1.0), "of the head at the start, unit quaternion x y z w", changeable=AT_RESET
    )
    initial_linear_velocity: tuple = _parameter(
        (0.0, 0.0, 0.0), "of the head at the start, in the head frame", "m/s", changeable=AT_RESET
    )
    initial_angular_velocity: tuple = _parameter(
        (0.0, 0.0, 0.0), "of the head at the start, in the head frame", "rad/s", changeable=AT_RESET
    )
    world_frame: str = _parameter("odom", "frame id of the world; by default below the namespace, as in eel1/odom")
    head_frame: str = _parameter("base_link", "frame id of the head; by default below the namespace")
    section_frame: str = _parameter(
        "section", "frame id of values in the axes of their own section; by default below the namespace"
    )
    root_frame: str = _parameter(
        "",
        "frame id above world_frame, on /tf_static with publish_tf; empty: none; by default world below a namespace",
    )
    clock: bool = _parameter(
        True, "publish /clock, unless another publisher of it is on the network, or follow_clock", changeable=True
    )
    follow_clock: bool = _parameter(
        False, "take the pace from the /clock of another node: each sample is due once /clock has come to its time"
    )
    clock_rate: float = _parameter(
        0.0,
        "messages on /clock per simulated second; 0: one with each sample",
        "Hz",
        minimum=0.0,
        maximum=1e4,
        changeable=AT_RESET,
    )
    publish_tf: bool = _parameter(True, "publish world to head on /tf", changeable=True)
    publish_tf_stations: bool = _parameter(
        False, "publish a frame of section axes for each station too, as section_0, section_1, ... (see section_frame)"
    )
    yaw_joints: int = _parameter(
        0, "joints in yaw of a robot whose motors are on joint_states; 0: none", minimum=0, maximum=MOST_JOINTS
    )
    pitch_joints: int = _parameter(0, "joints in pitch, likewise", minimum=0, maximum=MOST_JOINTS)
    torque_limit: float = _parameter(
        0.0,
        "internal torque about any axis above which the greatest is reported, once a second of wall time; 0: none",
        "N m",
        minimum=0.0,
        changeable=True,
    )
    wait_for_subscribers: int = _parameter(
        0,
        "subscribers to wait for before the first sample; 0: at real_time_factor 0, those on the network",
        minimum=0,
        maximum=1000,
    )
    subscriber_timeout: float = _parameter(
        5.0,
        "longest wait for a stuck subscriber or a silent controller, at real_time_factor 0",
        "s",
        minimum=0.0,
        maximum=3600.0,
        changeable=True,
    )

    def __post_init__(self):
        for name in FRAMES:
            if not getattr(self, name):
                raise ValueError(f"{name} must not be empty")
            if getattr(self, name) == self.root_frame:
                raise ValueError(f"root_frame must be another frame than {name}, got {shown(self.root_frame)}")
        if max(self.yaw_joints, self.pitch_joints) > 0 and self.stations < 4:
            raise ValueError(f"stations must be 4 or more where there are joints, got {self.stations}")
        if self.publish_tf_stations and self.stations > MOST_FRAMES:
            most = f"at most {MOST_FRAMES} with publish_tf_stations"
            raise ValueError(f"stations must be {most}, got {self.stations}")
        orientation = unit_quaternion("initial_orientation", self.initial_orientation)
        object.__setattr__(self, "initial_orientation", orientation)

    @property
    def makes_clock(self) -> bool:
        """Whether the node is to publish /clock."""
        return self.clock and not self.follow_clock

    @property
    def last_sample(self) -> float:
        """Index of the last sample: samples k = 0 ... N at k/rate; infinite without a duration."""
        return math.floor(self.duration * self.rate + 1e-9) if self.duration > 0.0 else math.inf


def from_values(kind, values: dict, prefix: str = ""):
    """An instance of the dataclass `kind` from its fields' `values`, checked; names in errors begin with `prefix`."""
    return kind(**{item.name: checked(item, values[item.name], prefix + item.name) for item in fields(kind)})
