# SPDX-License-Identifier: Apache-2.0
"""Bodies that weigh: `Scene(weight=True)`, mass along the body, and a centre of mass off the axis."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from cases import falling_law, random_law, random_twist
from draws import few, numbers, quaternions, scenes, swimmers, twists
from eel_dynamics.commands.ballast import main as command
from eel_dynamics.model import section_data
from eel_dynamics.model.axes import turn_vector
from eel_dynamics.model.inertia import straight_inertia
from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.model.section_data import nose_of
from flows import FLOWS, formula
from flows import in_paper_axes as in_paper_axes_of_flow
from hypothesis import given
from hypothesis import strategies as st
from library_state import DENSE, Reference, distance, expected, in_paper_axes, library_body, rotation, turn_twist
from reference import boyer_body
from reference import scene as reference_scene
from scipy.interpolate import make_interp_spline
from test_against_reference import EXACT, check

from eel_dynamics import Accuracy, Body, FlowField, Run, Scene, Simulation, ballast_for, simulate, trim_of
from eel_gaits import Law, Term, straight

pytestmark = pytest.mark.identity("Bodies that weigh")
G = 9.80665
ROUND_OFF = 1e-11
STRAIGHT = Law(name="straight")


def weighing(body, extra=0.0, slope=0.0, offset=0.0, lean=0.0):
    """The body with the mass of its water, times 1 + extra + slope (X/l - 1/2), and h = offset (1 + lean X/l) [m]."""
    length = body.kinks[-1]

    def mass(x):
        area = np.pi * body.half_width(x) * body.half_height(x)
        return 1000.0 * area * (1.0 + extra + slope * (np.asarray(x) / length - 0.5))

    def low(x):
        return offset * length * (1.0 + lean * np.asarray(x) / length)

    return SimpleNamespace(**vars(body), mass=mass, offset=low)


@st.composite
def heavy_swimmers(draw):
    body, law = draw(swimmers())
    change = [
        draw(numbers(-0.2, 0.4)),
        draw(numbers(-0.5, 0.5)),
        draw(numbers(-0.008, 0.008)),
        draw(numbers(-1.0, 1.0)),
    ]
    return weighing(body, *change), law


@few(6)
@given(heavy_swimmers(), numbers(0.0, 3.0), twists(), quaternions(), scenes(weight=True))
def test_any_body_that_weighs_against_the_reference(measured, swimmer, time, twist, q, settings):
    """Head's acceleration, internal wrench, loads, energies and powers; its current is the water's frame."""
    check(measured, "any body that weighs", *swimmer, time, twist, q, settings, EXACT, nodes=24)


@pytest.mark.parametrize("name", FLOWS)
def test_weight_in_water_that_moves_against_the_reference(measured, name):
    """An offset and a net weight in each flow, where the water's acceleration acts at the centre and not at e."""
    rng = np.random.default_rng(list(FLOWS).index(name))
    body, law, twist = weighing(boyer_body(), 0.1, 0.3, 0.006, 0.5), random_law(rng, spline=False), random_twist(rng)
    settings, time, position = {"resistive": False, "weight": True}, 0.7, (0.1, 0.05, -0.2)
    simulation = Simulation(
        body=library_body(body),
        scene=Scene(**settings),
        accuracy=DENSE,
        flow=FLOWS[name][1],
        position=turn_vector(position),
        twist=turn_twist(twist),
    )
    simulation.adopt(law, origin=-time)
    got = in_paper_axes(simulation.observe(wrench=True, load=True))
    reference = Reference(body, reference_scene(**settings), panels_per_span=3, nodes_per_panel=20)
    reference.flow, reference.height = in_paper_axes_of_flow(formula(name)), position[2]
    reference.pose = SimpleNamespace(position=np.array(position), axes=np.eye(3), time=0.0)
    shape, relative, rate, acceleration = expected(reference, law, time, twist)
    fields = reference.fields(*shape, relative, rate)
    measured("head's acceleration in water that moves", distance(got.head_acceleration, acceleration), EXACT)
    at = lambda field: reference.space.evaluate(field, simulation.x)  # noqa: E731
    apart = distance(got.torque, at(fields.torque)), distance(got.force, at(fields.force))
    measured("internal torque and force in water that moves", apart, EXACT)
    measured("potential energy", abs(got.energy.potential - fields.potential), 1e-12, unit="J")


def tilted(vector):
    """Quaternion of the turn that takes up to the direction of `vector`."""
    up = np.asarray(vector) / np.linalg.norm(vector)
    q = np.array([-up[1], up[0], 0.0, 1.0 + up[2]])
    return q / np.linalg.norm(q)


def test_gravity_and_the_water_s_acceleration_are_one(measured, monkeypatch):
    """A neutrally buoyant body with its centre of mass off the axis, in water that accelerates uniformly: still water
    whose gravity is g up + a, plus the displacement of the water, with the same internal wrench."""
    time, a = np.linspace(0.0, 2.0, 9), np.array([1.5, -2.0, 1.0])
    body = library_body(weighing(boyer_body(), offset=0.01, slope=0.4))
    law = random_law(np.random.default_rng(4), spline=False, size=0.7)
    options = {"scene": Scene(friction="laminar", weight=True), "accuracy": "reference", "sample_period": 0.1}
    flow = FlowField(
        lambda x, t: 0 * x + a * t, jacobian=lambda x, t: np.zeros((len(x), 3, 3)), rate=lambda x, t: 0 * x + a
    )
    moved = simulate(law, 1.5, body=body, flow=flow, **options)
    gravity = G * np.array([0.0, 0.0, 1.0]) + a
    monkeypatch.setattr(section_data, "GRAVITY", np.linalg.norm(gravity))
    q = tilted(gravity)
    still = simulate(law, 1.5, body=body.changed(name="elsewhere"), orientation=q * (-1, -1, -1, 1), **options)
    world = rotation(q)
    gone = moved.position - 0.5 * a * moved.time[:, None] ** 2
    measured("path in accelerating water less the water's", np.abs(gone - still.position @ world.T), 1e-7, unit="m")
    measured("its internal force", distance(moved.force, still.force), 1e-6)
    assert time[-1] > moved.time[-1] and np.abs(moved.position - still.position).max() > 1.0


@pytest.mark.parametrize("height", [1.0, -1000.0])
def test_weight_is_the_same_at_any_depth(measured, height):
    body = library_body(weighing(boyer_body(), 0.05, 0.2, 0.005))
    options = {"body": body, "scene": Scene(weight=True), "sample_period": 0.1}
    here, there = (simulate(falling_law(), 1.0, position=(0, 0, z), **options) for z in (0.0, height))
    measured("path at another depth", np.abs(there.position - here.position - (0, 0, height)), 1e-9, unit="m")
    measured("energy from nowhere at another depth", abs(there.energy.residual).max(), 1e-6, unit="J")


def test_a_trimmed_body_stays_at_rest():
    body = Body.boyer2010().changed(centre_of_mass_offset=0.01)
    run = simulate(STRAIGHT, 5.0, body=body, scene=Scene(weight=True), sample_period=0.5)
    assert np.all(run.position == 0.0) and np.all(run.twist == 0.0) and np.all(run.energy.residual == 0.0)
    assert trim_of(body).pitch == 0.0 and "floats" in run.summary()


def test_the_mirror_of_a_swim_with_weight_mirrors_it(measured):
    rng = np.random.default_rng(3)
    law, twist, sign = random_law(rng, spline=False, size=0.7), random_twist(rng), np.array([1, -1, 1])
    flipped = Law(*(replace(t, amplitude=tuple(-a for a in t.amplitude)) if t.axis == "yaw" else t for t in law.terms))
    body = library_body(weighing(boyer_body(), 0.02, 0.2, 0.008))
    options = {"duration": 1.0, "sample_period": 0.1, "scene": Scene(weight=True), "body": body}
    plain = simulate(law, twist=twist, **options)
    mirror = simulate(flipped, twist=np.concatenate([-sign * twist[:3], sign * twist[3:]]), **options)
    measured("path of the mirrored swimmer", distance(mirror.position, plain.position * sign), ROUND_OFF)


def integrals(body):
    """Of a library body along X: integral (1, X, X^2) of m, of rho_f A, and of the added mass along E3."""
    space = Reference(boyer_body(), reference_scene(), panels_per_span=4, nodes_per_panel=24).space
    x = space.x
    rows = body.mass_per_length(x), 1000.0 * np.pi * body.half_width(x) * body.half_height(x)
    rows = np.array(
        [*rows, 1000.0 * np.pi * body.half_width(x) ** 2, body.mass_per_length(x) * body.half_height(x) ** 2 / 4]
    )
    return np.array([(rows * x**power) @ space.weights for power in range(3)]).T, space, rows


def test_release_of_an_untrimmed_body(measured):
    """Heave and pitch from rest, and the shear force, by hand: (m + M3) (a - theta X) = net g per length."""
    body = library_body(weighing(boyer_body(), 0.1, 0.5))
    simulation = Simulation(body=body, scene=Scene(weight=True), accuracy=DENSE, law=STRAIGHT, stations=21)
    got = simulation.observe(wrench=True, load=True)
    (m, displaced, added, turning), space, rows = integrals(body)
    matrix = np.array([[(m + added)[0], (m + added)[1]], [(m + added)[1], (m + added)[2] + turning[0]]])
    net = displaced - m
    heave, turn = np.linalg.solve(matrix, G * net[:2])  # z'' at the nose; growth of z'' with X
    measured("heave at release", got.head_acceleration[5] / heave - 1.0, 1e-8)
    measured("pitch at release", got.head_acceleration[1] / turn - 1.0, 1e-8)
    density = (rows[0] + rows[2]) * (heave + turn * space.x) - G * (rows[1] - rows[0])
    shear = space.evaluate(space.cumulate(density[:, None])[:, 0], simulation.x)
    measured("shear force at release", distance(got.force[:, 2], shear), 1e-8)
    measured("mass", body.mass / m[0] - 1.0, 1e-12)


def test_a_heavy_body_falls_flat_at_its_terminal_speed(measured):
    """m = rho_f A + w b: weight and vertical drag are both proportional to the width, V^2 = w g / (rho_f c_3)."""
    robot, more = Body.boyer2010(), 3.0
    body = robot.changed(
        mass_per_length=lambda x: (
            1000.0 * np.pi * robot.half_width(x) * robot.half_height(x) + more * robot.half_width(x)
        )
    )
    speed = np.sqrt(more * G / 1000.0)
    twist = 0, 0, 0, 0, 0, -speed
    run = simulate(STRAIGHT, 3.0, body=body, scene=Scene(weight=True, wake=False), twist=twist, sample_period=0.5)
    measured("terminal speed", run.twist[:, 5] / -speed - 1.0, 1e-9)
    measured("turning of a body that falls flat", np.abs(run.twist[:, :3]), 1e-9, unit="rad/s")
    shed = simulate(STRAIGHT, 0.5, body=body, scene=Scene(weight=True), twist=twist, sample_period=0.5)
    assert shed.head_acceleration[0, 3] > 0.0  # of T_f at the tail, a suction that the theory has there


def test_small_roll_has_the_frequency_of_sway_yaw_and_roll(measured):
    """The 3 x 3 of sway, yaw and roll; the weight's moment acts in roll alone. The approximation by a metacentric
    height leaves out the couplings and m h^2: 7 % too high at 10 mm."""
    for height, too_high in ((0.01, 0.07), (0.02, 0.28)):
        robot = Body.boyer2010()
        body = robot.changed(centre_of_mass_offset=height)
        matrix = straight_inertia(*table_of(body, Scene()), True)[np.ix_([0, 2, 4], [0, 2, 4])]
        square = np.linalg.inv(matrix)[0, 0] * body.mass * G * height
        plain = body.mass * G * height / straight_inertia(*table_of(robot, Scene()))[0, 0]
        assert plain / square - 1.0 == pytest.approx(too_high, abs=0.01)
        scene, lean = Scene(weight=True, resistive=False, wake=False), 1e-5
        simulation = Simulation(
            body=body, scene=scene, accuracy=DENSE, law=STRAIGHT, orientation=(np.sin(lean / 2), 0, 0, np.cos(lean / 2))
        )
        roll = -simulation.observe().head_acceleration[0] / lean
        measured("square of the roll's frequency", roll / square - 1.0, 1e-9)


def table_of(body, scene):
    here = Simulation(body=body, scene=scene, accuracy=DENSE).discretisation
    return here.grid, here.sections, nose_of(body, scene)[0], body.length


@few(4)
@given(heavy_swimmers(), twists(), scenes(drag=True, weight=True))
def test_the_ledger_closes_with_weight(measured, swimmer, twist, settings):
    body, law = swimmer
    run = simulate(law, 1.0, body=library_body(body), scene=Scene(**settings), accuracy="fine", twist=twist)
    passed = sum(np.abs(run.energy[name]).max() for name in run.energy.keys() if name.endswith("work"))  # noqa: SIM118
    measured("energy from nowhere, accuracy fine (by all work)", np.abs(run.energy.residual).max() / passed, 1e-5)
    assert np.max(run.closure_torque) < 1e-7 and np.max(run.closure_force) < 1e-7


def test_ledger_of_the_falling_gait_with_weight(measured):
    body = library_body(weighing(boyer_body(), 0.05, 0.2, 0.01))
    finest = Accuracy(name="finest", resolution=60.0, tolerance=1e-10)
    scene = Scene(friction="laminar", weight=True)
    run = simulate(falling_law(), 3.0, body=body, scene=scene, accuracy=finest, sample_period=0.1)
    measured("energy from nowhere, falling gait", np.abs(run.energy.residual).max(), 1e-8, unit="J")
    moved = np.gradient(run.twist[:, 0], run.time)
    assert np.corrcoef(moved[2:-2], run.twist_rate[2:-2, 0])[0, 1] > 0.99


def test_the_acceleration_is_the_rate_of_the_marched_motion(measured):
    """Both forms, in a vortex street: the momentum that is marched, and the balance that gives the acceleration."""
    body = library_body(weighing(boyer_body(), 0.05, 0.2, 0.01))
    wave = {"wavelength": 1.0, "period": 1.0}
    law = Law(Term(axis="yaw", amplitude=(1.5,), **wave), Term(axis="pitch", amplitude=(0.7, 1.0), phase=1.0, **wave))
    finest = Accuracy(name="finest", resolution=100.0, tolerance=1e-12)
    street = FLOWS["street"][1]
    run = simulate(
        law,
        0.4,
        body=body,
        scene=Scene(weight=True, resistive=False),
        flow=street,
        accuracy=finest,
        sample_period=0.005,
    )
    gained = make_interp_spline(run.time, run.twist_rate, k=9).antiderivative()(run.time)
    measured("integral of the acceleration against the marched twist", distance(gained, run.twist - run.twist[0]), 1e-8)


def test_ballast_makes_a_body_float_level(measured, tmp_path):
    body = library_body(weighing(boyer_body(), -0.2, 0.3))
    found = ballast_for(body, offset=0.02)
    assert found.mass == pytest.approx(trim_of(body).displaced - trim_of(body).mass)
    measured("net weight with ballast", abs(found.trim.net_weight), 1e-9, unit="N")
    measured("its pitch", abs(found.trim.pitch), 1e-9, unit="rad")
    run = simulate(STRAIGHT, 2.0, body=found.body, scene=Scene(weight=True), sample_period=0.5)
    measured("drift of a ballasted body in 2 s", np.abs(run.position), 1e-9, unit="m")
    run.save(tmp_path / "run.nc")
    again = Run.load(tmp_path / "run.nc")
    assert again.scene.weight and abs(trim_of(again.body).net_weight) < 1e-9 and abs(trim_of(again.body).pitch) < 1e-9


def test_the_command_writes_a_body_that_floats(tmp_path, capsys):
    path = tmp_path / "level.csv"
    assert command(["--scene", "density=900", "--offset", "0.01", "--out", str(path)]) == 0
    said = capsys.readouterr().out
    assert "rises" in said and "floats" in said and "0.194" in said
    trim = trim_of(Body.from_file(path))
    assert abs(trim.net_weight) < 1e-3 and abs(trim.pitch) < 1e-3 and trim.offset == pytest.approx(0.001, rel=1e-2)
    assert command(["--scene", "density=1100"]) == 2
    assert "body must be lighter than its water to take ballast" in capsys.readouterr().err


ROBOT = Body.boyer2010()
FEW = np.linspace(0.0, 1.0, 5)
ARRAYS = {"x": FEW, "half_width": 0.03 * np.sqrt(FEW), "half_height": 0.04 * np.sqrt(FEW)}


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: ROBOT.changed(mass_per_length=-1.0), "body mass_per_length must be >= 0 kg/m"),
        (
            lambda: ROBOT.changed(mass_per_length=lambda x: 1.0 - 2.0 * x),
            r"mass_per_length must be >= 0 kg/m, got -0.0",
        ),
        (
            lambda: ROBOT.changed(mass_per_length=lambda x: 0 * x + np.nan),
            "mass_per_length must be >= 0 kg/m, got nan at",
        ),
        (lambda: ROBOT.changed(mass_per_length=[1.0, 2.0]), "must be a number or a function of X"),
        (lambda: Body(**ARRAYS, mass_per_length=[1.0, 2.0]), "body mass_per_length must have as many values as x, 5"),
        (lambda: ROBOT.changed(mass_per_length=2.0, density=900.0), "body density must not be given beside"),
        (lambda: ROBOT.changed(centre_of_mass_offset=0.06), r"centre_of_mass_offset must lie within the section, 0\.0"),
        (lambda: Scene(weight=True, metacentric_height=0.01), "scene metacentric_height must be 0 m where weight"),
        (lambda: Scene(weight=2.0), "scene weight"),
        (
            lambda: Simulation(body=ROBOT.changed(centre_of_mass_offset=0.01), scene=Scene(metacentric_height=0.01)),
            "scene metacentric_height must be 0 m for a body with centre_of_mass_offset",
        ),
        (
            lambda: Simulation(body=ROBOT.changed(mass_per_length=2.0), scene=Scene(density=900.0)),
            "scene density must be none for a body with mass_per_length, got 900",
        ),
        (
            lambda: Simulation(scene=Scene(planar=True, weight=True, density=900.0)),
            "scene planar must be off where weight and buoyancy differ, got 1.9",
        ),
        (lambda: trim_of(scene=True), "scene must be a Scene, got True"),
        (lambda: ballast_for(scene=0.0), "scene must be a Scene, got 0.0"),
        (lambda: ballast_for(ROBOT), "body must be lighter than its water"),
        (lambda: ballast_for(ROBOT.changed(mass_per_length=lambda x: 9.0 * (x < 0.2))), "ballast must fit between"),
        (lambda: ballast_for(scene=Scene(density=900.0), length=-1.0), "ballast length must be > 0 m"),
        (lambda: ballast_for(scene=Scene(density=900.0), offset=0.2), "ballast offset must lie within the section"),
    ],
)
def test_bad_input_names_the_argument(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_a_neutral_planar_swim_is_the_same_with_weight():
    law = random_law(np.random.default_rng(8), pitch=False, size=0.7)
    bodies = ROBOT, ROBOT.changed(centre_of_mass_offset=0.01)
    plain, low = (
        simulate(law, 1.0, scene=Scene(planar=True, weight=body is not ROBOT), body=body, sample_period=0.1)
        for body in bodies
    )
    assert np.array_equal(plain.position, low.position) and np.all(low.energy.potential == 0.0)


def test_mass_of_arrays_and_of_functions_are_one(tmp_path):
    x = np.union1d(np.linspace(0.0, 1.0, 201) ** 2, ROBOT.kinks)
    body = library_body(weighing(boyer_body(), 0.1, 0.3, 0.005))
    rows = {name: getattr(body, name)(x) for name in ("half_width", "half_height", "mass_per_length")}
    table = Body(x=x, **rows, centre_of_mass_offset=body.centre_of_mass_offset(x), kinks=ROBOT.kinks, nose=ROBOT.nose)
    assert trim_of(table).pitch == pytest.approx(trim_of(body).pitch, abs=1e-4)
    assert Body(**table.arguments) == table and table != table.changed(centre_of_mass_offset=0.0)
    options = {"scene": Scene(weight=True, friction="laminar"), "sample_period": 0.5, "accuracy": "fine"}
    smooth, of_data = (simulate(falling_law(), 1.0, body=each, **options) for each in (body, table))
    assert distance(of_data.position, smooth.position) < 1e-4 and distance(of_data.torque, smooth.torque) < 2e-3
    assert np.abs(of_data.energy.residual).max() < 1e-6
    of_data.save(tmp_path / "run.nc")
    assert Run.load(tmp_path / "run.nc") == of_data


def test_a_robot_that_bends_by_itself_sinks_with_its_energy_kept():
    hull = library_body(weighing(boyer_body(), 0.03, 0.1))
    robot, scene = Robot.named("eight_servos"), Scene(weight=True, current=(0.0, 0.0, 0.1))
    run = simulate(straight(), 1.5, robot=robot, body=hull, scene=scene, accuracy=1e-4, estimate=False)
    passed = np.abs(run.energy.actuator_work).max() + np.ptp(run.energy.potential)
    assert np.abs(run.energy.residual).max() < 1e-5 * passed
    assert run.closure_force.max() < 1e-11 and np.ptp(run.energy.potential) > 0.02
