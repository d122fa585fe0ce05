# SPDX-License-Identifier: Apache-2.0
"""The motion of a simulation's head, as on the topic `odom`.

So a controller or a policy that works here drives the dynamics node too.
"""

import math

from eel_gaits.pilot.head_motion import HeadMotion
from eel_model.initial_state import InitialState


def head_motion_of(head: InitialState) -> HeadMotion:
    """The motion of a simulation's `head`."""
    return HeadMotion(head.position, head.orientation, head.twist[:3], head.twist[3:])


def level_orientation(heading: float) -> tuple[float, float, float, float]:
    """The orientation (x, y, z, w) of a level head with this `heading` [rad]."""
    return 0.0, 0.0, math.sin(0.5 * heading), math.cos(0.5 * heading)
