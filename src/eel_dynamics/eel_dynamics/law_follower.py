"""Which law or samples the body follows, and how it passes smoothly from one to the next.

When a new law or controller takes over, the difference between the present motion and the new one (value, rate and
acceleration) dies out as a quintic over a transition, added to the new one: the curvature, its rate and its
acceleration never jump. When a controller's samples run out, the shape comes to rest by the same means.
"""

import math
from bisect import bisect_left, bisect_right
from collections.abc import Callable
from functools import lru_cache
from operator import attrgetter
from typing import NamedTuple

import numpy as np
from eel_gaits.law import Law, amplitude_of
from eel_gaits.spline import natural_spline

import eel_core

from .difficulty import speed_of
from .law_waves import groups_of
from .tabulated_law import AXES, Tabulation

AHEAD = 100  # instants that a grid is chosen for, so that it does not change with every one
TIME_OF = attrgetter("time")
NO_NUMBER, NO_RAMP = np.zeros(0), np.zeros((0, 3))


class Instant(NamedTuple):
    """Of a controller: curvature `values` (2, 3, n) [rad/m], pitch and yaw, value, rate and acceleration, at the points
    x (n,) [m], at `time` [s]."""

    time: float
    x: np.ndarray
    values: np.ndarray


class LawFollower:
    """The present source of curvature, its blend, and the tabulated `drive` of both for the loops.

    `default_transition` [s] holds where a law gives none, and for samples. law: the first; without one it is straight.
    """

    def __init__(self, tabulation: Tabulation, default_transition: float, law: Law | None = None):
        self.tabulation = tabulation
        self.default_transition = default_transition
        self.law = law
        self.origin = 0.0
        self.samples: list[Instant] = []  # from the start of the segment on
        self.points_ahead = 0  # of all of them
        self.sampled = False
        self.resting = False
        self._blend: tuple[np.ndarray, float, float] | None = None
        self._spline: tuple[np.ndarray, np.ndarray] | None = None
        self._source: dict = {}
        self.tabulated_law: eel_core.Law = None  # for the compiled mechanics
        self._follow(_straight(tabulation) if law is None else _law_rows(law, tabulation))

    def move(self, tabulation: Tabulation, values_at_nodes):
        """Go over to another tabulation. `values_at_nodes(rows)` takes fields at the old nodes (..., n) to the new
        points: what remains of samples and blends are values at the old nodes; a law is tabulated anew.
        """
        nodes = self.tabulation.nodes
        convert = lambda rows: tabulation.columns(values_at_nodes(rows[..., :nodes]))  # noqa: E731
        if "law" in self._source:
            self._source = _law_rows(self._source["law"], tabulation) | {"origin": self._source["origin"]}
        else:
            self._source = self._source | {"rows": convert(self._source["rows"]), "tables": None}
        if self._blend is not None:
            self._blend = (convert(self._blend[0]), *self._blend[1:])
        self.tabulation, self._spline = tabulation, None
        self._follow(self._source)

    # -- laws

    def adopt(self, law: Law, *, origin: float, time: float, transition: float):
        """Follow `law` from `time` [s] on; `transition` 0: at once, without a blend."""
        source = _law_rows(law, self.tabulation)
        if origin != source["origin"]:
            source = source | {"origin": origin}
        self._take_over(source, time, transition)
        self.law, self.origin = law, origin
        self.forget_samples()

    # -- samples of a controller

    def add(self, instant: Instant):
        """One instant more. `ValueError` for one that comes too late, or twice."""
        time, place = instant.time, bisect_left(self.samples, instant.time, key=TIME_OF)
        if self.sampled and place < 2:
            ahead = f"the instant being approached ({self.samples[1].time:.6f} s)"
            raise ValueError(f"curvature samples time must come after {ahead}, got {time:.6f} s")
        if place < len(self.samples) and self.samples[place].time == time:
            raise ValueError(f"curvature samples time must be new, got {time:.6f} s twice")
        self.samples.insert(place, instant)
        self.points_ahead += len(instant.x)

    @property
    def until(self) -> float | None:
        """Last instant of a controller that drives or is about to [s], or None."""
        return self.samples[-1].time if self.samples else None

    def next_event(self, now: float) -> float:
        """Time [s] at which the source changes by itself, inf where it does not."""
        if self.sampled:
            return self.samples[1].time
        later = bisect_right(self.samples, now, key=TIME_OF)
        return self.samples[later].time if later + 1 < len(self.samples) else np.inf

    def pass_event(self, now: float, prepare: Callable[[list[Instant]], None]):
        """Change the source as due at `now` [s]: to samples that bracket the time, to their next interval, or to rest.
        prepare(instants): is called before some drive that did not before, with them and those that follow, and may
        `move`."""
        if self.sampled:
            if now < self.samples[1].time:
                return
            self._drop_first()
            if len(self.samples) > 1:
                prepare(self.samples[:AHEAD])
                self._follow(self._segment())
                return
            value, _, _ = self.at(now)
            self._take_over(_constant(value), now, self.default_transition)
            self.forget_samples()
            self.resting = True
            return
        while len(self.samples) > 1 and self.samples[1].time <= now:
            self._drop_first()
        if len(self.samples) > 1 and self.samples[0].time <= now:
            prepare(self.samples[:AHEAD])
            self._take_over(self._segment(), now, self.default_transition)
            self.sampled, self.resting = True, False

    def _drop_first(self):
        self.points_ahead -= len(self.samples.pop(0).x)

    def forget_samples(self):
        """Drop the controller's instants; the shape stays with what drives it."""
        self.samples, self.points_ahead, self.sampled, self.resting = [], 0, False, False

    # -- rows

    def at(self, time: float) -> np.ndarray:
        """Tabulated value, rate and acceleration (3, 2, width) at `time` [s]."""
        factor = np.array(self.tabulated_law.factors(time))
        result = np.zeros((3, 2, self.tabulation.width))
        for axis in range(2):
            mine = self._axis == axis
            result[:, axis] = factor[:, mine] @ self._rows[mine]
        return result

    def breakpoints(self) -> np.ndarray:
        """Times [s] at which a derivative of the shape jumps, ascending."""
        source, origin = self._source, self._source.get("origin", 0.0)
        if self._blend is None and "ends" in source:
            return origin + source["ends"]
        times = {origin + time for *ends, _ in source.get("ramps", NO_RAMP).tolist() for time in ends}
        times |= {self._blend[2]} if self._blend is not None else set()
        times |= set(source.get("segment", ()))
        return np.array(sorted(times), dtype=float)

    @property
    def between_samples(self) -> bool:
        """Whether the shape is a quintic between two samples of a controller."""
        return "segment" in self._source

    @property
    def time_scale(self) -> float:
        """Shortest period [s] of the law; inf where it has none. Ramps, blends and samples begin and end on steps
        anyway."""
        return min(
            (period for period in self._source.get("period", NO_NUMBER).tolist() if period > 0.0), default=math.inf
        )

    def speed(self, length: float) -> float:
        """Speed [m/s] that the law gives to a body of `length` [m], of the order of; 0 for samples and at rest."""
        return speed_of(self._source["law"], length) if "law" in self._source else 0.0

    @property
    def blending(self) -> bool:
        """What drove before dies out, or has come to rest: its finer waves are still there."""
        return self._blend is not None or self.resting

    def end_blend(self, now: float):
        """Drop a blend that is over, so that it costs nothing."""
        if self._blend is not None and now >= self._blend[2]:
            self._blend = None
            self._follow(self._source)

    def _take_over(self, source: dict, time: float, transition: float):
        if transition > 0.0:
            present = self.at(time)
            self._blend = None
            self._follow(source)
            difference = (present - self.at(time)).swapaxes(0, 1).reshape(6, -1)
            if np.any(difference):
                self._blend = (difference, time, time + transition)
        else:
            self._blend = None
        self._follow(source)

    def _segment(self) -> dict:
        first, second = self.samples[:2]
        rows = np.stack((self._tabulated(first), self._tabulated(second)), axis=1).reshape(12, -1)
        return {"rows": rows, "axis": np.repeat((0, 1), 6), "segment": (first.time, second.time)}

    def _tabulated(self, instant: Instant) -> np.ndarray:
        """Rows (2, 3, width) of an instant."""
        if self._spline is None or not np.array_equal(self._spline[0], instant.x):
            matrix = natural_spline(instant.x, np.eye(len(instant.x)), self.tabulation.x)
            self._spline = instant.x, self.tabulation.columns(matrix)
        return instant.values @ self._spline[1]

    def _follow(self, source: dict):
        self._source = source
        rows, axis, blend = source["rows"], np.asarray(source["axis"]), None
        if self._blend is not None:
            difference, start, end = self._blend
            blend = len(rows), start, end
            rows, axis = np.concatenate((rows, difference)), np.concatenate((axis, np.repeat((0, 1), 3)))
        self._rows, self._axis = rows, axis
        tables = source.get("tables") if self._blend is None else None
        if tables is None:
            tables = self.tabulation.law_tables(rows, axis)
        segment = (0, *source["segment"]) if "segment" in source else None
        self.tabulated_law = eel_core.Law(
            tables, float(source.get("origin", 0.0)), source.get("waves", []), segment, blend
        )


@lru_cache(maxsize=256)
def _straight(tabulation: Tabulation) -> dict:
    """The straight shape at rest."""
    source = _constant(np.zeros((2, tabulation.width)))
    return source | {"tables": tabulation.law_tables(source["rows"], source["axis"])}


def _constant(value: np.ndarray) -> dict:
    """A shape that stands still: value (2, width)."""
    waves = [(0.0, None, axis, axis) for axis in range(2)]
    return {"rows": np.array(value), "origin": 0.0, "axis": np.arange(2), "waves": waves}


@lru_cache(maxsize=1024)
def _pattern(groups: tuple, tabulation: Tabulation) -> dict:
    """Rows along the body of `groups` of terms: (axis, whether they have a period, their waveforms)."""
    rows, axis, sine, cosine = [], [], [], []
    for name, moving, waveforms in groups:
        angle = [wave_number * tabulation.x + phase for _, _, wave_number, phase in waveforms]
        amplitude = [amplitude_of(*of, tabulation.x) for *of, _, _ in waveforms]
        sine.append(len(rows))
        rows.append(sum(a * np.sin(b) for a, b in zip(amplitude, angle, strict=True)))
        cosine.append(len(rows) if moving else sine[-1])
        if moving:
            rows.append(sum(a * np.cos(b) for a, b in zip(amplitude, angle, strict=True)))
        axis += [AXES[name]] * (2 if moving else 1)
    table = tabulation.columns(np.array(rows))
    tables = tabulation.law_tables(table, axis)
    return {"rows": table, "tables": tables, "axis": np.array(axis), "sine": sine, "cosine": cosine}


@lru_cache(maxsize=1024)
def _law_rows(law: Law, tabulation: Tabulation) -> dict:
    """Rows and time factors of a law; terms of equal axis, period and envelope share their rows. Laws that differ in
    periods and envelopes alone share theirs."""
    groups = groups_of(law)
    if not groups:
        return _straight(tabulation)
    pattern = _pattern(tuple((key[0], key[1] > 0.0, tuple(terms)) for key, terms in groups.items()), tabulation)
    ramps = [[(ramp.start, ramp.end, ramp.delta) for ramp in envelope] for _, _, envelope in groups]
    waves = [
        (period, envelope or None, sine, cosine)
        for (_, period, _), envelope, sine, cosine in zip(
            groups, ramps, pattern["sine"], pattern["cosine"], strict=True
        )
    ]
    every = [ramp for envelope in ramps for ramp in envelope]
    return pattern | {
        "law": law,
        "origin": 0.0,
        "waves": waves,
        "period": np.array([period for _, period, _ in groups]),
        "ramps": np.array(every, dtype=float).reshape(-1, 3),
        "ends": np.array(sorted({time for *ends, _ in every for time in ends}), dtype=float),
    }
