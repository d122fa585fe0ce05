"""Symmetries (model identity 6): poses, mirrors, plane, rest, and a uniform current."""

import dataclasses

import numpy as np
import pytest
from cases import falling_law, random_law
from hypothesis import given, settings
from hypothesis import strategies as st
from library_state import Scene, random_quaternion, rotation, simulate

from eel_gaits import Law

FEW = settings(derandomize=True, max_examples=5, deadline=None)
START = (0.2, -0.1, 0.3, -0.4, 0.1, 0.05)
QUICK = {"duration": 1.0, "accuracy": "standard", "sample_period": 0.1}
# Two runs that are equal in exact arithmetic: round-off, amplified e-fold or so per stride.
SAME = 1e-11


@FEW
@given(seed=st.integers(0, 1000), position=st.tuples(*[st.floats(-100, 100)] * 3))
def test_another_pose_gives_the_same_path_there(seed, position):
    rng = np.random.default_rng(seed)
    q, law = random_quaternion(rng), random_law(rng, size=0.7)
    here = simulate(law, twist=START, **QUICK)
    there = simulate(law, twist=START, position=position, orientation=tuple(q), **QUICK)
    assert there.position == pytest.approx(np.array(position) + here.position @ rotation(q).T, abs=SAME * 100)
    assert there.twist == pytest.approx(here.twist, abs=SAME * 10)
    for got, start in zip(there.orientation, here.orientation, strict=False):
        assert rotation(got) == pytest.approx(rotation(q) @ rotation(start), abs=SAME)


def mirrored(law, axis):
    """The law in the mirror that turns the sign of that axis's curvature."""
    flip = lambda term: tuple(-a for a in term.amplitude) if term.axis == axis else term.amplitude  # noqa: E731
    return Law(*(dataclasses.replace(term, amplitude=flip(term)) for term in law.terms))


@pytest.mark.parametrize("axis, column", [("yaw", 1), ("pitch", 2)])
def test_a_mirrored_law_mirrors_the_path(axis, column):
    """Yaw K3 bends in the plane (1, 2): its mirror is y -> -y; pitch: z -> -z. Angular velocities are axial vectors."""
    law, sign = random_law(np.random.default_rng(3), size=0.7), np.ones(3)
    sign[column] = -1
    twist = np.array(START)
    plain = simulate(law, twist=twist, **QUICK)
    mirror = simulate(mirrored(law, axis), twist=np.concatenate([-sign * twist[:3], sign * twist[3:]]), **QUICK)
    assert mirror.position == pytest.approx(plain.position * sign, abs=SAME)
    assert mirror.twist == pytest.approx(plain.twist * np.concatenate([-sign, sign]), abs=SAME * 10)
    assert mirror.torque == pytest.approx(plain.torque * -sign, abs=SAME * 10)
    assert mirror.force == pytest.approx(plain.force * sign, abs=SAME * 10)


def test_a_planar_law_stays_planar():
    law = random_law(np.random.default_rng(7), pitch=False)
    run = simulate(law, duration=2.0, sample_period=0.1, twist=(0, 0, 0.2, -0.3, 0.1, 0))
    assert np.max(np.abs(run.position[:, 2])) < 1e-14
    assert np.max(np.abs(run.twist[:, [0, 1, 5]])) < 1e-13
    assert np.max(np.abs(run.torque[:, :, [0, 1]])) < 1e-13


@pytest.mark.parametrize(
    "options", [{}, {"resistive": False}, {"current": (0.1, 0.2, 0.0), "friction": "laminar"}], ids=str
)
def test_the_planar_scene_is_the_plane_of_the_other(options):
    """One angle in place of a rotation: the same motion, to the accuracy of the presets' steps in space."""
    law = random_law(np.random.default_rng(8), pitch=False, size=0.7)
    start = {"twist": (0, 0, 0.2, -0.3, 0.1, 0), "duration": 2.0, "sample_period": 0.1, "accuracy": "fine"}
    flat, full = (simulate(law, scene=Scene(planar=planar, **options), **start) for planar in (True, False))
    assert flat.position == pytest.approx(full.position, abs=1e-6)
    assert flat.twist == pytest.approx(full.twist, abs=1e-5)
    assert flat.torque == pytest.approx(full.torque, abs=1e-5)
    assert flat.force == pytest.approx(full.force, abs=1e-5)
    for name in ("actuator_power", "drag_power", "wake_power"):
        assert getattr(flat.energy, name) == pytest.approx(getattr(full.energy, name), abs=1e-5)


def test_rest_stays_at_rest_exactly():
    run = simulate(Law(), duration=1.0, sample_period=0.1)
    assert np.all(run.position == 0) and np.all(run.twist == 0)
    assert np.all(run.orientation == (0, 0, 0, 1))
    assert np.all(run.torque == 0) and np.all(run.force == 0)
    assert np.all(run.energy.residual == 0)


@pytest.mark.parametrize("viscosity", [0.0, 1e-6])
def test_straight_and_still_in_a_current_is_carried_without_a_force(viscosity):
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
    assert run.position == pytest.approx(np.outer(run.time, current), abs=1e-14)
    assert run.force == pytest.approx(0, abs=1e-13)


def test_galilean_invariance():
    """A current adds its displacement, its velocity to the twist, and nothing to loads and energies."""
    law, current = falling_law(), np.array([0.3, -0.2, 0.1])
    q = random_quaternion(np.random.default_rng(2))
    options = {"duration": 1.5, "sample_period": 0.1, "orientation": tuple(q)}
    still = simulate(law, **options)
    start = np.concatenate([np.zeros(3), rotation(q).T @ current])
    carried = simulate(law, scene=Scene(current=tuple(current)), twist=tuple(start), **options)
    assert carried.position == pytest.approx(still.position + np.outer(still.time, current), abs=1e-11)
    drift = np.array([rotation(each).T @ current for each in carried.orientation])
    assert carried.twist[:, 3:] == pytest.approx(still.twist[:, 3:] + drift, abs=1e-10)
    assert carried.torque == pytest.approx(still.torque, abs=1e-10)
    assert carried.energy.kinetic_fluid == pytest.approx(still.energy.kinetic_fluid, abs=1e-10)


def test_orientation_stays_a_unit_quaternion():
    run = simulate(falling_law(), duration=3.0, accuracy="draft", sample_period=0.5)
    assert np.linalg.norm(run.orientation, axis=1) == pytest.approx(1, abs=1e-14)


def test_steps_do_not_depend_on_the_sampling():
    law = falling_law()
    coarse, fine = (simulate(law, duration=2.0, sample_period=period) for period in (1.0, 0.05))
    assert fine.position[::20] == pytest.approx(coarse.position, abs=1e-14)
