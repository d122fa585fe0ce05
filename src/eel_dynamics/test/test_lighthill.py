# SPDX-License-Identifier: Apache-2.0
"""Planar motion without drag is Lighthill's theory: eqs (1), (61), and the linear theory of 1960."""

import numpy as np
import pytest
from draws import few, numbers, waves
from hypothesis import given
from hypothesis import strategies as st
from library_state import Body, Scene, distance, hydrodynamic_wrench
from reference import boyer_body
from reference_space import Space

from eel_gaits import Law, Term

NO_DRAG = {"resistive": False}  # no m_o in it either: see `no_nose`
pytestmark = pytest.mark.identity("Lighthill")
TAIL = 1000 * np.pi * 0.03**2  # kg/m, added mass of the tail's section


def plane_momentum(space, wave, time, turn, heading, velocity):
    """Lighthill's fluid in the plane: positions from the head, velocities, tangent, normal and momentum of the slices.

    `wave` bends the body; `turn` is the head's angular velocity, `heading` its angle, `velocity` (2,) its velocity in
    fixed axes. May be complex, for derivatives by complex steps.
    """
    x = space.x
    along = x / wave.wavelength if wave.wavelength else 0 * x
    angle = 2 * np.pi * (along - time / wave.period) + wave.phase
    size = np.polynomial.polynomial.polyval(x, wave.amplitude)
    curvature, curvature_rate = size * np.sin(angle), -2 * np.pi / wave.period * size * np.cos(angle)
    direction = heading + space.cumulate(curvature)
    spin = turn + space.cumulate(curvature_rate)
    t1 = np.stack([np.cos(direction), np.sin(direction)], axis=1)
    t2 = np.stack([-np.sin(direction), np.cos(direction)], axis=1)
    r = space.cumulate(t1)
    v = velocity + space.cumulate(spin[:, None] * t2)
    added = 1000 * np.pi * boyer_body().half_height(x) ** 2
    momentum = (added * np.sum(v * t2, axis=1))[:, None] * t2
    return r, v, t1, t2, momentum


@few(25)
@given(waves(), numbers(0.0, 2.0), st.tuples(*[numbers(-1.5, 1.5)] * 6))
def test_large_amplitude_theory(measured, wave, time, motion):
    """Force and moment on the body by eqs (1) and (61), term by term: the rate of the momentum of the water along the
    body (by a complex step in time, in fixed axes), and what passes the plane of the tail, m V1 V2 t2 - m V2^2/2 t1.

    Round-off of two quadratures.
    """
    turn, turn_rate, velocity, acceleration = motion[0], motion[1], np.array(motion[2:4]) - (1, 0), np.array(motion[4:])
    space, step = Space(boyer_body().kinks, 2, 20), 1e-30

    def total(h):
        moved = time + h, turn + h * turn_rate, h * turn, velocity + h * acceleration
        r, _, _, _, momentum = plane_momentum(space, wave, *moved)
        r = r + h * velocity
        moment = r[:, 0] * momentum[:, 1] - r[:, 1] * momentum[:, 0]
        return np.concatenate([space.weights @ momentum, [space.weights @ moment]])

    rate = total(1j * step).imag / step
    at_tail = plane_momentum(space, wave, time, turn, 0.0, velocity)
    r, v, t1, t2, _ = (space.evaluate(field, 1.0)[0] for field in at_tail)
    V1, V2 = v @ t1, v @ t2
    tail = TAIL * V1 * V2 * t2 - TAIL * V2**2 / 2 * t1
    tail = np.append(tail, r[0] * tail[1] - r[1] * tail[0])

    twist = (0, 0, turn, *velocity, 0)
    twist_rate = (0, 0, turn_rate, acceleration[0] + turn * velocity[1], acceleration[1] - turn * velocity[0], 0)
    got = hydrodynamic_wrench(Body.boyer2010(), Law(wave), time, twist, twist_rate, Scene(nose=False, **NO_DRAG))
    scale, plane = np.abs([rate, tail]).max(), [3, 4, 2]
    measured("rate of the water's momentum, two forces and a moment", distance(-got.inertia[plane], rate, scale), 1e-10)
    measured("flux and pressure through the tail's plane", distance(got.wake[plane], tail, scale), 1e-10)
    measured("resultant, eq. (61)", distance(got.total[plane], tail - rate, scale), 1e-10)
    measured("what leaves the plane", np.abs(got.total[[0, 1, 5]]) / scale, 1e-12)


SPEED, BEAT, SAMPLES = 0.7, 1.1, 32  # m/s, s, instants in a period: exact for harmonics up to the fifteenth


def bending(size):
    """A wave on a body whose head goes straight: mean thrust and power of the library, and of Lighthill 1960.

    The head is drawn at -U E1; h(X, t) is the double integral of the curvature. The power is U times the thrust and
    what the wake takes away: |V1| T_f, from the library's flux through the plane of the tail: m V1 V2 along its
    normal, m V2^2/2 along its tangent (the kinetic energy is the same after a period).
    """
    wave = Term(axis="yaw", amplitude=tuple(size * a for a in (0.3, -0.5, 1.4)), wavelength=0.9, period=BEAT)
    space, law = Space((0.0, 0.5, 1.0), 2, 16), Law(wave)
    thrust, shed, h_t, h_x = [], [], [], []
    for time in np.arange(SAMPLES) * BEAT / SAMPLES:
        K, K_rate, _ = (field[:, 2] for field in law.curvature(time, space.x))
        angle = space.weights @ K
        h_x.append(angle)
        h_t.append(space.weights @ space.cumulate(K_rate))
        got = hydrodynamic_wrench(Body.boyer2010(), law, time, (0, 0, 0, -SPEED, 0, 0), np.zeros(6), FREE)
        thrust.append(-got.force[0])
        tangent, normal = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
        energy, flux = -got.wake[3:5] @ tangent, got.wake[3:5] @ normal  # m V2^2/2, m V1 V2
        shed.append(np.abs(flux) * np.sqrt(energy / (2 * TAIL)))  # |V1| T_f
    return np.mean(thrust), SPEED * np.mean(thrust) + np.mean(shed), *theory(np.array(h_t), np.array(h_x))


def swaying(size):
    """A rigid body that heaves and pitches about its nose: power is the wrench times the head's own motion."""
    rate = 2 * np.pi / BEAT
    thrust, power, h_t, h_x = [], [], [], []
    for time in np.arange(SAMPLES) * BEAT / SAMPLES:
        sine, cosine = np.sin(rate * time), np.cos(rate * time)
        heave = 0.1 * size * np.array([sine, rate * cosine, -(rate**2) * sine])  # m, and its rates
        pitch = 0.3 * size * np.array([cosine, -rate * sine, -(rate**2) * cosine])  # rad
        c, s = np.cos(pitch[0]), np.sin(pitch[0])
        axes = np.array([[c, s], [-s, c]])  # head's from fixed
        velocity, acceleration = axes @ (-SPEED, heave[1]), axes @ (0, heave[2])
        twist = np.array([0, 0, pitch[1], *velocity, 0])
        turned = pitch[1] * velocity[1], -pitch[1] * velocity[0]  # rates of the components as the axes turn
        twist_rate = (0, 0, pitch[2], acceleration[0] + turned[0], acceleration[1] + turned[1], 0)
        wrench = hydrodynamic_wrench(Body.boyer2010(), Law(), time, twist, twist_rate, FREE).total
        thrust.append(-(axes.T @ wrench[3:5])[0])
        power.append(-wrench @ twist)
        h_t.append(heave[1] + pitch[1])  # at the tail, 1 m behind
        h_x.append(pitch[0])
    # the wrench's work on the moving head is what goes into the wake; the lateral motions do the thrust's work as well
    return np.mean(thrust), np.mean(power) + SPEED * np.mean(thrust), *theory(np.array(h_t), np.array(h_x))


def theory(h_t, h_x):
    """Lighthill, J. Fluid Mech. 9 (1960): thrust m(l)/2 <h_t^2 - U^2 h_x^2> and power U m(l) <h_t (h_t + U h_x)>."""
    return TAIL / 2 * np.mean(h_t**2 - SPEED**2 * h_x**2), SPEED * TAIL * np.mean(h_t * (h_t + SPEED * h_x))


FREE = Scene(nose=False, **NO_DRAG)


@pytest.mark.parametrize("motion", [bending, swaying])
def test_linear_theory(measured, motion):
    """Means over a period go with the square of the amplitude; their difference from the linear theory with the fourth.

    Sizes 0.02 and 0.04 of a bend of the order of 1 rad: the next term is 1e-3 of that difference.
    """
    fine, coarse = motion(0.02), motion(0.04)
    for column, name in enumerate(("thrust", "power")):
        small, large, wanted, wanted_large = fine[column], coarse[column], fine[column + 2], coarse[column + 2]
        assert wanted != 0.0
        measured(f"mean {name}, amplitude 0.02, {motion.__name__}", abs(small / wanted - 1), 2e-3)
        order = np.log2((large - wanted_large) / (small - wanted))
        measured(f"power of the amplitude in the {name}, {motion.__name__}", np.log2(large / small), 0.01, wanted=2.0)
        measured(f"power of the amplitude in what is left of the {name}, {motion.__name__}", order, 0.1, wanted=4.0)
