# SPDX-License-Identifier: Apache-2.0
"""Receives laws: checks each, drops duplicates, and puts it into the queue of the run loop.

There are two subscriptions: one also gets earlier messages (transient local), the other matches any publisher
(volatile). So most laws arrive twice. If laws arrive faster than they are read, the two subscriptions drop different
ones. A law is ignored if the other subscription has already received a later law of the same publisher.
"""

import reprlib
from collections.abc import Mapping
from functools import partial
from typing import Any

from eel_common.ros.loop.diagnostics import ERROR, Report
from eel_common.ros.qos import Deliveries, latched
from eel_common.ros.serving import ServedNode
from eel_gaits.laws.law_message import law_from_message
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.qos import QoSProfile

from eel_dynamics.ros.inputs.law_messages import law_name, read_law
from eel_dynamics.ros.inputs.stamps import stamped
from eel_dynamics.ros.loop.run_loop import RunLoop
from eel_msgs.msg import CurvatureLaw

DEPTH = 10  # laws
DROPPED = 1_000_000_000  # ns: of a law sent longer before the later one, the publisher's clock was set back
SHOWN = reprlib.Repr()
SHOWN.maxstring = 60  # characters shown of a refused law's name


class LawSubscription:
    """The subscriptions of `node` to curvature_law, for a `run`."""

    def __init__(self, node: ServedNode, run: RunLoop, report: Report) -> None:
        self._run, self._report, self._deliveries = run, report, Deliveries()
        self._newest: dict[int, tuple[int, int]] = {}  # by subscription: sending time [ns] and number of its last law
        for number, quality in enumerate((latched(DEPTH), QoSProfile(depth=DEPTH))):
            quiet = SubscriptionEventCallbacks(use_default_callbacks=False)  # one of the two matches
            receive = partial(self.receive_law, subscription=number)
            node.create_subscription(CurvatureLaw, "curvature_law", receive, quality, raw=True, event_callbacks=quiet)

    def receive_law(self, data: bytes, info: Mapping[str, Any], subscription: int = 0) -> None:
        """Pass on the law in the serialised message `data`; `info`: message info, to recognise duplicates."""
        if self._is_outdated(info, subscription) or self._deliveries.repeats(info):
            return
        name = law_name(data)
        try:
            message = read_law(data)
            origin, law = stamped(message.header.stamp, self._run.time), law_from_message(message)
        except ValueError as error:
            self._report.event("law", f"law {SHOWN.repr(name)} refused: {error}", ERROR, differing=True)
        else:
            self._run.requests.put(self._run.take_law, law, origin, newest=True)

    def _is_outdated(self, info: Mapping[str, Any], subscription: int) -> bool:
        """Whether the other subscription has received a later law of the same publisher."""
        sent, count = info.get("source_timestamp"), info.get("publication_sequence_number")
        if not sent or count is None:  # the middleware does not tell
            return False
        self._newest[subscription] = sent, count
        others = (newest for other, newest in self._newest.items() if other != subscription)
        return any(later > sent > later - DROPPED and further > count for later, further in others)
