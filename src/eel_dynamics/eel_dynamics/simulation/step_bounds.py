"""Bounds of the steps in time: from the accuracy, the times of law and initial velocity, and the body."""

from eel_gaits.law import Law
from eel_gaits.wording import shown

import eel_core
from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.curvature.law_follower import LawFollower
from eel_dynamics.model.scene import Scene
from eel_dynamics.simulation.discretisation import Discretisation

LONGEST_STEP = 0.1  # of the shortest time over which the shape changes: works are integrals of what goes on within it
MOST_EVALUATIONS = 500_000.0  # by simulated second: seconds of wall time; the most exact runs need a tenth of it
SPARE_STEPS = 200_000.0  # beyond these, at any time of a run, with up to
SPARE_POINTS = 30.0  # points along the body; with more so many fewer, for a step costs as much more,
LEAST_SPARE = 6_000.0  # but not less than these
SLOWEST = 1e-3  # body lengths per time scale, below which the head counts as at rest
PART_OF_SPEED = 0.5  # of the speed that the shape gives the body: momenta below need not be exact to the last digit
PART_OF_SPAN = 0.25  # between two breakpoints of the shape, that a step may take
PART_OF_RAMP = 0.125  # the same for the ledger: of what a sudden ramp puts in, most comes back, and little may be left


EVALUATIONS = {"adams": 1, "dormand_prince": 6, "classical": 4}  # in a step: its last is the first of the next


def check_cost(law: Law, most_evaluations: float):
    """`ValueError` for a law of a period so short that `most_evaluations` by simulated second do not resolve it."""
    shortest = min((term.period for term in law.terms if term.period), default=None)
    if shortest is None:
        return
    needed = 1.0 / (LONGEST_STEP * shortest)
    if needed > most_evaluations:
        raise ValueError(
            f"law {shown(law.name)} has a period of {shortest:g} s, which takes {needed:.3g} evaluations per simulated "
            f"second or more: most_evaluations is {most_evaluations:.3g}"
        )


def step_bounds_of(
    *,
    accuracy: Accuracy,
    scene: Scene,
    follower: LawFollower,
    discretisation: Discretisation,
    length: float,
    scale: float,
    most_evaluations: float,
) -> eel_core.StepBounds:
    """The bounds for a body of `length` [m] on its `discretisation`, whose initial velocity has the time `scale` [s],
    under the law of the `follower`; `most_evaluations` by simulated second."""
    scale = min(follower.time_scale, scale)
    longest = LONGEST_STEP * min(scale, 10.0)
    fixed = accuracy.step or (accuracy.fixed and min(scale, 1.0) / accuracy.fixed)
    slowest = max(SLOWEST * length / min(scale, 10.0), PART_OF_SPEED * follower.speed(length))
    return eel_core.StepBounds(
        tolerance=accuracy.tolerance,
        longest=fixed or longest,
        smallest=1e-11 * min(scale, 1.0),
        length=length,
        momentum_floor=discretisation.mass * slowest,
        part_of_span=PART_OF_RAMP if scene.ledger and not follower.between_samples else PART_OF_SPAN,
        most_steps=most_evaluations / EVALUATIONS[accuracy.method],
        spare_steps=max(LEAST_SPARE, SPARE_STEPS * min(1.0, SPARE_POINTS / len(discretisation.grid.x))),
    )
