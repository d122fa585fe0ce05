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
PAUSE = 0.1  # s after a call of `take_messages` that found none: messages in bursts cost less
QUIET = 0.2  # s at the end without a message from before it: publishers repeat what is missing every 0.05 s
ON_THE_WAY = 5_000_000_000  # ns that a publisher waits at its end for a message to arrive
DRAIN_LIMIT = 1.5  # s at most, after a signal, to take messages from before it
STUCK = 0.5  # s after a signal, after which a node that starts, or keeps no files, leaves in the middle of a callback
SLOW_START = 4.0  # s likewise, of one that keeps files: its start may have begun one


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
    """Make the node and spin it until a signal comes or `poll(node)` returns False.

    words: the command line, the program first. about, parameters: what --help prints (`handle_arguments`); without
    them, the caller has handled other arguments than ROS arguments. sim_time: whether `use_sim_time` is true by
    default.

    take_messages(node, before): takes some of the waiting messages itself and returns how many of them are from before
    this time [ns, as `is_from_before`]; 0: all. The executor then only serves rare callbacks, such as parameter
    services. period: between two calls of `poll` [s]. complete: a node that keeps files. It subscribes in its
    `listen()`; from then on no signal makes it leave before they are complete. At the end, it takes all that was sent
    before; after a signal for `DRAIN_LIMIT` at most, and what is left its `drop_messages(before)` counts: `(number,
    whether that is all)`. At the end the node's `close()` is called, if it has one.
    Returns the exit status: 0; 1 if the node has a `failure` (a text), which is printed; 2 if it
    cannot start.
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
    """Whether `poll(node)` lets the node go on; it does so where it raises, which is logged."""
    try:
        return poll(node)
    except Exception as error:
        node.get_logger().error(f"what was due is left out: {reason_of(error)}", throttle_duration_sec=LOG_PERIOD)
        return True


def is_from_before(about: Mapping[str, Any], before: int) -> bool:
    """Whether the message with this message info `about` had come `before` [ns, system clock], or had been sent and was
    on its way."""
    late = (about["received_timestamp"] or time.time_ns()) - before
    return late <= (ON_THE_WAY if about["source_timestamp"] <= before else 0)


def _drain(node: Any, take_messages: Any, end: ProcessEnd) -> None:
    """Take what was sent before now: until none of it has come for `QUIET` [s], or the node has a `failure`, or it is
    time to go."""
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
