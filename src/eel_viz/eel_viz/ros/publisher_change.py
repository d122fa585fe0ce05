"""Whether a message comes from another publisher than the one before it: a node that was killed and started again.

Stamps tell only if the second one is found before its time has passed the last stamp of the first. A message does not
say who sent it; but each publisher counts its messages, and the network tells who publishes on a topic. So where the
count does not go on, or nothing came for a while, the publishers are looked up: one that was not there before has taken
over. Messages may wait to be shown until their publisher has gone; `look`, now and then, remembers it.
"""

from collections.abc import Callable, Hashable

PAUSE = 0.3  # s between two messages, after which their publisher is looked up: no node starts within it


class Succession:
    """One topic's messages in the order in which they come; `publishers()` identifies those who publish there now."""

    def __init__(self, publishers: Callable[[], set[Hashable]]) -> None:
        self._publishers = publishers
        self._seen: set[Hashable] = set()
        self._known: set[Hashable] = set()  # of those seen, whose messages have come
        self._last: tuple[int | None, int] | None = None  # count of the last message, and when it was sent [ns]

    def look(self) -> None:
        """Remember who publishes now."""
        self._seen |= self._publishers()

    def changes(self, count: int | None, sent: int) -> bool:
        """Whether the message with its publisher's `count`, `sent` at [ns, wall time], is the first of another one."""
        last, self._last = self._last, (count, sent)
        if last is None:
            self.look()
            self._known = set(self._seen)
            return False
        follows = count is None or count == last[0] + 1  # None: this middleware does not count
        if follows and 0 <= sent - last[1] < PAUSE * 1e9:
            return False
        self.look()
        newcomers = self._seen - self._known
        self._known |= newcomers
        return bool(newcomers)
