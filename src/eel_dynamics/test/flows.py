# SPDX-License-Identifier: Apache-2.0
"""Flows of the library with their formulas written again, of places (n, 3) and a time that may be complex."""

import numpy as np
from eel_dynamics.model.axes import turn_vector
from scipy.interpolate import CubicSpline

from eel_dynamics import Gust, Shear, Uniform, Vortex, VortexStreet, Wave

GRAVITY = 9.80665  # m/s^2


def uniform(flow):
    spline = CubicSpline(flow.time, flow.velocity, bc_type="clamped")
    knots, pieces = spline.x, spline.c

    def u(x, t):
        piece = int(np.clip(np.searchsorted(knots, np.real(t)) - 1, 0, len(knots) - 2))
        s = t - knots[piece]
        return 0 * x + ((pieces[0, piece] * s + pieces[1, piece]) * s + pieces[2, piece]) * s + pieces[3, piece]

    return u


def gust(flow):
    def ramp(t, start, end):
        part = (t - start) / (end - start)
        return 0.0 if np.real(part) < 0 else 1.0 if np.real(part) > 1 else part - np.sin(2 * np.pi * part) / (2 * np.pi)

    def u(x, t):
        start, risen, falls, end = flow.traits.breakpoints
        return 0 * x + np.array(flow.velocity) * (ramp(t, start, risen) - ramp(t, falls, end))

    return u


def shear(flow):
    across = np.array(flow.across) / np.linalg.norm(flow.across)

    def u(x, t):
        d = ((x - flow.centre) @ across) / flow.width
        return (d if flow.profile == "linear" else np.tanh(d))[:, None] * np.array(flow.velocity)

    return u


def vortices(rows, core, drift):
    def u(x, t):
        total = 0 * x
        for place_x, place_y, circulation in rows:
            dx, dy = x[:, 0] - place_x - drift[0] * t, x[:, 1] - place_y - drift[1] * t
            square = dx**2 + dy**2
            turn = circulation / (2 * np.pi * square) * (1 - np.exp(-square / core**2))
            total = total + np.stack([-turn * dy, turn * dx, 0 * dx], axis=1)
        return total

    return u


def vortex(flow):
    return vortices([(*flow.centre[:2], flow.circulation)], flow.core, flow.drift)


def street(flow):
    """Of a street along x alone."""
    x, y, _ = flow.start
    left = [(x + i * flow.spacing, y + flow.width / 2, -flow.circulation) for i in range(flow.count)]
    right = [(x + (i + 0.5) * flow.spacing, y - flow.width / 2, flow.circulation) for i in range(flow.count)]
    return vortices(left + right, flow.core, flow.drift)


def wave(flow):
    k, direction = 2 * np.pi / flow.wavelength, np.append(flow.direction, 0.0) / np.linalg.norm(flow.direction)
    w = np.sqrt(GRAVITY * k)

    def u(x, t):
        phase = k * (x @ direction) - w * t + flow.phase
        size = flow.amplitude * w * np.exp(k * (x[:, 2] - flow.surface))
        return (size * np.cos(phase))[:, None] * direction + (size * np.sin(phase))[:, None] * [0.0, 0.0, 1.0]

    return u


TIME = np.linspace(0.0, 3.0, 7)
ROWS = np.stack([0.3 * np.sin(2.0 * TIME), 0.2 * TIME * np.exp(-TIME), 0.1 * np.cos(3.0 * TIME)], axis=1)
FLOWS = {  # name: flow, its formula
    "uniform": (uniform, Uniform(ROWS, time=TIME)),
    "gust": (gust, Gust(velocity=(0.2, -0.3, 0.1), start=0.1, rise=1.5)),
    "shear": (shear, Shear(velocity=(0.3, 0.1, 0.2), across=(-1.0, 1.0, 1.0), centre=(0.1, 0.2, 0.0), width=0.7)),
    "linear shear": (shear, Shear(velocity=(0.2, 0.0, 0.0), across=(0.0, 1.0, 2.0), profile="linear")),
    "vortex": (vortex, Vortex(circulation=0.4, core=0.3, centre=(-0.3, 0.2, 0.0), drift=(0.1, 0.2, 0.0))),
    "street": (
        street,
        VortexStreet(circulation=0.3, core=0.25, count=4, start=(-2.0, 0.1, 0.0), drift=(0.2, 0.1, 0.0)),
    ),
    "wave": (wave, Wave(amplitude=0.1, wavelength=3.0, direction=(1.0, 2.0), surface=1.5, phase=0.4)),
}


def formula(name):
    """u(x, t) of a flow of `FLOWS`, in the axes of the library."""
    written, flow = FLOWS[name]
    return written(flow)


def in_paper_axes(u):
    """The same function in the paper's axes."""
    signs = turn_vector(np.ones(3))
    return lambda x, t: u(x * signs, t) * signs


def any_flow(rng, planar, near):
    """One to three flows of odd numbers whose middles are near the place `near`, as pairs of formula and flow."""
    flat = np.array([1.0, 1.0, 0.0 if planar else 1.0])

    def one():
        size, scale = 10.0 ** rng.uniform(-1.5, 0.3), 10.0 ** rng.uniform(-0.8, 0.7)
        velocity, place, drift = size * rng.normal(size=3) * flat, (near + 0.15 * rng.normal(size=3)) * flat, flat
        across = np.cross(velocity, [0.0, 0.0, 1.0] if planar else rng.normal(size=3))
        core = max(0.12, 0.3 * scale)
        rows, time = size * rng.normal(size=(6, 3)) * flat, np.linspace(0.0, rng.uniform(0.5, 3.0), 6)
        kinds = [
            (uniform, lambda: Uniform(rows, time=time)),
            (gust, lambda: Gust(velocity=velocity, start=rng.uniform(-1.0, 0.3), rise=scale, hold=0.4, fall=0.7)),
            (shear, lambda: Shear(velocity=velocity, across=across, centre=tuple(place), width=scale)),
            (shear, lambda: Shear(velocity=velocity, across=across, centre=tuple(place), profile="linear")),
            (
                vortex,
                lambda: Vortex(circulation=rng.normal() * scale, core=core, centre=tuple(place), drift=0.4 * drift),
            ),
            (
                street,
                lambda: VortexStreet(
                    circulation=rng.normal() * scale,
                    core=core,
                    spacing=2.0 * scale + 0.4,
                    width=scale,
                    count=int(rng.integers(1, 6)),
                    start=tuple(place),
                    drift=tuple(-0.3 * drift),
                ),
            ),
            (
                wave,
                lambda: Wave(
                    amplitude=0.1 * scale,
                    wavelength=max(1.0, 4.0 * scale),
                    direction=rng.normal(size=2),
                    surface=rng.uniform(1.5, 4.0),
                    phase=rng.uniform(0.0, 6.0),
                ),
            ),
        ]
        written, make = kinds[rng.integers(len(kinds) - planar)]
        return written, make()

    return [one() for _ in range(rng.integers(1, 4))]
