# SPDX-License-Identifier: Apache-2.0
"""Captions of pictures say what is drawn: sides, colours, units."""

import numpy as np
import pytest
from eel_common.cell import BLUE as BLUE_OF_CELLS
from eel_studies.optimisation.front import PHASES, Front, draw_front
from eel_studies.pictures import BLUE
from eel_studies.varied import labelled
from matplotlib.figure import Figure

from eel_dynamics import simulate
from eel_gaits import gait


@pytest.mark.parametrize("name, ahead", [("straight", 1.0), ("backward", -1.0)])
@pytest.mark.filterwarnings("ignore::eel_dynamics.Unsettled")
def test_gaits_of_a_front_swim_to_the_side_that_the_caption_says(name, ahead):
    """Whichever end leads."""
    run = simulate(gait(name), 6.0, accuracy=1e-2, estimate=False)
    one, row = np.ones(1), np.ones((1, 1))
    front = Front(
        "cost_of_transport", ("period",), 0.5 * one, 2.0 * one, one, row, one, one, (run,), row[:, [0, 0]], ()
    )
    figure = Figure()
    draw_front(figure, front)
    (caption,) = [each.get_supxlabel() for each in figure.subfigs if each.get_supxlabel()]
    assert "ahead is to the right" in caption and "seen from above" in caption
    (gaits,) = [axes for axes in figure.axes if len(axes.lines) == PHASES]
    for line in gaits.lines:
        x = line.get_xdata()
        assert ahead * (x[0] - x[-1]) > 0.5  # from the nose to the tail


def test_blue_is_one_colour():
    assert BLUE == BLUE_OF_CELLS


@pytest.mark.parametrize(
    "name, label",
    [
        ("fins.area", "fins.area [m^2]"),
        ("torque_limit", "torque_limit [N m]"),
        ("bending_stiffness", "bending_stiffness [N m^2]"),
        ("series_stiffness", "series_stiffness [N m/rad]"),
        ("period", "period [s]"),
        ("scene.viscosity", "scene.viscosity [m^2/s]"),
        ("fins.aspect_ratio", "fins.aspect_ratio"),
        ("robot.damping", "robot.damping"),  # of joints and of tails, in two units
        ("density_ratio", "density_ratio"),
        ("spin", "spin [turns/s]"),
        ("initial.v_x", "initial.v_x [m/s]"),
        ("initial.omega_z", "initial.omega_z [rad/s]"),
        ("flow.circulation", "flow.circulation [m^2/s]"),
        ("body.centre_of_mass_offset", "body.centre_of_mass_offset [m]"),
    ],
)
def test_an_axis_has_the_unit_of_its_number(name, label):
    assert labelled(name) == label
