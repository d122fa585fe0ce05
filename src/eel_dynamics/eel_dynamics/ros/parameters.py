# SPDX-License-Identifier: Apache-2.0
"""The dynamics node's parameters with default, unit, bounds and description.

The node declares its ROS parameters from these fields (and from `Scene`'s, as `scene.*`) and applies the user's
overrides. Poses and velocities are in ROS (REP-103) frames: world `odom`, head `base_link`. Where the node has a
namespace, the defaults of its frames begin with it.
"""

import math
from dataclasses import dataclass
from typing import Any

from eel_common.attitude import unit_quaternion
from eel_common.quantity import AT_RESET, Quantities, quantity
from eel_common.wording import shown

from eel_dynamics.accuracy.accuracy import STANDARD
from eel_dynamics.accuracy.step_bounds import MOST_EVALUATIONS
from eel_dynamics.analysis.joint_demand import MOST_JOINTS

FRAMES = ("world_frame", "head_frame", "section_frame")
NOW: dict[str, Any] = {"changeable": True}  # a change acts at once
LATER: dict[str, Any] = {"changeable": AT_RESET}
ROOT = "world"  # the frame that swimmers in namespaces share
MOST_FRAMES = 1000  # of sections on /tf


@dataclass(frozen=True, kw_only=True)
class DynamicsParameters(Quantities):
    """The node's parameters except the scene."""

    accuracy: str = quantity(
        STANDARD,
        "",
        "preset (draft, standard, fine, reference) or a target relative error of a run of that duration, or of 10 s",
        number=True,
        **LATER,
    )
    rate: float = quantity(100.0, "Hz", "samples published per simulated second", 0.0, 1e4, exclusive=True, **LATER)
    real_time_factor: float = quantity(
        1.0, "", "simulated seconds per second; 0: as fast as possible, fixed at start", 0.0, 1e6, **NOW
    )
    duration: float = quantity(0.0, "s", "simulated time after which the node ends with status 0; 0: no end", 0.0, 1e9)
    stations: int = quantity(51, "", "points along the backbone at which profiles are published", 2, 10_000, **LATER)
    most_evaluations: float = quantity(
        MOST_EVALUATIONS,
        "",
        "evaluations of the head's dynamics per simulated second; a law that needs more is refused, or stopped",
        0.0,
        exclusive=True,
    )
    estimate_error: bool = quantity(
        True, "", "measure the run's own error by a companion with coarser settings; shown in /diagnostics"
    )
    body: str = quantity(
        "boyer2010",
        "",
        "name of a body, a table or .npz file with columns x, half_width, half_height [m], or links with their "
        "numbers; changes follow as NAME=VALUE",
        **LATER,
    )
    flow: str = quantity(
        "",
        "",
        "flow of the water: a name with numbers (shear velocity=0.1,0,0 width=0.5), a .nc file of a grid, or several "
        "with ' + ' between; empty: none",
        **LATER,
    )
    robot: str = quantity(
        "",
        "",
        "name of a robot, or its .yaml or URDF file (URDF with joints=flush or a number); the robot's body is used "
        "unless body is set; its servos follow the law; empty: no robot, the law is imposed",
        **LATER,
    )
    command_interfaces: tuple[str, ...] = quantity(
        ("any",),
        "",
        "interfaces that joint_commands drive, of all joints or of each in turn: position, velocity, effort, several "
        "with spaces between, none, or any (whatever a message has)",
        **LATER,
    )
    command_timeout: float = quantity(
        0.5,
        "s",
        "simulated time after which a warning says that joint_commands have stopped and the last holds; 0: none",
        0.0,
        **NOW,
    )
    servo_torque_limit: float = quantity(
        0.0,
        "N m",
        "greatest torque of each servo of the robot, in place of its own limit, from the next sample on; 0: its own",
        0.0,
        **NOW,
    )
    fins: str = quantity(
        "",
        "",
        "fins: pair, left or right with numbers (pair station=0.5 area=0.0015 aspect_ratio=2.5 k_p=4 k_d=0.5 "
        "time_constant=0.05), several with ' + ' between; angle=commanded follows fin_command; empty: none",
        **LATER,
    )
    wrenches: str = quantity(
        "",
        "",
        "external wrenches: section or world with numbers (section station=0 force=2,0,0), several with ' + ' "
        "between; empty: none",
        **LATER,
    )
    wrench_frames: tuple[str, ...] = quantity(
        ("",),
        "",
        "frames of external_wrench besides head_frame: NAME X, with X in m from the head, axes turned as those of "
        "head_frame; on /tf too",
        **LATER,
    )
    default_transition: float = quantity(1.0, "s", "blending time of a law that names none", 0.0, 1e4, exclusive=True)
    initial_position: tuple[float, ...] = quantity(
        (0.0, 0.0, 0.0), "m", "of the head at the start, in the world frame", **LATER
    )
    initial_orientation: tuple[float, ...] = quantity(
        (0.0, 0.0, 0.0, 1.0), "", "of the head at the start, unit quaternion x y z w", **LATER
    )
    initial_linear_velocity: tuple[float, ...] = quantity(
        (0.0, 0.0, 0.0), "m/s", "of the head at the start, in the head frame", **LATER
    )
    initial_angular_velocity: tuple[float, ...] = quantity(
        (0.0, 0.0, 0.0), "rad/s", "of the head at the start, in the head frame", **LATER
    )
    world_frame: str = quantity("odom", "", "frame id of the world; by default below the namespace, as in eel1/odom")
    head_frame: str = quantity("base_link", "", "frame id of the head; by default below the namespace")
    section_frame: str = quantity(
        "section", "", "frame id of values in the axes of their own section; by default below the namespace"
    )
    root_frame: str = quantity(
        "",
        "",
        "frame id above world_frame, on /tf_static with publish_tf; empty: none; default in a namespace: world",
    )
    clock: bool = quantity(
        True, "", "publish /clock, unless another publisher of it is on the network, or follow_clock", **NOW
    )
    follow_clock: bool = quantity(
        False, "", "take the pace from the /clock of another node: each sample is due once /clock has come to its time"
    )
    clock_rate: float = quantity(
        0.0, "Hz", "messages on /clock per simulated second; 0: one with each sample", 0.0, 1e4, **LATER
    )
    publish_tf: bool = quantity(True, "", "publish world to head on /tf", **NOW)
    publish_tf_stations: bool = quantity(
        False,
        "",
        "publish a frame of section axes for each station too, as section_0, section_1, ... (see section_frame)",
    )
    publish_robot_description: bool = quantity(
        True,
        "",
        "publish the swimmer as a URDF on robot_description; off where another node publishes it there",
    )
    yaw_joints: int = quantity(
        0, "", "joints in yaw of a robot whose motors are on joint_states; 0: none", 0, MOST_JOINTS
    )
    pitch_joints: int = quantity(0, "", "joints in pitch, likewise", 0, MOST_JOINTS)
    torque_limit: float = quantity(
        0.0,
        "N m",
        "internal torque about any axis above which the greatest is reported, once a second of wall time; 0: none",
        0.0,
        **NOW,
    )
    wait_for_subscribers: int = quantity(
        0,
        "",
        "subscribers to wait for before the first sample; 0: at real_time_factor 0, those on the network",
        0,
        1000,
    )
    wait_for: tuple[str, ...] = quantity(
        ("",),
        "",
        "inputs that a run at real_time_factor 0 waits for: curvature_law, curvature_samples, joint_commands, "
        "fin_command, current, external_wrench; TOPIC/NAME for one joint, fin or frame; then a space and a period in "
        "s if it is not 1/rate; empty: inputs that have come once",
        **LATER,
    )
    subscriber_timeout: float = quantity(
        5.0,
        "s",
        "longest wait for a stuck subscriber, or for a silent input, at real_time_factor 0",
        0.0,
        3600.0,
        **NOW,
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in FRAMES:
            if not getattr(self, name):
                raise ValueError(f"{name} must not be empty")
            if getattr(self, name) == self.root_frame:
                raise ValueError(f"root_frame must be another frame than {name}, got {shown(self.root_frame)}")
        if self.robot and max(self.yaw_joints, self.pitch_joints) > 0:
            raise ValueError("yaw_joints and pitch_joints must be 0 with a robot, whose own joints are on joint_states")
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
