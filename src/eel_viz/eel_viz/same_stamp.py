# SPDX-License-Identifier: Apache-2.0
"""Two topics of the same stamp: the one that comes first waits for the other."""

from collections.abc import Callable
from typing import Any, Generic, TypeVar

First = TypeVar("First")
Second = TypeVar("Second")
MAXIMUM_WAITING = 512  # of each; the oldest is dropped


class SameStamp(Generic[First, Second]):
    """Calls draw(stamp, first, second) once both have come at a `stamp` [ns], whatever comes first."""

    def __init__(self, draw: Callable[[int, First, Second], None]) -> None:
        self._draw = draw
        self._waiting: tuple[dict[int, Any], dict[int, Any]] = {}, {}  # firsts and seconds, by stamp

    def first(self, stamp: int, value: First) -> None:
        self._take(0, stamp, value)

    def second(self, stamp: int, value: Second) -> None:
        self._take(1, stamp, value)

    def _take(self, which: int, stamp: int, value: Any) -> None:
        others, own = self._waiting[1 - which], self._waiting[which]
        if stamp in others:
            other = others.pop(stamp)
            self._draw(stamp, *((other, value) if which else (value, other)))
            return
        own[stamp] = value
        if len(own) > MAXIMUM_WAITING:
            del own[next(iter(own))]
