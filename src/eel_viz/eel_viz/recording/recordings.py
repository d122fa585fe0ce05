# SPDX-License-Identifier: Apache-2.0
"""The recordings of one visualiser: a stamp that goes back begins the next recording.

A reset reaches the topics one by one, in any order. So each topic has its own current recording, and a recording is
closed once no topic uses it any more. Each new recording gets the body, the law and the last diagnostics.
"""

import threading
import time
from collections import deque
from collections.abc import Callable

import numpy as np

from eel_viz.messages import Body, Status
from eel_viz.recording.delivery import DeliveryMonitor
from eel_viz.recording.destination import Destination, LogFunction
from eel_viz.recording.loggers import Loggers

RETRY = 2.0  # s of wall time between two attempts to open a destination
WALL_TIME = 10**17  # ns: later stamps are wall time, not simulation time
MAXIMUM_RECORDINGS, MINUTE = 10, 60.0  # new recordings within so many seconds; each takes memory, and time to close
RESETS, SPAN = 3, 10.0  # so many resets within so many seconds, with several publishers: not a reset


class Recording:
    """One recording: loggers and delivery monitor of each destination that is open, by its index."""

    def __init__(self, number: int) -> None:
        self.number = number
        self.loggers: dict[int, Loggers] = {}
        self.deliveries: dict[int, DeliveryMonitor] = {}
        self.latest = 0  # ns: newest stamp

    def drop(self, index: int) -> None:
        """Drop the stream of destination `index`, whose receiver has gone. Closing it can take seconds: in a thread."""
        self.loggers.pop(index, None)
        delivery = self.deliveries.pop(index, None)
        if delivery is not None:
            threading.Thread(target=delivery.close, daemon=True).start()

    def poll(self) -> bool:
        """Send rows that are due, check their delivery, and drop viewers that have gone. Whether a file failed."""
        for index, delivery in list(self.deliveries.items()):
            if delivery.accepts_data:
                self.loggers[index].send_due()
            delivery.check()
            if delivery.disconnected:
                self.drop(index)
        return any(delivery.failed for delivery in self.deliveries.values())

    def close(self) -> None:
        """Send all rows and close the streams."""
        for index, delivery in self.deliveries.items():
            if delivery.accepts_data:
                self.loggers[index].flush()
            delivery.close(self.latest * 1e-9)
        self.loggers.clear()


class Recordings:
    """Finds the loggers for each message, and begins and closes recordings.

    `has_several_publishers(topic)`: whether more than one publisher sends on `topic`; their stamps go back and forth.

    Attributes:
        incomplete: part of a run is missing in a file.
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
        self._position: dict[str, tuple[int, int]] = {}  # topic: number of its recording, last stamp [ns]
        self._body: Body | None = None
        self._law: str | None = None
        self._course: np.ndarray | None = None  # (n, 3) m, way points
        self._compared: dict[str, tuple] = {}  # method of the compared run's loggers: its last arguments
        self._statuses: tuple[int, list[Status]] = (0, [])
        self._resets: deque[float] = deque(maxlen=RESETS)
        self._begun: deque[float] = deque(maxlen=MAXIMUM_RECORDINGS)  # s: when each of the last recordings began
        self._limit_reported = False
        self._last_retry = time.monotonic()
        self._disorder_reported = False
        self.incomplete = False
        self._recordings: dict[int, Recording] = {}
        self._begin(1)

    @property
    def latest(self) -> int:
        """Newest stamp of the newest recording [ns]."""
        return self._newest.latest

    def loggers_for(self, topic: str, stamp: int, *, new_publisher: bool = False) -> list[Loggers]:
        """The loggers for a message of `topic` with `stamp` [ns]; `new_publisher`: its first from another publisher."""
        number, last = self._position.get(topic, (self._newest.number, stamp))
        continues = stamp >= last and not new_publisher
        if not continues:
            if self._is_disorder(topic):
                return []
            if number + 1 in self._recordings or self._may_begin(_reason(topic, last, stamp)):
                number += 1
            else:
                continues = True
        self._position[topic] = (number, stamp)
        if not continues:
            self._close_before(min(oldest for oldest, _ in self._position.values()))
        recording = self._recordings[number]
        recording.latest = max(recording.latest, stamp)
        return [loggers for index, loggers in recording.loggers.items() if recording.deliveries[index].accepts_data]

    def body(self, body: Body) -> None:
        """Log the body, now and in later recordings."""
        self._body = body
        for loggers in self._newest.loggers.values():
            loggers.body(body)

    def law(self, name: str) -> None:
        """Log the name of the newest law, now and in later recordings."""
        self._law = name
        for loggers in self._newest.loggers.values():
            loggers.law(self.latest, name)

    def course(self, points: np.ndarray) -> None:
        """Log the way points (n, 3) [m] of a goal, now and in later recordings; it may have none."""
        self._course = points
        for loggers in self._newest.loggers.values():
            loggers.course(points)

    def diagnostics(self, stamp: int, statuses: list[Status]) -> None:
        """Log statuses at `stamp` [ns], or at the newest stamp if theirs is wall time."""
        self._statuses = (stamp if stamp < WALL_TIME else self.latest, statuses)
        for loggers in self._newest.loggers.values():
            loggers.diagnostics(*self._statuses)

    def log_compared(self, method: str, *values) -> None:
        """Call `method` of the compared run's loggers with `values`, now and in later recordings."""
        self._compared[method] = values
        for loggers in self._newest.loggers.values():
            getattr(loggers.other, method)(*values)

    def poll(self) -> None:
        """Send rows that are due, check their delivery, and retry destinations that were not open."""
        for recording in self._recordings.values():
            self.incomplete |= recording.poll()
        if time.monotonic() - self._last_retry > RETRY:
            self._last_retry = time.monotonic()
            for index, destination in enumerate(self._destinations):
                if destination.disconnected():
                    for recording in self._recordings.values():
                        recording.drop(index)
            self._open_missing(self._newest)

    def close(self) -> None:
        """Close all recordings, then the destinations."""
        for recording in self._recordings.values():
            recording.close()
            self.incomplete |= any(delivery.failed for delivery in recording.deliveries.values())
        self._recordings.clear()
        for destination in self._destinations:
            self.incomplete |= destination.incomplete
            destination.close()

    @property
    def _newest(self) -> Recording:
        return self._recordings[max(self._recordings)]

    def _may_begin(self, reason: str) -> bool:
        """Begin the next recording, unless too many have begun recently; whether it began."""
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
        self._begin(self._newest.number + 1)
        return True

    def _begin(self, number: int) -> None:
        self._begun.append(time.monotonic())
        recording = Recording(number)
        self._open_missing(recording)
        self._recordings[number] = recording

    def _open_missing(self, recording: Recording) -> None:
        """Open the destinations that are not open, and log what is valid at all times."""
        for index, destination in enumerate(self._destinations):
            if index in recording.loggers:
                continue
            number = recording.number
            stream = destination.open(number, self._name if number == 1 else f"{self._name} {number}")
            if stream is None:
                continue
            loggers = Loggers(stream, destination.settings, destination.rates, self._name)
            recording.deliveries[index] = DeliveryMonitor(stream, destination, destination.file(number))
            recording.loggers[index] = loggers
            if self._body is not None:
                loggers.body(self._body)
            if self._law is not None:
                loggers.law(recording.latest, self._law)
            if self._course is not None:
                loggers.course(self._course)
            loggers.diagnostics(recording.latest, self._statuses[1])
            for method, values in self._compared.items():
                getattr(loggers.other, method)(*values)

    def _close_before(self, number: int) -> None:
        for each in [each for each in self._recordings if each < number]:
            self._recordings.pop(each).close()

    def _is_disorder(self, topic: str) -> bool:
        """Whether stamps go back because several publishers send on `topic`, not because of a reset."""
        now = time.monotonic()
        if self._position[topic][0] < self._newest.number:
            return False  # another topic has seen this reset already
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
    """Why a message with `stamp` [ns] begins a new recording after the one with stamp `last` [ns]."""
    if stamp < last:
        return f"stamps of {topic} went back from {last / 1e9:g} s to {stamp / 1e9:g} s"
    return f"another node publishes {topic} from {stamp / 1e9:g} s on"


class ComparedRecordings:
    """The same `recordings`, for messages of the compared swimmer in `namespace`."""

    def __init__(self, recordings: Recordings, namespace: str) -> None:
        self._recordings, self._namespace = recordings, namespace

    def loggers_for(self, topic: str, stamp: int, *, new_publisher: bool = False) -> list:
        """As `Recordings.loggers_for`, but those of the compared run."""
        name = f"{self._namespace}/{topic}"
        return [loggers.other for loggers in self._recordings.loggers_for(name, stamp, new_publisher=new_publisher)]

    def body(self, body: Body) -> None:
        """As `Recordings.body`."""
        self._recordings.log_compared("body", body)

    def law(self, name: str) -> None:
        """As `Recordings.law`."""
        self._recordings.log_compared("law", 0, name)

    def course(self, points: np.ndarray) -> None:
        """Do nothing: the course of the first swimmer is shown."""

    def diagnostics(self, stamp: int, statuses: list[Status]) -> None:
        """As `Recordings.diagnostics`."""
        self._recordings.log_compared("diagnostics", stamp if stamp < WALL_TIME else self._recordings.latest, statuses)

    def poll(self) -> None:
        """Do nothing: `Recordings` polls."""

    def close(self) -> None:
        """Do nothing: `Recordings` closes."""
