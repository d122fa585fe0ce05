# SPDX-License-Identifier: Apache-2.0
"""Takes a controller's samples in the run loop's thread, because one turn of the executor costs twice as much as a
sample.

The loop waits for samples and requests together, in a wait set of its own, as `rclpy.wait_for_message` does.
"""

from collections.abc import Iterator
from typing import Any

from eel_common.ros.loop.diagnostics import ERROR, Report
from eel_common.ros.qos import Deliveries, keep_all
from eel_common.ros.serving import PolledGroup, ServedNode, log_dropped
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.qos import ReliabilityPolicy

from eel_dynamics.ros.inputs.law_messages import refused, samples_from_message
from eel_msgs.msg import CurvatureSamples

TOPIC = "curvature_samples"
BATCH = 1000  # samples taken from one subscription at once


class CurvatureInbox:
    """The subscriptions of `node` to samples; they wake the run loop.

    One is reliable. If a publisher is best-effort, `look` adds a best-effort subscription, which also receives the
    samples of reliable publishers. Each sample is passed on once.
    """

    def __init__(self, node: ServedNode, report: Report) -> None:
        self._node, self._report, self._group = node, report, PolledGroup()
        self._deliveries = Deliveries()
        self._guard = node.create_guard_condition(lambda: None, self._group)
        self._subscriptions: tuple[Any, ...] = ()
        self._wait_set: Any = None
        self._waited_for: tuple[Any, ...] = ()  # the subscriptions in the wait set
        self._subscribe(reliable=True)

    def look(self) -> None:
        """Look up the publishers, and subscribe a second time if one is best-effort. Call this regularly."""
        offers = self._node.get_publishers_info_by_topic(self._node.resolve_topic_name(TOPIC))
        unreliable = any(each.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT for each in offers)
        if unreliable and len(self._subscriptions) == 1:
            self._subscribe(reliable=False)

    def _subscribe(self, reliable: bool) -> None:
        quality = keep_all(reliable=reliable)
        made = self._node.create_subscription(CurvatureSamples, TOPIC, print, quality, callback_group=self._group)
        self._subscriptions = *self._subscriptions, made
        self.set()

    # In the run loop's thread.

    def take(self, now: float) -> Iterator[dict[str, Any]]:
        """The samples that have arrived, as arguments of `Simulation.add_samples`. now: simulation time [s].

        An unreadable or invalid sample is logged and dropped.
        """
        for subscription in self._subscriptions:
            for _ in range(BATCH):
                with subscription.handle:
                    taken = subscription.handle.take_message(subscription.msg_type, True)
                if taken is None:
                    break
                if self._deliveries.repeats(taken[1]):
                    continue
                try:
                    samples = samples_from_message(taken[0], now)
                except ValueError as error:
                    self._report.event("samples", refused(error), ERROR)
                except EOFError as error:
                    log_dropped(self._node, error, f"a message of {subscription.topic_name}")
                else:
                    yield samples

    def wait(self, seconds: float) -> bool:
        """Sleep until samples come or `set` is called, at most `seconds`. Returns False after a time-out."""
        subscriptions = self._subscriptions  # the node's thread may add one at any moment
        if self._waited_for is not subscriptions:
            self._waited_for, sizes = subscriptions, (len(subscriptions), 1, 0, 0, 0, 0)
            self._wait_set = rclpy_implementation.WaitSet(*sizes, self._node.context.handle)
        waiting = self._wait_set
        waiting.clear_entities()
        for subscription in subscriptions:
            waiting.add_subscription(subscription.handle)
        waiting.add_guard_condition(self._guard.handle)
        waiting.wait(max(0, round(seconds * 1e9)))
        return bool(waiting.get_ready_entities("subscription") or waiting.get_ready_entities("guard_condition"))

    # For any thread.

    def set(self) -> None:
        """Wake the run loop, or let its next `wait` return at once."""
        self._guard.trigger()

    def wake_callers(self) -> None:
        """Let the executor check whether the awaited requests are done."""
        if self._node.executor is not None:
            self._node.executor.wake()
