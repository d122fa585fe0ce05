"""Serving a node that no message ends: what a callback raises is said, its message is left out, the next is served."""

from rclpy.executors import Executor
from rclpy.node import Node

SELDOM = 1.0  # s between two lines of log about that


def serve_once(executor: Executor, node: Node, timeout: float | None = None) -> None:
    """One turn of the `executor`, which waits so long [s] for something to do."""
    try:
        executor.spin_once(timeout_sec=timeout)
    except Exception as error:
        leave_out(node, error)


def leave_out(node: Node, error: Exception, what: str = "a message") -> None:
    """Say that `what` came to nothing."""
    reason = " ".join(f"{type(error).__name__}: {error}".split())[:300]
    node.get_logger().error(f"{what} cannot be taken and is left out: {reason}", throttle_duration_sec=SELDOM)
