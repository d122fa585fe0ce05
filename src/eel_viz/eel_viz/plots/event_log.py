# SPDX-License-Identifier: Apache-2.0
"""The log of a run: laws that were published, and statuses that changed."""

import reprlib

import rerun as rr

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.messages import Status

SHORT = reprlib.Repr()
SHORT.maxstring = 220  # characters of a law's name, which is not checked before
LEVELS = ("INFO", "WARN", "ERROR", "WARN")  # of a DiagnosticStatus: OK, WARN, ERROR, STALE


class EventLog:
    """Writes events as lines of text with a level."""

    def __init__(self, stream: BatchedStream) -> None:
        self._stream = stream
        self._statuses: dict[str, tuple[int, str]] = {}  # level and message, by name

    def law(self, stamp: int, name: str) -> None:
        """A law of this `name` was published at `stamp` [ns]."""
        self._write(stamp, f"law {SHORT.repr(name)} published", "INFO")

    def status(self, stamp: int, status: Status) -> None:
        """Write the `status` at `stamp` [ns] where its level or its message has changed."""
        if self._statuses.get(status.name) != (status.level, status.message):
            self._statuses[status.name] = (status.level, status.message)
            self._write(stamp, f"{status.name}: {status.message}", LEVELS[min(status.level, 3)])

    def _write(self, stamp: int, text: str, level: str) -> None:
        self._stream.log(stamp, entities.LOG, rr.TextLog(text, level=level))
