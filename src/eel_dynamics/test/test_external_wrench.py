# SPDX-License-Identifier: Apache-2.0
"""Wrenches from outside: against the reference and closed forms, in the ledger, at jumps, applied, saved, refused."""

import copy
import itertools
import pickle
from types import SimpleNamespace

import numpy as np
import pytest
from cases import random_law, random_twist
from draws import few, numbers, quaternions, scenes, swimmers, twists
from eel_dynamics.model.axes import turn_quaternion, turn_vector
from eel_dynamics.model.body.appendages import Appendage
from eel_dynamics.model.wrenches.text import text_of_wrenches, wrenches_from_text
from flows import FLOWS, formula
from flows import in_paper_axes as in_paper_axes_of_flow
from hypothesis import given
from hypothesis import strategies as st
from library_state import DENSE, Reference, distance, expected, in_paper_axes, library_body, rotation, turn_twist
from random_robots import drawn
from reference import boyer_body
from reference import scene as reference_scene
from reference_bending import BentReference
from scipy.integrate import quad, solve_ivp
from test_appendages import SOFT, carrying
from test_bending_reference import TURN, coordinates_of
from test_blunt_robots import NO_CROSS_FLOW, differences, with_hull
from test_reference_bending import MIXED, WAVE

from eel_dynamics import (
    Accuracy,
    Body,
    ExternalWrench,
    Run,
    Scene,
    Simulation,
    load_scene,
    save_scene,
    simulate,
    simulate_batch,
)
from eel_gaits import Law, falling, straight

STRAIGHT = Law(name="straight")
NO_WATER = Scene(reactive=False, resistive=False, nose=False)
PLACES = 0.0, 0.31, 1.0  # of the body's length
ROWS = (0.3, -0.4, 0.5, 0.02, -0.03, 0.01), (-0.2, 0.1, 0.6, -0.01, 0.0, 0.05), (0.7, 0.2, -0.1, 0.03, 0.02, -0.04)
RIPPLE = {"force": lambda t: (0.3 * np.sin(9.0 * t), 0.1, 0.2), "torque": lambda t: (0.0, 0.01 * np.cos(7.0 * t), 0.02)}


def three(length=1.0, size=1.0):
    """Wrenches at both ends and inside, one of them in the axes of the world."""
    return tuple(
        ExternalWrench(place * length, size * np.array(row[:3]), size * length * np.array(row[3:]), frame)
        for place, row, frame in zip(PLACES, ROWS, ("section", "world", "section"), strict=True)
    )


def of_reference(wrenches):
    """The same for the reference: its axes are those of the paper, of world and section alike."""

    def row(wrench):
        own = turn_twist(np.array([*wrench.torque, *wrench.force]))
        return wrench.station, wrench.frame == "world", lambda time: own

    return tuple(row(wrench) for wrench in wrenches)


def works_of(run) -> float:
    """The sum of the greatest works [J] of a run."""
    names = [name for name in run.energy.keys() if name.endswith("_work")]  # noqa: SIM118
    return sum(np.abs(run.energy[name]).max() for name in names)


def close(what, value, tolerance):
    """Assert that the greatest of `value` is at most `tolerance`."""
    assert np.max(value) <= tolerance, f"{what}: {np.max(value):.3g}, more than {tolerance:g}"


# -- against the reference ------------------------------------------------------------------------------------------
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


# -- closed forms ---------------------------------------------------------------------------------------------------
def test_a_tow_comes_to_the_speed_at_which_the_known_drag_holds_it():
    """m dU/dt = F - c U^2: U = sqrt(F/c) tanh(sqrt(F c) t/m), with c = 1/2 rho_f A of an element at the head."""
    force, mass, c = 0.8, 1.48, 0.5 * 1000.0 * 4e-3
    body = carrying(Appendage(0.0, drag1=4e-3), mass_per_length=mass)
    still = Scene(friction="none")
    tow = ExternalWrench(0.0, force=(force, 0.0, 0.0))
    run = simulate(STRAIGHT, 12.0, body=body, scene=still, wrenches=[tow], accuracy=1e-7, sample_period=0.1)
    exact = np.sqrt(force / c) * np.tanh(np.sqrt(force * c) * run.time / mass)
    assert exact[-1] == pytest.approx(np.sqrt(force / c), rel=2e-6)
    assert run.twist[:, 3] == pytest.approx(exact, abs=1e-6 * exact[-1])
    assert np.abs(run.twist[:, [0, 1, 2, 4, 5]]).max() < 1e-12  # round-off
    assert run.energy.external_power == pytest.approx(force * run.twist[:, 3], rel=1e-12, abs=1e-15)
    # towed at the tail instead, the same motion; the body is then pushed: its sections bear the drag of the head
    pushed = simulate(
        STRAIGHT, 12.0, body=body, scene=still, wrenches=[ExternalWrench(1.0, (force, 0, 0))], accuracy=1e-7
    )
    assert pushed.twist[-1, 3] == pytest.approx(exact[-1], abs=1e-6 * exact[-1])
    assert run.force[-1, 1:, 0] == pytest.approx(np.zeros(50), abs=1e-5)
    assert pushed.force[-1, :, 0] == pytest.approx(np.full(51, -force), abs=1e-5)


def about_centre(body, axis):
    """X of the centre of mass [m], mass [kg], and inertia about it [kg m^2] along "x", "y" or "z", by quadrature."""
    area = lambda x: np.pi * float(body.half_width(x)) * float(body.half_height(x))  # noqa: E731
    squares = {"y": lambda x: float(body.half_height(x)) ** 2, "z": lambda x: float(body.half_width(x)) ** 2}
    squares["x"] = lambda x: squares["y"](x) + squares["z"](x)
    moment = lambda f: quad(f, 0.0, 1.0, points=body.kinks, limit=200, epsabs=1e-13, epsrel=1e-12)[0]  # noqa: E731
    mass = 1000.0 * moment(area)
    centre = 1000.0 * moment(lambda x: x * area(x)) / mass
    own = 1000.0 * moment(lambda x: area(x) * squares[axis](x) / 4.0)
    along = 0.0 if axis == "x" else 1000.0 * moment(lambda x: (x - centre) ** 2 * area(x))
    return centre, mass, own + along


def test_a_torque_on_a_free_body_turns_it_about_its_centre_of_mass():
    """Without water: omega = T t / I, whatever the station; the centre of mass rests."""
    body, torque = Body.boyer2010(), 0.05
    _, _, inertia = about_centre(body, "z")
    for station, frame in ((0.0, "section"), (0.4, "world"), (1.0, "section")):
        given = ExternalWrench(station, torque=(0.0, 0.0, torque), frame=frame)
        run = simulate(STRAIGHT, 3.0, scene=NO_WATER, wrenches=[given], accuracy=1e-9)
        assert run.twist[:, 2] == pytest.approx(torque / inertia * run.time, rel=1e-8, abs=1e-14)
        assert np.abs(run.center_of_mass - run.center_of_mass[0]).max() < 1e-8
        assert run.energy.external_work == pytest.approx(0.5 * (torque * run.time) ** 2 / inertia, rel=1e-7, abs=1e-14)


def test_a_force_off_the_centre_of_a_free_body_is_euler_s():
    """In section axes at X: omega = F d t / I, and the centre of mass goes along the integral of the turned force."""
    body, force, station = Body.boyer2010(), 0.3, 0.9
    centre, mass, inertia = about_centre(body, "z")
    rate = force * (centre - station) / inertia  # rad/s^2, about z, of a force along y
    given = ExternalWrench(station, force=(0.0, force, 0.0))
    run = simulate(STRAIGHT, 2.0, scene=NO_WATER, wrenches=[given], accuracy=1e-9, sample_period=0.1)
    assert run.twist[:, 2] == pytest.approx(rate * run.time, rel=1e-8, abs=1e-14)
    moved = np.array(
        [
            [
                force / mass * quad(lambda s, t=t, f=f: (t - s) * f(0.5 * rate * s**2), 0.0, t)[0]
                for f in (np.sin, np.cos)
            ]
            for t in run.time
        ]
    ) * (-1.0, 1.0)
    assert run.center_of_mass[:, :2] - run.center_of_mass[0, :2] == pytest.approx(moved, abs=1e-8)
    # the internal force of a free rod behind the point of the force: the mass there times its acceleration
    assert distance(run.force[-1, -1], np.zeros(3), force) < 1e-12


def test_a_free_body_tumbles_by_the_laws_of_newton_and_euler():
    """All six components at once, at three stations, one wrench in the axes of the world, for a second."""
    wrenches, spin = three(), np.array([1.0, 2.0, 3.0])
    start = (*spin, 0.0, 0.0, 0.0)
    how = {"accuracy": 1e-8, "sample_period": 0.25, "twist": start, "estimate": False}
    run = simulate(STRAIGHT, 1.0, scene=NO_WATER, wrenches=wrenches, **how)
    centre, mass, _ = about_centre(Body.boyer2010(), "z")
    inertia = np.array([about_centre(Body.boyer2010(), axis)[2] for axis in "xyz"])

    def rates(time, state):
        q, omega, v = state[3:7] / np.linalg.norm(state[3:7]), state[7:10], state[10:]
        turn, force, torque = rotation(q), np.zeros(3), np.zeros(3)
        for wrench in wrenches:
            own = np.reshape([*wrench.force, *wrench.torque], (2, 3))
            pull, twisted = own @ turn if wrench.frame == "world" else own
            force, torque = force + pull, torque + twisted + np.cross([centre - wrench.station, 0.0, 0.0], pull)
        spun = (torque - np.cross(omega, inertia * omega)) / inertia
        turned = np.concatenate([q[3] * omega + np.cross(q[:3], omega), [-q[:3] @ omega]]) / 2
        return np.concatenate([v, turned, spun, turn @ force / mass])

    begin = np.concatenate([[-centre, 0, 0, 0, 0, 0, 1], spin, np.cross(spin, [-centre, 0.0, 0.0])])
    end = solve_ivp(rates, (0.0, 1.0), begin, "DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    assert run.center_of_mass[-1] == pytest.approx(end[:3], abs=1e-7)
    assert abs(end[3:7] @ run.orientation[-1]) == pytest.approx(np.linalg.norm(end[3:7]), abs=1e-10)
    assert run.twist[-1, :3] == pytest.approx(end[7:10], abs=1e-7 * np.abs(end[7:10]).max())


# -- the internal wrench --------------------------------------------------------------------------------------------
def test_the_internal_wrench_jumps_by_the_wrench():
    """Stations 2e-8 m to both sides see of the loads per length some 1e-6 N; at the place it is that behind."""
    inner = (*three()[1:2], ExternalWrench(0.64, (0.2, -0.5, 0.1), (0.01, 0.02, -0.03)))
    stations = np.sort([wrench.station + d for wrench in inner for d in (-2e-8, 0.0, 2e-8)])
    start = {"law": falling(), "twist": (0.3, -0.2, 0.5, 0.4, 0.2, 0.1), "stations": stations}
    bare = Simulation(**start)
    swims = Simulation(**start, wrenches=inner)
    for each in (bare, swims):
        each.advance(1.3)
    seen = swims.observe()
    for k, wrench in enumerate(inner):
        ahead, at, behind = 3 * k, 3 * k + 1, 3 * k + 2
        jump = np.array([seen.force[behind] - seen.force[ahead], seen.torque[behind] - seen.torque[ahead]])
        axes = rotation(seen.section_orientation[at])
        given = np.reshape([*wrench.force, *wrench.torque], (2, 3))
        local = given @ axes if wrench.frame == "world" else given
        assert jump == pytest.approx(-local * (-1.0, -1.0, 1.0), abs=1e-6)
        assert seen.force[at] == pytest.approx(seen.force[behind], abs=1e-6)
    assert max(seen.closure_force, seen.closure_torque) < 1e-13 * 10.0  # round-off of some N


def test_a_wrench_at_an_end_is_what_the_end_bears():
    law, twist = STRAIGHT, (0.0, 0.0, 0.0, 0.2, 0.0, 0.0)
    plain, at_nose, at_tail = (
        Simulation(law=law, twist=twist, scene=NO_WATER, wrenches=[each] if each else None).observe()
        for each in (None, ExternalWrench(0.0, (1.0, 0, 0)), ExternalWrench(1.0, (1.0, 0, 0), (0.0, 0.0, 0.1)))
    )
    assert np.abs(plain.force).max() < 1e-13
    assert at_nose.force[0] == pytest.approx([1.0, 0.0, 0.0], abs=1e-12)  # the rest hangs on it: tension
    assert at_nose.force[-1] == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)
    assert at_tail.force[-1] == pytest.approx([-1.0, 0.0, 0.0], abs=1e-12)
    assert at_tail.torque[-1] == pytest.approx([0.0, 0.0, 0.1], abs=1e-12)
    assert at_tail.force[0] == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)


# -- energy, steps --------------------------------------------------------------------------------------------------
SWIMS = {
    "imposed": {"law": falling(), "twist": (0.1, 0.0, 0.2, 0.3, 0.1, 0.0)},
    "planar": {"law": straight(), "scene": Scene(planar=True, friction="laminar")},
    "current": {"law": falling(), "scene": Scene(current=(0.2, -0.1, 0.05), friction="laminar")},
    "shear": {"law": straight(), "flow": FLOWS["shear"][1], "scene": Scene(friction="laminar")},
}


@pytest.mark.parametrize("name", SWIMS)
def test_the_ledger_closes_with_wrenches_of_all_kinds(name):
    """A constant, a table that jumps and bends, a function; each of them feeds energy in or takes it."""
    planar = name == "planar"
    plane = np.array([1.0, 1.0, 0.0]) if planar else np.ones(3)
    table = {"time": (0.2, 0.5, 0.5, 0.9), "force": plane * [[0, 0, 0], [0.5, 0.2, 0.1], [-0.5, 0.1, 0.3], [0.4, 0, 0]]}
    ripple = {"force": lambda t: plane * RIPPLE["force"](t)} if planar else RIPPLE
    wrenches = [
        ExternalWrench(0.0, force=(0.3, 0.1, 0.0), torque=(0.0, 0.0, 0.01)),
        ExternalWrench(0.47, **table, frame="world"),
        ExternalWrench(1.0, **ripple),
    ]
    how = {"no_cross": Body.boyer2010().changed(**NO_CROSS_FLOW)}
    run = simulate(**SWIMS[name], duration=1.2, wrenches=wrenches, body=how["no_cross"], accuracy=1e-9, estimate=False)
    assert np.abs(run.energy.external_work).max() > 0.02 * works_of(run)
    assert np.abs(run.energy.residual).max() < 1e-9 * works_of(run), np.abs(run.energy.residual).max() / works_of(run)
    assert run.closure_force.max() < 1e-12 and run.closure_torque.max() < 1e-12


ROBOTS = {**{name: (robot, WAVE, Scene(), 1e-5) for name, robot in SOFT.items()}}
ROBOTS |= {f"random {seed}": (one.robot, one.law, one.scene, 1e-3) for seed in (5, 7, 8) for one in [drawn(seed)]}


@pytest.mark.parametrize("name", ROBOTS)
def test_the_ledger_of_robots_closes(name):
    """The march has momenta, the powers accelerations: an error in either form gives energy from nowhere."""
    robot, law, scene, accuracy = ROBOTS[name]
    rng = np.random.default_rng(len(name))
    plane = np.array([1.0, 1.0, 0.0, 0.0, 0.0, 1.0]) if scene.planar else np.ones(6)
    rows = plane * rng.uniform(0.3, 1.0, (3, 6)) * (1, 1, 1, 0.1, 0.1, 0.1)
    stations = 0.0, float(rng.uniform(0.3, 0.7)), 1.0
    wrenches = [
        ExternalWrench(x, (row[:3], row[:3], -row[:3]), row[3:], frame, time=(0.1, 0.3, 0.3))
        for x, row, frame in zip(stations, rows, ("section", "world", "section"), strict=True)
    ]
    run = simulate(
        law, 0.5, robot=robot, scene=scene, wrenches=wrenches, accuracy=accuracy, estimate=False, stations=11
    )
    assert np.abs(run.energy.external_work).max() > 0.02 * works_of(run)
    assert np.abs(run.energy.residual).max() < 10.0 * accuracy * works_of(run)
    assert run.closure_force.max() < 1e-10 and run.closure_torque.max() < 1e-10


def test_steps_keep_their_order_where_a_wrench_jumps():
    """A jump at an instant that no step would end at: the fourth order of the steps stays."""
    body = Body.boyer2010().changed(**NO_CROSS_FLOW)
    at = 0.2 + 0.1 / np.pi
    wrench = ExternalWrench(0.6, time=(0.05, at, at, 0.4), force=((0, 0, 0), (1, 1, 1), (-2, 1, 0), (0, 0, 2)))

    def end(step):
        how = Accuracy(name="steps", resolution=40.0, step=step)
        run = simulate(
            straight(), 0.5, body=body, scene=Scene(friction="none"), accuracy=how, twist=(0, 0, 0, 0.4, 0, 0),
            wrenches=[wrench], estimate=False,
        )  # fmt: skip
        return np.concatenate([run.position[-1], run.twist[-1]])

    ends = [end(step) for step in (2e-2, 1e-2, 5e-3, 1.25e-3)]
    errors = [np.abs(each - ends[-1]).max() for each in ends[:-1]]
    assert all(3.4 < np.log2(a / b) < 4.8 for a, b in itertools.pairwise(errors)), errors


def test_a_jump_is_seen_to_the_accuracy_of_the_run():
    """A blow of 2 ms gives the free body its impulse, as a table and as a function; observed before the jump."""
    mass = about_centre(Body.boyer2010(), "z")[1]
    blow = ExternalWrench(0.0, time=(0.3, 0.3, 0.302, 0.302), force=((0, 0, 0), (50, 0, 0), (50, 0, 0), (0, 0, 0)))
    as_function = ExternalWrench(0.0, force=lambda t: (50.0 * (0.3 < t < 0.302), 0.0, 0.0))
    run = simulate(STRAIGHT, 1.0, scene=NO_WATER, wrenches=[blow], accuracy=1e-9)
    assert run.twist[-1, 3] == pytest.approx(0.1 / mass, rel=1e-12)
    assert run.error_estimate.worst < 1e-8
    simulation = Simulation(law=STRAIGHT, scene=NO_WATER, wrenches=[blow])
    simulation.advance(0.3)
    assert simulation.observe().head_acceleration[3] == 0.0
    simulation.advance(0.302)
    assert simulation.observe().head_acceleration[3] == pytest.approx(50.0 / mass, rel=1e-12)
    loose = simulate(STRAIGHT, 1.0, scene=NO_WATER, wrenches=[as_function], accuracy=1e-3)
    assert loose.twist[-1, 3] == pytest.approx(0.1 / mass, rel=0.2)  # it is looked at in steps of some ms


# -- applied --------------------------------------------------------------------------------------------------------
def test_an_applied_wrench_is_that_of_a_table():
    table = ExternalWrench(0.5, time=(0.4, 0.4, 0.7, 0.7), force=((0, 0, 0), (1, 0.5, 0), (1, 0.5, 0), (0, 0, 0)))
    start = {"law": falling(), "accuracy": 1e-7, "measure_error": True}
    one, other = Simulation(**start, wrenches=[table]), Simulation(**start, wrenches=[ExternalWrench(0.5)])
    for until, force in ((0.4, (1.0, 0.5, 0.0)), (0.7, (0.0, 0.0, 0.0)), (1.0, None)):
        for each in (one, other):
            each.advance(until)
        mine, yours = one.observe(), other.observe()
        assert mine.position == pytest.approx(yours.position, abs=1e-8)
        assert mine.torque == pytest.approx(yours.torque, abs=1e-6)
        assert mine.energy.external_work == pytest.approx(yours.energy.external_work, abs=1e-8)
        if force is not None:
            other.apply_wrench(0.5, force)
    assert abs(mine.energy.external_work) > 1e-4
    assert one.error_estimate.worst < 1e-5 and other.error_estimate.worst < 1e-5


def test_a_wrench_at_a_new_station_goes_on_from_the_same_motion():
    """The grid changes; the head's motion does not."""
    declared = Simulation(law=falling(), accuracy=1e-6, wrenches=[ExternalWrench(0.37)])
    late = Simulation(law=falling(), accuracy=1e-6)
    for each in (declared, late):
        each.advance(0.8)
        each.apply_wrench(0.37, (0.5, 0.0, 0.2), (0.0, 0.01, 0.0), frame="world")
    assert late.observe().twist == pytest.approx(declared.observe().twist, abs=1e-6)
    for each in (declared, late):
        each.advance(1.5)
    assert late.observe().position == pytest.approx(declared.observe().position, abs=1e-6)
    assert late.observe().energy.residual == pytest.approx(0.0, abs=1e-6)


def test_the_last_one_applied_at_a_station_holds_until_a_reset():
    simulation = Simulation(law=STRAIGHT, scene=NO_WATER)
    rest = simulation.observe().head_acceleration[3]
    simulation.apply_wrench(0.0, (1.0, 0.0, 0.0))
    simulation.apply_wrench(0.0, (2.0, 0.0, 0.0))
    mass = about_centre(Body.boyer2010(), "z")[1]
    assert simulation.observe().head_acceleration[3] == pytest.approx(2.0 / mass, rel=1e-8)
    simulation.apply_wrench(1.0, (1.0, 0.0, 0.0))
    assert simulation.observe().head_acceleration[3] == pytest.approx(3.0 / mass, rel=1e-8)
    simulation.apply_wrench(0.0)
    assert simulation.observe().head_acceleration[3] == pytest.approx(1.0 / mass, rel=1e-8)
    simulation.advance(0.5)
    simulation.reset()
    assert simulation.observe().head_acceleration[3] == rest == 0.0


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))])
@pytest.mark.parametrize("robot", [None, drawn(3).robot])
def test_copies_go_on_under_the_same_wrench(copied, robot):
    wrenches = [ExternalWrench(0.2, time=(0.1, 0.35, 0.35), force=((0, 0, 0), (1, 0, 0), (0, 1, 0)))]
    one = Simulation(law=straight(), robot=robot, wrenches=wrenches, accuracy="draft", stations=5)
    one.advance(0.2)
    one.apply_wrench(0.6, (0.3, 0.1, 0.0))
    one.advance(0.3)
    other = copied(one)
    for each in (one, other):
        each.advance(0.6)
    assert np.array_equal(one.observe().whole, other.observe().whole)


# -- off, and alike -------------------------------------------------------------------------------------------------
def test_a_wrench_of_nothing_at_the_ends_changes_nothing_to_the_last_bit():
    options = {"accuracy": 1e-3, "twist": (0.1, 0.0, 0.2, 0.3, 0.1, 0.0)}
    for robot in (None, drawn(5).robot):
        plain, nothing, none = (
            simulate(falling(), 0.6, robot=robot, wrenches=each, **options)
            for each in (None, [ExternalWrench(0.0), ExternalWrench(1.0, time=(0.1, 0.1), force=np.zeros((2, 3)))], [])
        )
        assert differences(plain, nothing) == [] and differences(plain, none) == []
        assert not plain.energy.external_power.any() and not plain.energy.external_work.any()


def test_a_planar_scene_gives_what_space_gives():
    wrenches = [ExternalWrench(x, (0.3, -0.2, 0.0), (0.0, 0.0, 0.02), "world") for x in (0.0, 0.62)]
    plane, space = (
        simulate(straight(), 1.0, scene=Scene(planar=planar), wrenches=wrenches, accuracy=1e-6, load=True)
        for planar in (True, False)
    )
    assert np.abs(plane.position - space.position).max() < 1e-7
    assert np.abs(plane.torque - space.torque).max() < 1e-6
    assert np.abs(plane.energy.external_power - space.energy.external_power).max() < 1e-7


def test_a_wrench_turns_with_its_frame():
    """A swimmer that starts in another pose swims likewise under wrenches of its section and one turned with it."""
    q = np.array([0.1, -0.4, 0.3, 0.8])
    q /= np.linalg.norm(q)
    options = {"law": falling(), "duration": 0.6, "accuracy": 1e-5}
    own, world = (0.3, 0.2, -0.4), np.array([0.1, -0.3, 0.2])
    here = [ExternalWrench(0.4, own), ExternalWrench(1.0, world, frame="world")]
    there = [here[0], ExternalWrench(1.0, rotation(q) @ world, frame="world")]
    plain, turned = simulate(**options, wrenches=here), simulate(**options, wrenches=there, orientation=q)
    assert turned.position == pytest.approx(plain.position @ rotation(q).T, abs=1e-10)
    assert turned.torque == pytest.approx(plain.torque, abs=1e-9)


# -- files, batches, texts ------------------------------------------------------------------------------------------
TABLE = ExternalWrench(0.5, time=(0.2, 0.2, 0.4), force=((0, 0, 0), (1, 0, 0), (0, 1, 0)), torque=(0, 0, 0.01))


def test_runs_are_saved_swum_again_and_alike_in_batches(tmp_path):
    options = {"accuracy": 1e-3, "estimate": False, "sample_period": 0.1, "stations": 11}
    each = [None, [TABLE], [ExternalWrench(1.0, (0.2, 0.0, 0.0), frame="world")]]
    alone = [simulate(straight(), 0.5, wrenches=wrenches, **options) for wrenches in each]
    batch = simulate_batch(straight(), 0.5, wrenches=each, **options)
    for one, many in zip(alone, batch, strict=True):
        assert differences(one, many) == [] and one.wrenches == many.wrenches
    alone[1].save(tmp_path / "run.nc")
    kept = Run.load(tmp_path / "run.nc")
    assert kept == alone[1] and kept.wrenches == (TABLE,)
    assert differences(simulate(kept.law, 0.5, **kept.swimmer, **options), kept) == []
    batch.save(tmp_path / "batch.nc")
    assert type(batch).load(tmp_path / "batch.nc") == batch
    with pytest.raises(ValueError, match=r"external wrench at 1 m has no text: it is a function"):
        simulate(straight(), 0.2, wrenches=[ExternalWrench(1.0, **RIPPLE)], **options).save(tmp_path / "none.nc")


def test_the_text_of_wrenches_is_read_again(tmp_path):
    text = "section station=0 force=2,0,0 + world station=1 force=0,0,1;0,0,3 time=0,5 + section station=0.5"
    wrenches = wrenches_from_text(text)
    assert wrenches == (
        ExternalWrench(0.0, (2.0, 0.0, 0.0)),
        ExternalWrench(1.0, ((0, 0, 1), (0, 0, 3)), frame="world", time=(0, 5)),
        ExternalWrench(0.5),
    )
    once = ExternalWrench(0.2, force=((1.0, 2.0, 3.0),), time=(1.0,))
    for each in (wrenches, (TABLE,), (once,), ()):
        assert wrenches_from_text(text_of_wrenches(each)) == each
    path = tmp_path / "swim.yaml"
    path.write_text(f"/**: {{ros__parameters: {{gait: straight, wrenches: '{text}'}}}}")
    swim = load_scene(path)
    assert swim.wrenches == wrenches == swim.simulation().wrenches
    save_scene(swim, tmp_path / "again.yaml")
    assert load_scene(tmp_path / "again.yaml").wrenches == wrenches


# -- refused --------------------------------------------------------------------------------------------------------
NOT = [
    ({"station": -0.1}, "external wrench station must be >= 0 m, got -0.1"),
    ({"station": np.nan}, "external wrench station must be finite"),
    ({"force": (1.0, np.nan, 0.0)}, "external wrench force must be finite, got nan at index 1"),
    ({"torque": (1.0, 0.0)}, "external wrench torque must be 3 numbers"),
    ({"force": "up"}, "external wrench force must be real numbers"),
    ({"frame": "head"}, "external wrench frame must be one of section, world, got 'head'"),
    ({"force": ((1, 2, 3), (4, 5, 6))}, "external wrench force must have a row for each time, 0, got 2"),
    ({"time": (0, 1), "force": ((1, 2, 3),)}, "external wrench force must have a row for each time, 2, got 1"),
    ({"time": (1, 0), "force": ((1, 2, 3), (4, 5, 6))}, "external wrench time must be 1 to 100000 instants that do"),
    ({"time": (0, 1)}, "external wrench time goes with rows of force or torque, got neither"),
    ({"time": (1, 1, 1), "force": np.ones((3, 3))}, "external wrench time may have an instant twice, got 1 s thrice"),
    ({"time": (0, 1), "force": ((1, 2, 3), (4, 5, np.inf))}, r"external wrench force\[1\] must be finite"),
]


@pytest.mark.parametrize(("fields", "message"), NOT)
def test_a_wrench_that_does_not_fit_is_refused(fields, message):
    with pytest.raises(ValueError, match=message):
        ExternalWrench(**{"station": 0.5} | fields)


def test_a_wrench_off_the_body_or_the_plane_is_refused():
    plane = Scene(planar=True)
    for how, wrenches, message in (
        ({}, [ExternalWrench(1.2)], "external wrench station must lie on the body, 0 to 1 m, got 1.2 m"),
        ({"scene": plane}, [ExternalWrench(0.5, (0, 0, 1))], "force must be along x and y alone in a planar scene"),
        ({"scene": plane}, [ExternalWrench(0.5, torque=(0, 1, 0))], "torque must be along z alone in a planar scene"),
        ({}, ExternalWrench(0.5), "wrenches must be a list of ExternalWrench"),
        ({}, [0.5], "external wrench must be a ExternalWrench, got 0.5"),
    ):
        with pytest.raises(ValueError, match=message):
            Simulation(law=straight(), wrenches=wrenches, **how)
    simulation = Simulation(law=straight(), scene=plane)
    before = simulation.observe().whole
    for arguments, message in (
        ((2.0, (1, 0, 0)), "station must lie on the body"),
        ((0.5, (1, 0, 1)), "force must be along x and y alone"),
        ((0.5, (1, np.nan, 0)), "force must be finite"),
        ((0.5, lambda t: (1, 0, 0)), "applied force and torque must be three numbers, got a function"),
    ):
        with pytest.raises(ValueError, match=message):
            simulation.apply_wrench(*arguments)
    assert np.array_equal(simulation.observe().whole, before)


@pytest.mark.parametrize("robot", [None, drawn(3).robot])
def test_a_function_that_gives_no_wrench_ends_the_march_where_it_is(robot):
    bad = ExternalWrench(0.5, force=lambda t: (1.0, 0.0) if t > 0.25 else (1.0, 0.0, 0.0))
    simulation = Simulation(law=straight(), robot=robot, wrenches=[bad], accuracy="draft")
    simulation.advance(0.2)
    with pytest.raises(ValueError, match=r"external wrench force at 0\.\d+ s must be 3 numbers, got 2"):
        simulation.advance(1.0)
    assert 0.2 <= simulation.time < 0.3
