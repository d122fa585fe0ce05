"""The straight rigid body (model identity 5): closed forms."""

import numpy as np
import pytest
from library_state import Body, Reference, Scene, prescribed, reference_scene, simulate
from reference import boyer_body
from scipy.special import ellipj

from eel_gaits import Law

STRAIGHT = Law(name="straight")


@pytest.mark.parametrize("speed", [-0.7, 0.4])
def test_coasting(speed):
    """Without friction the nose alone brakes: V = V0 / (1 + rho k_o |V0| t / (2 (m + m_o)))."""
    run = simulate(
        STRAIGHT,
        duration=10.0,
        scene=Scene(friction="none"),
        twist=(0, 0, 0, speed, 0, 0),
        sample_period=1.0,
        accuracy="fine",
    )
    added = 1000 * np.pi * 0.32 * 0.025 * 0.05 * 0.05
    drag, mass = np.pi * 0.036 * 0.025 * 0.05, Body.boyer2010().mass + added
    slowing = 1 + 1000 * drag * abs(speed) * run.time / (2 * mass)
    assert run.twist[:, 3] == pytest.approx(speed / slowing, rel=1e-9)
    travelled = speed * np.log(slowing) * 2 * mass / (1000 * drag * abs(speed))
    assert run.position[:, 0] == pytest.approx(travelled, rel=1e-9)
    assert np.all(run.position[:, 1:] == 0)


@pytest.mark.parametrize("sideways", [(0.3, 0.0), (0.0, 0.2), (0.3, -0.2)])
def test_munk_moment_and_wake(sideways):
    """-V1 V2 integral rho pi a^2 dX + l V1 V2 rho pi a(l)^2 about E3, its like about E2; and the force of the wake."""
    V1, (V2, V3) = -0.6, sideways
    wrench = prescribed(Body.boyer2010(), STRAIGHT, 0.0, (0, 0, 0, V1, V2, V3), np.zeros(6), {"resistive": False})
    space = Reference(boyer_body(), reference_scene()).space
    a, b = boyer_body().half_height, boyer_body().half_width
    mass2, mass3 = (1000 * np.pi * (space.weights @ axis(space.x) ** 2) for axis in (a, b))
    tail2, tail3 = (1000 * np.pi * float(axis(np.array(1.0))) ** 2 for axis in (a, b))
    # about E1 the two added masses differ: V x (M_f V) of the whole body
    moment = np.array([V2 * V3 * (mass2 - mass3), V1 * V3 * (mass3 - tail3), -V1 * V2 * (mass2 - tail2)])
    force = np.array([-(tail2 * V2**2 + tail3 * V3**2) / 2, V1 * tail2 * V2, V1 * tail3 * V3])
    torque_got, force_got = np.split(wrench, 2)
    assert force_got == pytest.approx(force, abs=1e-12)
    assert torque_got == pytest.approx(moment, abs=1e-12)


@pytest.mark.parametrize("spin", [(2.0, 0.0, 0.5), (40.0, 0.0, 0.2)])
def test_free_top(spin):
    """Without fluid: Euler's equations, solved by Jacobi's functions; the centre of mass rests.

    Moments A < B < C about the axes 1, 3, 2: a left-handed order, hence the sign of the middle one.
    """
    reference = Reference(boyer_body(), reference_scene(reactive=False))
    rest = np.zeros((reference.space.x.size, 3))
    matrix = reference.mass_matrix(rest)
    mass, center = matrix[3, 3], np.array([matrix[2, 4], 0, 0]) / matrix[3, 3]
    A, C, B = (matrix[k, k] - (mass * center[0] ** 2 if k else 0) for k in range(3))
    omega = np.array([spin[0], spin[2], 0.0])  # the middle moment's component starts at zero
    run = simulate(
        STRAIGHT,
        duration=4.0,
        scene=Scene(reactive=False, resistive=False),
        sample_period=0.1,
        accuracy="reference",
        twist=(*omega, *-np.cross(omega, center)),
    )
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
    assert run.twist[:, :3] == pytest.approx(np.stack(wanted, axis=1), abs=1e-7 * np.linalg.norm(omega))
    assert run.center_of_mass == pytest.approx(np.broadcast_to(center, run.center_of_mass.shape), abs=1e-8)
    assert np.ptp(run.twist[:, 2]) > 0.1 * np.abs(omega).min()  # it does tumble
