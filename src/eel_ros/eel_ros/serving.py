# SPDX-License-Identifier: Apache-2.0
"""Runs callbacks so that an exception does not end the node: it is logged, and the message is dropped."""

from rclpy.callback_groups import CallbackGroup
from rclpy.executors import Executor
from rclpy.node import Node

LOG_PERIOD = 1.0  # s between two log lines about dropped messages


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
    except Exception as error:  # rclpy's own callback for /clock may raise too
        log_dropped(node, error)


def log_dropped(node: Node, error: Exception, what: str = "a message") -> None:
    """Log that `what` is dropped, with the `error`."""
    reason = " ".join(f"{type(error).__name__}: {error}".split())[:300]
    node.get_logger().error(f"{what} cannot be taken and is left out: {reason}", throttle_duration_sec=LOG_PERIOD)
