# SPDX-License-Identifier: Apache-2.0
"""The totals of a node's run: what they take, and what they stop it for."""

import numpy as np
import pytest
from eel_common.quantity import LARGEST
from eel_dynamics.ros.loop.run_totals import RunTotals, check_finite

from eel_dynamics import Simulation, SimulationStopped
from eel_gaits import straight


@pytest.mark.parametrize("whole", [True, False])
def test_the_farthest_place_that_a_number_can_name_is_finite(whole):
    simulation = Simulation()
    simulation.adopt(straight())
    simulation.set_state([LARGEST, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0], np.zeros(6))
    totals, snapshot = RunTotals(), simulation.observe(wrench=whole, load=whole)
    check_finite(snapshot)  # the sum of its numbers is infinite
    totals.add(snapshot)
    assert ("closure_torque" in totals.values()) is whole


@pytest.mark.parametrize("whole", [True, False])
def test_a_number_that_is_not_finite_stops_the_run_by_its_name(whole):
    simulation = Simulation()
    simulation.adopt(straight())
    snapshot = simulation.observe(wrench=whole, load=whole)
    assert set(snapshot.arrays()) >= {"position", "backbone"} and ("torque" in snapshot.arrays()) is whole
    snapshot.backbone[3, 1] = np.nan
    with pytest.raises(SimulationStopped, match="backbone"):
        check_finite(snapshot)


def test_an_energy_residual_that_is_not_finite_stops_the_run_before_it_is_published():
    simulation = Simulation()
    simulation.adopt(straight())
    simulation.advance(0.1)
    snapshot = simulation.observe()
    works, _ = snapshot._ledger
    works[0] = np.inf
    with pytest.raises(SimulationStopped, match="energy residual"):
        check_finite(snapshot)
