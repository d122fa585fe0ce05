# SPDX-License-Identifier: Apache-2.0
"""Two topics of the same stamp: the one that comes first waits for the other."""

from collections import OrderedDict
from collections.abc import Callable
from typing import Generic, TypeVar

First = TypeVar("First")
Second = TypeVar("Second")
MAXIMUM_WAITING = 512  # of each; the oldest is dropped


class SameStamp(Generic[First, Second]):
    """Calls draw(stamp, first, second) once both have come, whatever comes first."""

    def __init__(self, draw: Callable[[int, First, Second], None]) -> None:
        self._draw = draw
        self._first: OrderedDict[int, First] = OrderedDict()
        self._second: OrderedDict[int, Second] = OrderedDict()

    def first(self, stamp: int, value: First) -> None:
        """Take the first at `stamp` [ns]."""
        if stamp in self._second:
            self._draw(stamp, value, self._second.pop(stamp))
        else:
            _keep(self._first, stamp, value)

    def second(self, stamp: int, value: Second) -> None:
        """Take the second at `stamp` [ns]."""
        if stamp in self._first:
            self._draw(stamp, self._first.pop(stamp), value)
        else:
            _keep(self._second, stamp, value)


Waiting = TypeVar("Waiting")


def _keep(waiting: OrderedDict[int, Waiting], stamp: int, value: Waiting) -> None:
    waiting[stamp] = value
    if len(waiting) > MAXIMUM_WAITING:
        waiting.popitem(last=False)
