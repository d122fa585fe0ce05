# SPDX-License-Identifier: Apache-2.0
"""Swimmers in water that moves against the reference: the same from the kinetic energy alone, and u(x, t) alone."""

import numpy as np
import pytest
from cases import kern_body, random_law, random_twist
from eel_dynamics.model.axes import turn_quaternion, turn_vector
from flows import FLOWS, any_flow, formula, in_paper_axes
from library_state import (
    DENSE,
    Reference,
    distance,
    library_body,
    library_scene,
    random_quaternion,
    reference_scene,
    rotation,
    turn_twist,
)
from library_state import in_paper_axes as snapshot_in_paper_axes
from reference import boyer_body

from eel_dynamics import Simulation, Vortex, Wave
from eel_gaits import straight

STATIONS = np.sort(np.concatenate([np.linspace(0, 1, 15), [0.01, 0.05, 0.2, 0.75, 0.96]]))
EXACT, KINKS = 1e-9, 1e-5  # as in test_against_reference.py
SCENES = {
    "no drag": {"resistive": False},
    "no wake": {"resistive": False, "wake": False, "current": (0.3, -0.2, 0.1)},
    "distributed": {"resistive": False, "tail_pressure": "distributed", "density": 1300.0, "fluid_density": 800.0},
    "laminar": {"friction": "laminar", "metacentric_height": 0.02},
}
NAMES = "actuator_power", "wake_power", "nose_power", "drag_power", "flow_power"


def reference_at(body, law, time, twist, q, position, settings, u):
    """The reference's fields and true acceleration of the head, in water that moves as `u`, in the paper's axes."""
    panels, nodes = (10, 10) if settings.get("resistive", True) else (3, 20)
    reference = Reference(body, reference_scene(**settings), panels_per_span=panels, nodes_per_panel=nodes)
    current = np.asarray(reference.scene.current, float)
    reference.flow = lambda x, t: u(x + current * (t - time), t)  # in the frame of the current
    reference.pose.position, reference.pose.axes, reference.pose.time = position, rotation(q), time
    shape = law.curvature(time, reference.space.x)
    reference.up = rotation(q)[2]
    relative = np.array(twist, float)
    relative[3:] -= rotation(q).T @ current
    rate = reference.acceleration(*shape, relative)
    acceleration = rate.copy()
    acceleration[3:] += np.cross(relative[:3], relative[3:])
    return reference, reference.fields(*shape, relative, rate), acceleration


@pytest.mark.parametrize("settings", SCENES.values(), ids=SCENES)
@pytest.mark.parametrize("name", FLOWS)
def test_any_motion_in_water_that_moves_is_that_of_the_kinetic_energy(name, settings):
    rng = np.random.default_rng(list(FLOWS).index(name) + 100 * list(SCENES.values()).index(settings))
    body = (boyer_body, kern_body)[rng.integers(2)]()
    law, twist, q = random_law(rng, spline=False), random_twist(rng), random_quaternion(rng)
    position, time = rng.normal(size=3) * 0.3, 0.0
    length = body.kinks[-1]
    stations = np.unique(np.concatenate([length * STATIONS, body.kinks]))
    simulation = Simulation(
        body=library_body(body),
        scene=library_scene(**settings),
        accuracy=DENSE,
        stations=stations,
        position=turn_vector(position),
        orientation=turn_quaternion(q),
        twist=turn_twist(twist),
        flow=FLOWS[name][1],
        law=law,
    )
    got = snapshot_in_paper_axes(simulation.observe())
    u = in_paper_axes(formula(name))
    reference, fields, acceleration = reference_at(body, law, time, twist, q, position, settings, u)
    at = lambda field: reference.space.evaluate(field, stations)  # noqa: E731
    drag, inner = settings.get("resistive", True), ~np.isin(stations, body.kinks)
    tolerance = KINKS if drag else EXACT
    scale = np.abs(fields.force).max()
    for part in (slice(0, 3), slice(3, 6)):
        assert distance(got.head_acceleration[part], acceleration[part]) < tolerance
    assert distance(got.torque, at(fields.torque)) < tolerance
    assert distance(got.force, at(fields.force)) < tolerance
    energy = got.energy
    assert distance([energy[name] for name in NAMES], [getattr(fields, name) for name in NAMES]) < tolerance
    assert distance(energy.kinetic_fluid, fields.kinetic_fluid) < tolerance
    assert distance(got.nose_force, fields.nose_force, scale) < tolerance
    assert distance(got.tail_force, fields.tail_force, scale) < tolerance
    reactive = got.fluid_force - got.resistive_force, at(fields.fluid_force - fields.resistive_force)
    assert distance(*(each[inner] for each in reactive), scale) < 10 * tolerance


FRICTION = "laminar", "blended", "taylor", "none"  # "printed" jumps, where the reference is exact to 1e-4 alone


@pytest.mark.parametrize("index", [*range(16), *(pytest.param(k, marks=pytest.mark.soak) for k in range(16, 400))])
def test_any_sum_of_flows_near_the_body_acts_as_its_formula(index):
    """Flows of odd numbers whose middles are within a few widths of the body, in space and in the plane."""
    rng, planar = np.random.default_rng([index, 5]), index % 3 == 0
    body = (boyer_body, kern_body)[rng.integers(2)]()
    settings = {"friction": FRICTION[index % 4]} if index % 5 else {"resistive": False, "current": (0.3, -0.2, 0.0)}
    position, twist, q, law = rng.normal(size=3) * 0.3, random_twist(rng), random_quaternion(rng), None
    if planar:
        turn = rng.uniform(0.0, 6.0)
        position[2], q = 0.0, np.array([0.0, 0.0, np.sin(turn / 2), np.cos(turn / 2)])
        twist = np.array(twist) * (0.0, 0.0, 1.0, 1.0, 1.0, 0.0)
        law = straight(wavelength=rng.uniform(0.5, 2.0), amplitude_0=rng.uniform(-3.0, 3.0), start_periods=0.1)
    law = random_law(rng, spline=False) if law is None else law.delayed(-0.4)
    parts = any_flow(rng, planar, turn_vector(position) - (0.4 * body.kinks[-1], 0.0, 0.0))
    written = [formula(flow) for formula, flow in parts]
    stations = np.unique(np.concatenate([body.kinks[-1] * STATIONS, body.kinks]))
    simulation = Simulation(
        body=library_body(body),
        scene=library_scene(**settings, planar=planar),
        accuracy=DENSE,
        stations=stations,
        position=turn_vector(position),
        orientation=turn_quaternion(q),
        twist=turn_twist(twist),
        flow=sum((flow for _, flow in parts[1:]), parts[0][1]),
        law=law,
    )
    got = snapshot_in_paper_axes(simulation.observe())
    u = in_paper_axes(lambda x, t: sum(each(x, t) for each in written))
    reference, fields, acceleration = reference_at(body, law, 0.0, twist, q, position, settings, u)
    tolerance = KINKS if settings.get("resistive", True) else EXACT
    for part in (2, slice(3, 5)) if planar else (slice(0, 3), slice(3, 6)):
        assert distance(got.head_acceleration[part], acceleration[part]) < 2 * tolerance
    for name in ("torque", "force"):
        assert distance(getattr(got, name), reference.space.evaluate(getattr(fields, name), stations)) < 3 * tolerance
    energy = got.energy
    assert distance([energy[name] for name in NAMES], [getattr(fields, name) for name in NAMES]) < 2 * tolerance
    assert distance(energy.kinetic_fluid, fields.kinetic_fluid) < EXACT


@pytest.mark.parametrize("name", FLOWS)
def test_a_flow_and_its_jacobian_are_those_of_its_formula(name):
    rng, u, time, h = np.random.default_rng(3), formula(name), 0.7, 1e-30
    x = rng.normal(size=(40, 3))
    got = FLOWS[name][1].sample(x, time)
    jacobian = np.stack([u(x + 1j * h * axis, time).imag / h for axis in np.eye(3)], axis=-1)
    assert np.allclose(got.velocity, u(x, time), rtol=1e-13, atol=1e-14)
    assert np.allclose(got.rate, u(x + 0j, time + 1j * h).imag / h, rtol=1e-12, atol=1e-13)
    assert np.allclose(got.jacobian, jacobian, rtol=1e-12, atol=1e-13)


def test_a_vortex_is_smooth_through_its_axis():
    """In the middle it turns as a rigid body; series and formula meet where one takes over from the other."""
    flow = Vortex(circulation=0.3, core=0.2)
    spin = 0.3 / (2.0 * np.pi * 0.2**2)
    middle = flow.sample([0.0, 0.0, 1.0])
    assert np.allclose(middle.velocity, 0.0)
    assert np.allclose(middle.jacobian, [[0.0, -spin, 0.0], [spin, 0.0, 0.0], [0.0, 0.0, 0.0]])
    radius = 0.2 * np.sqrt(0.5)
    x = np.array([[radius * (1 - 1e-12), 0.0, 0.0], [radius * (1 + 1e-12), 0.0, 0.0]])
    near = flow.sample(x)
    assert np.allclose(near.jacobian[0], near.jacobian[1], rtol=1e-11, atol=1e-11)


def test_a_wave_satisfies_laplace_s_equation_and_turns_as_deep_water_does():
    flow = Wave(amplitude=0.2, wavelength=4.0, surface=2.0)
    sample = flow.sample([0.3, 0.1, -0.4], 0.2)
    assert abs(np.trace(sample.jacobian)) < 1e-15
    assert np.allclose(sample.jacobian, sample.jacobian.T)
    assert np.isclose((2 * np.pi / flow.traits.time_scale) ** 2, 9.80665 * 2 * np.pi / 4.0)
