# SPDX-License-Identifier: Apache-2.0
"""Runs callbacks so that an exception does not end the node: it is logged, and the message is dropped or refused."""

import inspect
from collections.abc import Callable

from rcl_interfaces.msg import SetParametersResult
from rclpy.callback_groups import CallbackGroup
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.serialization import deserialize_message

LOG_PERIOD = 1.0  # s between two log lines about dropped messages
LARGEST_MESSAGE = 2**21  # bytes that are read: three times the largest sample of 10,000 stations
LONGEST_REASON = 300  # characters


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
    text = f"{what} cannot be taken and is left out: {reason_of(error)}"
    node.get_logger().error(text, throttle_duration_sec=LOG_PERIOD)


def reason_of(error: Exception) -> str:
    """The `error` in one line."""
    return " ".join(f"{type(error).__name__}: {error}".split())[:LONGEST_REASON]


def read_message(data: bytes, kind: type, largest: int = LARGEST_MESSAGE):
    """The message of the type `kind` that is serialised in `data`. `ValueError` for more than the `largest` [bytes].

    A sequence of messages takes microseconds for each of its bytes, and no signal is heard meanwhile.
    """
    if len(data) > largest:
        raise ValueError(f"it must have at most {largest} bytes, got {len(data)}")
    return deserialize_message(data, kind)


def answering(node: Node, name: str, callback: Callable) -> Callable:
    """The `callback` of the service `name`, so that it answers each call: an exception is logged, and told as the
    reason of a refusal."""

    async def answer(request, response):
        try:
            answered = callback(request, response)
            return await answered if inspect.isawaitable(answered) else answered
        except Exception as error:  # without a response the caller would wait for ever
            reason = reason_of(error)
            node.get_logger().error(f"a call of {name} is refused: {reason}")
            return _refusal(request, response, reason)

    return answer


def _refusal(request, response, reason: str):
    """The `response` with the `reason`, where its type has a place for it."""
    if hasattr(response, "results"):  # of SetParameters, one for each parameter
        left = len(request.parameters) - len(response.results)
        response.results += [SetParametersResult(successful=False, reason=reason) for _ in range(left)]
    elif isinstance(getattr(response, "result", None), SetParametersResult):
        response.result = SetParametersResult(successful=False, reason=reason)
    elif hasattr(response, "success"):
        response.success, response.message = False, reason
    return response
