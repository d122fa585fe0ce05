"""Convergence (model identity 7): the order in time, spectral in space, and the presets' accuracy."""

import numpy as np
import pytest
from cases import falling_law, random_law, random_twist
from library_state import DENSE, Accuracy, Body, Scene, distance, simulate, snapshot

STATIONS = (0.1, 0.3, 0.5, 0.75, 0.9)
QUANTITIES = ("position", "twist", "torque", "force")


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


def test_order_in_time():
    """Four, within 0.2, for the pose, the twist and the internal wrench, without cross-flow drag (kinks of V|V|).

    The falling gait to 2.5 s: steps end at the corners of its ramps. From 0.02 to 0.005 s; finer is round-off.
    """
    settings = {"resistive": False}
    exact, steps = fixed_step(0.001, settings), (0.02, 0.01, 0.005)
    runs = [fixed_step(step, settings) for step in steps]
    for name in QUANTITIES:
        errors = [np.linalg.norm(getattr(run, name)[-1] - getattr(exact, name)[-1]) for run in runs]
        slope = np.polyfit(np.log(steps), np.log(errors), 1)[0]
        assert slope == pytest.approx(4.0, abs=0.2), name
    residuals = [abs(run.energy.residual[-1]) for run in runs[:2]]
    assert np.log2(residuals[0] / residuals[1]) == pytest.approx(4.0, abs=0.3)


def test_friction_alone_keeps_the_order():
    """Laminar friction goes like |V1|^(1/2) V1 and V1 < 0 all along: smooth. Planar, fast start; the ledger too."""
    scene = {"friction": "laminar", "reactive": True, "nose": True}
    exact = fixed_step(0.001, scene, duration=1.0)
    errors = [
        np.linalg.norm(fixed_step(step, scene, duration=1.0).position[-1] - exact.position[-1]) for step in (0.02, 0.01)
    ]
    assert errors[0] < 1e-6
    assert errors[1] < errors[0] / 4  # between the orders 2 and 4: cross flow changes sign along the body


@pytest.mark.parametrize("seed", range(3))
def test_spectral_in_space(seed):
    """One evaluation without drag: 4 more digits for each doubling, to round-off at some 100 nodes."""
    rng = np.random.default_rng(seed)
    law, twist, settings = random_law(rng, spline=False), random_twist(rng), {"resistive": False}
    exact = snapshot(Body.boyer2010(), law, 0.7, twist, settings=settings, stations=STATIONS, accuracy=DENSE)
    for resolution, bound in ((10.0, 1e-3), (20.0, 1e-4), (40.0, 1e-7), (100.0, 1e-11)):
        accuracy = Accuracy(name="trial", resolution=resolution)
        got = snapshot(Body.boyer2010(), law, 0.7, twist, settings=settings, stations=STATIONS, accuracy=accuracy)
        for name in ("head_acceleration", "torque", "force", "backbone"):
            assert distance(getattr(got, name), getattr(exact, name)) < bound, (name, resolution)


def test_kinks_of_drag_cap_the_order_in_space():
    """With V|V| the error falls like a power of the nodes: measured between the second and the third."""
    rng = np.random.default_rng(1)
    law, twist, settings = random_law(rng, spline=False), random_twist(rng), {"friction": "laminar"}
    exact = snapshot(Body.boyer2010(), law, 0.7, twist, settings=settings, stations=STATIONS, accuracy=DENSE)
    for resolution, bound in ((20.0, 1e-4), (80.0, 3e-6), (160.0, 1e-7)):
        accuracy = Accuracy(name="trial", resolution=resolution)
        got = snapshot(Body.boyer2010(), law, 0.7, twist, settings=settings, stations=STATIONS, accuracy=accuracy)
        assert distance(got.torque, exact.torque) < bound


@pytest.mark.parametrize(
    "preset, position, torque", [("draft", 1e-2, 3e-2), ("standard", 1e-4, 2e-3), ("fine", 3e-6, 2e-4)]
)
def test_presets_on_the_falling_gait(preset, position, torque):
    """10 s with all physics on: the presets' target for the head's path; what the torque reaches of its maximum."""
    options = {"duration": 10.0, "sample_period": 0.1}
    exact = simulate(falling_law(), accuracy=DENSE, **options)
    run = simulate(falling_law(), accuracy=preset, **options)
    path = np.sum(np.linalg.norm(np.diff(exact.position, axis=0), axis=1))
    assert distance(run.position[-1], exact.position[-1], max(path, 1.0)) < position
    assert distance(run.torque, exact.torque) < torque
