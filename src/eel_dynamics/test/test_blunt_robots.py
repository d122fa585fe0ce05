# SPDX-License-Identifier: Apache-2.0
"""Bodies made of blunt links: drag of the links, of blunt ends, cross flow and added mass by the shape of a section."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from cases import random_law, random_twist
from eel_dynamics.analysis.powers import drag_powers
from eel_dynamics.model.axes import turn_quaternion, turn_vector
from flows import FLOWS, formula
from flows import in_paper_axes as flow_in_paper_axes
from library_state import (
    DENSE,
    Reference,
    distance,
    expected,
    hydrodynamic_wrench,
    in_paper_axes,
    library_body,
    random_quaternion,
    reference_scene,
    rotation,
    simulate_in_paper_axes,
    snapshot,
    turn_twist,
)
from random_bodies import drawn_chain, drawn_hull
from reference import STEP, boyer_body
from scipy.interpolate import PchipInterpolator
from test_against_reference import EXACT, KINKS, STATIONS

from eel_dynamics import Accuracy, Body, Scene, Simulation, simulate, simulate_batch
from eel_gaits import Law, Term, falling, straight

STRAIGHT = Law(name="straight")
NO_CROSS_FLOW = {"roll_drag": 0.0, "lateral_drag": 0.0, "vertical_drag": 0.0}  # has kinks along the body
ROUND_OFF = 1e-12
NEUTRAL = {
    "lateral_drag": 1.98,
    "vertical_drag": 1.0,
    "lateral_added_mass": 1.0,
    "round_added_mass": 1.0,
    "joint_drag": 0.0,
    "link_length": 0.18,
    "base_drag": 0.0,
    "nose_drag": 0.036,
    "appendages": [],
}
LINKS = {
    "lateral_drag": "by shape",
    "vertical_drag": "by shape",
    "round_added_mass": 0.2,
    "joint_drag": 0.65,
    "link_length": 0.18,
    "base_drag": 0.2,
    "nose_drag": 0.4,
}


def blunt(body: Body, **changes) -> Body:
    """The body with the numbers of one made of links."""
    return body.changed(**LINKS | changes)


def prism(half_height=0.055, half_width=0.05, length=1.62, **others) -> Body:
    """One section all along."""
    return Body(
        length=length,
        half_width=lambda x: half_width + 0.0 * np.asarray(x),
        half_height=lambda x: half_height + 0.0 * np.asarray(x),
        **{"blunt_nose": True, "nose_added_mass": 0.0, **LINKS, **others},
    )


def with_hull(body, hull):
    """A namespace of the reference with these numbers."""
    return SimpleNamespace(**vars(body) | {"hull": hull})


def library(body) -> Body:
    """The Body of a namespace with a `hull`."""
    if not body.hull.get("blunt_nose"):
        return library_body(body).changed(**body.hull)
    given = {"half_width": body.half_width, "half_height": body.half_height, "nose": body.nose, "density": body.density}
    return Body(length=body.kinks[-1], kinks=body.kinks[1:-1], **given, **body.hull)


def compare(body, law, settings, tolerance, rng, flow=None, planar=False, panels=3, nodes=20, own=None):
    """All that a snapshot holds, against the reference, at a random time, pose and twist of the head."""
    length, own = body.kinks[-1], own or library(body)
    time, twist, place = rng.uniform(0.0, 3.0), random_twist(rng, planar=planar), 0.2 * rng.normal(size=3)
    q = np.array([0.0, 0.0, 0.6, 0.8]) if planar else random_quaternion(rng)
    place *= (1.0, 1.0, 0.0) if planar else 1.0
    special = [*body.kinks, *(each.x for each in body.hull["appendages"])]
    stations = np.unique(np.concatenate([length * STATIONS, body.kinks]))
    simulation = Simulation(
        body=own,
        scene=Scene(**settings, planar=planar),
        accuracy=DENSE,
        stations=stations,
        flow=None if flow is None else FLOWS[flow][1],
        position=turn_vector(place),
        orientation=turn_quaternion(q),
        twist=turn_twist(twist),
    )
    simulation.adopt(law, origin=-time)
    got = in_paper_axes(simulation.observe(wrench=True, load=True))
    reference = Reference(body, reference_scene(**settings), panels_per_span=panels, nodes_per_panel=nodes)
    if flow is not None:
        reference.flow = flow_in_paper_axes(formula(flow))
    reference.height = place[2]
    reference.pose = SimpleNamespace(position=place, axes=rotation(q), time=0.0)
    shape, relative, rate, acceleration = expected(reference, law, time, twist, q)
    fields = reference.fields(*shape, relative, rate)
    assert np.abs(fields.point_wrench).max() > 0.0
    for part in (slice(0, 3), slice(3, 6)):
        assert distance(got.head_acceleration[part], acceleration[part], np.abs(acceleration[part]).max()) < tolerance
    inner = np.abs(stations[:, None] - special).min(axis=1) > 1e-6 * length  # elsewhere there are two values
    at = lambda field: reference.space.evaluate(field, stations)[inner]  # noqa: E731
    lateral = np.abs(fields.force).max()
    assert distance(got.torque[inner], at(fields.torque)) < tolerance
    assert distance(got.force[inner], at(fields.force)) < tolerance
    R, r = reference.configuration(shape[0])
    eta = reference.through_water(reference.twists(shape[0], shape[1], relative), R, r, turning=True)
    resistive = reference.resistive(reference.space.evaluate(eta, stations), stations)[1][inner]
    assert distance(got.resistive_force[inner], resistive, lateral) < tolerance
    # d/dX of the reference's polynomials costs two digits
    reactive = (got.fluid_force - got.resistive_force)[inner]
    assert distance(reactive, at(fields.fluid_force - fields.resistive_force), lateral) < 100 * tolerance
    names = ["actuator_power", "wake_power", "nose_power", "drag_power", "appendages_power"]
    powers = np.array([getattr(fields, name) for name in names])
    assert distance([getattr(got.energy, name) for name in names], powers) < tolerance
    assert distance(got.tail_force, fields.tail_force + fields.point_wrench[0, 3:], lateral) < tolerance  # and the base
    assert distance(got.nose_force, fields.nose_force, lateral) < tolerance
    assert distance(got.energy.kinetic_fluid, fields.kinetic_fluid) < tolerance
    assert max(got.closure_force, got.closure_torque / length) < 1e-10 * lateral


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("planar", [False, True], ids=["space", "plane"])
def test_any_chain_against_the_reference(seed, planar):
    """Smooth along the body: without cross-flow drag, whose kinks both sides have."""
    rng = np.random.default_rng(seed)
    body = drawn_chain(rng)
    body.hull |= NO_CROSS_FLOW
    if planar:
        body.hull["appendages"] = tuple(replace(each, z=0.0, drag3=0.0) for each in body.hull["appendages"])
    law = random_law(rng, pitch=not planar, length=body.kinks[-1], spline=False)
    settings = {
        "friction": "none",
        "fluid_density": rng.uniform(700.0, 1300.0),
        "added_mass": ("corrected", "printed")[seed % 2],
        "tail_pressure": ("lumped", "distributed")[seed // 2 % 2],
        "wake": seed % 3 > 0,
    }
    compare(body, law, settings, EXACT, rng, planar=planar)


@pytest.mark.parametrize("seed", range(4))
def test_any_chain_with_drag_across_it_against_the_reference(seed):
    rng = np.random.default_rng(10 + seed)
    body = drawn_chain(rng) if seed % 2 else with_hull(boyer_body(), drawn_hull(rng, 1.0))
    law = random_law(rng, length=body.kinks[-1], spline=False)
    compare(body, law, {"friction": ("laminar", "blended")[seed // 2]}, KINKS, rng, panels=10, nodes=10)


@pytest.mark.parametrize("flow", FLOWS)
def test_a_chain_in_water_that_moves_against_the_reference(flow):
    rng = np.random.default_rng(20 + list(FLOWS).index(flow))
    hull = drawn_hull(rng, 1.0) | NO_CROSS_FLOW
    compare(with_hull(boyer_body(), hull), random_law(rng, spline=False), {"friction": "none"}, EXACT, rng, flow)


def test_the_water_s_wrench_for_a_prescribed_motion():
    rng = np.random.default_rng(30)
    body, law, twist, rate = drawn_chain(rng), random_law(rng, spline=False), random_twist(rng), rng.normal(size=6)
    body.hull |= NO_CROSS_FLOW
    reference = Reference(body, reference_scene(friction="none"), panels_per_span=4)
    wanted = reference.fluid_wrench(*law.curvature(0.4, reference.space.x), twist, rate)
    got = hydrodynamic_wrench(library(body), law, 0.4, twist, rate, Scene(friction="none"))
    assert distance(np.asarray(got), wanted) < EXACT


@pytest.mark.parametrize("seed", range(3))
def test_the_reference_keeps_its_energy_and_meets_the_tail_s_condition(seed):
    """By itself, as it is derived: d/dt of its energy, a complex step, is the sum of its powers."""
    rng = np.random.default_rng(40 + seed)
    body = drawn_chain(rng)
    reference = Reference(body, reference_scene(friction="laminar"), panels_per_span=2)
    K, K1, K2 = random_law(rng, spline=False, length=body.kinks[-1]).curvature(0.7, reference.space.x)
    twist, step = random_twist(rng), 1j * STEP
    rate = reference.acceleration(K, K1, K2, twist)
    growth = sum(reference.energies(K + step * K1, K1 + step * K2, twist + step * rate)).imag / STEP
    found = reference.fields(K, K1, K2, twist, rate)
    names = "actuator_power", "wake_power", "nose_power", "drag_power", "appendages_power"
    powers = np.array([getattr(found, name) for name in names])
    # kinks of the cross flow inside panels, in the torques that are integrated from nose to tail
    assert abs(growth - powers.sum()) < 1e-6 * np.abs(powers).max()
    scale = np.repeat([np.abs(found.torque).max(), np.abs(found.force).max()], 3)
    assert np.abs(found.tail_residual / scale).max() < 1e-6


# -- closed forms ---------------------------------------------------------------------------------------------------
def observed(body, scene=None, twist=(0.0, 0.0, 0.0, -0.3, 0.2, 0.0), stations=11):
    """A snapshot of the straight body with this twist of the head, in the paper's axes."""
    return snapshot(body, STRAIGHT, twist=twist, settings=scene or {"friction": "none"}, stations=stations)


def test_loads_on_a_prism_are_those_by_hand():
    """a = 0.055, b = 0.05, l = 1.62 m, links of 0.18 m, V = (-0.3, 0.2, 0); numbers of six digits."""
    seen, close = observed(prism()), {"rel": 2e-5}  # half of the last digit given
    # one panel's Gauss weights sum to the length, so that a constant load per length is exact
    assert 1.62 * seen.resistive_force == pytest.approx(np.tile([2.7334, -4.5295, 0.0], (11, 1)), **close)
    assert seen.nose_force == pytest.approx([0.15551, 0.0, 0.0], **close, abs=1e-15)
    added = 3.2201  # kg/m
    assert seen.tail_force == pytest.approx([0.07776 - 0.5 * added * 0.2**2, 0.0, 0.0], abs=7e-6)  # of five digits
    assert seen.force[-1] == pytest.approx(seen.tail_force, abs=1e-12)
    assert seen.energy.drag_power == pytest.approx(-0.8200 - 4.5295 * 0.2 - 0.07776 * 0.3, rel=5e-5)  # four digits
    assert seen.energy.appendages_power == 0.0


def test_each_term_of_a_prism_by_itself():
    """The same without the others: k5 = 0.031198 m, c_2 = 1.270909, beta = 0.338843."""
    links = prism(lateral_drag=0.0, vertical_drag=0.0, base_drag=0.0, nose_drag=0.0)
    assert observed(links).energy.drag_power == pytest.approx(-0.8200, rel=5e-5)  # four digits
    speed, k5 = np.hypot(0.3, 0.2), 0.65 * np.pi * 0.055 * 0.05 / 0.18
    assert k5 == pytest.approx(0.031198, rel=2e-5)
    assert observed(links).energy.drag_power == pytest.approx(-500.0 * 1.62 * k5 * speed * 0.09, rel=ROUND_OFF)
    across = observed(prism(joint_drag=0.0)).resistive_force
    assert across[:, 1] == pytest.approx(np.full(11, -500.0 * 2 * 1.270909 * 0.055 * 0.04), rel=1e-6)  # seven digits
    kinetic = observed(prism(), {"resistive": False}).energy.kinetic_fluid
    assert kinetic == pytest.approx(0.5 * 1.62 * 0.04 * 1000.0 * np.pi * 0.055**2 * 0.338843, rel=2e-6)  # six digits
    assert observed(links, {"resistive": False}).energy.drag_power == 0.0


@pytest.mark.parametrize("shares", [(0.4, 0.2), (0.6, 0.0), (0.0, 0.6)], ids=["both", "nose", "base"])
def test_a_coast_is_that_by_hand(shares):
    """U0 / (1 + 0.6 U0 t / (2 l)) of a neutral prism: 0.13642 m/s after 5 s of 0.198 m/s."""
    body = prism(length=0.658, joint_drag=0.0, nose_drag=shares[0], base_drag=shares[1])
    run = simulate(STRAIGHT, 5.0, body=body, scene=Scene(friction="none"), twist=(0, 0, 0, 0.198, 0, 0), accuracy=1e-6)
    exact = 0.198 / (1.0 + 0.6 * 0.198 * run.time / (2 * 0.658))
    assert exact[-1] == pytest.approx(0.13642, abs=5e-6)  # half of the last digit
    assert run.twist[:, 3] == pytest.approx(exact, rel=1e-6)  # the run's accuracy
    assert np.abs(run.twist[:, [0, 1, 2, 4, 5]]).max() < ROUND_OFF


def test_links_of_a_straight_body_are_a_friction_of_the_square():
    """c_s V / p over the body is what c_b A would be; and by hand, from a coast."""
    options = {"scene": Scene(friction="none"), "twist": (0, 0, 0, 0.3, 0, 0), "accuracy": 1e-6, "duration": 3.0}
    links, base = (
        simulate(STRAIGHT, body=prism(nose_drag=0.0, joint_drag=c_s, base_drag=c_b), **options)
        for c_s, c_b in ((0.5, 0.0), (0.0, 0.5 * 1.62 / 0.18))
    )
    assert links.twist == pytest.approx(base.twist, abs=1e-6)  # the runs' accuracy
    assert links.twist[:, 3] == pytest.approx(0.3 / (1.0 + 0.5 * 0.3 * links.time / (2 * 0.18)), rel=1e-6)
    assert links.energy.drag_power == pytest.approx(base.energy.drag_power, rel=1e-5)  # the third power of the speed


# -- what must hold -------------------------------------------------------------------------------------------------
def differences(one, other) -> list[str]:
    """Names of the arrays of two runs that are not the same to the last bit."""
    names = [name for name, value in vars(one).items() if isinstance(value, np.ndarray)]
    pairs = {name: (getattr(one, name), getattr(other, name)) for name in names}
    pairs |= {name: (one.energy[name], other.energy[name]) for name in one.energy.keys()}  # noqa: SIM118
    assert len(pairs) > 30
    return [name for name, (mine, yours) in pairs.items() if not np.array_equal(mine, yours)]


DATA = np.unique(np.concatenate([np.linspace(0.0, 1.0, 21), [0.05, 0.2, 0.75]]))
OF_DATA = Body(x=DATA, **{name: getattr(Body.boyer2010(), name)(DATA) for name in ("half_width", "half_height")})


@pytest.mark.parametrize("planar", [True, False])
@pytest.mark.parametrize("body", [Body.boyer2010(), OF_DATA], ids=["functions", "data"])
def test_neutral_numbers_change_nothing_to_the_last_bit(body, planar):
    law, start = straight() if planar else falling(), (0.0, 0.0, 0.2, 0.3, 0.1, 0.0)
    options = {"scene": Scene(planar=planar), "accuracy": 1e-3, "twist": start, "load": True}
    plain, neutral = (simulate(law, 1.2, body=each, **options) for each in (body, body.changed(**NEUTRAL)))
    assert differences(plain, neutral) == []
    links = simulate(law, 1.2, body=blunt(body), **options)
    assert {"position", "force", "drag_power", "resistive_force"} <= set(differences(plain, links))


def test_a_coefficient_of_one_value_along_the_body_is_the_number():
    options = {"accuracy": 1e-3, "twist": (0.0, 0.0, 0.2, 0.3, 0.1, 0.0)}
    number, array = (
        simulate(falling(), 1.2, body=OF_DATA.changed(lateral_drag=given), **options)
        for given in (1.98, np.full(len(DATA), 1.98))
    )
    assert differences(number, array) == []
    constant = Body.boyer2010().changed(lateral_drag=lambda x: 1.98 + 0.0 * x, vertical_drag=lambda x: 1.0 + 0.0 * x)
    assert differences(*(simulate(falling(), 1.2, body=each, **options) for each in (None, constant))) == []


@pytest.mark.parametrize("by_shape", [False, True])
def test_arrays_along_a_body_of_data_are_monotone_cubics(by_shape):
    """Against the reference with panels that end at the points; between them the cubics are smooth to first order. The
    sections are high here and wide there, and appendages lie between the points."""
    rng, x = np.random.default_rng(50), np.linspace(0.0, 1.0, 15)
    arrays = {name: rng.uniform(0.8, 1.5, len(x)) for name in ("lateral_drag", "vertical_drag", "lateral_added_mass")}
    shape = {name: np.append(0.0, rng.uniform(0.02, 0.06, len(x) - 1)) for name in ("half_width", "half_height")}
    others = drawn_hull(rng, 1.0, along=False) | (dict.fromkeys(list(arrays)[:2], "by shape") if by_shape else {})
    arrays = {name: values for name, values in arrays.items() if not (by_shape and name in list(arrays)[:2])}
    own = Body(x=x, **shape, nose=(0.02, 0.03, 0.05), **others | arrays)
    squares = {name: PchipInterpolator(x, values**2) for name, values in shape.items()}
    body = SimpleNamespace(
        **{name: lambda at, cubic=cubic: np.sqrt(np.maximum(cubic(at), 0.0)) for name, cubic in squares.items()},
        kinks=tuple(x),
        nose=(0.02, 0.03, 0.05),
        density=1000.0,
        hull=others | {name: PchipInterpolator(x, values) for name, values in arrays.items()},
    )
    compare(body, random_law(rng, spline=False), {"friction": "none"}, 1e-5, rng, panels=2, nodes=10, own=own)


SIZES = [("joint_drag", (0.0, 0.3, 0.65, 0.87)), ("base_drag", (0.0, 0.5, 1.5)), ("nose_drag", (0.036, 0.4, 0.8))]


@pytest.mark.parametrize(("name", "values"), SIZES)
def test_more_drag_swims_more_slowly(name, values):
    bodies = [blunt(Body.boyer2010(), **{name: value}) for value in values]
    options = {"scenes": Scene(planar=True), "accuracy": 1e-3, "estimate": False, "sample_period": 1.0}
    batch = simulate_batch(straight(), 6.0, bodies=bodies, **options)
    speeds = np.linalg.norm(batch.position[:, -1] - batch.position[:, -2], axis=1)
    assert np.all(np.diff(speeds) < -5e-3 * speeds[0]) and speeds[-1] > 0.0, speeds  # five times the accuracy


@pytest.mark.parametrize("water", ["still", "current", "shear"])
def test_ledger_closure_and_powers_of_any_chain(water):
    """In still water each new power takes energy away; the powers by kind are those of the ledger in any."""
    rng = np.random.default_rng(60 + len(water))
    body = library(drawn_chain(rng))
    law = random_law(rng, length=body.length, spline=False)
    run = simulate(
        law,
        0.5,
        body=body,
        scene=Scene(friction="laminar", current=(0.1, -0.2, 0.05) if water == "current" else (0.0, 0.0, 0.0)),
        flow=FLOWS[water][1] if water in FLOWS else None,
        accuracy=1e-7,
        twist=(0.3, 0.2, 0.1, 0.3, 0.1, 0.1),
    )
    passed = sum(
        np.abs(run.energy[f"{part}_work"]).max() for part in ("actuator", "drag", "appendages", "wake", "flow")
    )
    assert np.abs(run.energy.residual).max() < 1e-6 * passed  # ten times the accuracy
    assert run.closure_force.max() < 1e-10 * np.abs(run.force).max()
    assert run.closure_torque.max() < 1e-10 * np.abs(run.force).max() * body.length
    powers = drag_powers(run)
    if water != "shear":  # the ledger of a current is in its frame
        assert powers.max() <= 0.0 and powers[:, 4:].max() < 0.0 and run.energy.appendages_power.max() < 0.0
    assert powers.sum(axis=1) == pytest.approx(run.energy.drag_power, rel=1e-9)


def test_friction_off_leaves_the_links_and_no_resistance_clears_them():
    body = blunt(Body.boyer2010(), lateral_drag=0.0, vertical_drag=0.0, roll_drag=0.0)
    without = {"friction": "none"}
    assert observed(body, without).energy.drag_power < -0.01
    assert observed(body, {"resistive": False}).energy.drag_power == 0.0
    thick = observed(body, without | {"fluid_density": 2000.0}).energy.drag_power
    assert thick == pytest.approx(2.0 * observed(body, without).energy.drag_power, rel=ROUND_OFF)
    kept, base = (observed(each, {**without, "wake": False}) for each in (body, body.changed(base_drag=0.0)))
    area = np.pi * float(body.half_width(1.0) * body.half_height(1.0))
    assert kept.force[-1] - base.force[-1] == pytest.approx([100.0 * area * 0.09, 0.0, 0.0], rel=1e-9, abs=1e-12)


ROUND = Body(
    length=1.0,
    half_width=lambda x: 0.04 - 0.02 * np.asarray(x) ** 2,
    half_height=lambda x: 0.04 - 0.02 * np.asarray(x) ** 2,
    blunt_nose=True,
    **LINKS,
)


@pytest.mark.parametrize("planar_law", [True, False])
def test_a_round_body_has_no_up(planar_law):
    """Rolled by 90 degrees, with the law's axes turned likewise, it swims alike."""
    waves = {"wavelength": 1.0, "period": 0.7}
    yaw, pitch = (1.0, 2.0), (0.6, -1.0)
    terms = [("yaw", yaw, "pitch", yaw)]
    if not planar_law:
        terms.append(("pitch", pitch, "yaw", tuple(-each for each in pitch)))
    laws = (Law(*(Term(axis=t[k], amplitude=t[k + 1], **waves) for t in terms)) for k in (0, 2))
    root, twist = np.sqrt(0.5), np.array([0.1, 0.2, 0.3, -0.4, 0.1, 0.2])
    turn = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])  # of components, to the rolled axes
    rolled_twist = np.concatenate([turn @ twist[:3], turn @ twist[3:]])
    starts = {"twist": twist}, {"twist": rolled_twist, "orientation": (root, 0.0, 0.0, root)}
    level, rolled = (
        simulate_in_paper_axes(law, 1.0, body=ROUND, scene=Scene(friction="laminar"), accuracy=1e-4, **start)
        for law, start in zip(laws, starts, strict=True)
    )
    close = 1e-10  # round-off of 1e-16 that the soft roll grows
    assert np.abs(rolled.position - level.position).max() < close
    assert (
        distance(rolled.force, level.force @ turn.T) < close and distance(rolled.torque, level.torque @ turn.T) < close
    )
    assert distance(rolled.energy.drag_power, level.energy.drag_power) < close
    # without the added mass of both axes alike it is not round
    one_axis = ROUND.changed(lateral_added_mass=0.5)
    apart = simulate_in_paper_axes(
        Law(*(Term(axis=t[2], amplitude=t[3], **waves) for t in terms)), 1.0, body=one_axis, accuracy=1e-4, **starts[1]
    )
    assert np.abs(apart.position - level.position).max() > 1e-3


def mirrored(law):
    flip = lambda term: tuple(-a for a in term.amplitude) if term.axis == "yaw" else term.amplitude  # noqa: E731
    return Law(*(replace(term, amplitude=flip(term)) for term in law.terms))


def test_the_mirror_image_and_another_pose():
    rng = np.random.default_rng(70)
    namespace = drawn_chain(rng)
    length, sign = namespace.kinks[-1], np.array([1.0, -1.0, 1.0])
    law, start = random_law(rng, length=length, spline=False), np.array([0.3, 0.2, 0.1, 0.3, 0.1, 0.1])
    body = library(namespace)
    image = body.changed(appendages=[replace(each, y=-each.y) for each in body.appendages])
    q, place = random_quaternion(rng), rng.normal(size=3)
    options = {"scene": Scene(friction="laminar"), "accuracy": 1e-3, "sample_period": 0.05}
    plain = simulate(law, 0.5, body=body, twist=start, **options)
    mirror = simulate(mirrored(law), 0.5, body=image, twist=start * (-1, 1, -1, 1, -1, 1), **options)
    moved = simulate(law, 0.5, body=body, twist=start, position=place, orientation=q, **options)
    assert distance(mirror.position, plain.position * sign) < 1e-11  # signs alone change, but for sums' order
    assert distance(mirror.force, plain.force * sign) < 1e-11
    assert distance(moved.position, place + plain.position @ rotation(q).T) < 1e-11
    assert distance(moved.torque, plain.torque) < 1e-11


def test_a_batch_of_blunt_and_smooth_bodies_swims_as_each_alone():
    bodies = [Body.boyer2010(), blunt(Body.boyer2010()), blunt(Body.boyer2010(), joint_drag=0.0), ROUND]
    options = {"accuracy": 1e-3, "estimate": False, "sample_period": 0.1, "stations": 11}
    batch = simulate_batch(straight(), 0.5, bodies=bodies, **options)
    for each, body in zip(batch, bodies, strict=True):
        assert differences(each, simulate(straight(), 0.5, body=body, **options)) == []


def test_steps_of_a_chain_keep_their_order():
    """|V| V1 is analytic but where all of V is 0: energy from nowhere falls by the fourth order of the steps."""
    body = blunt(Body.boyer2010(), **NO_CROSS_FLOW)

    def residual(step):
        run = simulate(
            straight(),
            0.5,
            body=body,
            scene=Scene(friction="none"),
            accuracy=Accuracy(name="steps", resolution=40.0, step=step),
            twist=(0, 0, 0, 0.4, 0, 0),
            estimate=False,
        )
        return np.abs(run.energy.residual).max()

    coarse, fine = residual(1e-2), residual(5e-3)
    assert 3.5 < np.log2(coarse / fine) < 4.6, (coarse, fine)
