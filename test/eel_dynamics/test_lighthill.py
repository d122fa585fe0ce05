"""Planar motion without drag is Lighthill's theory (model identity 3): eqs (1), (61), and the linear theory of 1960."""

import numpy as np
import pytest
from library_state import Body, prescribed
from reference import boyer_body
from reference_space import Space

from eel_gaits import Law, Term

NO_DRAG = {"resistive": False}  # no m_o in it either: see `no_nose`
AMPLITUDE, WAVELENGTH, PERIOD, PHASE = (1.0, 0.5, 2.0), 0.8, 1.3, 0.4
WAVE = Law(Term(axis="yaw", amplitude=AMPLITUDE, wavelength=WAVELENGTH, period=PERIOD, phase=PHASE))


def plane_momentum(space, time, turn, heading, velocity):
    """Lighthill's fluid in the plane: momentum of the slices, its moment about the origin, and the tail's state.

    `turn` is the head's angular velocity, `heading` its angle, `velocity` (2,) its velocity in fixed axes; positions
    are from the head.
    """
    x = space.x
    angle = 2 * np.pi * (x / WAVELENGTH - time / PERIOD) + PHASE
    curvature = np.polynomial.polynomial.polyval(x, AMPLITUDE) * np.sin(angle)
    curvature_rate = -2 * np.pi / PERIOD * np.polynomial.polynomial.polyval(x, AMPLITUDE) * np.cos(angle)
    direction = heading + space.cumulate(curvature)
    spin = turn + space.cumulate(curvature_rate)
    t1 = np.stack([np.cos(direction), np.sin(direction)], axis=1)
    t2 = np.stack([-np.sin(direction), np.cos(direction)], axis=1)
    r = space.cumulate(t1)
    v = velocity + space.cumulate(spin[:, None] * t2)
    added = 1000 * np.pi * boyer_body().half_height(x) ** 2
    momentum = (added * np.sum(v * t2, axis=1))[:, None] * t2
    return r, v, t1, t2, momentum


@pytest.mark.parametrize("seed", range(4))
def test_large_amplitude_theory(seed):
    """Force and moment on the body by eqs (1) and (61), with the momentum's rate by a complex step in time."""
    rng = np.random.default_rng(seed)
    time, turn, turn_rate = rng.uniform(0, 2), *rng.normal(size=2)
    velocity, acceleration = (
        rng.normal(size=2) - (1, 0),
        rng.normal(size=2),
    )  # true acceleration, fixed axes = head axes
    space, step = Space(boyer_body().kinks, 2, 16), 1e-30

    def total(h):
        shift = h * velocity
        r, _, _, _, momentum = plane_momentum(
            space, time + h, turn + h * turn_rate, h * turn, velocity + h * acceleration
        )
        r = r + shift
        moment = r[:, 0] * momentum[:, 1] - r[:, 1] * momentum[:, 0]
        return np.concatenate([space.weights @ momentum, [space.weights @ moment]])

    rate = total(1j * step).imag / step
    r, v, t1, t2, _ = (space.evaluate(field, 1.0)[0] for field in plane_momentum(space, time, turn, 0.0, velocity))
    m, V1, V2 = 1000 * np.pi * 0.03**2, v @ t1, v @ t2
    tail = m * V1 * V2 * t2 - m * V2**2 / 2 * t1
    force = -rate[:2] + tail
    moment = -rate[2] + r[0] * tail[1] - r[1] * tail[0]

    twist = (0, 0, turn, *velocity, 0)
    twist_rate = (0, 0, turn_rate, acceleration[0] + turn * velocity[1], acceleration[1] - turn * velocity[0], 0)
    got = prescribed(Body.boyer2010(), WAVE, time, twist, twist_rate, dict(nose=False, **NO_DRAG))
    scale = np.abs(np.append(rate, tail)).max()
    assert got[3:5] == pytest.approx(force, abs=1e-10 * scale)  # round-off of two quadratures
    assert got[2] == pytest.approx(moment, abs=1e-10 * scale)
    assert got[[0, 1, 5]] == pytest.approx(0, abs=1e-12 * scale)


def linear_theory(size, speed=0.7, period=1.1, samples=32):
    """Mean thrust and rate of work on the water, library and Lighthill 1960, of a bending of relative size `size`.

    The head is drawn at -U E1; h(X, t) is the double integral of the curvature, so that thrust is
    m(l)/2 <h_t^2 - U^2 h_x^2> and power U m(l) <h_t (h_t + U h_x)>, at the tail.
    """
    amplitude, wavelength = (0.3, -0.5, 1.4), 0.9
    law = Law(Term(axis="yaw", amplitude=tuple(size * a for a in amplitude), wavelength=wavelength, period=period))
    space = Space((0.0, 0.5, 1.0), 2, 16)
    thrust, h_t, h_x = [], [], []
    for time in np.arange(samples) * period / samples:
        wrench = prescribed(
            Body.boyer2010(), law, time, (0, 0, 0, -speed, 0, 0), np.zeros(6), dict(nose=False, **NO_DRAG)
        )
        thrust.append(-wrench[3])
        K, K_rate, _ = (field[:, 2] for field in law.curvature(time, space.x))
        h_x.append(space.weights @ K)
        h_t.append(space.weights @ space.cumulate(K_rate))
    h_t, h_x, m = np.array(h_t), np.array(h_x), 1000 * np.pi * 0.03**2
    return np.mean(thrust), m / 2 * np.mean(h_t**2 - speed**2 * h_x**2)


def test_linear_theory():
    """The mean thrust over a period meets m(l)/2 <h_t^2 - U^2 h_x^2>; the difference falls like the fourth power."""
    (fine, fine_theory), (coarse, coarse_theory) = linear_theory(0.02), linear_theory(0.04)
    assert coarse_theory == pytest.approx(4 * fine_theory, rel=1e-12)
    assert fine == pytest.approx(fine_theory, rel=2e-3)
    assert (coarse - coarse_theory) / (fine - fine_theory) == pytest.approx(16, rel=0.05)
