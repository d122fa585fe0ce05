# SPDX-License-Identifier: Apache-2.0
"""Pairs two topics by their stamp: the message that comes first waits for the other."""

from collections.abc import Callable
from typing import Any, Generic, TypeVar

First = TypeVar("First")
Second = TypeVar("Second")
MAXIMUM_WAITING = 5000  # of each topic: the length of a publisher's history, so that no topic gets further ahead
UNSEEN = 512  # the same while the other topic has no message yet: it may never have one


class SameStamp(Generic[First, Second]):
    """Calls draw(stamp, first, second) once both have come for a `stamp` [ns], in any order.

    The stamps of a topic rise. So values that the other topic has passed are dropped, and the oldest beyond these
    numbers.
    """

    def __init__(self, draw: Callable[[int, First, Second], None]) -> None:
        self._draw = draw
        self._waiting: tuple[dict[int, Any], dict[int, Any]] = {}, {}  # firsts and seconds, by stamp
        self._seen = [False, False]

    def first(self, stamp: int, value: First) -> None:
        self._take(0, stamp, value)

    def second(self, stamp: int, value: Second) -> None:
        self._take(1, stamp, value)

    def _take(self, which: int, stamp: int, value: Any) -> None:
        others, own = self._waiting[1 - which], self._waiting[which]
        self._seen[which] = True
        while others and next(iter(others)) < stamp:
            del others[next(iter(others))]
        if stamp in others:
            other = others.pop(stamp)
            self._draw(stamp, *((other, value) if which else (value, other)))
            return
        own[stamp] = value
        if len(own) > (MAXIMUM_WAITING if self._seen[1 - which] else UNSEEN):
            del own[next(iter(own))]
