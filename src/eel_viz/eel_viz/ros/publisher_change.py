# SPDX-License-Identifier: Apache-2.0
"""Detects that a message comes from another publisher than the one before, such as a restarted node.

Stamps are not enough: the new node's may already lie beyond the last stamp of the old one. A message does not name its
publisher, but each publisher counts its messages, and discovery lists the publishers of a topic. So after a gap in the
count or a pause, the publishers are looked up: a new one has taken over. Messages may wait until their publisher has
gone; so `note_publishers` must be called regularly.
"""

from collections.abc import Callable, Hashable

PAUSE = 0.3  # s between two messages, after which the publishers are looked up: no node starts faster


class PublisherChange:
    """Follows the messages of one topic in the order of reception; `publishers()` returns its present publishers."""

    def __init__(self, publishers: Callable[[], set[Hashable]]) -> None:
        self._publishers = publishers
        self._seen: set[Hashable] = set()
        self._known: set[Hashable] = set()  # those seen when messages came
        self._last: tuple[int | None, int] | None = None  # count of the last message, and its time of sending [ns]

    def note_publishers(self) -> None:
        """Note the present publishers."""
        self._seen |= self._publishers()

    def changes(self, count: int | None, sent: int) -> bool:
        """Whether a message is the first of another publisher; `count`: its number there, `sent`: wall time [ns]."""
        last, self._last = self._last, (count, sent)
        if last is None:
            self.note_publishers()
            self._known = set(self._seen)
            return False
        # None: the middleware does not count
        follows = count is None or (last[0] is not None and count == last[0] + 1)
        if follows and 0 <= sent - last[1] < PAUSE * 1e9:
            return False
        self.note_publishers()
        newcomers = self._seen - self._known
        self._known |= newcomers
        return bool(newcomers)
