# SPDX-License-Identifier: Apache-2.0
"""Runs callbacks so that no exception ends the node: it is logged, and the message is dropped or the call refused."""

import inspect
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any
from weakref import WeakKeyDictionary

from rcl_interfaces.msg import SetParametersResult
from rclpy.callback_groups import CallbackGroup
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.serialization import deserialize_message
from rclpy.subscription import Subscription

LOG_PERIOD = 1.0  # s between two log lines about dropped messages of one topic
LARGEST_MESSAGE = 2**21  # bytes accepted: three times a sample with 10,000 stations; such a law takes 0.2 s
LONGEST_REASON = 300  # characters


@dataclass
class Dropped:
    """What has been dropped of one topic. logged: how many of them were logged, and when [s, steady clock]."""

    count: int = 0
    logged: int = 0
    when: float = 0.0
    reason: str = ""


_dropped: WeakKeyDictionary[Node, dict[str, Dropped]] = WeakKeyDictionary()


class ServedNode(Node):
    """A node that survives every input. An unusable message is dropped; each service call is answered.

    Its subscriptions take bytes: where bytes are no message, rclpy's own subscriptions print twelve lines of the C
    libraries on stderr.
    """

    def create_service(self, srv_type: Any, srv_name: str, callback: Callable[..., Any], **options: Any) -> Any:
        """As in `Node`, but each call is answered even if `callback` raises; those of parameter services too."""
        return super().create_service(srv_type, srv_name, answering(self, srv_name, callback), **options)

    def create_subscription(
        self, msg_type: Any, topic: str, callback: Callable[..., Any], qos_profile: Any, **options: Any
    ) -> Subscription:
        """As in `Node`, but errors of `callback(message)` are logged and the message dropped, as are too large ones.
        With `raw=True` it is `callback(data, about)`: the serialised message and its message info."""
        what, raw = f"a message of {self.resolve_topic_name(topic)}", options.pop("raw", False)

        def take(data: bytes, about: dict[str, Any]) -> None:
            try:
                callback(*((data, about) if raw else (read_message(data, msg_type),)))
            except Exception as error:
                log_dropped(self, error, what)

        taken: Callable[..., None] = take  # rclpy's type hint omits the message info
        return super().create_subscription(msg_type, topic, taken, qos_profile, raw=True, **options)


class PolledGroup(CallbackGroup):
    """A callback group that the executor ignores: the node polls its subscriptions."""

    def can_execute(self, entity: Any) -> bool:
        return False


def serve_once(executor: Executor, node: Node, timeout: float | None = None) -> None:
    """Run one callback of the `executor`, waiting at most `timeout` [s] for it."""
    try:
        executor.spin_once(timeout_sec=timeout)
    except Exception as error:
        log_dropped(node, error)
    for what, dropped in list(_dropped.get(node, {}).items()):
        _tell(node, what, dropped)


def log_dropped(node: Node, error: Exception, what: str = "a message") -> None:
    """Log that `what` is dropped because of the `error`: at once, or together with others when `serve_once` finds that
    a second has passed."""
    dropped = _dropped.setdefault(node, {}).setdefault(what, Dropped())
    dropped.count += 1
    dropped.reason = reason_of(error)
    _tell(node, what, dropped)


def _tell(node: Node, what: str, dropped: Dropped) -> None:
    now = time.monotonic()
    if dropped.count == dropped.logged or (dropped.logged and now - dropped.when < LOG_PERIOD):
        return
    dropped.logged, dropped.when = dropped.count, now
    so_far = f" ({dropped.count} so far)" if dropped.count > 1 else ""
    node.get_logger().error(f"{what} cannot be taken and is left out{so_far}: {dropped.reason}")


def reason_of(error: Exception) -> str:
    """The `error` in one line."""
    return " ".join(f"{type(error).__name__}: {error}".split())[:LONGEST_REASON]


def read_message(data: bytes, kind: type) -> Any:
    """The message of type `kind` serialised in `data`. `ValueError` for more than `LARGEST_MESSAGE` bytes.

    A sequence of messages takes microseconds per byte, and meanwhile no signal is handled.
    """
    if len(data) > LARGEST_MESSAGE:
        raise ValueError(f"it must have at most {LARGEST_MESSAGE} bytes, got {len(data)}")
    return deserialize_message(data, kind)


def answering(node: Node, name: str, callback: Callable[..., Any]) -> Callable[..., Any]:
    """The `callback` of the service `name`, wrapped so that it answers each call. An exception is logged, and becomes
    the reason of a refusal."""

    async def answer(request: Any, response: Any) -> Any:
        try:
            answered = callback(request, response)
            return await answered if inspect.isawaitable(answered) else answered
        except Exception as error:  # without a response the caller would wait for ever
            reason = reason_of(error)
            node.get_logger().error(f"a call of {name} is refused: {reason}")
            return _refusal(request, response, reason)

    return answer


def _refusal(request: Any, response: Any, reason: str) -> Any:
    """The `response` with the `reason` in the field for it, if its type has one."""
    if hasattr(response, "results"):  # of SetParameters, one for each parameter
        left = len(request.parameters) - len(response.results)
        response.results += [SetParametersResult(successful=False, reason=reason) for _ in range(left)]
    elif isinstance(getattr(response, "result", None), SetParametersResult):
        response.result = SetParametersResult(successful=False, reason=reason)
    elif hasattr(response, "success"):
        response.success, response.message = False, reason
    return response
