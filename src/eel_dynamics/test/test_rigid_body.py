# SPDX-License-Identifier: Apache-2.0
"""The straight rigid body: closed forms."""

import numpy as np
import pytest
from draws import bodies, few, numbers
from hypothesis import given
from hypothesis import strategies as st
from library_state import (
    Accuracy,
    Reference,
    Scene,
    distance,
    library_body,
    prescribed,
    reference_scene,
    simulate,
    turn_twist,
)
from reference import boyer_body
from scipy.special import ellipj

from eel_gaits import Law

STRAIGHT = Law(name="straight")


pytestmark = pytest.mark.identity("Rigid body")


@few(10)
@given(bodies(), st.one_of(numbers(-1.5, -0.1), numbers(0.1, 1.0)))
def test_coasting(measured, body, speed):
    """Without friction the nose alone brakes: V = V0 / (1 + rho k_o |V0| t / (2 (m + m_o))), either way.

    Steps are asked for 1e-10.
    """
    swimmer = library_body(body)
    run = simulate(
        STRAIGHT,
        duration=10.0,
        body=swimmer,
        scene=Scene(friction="none"),
        twist=(0, 0, 0, speed, 0, 0),
        sample_period=1.0,
        accuracy=Accuracy(name="coasting", resolution=60.0, tolerance=1e-10),
    )
    added = 1000 * np.pi * 0.32 * np.prod(body.nose)
    drag, mass = np.pi * 0.036 * body.nose[0] * body.nose[1], swimmer.mass + added
    slowing = 1 + 1000 * drag * abs(speed) * run.time / (2 * mass)
    measured("coasting for 10 s, speed", distance(run.twist[:, 3], speed / slowing), 1e-8)
    travelled = speed * np.log(slowing) * 2 * mass / (1000 * drag * abs(speed))
    measured("coasting for 10 s, way", distance(run.position[:, 0], travelled), 1e-8)
    assert np.all(run.position[:, 1:] == 0)


@few(20)
@given(bodies(), st.tuples(*[st.one_of(numbers(-1.0, -0.1), numbers(0.1, 1.0))] * 3))
def test_munk_moment_and_wake(measured, body, velocity):
    """-V1 V2 integral rho pi a^2 dX + l V1 V2 rho pi a(l)^2 about E3, its like about E2; and the force of the wake.

    About E1 the two added masses differ: V x (M_f V) of the whole body. Round-off of two quadratures.
    """
    V1, V2, V3 = velocity
    scene = {"resistive": False, "nose": False}
    got = prescribed(library_body(body), STRAIGHT, 0.0, (0, 0, 0, *velocity), np.zeros(6), scene)
    space, length = Reference(body, reference_scene()).space, body.kinks[-1]
    a, b = body.half_height, body.half_width
    mass2, mass3 = (1000 * np.pi * (space.weights @ axis(space.x) ** 2) for axis in (a, b))
    tail2, tail3 = (1000 * np.pi * float(axis(np.array(length))) ** 2 for axis in (a, b))
    moment = V2 * V3 * (mass2 - mass3), V1 * V3 * (mass3 - length * tail3), -V1 * V2 * (mass2 - length * tail2)
    force = -(tail2 * V2**2 + tail3 * V3**2) / 2, V1 * tail2 * V2, V1 * tail3 * V3
    measured("Munk's moment and the wake's, straight body in oblique flow", distance(got[:3], moment), 1e-12)
    measured("force of the wake on it", np.abs(got[3:] - force) / mass2, 1e-12)


@pytest.mark.parametrize("which, least_roll, most_roll", [("greatest", 0.1, 0.5), ("least", 2.0, 50.0)])
@few(3)
@given(st.data())
def test_free_top(measured, which, least_roll, most_roll, data):
    """Without fluid: Euler's equations, solved by Jacobi's functions; the centre of mass rests. It turns about its
    greatest moment of inertia (roll below 0.83 of the pitch) or its least, and tumbles.

    Moments A < B < C about the axes 1, 3, 2: a left-handed order, hence the sign of the middle one.
    """
    roll, pitch = data.draw(numbers(least_roll, most_roll)), data.draw(numbers(0.6, 1.0))
    reference = Reference(boyer_body(), reference_scene(reactive=False), panels_per_span=1)
    rest = np.zeros((reference.space.x.size, 3))
    matrix = reference.mass_matrix(rest)
    mass, centre = matrix[3, 3], np.array([matrix[2, 4], 0, 0]) / matrix[3, 3]
    A, C, B = (matrix[k, k] - (mass * centre[0] ** 2 if k else 0) for k in range(3))
    omega = np.array([roll, pitch, 0.0])  # the middle moment's component starts at zero
    run = simulate(
        STRAIGHT,
        duration=4.0,
        scene=Scene(reactive=False, resistive=False),
        sample_period=0.1,
        accuracy="reference",
        twist=turn_twist((*omega, *-np.cross(omega, centre))),
    ).in_axes("paper")
    energy2, momentum2 = A * omega[0] ** 2 + C * omega[1] ** 2, (A * omega[0]) ** 2 + (C * omega[1]) ** 2
    if momentum2 > energy2 * B:  # turns about C
        rate = np.sqrt((C - B) * (momentum2 - energy2 * A) / (A * B * C))
        m = (B - A) * (energy2 * C - momentum2) / ((C - B) * (momentum2 - energy2 * A))
        sn, cn, dn, _ = ellipj(rate * run.time, m)
        wanted = omega[0] * cn, omega[1] * dn, -np.sqrt((energy2 * C - momentum2) / (B * (C - B))) * sn
    else:  # turns about A
        rate = np.sqrt((B - A) * (energy2 * C - momentum2) / (A * B * C))
        m = (C - B) * (momentum2 - energy2 * A) / ((B - A) * (energy2 * C - momentum2))
        sn, cn, dn, _ = ellipj(rate * run.time, m)
        wanted = omega[0] * dn, omega[1] * cn, -np.sqrt((momentum2 - energy2 * A) / (B * (B - A))) * sn
    assert (momentum2 > energy2 * B) == (which == "greatest")
    error = distance(run.twist[:, :3], np.stack(wanted, axis=1), np.linalg.norm(omega))
    measured(f"Euler's top for 4 s about its axis of {which} moment, against Jacobi's functions", error, 1e-7)
    measured("its centre of mass, which rests", np.abs(run.center_of_mass - centre), 1e-8, unit="m")
    assert np.ptp(run.twist[:, 2]) > 0.1 * pitch  # it does tumble
