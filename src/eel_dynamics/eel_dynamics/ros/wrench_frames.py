# SPDX-License-Identifier: Apache-2.0
"""The frames of external_wrench (geometry_msgs/WrenchStamped): sections that it acts on, with axes turned as base_link.

The head's frame is one. The parameter wrench_frames adds others, each as "NAME X", in the same namespace. Their
poses are on /tf.
"""

import math
import re

from eel_common.quantity import number
from eel_common.wording import shown

from eel_dynamics.model.wrenches.external_wrench import ExternalWrench
from eel_dynamics.ros.parameters import DynamicsParameters

Frames = dict[str, float]  # stations [m] by frame id
OTHERS = re.compile(r"(imu|pressure|velocity)(_\d+)?_link|section_\d+|link_\d+")  # of sensors, sections and the URDF


def wrench_frames(parameters: DynamicsParameters) -> Frames:
    """All frames by their ids. `ValueError` names an invalid entry of the parameter."""
    head = parameters.head_frame
    space, taken = head.rpartition("/")[0], (head, parameters.world_frame, parameters.root_frame)
    frames = {head: 0.0}
    for text in filter(None, parameters.wrench_frames):
        words = text.split()
        if len(words) != 2:
            raise ValueError(f"wrench_frames must each be NAME X, with X in m from the head, got {shown(text)}")
        frame = f"{space}/{words[0]}".lstrip("/")
        if frame in (*frames, *taken) or OTHERS.fullmatch(words[0]):
            raise ValueError(f"wrench_frames must have names of their own, got {shown(words[0])} again")
        try:
            station = float(words[1])
        except ValueError:
            station = math.nan
        frames[frame] = number(f"wrench_frames {words[0]}", station, "m", minimum=0.0)
    return frames


def stations_of(frames: Frames) -> tuple[ExternalWrench, ...]:
    """Zero wrenches at the stations of `frames`, so that panels end there from the start."""
    return tuple(ExternalWrench(station) for station in frames.values() if station > 0.0)
