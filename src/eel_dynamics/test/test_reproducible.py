# SPDX-License-Identifier: Apache-2.0
"""The last digit of a start, or of a processor's arithmetic, stays a last digit: steps are not chosen by it."""

import numpy as np
import pytest

from eel_dynamics import Scene, simulate
from eel_gaits import falling, straight

PERIODS = np.linspace(0.8, 1.4, 6)


@pytest.mark.parametrize("friction", ["laminar", "printed"])
@pytest.mark.parametrize("accuracy", [1e-2, 1e-4, 1e-6])
def test_a_last_digit_stays_one(accuracy, friction):
    """Before steps grew by whole parts of 32, such pairs were up to 2e-6, 1e-10 and 1e-6 m apart."""
    scene = Scene(friction=friction, ledger=False, internal_wrench=False)
    for period in PERIODS:
        first, second = (
            simulate(
                falling(period=period),
                10.0,
                scene=scene,
                accuracy=accuracy,
                sample_period=10.0,
                stations=2,
                twist=(0.0, 0.0, 0.0, -0.1, speed, 0.0),
            )
            for speed in (0.01, 0.01 * (1.0 + 2e-16))
        )
        assert (first.steps, first.evaluations) == (second.steps, second.evaluations)
        assert np.max(np.abs(first.position - second.position)) < 1e-10, period


def test_with_all_that_is_on_by_default():
    runs = [simulate(straight(), 5.0, twist=(0.0, 0.0, 0.0, speed, 0.0, 0.0)) for speed in (-0.1, -0.1 * (1.0 - 2e-16))]
    assert runs[0].evaluations == runs[1].evaluations
    assert np.max(np.abs(runs[0].torque - runs[1].torque)) < 1e-10
