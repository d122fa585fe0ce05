"""Callbacks that cannot end the node: an exception is logged, its message is left out, the next one is served."""

from rclpy.callback_groups import CallbackGroup
from rclpy.executors import Executor
from rclpy.node import Node

SELDOM = 1.0  # s between two lines of log about that


class Unattended(CallbackGroup):
    """The executor neither waits for the entities of this group nor runs them; the node takes their messages."""

    def can_execute(self, entity) -> bool:
        """Never."""
        return False

    def beginning_execution(self, entity) -> bool:
        """Never."""
        return False

    def ending_execution(self, entity) -> None:
        """Nothing has begun."""


def serve_once(executor: Executor, node: Node, timeout: float | None = None) -> None:
    """Run one callback of the `executor`, which waits at most `timeout` [s] for one."""
    try:
        executor.spin_once(timeout_sec=timeout)
    except Exception as error:  # also of rclpy's own callback for /clock
        leave_out(node, error)


def leave_out(node: Node, error: Exception, what: str = "a message") -> None:
    """Log that `what` is left out, and the `error` that is the reason."""
    reason = " ".join(f"{type(error).__name__}: {error}".split())[:300]
    node.get_logger().error(f"{what} cannot be taken and is left out: {reason}", throttle_duration_sec=SELDOM)
