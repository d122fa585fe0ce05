# SPDX-License-Identifier: Apache-2.0
"""Decides which of several dynamics nodes publishes a swimmer: of those with the same topics, the one that began first.

Each node gives its identity in /diagnostics: topic, start, host, process. So the nodes decide alike as soon as they
have received each other's. The later one waits until the earlier one has gone. /clock, which has publishers of other
kinds too, has its own rule (clock_arbiter.py).
"""

import os
import socket
import time
from collections.abc import Callable, Mapping
from datetime import UTC, datetime
from typing import NamedTuple

from eel_dynamics.ros.diagnostics import ERROR

GONE = 5.0  # s without diagnostics from a node, after which it counts as gone; they come once a second


class Identity(NamedTuple):
    """A dynamics node; the lesser of two began first."""

    started: str  # UTC, ISO 8601
    host: str
    process: str

    @staticmethod
    def own() -> "Identity":
        """That of this process, started now."""
        return Identity(datetime.now(UTC).isoformat(), socket.gethostname(), str(os.getpid()))


class SwimmerArbiter:
    """Compares this node with the others that publish `topic`; `waits`: another one was first.

    hold(reason): is called with a text when the run is to wait, with an empty one when it may continue.
    """

    def __init__(self, own: Identity, topic: str, report, hold: Callable[[str], None], now=time.monotonic):
        self._own, self._topic, self._report, self._hold, self._now = own, topic, report, hold, now
        self._others: dict[Identity, tuple[str, float]] = {}  # name of the node, and when it was last received [s]
        self.waits = False

    def values(self) -> dict[str, str]:
        """The identity for /diagnostics."""
        return {"swimmer": self._topic, **self._own._asdict()}

    def receive(self, name: str, values: Mapping[str, str]):
        """Take a status in /diagnostics: the `name` of its node, and its values."""
        if values.get("swimmer") == self._topic and all(field in values for field in Identity._fields):
            identity = Identity(*(values[field] for field in Identity._fields))
            if identity != self._own:
                self._others[identity] = name, self._now()

    def look(self):
        """Decide again; call this a few times a second."""
        self._others = {each: seen for each, seen in self._others.items() if self._now() - seen[1] < GONE}
        first = min((self._own, *self._others))
        waits, text = first != self._own, ""
        if waits:
            text = f"{self._described(first)} publishes {self._topic} already: this node waits until it has gone"
        elif self._others:
            second = self._described(min(self._others))
            text = f"{second} is to publish {self._topic} too: it waits until this node has gone"
        if text:
            self._report.begin("swimmer", text, ERROR)
        else:
            self._report.end("swimmer", f"no other node publishes {self._topic} any more")
        if self.waits != waits:
            self.waits = waits
            self._hold(f"waiting until {self._others[first][0]} has gone" if waits else "")

    def _described(self, other: Identity) -> str:
        name, _ = self._others[other]
        return f"{name} (host {other.host}, process {other.process}, started {other.started})"
