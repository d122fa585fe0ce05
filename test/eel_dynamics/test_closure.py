"""Closure of the internal wrench (model identity 2), its boundary conditions, and the acceleration as a derivative."""

import numpy as np
import pytest
from cases import FALLING_BREAKS, falling_law, kern_body, random_law, random_twist
from library_state import Body, Scene, Simulation, library_body, rotation, simulate, snapshot
from reference import boyer_body

BODIES = {"boyer": boyer_body(), "kern": kern_body()}
SCENES = [
    {},
    {"resistive": False},
    {"reactive": False},
    {"nose": False},
    {"tail_pressure": "distributed"},
    {"current": (0.1, 0.2, 0.3)},
    {"added_mass": "printed"},
]
ROUND_OFF = 1e-12  # against the greatest torque, or force, along the body


@pytest.mark.parametrize("settings", SCENES, ids=str)
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("accuracy", ["draft", "reference"])
def test_closure_at_the_nose_and_condition_at_the_tail(body, settings, accuracy):
    rng = np.random.default_rng(SCENES.index(settings))
    got = snapshot(
        library_body(BODIES[body]), random_law(rng), 0.7, random_twist(rng), settings=settings, accuracy=accuracy
    )
    torque, force = np.abs(got.torque).max(), np.abs(got.force).max()
    assert abs(got.closure_torque) < ROUND_OFF * torque
    assert abs(got.closure_force) < ROUND_OFF * force
    # nose: no torque, and the reaction of the nose's load
    assert got.torque[0] == pytest.approx(0, abs=ROUND_OFF * torque)
    assert got.force[0] == pytest.approx(-got.nose_force, abs=ROUND_OFF * force)
    # tail: the pressure of the water behind, and nothing else
    assert got.torque[-1] == pytest.approx(0, abs=ROUND_OFF * torque)
    assert got.force[-1] == pytest.approx(got.tail_force, abs=ROUND_OFF * force)
    if settings.get("tail_pressure") == "distributed":
        assert np.all(got.tail_force == 0)


def test_closure_at_every_published_instant():
    simulation = Simulation(body=Body.boyer2010(), scene=Scene(), accuracy="standard", stations=31)
    simulation.adopt(falling_law())
    for time in np.linspace(0.1, 3.0, 30):
        simulation.advance(time)
        got = simulation.observe()
        assert abs(got.closure_torque) < ROUND_OFF * np.abs(got.torque).max()
        assert abs(got.closure_force) < ROUND_OFF * np.abs(got.force).max()


@pytest.mark.parametrize("settings, tolerance", [({"resistive": False}, 1e-7), ({"friction": "laminar"}, 1e-5)])
def test_acceleration_is_the_derivative_of_the_marched_twist(settings, tolerance):
    """Closure follows from how the acceleration was solved; that it moves the head is checked here.

    Difference quotient of order 6 at 0.005 s of the march's samples: (2 pi)^7 h^6 / 140 = 4e-11 for the gait's first
    harmonic, 100 times that for its third; the march's dense output adds some 1e-9. Drag has kinks in time where V2
    changes sign somewhere along the body. Left out: the three samples about each corner of the law's ramps.
    """
    step = 0.005
    run = simulate(falling_law(), duration=3.0, scene=Scene(**settings), accuracy="reference", sample_period=step)
    w = run.twist
    true = run.head_acceleration.copy()  # of the velocity as a vector; its components turn with the head
    true[:, 3:] -= np.cross(w[:, :3], w[:, 3:])
    slope = (-w[:-6] + 9 * w[1:-5] - 45 * w[2:-4] + 45 * w[4:-2] - 9 * w[5:-1] + w[6:]) / (60 * step)
    smooth = np.all(np.abs(run.time[3:-3, None] - FALLING_BREAKS) > 3.5 * step, axis=1)
    error = np.abs(slope - true[3:-3])[smooth].max(axis=0)
    assert np.all(error < tolerance * np.abs(true).max(axis=0))


def test_twist_is_the_derivative_of_the_marched_pose():
    step = 0.01
    run = simulate(
        falling_law(), duration=2.0, scene=Scene(current=(0.1, 0.0, 0.2)), accuracy="fine", sample_period=step
    )
    p, q = run.position, run.orientation
    velocity = (p[:-4] - 8 * p[1:-3] + 8 * p[3:-1] - p[4:]) / (12 * step)
    q_rate = (q[:-4] - 8 * q[1:-3] + 8 * q[3:-1] - q[4:]) / (12 * step)
    for k in range(len(velocity)):
        world, (x, y, z, w), rate = rotation(q[k + 2]), q[k + 2], q_rate[k]
        turn = 2 * np.array([[w, z, -y, -x], [-z, w, x, -y], [y, -x, w, -z]]) @ rate
        assert world.T @ velocity[k] == pytest.approx(run.twist[k + 2, 3:], abs=2e-4)
        assert turn == pytest.approx(run.twist[k + 2, :3], abs=2e-3)
