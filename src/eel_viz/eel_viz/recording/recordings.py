# SPDX-License-Identifier: Apache-2.0
"""The recordings of one visualiser. A stamp that goes back begins the next recording.

A reset reaches the topics one by one, in any order. So each topic has its own current recording. A recording is closed
when no topic uses it any more, and some time after the next one began: a topic's first message may come later than the
others' reset, and its time of sending decides its recording. Each new recording gets the body, the law, the goal and
the last diagnostics.
"""

import math
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Any

from eel_common.topics import SENSORS

from eel_viz.recording.destination import Delivery, Destination, LogFunction
from eel_viz.recording.loggers import Loggers

RETRY = 2.0  # s of wall time between two attempts to open a destination
WALL_TIME = 10**17  # ns: later stamps are wall time, not simulation time
MAXIMUM_RECORDINGS, MINUTE = 10, 60.0  # most new recordings in so many seconds; each takes memory, and time to close
LATE = 10  # polls after the next recording begins: until then a topic's first message may belong to the previous one
# This is at least a second of a node, not counting times when its process stands still.
RESETS, SPAN = 3, 10.0  # so many resets in so many seconds, with several publishers, are none


class Recording:
    """One recording: loggers and stream of each open destination, by its index.

    began: messages sent from then on belong to it [ns, wall time]. polls: number of polls so far.
    """

    def __init__(self, number: int, began: float) -> None:
        self.number, self.began = number, began
        self.polls = 0
        self.opened: dict[int, tuple[Loggers, Delivery]] = {}
        self.latest = 0  # ns: newest stamp

    @property
    def loggers(self) -> list[Loggers]:
        """The loggers that accept data now."""
        return [loggers for loggers, delivery in self.opened.values() if delivery.accepts_data]

    @property
    def failed(self) -> bool:
        """Whether a file can no longer be written."""
        return any(delivery.failed for _, delivery in self.opened.values())

    def drop(self, index: int) -> None:
        """Drop the stream of destination `index`, whose receiver has gone. A thread closes it, as that takes
        seconds."""
        if index in self.opened:
            _, delivery = self.opened.pop(index)
            threading.Thread(target=delivery.close, daemon=True).start()

    def poll(self) -> None:
        """Send due rows, check their delivery, and drop viewers that have gone."""
        self.polls += 1
        for index, (loggers, delivery) in list(self.opened.items()):
            if delivery.accepts_data:
                loggers.send_due()
            delivery.check()
            if delivery.disconnected:
                self.drop(index)

    def close(self) -> None:
        """Send all rows and close the streams."""
        for loggers, delivery in self.opened.values():
            if delivery.accepts_data:
                loggers.flush()
            delivery.close(self.latest * 1e-9)


class Recordings:
    """Finds the loggers for each message, and begins and closes recordings.

    `has_several_publishers(topic)`: whether more than one publisher sends on `topic`: then stamps go back and forth.

    Attributes:
        incomplete: whether part of a run is missing in a file.
    """

    def __init__(
        self,
        destinations: list[Destination],
        name: str,
        log_warning: LogFunction,
        has_several_publishers: Callable[[str], bool] = lambda topic: False,
    ) -> None:
        self._destinations, self._name, self._log_warning = destinations, name, log_warning
        self._has_several_publishers = has_several_publishers
        # topic: number of its recording, last stamp [ns], time of sending [ns, wall time]
        self._position: dict[str, tuple[int, int, float]] = {}
        self._lasting: dict[tuple[str, bool], tuple[Any, ...]] = {}  # (topic, whether of the compared run): last values
        self._resets: deque[float] = deque(maxlen=RESETS)
        self._begun: deque[float] = deque(maxlen=MAXIMUM_RECORDINGS)  # s: start times of the last recordings
        self._limit_reported = self._disorder_reported = self._sensed = False
        self._last_retry = time.monotonic()
        self.incomplete = False
        self._recordings: dict[int, Recording] = {}
        self._begin(1, -math.inf)

    def log_sample(
        self,
        topic: str,
        stamp: int,
        values: tuple[Any, ...],
        *,
        compared: str | None = None,
        new_publisher: bool = False,
        sent: float = math.inf,
    ) -> None:
        """Log the `values` of `topic` at `stamp` [ns], of this run or of one whose topics have the prefix `compared`.

        sent: time of sending [ns, wall time]; without it a topic begins with the newest recording.
        """
        known_as = topic if compared is None else f"{compared}/{topic}"
        if topic in SENSORS and compared is None and not self._sensed:
            self._sensed = True
            for index, destination in enumerate(self._destinations):
                opened = self._newest.opened.get(index)
                destination.adopt_sensors(opened[1].stream if opened else None)
        for loggers in self._loggers_for(known_as, stamp, new_publisher, sent):
            loggers.log(topic, stamp, *values, compared=compared is not None)

    def log_lasting(self, topic: str, *values: Any, stamp: int | None = None, compared: bool = False) -> None:
        """Log values that hold until they come again, in this and later recordings.

        stamp: their own [ns]; None, or a wall time: the newest stamp of the recording.
        """
        self._lasting[topic, compared] = values
        at = self._newest.latest if stamp is None or stamp >= WALL_TIME else stamp
        if topic == "body" and not compared:
            for index, destination in enumerate(self._destinations):
                opened = self._newest.opened.get(index)
                destination.adopt_body(opened[1].stream if opened else None, *values)
        for loggers in self._newest.loggers:
            loggers.log(topic, at, *values, compared=compared)

    def poll(self) -> None:
        """Send due rows, close ended recordings, check the delivery, and retry destinations that are not open."""
        self._close_before(min((number for number, *_ in self._position.values()), default=0), LATE)
        for recording in self._recordings.values():
            recording.poll()
            self.incomplete |= recording.failed
        if time.monotonic() - self._last_retry > RETRY:
            self._last_retry = time.monotonic()
            for index, destination in enumerate(self._destinations):
                if destination.disconnected():
                    for recording in self._recordings.values():
                        recording.drop(index)
            self._open_missing(self._newest)

    def close(self) -> None:
        """Close all recordings, then the destinations."""
        if not self._position and not self._lasting:
            for _, delivery in self._newest.opened.values():
                delivery.keep_older()
        try:
            self._close_before(self._newest.number + 1)
        except Exception:
            self.discard()
            raise
        for destination in self._destinations:
            self.incomplete |= destination.incomplete
            destination.close()

    def discard(self) -> None:
        """After an error: discard incomplete output."""
        for recording in self._recordings.values():
            for _, delivery in recording.opened.values():
                delivery.discard()

    def _loggers_for(self, topic: str, stamp: int, new_publisher: bool, sent: float) -> list[Loggers]:
        """The loggers for a message of `topic` with `stamp` [ns]. new_publisher: it is a new publisher's first."""
        number, last, before = self._position.get(topic, (self._at(sent), stamp, sent))
        if stamp < last or new_publisher:
            if self._is_disorder(topic):
                return []
            if number + 1 in self._recordings or self._may_begin(_reason(topic, last, stamp), (before + sent) / 2):
                number += 1
        self._position[topic] = (number, stamp, sent)
        recording = self._recordings[number]
        recording.latest = max(recording.latest, stamp)
        return recording.loggers

    def _at(self, sent: float) -> int:
        """The number of the recording for a message `sent` at this time [ns, wall time], or else the oldest."""
        begun = [number for number, recording in self._recordings.items() if recording.began <= sent]
        return max(begun, default=min(self._recordings))

    @property
    def _newest(self) -> Recording:
        return self._recordings[max(self._recordings)]

    def _may_begin(self, reason: str, began: float) -> bool:
        """Begin the next recording, unless too many have begun recently. Returns whether it began."""
        now = time.monotonic()
        if len(self._begun) == MAXIMUM_RECORDINGS and now - self._begun[0] < MINUTE:
            if not self._limit_reported:
                self._limit_reported = True
                self._log_warning(
                    f"{reason}, after {MAXIMUM_RECORDINGS} recordings within {MINUTE:g} s: what comes goes into the "
                    "present one until that is over"
                )
            return False
        self._limit_reported = False
        self._log_warning(f"{reason}: a new recording begins")
        self._begin(self._newest.number + 1, began)
        return True

    def _begin(self, number: int, began: float) -> None:
        self._begun.append(time.monotonic())
        recording = Recording(number, began)
        self._open_missing(recording)
        self._recordings[number] = recording

    def _open_missing(self, recording: Recording) -> None:
        """Open the destinations that are not open, and log the data that hold at all times."""
        for index, destination in enumerate(self._destinations):
            if index in recording.opened:
                continue
            number = recording.number
            delivery = destination.open(number, self._name if number == 1 else f"{self._name} {number}")
            if delivery is None:
                continue
            loggers = Loggers(delivery.stream, destination.settings, destination.rates, self._name)
            recording.opened[index] = loggers, delivery
            for (topic, compared), values in self._lasting.items():
                loggers.log(topic, recording.latest, *values, compared=compared)

    def _close_before(self, number: int, late: int = 0) -> None:
        """Close the recordings before `number` whose successor has been polled at least `late` times."""
        for each in [each for each in self._recordings if each < number]:
            following = self._recordings.get(each + 1)
            if following and following.polls < late:
                return
            self._recordings[each].close()
            self.incomplete |= self._recordings.pop(each).failed

    def _is_disorder(self, topic: str) -> bool:
        """Whether stamps go back because of several publishers on `topic`, not because of a reset."""
        now = time.monotonic()
        if self._position[topic][0] < self._newest.number:
            return False  # this reset has been seen on another topic
        frequent = len(self._resets) == RESETS and now - self._resets[0] < SPAN
        if frequent and self._has_several_publishers(topic):
            if not self._disorder_reported:
                self._log_warning(
                    f"stamps of {topic} go back and forth, it has more than one publisher: older ones are left out"
                )
                self._disorder_reported = True
            return True
        self._resets.append(now)
        return False


def _reason(topic: str, last: int, stamp: int) -> str:
    """The reason why a message with `stamp` [ns] begins a new recording after stamp `last` [ns]."""
    if stamp < last:
        return f"stamps of {topic} went back from {last / 1e9:g} s to {stamp / 1e9:g} s"
    return f"another node publishes {topic} from {stamp / 1e9:g} s on"
