"""How long a swim is going to take, foreseen from how far it has come: who waits for it is told within a second."""

import time
import warnings
from collections.abc import Callable

FIRST = 1.0  # s of wall time until it is foreseen, and between two times that it is told
LONG = 60.0  # s of wall time: a swim that takes longer is warned of


class Foresight:
    """Looks on while a swim of `duration` [s] goes on. progress(time, left): is told the time [s] that the swim has
    come to, and the wall time [s] that it still takes; without it a swim that takes long is warned of once."""

    def __init__(self, duration: float, progress: Callable[[float, float], None] | None):
        self._duration, self._progress = duration, progress
        self._began = self._told = time.monotonic()
        self._warned = False

    def look(self, reached: float):
        """The swim has come to the time `reached` [s]."""
        now = time.monotonic()
        if now - self._told < FIRST:
            return
        self._told = now
        took = now - self._began
        left = took * (self._duration - reached) / reached if reached > 0.0 else float("inf")
        if self._progress is not None:
            self._progress(reached, left)
        elif took + left > LONG and not self._warned:
            self._warned = True
            warnings.warn(
                f"this swim of {self._duration:g} s is going to take {_minutes(took + left)}: it has come to "
                f"{reached:.3g} s in {took:.0f} s; a coarser accuracy, a slower law or a shorter duration takes less",
                stacklevel=6,
            )


def _minutes(seconds: float) -> str:
    return "for ever" if seconds == float("inf") else f"about {seconds / 60.0:.2g} minutes"
