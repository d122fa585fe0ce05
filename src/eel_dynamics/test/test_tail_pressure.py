# SPDX-License-Identifier: Apache-2.0
"""Pressure at the tail, lumped or distributed: same head motion and torque, N1 larger by T_f(X)."""

import numpy as np
import pytest
from cases import falling_law
from draws import few, numbers, scenes, swimmers, twists
from hypothesis import given
from hypothesis import strategies as st
from library_state import (
    Reference,
    Scene,
    distance,
    expected,
    library_body,
    reference_scene,
    simulate,
    snapshot,
)

pytestmark = pytest.mark.identity("Pressure at the tail")


@few(20)
@given(swimmers(), numbers(0.0, 3.0), twists(), st.one_of(scenes(), scenes(drag=True)))
def test_wrench(measured, swimmer, time, twist, settings):
    """Round-off; T_f(X) of the difference comes from the reference: 1e-10 of its greatest value."""
    body, law = swimmer
    lumped, distributed = (
        snapshot(library_body(body), law, time, twist, settings={**settings, "tail_pressure": choice})
        for choice in ("lumped", "distributed")
    )
    measured("head's acceleration", distance(distributed.head_acceleration, lumped.head_acceleration), 1e-13)
    measured("internal torque along the body", distance(distributed.torque, lumped.torque), 1e-12)
    difference, force = distributed.force - lumped.force, np.abs(lumped.force).max()
    measured("internal force across the body", np.abs(difference[:, 1:]) / force, 1e-12)
    reference = Reference(body, reference_scene(**settings), nodes_per_panel=24)
    relative = expected(reference, law, time, twist)[1]
    eta = reference.twists(*law.curvature(time, reference.space.x)[:2], relative)
    energy = reference.space.evaluate(np.sum(reference.inertia_fluid * eta**2, axis=1) / 2, lumped.x)
    measured("N1 along the body: difference against T_f(X)", distance(difference[:, 0], energy, force), 1e-10)


def test_head_motion(measured):
    runs = [
        simulate(falling_law(), duration=2.0, scene=Scene(tail_pressure=choice), sample_period=0.2)
        for choice in ("lumped", "distributed")
    ]
    apart = [np.abs(getattr(runs[0], name) - getattr(runs[1], name)).max() for name in ("position", "twist")]
    measured("head's motion over 2 s of the falling gait, bit by bit", apart, 0.0)
