"""Requests of other threads to the run loop, which carries them out between two samples."""

import math
import threading
import time
from collections import deque
from collections.abc import Callable

PATIENCE = 1.0  # s of wall time on the way to a sample, after which every request is urgent


class Request:
    """An `action` for the run loop; `done` is set when it has been carried out."""

    def __init__(self, action: Callable[[], None], replaces: str = ""):
        self.action, self.replaces = action, replaces
        self.done = threading.Event()
        self.time = math.nan  # s: simulation time when it had been carried out


class RequestQueue:
    """Requests in the order in which they came, and the order to stop.

    Attributes:
        urgent: a request does not wait for the next sample.
        stopped: the run is to end.
    """

    def __init__(self):
        self._guard, self._bell = threading.Lock(), Bell()
        self._waiting: deque[Request] = deque()
        self.urgent = False
        self.stopped = False

    def __len__(self) -> int:
        return len(self._waiting)

    def put(self, action: Callable[[], None], replaces: str = "", urgent: bool = False) -> Request:
        """Add a request. It takes the place of the newest one if both have the same text `replaces`, not empty."""
        request = Request(action, replaces)
        with self._guard:
            if replaces and self._waiting and self._waiting[-1].replaces == replaces:
                self._waiting.pop()
            self._waiting.append(request)
            self.urgent |= urgent
            self._bell.ring()
        return request

    def stop(self):
        """End the run."""
        with self._guard:
            self.stopped = True
            self._bell.ring()

    def interrupt(self, since: float) -> bool:
        """Whether the way to a sample, begun at `since` [s, steady clock], is to be interrupted."""
        return self.stopped or self.urgent or (len(self._waiting) > 0 and time.monotonic() - since > PATIENCE)

    def wait(self, seconds: float) -> bool:
        """Sleep, unless there is a request or the run is stopped: then True. For the thread of the run loop."""
        with self._guard:
            if self._waiting or self.stopped:
                return True
            self._bell.hush()
        return self._bell.wait(seconds)

    def carry_out(self, perform: Callable[[Callable[[], None]], float]):
        """Have `perform(action)` carry out what waits; it returns the simulation time [s] afterwards."""
        self.urgent = False  # before they are counted, so that none is missed
        for _ in range(len(self._waiting)):  # those that come meanwhile wait for the next sample
            with self._guard:
                request = self._waiting.popleft()
            request.time = perform(request.action)
            request.done.set()


class Bell:
    """Wakes one thread that waits.

    It is one lock and nothing else: a node wakes 100 times a second, and each line of Python counts.
    """

    def __init__(self):
        self._silent = threading.Lock()
        self._silent.acquire()

    def ring(self):
        """Wake the thread that waits, or the next that waits. The caller sees to it that two rings do not overlap."""
        if self._silent.locked():
            self._silent.release()

    def hush(self):
        """Forget that it rang."""
        self._silent.acquire(blocking=False)

    def wait(self, seconds: float) -> bool:
        """Sleep until it rings, or for `seconds`: whether it rang."""
        return self._silent.acquire(timeout=max(0.0, seconds))
