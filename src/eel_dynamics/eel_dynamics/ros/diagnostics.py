# SPDX-License-Identifier: Apache-2.0
"""The node's log: a condition is logged once, and shown in /diagnostics while it lasts."""

import math
import time
from collections.abc import Callable
from typing import Protocol

OK, WARN, ERROR = 0, 1, 2  # levels of diagnostic_msgs/DiagnosticStatus
REPEAT = 1.0  # s: an event of one kind is logged at most once in this time
RECENT = 2.0  # s: how long an event is shown in the diagnostics
BURST = 20  # lines of one kind with different texts that are logged in that time


class Logger(Protocol):
    """One of rclpy."""

    def info(self, message: str) -> object: ...

    def warning(self, message: str) -> object: ...

    def error(self, message: str) -> object: ...


class Report:
    """Logs conditions and events to `logger`. Safe to use from several threads."""

    def __init__(self, logger: Logger, now: Callable[[], float] = time.monotonic) -> None:
        self._logger, self._now = logger, now
        self._lasting: dict[str, tuple[int, str]] = {}  # level and text by kind
        self._events: dict[str, tuple[int, str, float, float]] = {}  # likewise, time last logged, time last seen
        self._quotas: dict[str, Quota] = {}  # by kind

    def info(self, text: str) -> None:
        """Log a normal event."""
        self._logger.info(text)

    def note(self, kind: str, text: str) -> None:
        """Log a normal event; at most `BURST` lines a second of one kind."""
        if self._quota(kind).allows(self._now()):
            self.info(text + self._quota(kind).left_out())

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
        """Whether the condition has begun and has not ended."""
        return kind in self._lasting

    def event(self, kind: str, text: str, level: int = WARN, differing: bool = False) -> None:
        """Log an event; at most one a second of one kind, or with `differing` up to `BURST` different texts."""
        now = self._now()
        _, last, logged, _ = self._events.get(kind, (OK, "", -math.inf, 0.0))
        if differing:
            repeated = text == last and now - logged < REPEAT
            if not repeated and self._quota(kind).allows(now):
                self._log(level, text + self._quota(kind).left_out())
                logged = now
        elif now - logged >= REPEAT:
            self._log(level, text)
            logged = now
        self._events[kind] = (level, text, logged, now)

    def state(self) -> tuple[int, list[str]]:
        """Present level and texts, the most severe first."""
        now = self._now()
        recent = [(level, text) for level, text, _, seen in list(self._events.values()) if now - seen < RECENT]
        present = sorted([*list(self._lasting.values()), *recent], key=lambda entry: -entry[0])
        return max((level for level, _ in present), default=OK), [text for _, text in present]

    def _quota(self, kind: str) -> "Quota":
        return self._quotas.setdefault(kind, Quota())

    def _log(self, level: int, text: str) -> None:
        # Two statements: rclpy's loggers tell calls apart by their line.
        if level == ERROR:
            self._logger.error(text)
        else:
            self._logger.warning(text)


class Quota:
    """Rate limit: `BURST` lines in `REPEAT` seconds."""

    def __init__(self) -> None:
        self._begin = -math.inf  # s
        self._lines = self._refused = 0

    def allows(self, now: float) -> bool:
        """Whether one more line may be logged `now` [s]."""
        if now - self._begin >= REPEAT:
            self._begin, self._lines = now, 0
        allowed = self._lines < BURST
        self._lines += allowed
        self._refused += not allowed
        return allowed

    def left_out(self) -> str:
        """Text with the number of lines left out since the last call; empty if there were none."""
        count, self._refused = self._refused, 0
        return f" (and {count} more before, not shown)" if count else ""
