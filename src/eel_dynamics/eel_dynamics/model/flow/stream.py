# SPDX-License-Identifier: Apache-2.0
"""A current that comes sample by sample, as from a sensor or a controller.

Each sample is reached one interval after it arrives, along a cubic that begins with the present velocity and rate. So u
and its rate never jump, and no later sample is needed. A sample with a later stamp is reached at its stamp.
When samples stop, the rate dies out within another interval, and the last velocity is held.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

import eel_core
from eel_dynamics.model.flow.flow import Flow, FlowTraits

SHORTEST = 1e-3  # s, of an interval
LONGEST = 10.0  # s, of one: a sample after a longer silence begins anew
LATEST = 1e12  # s, of a stamp: numbers do not carry an interval beyond it
FASTEST = 100.0  # m/s along an axis: no water flows like that, and far beyond it no march can follow
PERIODS = 4.0  # intervals in the shortest period that samples can show


@dataclass(frozen=True)
class Course(Flow):
    """Water that moves alike everywhere, by cubics in time between `knots` (n,) [s]; held before and after them.

    values, rates: (n, 3) [m/s], [m/s^2] at the knots.
    """

    vectors = ("values",)

    knots: tuple[float, ...]
    values: tuple[tuple[float, ...], ...]
    rates: tuple[tuple[float, ...], ...]

    def sources(self, planar: bool) -> "list[eel_core.Source]":
        # not SciPy's cubics: its import takes more than a second, in a node between two samples
        u, v, h = np.array(self.values), np.array(self.rates), np.diff(self.knots)[:, None]
        slope = np.diff(u, axis=0) / h
        square = (3.0 * slope - 2.0 * v[:-1] - v[1:]) / h
        cube = (v[:-1] + v[1:] - 2.0 * slope) / h**2
        pieces = np.ascontiguousarray(np.stack([u[:-1], v[:-1], square, cube], axis=1))
        return [eel_core.SplineFlow(np.array(self.knots), pieces)]

    @cached_property
    def traits(self) -> FlowTraits:
        return FlowTraits(self.knots, PERIODS * float(np.diff(self.knots).min()))


class CurrentStream:
    """The course through the samples so far.

    transition: [s], in which the first sample is reached, from water at rest.

    Attributes:
        course: Course, or None before the first sample.
        interval: [s], between the last two samples; None before there are two.
        last, velocity: stamp [s] of the last sample, and its velocity (3,) [m/s].
    """

    def __init__(self, transition: float) -> None:
        self._transition = transition
        self.course: Course | None = None
        self.interval: float | None = None
        self.last, self.velocity = -np.inf, np.zeros(3)

    def add(self, now: float, stamp: float, velocity: np.ndarray) -> Course | None:
        """The course from `now` [s] on with a sample (3,) [m/s] of the time `stamp` [s]; None: it is no newer."""
        passed = stamp - self.last
        if not passed > 0.0:
            return None
        before = None if self.course is None else self.course.sample([0.0, 0.0, 0.0], now)
        u, rate = (np.zeros(3), np.zeros(3)) if before is None else (before.velocity, before.rate)
        known = before is not None and passed <= LONGEST
        self.interval = max(passed, SHORTEST) if known else None
        interval = self.interval or self._transition
        reached = max(now + interval, stamp)
        slope = (velocity - self.velocity) / interval if known else np.zeros(3)
        self.last, self.velocity = stamp, velocity
        values, rates = (u, velocity, velocity), (rate, slope, np.zeros(3))
        rows = [tuple(tuple(row.tolist()) for row in each) for each in (values, rates)]
        self.course = Course((now, reached, reached + interval), *rows)
        return self.course

    def is_silent(self, now: float) -> bool:
        """Whether the next sample is overdue at `now` [s]: by two intervals, or the transition after the first."""
        return self.course is not None and now > self.last + 3.0 * (self.interval or self._transition)
