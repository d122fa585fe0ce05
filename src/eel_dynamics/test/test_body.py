# SPDX-License-Identifier: Apache-2.0
"""Bodies: mass and volume as printed, section data of ellipses, added mass by pushing the body."""

import numpy as np
import pytest
from cases import kern_body
from draws import few, numbers
from eel_dynamics.model.section_data import sections_of
from hypothesis import given
from library_state import Body, Scene, hydrodynamic_wrench, momentum
from reference import boyer_body

from eel_gaits import Law

pytestmark = pytest.mark.identity("Bodies")
X = np.linspace(0.0, 1.0, 1001)


def test_mass_of_the_robot(measured):
    """1.94 kg, as printed in section 7.2.1, within 0.3 %."""
    measured("mass of the paper's robot", Body.boyer2010().mass, 0.003 * 1.94, wanted=1.94, unit="kg")


def test_volume_of_the_kern_body(measured):
    """Kern and Koumoutsakos 2006 print 0.0059326 L^3: half of the last digit."""
    body = Body.kern2006(2.0)
    measured("volume of the Kern-Koumoutsakos body of 1 m", 1e3 * body.volume / 8.0, 5e-5, wanted=5.9326, unit="l")


@pytest.mark.parametrize(
    "ours, theirs", [(Body.boyer2010(), boyer_body()), (Body.kern2006(), kern_body())], ids=["boyer2010", "kern2006"]
)
def test_half_axes_from_the_printed_formulae(measured, ours, theirs):
    apart = ours.half_width(X) - theirs.half_width(X), ours.half_height(X) - theirs.half_height(X)
    measured("half-axes, against formulae typed from the papers a second time", np.abs(apart), 1e-15, unit="m")


def test_added_mass_of_the_robot(measured):
    """Pushed sideways with 1 m/s^2: 4.998 kg of water, 0.822 kg with eq. (37) as printed."""
    for choice, wanted in (("corrected", 4.998), ("printed", 0.822)):
        scene = Scene(resistive=False, nose=False, added_mass=choice)
        wrench = hydrodynamic_wrench(Body.boyer2010(), Law(), 0.0, np.zeros(6), np.eye(6)[4], scene)
        measured(f"lateral added mass of the robot, {choice}", -wrench.force[1], 5e-4, wanted=wanted, unit="kg")


def test_perimeter_of_a_circle():
    """Blasius' friction on a body of revolution: 1/2 rho 0.664 sqrt(nu / (|V1| X)) |V1| V1 on 2 pi r; in print half."""
    body = Body(length=1.0, half_height=lambda x: 0.1 * np.sqrt(x), half_width=lambda x: 0.1 * np.sqrt(x))
    x = np.linspace(0.1, 1.0, 10)
    wanted = 500.0 * 0.664 * np.sqrt(1e-6 / x) * 2.0 * np.pi * 0.1 * np.sqrt(x)
    for choice, share in (("ellipse", 1.0), ("printed", 0.5)):
        got = sections_of(body, Scene(perimeter=choice), x).laminar
        np.testing.assert_allclose(got, share * wanted, rtol=1e-12)


@few(15)
@given(numbers(0.01, 0.1), numbers(0.01, 0.1), numbers(0.02, 0.3), numbers(0.3, 3.0), numbers(300.0, 2000.0))
def test_ellipses_in_closed_form(measured, a, b, cap, length, density):
    """An elliptic cylinder with a round cap over `cap` of its length: rho pi a^2, rho pi b^2 and rho pi/8 (a^2 - b^2)^2
    of water per length (Lamb; Newman, Marine Hydrodynamics, table 4.3), and the body's own mass and inertia.

    The cap's half-axes go with sqrt(2 u - u^2): the integrals of its square and fourth power are 2/3 and 8/15.
    """

    def profile(size):
        return lambda x: size * np.sqrt(1.0 - np.maximum(0.0, 1.0 - np.asarray(x, float) / (cap * length)) ** 2)

    body = Body(
        length=length,
        half_height=profile(a),
        half_width=profile(b),
        kinks=(cap * length,),
        density=density,
    )
    square, fourth = length * (1 - cap / 3), length * (1 - 7 * cap / 15)
    water = np.array([np.pi / 8 * (a**2 - b**2) ** 2 * fourth, np.pi * a**2 * square, np.pi * b**2 * square]) * 1000
    scene = Scene(resistive=False, nose=False)
    push = lambda k: -hydrodynamic_wrench(body, Law(), 0.0, np.zeros(6), np.eye(6)[k], scene).total[k]  # noqa: E731
    got = np.array([push(k) for k in (0, 4, 5)])
    apart = np.abs(got - water) / np.maximum(water, 1e-6)
    measured("added mass across and about an ellipse's axes", apart, 1e-12)
    mass, roll = density * np.pi * a * b * square, density * np.pi * a * b * (a**2 + b**2) / 4 * fourth
    dry = {"reactive": False, "resistive": False}
    pushed = [momentum(body, Law(), 0.0, np.eye(6)[k], dry)[k] for k in (0, 3)]
    measured("mass and roll inertia of elliptic sections", np.abs(pushed / np.array([roll, mass]) - 1), 1e-12)
    measured("mass of a body of elliptic sections", abs(body.mass / mass - 1), 1e-12)
