"""What the node has to say, so that each thing is said once or seldom, and stays in /diagnostics while it lasts."""

import math
import time

OK, WARN, ERROR = 0, 1, 2  # as diagnostic_msgs/DiagnosticStatus has them
REPEAT = 1.0  # s: an event of one kind is logged at most once in this time
RECENT = 2.0  # s: how long an event shows in the diagnostics


class Report:
    """Writes to `logger` (methods info, warning, error). Safe to use from several threads."""

    def __init__(self, logger, now=time.monotonic):
        self._logger = logger
        self._now = now
        self._lasting = {}  # kind: (level, text)
        self._events = {}  # kind: (level, text, time last logged, time last seen)

    def info(self, text: str):
        self._logger.info(text)

    def begin(self, kind: str, text: str, level: int = WARN):
        """A condition `kind` that lasts until `end`; logged when it begins."""
        if kind not in self._lasting:
            self._log(level, text)
        self._lasting[kind] = (level, text)

    def end(self, kind: str, text: str = ""):
        """The condition is over; `text`, if any, is logged if it had begun."""
        if self._lasting.pop(kind, None) is not None and text:
            self.info(text)

    def event(self, kind: str, text: str, level: int = WARN, differing: bool = False):
        """Something that happened; of one kind one a second is logged at most, or every `differing` text if asked."""
        now = self._now()
        _, last, logged, _ = self._events.get(kind, (OK, "", -math.inf, 0.0))
        if now - logged >= REPEAT or (differing and text != last):
            self._log(level, text)
            logged = now
        self._events[kind] = (level, text, logged, now)

    def state(self) -> tuple[int, list[str]]:
        """Present level and texts, the gravest first."""
        now = self._now()
        recent = [(level, text) for level, text, _, seen in list(self._events.values()) if now - seen < RECENT]
        present = sorted([*list(self._lasting.values()), *recent], key=lambda entry: -entry[0])
        return max((level for level, _ in present), default=OK), [text for _, text in present]

    def _log(self, level: int, text: str):
        # Two statements: rclpy's loggers tell calls apart by their line.
        if level == ERROR:
            self._logger.error(text)
        else:
            self._logger.warning(text)
