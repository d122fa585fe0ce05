# SPDX-License-Identifier: Apache-2.0
"""The core's bodies with modes against the reference, which has them from the kinetic energy alone."""

import numpy as np
import pytest
from reference import boyer_body, scene
from reference_bending import BentReference
from test_reference_bending import MIXED, WAVE

from eel_dynamics import Scene, Simulation, simulate

TURN = np.array([-1.0, -1.0, 1.0, -1.0, -1.0, 1.0])  # between the axes of the library and of the paper


def coordinates_of(simulation):
    """Coordinates, their rates and accelerations, as the core has them at present."""
    core, now = simulation._march.core, simulation.observe(load=False)
    row = np.zeros((1, max(end for _, end in core.row.values())))
    assert core.observe(now.whole, row, True, False)
    return now, *(row[0, slice(*core.row[name])] for name in ("x", "rate", "acceleration"))


@pytest.mark.parametrize(
    ("settings", "times"),
    [({}, (0.3, 0.83)), ({"metacentric_height": 0.02}, (0.83,)), ({"reactive": False, "resistive": False}, (0.3,))],
)
def test_accelerations_are_those_of_lagrange_s_equations(settings, times):
    settings = settings | {"friction": "laminar"}
    reference = BentReference(boyer_body(), MIXED, scene(**settings), law=WAVE, panels_per_span=2, nodes_per_panel=14)
    simulation = Simulation(robot=MIXED, law=WAVE, scene=Scene(**settings), accuracy="fine", stations=11)
    modes = len(reference.owner)
    for time in times:
        simulation.advance(time)
        now, x, rate, acceleration = coordinates_of(simulation)
        up = np.array([0.0, 0.0, 1.0])
        if "metacentric_height" in settings:
            q = now.orientation * np.array([-1.0, -1.0, 1.0, 1.0])
            v = q[:3]
            reference.up = up - 2.0 * q[3] * np.cross(v, up) + 2.0 * np.cross(v, np.cross(v, up))
        head, qddot, thdd = reference.bent_accelerations(
            time, now.twist * TURN, x[:modes], rate[:modes], x[modes:], rate[modes:]
        )
        twist, found = now.twist * TURN, now.head_acceleration * TURN
        found = found - np.concatenate([np.zeros(3), np.cross(twist[:3], twist[3:])])
        scale = np.abs(qddot).max()
        assert np.abs(acceleration[:modes] - qddot).max() < 2e-5 * scale
        assert np.abs(acceleration[modes:] - thdd).max() < 1e-6 * np.abs(thdd).max()
        assert np.abs(found - head).max() < 2e-5 * np.abs(head).max()


def test_momenta_and_accelerations_are_two_forms_of_one_motion():
    """The rates that the march of momenta gives have the accelerations of the balance of forces for derivatives."""
    simulation = Simulation(robot=MIXED, law=WAVE, scene=Scene(friction="none"), accuracy="fine", stations=2)
    step, seen = 2e-3, []
    for k in range(-2, 3):
        simulation.advance(0.6 + k * step)
        now, _, rate, acceleration = coordinates_of(simulation)
        seen.append(
            (np.concatenate([rate, now.twist]), np.concatenate([acceleration, now.head_acceleration]), now.twist)
        )
    slope = (seen[0][0] - 8.0 * seen[1][0] + 8.0 * seen[3][0] - seen[4][0]) / (12.0 * step)
    expected, twist = seen[2][1].copy(), seen[2][2]
    expected[-3:] -= np.cross(twist[:3], twist[3:])
    # the rates of stiff high modes differ by some 1e-4 of the greatest, over steps of 2 ms
    assert np.abs(slope - expected).max() < 5e-3 * np.abs(expected).max()


def test_ledger_closes_with_motors_muscles_springs_and_stops():
    run = simulate(WAVE, 1.0, robot=MIXED, accuracy=1e-5, estimate=False)
    assert np.abs(run.energy.residual).max() < 1e-5 * np.abs(run.energy.actuator_work).max()
