# SPDX-License-Identifier: Apache-2.0
"""Appendages: drag areas at places of a body. Their forces, the jump of the internal wrench, and what must hold.

Against the reference they are in test_blunt_robots.py, of bodies whose shape is imposed; here of robots.
"""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from eel_dynamics.model.axes import turn_quaternion, turn_vector
from eel_dynamics.model.body.appendages import Appendage
from flows import FLOWS, formula
from flows import in_paper_axes as flow_in_paper_axes
from library_state import distance, hydrodynamic_wrench, library_body, rotation, simulate_in_paper_axes, snapshot
from random_bodies import drawn_appendages, drawn_hull
from random_robots import drawn
from random_scenes import with_hulls
from reference import Reference, boyer_body, scene
from reference_bending import BentReference
from test_bending_reference import TURN, coordinates_of
from test_blunt_robots import LINKS, NO_CROSS_FLOW, ROUND, ROUND_OFF, STRAIGHT, differences, mirrored, with_hull
from test_reference_bending import MIXED, WAVE

from eel_dynamics import (
    Accuracy,
    Body,
    Fin,
    Joint,
    PassiveTail,
    Robot,
    Run,
    Scene,
    Servo,
    Simulation,
    SimulationStopped,
    simulate,
    simulate_batch,
)
from eel_gaits import Law, Term, falling, straight

BARE = Body.boyer2010().changed(**NO_CROSS_FLOW, nose_drag=0.0, nose_added_mass=0.0)
WITHOUT_FRICTION = {"friction": "none"}


def carrying(*appendages, body=BARE, **others) -> Body:
    return body.changed(appendages=appendages, **others)


def wrench_on(appendage, twist) -> np.ndarray:
    """Wrench (6,) of the appendage alone on the straight body, about its section's centre, in the paper's axes."""
    body = carrying(appendage)
    about_head = hydrodynamic_wrench(body, STRAIGHT, 0.0, twist, np.zeros(6), Scene(**WITHOUT_FRICTION)).resistive
    torque, force = np.split(about_head, 2)
    return np.concatenate([torque - np.cross([appendage.x, 0.0, 0.0], force), force])


AREAS = {"drag1": 0.005, "drag2": 0.007}


@pytest.mark.parametrize(
    ("law", "force", "power"),
    [("axis", (0.2250, -0.1400), -0.0955), ("speed", (0.270416, -0.252389), -0.131603)],
)
def test_forces_are_those_by_hand(law, force, power):
    """Of the velocity (-0.3, 0.2, 0) m/s of a section; digits as they are given."""
    appendage, twist = Appendage(0.37, **AREAS, law=law), (0.0, 0.0, 0.0, -0.3, 0.2, 0.0)
    assert wrench_on(appendage, twist) == pytest.approx(
        [0, 0, 0, *force, 0], abs=5e-7
    )  # half of the last of six digits
    seen = snapshot(carrying(appendage), STRAIGHT, twist=twist, settings=WITHOUT_FRICTION)
    assert seen.energy.appendages_power == pytest.approx(power, abs=5e-7)


def test_the_arm_by_hand():
    """y = 0.035 m and Omega3 = 2 rad/s, where the section has (-0.3, 0.2, 0) m/s: w1 = -0.37, M3 = -0.0119788 N m."""
    x, y = 0.37, 0.035
    twist = (0.0, 0.0, 2.0, -0.3, 0.2 - 2.0 * x, 0.0)
    got = wrench_on(Appendage(x, y, drag1=0.005), twist)
    assert got == pytest.approx([0, 0, -0.0119788, 0.34225, 0, 0], abs=5e-8)  # half of the last of six digits
    up = wrench_on(Appendage(x, z=0.02, drag1=0.005, drag2=0.007), (1.0, 0.0, 0.0, -0.3, 0.2, 0.0))
    w2 = 0.2 - 1.0 * 0.02
    F = 500.0 * np.array([0.005 * 0.09, -0.007 * w2**2, 0.0])
    assert up == pytest.approx([-0.02 * F[1], 0.02 * F[0], 0.0, *F], abs=ROUND_OFF)


@pytest.mark.parametrize("law", ["axis", "speed"])
def test_a_coast_is_that_by_hand(law):
    """U0 / (1 + rho_f drag1 U0 t / (2 m)): 0.029336 m/s after 5 s of 0.2 m/s, 1.48 kg, 0.01722 m^2."""
    body = carrying(Appendage(0.3, drag1=0.01722, law=law), mass_per_length=1.48)
    still = Scene(friction="none")
    run = simulate(STRAIGHT, 5.0, body=body, scene=still, twist=(0, 0, 0, 0.2, 0, 0), accuracy=1e-6)
    exact = 0.2 / (1.0 + 1000.0 * 0.01722 * 0.2 * run.time / (2 * 1.48))
    assert exact[-1] == pytest.approx(0.029336, abs=5e-7)
    assert run.twist[:, 3] == pytest.approx(exact, rel=2e-6)  # the run's accuracy, of a greater speed at first
    assert run.energy.appendages_work == pytest.approx(0.74 * (exact**2 - 0.04), abs=1e-7)


# -- the internal wrench --------------------------------------------------------------------------------------------
def test_the_internal_wrench_jumps_by_the_element_s_wrench():
    """At two places, of which one lies between nodes; at the place itself it is that behind. Stations 1e-7 m apart see
    of the loads per length some 1e-6 N."""
    places, near = (0.3111, 0.64), 1e-7
    elements = [
        Appendage(x, 0.03, -0.02, 0.01, 0.02, 0.015, law) for x, law in zip(places, ("axis", "speed"), strict=True)
    ]
    stations = np.sort([p + d for p in places for d in (-near, 0.0, near)])
    law, twist = WAVE, (0.3, -0.2, 0.5, -0.4, 0.2, 0.1)
    seen = snapshot(carrying(*elements, body=Body.boyer2010()), law, 0.7, twist, stations=stations)
    for k, element in enumerate(elements):
        ahead, at, behind = slice(3 * k, 3 * k + 1), 3 * k + 1, 3 * k + 2
        jump = np.concatenate([seen.torque[behind] - seen.torque[ahead][0], seen.force[behind] - seen.force[ahead][0]])
        body = with_hull(boyer_body(), {"appendages": [element]})
        reference = Reference(body, scene(), panels_per_span=4)
        K, K_rate, _ = law.curvature(0.7, reference.space.x)
        found = reference.point_forces(K, K_rate, np.array(twist))[1]
        wrench = np.concatenate([np.cross(found.arm, found.force) @ found.axes, found.force @ found.axes])
        assert np.abs(found.force).max() > 0.1
        assert jump == pytest.approx(-wrench, abs=1e-5 * np.abs(seen.force).max())
        assert distance(seen.force[at], seen.force[behind], 1.0) < 1e-5 * np.abs(seen.force).max()


@pytest.mark.parametrize("x", [0.0, 1.0])
def test_elements_at_the_ends(x):
    """At X = 0 the internal wrench is that of the nose and the element, at X = l that of wake, base and element."""
    element, twist = Appendage(x, 0.03, 0.0, 0.01, 0.02, 0.0), (0.0, 0.0, 0.5, -0.4, 0.2 - 0.5 * x, 0.0)
    body = carrying(element, body=Body.boyer2010(), base_drag=0.2)
    seen = snapshot(body, STRAIGHT, twist=twist)
    w1 = -0.4 - 0.5 * 0.03
    force = 500.0 * np.array([0.01 * w1**2, -0.02 * 0.04, 0.0])
    wrench = np.array([0.0, 0.0, -0.03 * force[0], *force])
    nose = np.concatenate([np.zeros(3), -seen.nose_force]) - (wrench if x == 0.0 else 0.0)
    tail = np.concatenate([np.zeros(3), seen.tail_force]) + (wrench if x == 1.0 else 0.0)
    base = np.pi * float(body.half_width(1.0) * body.half_height(1.0)) * 0.2 * 500.0 * 0.16
    added = 1000.0 * np.pi * float(body.half_height(1.0)) ** 2
    speed = 0.2 + (0.0 if x else 0.5)  # sideways at the tail
    assert seen.tail_force == pytest.approx([base - 0.5 * added * speed**2, 0.0, 0.0], abs=1e-9)
    close = 1e-10 * np.abs(seen.force).max()  # round-off of the sum over the body
    assert np.concatenate([seen.torque[0], seen.force[0]]) == pytest.approx(nose, abs=close)
    assert np.concatenate([seen.torque[-1], seen.force[-1]]) == pytest.approx(tail, abs=close)
    assert max(seen.closure_force, seen.closure_torque) < close


# -- what must hold -------------------------------------------------------------------------------------------------
SWIM = {"accuracy": 1e-3, "twist": (0.1, 0.0, 0.2, 0.3, 0.1, 0.0)}


def test_two_elements_are_one_of_their_sum():
    one = carrying(Appendage(0.3, 0.02, 0.01, 0.004, 0.006, 0.002), body=Body.boyer2010())
    two = carrying(
        Appendage(0.3, 0.02, 0.01, 0.001, 0.006), Appendage(0.3, 0.02, 0.01, 0.003, 0.0, 0.002), body=Body.boyer2010()
    )
    runs = [simulate(falling(), 1.0, body=body, **SWIM) for body in (one, two)]
    assert distance(runs[1].position, runs[0].position) < 1e-11  # round-off
    assert distance(runs[1].torque, runs[0].torque) < 1e-11
    assert distance(runs[1].energy.appendages_work, runs[0].energy.appendages_work) < 1e-11


def test_rows_of_zeros_change_nothing():
    plain = simulate(falling(), 1.0, **SWIM)
    rows = [Appendage(0.0), Appendage(0.31, 0.1, law="speed"), Appendage(1.0, z=0.02)]
    zeros = simulate(falling(), 1.0, body=carrying(*rows, body=Body.boyer2010()), **SWIM)
    assert differences(plain, zeros) == []


def test_more_drag_swims_more_slowly_and_takes_energy():
    bodies = [carrying(Appendage(0.1, drag1=a, drag2=a), body=Body.boyer2010()) for a in (0.0, 1e-3, 3e-3, 1e-2)]
    options = {"scenes": Scene(planar=True), "accuracy": 1e-3, "estimate": False, "sample_period": 1.0}
    batch = simulate_batch(straight(), 6.0, bodies=bodies, **options)
    speeds = np.linalg.norm(batch.position[:, -1] - batch.position[:, -2], axis=1)
    assert np.all(np.diff(speeds) < -0.02 * speeds[0]) and speeds[-1] > 0.0, speeds  # twenty times the accuracy
    assert not batch.energy.appendages_power[0].any() and batch.energy.appendages_power[1:, 1:].max() < 0.0


@pytest.mark.parametrize("seed", range(4))
def test_each_element_takes_energy_away(seed):
    rng = np.random.default_rng(seed)
    body = carrying(drawn_appendages(rng, 1.0)[0], body=Body.boyer2010(), **LINKS)
    run = simulate(falling(), 1.0, body=body, sample_period=0.01, **SWIM)
    assert run.energy.appendages_power.max() <= 0.0 < -run.energy.appendages_work[-1]
    assert np.all(np.diff(run.energy.appendages_work) <= 0.0)


def test_switches():
    body = carrying(Appendage(0.4, drag1=0.01, drag2=0.01), body=Body.boyer2010())
    power = lambda **settings: snapshot(body, STRAIGHT, 0.0, (0, 0, 0, -0.3, 0.1, 0), settings=settings).energy  # noqa: E731
    assert power(resistive=False).appendages_power == 0.0
    by_hand = -500.0 * 0.01 * (0.3**3 + 0.1**3)
    for settings in ({}, {"friction": "none"}, {"wake": False}, {"reactive": False}):
        assert power(**settings).appendages_power == pytest.approx(by_hand, rel=ROUND_OFF)
    drifts = snapshot(body, STRAIGHT, 0.0, (0, 0, 0, -0.3, 0.1, 0), settings={"current": (-0.3, 0.1, 0.0)})
    assert drifts.energy.appendages_power == 0.0 and np.abs(drifts.head_acceleration).max() < ROUND_OFF


@pytest.mark.parametrize("law", ["axis", "speed"])
def test_a_planar_scene_gives_what_space_gives(law):
    """In the plane z counts as 0."""
    given = [Appendage(0.0, 0.02, 0.0, 2e-3, 1e-3, law=law), Appendage(0.62, -0.05, 0.0, 2e-3, 4e-3, law=law)]
    low = [replace(each, z=0.05) for each in given]
    cases = (given, Scene(planar=True)), (given, Scene()), (low, Scene(planar=True))
    runs = [
        simulate(straight(), 1.0, body=carrying(*rows, body=Body.boyer2010()), scene=where, accuracy=1e-6, load=True)
        for rows, where in cases
    ]
    plane, space, with_z = runs
    assert np.abs(plane.position - space.position).max() < 1e-8  # the runs' accuracy is 1e-6; their steps differ little
    assert np.abs(plane.torque - space.torque).max() < 1e-6
    assert np.abs(plane.energy.appendages_power - space.energy.appendages_power).max() < 1e-7
    assert differences(plane, with_z) == []


def test_a_round_body_with_appendages_has_no_up():
    """Rolled by 90 degrees, with places and areas turned likewise."""
    rng = np.random.default_rng(5)
    rows = [Appendage(x, *rng.uniform(-0.05, 0.05, 2), *rng.uniform(0.0, 5e-3, 3)) for x in (0.0, 0.4, 1.0)]
    turned = [replace(each, y=each.z, z=-each.y, drag2=each.drag3, drag3=each.drag2) for each in rows]
    waves = {"wavelength": 1.0, "period": 0.7, "amplitude": (1.0, 2.0)}
    root = np.sqrt(0.5)
    level, rolled = (
        simulate_in_paper_axes(
            Law(Term(axis=axis, **waves)),
            0.7,
            body=carrying(*each, body=ROUND),
            accuracy=1e-3,
            orientation=(s, 0, 0, c),
        )
        for axis, each, s, c in (("yaw", rows, 0.0, 1.0), ("pitch", turned, root, root))
    )
    assert np.abs(rolled.position - level.position).max() < 1e-10  # round-off that the soft roll grows
    assert np.abs(level.position[:, 2]).max() > 1e-4
    assert distance(rolled.energy.appendages_power, level.energy.appendages_power) < 1e-9


def test_runs_with_appendages_are_saved_and_swim_alike_in_batches(tmp_path):
    rows = Appendage(0.2, 0.02, 0.0, 2e-3), Appendage(0.9, drag2=2e-3, law="speed")
    bodies = [Body.boyer2010(), carrying(*rows, body=Body.boyer2010(), **LINKS), carrying(*rows)]
    options = {"accuracy": 1e-3, "estimate": False, "sample_period": 0.1, "stations": 11}
    alone = [simulate(straight(), 0.5, body=body, **options) for body in bodies]
    for one, many in zip(alone, simulate_batch(straight(), 0.5, bodies=bodies, **options), strict=True):
        assert differences(one, many) == []
    alone[1].save(tmp_path / "run.nc")
    kept = Run.load(tmp_path / "run.nc")
    assert kept == alone[1] and kept.body.appendages == rows


# -- robots ---------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize(("flow", "exact"), [(None, True), ("street", True), ("shear", False)])
def test_accelerations_of_robots_are_those_of_lagrange_s_equations(flow, exact):
    """Springs, stops, motors, muscles, a passive tail; elements inside the supports of joints, and at both ends."""
    rng = np.random.default_rng(7)
    places = (0.0, 0.21, 0.49, 0.77, 1.0)
    rows = [
        Appendage(x, *rng.uniform(-0.05, 0.05, 2), *rng.uniform(0.0, 4e-3, 3), law)
        for x, law in zip(places, ("axis", "speed", "axis", "speed", "axis"), strict=True)
    ]
    hull = drawn_hull(rng, 1.0, along=False) | {"appendages": rows} | (NO_CROSS_FLOW if exact else {})
    settings, body = {"friction": "none"}, with_hull(boyer_body(), hull)
    reference = BentReference(body, MIXED, scene(**settings), law=WAVE, panels_per_span=2, nodes_per_panel=14)
    if flow is not None:
        reference.flow = flow_in_paper_axes(formula(flow))
    simulation = Simulation(
        robot=MIXED,
        body=library_body(body).changed(**hull),
        law=WAVE,
        scene=Scene(**settings),
        accuracy=Accuracy(name="dense", resolution=120.0, tolerance=1e-6),
        stations=11,
        flow=None if flow is None else FLOWS[flow][1],
        position=turn_vector((0.1, 0.05, -0.2)),
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
    close = 1e-7 if exact else 1e-4  # the condition of the mass matrix; kinks of the cross flow
    assert np.abs(acceleration[:modes] - qddot).max() < close * np.abs(qddot).max()
    assert np.abs(acceleration[modes:] - thdd).max() < close * np.abs(thdd).max()
    assert np.abs(found - head).max() < close * np.abs(head).max()


SOFT = {
    "tail": Robot([PassiveTail(0.6, 0.6, 0.02)]),
    "springs": Robot(
        [Joint(0.2 + 0.15 * k, stiffness=0.5, damping=0.01) for k in range(4)] + [Joint(0.9, "pitch", stiffness=0.3)]
    ),
    "servos": Robot([Joint(0.1 + 0.12 * k, width=0.06, actuator=Servo(kp=20.0, kd=0.1)) for k in range(8)]),
}


@pytest.mark.parametrize("name", SOFT)
def test_soft_robots_keep_energy_closure_and_symmetry(name):
    """The march has momenta, the powers accelerations: an error in either form gives energy from nowhere."""
    rows = [Appendage(0.1, 0.03, 0.0, 4e-3, 2e-3), Appendage(0.66, -0.02, 0.01, 1e-3, 3e-3, 2e-3, "speed")]
    rows += [Appendage(1.0, 0.01, 0.0, 1e-3, 2e-3)]
    yaw = Law(Term(axis="yaw", amplitude=(2.0, 2.0), wavelength=1.0, period=0.8))
    start = np.array([0.2, 0.1, 0.3, 0.3, 0.1, 0.05])
    links = {"body": carrying(*rows, body=Body.boyer2010(), **LINKS), "robot": SOFT[name], "accuracy": 1e-5}
    image = carrying(*(replace(each, y=-each.y) for each in rows), body=links["body"])
    run = simulate(yaw, 0.5, twist=start, estimate=False, sample_period=0.02, **links)
    works = sum(np.abs(run.energy[f"{part}_work"]).max() for part in ("actuator", "drag", "appendages", "wake"))
    assert np.abs(run.energy.residual).max() < 1e-4 * works  # ten times the accuracy
    assert run.energy.appendages_power.max() < 0.0
    assert run.closure_force.max() < 1e-11 and run.closure_torque.max() < 1e-11  # of some N and some 0.1 N m
    turned = start * (-1, 1, -1, 1, -1, 1)
    mirror = simulate(mirrored(yaw), 0.5, twist=turned, estimate=False, sample_period=0.02, **links | {"body": image})
    assert distance(mirror.position, run.position * (1, -1, 1)) < 1e-9  # round-off through 1e3 steps
    assert np.ptp(run.curvature, axis=0).max() > 0.1


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("count", [24, pytest.param(600, marks=pytest.mark.soak)])
def test_any_body_of_links_keeps_its_energy_in_any_water(count):
    """With weight and fins or without, in still and in moving water, in the plane and in space."""
    for index, arguments in enumerate(with_hulls(count, seed=77)):
        duration = 0.15
        how = {"sample_period": duration / 5, "stations": 11, "estimate": False} | arguments
        run = simulate(duration=duration, accuracy=1e-6, **how)
        energy, length = run.energy, run.body.length
        works = sum(np.abs(energy[name]).max() for name in energy.keys() if name.endswith("_work"))  # noqa: SIM118
        passed = works + energy.kinetic_body.max() + energy.kinetic_fluid.max() + np.ptp(energy.potential)
        assert np.abs(energy.residual).max() < 1e-6 * passed, index
        assert run.closure_force.max() < 1e-10 * np.abs(run.force).max(), index
        assert run.closure_torque.max() < 1e-10 * length * np.abs(run.force).max(), index
        assert energy.appendages_work.any(), index


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("count", [10, pytest.param(600, marks=pytest.mark.soak)])
def test_random_robots_of_links_keep_their_energy_or_are_refused(count):
    refused = swum = 0
    for seed, arguments in enumerate(with_hulls(count, seed=78)):
        if arguments["body"].length != 1.0 or arguments["scene"].planar:
            continue
        swum, draw = swum + 1, drawn(seed)
        try:
            ledger = simulate(
                accuracy=1e-4,
                estimate=False,
                duration=0.05,
                stations=5,
                **arguments | {"law": draw.law, "robot": draw.robot},
            ).energy
        except (SimulationStopped, ValueError) as error:
            refused += 1
            assert any(part.name in str(error) for part in draw.robot.parts), (seed, error)
            continue
        amounts = (v for name, v in vars(ledger).items() if not name.endswith(("power", "residual")))  # J
        scale = max(np.abs(each).max() for each in amounts)
        assert np.abs(ledger.residual).max() < 0.01 * scale, seed  # of which stiff dampers take what they take
    assert swum > count // 4 and refused <= max(1, swum // 10)


def test_fins_and_appendages_at_one_place_are_apart():
    """Two kinds of point forces at the same edge of a panel; the wrenches of both are carried to the head."""
    twist = (0.2, 0.1, 0.3, -0.4, 0.1, 0.2)
    runs = {}
    for key, fins, rows in (("none", None, ()), ("fin", 1, ()), ("bar", None, 1), ("both", 1, 1)):
        body = carrying(*([Appendage(0.3, 0.02, drag1=4e-3)] if rows else []), body=Body.boyer2010())
        fin = [Fin(0.3, "right", 1e-3, 3.0, angle=0.2)] if fins else None
        simulation = Simulation(body=body, law=STRAIGHT, fins=fin, twist=twist, accuracy="fine")
        runs[key] = simulation.observe()
    powers = {key: (seen.energy.fins_power, seen.energy.appendages_power) for key, seen in runs.items()}
    assert powers["both"][1] == pytest.approx(powers["bar"][1], rel=ROUND_OFF) and powers["none"] == (0.0, 0.0)
    assert runs["both"].closure_force < 1e-11
    # each fin's added mass changes the inertia that the bar's force meets, so the accelerations do not add up exactly
    added = runs["fin"].head_acceleration + runs["bar"].head_acceleration - runs["none"].head_acceleration
    assert distance(runs["both"].head_acceleration, added) < 0.05
