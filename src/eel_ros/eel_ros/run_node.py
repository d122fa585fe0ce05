"""Runs a node in the main thread: SIGINT and SIGTERM end it with status 0 and no traceback."""

import time
from collections.abc import Callable

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from eel_ros.process_end import ProcessEnd
from eel_ros.serving import serve_once
from eel_ros.start import start

ATTEND = 0.1  # s between two calls of `attend`
PAUSE = 0.1  # s between two calls of `work` that found nothing: messages that come in bursts cost less
LAST_LOOK = 0.25  # s at most, at the end, for messages that have arrived and are not yet taken
EMPTY = 0.005  # s that the executor waits for a message there; three times in vain, and there is none


def run_node(
    name: str,
    words: list[str],
    make: Callable[[], Node],
    attend: Callable[[Node], bool],
    work: Callable[[Node], bool] | None = None,
    *,
    complain: Callable[[str, object], None],
    period: float = ATTEND,
    complete: bool = False,
) -> int:
    """Make the node and serve it until a signal comes or `attend(node)`, called every `period` [s], returns False.

    With `work` the node takes its messages itself, there, and returns whether it found some; the executor then only
    has what is rare, such as requests about parameters. `complete`: messages that have arrived when the end comes are
    taken too. At the end the node's `close()` is called, if it has one.
    Returns the exit status: 0; 1 if the node has a `failure` (a text), which `complain(name, failure)` gets; 2 if it
    cannot start.
    """
    end = ProcessEnd()
    node = start(name, words, make, complain)
    if node is None:
        return 2
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    try:
        _serve(executor, node, attend, work, period, end)
        if complete and not getattr(node, "failure", ""):
            _take_the_rest(executor, node, work)
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


def _serve(executor, node, attend, work, period: float, end: ProcessEnd) -> None:
    attended = 0.0  # s, steady clock
    while not end.signalled:
        now = time.monotonic()
        if now - attended > period:
            attended = now
            if not attend(node):
                return
            if work is not None:
                serve_once(executor, node, 0.0)
        if work is None:
            serve_once(executor, node, period)
        elif not work(node):
            time.sleep(PAUSE)


def _take_the_rest(executor, node, work) -> None:
    """Messages that have arrived when the end comes belong to the run: take them, in `LAST_LOOK` [s] at most."""
    limit, in_vain = time.monotonic() + LAST_LOOK, 0
    while in_vain < 3 and time.monotonic() < limit:
        began = time.monotonic()
        if work is not None:
            found = work(node)
        else:
            serve_once(executor, node, EMPTY)
            found = time.monotonic() - began < EMPTY
        in_vain = 0 if found else in_vain + 1
