"""Finds what keeps a run from its next sample: another node, a failure, no law, missing subscribers, or a pause."""

import time
from collections.abc import Callable


class Obstacles:
    """Finds the obstacles of a `simulation`.

    publishers: subscribers_complete(wanted, now). wanted: subscribers to wait for before the first sample.
    on_subscribers_complete: called once, when they are there.

    Attributes:
        failed: the simulation has stopped and waits for a reset.
        paused: the user has paused the run.
        held: why another node has the topics; empty if none has.
    """

    def __init__(self, simulation, publishers, wanted: int, on_subscribers_complete: Callable[[], None]):
        self._simulation, self._publishers = simulation, publishers
        self._wanted, self._on_subscribers_complete = wanted, on_subscribers_complete
        self._subscribers_complete = wanted == 0
        self.failed = self.paused = False
        self.held = ""

    def find(self, simulation_time: float) -> str:
        """The first obstacle as text, at `simulation_time` [s]; empty if there is none."""
        if self.held:
            return self.held
        if self.failed:
            return f"stopped at t = {simulation_time:g} s until it is reset"
        if not self._simulation.ready:
            return "waiting for a law"
        if not self._subscribers_complete:
            self._subscribers_complete = self._publishers.subscribers_complete(self._wanted, time.monotonic())
            if not self._subscribers_complete:
                return f"waiting for {self._wanted} subscriber{'s' if self._wanted > 1 else ''}"
            self._on_subscribers_complete()
        return f"paused at t = {simulation_time:g} s" if self.paused else ""

    def pause(self, paused: bool):
        """Pause the run, or continue it."""
        self.paused = paused

    def hold(self, reason: str):
        """Hold the run for a `reason`; continue it with an empty one."""
        self.held = reason
