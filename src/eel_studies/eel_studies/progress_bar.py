# SPDX-License-Identifier: Apache-2.0
"""A progress bar on stderr."""

import sys
import time
from collections.abc import Callable

WIDTH = 30  # characters


def progress_of(progress: "Callable | bool | None", what: str = "points") -> Callable[[int, int], None]:
    """The function progress(done, count) that the argument `progress` asks for.

    progress: a function; True for a bar on stderr, False for nothing, None for a bar where stderr is a terminal.
    """
    if callable(progress):
        return progress
    if progress is None:
        progress = sys.stderr is not None and sys.stderr.isatty()
    return ProgressBar(what) if progress else lambda done, count: None


class ProgressBar:
    """Draws a bar for what is done, with the time that is left."""

    def __init__(self, what: str):
        self._what, self._start = what, time.monotonic()
        self._first: int | None = None

    def __call__(self, done: int, count: int) -> None:
        """Draw: `done` of `count`."""
        if self._first is None:
            self._first = done
        fresh = done - self._first
        left = (time.monotonic() - self._start) * (count - done) / fresh if fresh else 0.0
        bar = "#" * (WIDTH * done // max(1, count))
        text = f"\r[{bar:.<{WIDTH}s}] {done} of {count} {self._what}" + (f", {left:.0f} s left" if fresh else "")
        sys.stderr.write(f"{text:<70s}" + ("\n" if done >= count else ""))
        sys.stderr.flush()
