# SPDX-License-Identifier: Apache-2.0
"""The node's log and its content of /diagnostics: a condition is logged once, and published while it lasts."""

import math
import time
from typing import Any

OK, WARN, ERROR = 0, 1, 2  # levels of diagnostic_msgs/DiagnosticStatus
REPEAT = 1.0  # s: an event of one kind is logged at most once in this time
RECENT = 2.0  # s: how long an event is shown in the diagnostics
BURST = 20  # lines of one kind with different texts that are logged in that time
OVERDUE = 3.0  # s of wall time for one sample of a paced run, after which an error is reported
PERIOD = 1.0  # s of wall time, and of simulation time, after which /diagnostics is published again


class Report:
    """Logs conditions and events to `logger` (methods info, warning, error). Safe to use from several threads."""

    def __init__(self, logger, now=time.monotonic):
        self._logger = logger
        self._now = now
        self._lasting = {}  # kind: (level, text)
        self._events = {}  # kind: (level, text, time last logged, time last seen)
        self._quotas = {}  # kind: Quota

    def info(self, text: str):
        self._logger.info(text)

    def note(self, kind: str, text: str):
        """Log a normal event; at most `BURST` lines a second of one kind."""
        if self._quota(kind).allows(self._now()):
            self.info(text + self._quota(kind).left_out())

    def begin(self, kind: str, text: str, level: int = WARN):
        """Begin the condition `kind`, which lasts until `end`; it is logged when it begins."""
        if kind not in self._lasting:
            self._log(level, text)
        self._lasting[kind] = (level, text)

    def end(self, kind: str, text: str = ""):
        """End the condition; `text`, if any, is logged if it had begun."""
        if self._lasting.pop(kind, None) is not None and text:
            self.info(text)

    def lasts(self, kind: str) -> bool:
        """Whether the condition has begun and has not ended."""
        return kind in self._lasting

    def event(self, kind: str, text: str, level: int = WARN, differing: bool = False):
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

    def _log(self, level: int, text: str):
        # Two statements: rclpy's loggers tell calls apart by their line.
        if level == ERROR:
            self._logger.error(text)
        else:
            self._logger.warning(text)


class Quota:
    """Rate limit: `BURST` lines in `REPEAT` seconds."""

    def __init__(self):
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


class Status:
    """Collects the content of /diagnostics from a RunLoop.

    Attributes:
        accuracy: of the present run, as it was asked for.
    """

    def __init__(self, run, report, accuracy):
        self._run, self._report, self.accuracy = run, report, accuracy
        self._seen = (0.0, 0.0)  # s: simulation time, wall time spent on samples
        self._last_published: tuple[float, float, Any] = (-PERIOD, 0.0, None)  # s, s: wall, simulation time; state

    def due(self) -> bool:
        """Whether to publish: after a second of wall time or of simulation time, and when the state has changed."""
        wall, simulated, state = self._last_published
        run = self._run
        return (
            time.monotonic() - wall >= PERIOD
            or abs(run.time - simulated) >= PERIOD
            or (run.standing, self._report.state()) != state
        )

    def collect(self, publishers_of_laws: int, final: bool = False) -> tuple[int, str, dict]:
        """Level, text and values; the real-time factor is the one since the last call, with `final` that of the run."""
        run = self._run
        if publishers_of_laws > 1:
            self._report.begin("laws", f"{publishers_of_laws} publishers of curvature_law: the later message wins")
        else:
            self._report.end("laws", "no more than one publisher of curvature_law again")
        if run.overdue > OVERDUE:
            self._report.begin(
                "overdue",
                f"no sample for {run.overdue:.0f} s after t = {run.time:g} s, which takes too many steps: another "
                "law, reset and pause are served",
                ERROR,
            )
        else:
            self._report.end("overdue")
        before, self._seen = (0.0, 0.0) if final else self._seen, (run.time, run.wall_time.seconds)
        simulated, wall = self._seen[0] - before[0], self._seen[1] - before[1]
        level, warnings = state = self._report.state()
        self._last_published = (time.monotonic(), run.time, (run.standing, state))
        values = {
            "law": run.laws.name,
            "accuracy": self.accuracy,
            "time": run.time,
            "real_time_factor": max(0.0, simulated) / wall if wall > 0.0 else 0.0,
            "late": max(0.0, run.pace.lost(run.samples_published)),
            **run.output.totals.values(),
            **run.output.errors,
            "samples_published": run.samples_published,
            "publishers_of_laws": publishers_of_laws,
            "warnings": "; ".join(warnings),
        }
        run.output.request_whole_snapshot()
        return level, (warnings[0] if warnings else "finished" if final else run.standing or "swimming"), values
