# SPDX-License-Identifier: Apache-2.0
"""Tells on stderr how far a work has come that takes more than 2 s."""

import sys
import time
from collections.abc import Callable

WIDTH = 30  # characters of the bar
QUIET = 2.0  # s before the first word
REDRAWN = 0.1  # s between two drawings of the bar, at least
RARE = 60.0  # s between two lines, at most
WINDOW, SPACING = 6.0, 1.0  # s of wall time whose rate counts, and between two instants of it, at least
AGREED = 1.5  # times the rate in one half of the window by that in the other, at most


class Forecast:
    """The wall time that a work has left, by its rate in the last seconds. What was before its first word is set-up.

    It is silent until the rates in the two halves of the last 6 s, or of the last three words if these are rarer, agree
    within 1.5: a work at such a rate takes what is told to a factor of 2.
    """

    def __init__(self) -> None:
        self._marks: list[tuple[float, float]] = []  # wall time [s], what was done

    def add(self, now: float, done: float) -> None:
        """Take in what is `done` at the wall time `now` [s]. Where it is less than before the work has begun anew."""
        if self._marks and done < self._marks[-1][1]:
            self._marks.clear()
        if not self._marks or now - self._marks[-1][0] >= SPACING:
            self._marks.append((now, done))
        while len(self._marks) > 3 and self._marks[-1][0] - self._marks[1][0] >= WINDOW:
            del self._marks[0]

    def left(self, count: float) -> float | None:
        """Wall time [s] from the last mark until `count` is done; None where it cannot be told."""
        if len(self._marks) < 3 or self._marks[-1][0] - self._marks[0][0] < WINDOW:
            return None
        (start, begun), *between, (end, done) = self._marks
        middle, halfway = min(between, key=lambda mark: abs(mark[0] - 0.5 * (start + end)))
        early, late = (halfway - begun) / (middle - start), (done - halfway) / (end - middle)
        if not 0.0 < max(early, late) <= AGREED * min(early, late):
            return None
        return (count - done) * (end - start) / (done - begun)


class Progress:
    """A terminal shows a bar that is drawn anew. Anything else gets a line after 2, 4, 8 ... s, and every minute."""

    def __init__(self, program: str, unit: str):
        self._program, self._unit = program, unit
        self._forecast = Forecast()
        self._bar = sys.stderr is not None and sys.stderr.isatty()
        self._drawn = False
        self._start = time.monotonic()
        self._due = self._start + QUIET

    def __call__(self, done: float, count: float | None) -> None:
        """Tell, if due: `done` of `count`, in the unit. count: None where the end is not known."""
        now = time.monotonic()
        self._forecast.add(now, done)
        last = self._drawn and count is not None and done >= count
        if now < self._due and not last:
            return
        took, text, bar = now - self._start, f"{done:.4g} {self._unit}", ""
        if count is not None:
            text = f"{done:.6g} of {count:.6g} {self._unit}"
            bar = f"[{'#' * int(WIDTH * done / max(1, count)):.<{WIDTH}s}] "
            if done < count and (left := self._forecast.left(count)) is not None:
                text += f", about {left:.0f} s left"
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
