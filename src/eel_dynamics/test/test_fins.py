# SPDX-License-Identifier: Apache-2.0
"""Fins: their forces, their place in the balance, the servo, and the roll that they hold."""

import itertools
from copy import deepcopy
from types import SimpleNamespace

import numpy as np
import pytest
from cases import falling_law, random_law, random_twist
from draws import few, numbers, quaternions, scenes, swimmers, twists
from eel_dynamics.model.axes import turn_quaternion, turn_vector
from eel_dynamics.model.fins.text import fins_from_text, text_of_fins
from eel_dynamics.model.inertia import straight_inertia
from eel_dynamics.model.section_data import nose_of
from flows import FLOWS, formula
from flows import in_paper_axes as in_paper_axes_of_flow
from hypothesis import given
from hypothesis import strategies as st
from library_state import DENSE, Reference, distance, expected, in_paper_axes, library_body, rotation, turn_twist
from reference import boyer_body, fin_steady
from reference import scene as reference_scene
from scipy.interpolate import make_interp_spline
from test_against_reference import EXACT
from test_weight import weighing

from eel_dynamics import Accuracy, Body, Fin, RollHold, Run, Scene, Simulation, simulate
from eel_gaits import Law, Term, falling, straight

pytestmark = pytest.mark.identity("Fins")
STRAIGHT = Law(name="straight")
ROBOT = Body.boyer2010()
TIME = (0.0, 0.2, 0.5, 0.7, 1.1)
GIVEN = (TIME, (0.1, 0.3, -0.2, 0.0, 0.4))
HELD = {"angle": RollHold(2.0, 0.15), "time_constant": 0.05}


def row_of(*angles, **others):
    """Fins at different stations, on both sides, with these angles."""
    return tuple(
        Fin(
            0.2 + 0.15 * k, ("left", "right")[k % 2], 1e-3 * (1 + k), 2.0 + k, dihedral=0.3 * k - 0.2, angle=a, **others
        )
        for k, a in enumerate(angles)
    )


def compare(measured, kind, body, law, time, twist, q, settings, angles, flow=None, position=(0.0, 0.0, 0.0)):
    """A snapshot with fins against the reference: head's acceleration, internal wrench, fins' forces and power."""
    length = body.kinks[-1]
    fins = tuple(
        Fin(**vars(fin) | {"station": fin.station * length, "area": fin.area * length**2}) for fin in row_of(*angles)
    )
    simulation = Simulation(
        body=library_body(body),
        scene=Scene(**settings),
        accuracy=DENSE,
        fins=fins,
        flow=None if flow is None else FLOWS[flow][1],
        position=turn_vector(position),
        orientation=turn_quaternion(q),
        twist=turn_twist(twist),
    )
    simulation.adopt(law, origin=-time)
    got = in_paper_axes(simulation.observe(wrench=True, load=True))
    stations = [fin.station for fin in fins]
    reference = Reference(body, reference_scene(**settings), splits=stations, panels_per_span=2, nodes_per_panel=24)
    reference.fins = [(fin, lambda t, angle=fin.angle: angle) for fin in fins]
    reference.height = position[2]
    if flow is not None:
        reference.flow = in_paper_axes_of_flow(formula(flow))
    reference.pose = SimpleNamespace(position=np.array(position), axes=rotation(q), time=0.0)
    shape, relative, rate, acceleration = expected(reference, law, time, twist, q)
    fields = reference.fields(*shape, relative, rate)
    apart = [distance(got.head_acceleration[part], acceleration[part]) for part in (slice(0, 3), slice(3, 6))]
    measured(f"head's acceleration, {kind}", apart, EXACT)
    inner = np.abs(simulation.x[:, None] - stations).min(axis=1) > 1e-6 * length  # elsewhere two values
    at = lambda field: reference.space.evaluate(field, simulation.x)[inner]  # noqa: E731
    apart = distance(got.torque[inner], at(fields.torque)), distance(got.force[inner], at(fields.force))
    measured(f"internal torque and force, {kind}", apart, EXACT)
    measured(f"forces of the fins, {kind}", distance(got.fin_force, fields.fin_force), EXACT)
    powers = np.array([got.energy.actuator_power, got.energy.fins_power])
    measured(
        f"powers of actuators and fins, {kind}", distance(powers, [fields.actuator_power, fields.fins_power]), 1e-8
    )
    least = np.array([got.closure_torque / length, got.closure_force]) / max(1.0, np.abs(got.force).max())
    measured(f"closure, by the greatest force, {kind}", least, 1e-9)


@few(4)
@given(
    swimmers(),
    numbers(0.0, 3.0),
    twists(),
    quaternions(),
    scenes(current=(0.0, 0.0, 0.0)),
    st.tuples(*[numbers(-0.8, 0.8)] * 3),
)
def test_any_swimmer_with_fins_against_the_reference(measured, swimmer, time, twist, q, settings, angles):
    compare(measured, "any swimmer with fins", *swimmer, time, twist, q, settings, angles)


@pytest.mark.parametrize("name", FLOWS)
def test_fins_and_weight_in_water_that_moves_against_the_reference(measured, name):
    rng = np.random.default_rng(list(FLOWS).index(name))
    body, law, twist = weighing(boyer_body(), 0.1, 0.3, 0.006, 0.5), random_law(rng, spline=False), random_twist(rng)
    settings, place = {"resistive": False, "weight": True}, (0.1, 0.05, -0.2)
    compare(measured, "in water that moves", body, law, 0.7, twist, (0, 0, 0, 1), settings, (0.2, -0.5), name, place)


@pytest.mark.parametrize("angle", [0.02, 0.2, 0.5, 1.2])
def test_lift_drag_and_arm_by_the_accelerations_of_a_straight_body(measured, angle):
    """What a fin gives a straight body, times the inertia, is its wrench: by hand, at rest but for a forward speed."""
    fin, speed = Fin(0.3, "right", 1.5e-3, 3.0, dihedral=0.2, angle=angle), 0.8
    options = {
        "scene": Scene(resistive=False, wake=False),
        "accuracy": DENSE,
        "law": STRAIGHT,
        "twist": (0, 0, 0, speed, 0, 0),
    }
    plain, finned = Simulation(**options), Simulation(**options, fins=[fin])
    e_n = np.cos(angle) * fin.normal + np.sin(angle) * np.array([1.0, 0.0, 0.0])
    e_c = np.sin(angle) * fin.normal - np.cos(angle) * np.array([1.0, 0.0, 0.0])
    w = np.array([-speed, 0.0, 0.0])
    force = fin_steady(fin, 1000.0, w @ e_n, w @ e_c, e_n, e_c)
    span = np.sqrt(1.5 * 1.5e-3)
    arm = np.array([0.3, 0.0, 0.0]) + fin.root(ROBOT) + 4 * span / (3 * np.pi) * fin.axis
    y = np.concatenate([np.cross(arm, e_n), e_n])
    here = plain.discretisation
    matrix = straight_inertia(here.grid, here.sections, nose_of(ROBOT, plain.scene)[0], 1.0)
    matrix += 1000.0 * np.pi / 4 * (1.5e-3 / span) ** 2 * span * np.outer(y, y)
    gained = in_paper_axes(finned.observe()).head_acceleration
    assert np.abs(in_paper_axes(plain.observe()).head_acceleration).max() < 1e-12
    measured(
        "wrench of a fin by the accelerations",
        distance(matrix @ gained, np.concatenate([np.cross(arm, force), force])),
        1e-8,
    )


@pytest.mark.parametrize("law", [STRAIGHT, straight()], ids=["at rest", "swimming"])
def test_a_symmetric_pair_keeps_a_planar_swim_planar(measured, law):
    run = simulate(law, 2.0, fins=[Fin.pair(0.2, 1e-3, 3.0)], sample_period=0.1, twist=(0, 0, 0.1, 0.3, 0, 0))
    measured("height of a planar swim with a pair of fins", np.abs(run.position[:, 2]), 1e-12, unit="m")
    measured("its roll and pitch", np.abs(run.orientation[:, :2]), 1e-12)


def test_the_mirror_of_a_swim_with_fins_mirrors_it(measured):
    sign = np.array([1, -1, 1])
    wave = {"wavelength": 1.0, "period": 1.0}
    laws = (
        Law(Term(axis="yaw", amplitude=(a,), **wave), Term(axis="pitch", amplitude=(0.4,), **wave)) for a in (1.0, -1.0)
    )
    fins = ([Fin(0.2, side, 1e-3, 3.0, dihedral=0.2, angle=GIVEN)] for side in ("left", "right"))
    plain, mirror = (simulate(law, 1.0, fins=each, sample_period=0.1) for law, each in zip(laws, fins, strict=True))
    measured("path of the mirrored swimmer with a fin", distance(mirror.position, plain.position * sign), 1e-11)


def combined_law():
    wave = {"wavelength": 1.0, "period": 1.0}
    return Law(Term(axis="yaw", amplitude=(1.5,), **wave), Term(axis="pitch", amplitude=(0.7, 1.0), phase=1.0, **wave))


COMBINED = {
    "given": ({}, row_of(GIVEN, 0.2, -0.3), None),
    "servo": ({}, row_of(GIVEN, 0.2, -0.3, time_constant=0.1), None),
    "roll hold, weight": ({"weight": True}, Fin.pair(0.2, 1e-3, 3.0, **HELD), None),
    "roll hold, weight, street": ({"weight": True}, Fin.pair(0.2, 1e-3, 3.0, dihedral=0.3, **HELD), "street"),
    "given, wave": ({}, row_of(GIVEN, 0.2), "wave"),
}


@pytest.mark.parametrize("water", ["still", *FLOWS])
@pytest.mark.parametrize("kind", ["given", "servo", "roll hold"])
@pytest.mark.parametrize("weight", [False, True], ids=["neutral", "weighs"])
def test_ledger_and_closure_in_every_combination(measured, weight, kind, water):
    """Fins of each kind with and without weight in each flow; the error estimate is within its target."""
    fins = {
        "given": row_of(GIVEN, 0.2, -0.3),
        "servo": row_of(GIVEN, 0.2, -0.3, time_constant=0.1),
        "roll hold": Fin.pair(0.2, 1e-3, 3.0, dihedral=0.3, **HELD),
    }[kind]
    run = simulate(
        combined_law(),
        0.25,
        body=library_body(weighing(boyer_body(), 0.05, 0.2, 0.005)) if weight else None,
        scene=Scene(weight=weight),
        fins=fins,
        flow=None if water == "still" else FLOWS[water][1],
        accuracy=1e-7,
        sample_period=0.025,
        stations=11,
        twist=(0.5, 0, 0, 0.4, 0, 0),
    )
    measured("energy from nowhere, each combination with fins", np.abs(run.energy.residual).max(), 1e-8, unit="J")
    measured("closure, each combination with fins", [run.closure_torque, run.closure_force], 1e-10)
    measured("estimated error, each combination with fins", run.error_estimate.worst, 1e-7)


def test_steps_with_fins_are_of_fourth_order(measured):
    """Weight, a street, a pair that holds the roll: energy from nowhere by steps of one length."""
    body = library_body(weighing(boyer_body(), 0.05, 0.2, 0.005))

    def residual(step):
        run = simulate(
            combined_law(),
            0.5,
            body=body,
            scene=Scene(resistive=False, weight=True),
            fins=Fin.pair(0.2, 1e-3, 3.0, dihedral=0.3, **HELD),
            flow=FLOWS["street"][1],
            accuracy=Accuracy(name="steps", resolution=40.0, step=step),
            sample_period=0.1,
            twist=(0.5, 0, 0, 0.4, 0, 0),
            estimate=False,
        )
        return np.abs(run.energy.residual).max()

    coarse, fine = residual(5e-3), residual(2.5e-3)
    assert 3.8 < np.log2(coarse / fine) < 4.6
    measured("energy from nowhere at steps of 2.5 ms", fine, 1e-8, unit="J")


@pytest.mark.parametrize("name", COMBINED)
def test_the_ledger_closes_and_the_two_forms_agree(measured, name):
    """The momentum that is marched, and the balance that gives the acceleration; the energy ledger besides."""
    settings, fins, flow = COMBINED[name]
    finest = Accuracy(name="finest", resolution=60.0, tolerance=1e-12)
    body = library_body(weighing(boyer_body(), 0.05, 0.2, 0.005)) if settings else None
    run = simulate(
        combined_law(),
        0.5,
        body=body,
        scene=Scene(resistive=False, **settings),
        fins=fins,
        accuracy=finest,
        sample_period=0.00125,
        flow=None if flow is None else FLOWS[flow][1],
        twist=(0.5, 0, 0, 0.4, 0, 0),
        estimate=False,
    )
    cut = np.searchsorted(run.time, [0.0, 0.2, 0.5])
    for first, last in itertools.pairwise(cut):  # between the knots of the given angle
        here = slice(first, last + 1)
        gained = make_interp_spline(run.time[here], run.twist_rate[here], k=9).antiderivative()(run.time[here])
        apart = distance(gained, run.twist[here] - run.twist[first])
        measured("integral of the acceleration against the marched twist, with fins", apart, 1e-8)
    measured("energy from nowhere, with fins", np.abs(run.energy.residual).max(), 1e-8, unit="J")
    measured("closure with fins", [run.closure_torque, run.closure_force], 1e-10)
    assert np.abs(run.energy.fins_work).max() > 1e-5


def test_the_servo_lags_by_its_time_constant(measured):
    tau, angle, limit = 0.08, 0.3, 0.6
    run = simulate(
        STRAIGHT, 0.5, fins=[Fin(0.2, "left", 1e-3, 3.0, angle=angle, time_constant=tau, limit=limit)], accuracy="fine"
    )
    wanted = limit * np.tanh(angle / limit) * (1.0 - np.exp(-run.time / tau))
    measured("angle of a servo", distance(run.fin_angle[:, 0], wanted), 1e-6)


def test_the_roll_hold_turns_left_and_right_against_each_other():
    run = simulate(
        straight(), 2.0, fins=[Fin.pair(0.2, 1e-3, 3.0, **HELD)], orientation=(0.05, 0, 0, 0.99875), sample_period=0.1
    )
    assert np.array_equal(run.fin_angle[:, 0], -run.fin_angle[:, 1]) and np.abs(run.fin_angle).max() > 0.01


def roll_of(run):
    x, y, z, w = run.orientation.T
    return np.unwrap(np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)))


def test_fins_hold_the_roll_of_the_straight_gait():
    """A push of 0.05 rad/s: without fins the robot rolls over and dives; 10 cm^2 a side hold it upright, and too much
    area or gain is worse than too little."""
    push = {"twist": (0.05, 0, 0, 0, 0, 0), "accuracy": 1e-3, "sample_period": 0.1, "estimate": False}

    def swim(area, k_p):
        fins = [Fin.pair(0.2, area, 2.5, angle=RollHold(k_p, 0.15), time_constant=0.05)] if area else None
        run = simulate(straight(), 40.0, fins=fins, **push)
        return np.abs(roll_of(run)).max(), np.ptp(run.position[:, 2])

    (rolled, sunk), (held, depth), (much, _) = swim(0.0, 0.0), swim(1e-3, 2.0), swim(4e-3, 2.0)
    assert rolled > 10.0 and sunk > 10.0
    assert held < 0.1 and depth < 0.1
    assert 0.4 < much < 0.8


def test_fins_keep_the_falling_gait_on_its_course():
    """Drift to the side in 10 s: 0.9 m without fins; by an independent prototype 0.21 m with 20 cm^2 a side."""
    pair = Fin.pair(0.2, 2e-3, 2.5, angle=RollHold(2.0, 0.15), time_constant=0.05)
    free, held = (
        np.abs(simulate(falling(), 10.0, fins=fins, accuracy=1e-3, sample_period=0.1, estimate=False).position[:, 1])
        for fins in (None, [pair])
    )
    assert 0.8 < free.max() < 1.0 and 0.12 < held.max() < 0.25


def test_a_run_with_fins_is_saved_copied_and_simulated_again(tmp_path):
    fins = (*Fin.pair(0.2, 0.001, 3.0, **HELD), Fin(0.5, "left", 0.0005, 2.0, angle=GIVEN))
    run = simulate(falling_law(), 1.0, fins=fins, sample_period=0.1, accuracy=1e-3)
    run.save(tmp_path / "run.nc")
    assert Run.load(tmp_path / "run.nc") == run and run.fins == fins and run.fin_angle.shape == (11, 3)
    assert np.abs(run.refined.position - run.position).max() < 1e-3
    simulation = Simulation(fins=fins, law=falling_law())
    simulation.advance(0.5)
    other = deepcopy(simulation)
    for each in (simulation, other):
        each.advance(0.9)
    assert np.array_equal(simulation.observe().fin_force, other.observe().fin_force)
    assert run.error_estimate.position < 1e-3


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Fin(0.2, "top", 1e-3, 3.0), "fin side must be"),
        (lambda: Fin(-0.2, "left", 1e-3, 3.0), "fin station must be > 0 m"),
        (lambda: Fin(0.2, "left", 0.0, 3.0), "fin area must be > 0 m"),
        (lambda: Fin(0.2, "left", 1e-3, 0.0), "fin aspect_ratio must be > 0"),
        (lambda: Fin(0.2, "left", 1e-3, 3.0, time_constant=0.0), "fin time_constant must be > 0 s"),
        (lambda: Fin(0.2, "left", 1e-3, 3.0, limit=0.0), "fin limit must be > 0 rad"),
        (lambda: Fin(0.2, "left", 1e-3, 3.0, angle="up"), "fin angle must be a number in rad"),
        (lambda: Fin(0.2, "left", 1e-3, 3.0, angle=([0.0, 0.0], [0.1, 0.2])), "fin angle must have rising times"),
        (lambda: Fin(0.2, "left", 1e-3, 3.0, angle=RollHold()), "fin time_constant must be given for a RollHold"),
        (lambda: Simulation(fins=Fin(0.2, "left", 1e-3, 3.0)), "fins must be a list of Fin"),
        (lambda: Simulation(fins=np.array("pair")), "fins must be a list of Fin"),
        (lambda: Simulation(fins=[0.2]), "fin must be a Fin, got 0.2"),
        (
            lambda: Simulation(fins=[Fin(1.0, "left", 1e-3, 3.0)]),
            "fin station must lie inside the body, 0 to 1 m, got 1 m",
        ),
        (
            lambda: Simulation(fins=[Fin(0.2, "left", 1e-3, 3.0)] * 2),
            "fins must be at different places, got two on the left",
        ),
        (lambda: Simulation(fins=row_of(*[0.1 * k for k in range(4)], time_constant=0.1)), "fins must have 3 servos"),
        (lambda: Simulation(fins=row_of(0.1), scene=Scene(planar=True)), "fins need a scene in space, got planar"),
    ],
)
def test_bad_input_names_the_argument(make, message):
    with pytest.raises(ValueError, match=message):
        make()


@pytest.mark.fault(
    "parameters", "two fins within a millimetre, or one that moves", "each has a name of its own, which stays"
)
def test_each_fin_has_a_name_of_its_own_that_stays_where_it_moves():
    def names(*stations, **others):
        fins = [Fin(station, "left", 1e-3, 2.5, **others) for station in stations]
        return [fin.name for fin in Simulation(law=STRAIGHT, fins=[*fins, Fin.pair(0.2, 1e-3, 2.5)]).fins]

    assert names(0.5001, 0.5004) == ["left", "left_2", "left_3", "right"] == names(0.3, 0.8)
    assert names(0.5, name="left_2") == ["left_2", "left", "right"]
    simulation = Simulation(law=STRAIGHT, fins=[Fin.pair(0.2, 1e-3, 2.5, name="rudder"), Fin(0.3, "left", 1e-3, 2.5)])
    assert [fin.name for fin in simulation.fins] == ["left_rudder", "right_rudder", "left"]
    assert [fin.name for fin in fins_from_text(text_of_fins(simulation.fins))] == [
        "left_rudder",
        "right_rudder",
        "left",
    ]
    with pytest.raises(ValueError, match="fins must have different names, got 'rudder' twice"):
        names(0.3, 0.4, name="rudder")
    with pytest.raises(ValueError, match="fin name must be a text of at most 100 characters without spaces"):
        names(0.3, name="a rudder")
    with pytest.raises(ValueError, match="fin name must be a str, got 3"):
        Fin.pair(0.3, 1e-3, 2.5, name=3)
