# SPDX-License-Identifier: Apache-2.0
"""Swimmers in water that moves: exact shifts, closed forms, the energy ledger, a second formulation, symmetry."""

from dataclasses import replace

import numpy as np
import pytest
from eel_dynamics.analysis.powers import drag_powers
from eel_dynamics.model.axes import turn_vector
from flows import FLOWS, ROWS, TIME, formula, in_paper_axes
from library_state import Reference, library_body, reference_scene
from random_scenes import pointed, robots_anywhere
from reference import boyer_body
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

from eel_dynamics import (
    Body,
    FlowField,
    GriddedFlow,
    Gust,
    Scene,
    Shear,
    Simulation,
    Uniform,
    Vortex,
    VortexStreet,
    Wave,
    simulate,
    simulate_batch,
)
from eel_gaits import Law, falling, straight

LAMINAR, NO_DRAG = Scene(friction="laminar"), Scene(resistive=False)
STILL = Law(name="straight body")
EXACT = 1e-6  # accuracy of the runs that are compared


def apart(one, other):
    return np.abs(one - other).max()


def test_uniform_water_carries_a_swimmer_along():
    """Started with the water's velocity it swims as in still water; a current is the same, by a shift of frame."""
    u = np.array([0.2, -0.1, 0.05])
    start = {"accuracy": EXACT, "scene": LAMINAR, "sample_period": 0.25}
    still = simulate(falling(), 2.0, **start)
    carried = simulate(falling(), 2.0, **start, flow=Uniform(u), twist=np.r_[np.zeros(3), u])
    assert apart(carried.position, still.position + np.outer(still.time, u)) < 3e-8
    assert apart(carried.force, still.force) < 1e-6
    held = {"duration": 2.0, "accuracy": EXACT, "sample_period": 0.25}
    drifting = simulate(falling(), **held, scene=replace(LAMINAR, current=tuple(u)))
    assert apart(simulate(falling(), **held, scene=LAMINAR, flow=Uniform(u)).position, drifting.position) < 1e-8


@pytest.mark.parametrize("kind", ["shear", "rigid rotation"])
def test_water_with_vorticity_that_is_carried_along_carries_its_swimmer(kind):
    """u(x - U t) + U: its rate at a fixed place, its acceleration and its rate as the section meets it all differ."""
    carried_by, rate = np.array([0.3, 0.2, -0.1]), 0.5
    jacobian = rate * np.array(
        [[0.0, 1.0, 0.0], [-1.0 if kind == "rigid rotation" else 0.0, 0.0, 0.4], [0.0, 0.0, 0.0]]
    )

    def moving(by):
        return FlowField(
            lambda x, t: (x - by * t) @ jacobian.T + by,
            jacobian=lambda x, t: np.broadcast_to(jacobian, (len(x), 3, 3)),
            rate=lambda x, t: np.broadcast_to(-jacobian @ by, x.shape),
        )

    options = {"accuracy": EXACT, "scene": LAMINAR, "sample_period": 0.25}
    steady = simulate(falling(), 1.0, **options, flow=moving(np.zeros(3)))
    carried = simulate(falling(), 1.0, **options, flow=moving(carried_by), twist=np.r_[np.zeros(3), carried_by])
    assert apart(carried.position, steady.position + np.outer(steady.time, carried_by)) < 3e-8
    assert apart(carried.force, steady.force) < 1e-6 and apart(carried.torque, steady.torque) < 1e-6


@pytest.mark.parametrize("by", ["current", "flow"])
def test_a_flow_that_is_carried_along_carries_its_swimmer(by):
    """A vortex at rest, and one that drifts with the water around: u_t is not 0, the motion is the same plus U t."""
    u = np.array([0.3, 0.2, 0.0])
    vortex = Vortex(circulation=0.3, core=0.25, centre=(-0.5, 0.2, 0.0))
    options = {"accuracy": EXACT, "scene": LAMINAR, "sample_period": 0.25}
    steady = simulate(falling(), 2.0, **options, flow=vortex)
    moving = replace(vortex, drift=tuple(u))
    if by == "current":
        options["scene"] = replace(LAMINAR, current=tuple(u))
    else:
        moving = moving + Uniform(u)
    carried = simulate(falling(), 2.0, **options, flow=moving, twist=np.r_[np.zeros(3), u])
    assert apart(carried.position, steady.position + np.outer(steady.time, u)) < 3e-8
    assert apart(carried.force, steady.force) < 1e-6 and apart(carried.torque, steady.torque) < 1e-6


@pytest.mark.parametrize("scene", [LAMINAR, replace(NO_DRAG, wake=False, tail_pressure="distributed")])
def test_in_water_that_accelerates_a_neutral_swimmer_swims_as_in_still_water(scene):
    """The only test that sees a missing rho_f A a_u: plus the displacement of the water, the same internal wrench."""
    displacement = CubicSpline(TIME, ROWS, bc_type="clamped").antiderivative()
    options = {"accuracy": EXACT, "scene": scene, "sample_period": 0.25}
    still = simulate(falling(), 3.0, **options)
    moved = simulate(falling(), 3.0, **options, flow=Uniform(ROWS, time=TIME), twist=np.r_[np.zeros(3), ROWS[0]])
    assert apart(moved.position, still.position + displacement(still.time)) < 1e-7
    assert apart(moved.force, still.force) < 1e-6 and apart(moved.torque, still.torque) < 1e-6


@pytest.mark.parametrize("density", [700.0, 1000.0, 2500.0])
def test_a_straight_body_takes_its_part_of_the_water_s_acceleration(density):
    """Across (rho_f A + M2) / (m + M2), along rho_f A / m, of a_u, at the start."""
    body, scene = pointed(0.03, 0.05), Scene(resistive=False, nose=False, density=density)
    for axis, added in ((0, 0.0), (1, 1000.0 * np.pi * 0.05**2), (2, 1000.0 * np.pi * 0.03**2)):
        rows = np.zeros((7, 3))
        rows[:, axis] = 0.3 * np.sin(TIME + 1.0)
        rate = CubicSpline(TIME, rows, bc_type="clamped")(0.7, 1)[axis]
        velocity = CubicSpline(TIME, rows, bc_type="clamped")(0.7)
        flow = Uniform(rows, time=TIME - 0.7)
        simulation = Simulation(
            body=body, scene=scene, accuracy=1e-6, law=STILL, flow=flow, twist=np.r_[np.zeros(3), velocity]
        )
        area = 1000.0 * np.pi * 0.03 * 0.05  # by the square of the shape, as the added mass
        got = simulation.observe().head_acceleration[3 + axis]
        assert np.isclose(got, (area + added) / (area * density / 1000.0 + added) * rate, rtol=1e-9)


def test_a_spheroid_in_a_plane_strain_feels_the_derivative_of_the_water_s_energy():
    """u = ((s, q), (q, -s)) (x, y) about its middle: torque -2 s q integral M2 X^2 about z."""
    s, q = 0.7, 0.4
    strain = np.array([[s, q, 0.0], [q, -s, 0.0], [0.0, 0.0, 0.0]])
    flow = FlowField(
        lambda x, t: x @ strain.T,
        jacobian=lambda x, t: np.broadcast_to(strain, (len(x), 3, 3)),
        rate=lambda x, t: 0 * x,
    )
    body, scene = pointed(0.05, 0.05), Scene(resistive=False, nose=False)
    simulation = Simulation(body=body, scene=scene, accuracy=1e-9, law=STILL, position=(0.5, 0.0, 0.0), flow=flow)
    x, w = np.polynomial.legendre.leggauss(60)
    added = 1000.0 * np.pi * 0.05**2 * (1.0 - x**2)  # M2 = m of a neutral body of round sections, over X = x / 2
    second, first = np.sum(0.5 * w * added * (x / 2) ** 2), np.sum(0.5 * w * added * added / (4000.0 * np.pi))
    inertia = 2.0 * second + first  # of body and water about the middle: J3 = m a^2 / 4
    assert np.isclose(simulation.observe().head_acceleration[2], -2.0 * s * q * second / inertia, rtol=1e-9)


def test_a_body_across_a_wave_moves_like_a_particle_of_water():
    flow = Wave(amplitude=0.4, wavelength=20.0, surface=1.5)
    across = (0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5))  # along y: along the crests
    start = flow.sample([0.0, 0.0, 0.0]).velocity
    world_from_head = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    twist = np.r_[np.zeros(3), world_from_head.T @ start]
    scene = Scene(resistive=False)
    run = simulate(STILL, 5.0, scene=scene, accuracy=EXACT, flow=flow, orientation=across, twist=twist)
    particle = solve_ivp(
        lambda t, x: flow.sample(x, t).velocity, (0.0, 5.0), np.zeros(3), "DOP853", run.time, rtol=1e-12, atol=1e-12
    )
    assert np.ptp(particle.y, axis=1).max() > 0.4
    assert apart(run.position, particle.y.T) < 1e-7


def test_a_body_along_a_wave_stays_near_the_water_at_its_middle():
    """Started with the water's turning; on an orbit ten times as wide."""
    flow = Wave(amplitude=0.457, wavelength=20.0, surface=1.5)
    middle = flow.sample([-0.5, 0.0, 0.0])
    spin = -middle.jacobian[2, 0]  # of a line of water along x, about y
    start = middle.velocity + np.array([0.0, 0.0, -0.5 * spin])
    scene = Scene(resistive=False)
    run = simulate(STILL, 5.0, scene=scene, accuracy=EXACT, flow=flow, twist=np.r_[0.0, spin, 0.0, start], stations=3)
    particle = solve_ivp(
        lambda t, x: flow.sample(x, t).velocity,
        (0.0, 5.0),
        [-0.5, 0.0, 0.0],
        "DOP853",
        run.time,
        rtol=1e-10,
        atol=1e-10,
    )
    orbit = np.ptp(particle.y, axis=1)[2]
    assert 0.5 < orbit < 0.56
    assert apart(run.backbone[:, 1], particle.y.T) < 0.05


DEAR = [pytest.param(name, marks=pytest.mark.soak) for name in ("vortex", "wave", "street")]
LEDGER = [*(name for name in FLOWS if name != "gust"), "street of 34 and a wave"]


@pytest.mark.parametrize("scene", [LAMINAR, NO_DRAG, Scene(friction="blended", wake=False, metacentric_height=0.02)])
@pytest.mark.parametrize("name", LEDGER)
def test_the_ledger_closes_in_water_that_moves(name, scene):
    """Without g^T p, or with g p in its place, it is open by 1e-4 J or more in a shear."""
    many = VortexStreet(start=(-10.0, 0.1, 0.0), drift=(0.2, 0.0, 0.0), core=0.25) + FLOWS["wave"][1]
    flow = many if name.startswith("street of") else FLOWS[name][1]
    run = simulate(falling(), 1.5, scene=scene, accuracy=1e-7, flow=flow, estimate=False, sample_period=0.25)
    assert np.abs(run.energy.residual).max() < 1e-8
    assert max(run.closure_torque.max(), run.closure_force.max()) < 1e-12


@pytest.mark.parametrize("name", ["linear shear", *DEAR])
def test_a_march_by_accelerations_and_energies_alone_is_the_same(name):
    """The reference marches the twist; the library the momentum, which the water changes all along the body."""
    law = falling(start_periods=0.1)
    run = simulate(
        law, 0.1, body=library_body(boyer_body()), scene=NO_DRAG, accuracy=1e-8, flow=FLOWS[name][1], sample_period=0.05
    )
    reference = Reference(boyer_body(), reference_scene(resistive=False), panels_per_span=1, nodes_per_panel=10)
    reference.flow = in_paper_axes(formula(name))
    position, _, twist = reference.march(law, run.time, rtol=1e-9, breaks=(0.1,))
    assert apart(run.position, turn_vector(position)) < 1e-8
    assert apart(run.twist[:, 3:], turn_vector(twist[:, 3:])) < 1e-7


def test_the_error_is_estimated_in_water_that_moves():
    """The distance from a run of a thousandth of the error lies within a few times the estimate, and within the
    target."""
    flow = FLOWS["street"][1] + FLOWS["wave"][1]
    for accuracy in (1e-2, 1e-4):
        run = simulate(falling(), 3.0, scene=LAMINAR, accuracy=accuracy, flow=flow)
        exact = simulate(falling(), 3.0, scene=LAMINAR, accuracy=1e-8, flow=flow, estimate=False)
        error = apart(run.position, exact.position) / max(1.0, exact.path_length)
        assert error < max(3.0 * run.error_estimate.position, 0.1 * accuracy)
        assert error < accuracy


def test_the_mirror_image_swims_mirrored():
    mirror = np.array([1.0, -1.0, 1.0])
    flow = Shear(velocity=(0.2, 0.0, 0.0), centre=(0.0, 0.2, 0.0)) + Vortex(centre=(-0.5, 0.3, 0.0), circulation=0.2)
    image = Shear(velocity=(-0.2, 0.0, 0.0), centre=(0.0, -0.2, 0.0)) + Vortex(
        centre=(-0.5, -0.3, 0.0), circulation=-0.2
    )
    law = falling()
    mirrored = Law(*(replace(t, amplitude=tuple(-a for a in t.amplitude)) if t.axis == "yaw" else t for t in law.terms))
    one, other = (
        simulate(each, 2.0, scene=LAMINAR, flow=water, accuracy="fine", estimate=False)
        for each, water in ((law, flow), (mirrored, image))
    )
    assert apart(one.position, other.position * mirror) < 1e-9


def test_a_planar_scene_swims_as_space_does():
    flow = FLOWS["vortex"][1] + Gust(velocity=(0.1, 0.2, 0.0))
    plane, space = (
        simulate(straight(), 2.0, scene=replace(LAMINAR, planar=planar), flow=flow, accuracy=EXACT, load=True)
        for planar in (True, False)
    )
    assert apart(plane.position, space.position) < 1e-8
    assert apart(plane.fluid_force, space.fluid_force) < 1e-5
    assert apart(plane.energy.flow_power, space.energy.flow_power) < 1e-7


def test_a_flow_of_a_function_is_that_of_the_core():
    """With a Jacobian and a rate by differences, whose error is 1e-8 of theirs."""
    flow = FLOWS["street"][1]
    own = FlowField(lambda x, t: flow.sample(x, t).velocity)
    exact = FlowField(
        own.function, jacobian=lambda x, t: flow.sample(x, t).jacobian, rate=lambda x, t: flow.sample(x, t).rate
    )
    options = {"scene": LAMINAR, "accuracy": 1e-4, "sample_period": 0.25, "estimate": False}
    core, by_differences, by_function = (simulate(falling(), 1.0, flow=each, **options) for each in (flow, own, exact))
    assert apart(core.position, by_function.position) < 1e-5 and apart(core.position, by_differences.position) < 1e-5
    assert apart(by_function.position, by_differences.position) < 1e-7


def test_a_body_of_data_feels_the_same_water():
    """Its sections are smooth between its points alone: the internal wrench closes, and the ledger too."""
    x = np.linspace(0.0, 1.0, 41)
    shape = np.sqrt(4.0 * x * (1.0 - x))
    body = Body(x=x, half_width=0.03 * shape, half_height=0.05 * shape)
    flow = FLOWS["street"][1] + FLOWS["wave"][1]
    one = simulate(falling(), 1.0, body=body, scene=LAMINAR, flow=flow, accuracy=EXACT)
    smooth = simulate(falling(), 1.0, body=pointed(0.03, 0.05), scene=LAMINAR, flow=flow, accuracy=EXACT)
    assert np.abs(one.energy.residual).max() < 1e-7
    assert apart(one.torque, smooth.torque) < 0.01 * np.abs(smooth.torque).max()
    assert one.closure_force.max() < 1e-10


def test_the_drag_s_kinds_add_up_to_its_power():
    run = simulate(straight(), 4.0, scene=LAMINAR, flow=FLOWS["shear"][1] + FLOWS["vortex"][1], accuracy="fine")
    assert apart(drag_powers(run).sum(axis=1), run.energy.drag_power) < 1e-9
    assert apart(drag_powers(run.in_axes("paper")).sum(axis=1), run.energy.drag_power) < 1e-9


CELLS = np.linspace(-11.0, 11.0, 12)


def anywhere(count, seed):
    """`count` flows of all kinds, slow and fast, wide and down to the width of a body."""
    rng = np.random.default_rng(seed)

    def flow(index):
        size, scale = 10.0 ** rng.uniform(-2.0, 0.3), 10.0 ** rng.uniform(-0.6, 1.0)
        velocity, drift = tuple(size * rng.normal(size=3)), tuple(rng.normal(size=3) * 0.3)
        across = np.cross(velocity, rng.normal(size=3))
        kinds = (
            lambda: Gust(velocity=velocity, start=0.1, rise=scale * 0.1, hold=0.0, fall=scale * 0.2),
            lambda: Shear(velocity=velocity, across=tuple(across), width=scale),
            lambda: Vortex(circulation=6.0 * size * scale, core=scale, centre=drift, drift=drift),
            lambda: VortexStreet(circulation=6.0 * size * scale, core=scale, spacing=4.0 * scale, count=3, drift=drift),
            lambda: Wave(amplitude=0.1 * scale, wavelength=6.0 * scale, surface=3.0 * scale, direction=velocity[:2]),
            lambda: Uniform(size * rng.normal(size=(5, 3)), time=np.linspace(0.0, 4.0 * scale, 5)),
            lambda: GriddedFlow(size * rng.normal(size=(12, 12, 12, 3)), **dict.fromkeys("xyz", scale * CELLS)),
        )
        made = kinds[index % len(kinds)]()
        return made + kinds[(index // 7) % len(kinds)]() if index % 3 == 0 else made

    return [flow(index) for index in range(count)]


@pytest.mark.parametrize("count", [pytest.param(300, id="300"), pytest.param(3_000, id="3000", marks=pytest.mark.soak)])
def test_robots_in_any_water_finish_or_say_why_not(count):
    cases = robots_anywhere(count, seed=count + 1)
    laws = [falling(period=1.0 + (index % 7) / 4.0) for index in range(count)]
    scenes = [replace(scene, density=None) for scene in cases["scenes"]]
    batch = simulate_batch(
        laws, 0.5, scenes=scenes, flows=anywhere(count, count), accuracy=1e-2, estimate=False, sample_period=0.125
    )
    left = np.array(["left the grid" in str(error) for error in batch.error])
    assert np.array_equal(batch.stopped, left) and left.mean() < 0.05
    assert all(np.isfinite(array).all() for array in (batch.position, batch.twist, batch.energy.residual))
    energy = batch.energy
    works = (energy[f"{name}_work"] for name in ("actuator", "wake", "nose", "drag", "flow"))
    passed = (np.abs(energy.kinetic_body) + np.abs(energy.kinetic_fluid) + sum(map(np.abs, works))).max(axis=1)
    assert (np.abs(energy.residual).max(axis=1) < 0.02 * passed).all()
