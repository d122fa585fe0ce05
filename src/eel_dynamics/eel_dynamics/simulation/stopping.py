# SPDX-License-Identifier: Apache-2.0
"""The reasons why a march could not continue, the remedies, and the first sample of a run that cannot be returned.

Too long a fixed step does not fail by itself: the motion grows, but every number stays finite. The ledger (eq.
60 times the head's twist) shows the error: the energy gains more than the integral of the powers. If this
excess exceeds a share of all energy that was present or passed, the motion is wrong. A motion below `floor` is
too small on the body's scale to need smaller steps, and is accepted: its error is relative to the body's length.
"""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from eel_common.wording import WorkStopped, shown

import eel_core
from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.model.flow.flow import Flow
from eel_dynamics.model.robot.compiled import ModeTable

OPEN = 0.2  # share of the energy; at twice the longest useful step of the robot's gaits it is 0.03, then grows at once


class SimulationStopped(WorkStopped):
    """The march could not continue. `quantity` failed with `value` at `time` [s]. `hint` tells what to change."""

    def __init__(self, time: float, quantity: str, value: float, hint: str):
        super().__init__(f"stopped at t = {time:.6g} s: {quantity} ({value:.3g}); {hint}")
        self.time, self.quantity, self.value, self.hint = time, quantity, value, hint
        self.diverged = False  # the steps were too long
        self.run: Any  # the Run up to there, if one was requested

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


def stopped_in_flow(flow: Flow | None, core: eel_core.March, time: float) -> SimulationStopped | None:
    """The error at `time` [s] outside the known `flow` or above its surface; else None."""
    if core.outside is not None:
        return left_grid(flow, core.outside)
    if flow is not None and core.state[2] > flow.traits.surface_height:
        what = "the head is above the surface of the flow, z"
        return SimulationStopped(time, what, core.state[2], "dive deeper")
    return None


def left_grid(flow: Flow | None, where: Sequence[float]) -> SimulationStopped:
    """The error for a swimmer with a point at `where`, a time [s] and a place [m] outside the known `flow`."""
    time, x, y, z = map(float, where)
    axis, value = (flow and flow.outside(time, (x, y, z))) or ("", np.nan)
    quantity = f"the swimmer has left the grid of the flow at ({x:.4g}, {y:.4g}, {z:.4g}) m, beyond {axis}"
    return SimulationStopped(time, quantity, value, "give a larger grid, or a shorter run")


def outside_flow(flow: Flow | None, time: float, places: np.ndarray) -> SimulationStopped | None:
    """The error for the first of `places` (M, 3) [m] where the `flow` is not known at `time` [s]; else None."""
    found = (place for place in places if flow is not None and flow.outside(time, place))
    place = next(found, None)
    return None if place is None else left_grid(flow, (time, *place))


def by_part(stopped: SimulationStopped, core: eel_core.March, table: ModeTable, singular: bool) -> SimulationStopped:
    """The error of a robot with the modes of `table`, with the responsible part. singular: whether the inertia is."""
    part = shown(table.name[core.to_blame(singular)])
    if singular:
        hint = f"{part} has no inertia of its own: give it an armature, or a support apart from the others"
    else:
        hint = f"{part} asks for the shortest steps: give it damping or an armature; or {stopped.hint}"
    return SimulationStopped(stopped.time, stopped.quantity, stopped.value, hint)


def remedy(accuracy: Accuracy) -> str:
    """What to change after a run has diverged."""
    if accuracy.step is not None:
        return "take a smaller step, or an accuracy in its place"
    if accuracy.fixed is not None:
        return "take the accuracy without fixed steps, or a gentler law"
    return "take a gentler law, or start slower"


def first_bad_sample(
    out: Any, works: np.ndarray, done: int, start: float, floor: float, robot: np.ndarray | None = None
) -> tuple[int, str, float] | None:
    """The first bad sample of the first `done` ones: its index, the quantity and its value. None if all are good.

    out: `Observations`. works (T, 8) [J]. start [J]: the energy at the start. floor [J]: energy that counts as
    none; where it is infinite, the ledger is not checked. robot (T, 3): as in `EnergyLedger.of`.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        failures = []
        if not math.isfinite(np.add.reduce(out.whole) + np.add.reduce(works, axis=None)):
            arrays = out.arrays() | {"works": works}
            failures = [_not_finite(name, array[:done]) for name, array in arrays.items()]
        if done and np.isfinite(floor):
            energies, works = out.energies[:done], works[:done]
            if robot is not None:
                energies = np.column_stack((energies, robot[:done, 0]))
                works = np.column_stack((works, robot[:done, 2]))
            failures.append(_open(energies, works, start, floor))
    return min((each for each in failures if each), default=None, key=lambda each: each[0])


def _not_finite(name: str, array: np.ndarray) -> tuple[int, str, float] | None:
    if not array.size or np.isfinite(np.add.reduce(array, axis=None)):
        return None
    bad = ~np.isfinite(array.reshape(len(array), -1))
    if not bad.any():
        return None  # the sum alone was too large
    sample = int(np.argmax(bad.any(axis=1)))
    value = float(array[sample].ravel()[np.argmax(bad[sample])])
    return sample, f"{name.replace('_', ' ')} is not finite", value


def _open(energies: np.ndarray, works: np.ndarray, start: float, floor: float) -> tuple[int, str, float] | None:
    residual = np.abs(energies.sum(axis=1) - start - works.sum(axis=1))
    there = np.maximum(np.abs(energies).sum(axis=1) + np.abs(works).sum(axis=1), start)
    passed = np.maximum.accumulate(there) + floor
    bad = residual > OPEN * passed
    if not bad.any():
        return None
    sample = int(np.argmax(bad))
    return sample, "energy from nowhere, as a share of all that passed", float(residual[sample] / passed[sample])
