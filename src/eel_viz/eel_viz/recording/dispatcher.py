# SPDX-License-Identifier: Apache-2.0
"""Dispatches one swimmer's messages to the loggers, from any source: the network, a bag, a run of the library.

While a run stands at its start, the dynamics node repeats sample 0. So a sample of stamp 0 is held back until the next
one of its topic comes; of several only the last is logged and counted. The size of drawings comes from the body, whose
message may come after the first samples. Until it comes, these and later messages wait, for a limited time.
A message is any object with the fields of its type. A message that cannot be shown is reported once and left out.
"""

import math
import time
from collections import Counter, deque
from collections.abc import Callable, Hashable
from operator import attrgetter
from typing import Any

from eel_common.topics import SAMPLED

from eel_viz import message_readers as readers
from eel_viz.messages import BadMessage
from eel_viz.recording.destination import LogFunction
from eel_viz.recording.recordings import Recordings

COARSE = 4  # stations: fewer say little about the shape
BODY_LIMIT = 2.0  # s after the first sample: the body must have come by then
MOST_WAITING = 3000  # most messages that wait for the body

READERS: dict[str, Callable[[Any], Any]] = {  # topic: from a message to the loggers' arguments
    "body": readers.read_body,
    "curvature_law": attrgetter("name"),
    "goal": readers.read_path,
    "head_pose": lambda message: readers.read_pose(message.pose),
    "head_twist": lambda message: readers.read_twist(message.twist),
    "odom": lambda message: (readers.read_pose(message.pose.pose), readers.read_twist(message.twist.twist)),
    "backbone": readers.read_backbone,
    "curvature": readers.read_curvature,
    "internal_wrench": readers.read_wrench,
    "hydrodynamic_load": readers.read_load,
    "flow_vectors": readers.read_flow,
    "fin_states": readers.read_joints,
    "joint_states": readers.read_joints,
    "motor_states": readers.read_motors,
    "imu": readers.read_imu,
    "pressure": readers.read_pressure,
    "depth": readers.read_depth,
    "velocity": readers.read_velocity,
    "energy": readers.read_energy,
    "diagnostics": readers.read_diagnostics,
}


class Dispatcher:
    """Checks each message and passes it to the loggers of its recording.

    namespace: the swimmer's; diagnostics of other namespaces are ignored. log_warning: writes one line to the user.
    compared: prefix of the topics of a compared swimmer; None for the swimmer that the recording shows.

    Attributes:
        received: number of messages by topic; a repeated sample 0 counts once.
    """

    def __init__(
        self, recordings: Recordings, *, namespace: str, log_warning: LogFunction, compared: str | None = None
    ) -> None:
        self._recordings, self._log_warning = recordings, log_warning
        self._namespace, self._compared = namespace.rstrip("/"), compared
        self.received: Counter[str] = Counter()
        self._reported: set[Hashable] = set()  # faults
        self._start: dict[str, tuple[Any, bool, float]] = {}  # topic: sample 0, whether from a new publisher, time sent
        self._stations: dict[str, int] = {}  # number of stations by topic
        self._first_sample: float | None = None  # s
        self._waiting: deque[tuple[str, Any, bool, float]] = deque()  # for the body; arguments of `_dispatch`

    def dispatch(self, topic: str, message: Any, *, new_publisher: bool = False, sent: float = math.inf) -> None:
        """Log one message of `topic`, a name in `READERS`.

        new_publisher: whether it is the first from a new publisher. sent: time of sending [ns, wall time], if known.
        """
        if topic in SAMPLED:
            self._first_sample = self._first_sample or time.monotonic()
        if topic == "body":
            self._dispatch(topic, message, new_publisher, sent)
        else:
            self._waiting.append((topic, message, new_publisher, sent))
        self._dispatch_waiting(MOST_WAITING if self._awaits_body() else 0)

    def _dispatch(self, topic: str, message: Any, new_publisher: bool, sent: float) -> None:
        if topic in SAMPLED and readers.is_at_start(message):
            _, before, _ = self._start.get(topic, (None, False, sent))
            self._start[topic] = message, new_publisher or before, sent
            return
        self._log_start(topic)
        self._log(topic, message, new_publisher, sent)

    def poll(self) -> None:
        """If the body is overdue, log the waiting messages, and warn."""
        if not self._awaits_body():
            self._dispatch_waiting()
            self._check_body()

    def finish(self) -> str:
        """Log held-back samples. Returns the received topics with their numbers of messages as text."""
        self._dispatch_waiting()
        for topic in list(self._start):
            self._log_start(topic)
        self._check_body()
        return ", ".join(f"{topic} {count}" for topic, count in self.received.items()) or "nothing"

    def _awaits_body(self) -> bool:
        """Whether messages wait for the body: for a while after the first sample."""
        if self.received["body"] or self._first_sample is None:
            return False
        return time.monotonic() - self._first_sample < BODY_LIMIT

    def _dispatch_waiting(self, but: int = 0) -> None:
        """Dispatch the waiting messages in order, except the newest `but`."""
        while len(self._waiting) > but:
            self._dispatch(*self._waiting.popleft())

    def _log_start(self, topic: str) -> None:
        """Log the held-back sample 0 of `topic`."""
        if topic in self._start:
            self._log(topic, *self._start.pop(topic))

    def _log(self, topic: str, message: Any, new_publisher: bool, sent: float) -> None:
        self.received[topic] += 1
        try:
            try:
                stamp: Any = readers.stamp_of(message) if topic in SAMPLED or topic == "diagnostics" else None
                value = READERS[topic](message)
            except AttributeError as error:  # from a bag of another version
                raise BadMessage("type", f"is another version's: {error}") from error
            values = value if isinstance(value, tuple) else (value,)
            if topic in SAMPLED:
                if hasattr(message, "x"):
                    self._check_stations(topic, len(message.x))
                self._recordings.log_sample(
                    topic, stamp, values, compared=self._compared, new_publisher=new_publisher, sent=sent
                )
            else:
                if topic == "diagnostics":
                    values = ([each for each in value if each.name.rpartition("/")[0] == self._namespace],)
                if topic != "diagnostics" or values[0]:
                    self._recordings.log_lasting(topic, *values, stamp=stamp, compared=self._compared is not None)
        except BadMessage as problem:
            self._warn_once((topic, problem.field), f"{topic}: {problem}: left out, and those like it")

    def _check_stations(self, topic: str, count: int) -> None:
        before = self._stations.setdefault(topic, count)
        if before != count:
            text = f"{topic} has {count} stations and had {before}: it is drawn, its envelope begins anew"
            self._warn_once((topic, "stations"), text)
            self._stations[topic] = count
        if topic == "backbone" and count < COARSE:
            self._warn_once("coarse", f"backbone has {count} stations: the shape between them is a guess")

    def _check_body(self) -> None:
        if self.received["backbone"] and not self.received["body"]:
            self._warn_once("no body", "no body has come: the backbone is drawn as a line, without skin")

    def _warn_once(self, fault: Hashable, text: str) -> None:
        if fault not in self._reported:
            self._reported.add(fault)
            self._log_warning(text)
