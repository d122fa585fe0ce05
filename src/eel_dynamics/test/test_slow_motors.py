# SPDX-License-Identifier: Apache-2.0
"""Motors that are too slow for what they are asked for are told at the start, with names and numbers."""

import warnings

import numpy as np
import pytest
from eel_dynamics.model.robot.compiled import mode_table
from eel_dynamics.simulation.bending.slow_motors import slow_motors

from eel_dynamics import Body, Robot, Scene, simulate
from eel_gaits import sampled, still, straight

EIGHT = Robot.named("eight_servos")
TABLE = mode_table(EIGHT, Body.boyer2010())
PLANE = Scene(planar=True)


def with_limit(limit):
    return mode_table(EIGHT.changed(speed_limit=limit), Body.boyer2010())


def test_the_greatest_rate_of_the_law_is_compared_with_each_motor():
    """The bend of one joint by the law, differenced in time."""
    law, joint = straight(), 5
    time = np.linspace(3.0, 4.0, 401)  # a period after the start
    bends = np.array([TABLE.projection[joint] @ law.curvature(t, TABLE.points)[0][:, 2] for t in time])
    greatest = np.abs(np.gradient(bends, time)).max()
    only = mode_table(EIGHT.changed("joint_6", speed_limit=0.9 * greatest), Body.boyer2010())
    told = slow_motors(only, law, 4.0)
    words = f"1 of 8 motors are too slow for the law: the one of joint_6 is asked for {greatest:.2g}"
    assert told.text.startswith(words) and not told.far
    enough = mode_table(EIGHT.changed("joint_6", speed_limit=1.1 * greatest), Body.boyer2010())
    assert slow_motors(enough, law, 4.0) is None


@pytest.mark.parametrize("law", [straight(period=0.1), sampled(straight(period=0.1).curvature, 2.0)])
def test_laws_of_any_kind_are_looked_at(law):
    told = slow_motors(with_limit(0.1), law, 2.0)
    assert "8 of 8 motors are too slow" in told.text and told.far
    assert slow_motors(with_limit(1e3), law, 2.0) is slow_motors(with_limit(None), law, 2.0) is None
    assert slow_motors(None, law, 2.0) is slow_motors(with_limit(0.1), still(), 2.0) is None


def test_it_is_told_before_the_swim_which_is_not_made_finer():
    slow = EIGHT.changed(speed_limit=0.1)
    swim = {"robot": slow, "scene": PLANE, "stations": 9}
    with pytest.warns(UserWarning, match=r"8 of 8 motors are too slow for the law: the one of joint_8 is asked for"):
        run = simulate(straight(), 1.0, **swim, accuracy=1e-7)
    plain = simulate(straight(), 1.0, **swim, accuracy=1e-7, estimate=False)
    assert run.error_estimate.worst > 1e-7 and run.steps < 3 * plain.steps
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        simulate(straight(), 0.2, robot=EIGHT, scene=PLANE, accuracy=1e-2)
