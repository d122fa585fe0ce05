# SPDX-License-Identifier: Apache-2.0
"""Bounds of the time step. They follow from the accuracy, the law, the initial velocity and the body.

Within them the core chooses each step by its error: `time_step_size` in eel_core/steppers/step_control.hpp.
"""

import math
from typing import Any

import eel_core
from eel_dynamics.accuracy.accuracy import LONGEST_STEP
from eel_dynamics.accuracy.error_estimate import floors

# Most evaluations of a run per simulated second. They take seconds of wall time. The most exact runs need
# a tenth of them.
MOST_EVALUATIONS = 500_000.0
# Steps that a run may take beyond that limit, at any time, on a body of at most SPARE_POINTS points.
SPARE_STEPS = 200_000.0
# With more points than these along the body, the spare steps decrease as the cost of a step increases.
SPARE_POINTS = 30.0
# Least number of spare steps of a run.
LEAST_SPARE = 6_000.0
# The head counts as at rest below this speed, in body lengths per time scale.
SLOWEST = 1e-3
# Momenta below this part of the speed that the law gives to the body need not be exact to the last digit.
PART_OF_SPEED = 0.5
# A step takes at most this part of the time between two breakpoints of the shape, if longest_step is LONGEST_STEP.
# Between two samples only the error sets the step: a controller's samples are close together on the motion's scale.
PART_OF_SPAN = 0.25
# This part holds instead with a ledger. Most of the energy that a sudden ramp puts in comes back, and little
# may be left over.
PART_OF_RAMP = 0.125
# Evaluations per step: its last one is the first of the next.
EVALUATIONS = {"adams": 1, "dormand_prince": 6, "classical": 4, "rosenbrock": 4}


def check_cost(what: str, scale: float, most_evaluations: float) -> None:
    """`ValueError` if the time `scale` [s] of `what` is too short for `most_evaluations` per simulated second."""
    needed = 1.0 / (LONGEST_STEP * scale)
    if needed > most_evaluations:
        raise ValueError(
            f"{what} {scale:g} s, which takes {needed:.3g} evaluations per simulated second or more: most_evaluations "
            f"is {most_evaluations:.3g}"
        )


def step_bounds_of(
    swimmer: Any, here: Any, between_samples: bool, law_scale: float, speed: float = 0.0
) -> eel_core.StepBounds:
    """The bounds of the steps of a swimmer with this `Swimmer` on the grid of `here`, a `Discretisation`.

    between_samples: whether the curvature is a quintic between two samples. law_scale: [s], the shortest time scale of
    the law and the initial velocity. speed: [m/s], of the body under the law.
    """
    accuracy, length, mass = swimmer.settings, swimmer.body.length, here.mass
    scale = min(law_scale, here.weight_time, swimmer.time_scale_of_surroundings)
    longest = min(accuracy.longest_step * min(scale, 10.0), swimmer.longest_step)
    fixed = accuracy.step or (accuracy.fixed and min(min(scale, 1.0) / accuracy.fixed, swimmer.longest_step))
    part_of_span = PART_OF_RAMP if swimmer.scene.ledger else PART_OF_SPAN
    sudden = not between_samples or swimmer.sudden_changes
    slowest = max(SLOWEST * length / min(scale, 10.0), PART_OF_SPEED * speed)
    return eel_core.StepBounds(
        tolerance=math.inf if accuracy.method == "classical" else accuracy.tolerance,  # infinite: fixed steps
        longest=fixed or longest,
        smallest=1e-11 * min(scale, 1.0),
        length=length,
        momentum_floor=mass * slowest,
        part_of_span=min(1.0, part_of_span * accuracy.longest_step / LONGEST_STEP) if sudden else 1.0,
        most_steps=swimmer.most_evaluations / EVALUATIONS[accuracy.method],
        spare_steps=max(LEAST_SPARE, SPARE_STEPS * min(1.0, SPARE_POINTS / len(here.grid.x))),
        torque_floor=floors(mass, length, min(law_scale, 1.0)).torque,
    )
