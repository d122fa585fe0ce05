# SPDX-License-Identifier: Apache-2.0
"""Recognises a message that another subscription of the same node has received already.

A topic may need two subscriptions, because one quality of service does not match all publishers. A publisher that both
match then delivers each message twice.
"""

from collections.abc import Mapping
from typing import Any

REMEMBERED = 4096  # deliveries: one subscription may be so far behind the other


class Deliveries:
    """The messages of one topic, by the time at which they were sent and their publisher's count of messages."""

    def __init__(self) -> None:
        self._known: dict[tuple[Any, ...], None] = {}  # the oldest first

    def repeats(self, info: Mapping[str, Any]) -> bool:
        """Whether the message with this message `info` has come before; from now on it has.

        A message without a time of sending is never a repetition.
        """
        delivery = info.get("source_timestamp"), info.get("publication_sequence_number")
        if delivery in self._known:
            return True
        if delivery[0]:
            self._known[delivery] = None
            if len(self._known) > REMEMBERED:
                del self._known[next(iter(self._known))]
        return False
