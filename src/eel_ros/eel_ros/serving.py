# SPDX-License-Identifier: Apache-2.0
"""Runs callbacks so that an exception does not end the node: it is logged, and the message is dropped."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from weakref import WeakKeyDictionary

from rclpy.callback_groups import CallbackGroup
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.serialization import deserialize_message
from rclpy.subscription import Subscription

LOG_PERIOD = 1.0  # s between two log lines about dropped messages of one topic


@dataclass
class Dropped:
    """What has been dropped of one topic. told: how many of them the log has told of, and when [s, steady clock]."""

    count: int = 0
    told: int = 0
    when: float = 0.0
    reason: str = ""


_dropped: WeakKeyDictionary[Node, dict[str, Dropped]] = WeakKeyDictionary()


class ServedNode(Node):
    """A node whose subscriptions take bytes. With bytes that are no message, rclpy's own way leaves twelve lines of the
    C libraries on stderr for each."""

    def create_subscription(self, msg_type, topic: str, callback: Callable, qos_profile, **options) -> Subscription:
        """As of `rclpy.node.Node`; what the `callback(message)` raises is logged, and the message dropped."""
        if options.pop("raw", False):
            return super().create_subscription(msg_type, topic, callback, qos_profile, raw=True, **options)

        name = self.resolve_topic_name(topic)

        def take(data: bytes) -> None:
            try:
                callback(deserialize_message(data, msg_type))
            except Exception as error:
                log_dropped(self, error, f"a message of {name}")

        return super().create_subscription(msg_type, topic, take, qos_profile, raw=True, **options)


class PolledGroup(CallbackGroup):
    """A callback group that the executor neither waits for nor runs; the node polls its subscriptions."""

    def can_execute(self, entity) -> bool:
        """Return False: the executor runs none of them."""
        return False

    def beginning_execution(self, entity) -> bool:
        """Return False: the executor runs none of them."""
        return False

    def ending_execution(self, entity) -> None:
        """Do nothing: none has begun."""


def serve_once(executor: Executor, node: Node, timeout: float | None = None) -> None:
    """Run one callback of the `executor`, waiting at most `timeout` [s] for it."""
    try:
        executor.spin_once(timeout_sec=timeout)
    except Exception as error:
        log_dropped(node, error)
    for what, dropped in list(_dropped.get(node, {}).items()):
        _tell(node, what, dropped)


def log_dropped(node: Node, error: Exception, what: str = "a message") -> None:
    """Log that `what` is dropped, with the `error`: at once, or with those of the same second when `serve_once` finds
    that it has passed."""
    dropped = _dropped.setdefault(node, {}).setdefault(what, Dropped())
    dropped.count += 1
    dropped.reason = " ".join(f"{type(error).__name__}: {error}".split())[:300]
    _tell(node, what, dropped)


def _tell(node: Node, what: str, dropped: Dropped) -> None:
    now = time.monotonic()
    if dropped.count == dropped.told or (dropped.told and now - dropped.when < LOG_PERIOD):
        return
    dropped.told, dropped.when = dropped.count, now
    so_far = f" ({dropped.count} so far)" if dropped.count > 1 else ""
    node.get_logger().error(f"{what} cannot be taken and is left out{so_far}: {dropped.reason}")
