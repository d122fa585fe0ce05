"""No fluid (model identity 4): linear and angular momentum stay, energy is the actuators' work."""

import numpy as np
import pytest
from cases import falling_law, random_law
from library_state import Body, Reference, Scene, reference_scene, rotation, simulate
from reference import boyer_body

VACUUM = {"reactive": False, "resistive": False}
START = np.array([0.3, 0.2, -0.4, -0.5, 0.1, 0.2])
# RK4 at the step of the finest preset over 2 s, and the fixed orders in space: a bound well above what is measured.
TOLERANCE = 1e-6


@pytest.fixture(scope="module", params=["falling", "random"])
def flight(request):
    law = falling_law() if request.param == "falling" else random_law(np.random.default_rng(2), spline=False)
    run = simulate(law, duration=2.0, scene=Scene(**VACUUM), accuracy="reference", sample_period=0.1, twist=START)
    return law, run


def momenta(law, run):
    """(T, 6) angular (about the origin) and linear momentum in world axes, by the reference's own integrals."""
    reference, out = Reference(boyer_body(), reference_scene(**VACUUM)), []
    for time, position, q, twist in zip(run.time, run.position, run.orientation, run.twist, strict=False):
        L, P = np.split(reference.momentum(*law.curvature(time, reference.space.x)[:2], twist), 2)
        L, P = rotation(q) @ L, rotation(q) @ P
        out.append(np.concatenate([L + np.cross(position, P), P]))
    return np.array(out)


def test_linear_and_angular_momentum(flight):
    L, P = np.split(momenta(*flight), 2, axis=1)
    assert np.ptp(P, axis=0) == pytest.approx(0, abs=TOLERANCE * np.linalg.norm(P[0]))
    assert np.ptp(L, axis=0) == pytest.approx(0, abs=TOLERANCE * np.linalg.norm(L[0]))


def test_center_of_mass_moves_uniformly(flight):
    _, run = flight
    line = run.center_of_mass[0] + np.outer(run.time, run.center_of_mass[-1] - run.center_of_mass[0]) / run.time[-1]
    assert run.center_of_mass == pytest.approx(line, abs=TOLERANCE)
    speed = np.linalg.norm(run.center_of_mass[-1] - run.center_of_mass[0]) / run.time[-1]
    momentum = np.linalg.norm(momenta(*flight)[0, 3:])
    assert Body.boyer2010().mass * speed == pytest.approx(momentum, rel=1e-6)


def test_energy_is_the_work_of_the_actuators(flight):
    _law, run = flight
    kinetic = run.energy.kinetic_body
    largest = np.max(np.abs(kinetic))
    assert np.all(run.energy.kinetic_fluid == 0)
    for name in ("wake_power", "nose_power", "drag_power"):
        assert np.all(getattr(run.energy, name) == 0)
    assert run.energy.residual == pytest.approx(0, abs=TOLERANCE * largest)
    assert np.ptp(kinetic) > 0.01 * largest  # it is not trivially constant
