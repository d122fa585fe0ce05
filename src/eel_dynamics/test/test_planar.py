# SPDX-License-Identifier: Apache-2.0
"""The planar kernel: the same motion as the three-dimensional one, with one angle in place of a rotation."""

import numpy as np
import pytest

from eel_dynamics import Accuracy, Body, Scene, simulate
from eel_gaits import Law, Ramp, Term, straight, turning

# Both take the same steps. They differ in the rates of the shape: integrals of Kdot along the nodes in three
# dimensions, tabulated rows in the plane; both are exact to round-off with this many points.
FINE = Accuracy(name="test", resolution=60.0, step=0.02)
START = {"orientation": (0.0, 0.0, np.sin(0.7), np.cos(0.7)), "twist": (0.0, 0.0, 0.3, -0.2, 0.1, 0.0)}
SCENES = [
    {},
    {"friction": "blended", "current": (0.1, -0.2, 0.0)},
    {"resistive": False},
    {"reactive": False},
    {"wake": False},
    {"nose": False, "density": 300.0},
]


@pytest.mark.parametrize("switches", SCENES, ids=str)
@pytest.mark.parametrize("law", [straight(), turning(), Law(Term(amplitude=(8.0,), wavelength=0.7, period=0.5))])
def test_same_motion_as_in_three_dimensions(law, switches):
    whole = simulate(law, 2.0, scene=Scene(**switches), accuracy=FINE, **START)
    plane = simulate(law, 2.0, scene=Scene(planar=True, **switches), accuracy=FINE, **START)
    for name in ("position", "orientation", "twist", "torque", "force"):
        ours, theirs = getattr(plane, name), getattr(whole, name)
        assert np.abs(ours - theirs).max() <= 1e-10 * max(1.0, np.abs(theirs).max()), name
    assert np.all(plane.position[:, 2] == 0.0)
    assert np.abs(plane.energy.residual - whole.energy.residual).max() <= 1e-9 * np.abs(whole.energy.kinetic_body).max()


def test_a_blend_and_a_second_body():
    law = Law(Term(amplitude=(3.0,), wavelength=-1.5, period=0.8, envelope=(Ramp(0.1, 0.6, 1.0),)))
    runs = [
        simulate(law, 1.5, body=Body.kern2006(2.0), scene=Scene(planar=planar, fluid_density=800.0), accuracy=FINE)
        for planar in (False, True)
    ]
    assert np.abs(runs[0].backbone - runs[1].backbone).max() <= 1e-10
