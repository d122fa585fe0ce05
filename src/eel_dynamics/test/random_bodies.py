# SPDX-License-Identifier: Apache-2.0
"""Bodies from data as users have them: 6 to 38 points at unequal distances, with tapers, bumps and noise.

Each comes with the smooth body from which the data were taken, before the noise.
"""

from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
from eel_dynamics.model.body.appendages import Appendage

from eel_dynamics import Body
from eel_gaits import Law, Term


class DrawnBody(NamedTuple):
    """A body from data, the smooth body behind them, and a body as exact as can be with a kink at each data point."""

    data: Body
    smooth: Body
    cut: Body


def drawn_body(rng: np.random.Generator, most_noise: float = 0.03) -> DrawnBody:
    """A body of 0.3 to 2 m with a round nose and a blunt or pointed tail; `most_noise`: of the half-axes."""
    length, points = rng.uniform(0.3, 2.0), rng.integers(6, 39)
    x = np.cumsum(rng.uniform(0.3, 1.0, points - 1))
    x = length * np.concatenate(([0.0], x / x[-1]))
    pointed = rng.random() < 0.3
    axes = [_half_axis(rng, length, size, pointed) for size in (rng.uniform(0.02, 0.05), rng.uniform(0.03, 0.07))]
    noise = rng.uniform(0.0, most_noise)
    values = [axis(x) * (1.0 + noise * rng.standard_normal(points)) for axis in axes]
    density = rng.uniform(900.0, 1200.0)
    data = Body(x=x, half_width=values[0], half_height=values[1], density=density)
    smooth = Body(half_width=axes[0], half_height=axes[1], length=length, density=density)
    return DrawnBody(data, smooth, with_kinks_at_data(data))


def with_kinks_at_data(body: Body) -> Body:
    """The same half-axes as functions with a kink at each data point, so that each panel is smooth."""
    given = body.half_axes["half_width"][0]
    return Body(
        half_width=body.half_width,
        half_height=body.half_height,
        length=body.length,
        kinks=given[1:-1],
        nose=body.nose,
        density=body.density,
    )


def drawn_law(rng: np.random.Generator, length: float) -> Law:
    """An ordinary gait: a wave that grows towards the tail, for some with a constant bend or a wave in pitch."""
    period = rng.uniform(0.6, 2.0)
    phase, slope = rng.uniform(0.0, 6.0), rng.uniform(0.5, 2.5)

    def wave(axis, size):
        return Term(
            axis=axis,
            amplitude=(0.5 * size / length, slope * size / length**2),
            wavelength=rng.uniform(0.7, 1.6) * length,
            period=period,
            phase=phase,
        )

    terms = [wave("yaw", rng.uniform(0.5, 1.5))]
    kind = rng.integers(3)
    if kind == 1:
        terms.append(Term(axis="yaw", amplitude=(rng.uniform(-0.5, 0.5) / length,), phase=0.5 * np.pi))
    if kind == 2:
        terms.append(wave("pitch", rng.uniform(0.2, 0.6)))
    return Law(*terms, name="drawn")


def _half_axis(rng: np.random.Generator, length: float, size: float, pointed: bool):
    nose, taper, power = rng.uniform(0.1, 0.4), rng.uniform(0.2, 0.9), rng.uniform(1.0, 3.0)
    places, heights = rng.uniform(0.2, 0.9, 2), rng.uniform(-0.15, 0.25, 2)
    widths = rng.uniform(0.08, 0.2, 2)

    def half_axis(x):
        s = np.asarray(x, dtype=float) / length
        cap = np.sqrt(np.maximum(0.0, 1.0 - np.exp(-3.0 * s / nose)))
        tail = np.sqrt(np.maximum(0.0, 1.0 - s**4)) if pointed else 1.0 - taper * s**power
        bumps = sum(h * np.exp(-(((s - p) / w) ** 2)) for h, p, w in zip(heights, places, widths, strict=True))
        return length * size * cap * tail * (1.0 + bumps)

    return half_axis


def drawn_hull(rng: np.random.Generator, length: float, along: bool = True) -> dict:
    """What makes a body of `length` [m] one of blunt links, as arguments of `Body`: coefficients as numbers, by shape
    or (`along`) as functions of X, and up to four appendages, some of them at the ends."""

    def coefficient(low, high, *others):
        size, slope = rng.uniform(low, high), rng.uniform(-0.4, 0.4)
        wave = lambda x: size * (1.0 + slope * np.sin(2.0 * np.asarray(x) / length))  # noqa: E731
        return (size, *others, *([wave] if along else []))[rng.integers(1 + len(others) + along)]

    return {
        "roll_drag": rng.uniform(0.5, 1.5),
        "lateral_drag": coefficient(0.8, 2.2, "by shape"),
        "vertical_drag": coefficient(0.8, 2.2, "by shape"),
        "friction_factor": rng.uniform(0.5, 4.0),
        "lateral_added_mass": coefficient(0.5, 1.5),
        "round_added_mass": rng.uniform(0.0, 1.0),
        "joint_drag": rng.uniform(0.1, 0.9),
        "link_length": rng.uniform(0.05, 0.3) * length,
        "base_drag": rng.uniform(0.1, 0.5),
        "nose_added_mass": rng.uniform(0.1, 0.5),
        "nose_drag": rng.uniform(0.0, 0.6),
        "appendages": drawn_appendages(rng, length),
    }


def drawn_appendages(rng: np.random.Generator, length: float) -> tuple[Appendage, ...]:
    """Up to four of a body of `length` [m], of both laws, inside it and at its ends."""

    def one():
        x = (0.0, length, *rng.uniform(0.02, 0.98, 4) * length)[rng.integers(6)]
        y, z = map(float, rng.uniform(-0.1, 0.1, 2) * length)
        drag1, drag2, drag3 = map(float, rng.uniform(0.0, 0.01, 3) * length**2)
        return Appendage(float(x), y, z, drag1, drag2, drag3, str(rng.choice(["axis", "speed"])))

    return tuple(one() for _ in range(rng.integers(1, 5)))


def drawn_chain(rng: np.random.Generator) -> SimpleNamespace:
    """A body of links with a blunt nose and a blunt tail, as the reference takes it: wide in one part and high in the
    other, or round all along, with the numbers of `drawn_hull`."""
    length, size, bulge = rng.uniform(0.4, 2.0), rng.uniform(0.02, 0.05, 2), rng.uniform(-0.3, 0.3, 2)
    if rng.random() < 0.3:
        size, bulge = size[[0, 0]], bulge[[0, 0]]  # round

    def half_axis(k):
        wave = lambda s: 1.0 + bulge[k] * np.sin(3.0 * s + 2.0 * k) - 0.3 * s  # noqa: E731
        return lambda x: length * size[k] * wave(np.asarray(x, dtype=float) / length)

    width, height = half_axis(0), half_axis(int(np.ptp(size) > 0.0))
    a, b = float(height(0.0)), float(width(0.0))
    return SimpleNamespace(
        half_width=width,
        half_height=height,
        kinks=(0.0, 0.3 * length, length),
        nose=(a, b, float(np.sqrt(a * b))),
        density=rng.uniform(900.0, 1200.0),
        hull={"blunt_nose": True, **drawn_hull(rng, length)},
    )
