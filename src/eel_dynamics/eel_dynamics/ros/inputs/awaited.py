# SPDX-License-Identifier: Apache-2.0
"""Which inputs a run as fast as possible (real_time_factor 0) waits for, and which messages were sent before a reset.

One rule holds for curvature samples, commands of joints and fins, currents and external wrenches. Each message acts at
its stamp. The next message for the same joint or fin is due one period later. That period is given in `wait_for`, or is
the longest of the last three intervals between stamps, at first the sample period. The run advances to its next sample
once no message is due before it. So a run is reproducible, however fast the other nodes are.

At the start, and after a reset, the first message of each input is due at once; with a given period it is due after one
period, as a timer sends it. Before its start the run also waits for publishers of the topics in `wait_for`.

`wait_for` names the awaited inputs. Without it they are the inputs that have sent a message with a stamp. An input that
is not there within the timeout is no longer awaited, until its next message comes.
"""

import math
import time as wall
from collections import deque
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field

from eel_common.quantity import checked_choice, is_finite
from eel_common.ros.loop.diagnostics import Report
from eel_common.wording import shown

LAW, SAMPLES, JOINTS, FINS, CURRENT = "curvature_law", "curvature_samples", "joint_commands", "fin_command", "current"
WRENCH = "external_wrench"
INPUTS = (LAW, SAMPLES, JOINTS, FINS, CURRENT, WRENCH)
MESSAGES = {LAW: "law", SAMPLES: "curvature sample", JOINTS: "joint command", FINS: "fin command", CURRENT: "current"}
MESSAGES |= {WRENCH: "external wrench"}
ALL = ""  # in place of a name of a joint or fin: the whole topic
ECHO = 5.0  # s after a reset, in which messages that were sent before it may arrive
SETTLING = 0.5  # s of wall time at the start, in which timers of other nodes see the clock at 0 and begin their periods
EQUAL = 1e-9  # s: closer times count as equal
INTERVALS = 3  # the longest of the last ones counts, because those of a timer vary by a sample
MOST_NAMED = 5  # names in a text


@dataclass
class Source:
    """The messages for a joint, a fin, or a whole topic. Times are simulation times [s].

    period: between messages, if it is given. due: time of the next message; -inf: at once; inf: none is awaited.
    stamp: of the newest message; NaN before the first. intervals: the last ones between stamps.
    """

    period: float | None = None
    due: float = math.inf
    stamp: float = math.nan
    intervals: deque[float] = field(default_factory=lambda: deque(maxlen=INTERVALS))

    def come(self, stamp: float, now: float, period: float) -> None:
        """Take note of a message with this `stamp`, received at the time `now` of a run with this sample `period`."""
        if stamp <= self.stamp:
            return
        if not math.isnan(self.stamp):
            self.intervals.append(stamp - self.stamp)
        self.stamp = stamp
        given = self.period if self.period is not None else max(self.intervals, default=period)
        self.due = max(stamp, now) + given


class Awaited:
    """The inputs that a run waits for.

    Attributes:
        period: [s], between samples of the run.
        offered: topics that have a publisher; None: not known.
    """

    def __init__(self, report: Report) -> None:
        self._report, self.period = report, 0.0
        self.offered: set[str] | None = None
        self._wanted: dict[tuple[str, str], float | None] = {}  # periods by topic and name
        self._sources: dict[tuple[str, str], Source] = {}
        self._farthest: dict[str, float] = {}  # by topic: s, greatest distance of a message ahead of the simulation
        self._begun = self._reset_at = -math.inf  # s, steady clock
        self._late_since = math.inf  # s, steady clock

    def begin(self, wait_for: Iterable[str], parts: Mapping[str, tuple[str, ...]], period: float) -> None:
        """Begin at time 0. Inputs that were awaited before are awaited again.

        wait_for, parts: as for `wanted_inputs`, which raises `ValueError` for an invalid entry. period [s]: between
        samples. A law is kept over a reset, and not awaited again.
        """
        wanted, known = wanted_inputs(wait_for, parts), self._sources
        self._wanted, self.period, self._late_since = wanted, period, math.inf
        self._sources = {}
        for key in wanted:
            if key[0] != LAW or LAW not in self._farthest:
                self._add_source(*key, awaited=True)
        for (topic, name), source in known.items():
            if source.due < math.inf and name in (ALL, *parts.get(topic, ())) and self._awaits(topic):
                self._add_source(topic, name, awaited=True).intervals = source.intervals
        for topic, name in list(self._sources):
            if name != ALL:
                self._sources.pop((topic, ALL), None)
        self._begun = wall.monotonic()
        self._reset_at = self._begun if self._farthest else -math.inf
        for topic in INPUTS:
            self._report.end(_kind(topic))

    def come(self, topic: str, stamp: float, now: float, names: Collection[str] = (ALL,)) -> None:
        """Take note of a message with this `stamp` [s] for joints or fins with these `names`. now: time [s]."""
        self._farthest[topic] = max(self._farthest.get(topic, 0.0), stamp - now)
        self._report.end(_kind(topic), f"{MESSAGES[topic]}s are back at t = {now:g} s")
        if topic == LAW:
            self._sources.pop((LAW, ALL), None)
        elif self._awaits(topic):
            for name in names:
                (self._sources.get((topic, name)) or self._add_source(topic, name)).come(stamp, now, self.period)
            if names and ALL not in names:
                self._sources.pop((topic, ALL), None)

    def names(self, topic: str) -> bool:
        """Whether `wait_for` names the `topic`."""
        return any(topic == each for each, _ in self._wanted)

    def _awaits(self, topic: str) -> bool:
        return not self._wanted or self.names(topic)

    def _add_source(self, topic: str, name: str, awaited: bool = False) -> Source:
        """Add a source without messages so far. awaited: whether its first message is."""
        period = self._wanted.get((topic, name), self._wanted.get((topic, ALL)))
        first = math.inf if not awaited else -math.inf if period is None else period
        source = Source(0.0 if topic == SAMPLES else period, first)
        self._sources[topic, name] = source
        return source

    def end(self, topic: str) -> None:
        """Stop waiting for the `topic` until its next message, except for a first message that `wait_for` asks for."""
        for key, source in self._sources.items():
            if key[0] == topic and not (key in self._wanted and math.isnan(source.stamp)):
                source.due = math.inf

    def counts_as_stamped(self, topic: str, names: Iterable[str]) -> bool:
        """Whether a stamp of 0 means t = 0, not an empty stamp: because messages for these `names` are awaited."""
        return any(self._sources.get((topic, name), Source()).due < math.inf for name in names)

    def is_echo(self, topic: str, ahead: float) -> bool:
        """Whether a message that lies `ahead` [s] of the simulation was sent before the reset: no other lay so far."""
        farthest = self._farthest.get(topic, math.inf) + 0.5 * self.period
        return ahead > farthest and wall.monotonic() < self._reset_at + ECHO

    def late(self, instant: float) -> list[str]:
        """The inputs that must arrive before the sample of `instant` [s]: topics, with names of joints or fins."""
        return [_text(topic, names) for topic, names in self._late(instant).items()]

    def missing(self, instant: float, now: float, timeout: float) -> list[str]:
        """As `late`, but empty, with a warning, once `timeout` [s] have passed. now: [s, steady clock]."""
        late = self._late(instant)
        if not late:
            self._late_since = math.inf
            return []
        self._late_since = now if self._is_starting(instant) else min(self._late_since, now)
        if now - self._late_since < timeout:
            return [_text(topic, names) for topic, names in late.items()]
        self._late_since = math.inf
        for topic, names in late.items():
            self._report_late(topic, names, instant, timeout)
            for name in names:
                self._sources[topic, name].due = math.inf
        return []

    def _is_starting(self, instant: float) -> bool:
        """Whether publishers of topics in `wait_for` are still missing, or timers must still see the clock at 0."""
        wanted = {topic for topic, _ in self._wanted}
        if self._reset_at == -math.inf and self.offered is not None and not wanted <= self.offered:
            self._begun = wall.monotonic()
        return instant == 0.0 and wall.monotonic() < self._begun + SETTLING

    def _late(self, instant: float) -> dict[str, list[str]]:
        """Names by topic; `ALL` stands for the whole topic."""
        late: dict[str, list[str]] = {}
        starting = self._is_starting(instant)
        for (topic, name), source in self._sources.items():
            is_timer = source.due == source.period and source.period > 0.0  # without a message so far
            if source.due < instant - EQUAL or (starting and is_timer):
                late.setdefault(topic, []).append(name)
        return late

    def _report_late(self, topic: str, names: list[str], instant: float, timeout: float) -> None:
        """Report that messages due before the sample of `instant` [s] have not arrived for `timeout` [s]."""
        newest = max((self._sources[topic, name].stamp for name in names), default=math.nan)
        whose = "" if names == [ALL] else f" for {_listed(names)}"
        if math.isnan(newest):
            text = f"no {MESSAGES[topic]}{whose} at the start within {timeout:g} s: the run begins without"
        elif topic != SAMPLES:
            text = (
                f"no {MESSAGES[topic]}{whose} for {timeout:g} s of wall time before t = {instant:.9g} s, the newest is "
                f"of t = {newest:.9g} s: it holds, and the run does not wait until they are back"
            )
        else:
            self._report.event(
                "missing samples",
                f"no curvature sample for t >= {instant:.9g} s within {timeout:g} s, the newest is for t = "
                f"{newest:.9g} s: at real_time_factor 0 a controller's samples must lie at least 1/rate = "
                f"{self.period:.9g} s ahead of the simulation",
            )
            return
        self._report.begin(_kind(topic), text)


def wanted_inputs(wait_for: Iterable[str], parts: Mapping[str, tuple[str, ...]]) -> dict[tuple[str, str], float | None]:
    """Topic and name of each input in `wait_for`, with its period [s] or None. `ValueError` for an invalid entry.

    An entry is TOPIC, or TOPIC/NAME for one joint or fin; a space and a period [s] may follow. parts: names of joints
    and fins by topic.
    """
    wanted: dict[tuple[str, str], float | None] = {}
    for text in filter(None, wait_for):
        word, _, number = text.partition(" ")
        topic, slash, name = word.partition("/")
        checked_choice("wait_for", topic, INPUTS)
        if topic in (JOINTS, FINS) and not parts.get(topic):
            raise ValueError(f"wait_for must name inputs that there are, got {topic}: nothing follows it")
        if slash and not parts.get(topic):
            raise ValueError(f"wait_for {topic} has no names, got {shown(name)}")
        if slash:
            checked_choice(f"wait_for {topic}/", name, parts[topic])
        try:
            period = float(number) if number else None
        except ValueError:
            period = math.nan
        if period is not None and not (is_finite(period) and period > 0.0):
            raise ValueError(f"wait_for must have a period > 0 s behind {word}, got {shown(number)}")
        wanted[topic, name] = period
    return wanted


def _kind(topic: str) -> str:
    return f"no {topic}"


def _text(topic: str, names: list[str]) -> str:
    return topic if ALL in names else f"{topic} ({_listed(names)})"


def _listed(names: list[str]) -> str:
    return ", ".join(names[:MOST_NAMED]) + (" ..." if len(names) > MOST_NAMED else "")
