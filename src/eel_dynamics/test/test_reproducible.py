# SPDX-License-Identifier: Apache-2.0
"""The last digit of a start, or of a processor's arithmetic, stays a last digit: steps are not chosen by it."""

import itertools

import numpy as np

from eel_dynamics import Scene, simulate
from eel_gaits import falling, straight

PERIODS = np.linspace(0.8, 1.4, 6)


def pair(accuracy, friction, period):
    """Two runs whose starts differ in the last digit."""
    scene = Scene(friction=friction, ledger=False, internal_wrench=False)
    return [
        simulate(
            falling(period=period),
            10.0,
            scene=scene,
            accuracy=accuracy,
            sample_period=10.0,
            stations=2,
            twist=(0.0, 0.0, 0.0, 0.1, speed, 0.0),
        )
        for speed in (0.01, 0.01 * (1.0 + 2e-16))
    ]


def test_a_last_digit_stays_one():
    """Before steps grew by whole parts of 32, such pairs were apart by up to 2e-6, 1e-10 and 1e-6 m.

    A step may still lie so near to the border of two sizes that the last digit decides. On one processor 2 of 360 pairs
    did, both at 1e-6; here 2 of 36 may. They keep the target.
    """
    decided = 0
    for accuracy, friction in itertools.product((1e-2, 1e-4, 1e-6), ("laminar", "printed")):
        for period in PERIODS:
            first, second = pair(accuracy, friction, period)
            distance = np.max(np.abs(first.position - second.position))
            if (first.steps, first.evaluations) == (second.steps, second.evaluations):
                assert distance < 1e-10, (accuracy, friction, period)
            else:
                decided += 1
                assert distance < accuracy * first.path_length, (accuracy, friction, period)
    assert decided <= 2


def test_with_all_that_is_on_by_default():
    runs = [simulate(straight(), 5.0, twist=(0.0, 0.0, 0.0, speed, 0.0, 0.0)) for speed in (0.1, 0.1 * (1.0 - 2e-16))]
    assert runs[0].evaluations == runs[1].evaluations
    assert np.max(np.abs(runs[0].torque - runs[1].torque)) < 1e-10
