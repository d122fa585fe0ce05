# SPDX-License-Identifier: Apache-2.0
"""Queue of requests from other threads to the run loop, which executes them between two samples."""

import math
import threading
import time
from collections import deque
from collections.abc import Callable

INTERRUPT_AFTER = 1.0  # s of wall time for one sample, after which any request interrupts its computation


class Request:
    """An `action` for the run loop; `done` is set, and `wake()` called if it is given, after its execution.

    Attributes:
        time: simulation time [s] after its execution.
        failure: why it was refused, as text; empty if it was not.
    """

    def __init__(self, action: Callable[[], None], replaces: str = "", wake: Callable[[], None] | None = None):
        self.action, self.replaces, self._wake = action, replaces, wake
        self.done = threading.Event()
        self.time, self.failure = math.nan, ""

    def finish(self, simulation_time: float, failure: str = ""):
        """Set the attributes: it was executed, or ended with `failure`, at `simulation_time` [s]."""
        self.time, self.failure = simulation_time, failure
        self.done.set()
        if self._wake is not None:
            self._wake()


class RequestQueue:
    """Requests in the order of arrival, and the flag to stop. `wake_up`: what the run loop waits on.

    Attributes:
        urgent: a request does not wait for the next sample.
        stopped: the run is to end.
    """

    def __init__(self, wake_up: "WakeUp"):
        self._guard, self._wake_up = threading.Lock(), wake_up
        self._waiting: deque[Request] = deque()
        self.urgent = False
        self.stopped = False

    def __len__(self) -> int:
        return len(self._waiting)

    def put(self, action: Callable[[], None], replaces: str = "", urgent: bool = False, wake=None) -> Request:
        """Add a request. It replaces the newest one if both have the same non-empty text `replaces`."""
        request = Request(action, replaces, wake)
        with self._guard:
            if replaces and self._waiting and self._waiting[-1].replaces == replaces:
                self._waiting.pop()
            self._waiting.append(request)
            self.urgent |= urgent
            self._wake_up.set()
        return request

    def stop(self):
        """End the run."""
        with self._guard:
            self.stopped = True
            self._wake_up.set()

    def interrupt(self, since: float) -> bool:
        """Whether to interrupt the computation of a sample, begun at `since` [s, steady clock]."""
        return self.stopped or self.urgent or (len(self._waiting) > 0 and time.monotonic() - since > INTERRUPT_AFTER)

    def wait(self, seconds: float) -> bool:
        """Sleep at most `seconds`; True at once if there is a request or the run stops. For the run loop's thread."""
        with self._guard:
            if self._waiting or self.stopped:
                return True
            self._wake_up.clear()
        return self._wake_up.wait(seconds)

    def carry_out(self, perform: Callable[[Callable[[], None]], tuple[float, str]]):
        """Execute the waiting requests by `perform(action)`, which returns the simulation time [s] and a failure."""
        self.urgent = False  # before counting, so that no request is missed
        for _ in range(len(self._waiting)):  # later requests wait for the next sample
            with self._guard:
                request = self._waiting.popleft()
            request.finish(*perform(request.action))


class WakeUp:
    """An event for one waiting thread.

    It is a single lock, faster than `threading.Event`: a node waits 100 times a second.
    """

    def __init__(self):
        self._lock = threading.Lock()
        self._lock.acquire()

    def set(self):
        """Wake the waiting thread, or the next one that waits. Calls must not overlap."""
        if self._lock.locked():
            self._lock.release()

    def clear(self):
        """Reset the event."""
        self._lock.acquire(blocking=False)

    def wait(self, seconds: float) -> bool:
        """Sleep until the event is set, at most `seconds`; whether it was set."""
        return self._lock.acquire(timeout=max(0.0, seconds))
