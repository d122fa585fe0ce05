# SPDX-License-Identifier: Apache-2.0
"""Bodies from data: their splines break at each data point, within the panels, and cost no more than smooth bodies."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
from eel_dynamics.model.body.grid import Grid
from eel_dynamics.model.body.panels import panels_of
from eel_dynamics.model.section_data import sections_of, sections_on
from eel_dynamics.runs.companion import relative_errors
from random_bodies import drawn_body, drawn_law, with_kinks_at_data

import eel_core
from eel_dynamics import Accuracy, Body, Scene, Simulation, simulate
from eel_gaits import straight


def sampled(x, width=0.03, height=0.04) -> Body:
    """A spindle of 1 m, known at `x` [m] alone."""
    profile = np.sqrt(1.0 - np.exp(-20.0 * np.asarray(x))) * (1.0 - 0.6 * np.asarray(x))
    return Body(x=x, half_width=width * profile, half_height=height * profile)


def silently(*arguments, **options):
    """The run of `simulate`. Any warning is an error."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return simulate(*arguments, **options)


def exactly(law, duration: float, body: Body, scene: Scene | None = None):
    """A run without an estimate whose panels end at the data points, of a much finer accuracy."""
    finest = replace(Accuracy.of(1e-7).in_scene(scene or Scene()), target=None, resolution=60.0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return simulate(law, duration, body=body, scene=scene, accuracy=finest)


def cost_of(run) -> int:
    return run.evaluations * run.nodes + run.error_estimate.cost


def costs_of_drawn_bodies(bodies: int, seed: int, targets) -> np.ndarray:
    """Costs (bodies, targets) by those of the smooth bodies. No run warns, and each keeps its target."""
    costs = np.empty((bodies, len(targets)))
    for number in range(bodies):
        rng = np.random.default_rng([seed, number])
        body = drawn_body(rng)
        law = drawn_law(rng, body.data.length)
        duration = 2.5 * law.terms[0].period
        exact = exactly(law, duration, body.cut)
        for column, target in enumerate(targets):
            run = silently(law, duration, body=body.data, accuracy=target)
            assert relative_errors(run, exact).worst <= target
            costs[number, column] = cost_of(run) / cost_of(simulate(law, duration, body=body.smooth, accuracy=target))
    return costs


def test_bodies_from_data_keep_their_targets_at_the_cost_of_smooth_ones():
    costs = costs_of_drawn_bodies(6, 1, (1e-2, 1e-4))
    assert np.median(costs) < 1.2


@pytest.mark.soak
def test_sixty_bodies_from_data_keep_three_targets_at_the_cost_of_smooth_ones():
    costs = costs_of_drawn_bodies(60, 2, (1e-2, 1e-3, 1e-4))
    assert np.median(costs) < 1.1
    assert np.mean(costs > 1.5) < 0.1  # the runs that are swum a second time, as some of smooth bodies are


def test_sections_of_data_have_the_moments_of_their_spline():
    body = drawn_body(np.random.default_rng(1005)).data
    coarse, x = Grid.of(panels_of(body, 12.0)), body.half_axes["half_width"][0]
    cut = with_kinks_at_data(body)
    fine = Grid.of(panels_of(cut, 400.0))
    got, wanted = sections_on(body, Scene(), coarse), sections_of(cut, Scene(), fine.x)
    assert len(x) > 30 > len(coarse.x)
    for power in range(5):
        for name in ("mass", "added2", "inertia3", "drag2", "laminar"):
            ours = coarse.weight @ (getattr(got, name) * (coarse.x / body.length) ** power)
            theirs = fine.weight @ (getattr(wanted, name) * (fine.x / body.length) ** power)
            assert ours == pytest.approx(theirs, rel=1e-9), (name, power)
    assert got.added2[-1] == sections_of(body, Scene(), coarse.x).added2[-1]  # what is left to the wake


def test_the_mass_is_that_of_the_spline():
    body = drawn_body(np.random.default_rng(1005)).data
    fine = Grid.of(panels_of(with_kinks_at_data(body), 400.0))
    volume = fine.weight @ (np.pi * body.half_width(fine.x) * body.half_height(fine.x))
    assert body.mass == pytest.approx(body.density * volume, rel=1e-10)
    assert simulate(straight(), 0.1, body=body).body_mass == pytest.approx(body.mass, rel=1e-12)


@pytest.mark.parametrize("scene", [Scene(resistive=False), Scene(metacentric_height=0.01), Scene(friction="blended")])
def test_torque_within_a_panel_is_that_of_the_spline(scene):
    """Sixteen points per length and 37 data points: the noise of the data is finer than the nodes."""
    rng = np.random.default_rng(1005)
    body = drawn_body(rng)
    law = drawn_law(rng, body.data.length)
    plain = Accuracy(name="plain", resolution=16.0, tolerance=1e-8)
    run = simulate(law, 2.0, body=body.data, scene=scene, accuracy=plain)
    assert relative_errors(run, exactly(law, 2.0, body.cut, scene)).torque < 1e-4


@pytest.mark.parametrize("seed, pointed", [(1005, False), (1020, True)])
def test_drag_between_kinks_is_that_of_the_spline(seed, pointed):
    body, law = drawn_body(np.random.default_rng(seed)).data, straight()
    assert body.pointed_tail is pointed

    def drags(body, resolution):
        accuracy = Accuracy(name="plain", resolution=resolution)
        simulation = Simulation(body=body, accuracy=accuracy, law=law)
        instant = eel_core.Instant(simulation.discretisation.swimmer)
        size = np.array([0.0, 0.0, 1.0, body.length, body.length, 0.0])
        twists = [size * [0, 0, 0.2 * np.sin(7 * t), 0.3, -0.1 * np.sin(3 * t), 0] for t in np.arange(0.5, 3.0, 0.05)]
        return np.array([instant.loads(simulation.law_on_grid, 1.0, twist)[1] for twist in twists])

    wanted = drags(with_kinks_at_data(body), 100.0)
    assert np.abs(drags(body, 32.0) - wanted).max() < 1e-6 * np.abs(wanted).max()


STEP = np.sort(np.concatenate((np.linspace(0.0, 1.0, 20), [0.5 - 1e-6, 0.5 + 1e-6])))
WITH_STEP = Body(x=STEP, half_width=np.where(STEP < 0.5, 0.04, 0.02) * (STEP > 0), half_height=0.04 * (STEP > 0))
WAIST = np.array([0.0, 0.03, 0.04, 0.04, 1e-4, 0.03, 0.01])
UNUSUAL = {
    "four points": sampled([0.0, 0.3, 0.6, 1.0]),
    "equal widths": Body(x=np.linspace(0, 1, 9), half_width=0.02 * (np.arange(9) > 0), half_height=[0] + [0.03] * 8),
    "a step in width": WITH_STEP,
    "a waist of 0.1 mm": Body(x=np.linspace(0.0, 1.0, 7), half_width=WAIST, half_height=WAIST),
    "points that nearly meet": sampled([0.0, 1e-9, 1e-8, 0.5, 1.0]),
}


@pytest.mark.parametrize("body", UNUSUAL.values(), ids=UNUSUAL)
def test_unusual_bodies_keep_their_target(body):
    run = silently(straight(), 2.0, body=body, accuracy=1e-3)
    assert relative_errors(run, exactly(straight(), 2.0, with_kinks_at_data(body))).worst <= 1e-3


def test_ten_thousand_points_need_no_more_nodes_than_forty():
    many, few = (silently(straight(), 2.0, body=sampled(np.linspace(0, 1, n)), accuracy=1e-3) for n in (10_000, 40))
    assert many.nodes == few.nodes
    assert relative_errors(many, few).worst < 1e-2  # the few points are another body


@pytest.mark.parametrize(
    "x, message",
    [
        ([0.0, 0.5, 1.0], "body x must rise from 0 over 4 points or more, got 3 points from 0 to 1$"),
        ([0.0, 0.3, 0.3, 0.6, 1.0], "got 5 points from 0 to 1, 0.3 after 0.3$"),
        ([0.0] * 5, "got 5 points from 0 to 0, 0 after 0$"),
    ],
)
def test_points_that_make_no_body_are_refused(x, message):
    with pytest.raises(ValueError, match=message):
        sampled(x)
