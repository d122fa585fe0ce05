# SPDX-License-Identifier: Apache-2.0
"""The parameters of the node `pilot`: the goal, which may change, the timing, and the numbers of the pilot."""

import math
from dataclasses import dataclass

from eel_base.quantity import Quantities, quantity

from eel_gaits.pilot.settings import PilotSettings


@dataclass(frozen=True, kw_only=True)
class GoalParameters(Quantities):
    """What may change while the node runs."""

    heading: float = quantity(0.0, "rad", "heading to hold; positive: left", -1e3, 1e3, changeable=True)
    depth: float = quantity(0.0, "m", "depth to hold, below z = 0", -1e5, 1e5, changeable=True)
    speed: float = quantity(0.5, "m/s", "speed over ground, of every goal", 1e-3, 1e2, changeable=True)
    torque_limit: float = quantity(
        0.0,
        "N m",
        "internal torque above which the pilot slows down, from swim_state; 0: none",
        0.0,
        math.inf,
        changeable=True,
    )


@dataclass(frozen=True, kw_only=True)
class TimingParameters(Quantities):
    """When the pilot sends what."""

    sample_period: float = quantity(0.02, "s", "time from one sample of the curvature to the next", 1e-3, 0.2)
    lead: float = quantity(
        0.05, "s", "time by which samples are sent ahead of odom; at least a sample_period", 1e-3, 1.0
    )


GROUPS = (GoalParameters, TimingParameters, PilotSettings)
