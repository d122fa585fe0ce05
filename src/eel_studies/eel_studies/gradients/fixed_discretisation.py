# SPDX-License-Identifier: Apache-2.0
"""The same grid and the same sequence of steps for neighbouring swims, so that only the swims differ.

Steps of fixed length end on the breakpoints of the law's ramps. The step is chosen so that each span between two
breakpoints has the same number of steps in all swims. A parameter that moves a ramp then stretches its steps.
"""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
from eel_dynamics.accuracy.accuracy import FIXED, Accuracy
from eel_dynamics.accuracy.law_waves import check_law
from eel_dynamics.model.initial_state import time_scale

from eel_dynamics import Swim

SHORTER = 0.002  # relative decrease from one trial step to the next
TRIALS = 500


def fixed_steps(accuracy: "str | float | Accuracy") -> Accuracy:
    """Settings with fixed steps for the target of `accuracy`. `ValueError` for settings without fixed steps."""
    settings = Accuracy.of(accuracy)
    if settings.step is not None or settings.fixed is not None:
        return settings
    if settings.target is None:
        raise ValueError(
            f"accuracy of a gradient must be a target, or settings with fixed steps, got {settings.name!r}"
        )
    return Accuracy.of(f"{settings.name}, {FIXED}")


def step_of(point: Swim) -> float:
    """The length [s] of the fixed steps of the `point`, from the accuracy of its scene."""
    settings: Accuracy = point.accuracy
    if settings.step is not None:
        return settings.step
    period = min((term.period for term in point.law.waves), default=np.inf)
    flow = time_scale(point.start.in_water(np.array(point.scene.current)), point.body.length)
    assert settings.fixed is not None
    return float(min(period, flow, 1.0) / settings.fixed)


def on_one_grid(points: list[Swim], step: float) -> list[Swim]:
    """The `points` with the grid that the first one needs, and the same number of steps, of `step` [s] or less."""
    law, body, flow, accuracy = points[0].law, points[0].body, points[0].flow, points[0].accuracy
    of_flow = 0.0 if flow is None else body.length / flow.traits.shortest_wave
    waves = max(1.0, check_law(law, body.length), of_flow)
    step = common_step([breakpoints_of(point) for point in points], step)
    accuracy = replace(accuracy, waves=waves, step=step, fixed=None, target=None)
    return [point.changed(accuracy=accuracy) for point in points]


def breakpoints_of(point: Swim) -> list[float]:
    """Times [s] from the start at which a derivative of the law's curvature jumps, ascending."""
    ends = {time for term in point.law.terms for ramp in term.envelope for time in (ramp.start, ramp.end) if time > 0.0}
    return [0.0, *sorted(ends)]


def common_step(breakpoints: list[list[float]], step: float) -> float:
    """The longest step [s], up to `step`, that gives all swims as many steps in each span; otherwise `step`."""
    for trial in range(TRIALS):
        length = step * (1.0 - SHORTER * trial)
        if len({tuple(_counts(times, length)) for times in breakpoints}) == 1:
            return length
    return step


def _counts(times: list[float], step: float) -> list[int]:
    return [math.ceil((end - start) / step - 1e-9) for start, end in pairwise(times)]
