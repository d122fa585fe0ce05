"""How a ROS process of this package lives and ends: SIGINT and SIGTERM end it well, with status 0 and no traceback."""

import signal
import time
from collections.abc import Callable

import rclpy
from eel_gaits.command_line import complain
from eel_gaits.starting import CANNOT_START, tell_no_start
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

ATTEND = 0.1  # s between two calls of `attend`
PAUSE = 0.1  # s between two calls of `work` that found nothing: what comes in bursts is shown for less
SELDOM = 1.0  # s between two lines of log about messages that cannot be taken
LAST_LOOK = 0.25  # s at most, at the end, for what has arrived and is not yet taken
EMPTY = 0.005  # s that the executor waits for a message there; three times in vain, and there is none


def live(
    name: str,
    arguments: list[str],
    make: Callable[[], Node],
    attend: Callable[[Node], bool],
    work: Callable[[Node], bool] | None = None,
    *,
    complete: bool = False,
) -> int:
    """Make the node, serve it until a signal comes or `attend(node)` says False, and call its `close()`, if it has one.

    With `work` the node fetches its messages itself, there, and says whether it found some; the executor then only has
    what is rare, such as questions about parameters. `complete`: what has arrived when the end comes is taken too.
    Returns the exit status: 0; 1 with one line on stderr if the node says why it had to stop, in its `failure`; 2 with
    one line if `make` refuses its settings.
    """
    signals: list[int] = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda received, _: signals.append(received))
    try:
        rclpy.init(args=arguments, signal_handler_options=SignalHandlerOptions.NO)
        node = make()
    except CANNOT_START as error:
        tell_no_start(name, error)
        rclpy.try_shutdown()
        return 2
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    attended = 0.0
    try:
        while not signals:
            now = time.monotonic()
            if now - attended > ATTEND:
                attended = now
                if not attend(node):
                    break
                if work is not None:
                    serve_once(executor, node, 0.0)
            if work is None:
                serve_once(executor, node, ATTEND)
            elif not work(node):
                time.sleep(PAUSE)
        if complete and not getattr(node, "failure", ""):
            take_the_rest(executor, node, work)
    finally:
        executor.shutdown()
        if hasattr(node, "close"):
            node.close()
        node.destroy_node()
        rclpy.try_shutdown()
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)  # until the process is gone: one more would spoil its exit status
    failure = getattr(node, "failure", "")
    if failure:
        complain(name, failure)
    return int(bool(failure))


def serve_once(executor: SingleThreadedExecutor, node: Node, timeout: float) -> None:
    """One turn of the executor, which waits `timeout` [s]; no message ends the node, of whatever callback."""
    try:
        executor.spin_once(timeout_sec=timeout)
    except Exception as error:  # also of rclpy's own callback for /clock
        leave_out(node, error)


def leave_out(node: Node, error: Exception, what: str = "a message") -> None:
    """Say, now and then, that `what` came to nothing."""
    reason = " ".join(f"{type(error).__name__}: {error}".split())[:300]
    node.get_logger().error(f"{what} cannot be taken and is left out: {reason}", throttle_duration_sec=SELDOM)


def check_seconds(argument: str, value: float | None) -> None:
    """ValueError that names the argument unless its value [s] is positive, or None."""
    if value is not None and not value > 0.0:
        raise ValueError(f"{argument} must be > 0 s, got {value:g}")


def take_the_rest(executor: SingleThreadedExecutor, node: Node, work: Callable[[Node], bool] | None) -> None:
    """What has arrived when the end comes belongs to the run: take it, in `LAST_LOOK` [s] at most."""
    limit, in_vain = time.monotonic() + LAST_LOOK, 0
    while in_vain < 3 and time.monotonic() < limit:
        began = time.monotonic()
        if work is not None:
            found = work(node)
        else:
            serve_once(executor, node, EMPTY)
            found = time.monotonic() - began < EMPTY
        in_vain = 0 if found else in_vain + 1
