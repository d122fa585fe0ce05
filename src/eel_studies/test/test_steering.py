# SPDX-License-Identifier: Apache-2.0
"""The linearised swim: what grows in a period, and what bends in yaw and pitch can do about it."""

from dataclasses import replace

import numpy as np
import pytest
from eel_studies.steering.linearisation import INPUTS, OUT_OF_PLANE, STATES
from hypothesis import given, settings
from hypothesis import strategies as st

from eel_dynamics import Scene, simulate
from eel_gaits import Law, Term, falling, helix, straight, turning
from eel_studies import periodic_linearisation

OUT = np.isin(STATES, OUT_OF_PLANE)
YAW, PITCH = INPUTS[:3], INPUTS[3:]


@pytest.fixture(scope="module")
def free():
    """The straight gait without ballast."""
    return periodic_linearisation(straight())


def test_roll_grows_as_it_does_in_a_long_swim(free):
    """The known e^1.45 a period, fitted over a swim from rest; the rate that such a swim comes to is the multiplier."""
    how = {"accuracy": 1e-5, "stations": 2, "estimate": False, "sample_period": 1.0}
    run = simulate(straight(), 18.0, scene=Scene(ledger=False), twist=(1e-14, 0.0, 0.0, 0.0, 0.0, 0.0), **how)
    swum = np.linalg.norm(run.twist[-2:, [0, 1, 5]], axis=1)  # out of the plane; the body is 1 m long
    assert np.log(free.growth) == pytest.approx(np.log(swum[1] / swum[0]), abs=2e-3)
    assert np.log(free.growth) == pytest.approx(1.45, abs=0.03)
    assert free.error < 1e-4 and free.defect < 1e-9
    assert np.abs(free.multipliers[1:]).max() < 1.0 + 1e-6 and "roll_rate" in free.motion_of(0)


@settings(derandomize=True, max_examples=4, deadline=None, database=None)
@given(st.sampled_from((straight, turning, falling, helix)), st.floats(0.7, 1.5), st.sampled_from((0.0, 0.008, 0.03)))
def test_no_heading_and_without_ballast_no_attitude_is_special(gait, period, height):
    found = periodic_linearisation(
        gait(period=period), scene=Scene(metacentric_height=height), estimate=False, steps=80, resolution=26.0
    )
    free = [STATES.index("heading")] if height else [0, 1, 2]
    turn = found.monodromy[np.ix_(free, free)]  # of the course: what lies in the world turns against it
    assert np.abs(np.delete(found.monodromy, free, axis=0)[:, free]).max() < 1e-6
    assert np.allclose(turn @ turn.T, np.eye(len(free)), atol=1e-6) and found.monodromy[2, 2] == pytest.approx(1.0)
    assert np.count_nonzero(found.neutral) == len(free)
    assert np.abs(np.abs(found.multipliers[found.neutral]) - 1.0).max() < 1e-6
    assert np.allclose(found.participation.sum(axis=0), 1.0)
    if gait in (straight, turning):  # the mirror of the plane
        assert np.abs(found.monodromy[np.ix_(OUT, ~OUT)]).max() < 1e-9
        assert np.abs(found.monodromy[np.ix_(~OUT, OUT)]).max() < 1e-9


def test_frequency_and_ballast_scale_together():
    """Without viscosity a swim twice as slow is the same swim where the metacentric height is a quarter."""
    fast, slow = (
        periodic_linearisation(
            straight(period=period), scene=Scene(metacentric_height=height, viscosity=0.0), estimate=False
        )
        for period, height in ((1.0, 0.02), (2.0, 0.005))
    )
    assert np.allclose(fast.multipliers, slow.multipliers, atol=1e-6)
    assert np.allclose(fast.controllability(), slow.controllability(), atol=1e-5)


def test_pitch_holds_roll_and_yaw_holds_the_heading(free):
    ballast = periodic_linearisation(straight(), scene=Scene(metacentric_height=0.01), estimate=False)
    for found in (free, ballast):
        assert found.controllability().min() > 1e-3
        assert found.controllability(YAW)[0] < 1e-6 < 0.1 < found.controllability(PITCH)[0]
        assert found.controllability(PITCH)[found.neutral].max() < 1e-6
    assert np.abs(free.kick(0)[INPUTS.index("up_bend_cos")]) > 0.3 and np.abs(free.kick(0)[:3]).max() < 1e-6


@pytest.mark.parametrize("height", [0.0, 0.01])
def test_a_controller_once_a_period_steadies_the_swim(height):
    found = periodic_linearisation(straight(), scene=Scene(metacentric_height=height), estimate=False)
    closed = found.monodromy - found.input_matrix @ found.feedback(0.3)
    assert np.abs(np.linalg.eigvals(closed)).max() < 1.0 < found.growth


def test_the_settled_motion_is_periodic_and_swims_on_its_course(free):
    start, end = free.start, free.end
    assert end.position[0] > 0.5 and abs(end.position[1]) < 1e-9 and np.all(start.position == 0.0)
    assert np.allclose(start.twist, end.twist, atol=1e-8) and np.allclose(start.up, end.up, atol=1e-9)
    assert free.bent(np.zeros(6)) == free.law and len(free.bent(np.ones(6)).terms) == len(free.law.terms) + 6
    assert "growth 4.3" in repr(free)


@pytest.mark.parametrize(
    "given, words",
    [
        ({"scene": Scene(planar=True)}, "scene must not be planar"),
        ({"law": Law(Term(amplitude=(0.5,), phase=1.0))}, "no periodic term"),
        ({"law": "straight"}, "law must be a Law, got 'straight'"),
        ({"steps": 3}, "steps must be a whole number of 20 or more, got 3"),
        ({"rise": 0.7}, "rise must be > 0 and at most 0.5 of the period, got 0.7"),
    ],
)
def test_what_does_not_fit_is_named(given, words):
    with pytest.raises(ValueError, match=words):
        periodic_linearisation(given.pop("law", straight()), **given)


def test_unknown_inputs_are_named(free):
    with pytest.raises(ValueError, match=r"inputs must be one of left_bend, .* got 'roll'"):
        free.controllability(("roll",))
    with pytest.raises(ValueError, match="bend must be > 0 rad/m, got -1"):
        free.feedback(-1.0)
    stiff = replace(free, input_matrix=np.zeros((9, 6)))
    with pytest.raises(ValueError, match="no feedback of these bends is stable"):
        stiff.feedback()
