# SPDX-License-Identifier: Apache-2.0
"""External wrenches for tests, as library and reference take them, and what is measured of swims under them."""

import numpy as np
from library_state import turn_twist
from scipy.integrate import quad

from eel_dynamics import ExternalWrench, Scene
from eel_gaits import Law

STRAIGHT = Law(name="straight")
NO_WATER = Scene(reactive=False, resistive=False, nose=False)
PLACES = 0.0, 0.31, 1.0  # of the body's length
ROWS = (0.3, -0.4, 0.5, 0.02, -0.03, 0.01), (-0.2, 0.1, 0.6, -0.01, 0.0, 0.05), (0.7, 0.2, -0.1, 0.03, 0.02, -0.04)
RIPPLE = {"force": lambda t: (0.3 * np.sin(9.0 * t), 0.1, 0.2), "torque": lambda t: (0.0, 0.01 * np.cos(7.0 * t), 0.02)}


def three(length=1.0, size=1.0):
    """Wrenches at both ends and inside, one of them in the axes of the world."""
    return tuple(
        ExternalWrench(place * length, size * np.array(row[:3]), size * length * np.array(row[3:]), frame)
        for place, row, frame in zip(PLACES, ROWS, ("section", "world", "section"), strict=True)
    )


def of_reference(wrenches):
    """The same for the reference: its axes are those of the paper, of world and section alike."""

    def row(wrench):
        own = turn_twist(np.array([*wrench.torque, *wrench.force]))
        return wrench.station, wrench.frame == "world", lambda time: own

    return tuple(row(wrench) for wrench in wrenches)


def works_of(run) -> float:
    """The sum of the greatest works [J] of a run."""
    names = [name for name in run.energy.keys() if name.endswith("_work")]  # noqa: SIM118
    return sum(np.abs(run.energy[name]).max() for name in names)


def close(what, value, tolerance):
    """Assert that the greatest of `value` is at most `tolerance`."""
    assert np.max(value) <= tolerance, f"{what}: {np.max(value):.3g}, more than {tolerance:g}"


def about_centre(body, axis):
    """X of the centre of mass [m], mass [kg], and inertia about it [kg m^2] along "x", "y" or "z", by quadrature."""
    area = lambda x: np.pi * float(body.half_width(x)) * float(body.half_height(x))  # noqa: E731
    squares = {"y": lambda x: float(body.half_height(x)) ** 2, "z": lambda x: float(body.half_width(x)) ** 2}
    squares["x"] = lambda x: squares["y"](x) + squares["z"](x)
    moment = lambda f: quad(f, 0.0, 1.0, points=body.kinks, limit=200, epsabs=1e-13, epsrel=1e-12)[0]  # noqa: E731
    mass = 1000.0 * moment(area)
    centre = 1000.0 * moment(lambda x: x * area(x)) / mass
    own = 1000.0 * moment(lambda x: area(x) * squares[axis](x) / 4.0)
    along = 0.0 if axis == "x" else 1000.0 * moment(lambda x: (x - centre) ** 2 * area(x))
    return centre, mass, own + along
