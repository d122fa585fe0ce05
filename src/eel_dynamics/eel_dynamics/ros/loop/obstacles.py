"""What keeps a run from its next sample: a failure, no law yet, subscribers that are not there yet, a pause."""

import time
from collections.abc import Callable


class Obstacles:
    """Looks for obstacles of a `simulation`.

    publishers: audience_complete(wanted, now). wanted: subscribers to wait for before the first sample.
    greet: called once they are there.

    Attributes:
        failed: the simulation has stopped and waits for a reset.
        paused: the user has paused the run.
    """

    def __init__(self, simulation, publishers, wanted: int, greet: Callable[[], None]):
        self._simulation, self._publishers = simulation, publishers
        self._wanted, self._greet = wanted, greet
        self._audience_complete = wanted == 0
        self.failed = self.paused = False

    def find(self, simulation_time: float) -> str:
        """The first obstacle in words, at `simulation_time` [s]; empty if there is none."""
        if self.failed:
            return f"stopped at t = {simulation_time:g} s until it is reset"
        if not self._simulation.ready:
            return "waiting for a law"
        if not self._audience_complete:
            self._audience_complete = self._publishers.audience_complete(self._wanted, time.monotonic())
            if not self._audience_complete:
                return f"waiting for {self._wanted} subscriber{'s' if self._wanted > 1 else ''}"
            self._greet()
        return f"paused at t = {simulation_time:g} s" if self.paused else ""

    def pause(self, paused: bool):
        """Stand still, or go on."""
        self.paused = paused
