# SPDX-License-Identifier: Apache-2.0
"""Symmetries: poses, mirrors, plane, rest, and a uniform current."""

import dataclasses

import numpy as np
import pytest
from cases import falling_law, random_law
from draws import few, numbers, quaternions, scenes, swimmers, twists
from hypothesis import given
from hypothesis import strategies as st
from library_state import Scene, distance, library_body, random_quaternion, rotation, simulate

from eel_gaits import Law

pytestmark = pytest.mark.identity("Symmetry")
START = (0.2, -0.1, 0.3, -0.4, 0.1, 0.05)
QUICK = {"duration": 1.0, "accuracy": "standard", "sample_period": 0.1}


@few(8)
@given(
    swimmers(ramps=True),
    st.tuples(*[numbers(-100.0, 100.0)] * 3),
    quaternions(),
    scenes(drag=True, current=(0.0, 0.0, 0.0)),
)
def test_another_pose_gives_the_same_path_there(measured, swimmer, position, q, settings):
    """Positions to 100 m away: round-off of 1e-14 m, and what the motion makes of it."""
    body, law = swimmer
    options = {"twist": START, "body": library_body(body), "scene": Scene(**settings), **QUICK}
    here, there = simulate(law, **options), simulate(law, position=position, orientation=q, **options)
    moved = np.array(position) + here.position @ rotation(q).T
    measured("path from another pose", np.abs(there.position - moved), 1e-11, unit="m")
    measured("twist from another pose", distance(there.twist, here.twist), 1e-11)
    turned = np.array([rotation(q) @ rotation(each) for each in here.orientation])
    got = np.array([rotation(each) for each in there.orientation])
    measured("orientation from another pose", np.abs(got - turned), 1e-11)
    measured(
        "internal wrench from another pose",
        [distance(there.torque, here.torque), distance(there.force, here.force)],
        1e-11,
    )


def mirrored(law, axis):
    """The law in the mirror that turns the sign of that axis's curvature."""
    flip = lambda term: tuple(-a for a in term.amplitude) if term.axis == axis else term.amplitude  # noqa: E731
    return Law(*(dataclasses.replace(term, amplitude=flip(term)) for term in law.terms))


@pytest.mark.parametrize("axis, column", [("yaw", 1), ("pitch", 2)])
@few(5)
@given(swimmers(), twists(), scenes(drag=True, current=(0.0, 0.0, 0.0)))
def test_a_mirrored_law_mirrors_the_path(measured, axis, column, swimmer, twist, settings):
    """Yaw K3 bends in the plane (1, 2): its mirror is y -> -y; pitch: z -> -z. Angular velocities are axial vectors.

    Signs alone change, so that even the round-off is the mirror's, but for the order of a sum here and there.
    """
    body, law = swimmer
    sign = np.ones(3)
    sign[column] = -1
    options = {"body": library_body(body), "scene": Scene(**settings), **QUICK}
    plain = simulate(law, twist=twist, **options)
    mirror = simulate(mirrored(law, axis), twist=np.concatenate([-sign * twist[:3], sign * twist[3:]]), **options)
    pairs = {
        "path": (mirror.position, plain.position * sign),
        "twist": (mirror.twist, plain.twist * np.concatenate([-sign, sign])),
        "torque": (mirror.torque, plain.torque * -sign),
        "force": (mirror.force, plain.force * sign),
    }
    for name, (got, wanted) in pairs.items():
        measured(f"{name} of the mirrored swimmer", distance(got, wanted), 1e-12)


@few(6)
@given(swimmers(planar=True, ramps=True), twists(planar=True), scenes(drag=True, planar=True))
def test_a_planar_law_stays_planar(measured, swimmer, twist, settings):
    body, law = swimmer
    run = simulate(law, body=library_body(body), scene=Scene(**settings), twist=twist, **QUICK)
    measured("out of the plane: position, by the length", np.abs(run.position[:, 2]) / body.kinks[-1], 1e-13)
    measured("out of the plane: twist", np.abs(run.twist[:, [0, 1, 5]]) / np.abs(run.twist).max(), 1e-13)
    measured("out of the plane: torque", np.abs(run.torque[:, :, :2]) / np.abs(run.torque).max(), 1e-13)


@pytest.mark.parametrize(
    "options", [{}, {"resistive": False}, {"current": (0.1, 0.2, 0.0), "friction": "laminar"}], ids=str
)
def test_the_planar_scene_is_the_plane_of_the_other(measured, options):
    """One angle in place of a rotation: the same motion, to the accuracy of the presets' steps in space."""
    law = random_law(np.random.default_rng(8), pitch=False, size=0.7)
    start = {"twist": (0, 0, 0.2, -0.3, 0.1, 0), "duration": 2.0, "sample_period": 0.1, "accuracy": "fine"}
    flat, full = (simulate(law, scene=Scene(planar=planar, **options), **start) for planar in (True, False))
    names = "position", "twist", "torque", "force"
    apart = [distance(getattr(flat, name), getattr(full, name)) for name in names]
    measured("planar scene against three dimensions, preset fine: path, twist, wrench", apart, 1e-6)
    powers = "actuator_power", "drag_power", "wake_power"
    scale = np.abs(full.energy.actuator_power).max()
    apart = [distance(flat.energy[name], full.energy[name], scale) for name in powers]
    measured("planar scene against three dimensions, preset fine: powers", apart, 1e-6)


def test_rest_stays_at_rest_exactly(measured):
    run = simulate(Law(), duration=1.0, sample_period=0.1)
    assert np.all(run.orientation == (0, 0, 0, 1))
    fields = run.position, run.twist, run.torque, run.force, run.energy.residual
    measured("what a swimmer at rest does", [np.abs(field).max() for field in fields], 0.0)


@pytest.mark.parametrize("viscosity", [0.0, 1e-6])
def test_straight_and_still_in_a_current_is_carried_without_a_force(measured, viscosity):
    """At the current's own velocity, turned initial pose: no load, path with the water."""
    current, q = np.array([0.3, -0.2, 0.1]), random_quaternion(np.random.default_rng(1))
    twist = np.concatenate([np.zeros(3), rotation(q).T @ current])
    run = simulate(
        Law(),
        duration=1.0,
        sample_period=0.1,
        orientation=tuple(q),
        twist=tuple(twist),
        scene=Scene(current=tuple(current), viscosity=viscosity),
    )
    measured(
        "path of a straight swimmer that drifts with a current",
        np.abs(run.position - np.outer(run.time, current)),
        1e-13,
        unit="m",
    )
    measured("force on it", np.abs(run.force), 1e-12, unit="N")


def test_galilean_invariance(measured):
    """A current adds its displacement, its velocity to the twist, and nothing to loads and energies."""
    law, current = falling_law(), np.array([0.3, -0.2, 0.1])
    q = random_quaternion(np.random.default_rng(2))
    options = {"duration": 1.5, "sample_period": 0.1, "orientation": tuple(q)}
    still = simulate(law, **options)
    start = np.concatenate([np.zeros(3), rotation(q).T @ current])
    carried = simulate(law, scene=Scene(current=tuple(current)), twist=tuple(start), **options)
    moved = still.position + np.outer(still.time, current)
    drift = np.array([rotation(each).T @ current for each in carried.orientation])
    measured("path in a current", np.abs(carried.position - moved), 1e-11, unit="m")
    measured("twist in a current", distance(carried.twist[:, 3:], still.twist[:, 3:] + drift), 1e-10)
    measured("torque in a current", distance(carried.torque, still.torque), 1e-10)
    measured(
        "energy of the water in a current", distance(carried.energy.kinetic_fluid, still.energy.kinetic_fluid), 1e-10
    )


def test_orientation_stays_a_unit_quaternion(measured):
    run = simulate(falling_law(), duration=3.0, accuracy="draft", sample_period=0.5)
    measured("norm of the quaternion less 1", np.abs(np.linalg.norm(run.orientation, axis=1) - 1), 1e-14)


def test_steps_do_not_depend_on_the_sampling(measured):
    law = falling_law()
    coarse, fine = (simulate(law, duration=2.0, sample_period=period) for period in (1.0, 0.05))
    measured("path with 20 times the samples", np.abs(fine.position[::20] - coarse.position), 1e-14, unit="m")
