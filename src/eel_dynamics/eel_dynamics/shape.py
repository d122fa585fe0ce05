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

from .drive import AXES, TABLES, TIMES, Drive, Tables, Tabulation, Times, factors
from .effort import speed_of
from .lanes import aligned
from .packed import Packed
from .waveforms import groups_of

AHEAD = 100  # instants that a grid is chosen for, so that it does not change with every one
TIME_OF = attrgetter("time")
NONE, NO_NUMBER, NO_RAMP = np.zeros(0, dtype=np.int64), np.zeros(0), np.zeros((0, 3))


class Instant(NamedTuple):
    """Of a controller: curvature `values` (2, 3, n) [rad/m], pitch and yaw, value, rate and acceleration, at the points
    x (n,) [m], at `time` [s]."""

    time: float
    x: np.ndarray
    values: np.ndarray


class Shape:
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
        self.drive: Drive = None
        self.packed: tuple[Packed, Packed] = ()  # of the drive: `Tables`, `Times`
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
        factor = np.zeros((3, len(self.drive.axis)))
        factors(self.drive, time, factor)
        result = np.zeros((3, 2, self.tabulation.width))
        for axis in range(2):
            mine = self.drive.axis == axis
            result[:, axis] = factor[:, mine] @ self._rows[mine]
        return result

    def breakpoints(self) -> np.ndarray:
        """Times [s] at which a derivative of the shape jumps, ascending."""
        drive = self.drive
        if drive.blend < 0 and "ends" in self._source:
            return drive.origin + self._source["ends"]
        times = {drive.origin + time for ramp in drive.ramps[:, :2].tolist() for time in ramp}
        times |= {drive.blend_end} if drive.blend >= 0 else set()
        times |= {drive.segment_start, drive.segment_end} if drive.segment >= 0 else set()
        return np.array(sorted(times), dtype=float)

    @property
    def time_scale(self) -> float:
        """Shortest period [s] of the law; inf where it has none. Ramps, blends and samples begin and end on steps
        anyway."""
        return min((period for period in self.drive.period.tolist() if period > 0.0), default=math.inf)

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
        rows, axis = source["rows"], source["axis"]
        start, end = source.get("segment", (0.0, 0.0))
        blend, blend_start, blend_end = -1, 0.0, 0.0
        if self._blend is not None:
            blend = len(rows)
            difference, blend_start, blend_end = self._blend
            rows, axis = np.concatenate((rows, difference)), np.concatenate((axis, np.repeat((0, 1), 3)))
        self._rows = rows
        tables = source.get("tables") if self._blend is None else None
        if tables is None:
            tables = _tables(self.tabulation, rows, axis, source.get("sine", NONE), source.get("cosine", NONE))
        times = Times(
            origin=float(source.get("origin", 0.0)),
            period=source.get("period", NO_NUMBER),
            ramp_first=source.get("ramp_first", NONE),
            ramp_count=source.get("ramp_count", NONE),
            ramps=source.get("ramps", NO_RAMP),
            segment=0 if "segment" in source else -1,
            segment_start=float(start),
            segment_end=float(end),
            blend=blend,
            blend_start=float(blend_start),
            blend_end=float(blend_end),
        )
        self.drive = Drive(*tables.value, *times)
        self.packed = tables, TIMES.packed(times)


def _tables(tabulation: Tabulation, rows: np.ndarray, axis, sine, cosine) -> Packed:
    """`Tables` of tabulated `rows` (m, width)."""
    node, bend, station, station_bend = tabulation.split(rows)
    angle = aligned(np.cumsum(bend[:, 0], axis=1), bend.shape[-1])
    axis = np.asarray(axis, dtype=np.int64)
    return TABLES.packed(Tables(axis, node, angle, bend, station, station_bend, sine, cosine))


@lru_cache(maxsize=256)
def _straight(tabulation: Tabulation) -> dict:
    """The straight shape at rest."""
    source = _constant(np.zeros((2, tabulation.width)))
    return source | {"tables": _tables(tabulation, *(source[name] for name in ("rows", "axis", "sine", "cosine")))}


def _constant(value: np.ndarray) -> dict:
    """A shape that stands still: value (2, width)."""
    return {
        "rows": np.array(value),
        "origin": 0.0,
        "axis": np.arange(2),
        "sine": np.arange(2),
        "cosine": np.full(2, -1),
        "period": np.zeros(2),
        "ramp_first": np.zeros(2, dtype=np.int64),
        "ramp_count": np.full(2, -1),
    }


@lru_cache(maxsize=1024)
def _pattern(groups: tuple, tabulation: Tabulation) -> dict:
    """Rows along the body of `groups` of terms: (axis, whether they have a period, their waveforms)."""
    rows, axis, sine, cosine = [], [], [], []
    for name, moving, waveforms in groups:
        angle = [wave_number * tabulation.x + phase for _, _, wave_number, phase in waveforms]
        amplitude = [amplitude_of(*of, tabulation.x) for *of, _, _ in waveforms]
        sine.append(len(rows))
        rows.append(sum(a * np.sin(b) for a, b in zip(amplitude, angle, strict=True)))
        cosine.append(len(rows) if moving else -1)
        if moving:
            rows.append(sum(a * np.cos(b) for a, b in zip(amplitude, angle, strict=True)))
        axis += [AXES[name]] * (2 if moving else 1)
    table = tabulation.columns(np.array(rows))
    axis, sine, cosine = (np.array(each, dtype=np.int64) for each in (axis, sine, cosine))
    tables = _tables(tabulation, table, axis, sine, cosine)
    return {"rows": table, "tables": tables, "axis": axis, "sine": sine, "cosine": cosine}


@lru_cache(maxsize=1024)
def _law_rows(law: Law, tabulation: Tabulation) -> dict:
    """Rows and time factors of a law; terms of equal axis, period and envelope share their rows. Laws that differ in
    periods and envelopes alone share theirs."""
    groups = groups_of(law)
    if not groups:
        return _straight(tabulation)
    first, count, ramps = [], [], []
    for _, _, envelope in groups:
        first.append(len(ramps))
        count.append(len(envelope) if envelope else -1)
        ramps += [(ramp.start, ramp.end, ramp.delta) for ramp in envelope]
    pattern = _pattern(tuple((key[0], key[1] > 0.0, tuple(terms)) for key, terms in groups.items()), tabulation)
    return pattern | {
        "law": law,
        "pattern": pattern,
        "origin": 0.0,
        "period": np.array([period for _, period, _ in groups]),
        "ramp_first": np.array(first, dtype=np.int64),
        "ramp_count": np.array(count, dtype=np.int64),
        "ramps": np.array(ramps, dtype=float).reshape(-1, 3),
        "ends": np.array(sorted({time for *ends, _ in ramps for time in ends}), dtype=float),
    }
