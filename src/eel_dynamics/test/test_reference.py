# SPDX-License-Identifier: Apache-2.0
"""The reference is verified by itself before anything is held against it: no import of eel_dynamics here."""

import numpy as np
import pytest
from cases import SPLINE_KNOTS, falling_law, kern_body, random_law, random_twist
from reference import STEP, Reference, boyer_body, rotation, scene

SMOOTH = {"resistive": False}
EXACT = 1e-11  # round-off of some 100 nodes and 40 Picard terms, relative to the terms' own size


def state(seed, **settings):
    """A reference, its motion and the head's acceleration, at a random instant."""
    rng = np.random.default_rng(seed)
    reference = Reference(boyer_body() if seed % 2 else kern_body(), scene(**settings), splits=SPLINE_KNOTS)
    shape = random_law(rng).curvature(rng.uniform(0, 3), reference.space.x)
    twist = random_twist(rng)
    return reference, shape, twist, reference.acceleration(*shape, twist)


def test_mass_and_added_mass_of_the_robot():
    """The paper's 1.94 kg; added mass 4.998 kg, 2.827 kg/m at the tail; 0.822 kg with eq. (37) as printed."""
    reference, printed = (Reference(boyer_body(), scene(added_mass=choice)) for choice in ("corrected", "printed"))
    weights = reference.space.weights
    assert weights @ reference.inertia_body[:, 3] == pytest.approx(1.944, abs=5e-4)
    assert weights @ reference.inertia_fluid[:, 4] == pytest.approx(4.998, abs=5e-4)
    assert reference.tail_added[4] == pytest.approx(1000 * np.pi * 0.03**2, rel=1e-12)
    assert weights @ printed.inertia_fluid[:, 4] == pytest.approx(0.822, abs=5e-4)


def test_volume_of_the_kern_body():
    """Kern & Koumoutsakos 2006: 0.0059326 L^3 (water inside: kg)."""
    reference = Reference(kern_body())
    assert reference.space.weights @ reference.inertia_body[:, 3] == pytest.approx(5.9326, abs=5e-4)


def test_configuration_of_a_circle_and_of_a_helix():
    """Constant curvature: a circle of radius 1/K; constant K2 and K3: a circle in the plane across (K2, K3)."""
    reference = Reference(boyer_body())
    K = np.tile([0.0, 3.0, 4.0], (reference.space.x.size, 1))
    R, r = reference.configuration(K)
    x, across = reference.space.x, np.array([0.0, 4.0, -3.0]) / 5  # K x E1 / |K|
    assert np.allclose(
        r, np.outer(np.sin(5 * x), [0.2, 0, 0]) + np.outer(0.2 * (1 - np.cos(5 * x)), across), atol=1e-13
    )
    assert np.allclose(R.transpose(0, 2, 1) @ R, np.eye(3), atol=1e-13)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("settings, tolerance", [(SMOOTH, EXACT), ({"friction": "laminar"}, 1e-6)])
def test_strong_form_meets_the_tail_condition(seed, settings, tolerance):
    """Eq. (50) from the nose ends in n = -T_f t1, c = 0 at the tail, eq. (51): momentum against fields.

    With drag the kinks of V|V| inside panels near the tail leave up to 6e-7.
    """
    reference, shape, twist, rate = state(seed, **settings)
    fields = reference.fields(*shape, twist, rate)
    assert np.allclose(fields.tail_residual[:3], 0, atol=tolerance * np.abs(fields.torque).max())
    assert np.allclose(fields.tail_residual[3:], 0, atol=tolerance * np.abs(fields.force).max())


@pytest.mark.parametrize("seed", range(4))
def test_energy_ledger(seed):
    """d/dt of the kinetic energy, by a complex step, is the sum of the four powers."""
    reference, (K, K1, K2), twist, rate = state(seed)
    step = 1j * STEP
    growth = sum(reference.energies(K + step * K1, K1 + step * K2, twist + step * rate)).imag / STEP
    fields = reference.fields(K, K1, K2, twist, rate)
    powers = np.array([fields.actuator_power, fields.wake_power, fields.nose_power, fields.drag_power])
    assert growth == pytest.approx(powers.sum(), abs=EXACT * np.abs(powers).max())


@pytest.mark.parametrize("seed", range(4))
def test_torque_by_virtual_work(seed):
    """Lagrange's equation of a shape coordinate s, K + s phi(X), gives integral C . phi dX from the energy alone.

    d/dt dT/d(ds/dt) - dT/ds = -integral C . phi dX + (wake's wrench . virtual displacement of the tail), no drag.
    The head is held in the virtual displacement, so that its equation does not enter; the torque is the strong form's.
    """
    reference, (K, K1, K2), twist, rate = state(seed, **SMOOTH)
    x, step, h = reference.space.x, 1j * STEP, 1.0
    phi = np.stack([0 * x, np.cos(2 * x), 1 + x**2], axis=1)

    def conjugate(K, K1, mu):  # dT/d(ds/dt): exact difference, T being quadratic in K1
        return (sum(reference.energies(K, K1 + h * phi, mu)) - sum(reference.energies(K, K1 - h * phi, mu))) / (2 * h)

    inertial = conjugate(K + step * K1, K1 + step * K2, twist + step * rate).imag / STEP
    inertial -= sum(reference.energies(K + step * phi, K1, twist)).imag / STEP
    R, _r = reference.configuration(K)
    turn, shift = (reference.at_tail(field) for field in reference.shape_velocity(R, phi))
    eta, tail_R = reference.at_tail(reference.twists(K, K1, twist)), reference.at_tail(R.reshape(-1, 9)).reshape(3, 3)
    wrench, _ = reference.tail_wrench(tail_R, np.zeros(3), eta)  # about the tail
    fields = reference.fields(K, K1, K2, twist, rate)
    work = reference.space.weights @ np.sum(fields.torque * phi, axis=1)
    assert inertial == pytest.approx(-work + wrench @ np.concatenate([turn, shift]), abs=EXACT * (1 + abs(work)))


@pytest.mark.parametrize("seed", range(2))
def test_loads_sum_to_the_fluid_wrench(seed):
    reference, shape, twist, rate = state(seed)
    fields, R = reference.fields(*shape, twist, rate), reference.configuration(shape[0])[0]
    force = reference.space.weights @ np.einsum("xij,xj->xi", R, fields.fluid_force) + fields.nose_force
    force = force + reference.at_tail(R.reshape(-1, 9)).reshape(3, 3) @ fields.tail_force
    whole = reference.fluid_wrench(*shape, twist, rate)[3:]
    assert np.allclose(force, whole, atol=1e-9 * np.abs(fields.force).max())  # spectral derivative of V1 p_f: 1e-10


def test_nodes_converge():
    """Twice the nodes change the acceleration by round-off without drag."""
    rng = np.random.default_rng(3)
    law, twist = random_law(rng), random_twist(rng)
    results = []
    for panels in (1, 2):
        reference = Reference(boyer_body(), scene(**SMOOTH), splits=SPLINE_KNOTS, panels_per_span=panels)
        results.append(reference.acceleration(*law.curvature(0.7, reference.space.x), twist))
    assert np.allclose(*results, rtol=0, atol=1e-10 * np.abs(results[0]).max())


def test_without_fluid_the_momentum_stays():
    """A march of 0.3 s in vacuum: the momentum in world axes about the origin is constant to the march's tolerance."""
    reference = Reference(boyer_body(), scene(reactive=False, **SMOOTH), panels_per_span=1, nodes_per_panel=12)
    law, start = falling_law(), np.array([0.1, 0.2, -0.3, -0.5, 0.1, 0.2])
    times = (0.0, 0.15, 0.3)
    momenta = []
    for time, position, q, twist in zip(times, *reference.march(law, times, twist=start, rtol=1e-11), strict=False):
        L, P = np.split(reference.momentum(*law.curvature(time, reference.space.x)[:2], twist), 2)
        L, P = rotation(q) @ L, rotation(q) @ P
        momenta.append(np.concatenate([L + np.cross(position, P), P]))
    assert np.allclose(momenta, momenta[0], rtol=0, atol=1e-9)
