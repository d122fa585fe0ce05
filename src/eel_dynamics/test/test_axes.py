# SPDX-License-Identifier: Apache-2.0
"""World and head have REP-103 axes, section quantities the paper's section axes: one swim in both, and in the world."""

import numpy as np
import pytest
from eel_common.attitude import world_from_body
from eel_dynamics.analysis.settling import Unsettled
from library_state import rotation
from scipy.interpolate import make_interp_spline

from eel_dynamics import Scene, simulate
from eel_gaits import falling

PLACE = np.linspace(0.0, 1.0, 161)  # X = PLACE^2 for a body of 1 m: closer at the round nose
SECTION = np.array([-1.0, -1.0, 1.0])  # section axes are -x, -y, z of a section turned as the head
VECTORS = ("position", "center_of_mass", "backbone")


@pytest.fixture(scope="module")
def run():
    """The falling gait in a current that crosses it, from a pose that is turned about all axes."""
    return simulate(
        falling(),
        2.5,
        scene=Scene(friction="laminar", current=(-0.1, 0.05, 0.02)),
        orientation=(0.1, -0.2, 0.3, np.sqrt(0.86)),
        position=(1.0, 2.0, 3.0),
        twist=(0.2, 0.1, 0.3, 0.2, 0.1, -0.1),
        accuracy="fine",
        sample_period=0.01,
        stations=PLACE**2,
        load=True,
        estimate=False,
    )


def smooth(run):
    """The samples away from both ends of the run and from the corners of the gait's ramps."""
    return np.all(np.abs(run.time[:, None] - (0.0, 1.0, 2.0, run.time[-1])) > 0.095, axis=1)


def rate(run, values):
    """The rate of `values` (T, ...) by a spline of order 6."""
    return make_interp_spline(run.time, values, k=5).derivative()(run.time)


def along(values):
    """The integral of `values` (T, M, 3) over X, from the nose to each station."""
    return make_interp_spline(PLACE, values * (2.0 * PLACE)[:, None], k=5, axis=1).antiderivative()(PLACE)


def in_world(run, vectors, stations=slice(None)):
    """Vectors (T, M, 3) of section axes in the world, by the orientations of the sections."""
    return np.einsum("tmij,tmj->tmi", world_from_body(run.section_orientation[:, stations]), vectors * SECTION)


def test_forces_turned_into_the_world_close_the_balance_of_momentum(run):
    """Of the whole body, and of the part ahead of each section. Splines through samples 10 ms apart: 1e-4."""
    load, force = in_world(run, run.fluid_force), in_world(run, run.force)
    nose, tail = (in_world(run, each[:, None], [k])[:, 0] for each, k in ((run.nose_force, 0), (run.tail_force, -1)))
    inside, scale = smooth(run), np.abs(force).max()
    whole = run.body_mass * rate(run, rate(run, run.center_of_mass)) - along(load)[:, -1] - nose - tail
    assert np.abs(whole[inside]).max() < 1e-4 * scale
    mass = run.body_mass / run.body.volume * np.pi * run.body.half_width(run.x) * run.body.half_height(run.x)
    ahead = along(mass[:, None] * rate(run, rate(run, run.backbone)) - load) - nose[:, None]
    assert np.abs(force - ahead)[inside].max() < 1e-4 * scale
    assert np.allclose(run.force_world, force, rtol=0, atol=1e-14 * scale)


def test_torque_in_the_world_balances_its_force_where_no_water_is():
    """Of the part ahead of each section: the rate of its angular momentum about the origin of the world."""
    run = simulate(
        falling(),
        2.5,
        scene=Scene(reactive=False, resistive=False, nose=False),
        orientation=(0.1, -0.2, 0.3, np.sqrt(0.86)),
        accuracy="reference",
        sample_period=0.01,
        stations=PLACE**2,
        estimate=False,
    )
    a, b = run.body.half_width(run.x), run.body.half_height(run.x)
    mass = run.body_mass / run.body.volume * np.pi * a * b
    turn = world_from_body(run.section_orientation)
    spin = np.einsum("tmji,tmjk->tmik", turn, rate(run, turn))
    spin = np.stack([spin[..., 2, 1], spin[..., 0, 2], spin[..., 1, 0]], axis=-1)
    inertia = 0.25 * mass[:, None] * np.stack([a**2 + b**2, b**2, a**2], axis=-1)
    momentum = mass[:, None] * np.cross(run.backbone, rate(run, run.backbone))
    momentum += np.einsum("tmij,tmj->tmi", turn, inertia * spin)
    ahead = along(rate(run, momentum)) - np.cross(run.backbone, run.force_world)
    assert np.abs(run.torque_world - ahead)[smooth(run)].max() < 1e-4 * np.abs(run.torque_world).max()


def test_the_paper_s_axes_are_half_a_turn_away_and_back(run):
    paper = run.in_axes("paper")
    assert (
        (run.axes, paper.axes) == ("rep103", "paper")
        and paper.in_axes("rep103") == run
        and run.in_axes("rep103") is run
    )
    turn = np.diag([-1.0, -1.0, 1.0])
    for name in VECTORS:
        assert np.array_equal(getattr(paper, name), getattr(run, name) @ turn)
    assert np.array_equal(paper.twist, run.twist * np.tile([-1.0, -1.0, 1.0], 2))
    assert np.allclose(rotation(paper.orientation[-1]), turn @ rotation(run.orientation[-1]) @ turn, rtol=0, atol=1e-15)
    assert paper.scene.current == (0.1, -0.05, 0.02)
    assert np.array_equal(paper.torque, run.torque) and np.array_equal(paper.curvature, run.curvature)
    assert np.array_equal(paper.force_world, run.force_world @ turn)
    for words in ("REP", 3, None):
        with pytest.raises(ValueError, match="axes must be rep103 or paper, got"):
            run.in_axes(words)


def test_a_run_in_the_paper_s_axes_has_the_same_figures():
    run = simulate(falling(), 2.0, scene=Scene(current=(-0.2, 0.1, 0.0)), stations=11)
    paper = run.in_axes("paper")
    with pytest.warns(Unsettled):
        assert paper.mean_speed == pytest.approx(run.mean_speed)
        assert paper.analysis().friction_power == run.analysis().friction_power
    assert paper.warnings == run.warnings and paper.refined == run.refined.in_axes("paper")
    assert paper.greatest_torque() == run.greatest_torque()
    assert paper.actuators(4).table() == run.actuators(4).table()


def test_a_run_without_the_wrench_has_no_torque_in_the_world():
    bare = simulate(falling(), 0.1, scene=Scene(internal_wrench=False, ledger=False), estimate=False)
    with pytest.raises(ValueError, match="torque_world needs a run with scene internal_wrench on"):
        _ = bare.torque_world
