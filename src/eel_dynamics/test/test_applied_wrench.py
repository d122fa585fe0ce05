# SPDX-License-Identifier: Apache-2.0
"""Wrenches applied during a run, and copies of such a run."""

import copy
import pickle

import numpy as np
import pytest
from random_robots import drawn
from wrench_cases import NO_WATER, STRAIGHT, about_centre

from eel_dynamics import Body, ExternalWrench, Simulation
from eel_gaits import falling, straight


def test_an_applied_wrench_is_that_of_a_table():
    table = ExternalWrench(0.5, time=(0.4, 0.4, 0.7, 0.7), force=((0, 0, 0), (1, 0.5, 0), (1, 0.5, 0), (0, 0, 0)))
    start = {"law": falling(), "accuracy": 1e-7, "measure_error": True}
    one, other = Simulation(**start, wrenches=[table]), Simulation(**start, wrenches=[ExternalWrench(0.5)])
    for until, force in ((0.4, (1.0, 0.5, 0.0)), (0.7, (0.0, 0.0, 0.0)), (1.0, None)):
        for each in (one, other):
            each.advance(until)
        mine, yours = one.observe(), other.observe()
        assert mine.position == pytest.approx(yours.position, abs=1e-8)
        assert mine.torque == pytest.approx(yours.torque, abs=1e-6)
        assert mine.energy.external_work == pytest.approx(yours.energy.external_work, abs=1e-8)
        if force is not None:
            other.apply_wrench(0.5, force)
    assert abs(mine.energy.external_work) > 1e-4
    assert one.error_estimate.worst < 1e-5 and other.error_estimate.worst < 1e-5


def test_a_wrench_at_a_new_station_goes_on_from_the_same_motion():
    """The grid changes; the head's motion does not."""
    declared = Simulation(law=falling(), accuracy=1e-6, wrenches=[ExternalWrench(0.37)])
    late = Simulation(law=falling(), accuracy=1e-6)
    for each in (declared, late):
        each.advance(0.8)
        each.apply_wrench(0.37, (0.5, 0.0, 0.2), (0.0, 0.01, 0.0), frame="world")
    assert late.observe().twist == pytest.approx(declared.observe().twist, abs=1e-6)
    for each in (declared, late):
        each.advance(1.5)
    assert late.observe().position == pytest.approx(declared.observe().position, abs=1e-6)
    assert late.observe().energy.residual == pytest.approx(0.0, abs=1e-6)


def test_the_last_one_applied_at_a_station_holds_until_a_reset():
    simulation = Simulation(law=STRAIGHT, scene=NO_WATER)
    rest = simulation.observe().head_acceleration[3]
    simulation.apply_wrench(0.0, (1.0, 0.0, 0.0))
    simulation.apply_wrench(0.0, (2.0, 0.0, 0.0))
    mass = about_centre(Body.boyer2010(), "z")[1]
    assert simulation.observe().head_acceleration[3] == pytest.approx(2.0 / mass, rel=1e-8)
    simulation.apply_wrench(1.0, (1.0, 0.0, 0.0))
    assert simulation.observe().head_acceleration[3] == pytest.approx(3.0 / mass, rel=1e-8)
    simulation.apply_wrench(0.0)
    assert simulation.observe().head_acceleration[3] == pytest.approx(1.0 / mass, rel=1e-8)
    simulation.advance(0.5)
    simulation.reset()
    assert simulation.observe().head_acceleration[3] == rest == 0.0


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))])
@pytest.mark.parametrize("robot", [None, drawn(3).robot])
def test_copies_go_on_under_the_same_wrench(copied, robot):
    wrenches = [ExternalWrench(0.2, time=(0.1, 0.35, 0.35), force=((0, 0, 0), (1, 0, 0), (0, 1, 0)))]
    one = Simulation(law=straight(), robot=robot, wrenches=wrenches, accuracy="draft", stations=5)
    one.advance(0.2)
    one.apply_wrench(0.6, (0.3, 0.1, 0.0))
    one.advance(0.3)
    other = copied(one)
    for each in (one, other):
        each.advance(0.6)
    assert np.array_equal(one.observe().whole, other.observe().whole)
