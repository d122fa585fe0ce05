# SPDX-License-Identifier: Apache-2.0
"""Shows on stderr the progress of a task that takes more than 2 s."""

import sys
import time
from collections.abc import Callable

WIDTH = 30  # characters of the bar
QUIET = 2.0  # s before the first report
REDRAWN = 0.1  # s: least time between two drawings of the bar
RARE = 60.0  # s: longest time between two lines
WINDOW, SPACING = 6.0, 1.0  # s of wall time: the window of the rate, and the least time between its marks
AGREED = 1.5  # largest ratio of the rates in the two halves of the window


class Forecast:
    """The wall time left, from the rate of the last seconds. Time before the first report counts as set-up.

    There is no forecast until the rates in the two halves of the last 6 s agree within a factor of 1.5. If reports are
    rarer, the last three count. A forecast is then right to a factor of 2.
    """

    def __init__(self) -> None:
        self._marks: list[tuple[float, float]] = []  # wall time [s], amount done

    def add(self, now: float, done: float) -> None:
        """Add a mark: the amount `done` at the wall time `now` [s]. Less than before starts again."""
        if self._marks and done < self._marks[-1][1]:
            self._marks.clear()
        if not self._marks or now - self._marks[-1][0] >= SPACING:
            self._marks.append((now, done))
        while len(self._marks) > 3 and self._marks[-1][0] - self._marks[1][0] >= WINDOW:
            del self._marks[0]

    def left(self, count: float) -> float | None:
        """Wall time [s] from the last mark until `count` is done; None without a forecast."""
        if len(self._marks) < 3 or self._marks[-1][0] - self._marks[0][0] < WINDOW:
            return None
        (start, begun), *between, (end, done) = self._marks
        middle, halfway = min(between, key=lambda mark: abs(mark[0] - 0.5 * (start + end)))
        early, late = (halfway - begun) / (middle - start), (done - halfway) / (end - middle)
        if not 0.0 < max(early, late) <= AGREED * min(early, late):
            return None
        return (count - done) * (end - start) / (done - begun)


class Progress:
    """On a terminal, a bar. Elsewhere a line after 2, 4, 8 ... s, and then every minute."""

    def __init__(self, program: str, unit: str):
        self._program, self._unit = program, unit
        self._forecast = Forecast()
        self._bar = sys.stderr is not None and sys.stderr.isatty()
        self._drawn = False
        self._start = time.monotonic()
        self._due = self._start + QUIET

    def __call__(self, done: float, count: float | None) -> None:
        """Report `done` of `count`, in the unit, if a report is due. count: None where the end is not known."""
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
        """Report `text` at once."""
        sys.stderr.write(f"{self._program}: {text}\n")
        sys.stderr.flush()


def progress_of(
    progress: Callable[..., object] | bool | None, unit: str = "points"
) -> Callable[[float, float], object]:
    """The function progress(done, count) for the argument `progress` of a public function.

    progress: a function; True: `Progress`; False: nothing; None: `Progress` where stderr is a terminal.
    """
    if callable(progress):
        return progress
    if progress is None:
        progress = sys.stderr is not None and sys.stderr.isatty()
    return Progress("eel", unit) if progress else lambda done, count: None
