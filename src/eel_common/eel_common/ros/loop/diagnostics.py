# SPDX-License-Identifier: Apache-2.0
"""The node's log: a condition is logged once, and stays in /diagnostics while it lasts."""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

OK, WARN, ERROR = 0, 1, 2  # levels of diagnostic_msgs/DiagnosticStatus
REPEAT = 1.0  # s: in this time an event of one kind is logged at most once
RECENT = 2.0  # s: how long an event is shown in the diagnostics
BURST = 20  # differing lines of one kind that are logged in that time


class Logger(Protocol):
    """An rclpy logger."""

    def info(self, message: str) -> object: ...

    def warning(self, message: str) -> object: ...

    def error(self, message: str) -> object: ...


@dataclass
class Event:
    """The last event of a kind, and its number of logged lines since `begin`. Times on the steady clock."""

    level: int = OK
    text: str = ""
    told: dict[str, float] = field(default_factory=dict)  # texts that were logged, and when each came last [s]
    seen: float = -math.inf  # s
    begin: float = -math.inf  # s
    lines: int = 0
    left_out: int = 0  # lines neither logged nor counted in a later line


class Report:
    """Logs conditions and events to `logger`. Safe to use from several threads."""

    def __init__(self, logger: Logger, now: Callable[[], float] = time.monotonic) -> None:
        self._logger, self._now = logger, now
        self._lasting: dict[str, tuple[int, str]] = {}  # level and text by kind
        self._events: dict[str, Event] = {}  # by kind

    def info(self, text: str) -> None:
        """Log a normal event."""
        self._logger.info(text)

    def note(self, kind: str, text: str) -> None:
        """Log a normal event; at most `BURST` lines a second of one kind."""
        self._record(self._events.setdefault(f"note {kind}", Event()), OK, text, BURST)

    def begin(self, kind: str, text: str, level: int = WARN) -> None:
        """Begin the condition `kind`, which lasts until `end`; it is logged when it begins."""
        if kind not in self._lasting:
            self._log(level, text)
        self._lasting[kind] = (level, text)

    def end(self, kind: str, text: str = "") -> None:
        """End the condition; `text`, if any, is logged if it had begun."""
        if self._lasting.pop(kind, None) is not None and text:
            self.info(text)

    def lasts(self, kind: str) -> bool:
        """Whether the condition lasts."""
        return kind in self._lasting

    def event(self, kind: str, text: str, level: int = WARN, differing: bool = False) -> None:
        """Log an event. The same text is logged once while it repeats within a second, also among others.

        Differing texts of one kind are logged once a second, or with `differing` up to `BURST` times.
        """
        event, now = self._events.setdefault(kind, Event()), self._now()
        if now - event.told.get(text, -math.inf) >= REPEAT:
            self._record(event, level, text, BURST if differing else 1)
        if text in event.told:
            event.told[text] = now
        event.level, event.text, event.seen = level, text, now

    def state(self) -> tuple[int, list[str]]:
        """Present level and texts, the most severe first."""
        since = self._now() - RECENT
        recent = [(each.level, each.text) for each in list(self._events.values()) if each.level and each.seen > since]
        present = sorted([*list(self._lasting.values()), *recent], key=lambda entry: -entry[0])
        return max((level for level, _ in present), default=OK), [text for _, text in present]

    def _record(self, event: Event, level: int, text: str, most: int) -> None:
        """Log `text`, unless `most` lines of its kind have been logged within `REPEAT`."""
        now = self._now()
        if now - event.begin >= REPEAT:
            event.begin, event.lines = now, 0
        if event.lines >= most:
            event.left_out += 1
            return
        more = f" (and {event.left_out} more before, not shown)" if event.left_out and most > 1 else ""
        event.told = {each: seen for each, seen in event.told.items() if now - seen < REPEAT} | {text: now}
        event.lines, event.left_out = event.lines + 1, 0
        self._log(level, text + more)

    def _log(self, level: int, text: str) -> None:
        # Separate statements: rclpy's loggers tell calls apart by their line.
        if level == ERROR:
            self._logger.error(text)
        elif level == WARN:
            self._logger.warning(text)
        else:
            self._logger.info(text)
