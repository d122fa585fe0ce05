"""Pressure at the tail, lumped or distributed: same head motion and torque, N1 larger by T_f(X)."""

import numpy as np
import pytest
from cases import falling_law, random_law, random_twist
from library_state import Body, Reference, Scene, reference_scene, simulate, snapshot
from reference import boyer_body


@pytest.mark.parametrize("seed", range(3))
def test_wrench(seed):
    rng = np.random.default_rng(seed)
    law, twist = random_law(rng, spline=False), random_twist(rng)
    lumped, distributed = (
        snapshot(Body.boyer2010(), law, 0.5, twist, settings={"tail_pressure": choice})
        for choice in ("lumped", "distributed")
    )
    assert np.allclose(lumped.head_acceleration, distributed.head_acceleration, rtol=1e-12, atol=1e-12)
    assert np.allclose(lumped.torque, distributed.torque, rtol=0, atol=1e-13 * np.abs(lumped.torque).max())
    reference = Reference(boyer_body(), reference_scene())
    eta = reference.twists(*law.curvature(0.5, reference.space.x)[:2], twist)
    energy = reference.space.evaluate(np.sum(reference.inertia_fluid * eta**2, axis=1) / 2, lumped.x)
    difference = distributed.force - lumped.force
    assert np.allclose(difference[:, 0], energy, rtol=0, atol=1e-10 * energy.max())
    assert np.allclose(difference[:, 1:], 0, atol=1e-13 * np.abs(lumped.force).max())


def test_head_motion():
    runs = [
        simulate(falling_law(), duration=2.0, scene=Scene(tail_pressure=choice), sample_period=0.2)
        for choice in ("lumped", "distributed")
    ]
    assert np.array_equal(runs[0].position, runs[1].position)
    assert np.array_equal(runs[0].twist, runs[1].twist)
