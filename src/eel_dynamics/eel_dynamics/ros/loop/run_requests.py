# SPDX-License-Identifier: Apache-2.0
"""What other threads ask of a run loop: its thread executes each request between two samples."""

from collections.abc import Callable
from typing import Any, NamedTuple

from eel_dynamics.ros.diagnostics import ERROR
from eel_dynamics.ros.loop.request_queue import Request, RequestQueue
from eel_dynamics.simulation.simulation import Simulation

MAXIMUM_REQUESTS = 10_000  # requests
TOO_MANY = f"curvature samples refused: at most {MAXIMUM_REQUESTS} wait for the next sample"


class NewRun(NamedTuple):
    """What a reset changes: another `simulation`, `parameters`, and `begin()`, which makes its topics ready."""

    simulation: Simulation
    parameters: Any  # the node's Parameters
    begin: Callable[[], None]


class RunRequests:
    """Puts requests to the run `loop` into its `queue`.

    Attributes:
        on_finished: called when an urgent request, or a step, is done; may be replaced.
    """

    def __init__(self, loop, queue: RequestQueue, report):
        self._loop, self._queue, self._report = loop, queue, report
        self.on_finished: Callable[[], None] = lambda: None

    @property
    def time(self) -> float:
        """Simulation time of the last sample [s]."""
        return self._loop.time

    def put(self, action, replaces: str = "", urgent: bool = False) -> Request:
        """Queue `action()` for execution between two samples; an `urgent` one interrupts the present sample.

        It replaces the newest request if both have the same non-empty text `replaces`.
        """
        return self._queue.put(action, replaces, urgent, self.on_finished if urgent else None)

    def take_law(self, law, origin: float):
        """Adopt a law whose own t = 0 lies at simulation time `origin` [s]; of several before a sample the last."""
        self.put(lambda: self._loop.adopt(law, origin), "law")

    def take_samples(self, samples: dict):
        """Add one instant of a law, the arguments of `Simulation.add_samples`; refused while too many wait."""
        if len(self._queue) < MAXIMUM_REQUESTS:
            self.put(lambda: self._loop.laws.add_samples(samples, self._loop.pace.period))
        else:
            self._report.event("samples", TOO_MANY, ERROR)

    def reset(self, new: NewRun | None = None) -> Request:
        """Reset state and time to the start, of a `new` run if it is given. The law stays."""
        return self.put(lambda: self._loop.reset(new), urgent=True)

    def pause(self, paused: bool) -> Request:
        """Pause the run, or continue it."""
        return self.put(lambda: self._loop.obstacles.pause(paused, self._loop.time), urgent=True)

    def step(self, samples: int) -> Request:
        """Publish so many `samples` of a paused run; the request is done with the last of them.

        Sample 0 is none of them.
        """
        steps = Request(lambda: None, wake=self.on_finished)
        self.put(lambda: self._loop.obstacles.begin_steps(samples, steps, self._loop.time), urgent=True)
        return steps

    def set_state(self, position, orientation, twist) -> Request:
        """Put the head elsewhere, as `Simulation.set_state` does."""
        return self.put(lambda: self._loop.set_state(position, orientation, twist), urgent=True)

    def show_clock(self, shown: float, now: float):
        """Take the time `shown` [s] on the /clock that the run follows, received at `now` [s, steady clock]."""
        self.put(lambda: self._loop.pace.show(shown, now), "clock")

    def hold(self, reason: str):
        """Hold the run for a `reason`, before its next sample; continue it with an empty one."""
        self.put(lambda: self._loop.obstacles.hold(reason), urgent=True)

    def change(self, parameters):
        """Apply `parameters`; only the changeable ones may differ."""
        self.put(lambda: self._loop.change(parameters))

    def stop(self):
        """End the run."""
        self._queue.stop()

    @property
    def stopped(self) -> bool:
        """Whether `stop` was called."""
        return self._queue.stopped
