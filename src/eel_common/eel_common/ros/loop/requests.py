# SPDX-License-Identifier: Apache-2.0
"""Requests of callbacks to the run loop, whose thread executes each of them between two samples."""

import math
import threading
import time
from collections.abc import Callable, Generator
from typing import Any, NamedTuple, Protocol

INTERRUPT_AFTER = 1.0  # s of wall time: a request interrupts a sample that takes longer


class Waking(Protocol):
    """The event that a run loop waits for."""

    def set(self) -> None:
        """Wake the run loop, or let its next `wait` return at once."""

    def wait(self, seconds: float) -> bool:
        """Sleep at most `seconds`; return whether it was woken."""

    def wake_callers(self) -> None:
        """Let the executor check whether awaited requests are done."""


class Answer:
    """The run loop's answer to a request. While a callback awaits it, the executor runs callbacks of other groups.

    Attributes:
        done: whether it has been given.
        time: simulation time [s] at that moment.
        failure: why the request was refused, as text; empty if it was executed.
        deadline: [s, steady clock] end of the wait.
    """

    def __init__(self, inbox: Waking) -> None:
        self._inbox, self._awaited, self.done = inbox, False, threading.Event()
        self.time, self.failure, self.deadline = math.nan, "", math.inf

    def give(self, simulation_time: float, failure: str = "") -> None:
        """Answer that the request was executed, or ended with `failure`, at `simulation_time` [s]."""
        self.time, self.failure = simulation_time, failure
        self.done.set()
        if self._awaited:
            self._inbox.wake_callers()

    def __await__(self) -> Generator[None, None, None]:
        """Yield to the executor until the answer is given, or until `deadline`."""
        self._awaited = True
        while not self.done.is_set() and time.monotonic() < self.deadline:
            yield


class Request(NamedTuple):
    """`action(*arguments)` for the run loop, and its answer."""

    action: Callable[..., None]
    arguments: tuple[Any, ...]
    answer: Answer


class RequestQueue:
    """Requests in the order of arrival, and the flag to stop.

    Attributes:
        stopped: the run is to end.
    """

    def __init__(self, inbox: Waking) -> None:
        self._guard, self._inbox = threading.Lock(), inbox
        self._waiting: list[Request] = []
        self._urgent = self.stopped = False

    def put(self, action: Callable[..., None], *arguments: Any, urgent: bool = False, newest: bool = False) -> Answer:
        """Queue `action(*arguments)` for execution between two samples. If `urgent`, it interrupts the present sample.

        newest: it replaces the last request if that has the same action.
        """
        request = Request(action, arguments, Answer(self._inbox))
        with self._guard:
            if newest and self._waiting and self._waiting[-1].action == action:
                self._waiting.pop()
            self._waiting.append(request)
            self._urgent |= urgent
        self._inbox.set()
        return request.answer

    def take(self) -> list[Request]:
        """Remove and return the waiting requests. Later ones wait for the next sample."""
        with self._guard:
            taken, self._waiting, self._urgent = self._waiting, [], False
        return taken

    def stop(self) -> None:
        """End the run."""
        self.stopped = True
        self._inbox.set()

    def interrupt(self, since: float) -> bool:
        """Whether to interrupt the computation of a sample that began at `since` [s, steady clock]."""
        return self.stopped or self._urgent or (bool(self._waiting) and time.monotonic() - since > INTERRUPT_AFTER)

    def wait(self, seconds: float) -> bool:
        """Sleep at most `seconds`; return whether a request, a message or the end of the run woke it."""
        return bool(self._waiting) or self.stopped or self._inbox.wait(seconds)
