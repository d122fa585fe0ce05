# SPDX-License-Identifier: Apache-2.0
"""The righting moment of weight and buoyancy, `Scene(metacentric_height=)`."""

from dataclasses import replace

import numpy as np
import pytest
from cases import falling_law, random_law, random_twist
from draws import few, numbers, quaternions, swimmers, twists
from hypothesis import given
from library_state import Reference, Scene, distance, library_body, reference_scene, rotation, simulate, snapshot
from reference import boyer_body
from scipy.special import ellipj, ellipk

from eel_dynamics import Batch, Body, Run, simulate_batch
from eel_gaits import Law, Term

pytestmark = pytest.mark.identity("Righting moment")
G = 9.80665
ROUND_OFF = 1e-12
STRAIGHT = Law(name="straight")
BENT = Law(Term(axis="yaw", amplitude=(1.2,), phase=np.pi / 2), Term(axis="pitch", amplitude=(0.5,), phase=np.pi / 2))


def turned(angle, axis):
    """Quaternion of a turn by `angle` [rad] about `axis` 0, 1, 2."""
    q = np.zeros(4)
    q[axis], q[3] = np.sin(angle / 2), np.cos(angle / 2)
    return q


def tilt(run):
    """Angle (T,) [rad] between the head's axis 3 and up."""
    x, y, _, _ = run.orientation.T
    return 2 * np.arcsin(np.hypot(x, y))


def roll_inertia(reference):
    return reference.space.weights @ (reference.inertia_body + reference.inertia_fluid)[:, 0]


@pytest.mark.parametrize("height, lean", [(0.005, 1e-3), (0.02, 1e-3), (0.02, 2.0)])
def test_a_straight_body_rolls_as_a_pendulum(measured, height, lean):
    """(J1 + J_f1) of the whole times phi'' = - M g h sin phi, by Jacobi's elliptic function: no drag, no wake.

    The wake's pressure at the tail, 1/2 J_f1 Omega1^2, would move the body along its axis, and not turn it.
    """
    reference = Reference(boyer_body(), reference_scene())
    frequency = np.sqrt(mass_of(reference) * G * height / roll_inertia(reference))
    scene = Scene(resistive=False, wake=False, metacentric_height=height)
    duration = 2 * 2 * np.pi / frequency
    run = simulate(
        STRAIGHT,
        duration,
        scene=scene,
        accuracy="reference",
        sample_period=duration / 40,
        orientation=turned(lean, 0),
    )
    modulus = np.sin(lean / 2) ** 2
    sn = ellipj(ellipk(modulus) - frequency * run.time, modulus)[0]
    wanted = 2 * np.arcsin(np.sin(lean / 2) * sn)
    roll = 2 * np.arctan2(run.orientation[:, 0], run.orientation[:, 3])
    measured("roll of a straight body over two periods against the pendulum's", distance(roll, wanted), 1e-7)
    energy = run.energy
    depth = mass_of(reference) * G * height * (1 - np.cos(roll))
    measured("potential energy of the pendulum", distance(energy.potential, depth), 1e-9)
    passed = energy.potential.max()
    measured("kinetic and potential energy of the pendulum", np.ptp(total_energy(energy)) / passed, 1e-6)


def mass_of(reference):
    return reference.space.weights @ reference.inertia_body[:, 3]


def total_energy(energy):
    return energy.kinetic_body + energy.kinetic_fluid + energy.potential


@few(10)
@given(swimmers(), numbers(0.0, 3.0), twists(), quaternions(), numbers(-0.05, 0.05))
def test_the_moment_is_the_sum_over_the_sections(measured, swimmer, time, twist, q, height):
    """What the head's acceleration gains, times the inertia, is the sum of rho A g h (axis 3 x up); no force.

    Axis 3 of each section is read off the published orientations, at the nodes of the reference's quadrature.
    """
    body, law = swimmer
    reference = Reference(body, reference_scene(resistive=False), nodes_per_panel=24)
    x = np.unique(reference.space.x)
    low, plain = (
        snapshot(library_body(body), law, time, twist, q, {"resistive": False, **more}, x)
        for more in ({"metacentric_height": height}, {})
    )
    up = np.array([rotation(each)[:, 2] for each in low.section_orientation])
    density = (
        G * height * reference.inertia_body[:, 3, None] * np.cross(up[np.searchsorted(x, reference.space.x)], (0, 0, 1))
    )
    torque = rotation(q).T @ (reference.space.weights @ density)
    matrix = reference.mass_matrix(law.curvature(time, reference.space.x)[0])
    matrix[3, 3] += reference.nose_mass
    gained = matrix @ (low.head_acceleration - plain.head_acceleration)
    scale = G * abs(height) * mass_of(reference) + 1e-3
    measured("moment on the whole against the sum over sections", distance(gained[:3], torque, scale), 1e-9)
    measured("force on the whole, by moment over length", np.abs(gained[3:]) * body.kinks[-1] / scale, 1e-9)


@few(5)
@given(swimmers(ramps=True), numbers(-3.0, 3.0), quaternions(), numbers(-0.03, 0.03))
def test_no_heading_is_special(measured, swimmer, heading, q, height):
    """Turning the world about the vertical turns the path."""
    body, law = swimmer
    turn = rotation(turned(heading, 2))
    x, y, z, w = q
    s, c = np.sin(heading / 2), np.cos(heading / 2)
    elsewhere = np.array([c * x - s * y, c * y + s * x, c * z + s * w, c * w - s * z])
    options = {
        "duration": 1.0,
        "sample_period": 0.1,
        "body": library_body(body),
        "scene": Scene(friction="laminar", metacentric_height=height),
        "twist": (0.2, -0.1, 0.3, -0.4, 0.1, 0.05),
    }
    here, there = simulate(law, orientation=q, **options), simulate(law, orientation=elsewhere, **options)
    measured(
        "path of a swimmer turned about the vertical", np.abs(there.position - here.position @ turn.T), 1e-11, unit="m"
    )
    measured("its torque", distance(there.torque, here.torque), 1e-11)


def test_the_mirror_of_a_swim_mirrors_it(measured):
    """Left and right are alike: y -> -y with yaw, roll and heading turned round. Up and down are not."""
    rng = np.random.default_rng(3)
    law, twist = random_law(rng, spline=False, size=0.7), random_twist(rng)
    flipped = Law(
        *(
            replace(each, amplitude=tuple(-a for a in each.amplitude)) if each.axis == "yaw" else each
            for each in law.terms
        )
    )
    sign, q = np.array([1, -1, 1]), turned(0.7, 0)
    options = {"duration": 1.0, "sample_period": 0.1, "scene": Scene(metacentric_height=0.02)}
    plain = simulate(law, twist=twist, orientation=q, **options)
    mirror = simulate(
        flipped,
        twist=np.concatenate([-sign * twist[:3], sign * twist[3:]]),
        orientation=q * (-1, 1, -1, 1),
        **options,
    )
    measured("path of the mirrored swimmer", distance(mirror.position, plain.position * sign), ROUND_OFF)
    measured("torque of the mirrored swimmer", distance(mirror.torque, plain.torque * -sign), ROUND_OFF)


@pytest.mark.parametrize("law", [STRAIGHT, BENT], ids=["straight", "bent"])
@pytest.mark.parametrize("height", [0.02, -0.02])
def test_a_body_at_rest_comes_to_hang(measured, law, height):
    """Drag takes the energy: the weight comes to hang below the buoyancy, axis 3 of the sections up on their mean by
    mass. Top-heavy, the body turns over. Drag goes with the square: the last swings die out slowly."""
    low = Scene(metacentric_height=height)
    run = simulate(law, 40.0, scene=low, accuracy=1e-2, orientation=turned(1.2, 0), sample_period=2.0, estimate=False)
    energy, body = run.energy, run.body
    mass = body.half_width(run.x) * body.half_height(run.x)
    up = np.array([rotation(each)[:, 2] for each in run.section_orientation[-1]])
    mean = np.trapezoid(mass[:, None] * up, run.x, axis=0) * np.sign(height)
    sideways = np.arctan2(np.hypot(*mean[:2]), mean[2])
    measured("axis 3 of a body that hangs against up, after 40 s", sideways, np.radians(1.0), unit="rad")
    depth = run.body_mass * G * abs(height)
    assert np.all(np.diff(total_energy(energy)) < 1e-5 * depth) and energy.drag_work[-1] < -0.2 * depth
    measured("energy ledger of a body that comes to hang", np.abs(energy.residual).max() / depth, 1e-3)


def test_a_bent_body_holds_the_static_torque_of_its_weight(measured):
    """At rest in a bend the internal torque is the moment of the part behind: no motion, no acceleration.

    A bend in pitch, symmetric about the middle of a body of constant section: it hangs level. C2(X) is the integral of
    m g h sin(pitch) over the part behind, with pitch = bend (X - l/2).
    """
    bend, height = 0.8, 0.01
    body = Body(
        length=1.0,
        half_width=lambda x: 0.03 * np.sqrt(np.maximum(1 - np.maximum(0, 1 - np.minimum(x, 1 - x) / 0.05) ** 2, 0)),
        half_height=lambda x: 0.05 * np.sqrt(np.maximum(1 - np.maximum(0, 1 - np.minimum(x, 1 - x) / 0.05) ** 2, 0)),
        kinks=(0.05, 0.95),
    )
    law = Law(Term(axis="pitch", amplitude=(bend,), phase=np.pi / 2))
    x = np.linspace(0.0, 1.0, 41)
    got = snapshot(
        body,
        law,
        0.0,
        orientation=turned(-bend / 2, 1),
        settings={"metacentric_height": height, "nose": False},
        stations=x,
    )
    pitch = bend * (np.linspace(0, 1, 4001) - 0.5)
    fine = np.linspace(0, 1, 4001)
    load = body.density * np.pi * body.half_height(fine) * body.half_width(fine) * G * height * np.sin(pitch)
    moment = np.concatenate([[0.0], np.cumsum((load[1:] + load[:-1]) / 2)]) / 4000
    behind = moment[-1] - np.interp(x, fine, moment)
    measured("acceleration of a bent body at rest", np.abs(got.head_acceleration).max() * 0.05 / G, 1e-9)
    assert distance(np.abs(got.torque[:, 1]), np.abs(behind)) < 1e-4
    assert np.all(np.sign(got.torque[1:-1, 1]) == np.sign(got.torque[20, 1]))


def test_in_the_plane_it_does_nothing():
    law = random_law(np.random.default_rng(8), pitch=False, size=0.7)
    options = {"duration": 1.0, "sample_period": 0.1}
    plain, low = (
        simulate(law, scene=Scene(planar=True, metacentric_height=height), **options) for height in (0.0, 0.02)
    )
    assert np.array_equal(plain.position, low.position) and np.array_equal(plain.torque, low.torque)
    assert np.all(low.energy.potential == 0.0)


def test_it_goes_through_batches_and_files(tmp_path):
    scenes = [Scene(metacentric_height=height) for height in (0.0, 0.01, -0.01)]
    batch = simulate_batch([falling_law()] * 3, 1.5, scenes=scenes, sample_period=0.1)
    alone = simulate(falling_law(), 1.5, scene=scenes[1], sample_period=0.1)
    assert np.array_equal(batch[1].position, alone.position) and batch[1].energy == alone.energy
    alone.save(tmp_path / "run.nc")
    again = Run.load(tmp_path / "run.nc")
    assert again == alone and again.scene.metacentric_height == 0.01 and np.any(again.energy.potential)
    batch.save(tmp_path / "batch.nc")
    assert Batch.load(tmp_path / "batch.nc") == batch
    assert "potential" in alone.summary() and "potential" not in batch[0].summary()
