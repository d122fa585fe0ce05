# SPDX-License-Identifier: Apache-2.0
"""The model's prediction of each measurement, and its derivatives with respect to the unknowns.

The unknowns are the parameters, then for each path the placement of the laboratory's axes: a displacement (D,) and a
turn about the vertical, r_measured = R(turn) r + displacement. Placements need no further swims.
"""

import warnings
from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from eel_dynamics import Run, Swim
from eel_gaits import Law
from eel_studies.gradients.gradient import gradient
from eel_studies.identification.measurements import MeasuredAngles, MeasuredPath, MeasuredSpeed
from eel_studies.points import Gait, Numbers, law_of_terms, point_at
from eel_studies.steady_swim import at_speed, swim_times

PERIODS = 12  # of a swim at a measured speed
SAMPLES = 40  # per period of a path: a cubic spline through them is exact to a millionth of the amplitude
LONGEST_SAMPLE = 0.05  # s
SPEED = "mean_speed"


class Predicted(NamedTuple):
    """For one measurement: the prediction (T, D), its derivatives (T, D, P) by the parameters, and the run."""

    value: np.ndarray
    derivative: np.ndarray
    run: Run


class Swims(NamedTuple):
    """Simulates the measured swims. The fields are arguments of `gradient`."""

    gait: Gait
    numbers: Numbers
    base: Swim
    threads: int | None

    def predicted(self, measured: Any, at: dict[str, float]) -> Predicted:
        """The prediction of `measured` with the parameters `at`: positions in its axes, angles, or a speed."""
        numbers, steady = {**self.numbers, **measured.numbers}, isinstance(measured, MeasuredSpeed)
        numbers = at_speed(numbers, measured.speed) if steady else numbers
        law = point_at(at, self.gait, numbers, self.base).law
        times = swim_times(law, self.base.body.length, PERIODS) if steady else path_times(measured, law)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the jump of the printed friction: it is in the derivatives' error
            found = gradient(
                SPEED if steady else values_at(measured),
                at,
                gait=self.gait,
                numbers=numbers,
                body=self.base.body,
                robot=self.base.robot,
                scene=replace(self.base.scene, internal_wrench=False, ledger=False),
                accuracy=self.base.accuracy,
                stations=np.array([measured.station]) if isinstance(measured, MeasuredPath) else 2,
                estimate=False,
                threads=self.threads,
                **times,
            )
        shape = measured.values.shape
        return Predicted(found.value.reshape(shape), found.derivative.reshape(*shape, -1), found.run)


def path_times(path: MeasuredPath | MeasuredAngles, law: Law) -> dict[str, Any]:
    """Duration and sample period [s] of the swim of a `path`, or of angles. `ValueError` for a law without terms."""
    shortest = min((term.period for term in law_of_terms(law).terms if term.period), default=np.inf)
    duration = float(path.time[-1])
    count = np.ceil(duration / min(LONGEST_SAMPLE, shortest / SAMPLES))
    return {"duration": duration, "sample_period": duration / max(4.0, count)}


def values_at(measured: MeasuredPath | MeasuredAngles) -> Callable[[Run], dict[str, float]]:
    """A measure: positions of the tracked point, or joint angles, (T, D) at the times of `measured`, flattened."""
    from scipy.interpolate import CubicSpline

    def values(run: Run) -> dict[str, float]:
        rows = run.joint_angle if isinstance(measured, MeasuredAngles) else run.backbone[:, 0]
        found = CubicSpline(run.time, rows)(measured.time)[:, : measured.values.shape[1]]
        return {str(index): value for index, value in enumerate(found.ravel().tolist())}

    return values


def placement_of(path: MeasuredPath, positions: np.ndarray) -> np.ndarray:
    """The displacement (D,) and the turn that fit `positions` (T, D) best to the measured ones, (D + 1,)."""
    ours, theirs = positions - positions.mean(axis=0), path.position - path.position.mean(axis=0)
    cosine = np.sum(ours[:, :2] * theirs[:, :2])
    sine = np.sum(ours[:, 0] * theirs[:, 1] - ours[:, 1] * theirs[:, 0])
    turn = float(np.arctan2(sine, cosine))
    return np.append(path.position.mean(axis=0) - _rotation(turn, ours.shape[1]) @ positions.mean(axis=0), turn)


def placed(found: Predicted, placement: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The prediction in the axes of the measurement: (T, D), and its derivatives (T, D, P), (T, D, D + 1)."""
    count, axes = found.value.shape
    turn = _rotation(placement[-1], axes)
    value = found.value @ turn.T
    across = np.zeros_like(value)
    across[:, 0], across[:, 1] = -value[:, 1], value[:, 0]
    by_placement = np.concatenate((np.broadcast_to(np.eye(axes), (count, axes, axes)), across[:, :, None]), axis=2)
    return value + placement[:-1], turn @ found.derivative, by_placement


def _rotation(turn: float, axes: int) -> np.ndarray:
    """Matrix (D, D) of a `turn` [rad] about the vertical."""
    matrix = np.eye(axes)
    matrix[:2, :2] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    return matrix
