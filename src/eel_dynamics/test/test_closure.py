# SPDX-License-Identifier: Apache-2.0
"""Closure of the internal wrench, its boundary conditions, and the acceleration as a derivative."""

import numpy as np
import pytest
from cases import FALLING_BREAKS, falling_law
from draws import few, quaternions, scenes, swimmers, twists
from eel_dynamics.model.axes import turn_quaternion
from hypothesis import given
from hypothesis import strategies as st
from library_state import (
    DENSE,
    Accuracy,
    Reference,
    Scene,
    Simulation,
    distance,
    in_paper_axes,
    library_body,
    library_scene,
    reference_scene,
    rotation,
    simulate,
    simulate_in_paper_axes,
    snapshot,
    turn_twist,
)
from reference import E1

pytestmark = pytest.mark.identity("Closure")
ROUND_OFF = 1e-12  # against the greatest torque, or force, along the body at that instant


@few(40)
@given(
    swimmers(),
    twists(),
    st.one_of(scenes(), scenes(drag=True)),
    st.sampled_from(("draft", "standard", "fine", "reference")),
)
def test_closure_at_the_nose_and_condition_at_the_tail(measured, swimmer, twist, settings, accuracy):
    """One instant: what the kernel reports, and what the published profiles say at their two ends."""
    body, law = swimmer
    got = snapshot(library_body(body), law, 0.7, twist, settings=settings, accuracy=accuracy)
    torque, force = np.abs(got.torque).max(), np.abs(got.force).max()
    measured("torque left over at the nose, any swimmer", got.closure_torque / torque, ROUND_OFF)
    measured("force left over at the nose, any swimmer", got.closure_force / force, ROUND_OFF)
    # nose: no torque, and the reaction of the nose's load; tail: the pressure of the water behind, and nothing else
    measured("torque profile at its ends against 0", np.abs(got.torque[[0, -1]]) / torque, ROUND_OFF)
    measured(
        "force profile at the nose against the load there", distance(got.force[0], -got.nose_force, force), ROUND_OFF
    )
    measured(
        "force profile at the tail against its pressure", distance(got.force[-1], got.tail_force, force), ROUND_OFF
    )
    if settings["tail_pressure"] == "distributed":
        assert np.all(got.tail_force == 0)


@few(8)
@given(swimmers(ramps=True), twists(), scenes(drag=True))
def test_closure_at_every_sample_of_a_run(measured, swimmer, twist, settings):
    body, law = swimmer
    run = simulate_in_paper_axes(
        law, 1.5, body=library_body(body), scene=Scene(**settings), twist=twist, sample_period=0.02
    )
    torque, force = (np.abs(field).max(axis=(1, 2)) for field in (run.torque, run.force))
    measured("torque left over at every sample of a run", run.closure_torque / torque, ROUND_OFF)
    measured("force left over at every sample of a run", run.closure_force / force, ROUND_OFF)


def test_closure_at_every_instant_that_a_live_simulation_shows(measured):
    """The way of the node: advance, observe. The falling gait with all physics on."""
    simulation = Simulation(stations=31)
    simulation.adopt(falling_law())
    for time in np.linspace(0.1, 3.0, 30):
        simulation.advance(time)
        got = simulation.observe()
        apart = got.closure_torque / np.abs(got.torque).max(), got.closure_force / np.abs(got.force).max()
        measured("torque and force left over at every instant of a live simulation", apart, ROUND_OFF)


STEPS = (0.0025, 0.00125)  # s


@few(6)
@given(swimmers(), twists(), quaternions(), scenes(nose=True))
def test_acceleration_is_the_rate_of_the_marched_momentum(measured, swimmer, twist, q, settings):
    """The acceleration at output instants against the momentum that the march carries, which it was not made from.

    The momentum's rate that this acceleration means is the reference's (complex steps along the motion), with the
    nose's m_o V1 t1 on top. Against it: central differences of order 4 of the marched momentum, at the steps of the
    classical Runge-Kutta method, whose order 4 both share. Light bodies roll at up to 30 rad/s, with harmonics: the
    order shows below 0.005 s (at twice these steps one draw in a hundred has 3.8 or 4.3). Errors below 1e-9 are
    round-off of the differences (where momentum is conserved).
    """
    body, law = swimmer
    reference, errors = Reference(body, reference_scene(**settings), nodes_per_panel=24), []
    for step in STEPS:
        accuracy = Accuracy(name="fixed", resolution=200.0, step=step)
        marched = Simulation(
            body=library_body(body),
            scene=library_scene(**settings),
            accuracy=accuracy,
            twist=turn_twist(twist),
            orientation=turn_quaternion(q),
            stations=2,
        )
        marched.adopt(law)
        momenta = []
        for k in range(round(0.2 / step) + 3):
            marched.advance(k * step)
            momenta.append(turn_twist(marched.state[7:13]))
            if k == round(0.2 / step):
                got = in_paper_axes(marched.observe(wrench=False, load=False))
                means = rate_of_momentum(reference, law, got, settings["current"])
        a, b, c, d = momenta[-5], momenta[-4], momenta[-2], momenta[-1]
        slope = (a - 8 * b + 8 * c - d) / (12 * step)
        size = np.abs(means) + np.abs(momenta[-3])  # N m, N: the rate, and the momentum in a second
        errors.append([distance(slope[part], means[part], size[part].max()) for part in (slice(0, 3), slice(3, 6))])
    coarse, fine = np.array(errors)
    measured("acceleration at an output against differences of the marched momentum, 1.25 ms apart", fine, 1e-4)
    order = np.log2(coarse / fine)[fine > 1e-9]
    if len(order):
        measured("order at which the two meet as the step goes to 0", order, 0.2, wanted=4.0)


def rate_of_momentum(reference, law, got, current):
    """World vectors (6,): the rates of the angular momentum about the moving head and of the momentum of body, water
    and nose, from the twist and the acceleration of a snapshot."""
    world, shape = rotation(got.orientation), law.curvature(got.time, reference.space.x)
    twist, rate = got.twist.copy(), got.head_acceleration.copy()
    twist[3:] -= world.T @ np.asarray(current)
    spin, velocity = twist[:3], twist[3:]
    rate[3:] -= np.cross(spin, velocity)
    rates = reference.momentum_rate(*shape, twist, rate)
    rates[:3] -= np.cross(velocity, reference.momentum(*shape[:2], twist)[3:])  # about the head, which moves on
    rates[3:] += reference.nose_mass * (rate[3] * E1 + velocity[0] * np.cross(spin, E1))
    return np.concatenate([world @ rates[:3], world @ rates[3:]])


@pytest.mark.parametrize("settings, tolerance", [({"resistive": False}, 1e-7), ({"friction": "laminar"}, 1e-5)])
def test_acceleration_is_the_derivative_of_the_marched_twist(measured, settings, tolerance):
    """Closure follows from how the acceleration was solved; that it moves the head is checked here.

    Difference quotient of order 6 at 0.005 s of the march's samples: (2 pi)^7 h^6 / 140 = 4e-11 for the gait's first
    harmonic, 100 times that for its third; the march's dense output adds some 1e-9. Drag has kinks in time where V2
    changes sign somewhere along the body. Left out: the three samples about each corner of the law's ramps.
    """
    step = 0.005
    run = simulate(falling_law(), duration=3.0, scene=Scene(**settings), accuracy=DENSE, sample_period=step)
    w = run.twist
    true = run.head_acceleration.copy()  # of the velocity as a vector; its components turn with the head
    true[:, 3:] -= np.cross(w[:, :3], w[:, 3:])
    slope = (-w[:-6] + 9 * w[1:-5] - 45 * w[2:-4] + 45 * w[4:-2] - 9 * w[5:-1] + w[6:]) / (60 * step)
    smooth = np.all(np.abs(run.time[3:-3, None] - FALLING_BREAKS) > 3.5 * step, axis=1)
    error = np.abs(slope - true[3:-3])[smooth].max(axis=0) / np.abs(true).max(axis=0)
    kind = "laminar friction" if "friction" in settings else "no drag"
    measured(f"acceleration against the slope of the marched twist, falling gait, {kind}", error, tolerance)


def test_twist_is_the_derivative_of_the_marched_pose(measured):
    step = 0.01
    run = simulate(
        falling_law(), duration=2.0, scene=Scene(current=(0.1, 0.0, 0.2)), accuracy="fine", sample_period=step
    )
    p, q = run.position, run.orientation
    velocity = (p[:-4] - 8 * p[1:-3] + 8 * p[3:-1] - p[4:]) / (12 * step)
    q_rate = (q[:-4] - 8 * q[1:-3] + 8 * q[3:-1] - q[4:]) / (12 * step)
    got = []
    for k in range(len(velocity)):
        world, (x, y, z, w), rate = rotation(q[k + 2]), q[k + 2], q_rate[k]
        turn = 2 * np.array([[w, z, -y, -x], [-z, w, x, -y], [y, -x, w, -z]]) @ rate
        got.append([*turn, *world.T @ velocity[k]])
    # differences of order 4 at 0.01 s: (2 pi)^5 h^4 / 30 = 3e-6 of the first harmonic, a hundred times that of others
    error = np.abs(np.array(got) - run.twist[2:-2]).max(axis=0) / np.abs(run.twist).max(axis=0)
    measured("twist against the slope of the marched pose", error, 1e-3)
