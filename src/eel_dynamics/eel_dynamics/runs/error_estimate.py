"""Estimates the discretisation error of a run from a finer run, and finds a stable step.

The errors are those of the accuracy targets: of the head's position at the end, relative to the length of its path (or
of the body, if longer), and of the torque at samples and stations, relative to its maximum. The finer run's errors are
some ten times smaller, so the difference is the error to about ten per cent. It costs about twice the run.
"""

from dataclasses import dataclass, replace
from functools import partial
from sys import float_info

import numpy as np

from eel_dynamics.accuracy.accuracy import FINEST_TOLERANCE
from eel_dynamics.simulation.stopping import SimulationStopped

MORE_STEPS = 1.4  # ratio of steps that a finer run must have: coarse tolerances may leave the steps at their bound
MOST_FINER = 3  # attempts to get that many steps
HALVINGS = 8  # of an unstable step, at most, in the search for a stable one


@dataclass(frozen=True)
class ErrorEstimate:
    """Relative errors of position and torque; `torque` is None for a run without internal wrench."""

    position: float
    torque: float | None

    @property
    def worst(self) -> float:
        """The greater of the two."""
        return max(self.position, self.torque or 0.0)


def relative_errors(run, reference) -> ErrorEstimate:
    """Errors of `run` relative to `reference`, a run of the same swimmer with the same samples and stations."""
    scale = max(reference.path_length, reference.body.length)
    position = float(np.linalg.norm(run.position[-1] - reference.position[-1])) / scale
    if run.torque is None or reference.torque is None:
        return ErrorEstimate(position, None)
    size = np.linalg.norm(reference.torque, axis=2).max()
    difference = np.linalg.norm(run.torque - reference.torque, axis=2).max()
    return ErrorEstimate(position, float(difference / size) if size > 0.0 else 0.0)


def refined(run, simulate):
    """The same run, by `simulate`, with a finer grid and shorter steps."""
    period = float(run.time[1] - run.time[0]) if len(run.time) > 1 else 1.0
    again = partial(
        simulate,
        run.law,
        float(run.time[-1]),
        body=run.body,
        scene=run.scene,
        sample_period=period,
        stations=run.x,
        position=run.position[0],
        orientation=run.orientation[0] / np.linalg.norm(run.orientation[0]),
        twist=run.twist[0],
        load=run.fluid_force is not None,
        verify=False,
        most_evaluations=float_info.max,  # the run itself was within its limit
    )
    accuracy = run.accuracy.finer()
    finer = again(accuracy=accuracy)
    for _ in range(MOST_FINER):
        if finer.steps >= MORE_STEPS * run.steps or accuracy.tolerance <= FINEST_TOLERANCE:
            break
        accuracy = replace(accuracy, tolerance=accuracy.finer().tolerance)
        finer = again(accuracy=accuracy)
    return finer


def stable_step(swim, accuracy) -> float | None:
    """The longest step [s], by halving that of `accuracy`, at which `swim(accuracy)` does not stop; None if none is."""
    step = accuracy.step
    for _ in range(HALVINGS):
        step *= 0.5
        try:
            swim(replace(accuracy, step=step))
        except SimulationStopped:
            continue
        return step
    return None
