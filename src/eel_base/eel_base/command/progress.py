# SPDX-License-Identifier: Apache-2.0
"""Tells on stderr how far a work has come that takes more than 2 s."""

import sys
import time
from collections.abc import Callable

WIDTH = 30  # characters of the bar
QUIET = 2.0  # s before the first word
REDRAWN = 0.1  # s between two drawings of the bar, at least
RARE = 60.0  # s between two lines, at most


class Progress:
    """A terminal shows a bar that is drawn anew. Anything else gets a line after 2, 4, 8 ... s, and every minute."""

    def __init__(self, program: str, unit: str):
        self._program, self._unit = program, unit
        self._first: float | None = None
        self._bar = sys.stderr is not None and sys.stderr.isatty()
        self._drawn = False
        self._start = time.monotonic()
        self._due = self._start + QUIET

    def __call__(self, done: float, count: float | None) -> None:
        """Tell, if due: `done` of `count`, in the unit. count: None where the end is not known."""
        now = time.monotonic()
        self._first = done if self._first is None else self._first
        last = self._drawn and count is not None and done >= count
        if now < self._due and not last:
            return
        took, text, bar = now - self._start, f"{done:.4g} {self._unit}", ""
        if count is not None:
            text = f"{done:.6g} of {count:.6g} {self._unit}"
            bar = f"[{'#' * int(WIDTH * done / max(1, count)):.<{WIDTH}s}] "
            if self._first < done < count:
                text += f", about {took * (count - done) / (done - self._first):.0f} s left"
        if self._bar:
            sys.stderr.write(f"\r{bar}{text:<45s}" + ("\n" if last else ""))
            sys.stderr.flush()
            self._drawn, self._due = not last, now + REDRAWN
        else:
            self.say(text)
            self._due = now + min(took, RARE)

    def say(self, text: str) -> None:
        """Tell at once what is done now."""
        sys.stderr.write(f"{self._program}: {text}\n")
        sys.stderr.flush()


def progress_of(
    progress: Callable[..., object] | bool | None, unit: str = "points"
) -> Callable[[float, float], object]:
    """The function progress(done, count) that the argument `progress` asks for.

    progress: a function; True: `Progress`; False: nothing; None: `Progress` where stderr is a terminal.
    """
    if callable(progress):
        return progress
    if progress is None:
        progress = sys.stderr is not None and sys.stderr.isatty()
    return Progress("eel", unit) if progress else lambda done, count: None
