"""What the node has to say, so that each thing is said once or seldom, and stays in /diagnostics while it lasts."""

import math
import time

OK, WARN, ERROR = 0, 1, 2  # as diagnostic_msgs/DiagnosticStatus has them
REPEAT = 1.0  # s: an event of one kind is logged at most once in this time
RECENT = 2.0  # s: how long an event shows in the diagnostics
BURST = 20  # lines of one kind in that time, where each tells something else


class Report:
    """Writes to `logger` (methods info, warning, error). Safe to use from several threads."""

    def __init__(self, logger, now=time.monotonic):
        self._logger = logger
        self._now = now
        self._lasting = {}  # kind: (level, text)
        self._events = {}  # kind: (level, text, time last logged, time last seen)
        self._quotas = {}  # kind: Quota

    def info(self, text: str):
        self._logger.info(text)

    def note(self, kind: str, text: str):
        """Something usual that happened; of one kind some lines a second are logged at most."""
        if self._quota(kind).allows(self._now()):
            self.info(text + self._quota(kind).left_out())

    def begin(self, kind: str, text: str, level: int = WARN):
        """A condition `kind` that lasts until `end`; logged when it begins."""
        if kind not in self._lasting:
            self._log(level, text)
        self._lasting[kind] = (level, text)

    def end(self, kind: str, text: str = ""):
        """The condition is over; `text`, if any, is logged if it had begun."""
        if self._lasting.pop(kind, None) is not None and text:
            self.info(text)

    def lasts(self, kind: str) -> bool:
        """Whether the condition has begun and is not over."""
        return kind in self._lasting

    def event(self, kind: str, text: str, level: int = WARN, differing: bool = False):
        """Something that happened; of one kind one a second is logged at most, or some `differing` texts if asked."""
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
        """Present level and texts, the gravest first."""
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
    """`BURST` lines in `REPEAT` seconds."""

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
        """How many lines were not logged since the last time, in words; empty where none."""
        count, self._refused = self._refused, 0
        return f" (and {count} more before, not shown)" if count else ""
