"""Messages of one swimmer into recordings, wherever they come from: the network, a bag, a run of the library.

A message is any object with the fields of its type. What cannot be shown is said once and left out.
"""

import time
from collections import Counter
from collections.abc import Callable

from eel_viz import messages
from eel_viz.messages import BadMessage, stamp_of
from eel_viz.recording.destination import Say
from eel_viz.recording.runs import Runs

COARSE = 4  # stations, below which a backbone says little about the shape
BODY_LIMIT = 2.0  # s after the first backbone in which the body should have come

SAMPLES: dict[str, Callable] = {  # topic, and method of `Loggers`: what the method is given besides the stamp
    "head_pose": lambda message: [messages.read_pose(message.pose)],
    "head_twist": lambda message: [messages.read_twist(message.twist)],
    "odom": lambda message: [messages.read_pose(message.pose.pose), messages.read_twist(message.twist.twist)],
    "backbone": lambda message: [messages.read_backbone(message)],
    "curvature": lambda message: [messages.read_curvature(message)],
    "internal_wrench": lambda message: [messages.read_wrench(message)],
    "hydrodynamic_load": lambda message: [messages.read_load(message)],
    "energy": lambda message: [messages.read_energy(message)],
}


class Intake:
    """Hands each message to the loggers of its run, checked.

    `namespace`: the swimmer's, whose nodes' diagnostics are taken; `warn`: one line to the user.
    """

    def __init__(self, runs: Runs, *, namespace: str, warn: Say) -> None:
        self._runs, self._warn = runs, warn
        self._space = namespace.rstrip("/")
        self.received: Counter[str] = Counter()
        self._complaints: set = set()
        self._stations: dict[str, int] = {}  # of each topic, how many
        self._first_backbone: float | None = None  # s
        self._last_law = None
        self._others = {"body": self._body, "curvature_law": self._law, "diagnostics": self._diagnostics}

    @property
    def topics(self) -> tuple[str, ...]:
        """All that `take` knows."""
        return (*SAMPLES, *self._others)

    def take(self, topic: str, message, *, successor: bool = False) -> None:
        """One message of `topic`, a name in `topics`; `successor`: the first one of another publisher."""
        self.received[topic] += 1
        try:
            if topic in SAMPLES:
                self._sample(topic, message, successor)
            else:
                self._others[topic](message)
        except BadMessage as problem:
            self._warn_once((topic, problem.field), f"{topic}: {problem}: left out, and those like it")

    def attend(self) -> None:
        """Now and then: look after the sinks, and whether the body has come in time."""
        self._runs.attend()
        if self._first_backbone is not None and time.monotonic() - self._first_backbone > BODY_LIMIT:
            self._miss_body()

    def close(self) -> str:
        """Complete the recordings; returns in words what came."""
        if self._first_backbone is not None:
            self._miss_body()
        self._runs.close()
        return ", ".join(f"{topic} {count}" for topic, count in self.received.items()) or "nothing"

    def _sample(self, topic: str, message, successor: bool) -> None:
        try:
            stamp, values = stamp_of(message), SAMPLES[topic](message)
        except AttributeError as error:  # from a bag of long ago
            raise BadMessage("type", f"is another version's: {error}") from error
        if hasattr(message, "x"):
            self._watch_stations(topic, len(message.x))
        for loggers in self._runs.at(topic, stamp, successor=successor):
            getattr(loggers, topic)(stamp, *values)

    def _watch_stations(self, topic: str, count: int) -> None:
        if self._stations.setdefault(topic, count) != count:
            text = (
                f"{topic} has {count} stations and had {self._stations[topic]}: it is drawn, its envelope begins anew"
            )
            self._warn_once((topic, "stations"), text)
            self._stations[topic] = count
        if topic == "backbone":
            self._first_backbone = self._first_backbone or time.monotonic()
            if count < COARSE:
                self._warn_once("coarse", f"backbone has {count} stations: the shape between them is a guess")

    def _body(self, message) -> None:
        self._runs.body(messages.read_body(message))

    def _law(self, message) -> None:
        if message != self._last_law:  # the same law published again is no news
            self._last_law = message
            self._runs.law(message.name)

    def _diagnostics(self, message) -> None:
        statuses = [each for each in messages.read_diagnostics(message) if each.name.rpartition("/")[0] == self._space]
        if statuses:
            self._runs.diagnostics(stamp_of(message), statuses)

    def _miss_body(self) -> None:
        if not self.received["body"]:
            self._warn_once("no body", "no body has come: the backbone is drawn as a line, without skin")

    def _warn_once(self, fault, text: str) -> None:
        if fault not in self._complaints:
            self._complaints.add(fault)
            self._warn(text)
