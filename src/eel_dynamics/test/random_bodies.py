# SPDX-License-Identifier: Apache-2.0
"""Bodies from data as users have them: 6 to 38 points at unequal distances, with tapers, bumps and noise.

Each comes with the smooth body from which the data were taken, before the noise.
"""

from typing import NamedTuple

import numpy as np

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
