# SPDX-License-Identifier: Apache-2.0
"""The parameters of the node `pilot`: the goal, which may change, the timing, and the numbers of the pilot."""

import math
from dataclasses import dataclass
from typing import Any

from eel_base.quantity import Quantities, quantity

from eel_gaits.pilot.settings import PilotSettings


@dataclass(frozen=True, kw_only=True)
class GoalParameters(Quantities):
    """What may change while the node runs."""

    heading: float = quantity(0.0, unit="rad", description="heading to hold; positive: left", minimum=-1e3, maximum=1e3)
    depth: float = quantity(0.0, unit="m", description="depth to hold, below z = 0", minimum=-1e5, maximum=1e5)
    speed: float = quantity(0.5, unit="m/s", description="speed over ground, of every goal", minimum=1e-3, maximum=1e2)
    torque_limit: float = quantity(
        0.0,
        unit="N m",
        description="internal torque above which the pilot slows down, from swim_state; 0: none",
        minimum=0.0,
        maximum=math.inf,
    )


@dataclass(frozen=True, kw_only=True)
class TimingParameters(Quantities):
    """When the pilot sends what."""

    sample_period: float = quantity(
        0.02, unit="s", description="time from one sample of the curvature to the next", minimum=1e-3, maximum=0.2
    )
    lead: float = quantity(
        0.05,
        unit="s",
        description="time by which samples are sent ahead of odom; at least a sample_period",
        minimum=1e-3,
        maximum=1.0,
    )


GROUPS: dict[type[Any], bool] = {  # whether it may change
    GoalParameters: True,
    TimingParameters: False,
    PilotSettings: False,
}
