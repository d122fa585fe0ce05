# SPDX-License-Identifier: Apache-2.0
"""External wrenches against the reference, where they do virtual work; and zero ones, which change nothing."""

from types import SimpleNamespace

import numpy as np
import pytest
from cases import random_law, random_twist
from draws import few, numbers, quaternions, scenes, swimmers, twists
from eel_dynamics.model.axes import turn_quaternion, turn_vector
from flows import FLOWS, formula
from flows import in_paper_axes as in_paper_axes_of_flow
from hypothesis import given
from hypothesis import strategies as st
from library_state import DENSE, Reference, distance, expected, in_paper_axes, library_body, rotation, turn_twist
from random_robots import drawn
from reference import boyer_body
from reference import scene as reference_scene
from reference_bending import BentReference
from test_bending_reference import TURN, coordinates_of
from test_blunt_robots import NO_CROSS_FLOW, differences, with_hull
from test_reference_bending import MIXED, WAVE
from wrench_cases import close, of_reference, three

from eel_dynamics import Accuracy, ExternalWrench, Scene, Simulation, simulate
from eel_gaits import falling


def compare(kind, body, law, time, twist, q, settings, size=1.0, flow=None, position=(0.0, 0.0, 0.0)):
    """Head's acceleration, internal wrench and powers against the reference, where the wrenches do virtual work."""
    length = body.kinks[-1]
    wrenches = three(length, size)
    simulation = Simulation(
        body=library_body(body),
        scene=Scene(**settings),
        accuracy=DENSE,
        wrenches=wrenches,
        flow=None if flow is None else FLOWS[flow][1],
        position=turn_vector(position),
        orientation=turn_quaternion(q),
        twist=turn_twist(twist),
    )
    simulation.adopt(law, origin=-time)
    got = in_paper_axes(simulation.observe(wrench=True, load=True))
    inside = [wrench.station for wrench in wrenches[1:2]]
    reference = Reference(body, reference_scene(**settings), splits=inside, panels_per_span=2, nodes_per_panel=24)
    reference.wrenches, reference.height = of_reference(wrenches), position[2]
    if flow is not None:
        reference.flow = in_paper_axes_of_flow(formula(flow))
    reference.pose = SimpleNamespace(position=np.array(position), axes=rotation(q), time=0.0)
    shape, relative, rate, acceleration = expected(reference, law, time, twist, q)
    fields = reference.fields(*shape, relative, rate)
    exact = 1e-8
    apart = [distance(got.head_acceleration[part], acceleration[part]) for part in (slice(0, 3), slice(3, 6))]
    close(f"head's acceleration, {kind}", apart, exact)
    inner = np.abs(simulation.x[:, None] - inside).min(axis=1) > 1e-6 * length  # elsewhere two values
    inner[[0, -1]] = False  # as at both ends
    at = lambda field: reference.space.evaluate(field, simulation.x)[inner]  # noqa: E731
    apart = distance(got.torque[inner], at(fields.torque)), distance(got.force[inner], at(fields.force))
    close(f"internal torque and force, {kind}", apart, exact)
    powers = np.array([got.energy.actuator_power, got.energy.external_power])
    wanted = [fields.actuator_power, fields.external_power]
    close(f"powers of actuators and wrenches, {kind}", distance(powers, wanted), exact)
    left = np.array([got.closure_torque / length, got.closure_force]) / max(1.0, np.abs(got.force).max())
    close(f"closure, by the greatest force, {kind}", left, 1e-9)


@few(5)
@given(
    swimmers(), numbers(0.0, 3.0), twists(), quaternions(), scenes(current=(0.0, 0.0, 0.0)), st.sampled_from((0.1, 3.0))
)
def test_any_swimmer_under_wrenches_against_the_reference(swimmer, time, twist, q, settings, size):
    compare("any swimmer under wrenches", *swimmer, time, twist, q, settings, size)


@pytest.mark.parametrize("name", FLOWS)
def test_wrenches_in_water_that_moves_against_the_reference(name):
    rng = np.random.default_rng(list(FLOWS).index(name))
    law, twist, place = random_law(rng, spline=False), random_twist(rng), (0.1, 0.05, -0.2)
    settings = {"resistive": False}
    compare("in water that moves", boyer_body(), law, 0.7, twist, (0, 0, 0, 1), settings, 1.0, name, place)


@pytest.mark.parametrize("in_world", [False, True])
def test_accelerations_of_robots_are_those_of_lagrange_s_equations(in_world):
    """Springs, stops, motors, muscles, a passive tail; wrenches inside the supports of joints, and at both ends."""
    rng = np.random.default_rng(7)
    wrenches = [
        ExternalWrench(x, rng.uniform(-1, 1, 3), rng.uniform(-0.1, 0.1, 3), "world" if in_world else "section")
        for x in (0.0, 0.21, 0.49, 0.77, 1.0)
    ]
    settings, body = {"friction": "none"}, with_hull(boyer_body(), NO_CROSS_FLOW)
    inside = [wrench.station for wrench in wrenches[1:-1]]
    reference = BentReference(
        body, MIXED, reference_scene(**settings), law=WAVE, splits=inside, panels_per_span=2, nodes_per_panel=14
    )
    reference.wrenches = of_reference(wrenches)
    simulation = Simulation(
        robot=MIXED,
        body=library_body(body).changed(**NO_CROSS_FLOW),
        law=WAVE,
        scene=Scene(**settings),
        accuracy=Accuracy(name="dense", resolution=120.0, tolerance=1e-6),
        stations=11,
        wrenches=wrenches,
    )
    modes, time = len(reference.owner), 0.6
    simulation.advance(time)
    now, x, rate, acceleration = coordinates_of(simulation)
    axes, place = rotation(turn_quaternion(now.orientation)), turn_vector(now.position)
    reference.up, reference.height = axes[2], place[2]
    reference.pose = SimpleNamespace(position=place, axes=axes, time=time)
    twist, found = now.twist * TURN, now.head_acceleration * TURN
    head, qddot, thdd = reference.bent_accelerations(time, twist, x[:modes], rate[:modes], x[modes:], rate[modes:])
    found = found - np.concatenate([np.zeros(3), np.cross(twist[:3], twist[3:])])
    close = 1e-7  # the condition of the mass matrix
    assert np.abs(acceleration[:modes] - qddot).max() < close * np.abs(qddot).max()
    assert np.abs(acceleration[modes:] - thdd).max() < close * np.abs(thdd).max()
    assert np.abs(found - head).max() < close * np.abs(head).max()
    K, K_rate, *_ = reference.bent_motion(time, twist, x[:modes], rate[:modes], x[modes:], rate[modes:])
    power = reference.external_power(K, K_rate, twist)
    assert now.energy.external_power == pytest.approx(power, rel=1e-8)


def test_a_wrench_of_nothing_at_the_ends_changes_nothing_to_the_last_bit():
    options = {"accuracy": 1e-3, "twist": (0.1, 0.0, 0.2, 0.3, 0.1, 0.0)}
    for robot in (None, drawn(5).robot):
        plain, nothing, none = (
            simulate(falling(), 0.6, robot=robot, wrenches=each, **options)
            for each in (None, [ExternalWrench(0.0), ExternalWrench(1.0, time=(0.1, 0.1), force=np.zeros((2, 3)))], [])
        )
        assert differences(plain, nothing) == [] and differences(plain, none) == []
        assert not plain.energy.external_power.any() and not plain.energy.external_work.any()
