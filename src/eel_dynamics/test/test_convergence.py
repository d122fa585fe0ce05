# SPDX-License-Identifier: Apache-2.0
"""Convergence: the order in time, spectral in space, and the presets' accuracy."""

import numpy as np
import pytest
from cases import falling_law, random_law, random_twist
from eel_dynamics.model.body.panels import panels_of
from library_state import DENSE, Accuracy, Body, Scene, distance, simulate, snapshot

from eel_gaits import falling

STATIONS = (0.1, 0.3, 0.5, 0.75, 0.9)
QUANTITIES = ("position", "orientation", "twist", "torque", "force")
pytestmark = pytest.mark.identity("Convergence")


def fixed_step(step, settings, resolution=60.0, duration=2.5):
    """The end of a run by the classical Runge-Kutta method."""
    accuracy = Accuracy(name="fixed", resolution=resolution, step=step)
    scene = Scene(**settings)
    return simulate(
        falling_law(),
        duration=duration,
        scene=scene,
        accuracy=accuracy,
        sample_period=duration,
        stations=STATIONS,
    )


def errors_of(runs, exact):
    """(runs, quantities): relative errors of pose, twist and internal wrench at the end."""
    ends = [[getattr(run, name)[-1] for name in QUANTITIES] for run in (*runs, exact)]
    apart = [[np.linalg.norm(got - wanted) for got, wanted in zip(end, ends[-1], strict=True)] for end in ends[:-1]]
    return np.array(apart) / [np.linalg.norm(wanted) for wanted in ends[-1]]


def slopes(sizes, errors):
    return np.polyfit(np.log(sizes), np.log(errors), 1)[0]


def test_order_in_time(measured):
    """Four, within 0.2, for the pose, the twist and the internal wrench, without cross-flow drag (kinks of V|V|).

    The falling gait to 2.5 s: steps end at the corners of its ramps. From 0.02 to 0.005 s; finer is round-off.
    """
    settings = {"resistive": False}
    exact, steps = fixed_step(0.001, settings), (0.02, 0.01, 0.005)
    runs = [fixed_step(step, settings) for step in steps]
    for name, slope in zip(QUANTITIES, slopes(steps, errors_of(runs, exact)), strict=True):
        measured(f"order in time, classical Runge-Kutta, {name}", slope, 0.2, wanted=4.0)
    residuals = [abs(run.energy.residual[-1]) for run in runs[:2]]
    fall = np.log2(residuals[0] / residuals[1])
    measured("order in time, classical Runge-Kutta, residual of the energy ledger", fall, 0.2, wanted=4.0)


def test_chosen_steps_follow_the_tolerance(measured):
    """Dormand and Prince's pair: over seven decades of the tolerance the error goes with it, no drag, falling gait."""
    tolerances = 10.0 ** -np.arange(4, 12)

    def run(tolerance):
        accuracy = Accuracy(name="pair", resolution=60.0, tolerance=tolerance)
        scene = Scene(resistive=False)
        return simulate(falling_law(), 2.5, scene=scene, accuracy=accuracy, sample_period=2.5, stations=STATIONS)

    exact, runs = run(1e-13), [run(tolerance) for tolerance in tolerances]
    for name, slope in zip(QUANTITIES, slopes(tolerances, errors_of(runs, exact)), strict=True):
        measured(f"power of the tolerance that the error goes with, chosen steps, {name}", slope, 0.2, wanted=1.0)
    slope = slopes(tolerances, [abs(run.energy.residual[-1]) for run in runs])
    measured("power of the tolerance that the energy ledger's residual goes with, chosen steps", slope, 0.2, wanted=1.0)


def test_order_in_space(measured, monkeypatch):
    """Six, within 0.2: the Magnus series between nodes, which remains once the panels' polynomials have converged.

    The falling gait with six times its bend, so that this error stands above round-off; no drag, same steps in time. 90
    to 160 points per length, counted where they follow the resolution: the nose's panel has them by a rule of its
    own. Below, panels gain several digits with each point: see `test_spectral_in_space`.
    """
    monkeypatch.setattr("eel_dynamics.model.body.panels.FILLED", 1)  # no nodes beyond those of the resolution
    law, resolutions = falling(pitch_bend=3.0), np.arange(90.0, 165.0, 10.0)

    def run(resolution):
        accuracy = Accuracy(name="space", resolution=resolution, step=0.005)
        scene = Scene(resistive=False)
        return simulate(law, 2.5, scene=scene, accuracy=accuracy, sample_period=2.5, stations=STATIONS)

    nodes = [sum(panel.points for panel in panels_of(Body.boyer2010(), each)[1:]) for each in resolutions]
    errors = errors_of([run(each) for each in resolutions], run(500.0))
    for name, slope in zip(QUANTITIES, -slopes(nodes, errors), strict=True):
        measured(f"order in space, rotations between nodes, {name}", slope, 0.2, wanted=6.0)


def test_orders_with_cross_flow_drag(measured):
    """V|V| has kinks inside panels, where V2 or V3 changes sign: integrated up to them, they cost no order.

    Falling gait, laminar friction, over five halvings in time; in space to where the steps in time show.
    """
    settings = {"friction": "laminar"}
    steps = 0.02 / 2.0 ** np.arange(5)
    errors = errors_of([fixed_step(step, settings) for step in steps], fixed_step(0.0003, settings))
    slope = slopes(steps, errors.max(axis=1))
    measured("order in time with cross-flow drag, worst of pose, twist, wrench", slope, 0.3, wanted=4.0)
    resolutions = 10.0 * 2.0 ** np.arange(4)
    runs = [fixed_step(0.005, settings, resolution=each) for each in resolutions]
    errors = errors_of(runs, fixed_step(0.005, settings, resolution=300.0)).max(axis=1)
    measured("error in space with cross-flow drag, 80 points per length, the same", errors[-1], 1e-6)
    assert np.all(errors[1:] < errors[:-1])


@pytest.mark.parametrize("seed", range(3))
def test_spectral_in_space(measured, seed):
    """One evaluation without drag: 4 more digits for each doubling, to round-off at some 100 nodes."""
    rng = np.random.default_rng(seed)
    law, twist, settings = random_law(rng, spline=False), random_twist(rng), {"resistive": False}
    exact = snapshot(Body.boyer2010(), law, 0.7, twist, settings=settings, stations=STATIONS, accuracy=DENSE)
    for resolution, bound in ((10.0, 1e-3), (20.0, 1e-4), (40.0, 1e-7), (100.0, 1e-11)):
        accuracy = Accuracy(name="trial", resolution=resolution)
        got = snapshot(Body.boyer2010(), law, 0.7, twist, settings=settings, stations=STATIONS, accuracy=accuracy)
        names = "head_acceleration", "torque", "force", "backbone"
        errors = [distance(getattr(got, name), getattr(exact, name)) for name in names]
        measured(f"one evaluation without drag, {resolution:g} points per length", errors, bound)


def test_spectral_in_space_with_drag(measured):
    """One evaluation with V|V|, whose kinks are located."""
    rng = np.random.default_rng(1)
    law, twist, settings = random_law(rng, spline=False), random_twist(rng), {"friction": "laminar"}
    exact = snapshot(Body.boyer2010(), law, 0.7, twist, settings=settings, stations=STATIONS, accuracy=DENSE)
    for resolution, bound in ((20.0, 1e-4), (80.0, 1e-8), (160.0, 1e-11)):
        accuracy = Accuracy(name="trial", resolution=resolution)
        got = snapshot(Body.boyer2010(), law, 0.7, twist, settings=settings, stations=STATIONS, accuracy=accuracy)
        error = distance(got.torque, exact.torque)
        measured(f"torque of one evaluation with drag, {resolution:g} points per length", error, bound)


WHOLE = {"duration": 10.0, "sample_period": 0.1}


@pytest.fixture(scope="module")
def exact():
    return simulate(falling_law(), accuracy=DENSE, **WHOLE)


@pytest.mark.parametrize(
    "preset, position, torque", [("draft", 1e-2, 3e-2), ("standard", 1e-4, 2e-3), ("fine", 3e-6, 2e-4)]
)
def test_presets_on_the_falling_gait(measured, exact, preset, position, torque):
    """10 s with all physics on: the presets' target for the head's path; what the torque reaches of its maximum."""
    run = simulate(falling_law(), accuracy=preset, **WHOLE)
    path = np.sum(np.linalg.norm(np.diff(exact.position, axis=0), axis=1))
    error = distance(run.position[-1], exact.position[-1], max(path, 1.0))
    measured(f"head's position after 10 s, all physics, preset {preset} (relative to the path)", error, position)
    measured(f"torque over X and t, all physics, preset {preset}", distance(run.torque, exact.torque), torque)
