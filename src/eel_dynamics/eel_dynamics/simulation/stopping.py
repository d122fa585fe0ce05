# SPDX-License-Identifier: Apache-2.0
"""The reasons why a march could not continue, and what to change."""

from typing import Any

import numpy as np
from eel_base.wording import WorkStopped, shown
from eel_gaits.laws.law import Law
from eel_gaits.sources.sampled_law import SampledLaw

import eel_core
from eel_dynamics.accuracy.accuracy import Accuracy


class SimulationStopped(WorkStopped):
    """The march could not continue. `quantity` failed with `value` at `time` [s]. `hint` says what to change."""

    def __init__(self, time: float, quantity: str, value: float, hint: str):
        super().__init__(f"stopped at t = {time:.6g} s: {quantity} ({value:.3g}); {hint}")
        self.time, self.quantity, self.value, self.hint = time, quantity, value, hint
        self.diverged = False  # the steps were too long
        self.run: Any  # the Run up to there, where one was asked for

    def __reduce__(self) -> tuple[Any, ...]:
        return SimulationStopped, (self.time, self.quantity, self.value, self.hint), self.__dict__


def stopped_by(status: int, time: float, bounds: eel_core.StepBounds, accuracy: Accuracy) -> SimulationStopped:
    """The error for the `status` of a march that stopped at `time` [s].

    bounds, accuracy: the bounds of its steps, and its settings.
    """
    if eel_core.STATUSES[status] == "singular":
        quantity, value = "inertia of body and water is not positive definite", np.nan
        return SimulationStopped(time, quantity, value, "check the body's section data")
    if eel_core.STATUSES[status] == "not_finite":
        stopped = SimulationStopped(time, "momentum is not finite", np.nan, remedy(accuracy))
        stopped.diverged = True
        return stopped
    if eel_core.STATUSES[status] == "too_many_steps":
        quantity = "more steps per simulated second than most_evaluations allows"
        hint = "take a coarser accuracy, a slower or gentler law, or raise most_evaluations"
        return SimulationStopped(time, quantity, bounds.most_steps, hint)
    quantity = "step for the wanted accuracy is too small"
    return SimulationStopped(time, quantity, bounds.smallest, "take a coarser accuracy, or a slower law")


def left_grid(time: float, place: list[float], axis: str, value: float) -> SimulationStopped:
    """The error at `time` [s] for a swimmer with a point at a `place` [m] where the flow is not known.

    axis, value: as `Flow.outside` gives them.
    """
    x, y, z = place
    quantity = f"the swimmer has left the grid of the flow at ({x:.4g}, {y:.4g}, {z:.4g}) m, beyond {axis}"
    return SimulationStopped(time, quantity, value, "give a larger grid, or a shorter run")


def remedy(accuracy: Accuracy) -> str:
    """What to change where the numbers of a run have diverged."""
    if accuracy.step is not None:
        return "take a smaller step, or an accuracy in its place"
    if accuracy.fixed is not None:
        return "take the accuracy without fixed steps, or a gentler law"
    return "take a gentler law, or start slower"


def not_begun(law: Law | SampledLaw, stopped: SimulationStopped) -> ValueError:
    """The error for a swim by `law` that cannot begin, with the quantity that `stopped` it."""
    return ValueError(f"law {shown(law.name)} cannot be begun: {stopped.quantity}")
