# SPDX-License-Identifier: Apache-2.0
"""Runs a node in the main thread: SIGINT and SIGTERM end it with status 0 and no traceback."""

import time
from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from eel_common.command.command_line import print_to_stderr
from eel_common.ros.command_line import USE_SIM_TIME, handle_arguments
from eel_common.ros.process_end import ProcessEnd
from eel_common.ros.serving import LOG_PERIOD, reason_of, serve_once
from eel_common.ros.start import start

Served = TypeVar("Served", bound=Node)

POLL_PERIOD = 0.1  # s between two calls of `poll`
PAUSE = 0.1  # s after a call of `take_messages` that found none: bursts cost less than single messages
QUIET = 0.2  # s without an earlier message, after which the end is reached: publishers resend every 0.05 s
ON_THE_WAY = 5_000_000_000  # ns: longest wait of a publisher at its end for a message to arrive
DRAIN_LIMIT = 1.5  # s: longest time after a signal for taking earlier messages
STUCK = 0.5  # s after a signal: then a node that starts, or writes no files, leaves in the middle of a callback
SLOW_START = 4.0  # s likewise, for a node that writes files: its start may have begun one


def run_node(
    name: str,
    words: list[str],
    make: Callable[[], Served],
    poll: Callable[[Served], bool] = lambda node: True,
    take_messages: Callable[[Served, int], int] | None = None,
    *,
    about: str = "",
    parameters: Iterable[tuple[str, str, Any]] = (),
    sim_time: bool = False,
    period: float = POLL_PERIOD,
    complete: bool = False,
) -> int:
    """Make the node and spin it until a signal comes or `poll(node)` returns False. Returns the exit status.

    words: the command line, the program first.
    about, parameters: for --help (`handle_arguments`); without them, the caller has handled non-ROS arguments.
    sim_time: the default of `use_sim_time`.
    take_messages(node, before): takes waiting messages, and returns how many of them are from before that time [ns, as
    `is_from_before`]; 0: all. The executor then serves only rare callbacks, such as parameter services.
    period: time between two calls of `poll` [s].
    complete: the node writes files. It subscribes in its `listen()`; from then on a signal lets it complete them. At
    its end it takes all earlier messages, after a signal for at most `DRAIN_LIMIT`. Its `drop_messages(before)` counts
    the rest: `(number, whether that is all)`.
    The node's `close()` is called at the end, if it exists. Status 0; 1 if the node has a `failure` (a text), which is
    printed; 2 if it cannot start.
    """
    if about and (status := handle_arguments(name, about, parameters, words)) is not None:
        return status
    end = ProcessEnd()
    end.leave_when_stuck(SLOW_START if complete else STUCK)

    def made() -> Served:
        node = make()
        if complete:
            keeper: Any = node
            end.stay_when_stuck()
            keeper.listen()
        return node

    node = start(name, [*(USE_SIM_TIME if sim_time else ()), *words], made)
    if node is None:
        return 2
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    try:
        _serve(executor, node, poll, take_messages, period, end)
        end.over = True
        if complete and take_messages is not None:
            _drain(node, take_messages, end)
    finally:
        executor.shutdown()
        if hasattr(node, "close"):
            node.close()
        ended: Node = node
        ended.destroy_node()
        rclpy.try_shutdown()
        end.ignore_signals()
    failure = getattr(node, "failure", "")
    if failure:
        print_to_stderr(name, failure)
    return int(bool(failure))


def _serve(
    executor: SingleThreadedExecutor,
    node: Any,
    poll: Callable[[Any], bool],
    take_messages: Any,
    period: float,
    end: ProcessEnd,
) -> None:
    last_poll = 0.0  # s, steady clock
    while not end.signalled:
        now = time.monotonic()
        if now - last_poll > period:
            last_poll = now
            if not _goes_on(poll, node):
                return
            if take_messages is not None:
                serve_once(executor, node, 0.0)
        if take_messages is None:
            serve_once(executor, node, period)
        elif not take_messages(node, 0):
            time.sleep(PAUSE)


def _goes_on(poll: Callable[[Any], bool], node: Any) -> bool:
    """Whether the node continues, by `poll(node)`. After an exception, which is logged, it does."""
    try:
        return poll(node)
    except Exception as error:
        node.get_logger().error(f"what was due is left out: {reason_of(error)}", throttle_duration_sec=LOG_PERIOD)
        return True


def is_from_before(about: Mapping[str, Any], before: int) -> bool:
    """Whether the message with this message info `about` had been received, or was on its way, `before` [ns, system
    clock]."""
    late = (about["received_timestamp"] or time.time_ns()) - before
    return late <= (ON_THE_WAY if about["source_timestamp"] <= before else 0)


def _drain(node: Any, take_messages: Any, end: ProcessEnd) -> None:
    """Take messages sent before now. Ends when none has come for `QUIET` [s], when the node has a `failure`, or when
    the time is up."""
    before, last = time.time_ns(), time.monotonic()
    limit = float("inf")
    while (now := time.monotonic()) - last < QUIET and not getattr(node, "failure", ""):
        if end.signalled:
            limit = min(limit, now + DRAIN_LIMIT)
        if now > limit:
            count, is_all = node.drop_messages(before)
            which = "" if is_all else "at least "
            node.get_logger().warning(
                f"left out: {which}{count} messages that had come before the signal, and were not taken "
                f"{DRAIN_LIMIT:g} s after it"
            )
            return
        if take_messages(node, before):
            last = time.monotonic()
        else:
            time.sleep(QUIET / 10)
