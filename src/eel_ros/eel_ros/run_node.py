# SPDX-License-Identifier: Apache-2.0
"""Runs a node in the main thread: SIGINT and SIGTERM end it with status 0 and no traceback."""

import time
from collections.abc import Callable
from typing import TypeVar

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from eel_ros.process_end import ProcessEnd
from eel_ros.serving import LOG_PERIOD, reason_of, serve_once
from eel_ros.start import start

Served = TypeVar("Served", bound=Node)

POLL_PERIOD = 0.1  # s between two calls of `poll`
PAUSE = 0.1  # s after a call of `take_messages` that found none: messages in bursts cost less
DRAIN_LIMIT = 1.0  # s at most, at the end, to take messages that have arrived: a busy machine needs it
STUCK = 0.5  # s after a signal, after which a node that keeps no files leaves in the middle of a callback
EMPTY_TIMEOUT = 0.005  # s that the executor waits for a message there; after three time-outs there is none


def run_node(
    name: str,
    words: list[str],
    make: Callable[[], Served],
    poll: Callable[[Served], bool],
    take_messages: Callable[[Served], bool] | None = None,
    *,
    complain: Callable[[str, object], None],
    period: float = POLL_PERIOD,
    complete: bool = False,
) -> int:
    """Make the node and spin it until a signal comes or `poll(node)` returns False.

    take_messages: takes the waiting messages itself and returns whether there were any; the executor then only serves
    rare callbacks, such as parameter services. period: between two calls of `poll` [s]. complete: at the end, take the
    messages that have arrived. At the end the node's `close()` is called, if it has one.
    Returns the exit status: 0; 1 if the node has a `failure` (a text), which `complain(name, failure)` gets; 2 if it
    cannot start.
    """
    end = ProcessEnd()
    node = start(name, words, make, complain)
    if node is None:
        return 2
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    if not complete:
        end.leave_when_stuck(STUCK)
    try:
        _serve(executor, node, poll, take_messages, period, end)
        end.over = True
        if complete and not getattr(node, "failure", ""):
            _drain(executor, node, take_messages)
    finally:
        executor.shutdown()
        if hasattr(node, "close"):
            node.close()
        node.destroy_node()
        rclpy.try_shutdown()
        end.ignore_signals()
    failure = getattr(node, "failure", "")
    if failure:
        complain(name, failure)
    return int(bool(failure))


def _serve(executor, node, poll, take_messages, period: float, end: ProcessEnd) -> None:
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
        elif not take_messages(node):
            time.sleep(PAUSE)


def _goes_on(poll, node) -> bool:
    """Whether `poll(node)` lets the node go on; it does so where it raises, which is logged."""
    try:
        return poll(node)
    except Exception as error:
        node.get_logger().error(f"what was due is left out: {reason_of(error)}", throttle_duration_sec=LOG_PERIOD)
        return True


def _drain(executor, node, take_messages) -> None:
    """Take the messages that have arrived, for at most `DRAIN_LIMIT` [s]: they belong to the run."""
    limit, empty_polls = time.monotonic() + DRAIN_LIMIT, 0
    while empty_polls < 3 and time.monotonic() < limit:
        began = time.monotonic()
        if take_messages is not None:
            found = take_messages(node)
        else:
            serve_once(executor, node, EMPTY_TIMEOUT)
            found = time.monotonic() - began < EMPTY_TIMEOUT
        empty_polls = 0 if found else empty_polls + 1
