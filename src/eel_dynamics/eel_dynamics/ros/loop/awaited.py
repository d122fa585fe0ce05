# SPDX-License-Identifier: Apache-2.0
"""Which messages a run as fast as possible (real_time_factor 0) waits for, and which were sent before a reset.

Whoever answers samples with stamped messages is waited for, so that a run is the same each time. The next message for
a joint, a fin or a current is awaited one interval after the last: its publisher may be slower than the samples. After
a reset what came before is awaited from the start on, before sample 1. What does not come in time is not awaited until
it is back. Nor are messages without a stamp, but at the start, where it is 0.
"""

import math
import time as wall
from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from eel_ros.loop.diagnostics import Report

ECHO = 5.0  # s after a reset, within which messages that were sent before it may come
ALIKE = 1e-9  # s: times that are closer are one
INTERVALS = 3  # of which the longest counts: a timer's vary by a sample
MOST_SOURCES, MOST_NAMED = 100, 5


class Echo:
    """Tells messages that were sent before a reset: they lie much further ahead of the simulation than others did."""

    def __init__(self) -> None:
        self._farthest = -math.inf  # s by which a message lay ahead
        self._until = -math.inf  # s, steady clock

    def holds(self, ahead: float) -> bool:
        """Whether a message that lies `ahead` [s] of the simulation is one."""
        return ahead > 2.0 * max(0.0, self._farthest) + ALIKE and wall.monotonic() < self._until

    def take(self, ahead: float) -> None:
        """A message has been taken that lies so far `ahead` [s] of the simulation."""
        self._farthest = max(self._farthest, ahead)

    def reset(self) -> None:
        """The run begins again."""
        if self._farthest > -math.inf:
            self._until = wall.monotonic() + ECHO


@dataclass
class Source:
    """What is known of the messages for some joints or fins. All times are simulation time [s].

    due: of the sample from which on the next message is awaited; infinite: it is not. last: sample that the last
    message answers; NaN: none has come. lead: by which messages lie ahead of the sample that they answer. intervals:
    between the last few.
    """

    due: float = math.inf
    last: float = math.nan
    lead: float = 0.0
    intervals: deque[float] = field(default_factory=lambda: deque(maxlen=INTERVALS))

    def come(self, stamp: float, time: float) -> None:
        """A message with this `stamp` has come at simulation time `time`."""
        self.lead = max(self.lead, stamp - time)
        answered = stamp - self.lead
        if answered <= self.last:
            return
        if answered > self.last:
            self.intervals.append(answered - self.last)
        self.last, self.due = answered, answered + max(self.intervals, default=2.0 * ALIKE)


class Awaited:
    """The messages of a `topic` that are awaited, by the joints or fins that they are for; `what`: one is called."""

    def __init__(self, topic: str, what: str, report: Report) -> None:
        self.topic, self._what, self._report = topic, what, report
        self._sources: dict[tuple[str, ...], Source] = {}
        self._missing_since = math.inf  # s, steady clock

    def come(self, names: tuple[str, ...], stamp: float, time: float) -> None:
        """A message for these `names` with this `stamp` [s] has come, at simulation time `time` [s]."""
        self._report.end(self._kind, f"{self._what}s are back at t = {time:g} s")
        if (stamp > 0.0 or time == 0.0) and (names in self._sources or len(self._sources) < MOST_SOURCES):
            self._sources.setdefault(names, Source()).come(stamp, time)

    def late(self, time: float) -> list[tuple[str, ...]]:
        """The names of the messages that are missing at the sample of `time` [s]."""
        return [names for names, source in self._sources.items() if source.due <= time + ALIKE]

    def waits(self, time: float, now: float, timeout: float) -> bool:
        """Whether to wait for messages at the sample of `time` [s], for `timeout` [s] at most; a wait in vain is told.

        now: [s, steady clock].
        """
        late = self.late(time)
        if not late:
            self._missing_since = math.inf
            return False
        self._missing_since = min(self._missing_since, now)
        if now - self._missing_since < timeout:
            return True
        self._missing_since = math.inf
        for names in late:
            self._sources[names].due = math.inf
        self.miss(timeout, "of wall time", time, late if len(late) < len(self._sources) else [])
        return False

    def miss(self, timeout: float, kind: str, time: float, late: Sequence[tuple[str, ...]] = ()) -> None:
        """Tell that no message has come for `timeout` [s], at simulation time `time` [s]; late: whose, if not all's."""
        names = dict.fromkeys(name for each in late for name in each)
        listed = ", ".join([*names][:MOST_NAMED]) + (" ..." if len(names) > MOST_NAMED else "")
        whose = f" for {listed}" if names else ""
        text = f"no {self._what}{whose} for {timeout:g} s {kind} at t = {time:g} s: the last one holds"
        self._report.begin(self._kind, text)

    def reset(self, known: Iterable[str]) -> None:
        """The run begins again, with these names: what was awaited is awaited from the start on."""
        self._sources = {names: each for names, each in self._sources.items() if {*names} <= {*known}}
        for source in self._sources.values():
            source.last, source.due = math.nan, 0.0 if source.due < math.inf else math.inf
        self._missing_since = math.inf
        self._report.end(self._kind)

    @property
    def _kind(self) -> str:
        return f"no {self.topic}"
