# SPDX-License-Identifier: Apache-2.0
"""Bodies, laws and states that the tests of the physics share."""

from types import SimpleNamespace

import numpy as np

from eel_gaits import Law, Ramp, Term

HALF_PI = np.pi / 2


def falling_law():
    """Section 7.2.2: eqs (62) to (66) with the paper's numbers, written from the paper and not from `eel_gaits`."""
    yaw = Term(axis="yaw", amplitude=(1.0, 0.5, 2.0), wavelength=1.0, period=1.0, envelope=(Ramp(0.0, 1.0, 1.0),))
    steps = Ramp(1.0, 2.0, 1.0), Ramp(2.0, 3.0, -1.0), Ramp(6.0, 7.0, -1.0), Ramp(7.0, 8.0, 1.0)
    return Law(yaw, Term(axis="pitch", amplitude=(0.5,), phase=HALF_PI, envelope=steps), name="falling")


FALLING_BREAKS = (1.0, 2.0, 3.0, 6.0, 7.0, 8.0)  # s, where the third derivative of the law jumps


SPLINE_KNOTS = (0.0, 1 / 3, 2 / 3, 1.0)  # in lengths


def random_law(rng, pitch=True, size=1.0, length=1.0, spline=True):
    """Two waves and a bend in yaw, and the same in pitch: all kinds of term, at a size of `size` rad over the body."""
    terms = []
    for axis in ("yaw", "pitch") if pitch else ("yaw",):
        coefficients = size * rng.normal(size=3) / length ** np.arange(1, 4)
        terms.append(
            Term(
                axis=axis,
                amplitude=tuple(coefficients),
                wavelength=length * rng.uniform(0.6, 2.0),
                period=rng.uniform(0.5, 2.0),
                phase=rng.uniform(0, 6),
            )
        )
        if spline:  # its third derivative jumps at the inner knots
            terms.append(
                Term(
                    axis=axis,
                    amplitude=tuple(size * rng.normal(size=4) / length),
                    period=rng.uniform(1, 3),
                    knots=tuple(length * np.array(SPLINE_KNOTS)),
                )
            )
        terms.append(
            Term(
                axis=axis,
                amplitude=(size * rng.normal() / length,),
                phase=HALF_PI,
                envelope=(Ramp(0.1, 1.3, 1.0), Ramp(0.4, 2.0, -0.7)),
            )
        )
    return Law(*terms, name="random")


def random_twist(rng, size=0.5, planar=False):
    """Head twist (Omega, V) of the order of `size`, swimming forwards."""
    twist = size * rng.normal(size=6) - (0, 0, 0, size, 0, 0)
    return twist * (0, 0, 1, 1, 1, 0) if planar else twist


def kern_body():
    """Kern & Koumoutsakos 2006, L = 1 m."""
    wh, sb, st, wt, a, b = 0.04, 0.04, 0.95, 0.01, 0.51, 0.08

    def half_width(x):
        x = np.asarray(x, float)
        front = np.sqrt(np.maximum(2 * wh * x - x**2, 0.0))
        middle = wh - (wh - wt) * ((x - sb) / (st - sb)) ** 2
        return np.where(x < sb, front, np.where(x < st, middle, wt * (1 - x) / (1 - st)))

    def half_height(x):
        return b * np.sqrt(np.maximum(1 - ((np.asarray(x, float) - a) / a) ** 2, 0.0))

    kinks = (0.0, sb, st, 1.0)
    nose = float(half_width(sb)), float(half_height(sb)), sb
    return SimpleNamespace(half_width=half_width, half_height=half_height, kinks=kinks, nose=nose, density=1000.0)
