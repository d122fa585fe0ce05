# SPDX-License-Identifier: Apache-2.0
"""The law or the samples that the body follows, and the smooth change from one to the next.

A new law or controller takes over with a blend. The difference between the present motion and the new one (value, rate
and acceleration) is added to the new one, and dies out as a quintic over a transition. So the curvature, its rate and
its acceleration never jump. When a controller's samples run out, the shape comes to rest in the same way.
"""

from collections.abc import Callable
from copy import copy
from typing import Any, NamedTuple

import numpy as np
from eel_gaits.laws.law import Law
from eel_gaits.sources.sampled_law import SampledLaw

import eel_core
from eel_dynamics.accuracy.law_speed import speed_of
from eel_dynamics.curvature.curvature_samples import CurvatureSample, SampleQueue
from eel_dynamics.curvature.tabulated_law import SEGMENT_AXES, TabulatedLaw, Tabulation

DEFAULT_TRANSITION = 1.0  # s


class Blend(NamedTuple):
    """The difference (6, width) between two motions at `start` [s]: value, rate and acceleration for each axis.

    It decays to 0 until `end` [s]. Its factors in time are `Quintic::set_blend` in eel_core/law.hpp. Swimmers marched
    together (`SampledMarch` in eel_core/march/sampled_march.hpp) have a single blend, into the first sample, in C++.
    """

    difference: np.ndarray
    start: float
    end: float


class LawFollower:
    """The present source of curvature and its blend. `law_on_grid` holds both for the core.

    default_transition: [s], of blends to samples and to rest. law: the first law, whose own t = 0 is at `origin` [s].
    Without a law the body is straight. The rows of a `SampledLaw` are samples that are all present from the beginning.
    """

    def __init__(
        self,
        tabulation: Tabulation,
        default_transition: float = DEFAULT_TRANSITION,
        law: Law | SampledLaw | None = None,
        origin: float = 0.0,
    ):
        self._tabulation, self._default_transition = tabulation, default_transition
        self.law = law
        self.samples = SampleQueue()
        self.sampled = False  # whether samples drive the shape
        self.resting = False  # whether they have run out
        self._blend: Blend | None = None
        self._spline: tuple[np.ndarray, np.ndarray] | None = None  # x of a sample, and its splines on the grid
        self._last: tuple[CurvatureSample, np.ndarray] | None = None  # the last tabulated sample, and its rows
        self._source = self._begun(law, origin, 0.0)
        self.law_on_grid = self._with_blend()

    def __copy__(self) -> "LawFollower":
        """Constant data are shared."""
        copied = object.__new__(type(self))
        copied.__dict__.update(self.__dict__)
        copied.samples = copy(self.samples)
        return copied

    def __getstate__(self) -> dict[str, Any]:
        """Without the core's tables: `tabulate` must follow."""
        left_out = "_tabulation", "law_on_grid", "_spline"
        kept = {name: value for name, value in self.__dict__.items() if name not in left_out}
        return kept | {"_source": self._source._replace(tables=None)}

    def tabulate(self, tabulation: Tabulation) -> None:
        """Restore the data that a pickle leaves out, on a grid with this `tabulation`."""
        self._tabulation, self._spline = tabulation, None
        self._follow(self._source)

    def move(self, tabulation: Tabulation, values_at_nodes: Callable[[np.ndarray], np.ndarray]) -> None:
        """Change to the grid of another `tabulation`.

        A law is tabulated again. Samples and blends are kept as values at the old nodes: `values_at_nodes(rows)` takes
        fields at the old nodes (..., n) to the new points.
        """
        nodes = self._tabulation.nodes

        def convert(rows: np.ndarray) -> np.ndarray:
            return tabulation.columns(values_at_nodes(rows[..., :nodes]))

        source = self._source
        if source.law is not None:
            source = TabulatedLaw.of_law(source.law, source.origin, tabulation)
        else:
            source = source._replace(rows=convert(source.rows), tables=None)
        if self._blend is not None:
            self._blend = self._blend._replace(difference=convert(self._blend.difference))
        self._tabulation, self._spline, self._last = tabulation, None, None
        self._follow(source)

    def blend_into(self, law: Law | SampledLaw, *, origin: float, time: float, transition: float) -> None:
        """Follow `law` from `time` [s] on, with a blend over `transition` [s]."""
        self._forget_samples()
        self._take_over(self._begun(law, origin, time), time, transition)
        self.law = law

    def _begun(self, law: Law | SampledLaw | None, origin: float, time: float) -> TabulatedLaw:
        """The source of `law` at `time` [s]. Before the first row of a `SampledLaw` the body is straight."""
        if not isinstance(law, SampledLaw):
            return TabulatedLaw.of_law(law, origin, self._tabulation)
        self.samples = SampleQueue.of_law(law, origin)
        self.samples.drop_until(time)
        self.sampled = self.samples.begun(time)
        return self._segment() if self.sampled else TabulatedLaw.of_law(None, 0.0, self._tabulation)

    # -- samples of a controller

    def add(self, sample: CurvatureSample) -> None:
        """Add a sample. `ValueError` for a late or repeated one."""
        self.samples.add(sample, self.sampled)

    def next_event(self, now: float) -> float:
        """The next time [s] at which the source changes by itself; inf without one."""
        return self.samples.first_two[1].time if self.sampled else self.samples.next_bracket(now)

    def pass_event(self, now: float, prepare: Callable[[float], None]) -> None:
        """Change the source if that is due at `now` [s].

        The new source is the samples that bracket the time, their next interval, or rest. prepare(waves on the body) is
        called before samples drive the shape, for them and the next ones. It may call `move`.
        """
        if self.sampled and now >= self.next_event(now):
            self.samples.drop_first()
            if len(self.samples) > 1:
                prepare(self.samples.waves)
                self._follow(self._segment())
            else:
                value, _, _ = self._at(now)
                self._take_over(TabulatedLaw.constant(value), now, self._default_transition)
                self._forget_samples()
                self.resting = True
        elif not self.sampled:
            self.samples.drop_until(now)
            if self.samples.begun(now):
                prepare(self.samples.waves)
                self._take_over(self._segment(), now, self._default_transition)
                self.sampled, self.resting = True, False

    def pass_events(self, now: float, time: float) -> None:
        """Change the source at each event from `now` to `time` [s], for a caller that reads the law without
        marching."""
        while (event := self.next_event(now)) < time:
            now = event
            self.pass_event(now, lambda waves: None)

    def _forget_samples(self) -> None:
        self.samples, self.sampled, self.resting = SampleQueue(), False, False

    # -- data for the steps in time

    @property
    def breakpoints(self) -> list[float]:
        """Times [s] at which a derivative of the curvature jumps, ascending."""
        ends = () if self._blend is None else (self._blend.end,)
        return sorted({*self._source.breakpoints, *ends})

    @property
    def between_samples(self) -> bool:
        """Whether the curvature is a quintic between two samples of a controller, or two rows of a law."""
        return self._source.segment is not None

    @property
    def time_scale(self) -> float:
        """Shortest period [s] of the law; inf without one.

        Ramps, blends and samples do not count, because they begin and end on steps.
        """
        return min((period for period, *_ in self._source.waves if period > 0.0), default=np.inf)

    def speed(self, length: float) -> float:
        """Order of magnitude of the speed [m/s] of a body of `length` [m] under the law.

        It is 0 for samples and at rest.
        """
        return speed_of(self._source.law, length) if self._source.law is not None else 0.0

    # -- blends

    @property
    def blending(self) -> bool:
        """Whether the last motion is still decaying, or has come to rest. Its finer waves are then still present."""
        return self._blend is not None or self.resting

    def end_blend(self, now: float) -> None:
        """Remove a blend that has ended at `now` [s], so that it costs nothing."""
        if self._blend is not None and now >= self._blend.end:
            self._blend = None
            self._follow(self._source)

    def _take_over(self, source: TabulatedLaw, time: float, transition: float) -> None:
        present = self._at(time)
        self._blend = None
        self._follow(source)
        difference = (present - self._at(time)).swapaxes(0, 1).reshape(6, -1)
        if np.any(difference):
            self._blend = Blend(difference, time, time + transition)
        self._follow(source)

    def _at(self, time: float) -> np.ndarray:
        """Tabulated value, rate and acceleration (3, 2, width) at `time` [s]."""
        rows, axis = self.rows()
        factor = np.array(self.law_on_grid.factors(time))
        return np.stack([factor[:, axis == each] @ rows[axis == each] for each in (0, 1)], axis=1)

    def _segment(self) -> TabulatedLaw:
        """The quintic between the two samples that bracket the present."""
        first, second = self.samples.first_two
        start = self._last[1] if self._last is not None and self._last[0] is first else self._tabulated(first)
        self._last = second, self._tabulated(second)
        rows = np.concatenate((start, self._last[1]), axis=1)  # axis; value and its derivatives at both
        return TabulatedLaw(rows.reshape(12, -1), SEGMENT_AXES, segment=(first.time, second.time))

    def _tabulated(self, sample: CurvatureSample) -> np.ndarray:
        """Rows (2, 3, width) of a sample."""
        if self._spline is None or self._spline[0] is not sample.x:
            self._spline = sample.x, self._tabulation.weights_of(sample.x)
        rows = np.empty((2, 3, self._tabulation.width))
        eel_core.tabulate(self._spline[1], np.ascontiguousarray(sample.values), rows)
        return rows

    def _follow(self, source: TabulatedLaw) -> None:
        self._source = source
        self.law_on_grid = self._with_blend()

    def rows(self) -> tuple[np.ndarray, np.ndarray]:
        """Rows (m, width) of source and blend, and their axes (m,)."""
        if self._blend is None:
            return self._source.rows, self._source.axis
        rows = np.concatenate((self._source.rows, self._blend.difference))
        return rows, np.concatenate((self._source.axis, np.repeat((0, 1), 3)))

    def _with_blend(self) -> eel_core.LawOnGrid:
        shared = self._source.tables if self._blend is None else None
        return self.on_tables(self._tabulation.law_tables(*self.rows()) if shared is None else shared)

    def on_tables(self, tables: eel_core.LawTables) -> eel_core.LawOnGrid:
        """Source and blend with other `tables`, whose first rows replace those of `rows`."""
        source, blend = self._source, self._blend
        segment = source.segment and (0, *source.segment)
        dying = blend and (len(source.rows), blend.start, blend.end)
        return eel_core.LawOnGrid(tables, float(source.origin), list(source.waves), segment, dying)
