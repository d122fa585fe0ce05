# SPDX-License-Identifier: Apache-2.0
"""Advances the simulation to its next sample. A request may interrupt the computation; the next call continues it."""

import time

from eel_common.ros.loop.requests import RequestQueue

from eel_dynamics.ros.inputs.inputs import Inputs
from eel_dynamics.simulation.simulation import Simulation


class NextSample:
    """The computation of the next sample of a `simulation`. `requests` may interrupt it.

    Attributes:
        simulation: Simulation, which a reset may replace.
    """

    def __init__(self, simulation: Simulation, inputs: Inputs, requests: RequestQueue) -> None:
        self.simulation, self._inputs, self._requests = simulation, inputs, requests
        self._begun: float | None = None  # s, steady clock

    @property
    def lasted(self) -> float:
        """Wall time [s] since the computation began; 0 without one. For any thread."""
        begun = self._begun
        return 0.0 if begun is None else time.monotonic() - begun

    def forget(self) -> None:
        """Let the next call of `advance` begin a new computation."""
        self._begun = None

    def advance(self, instant: float) -> bool:
        """Advance to the sample at `instant` [s]; False if a request or the end of the run interrupts it."""
        if self._begun is None:
            self._begun = time.monotonic()
        since, requests = self._begun, self._requests
        while True:  # a step ends where commands take effect
            end = self._inputs.next_instant(instant)
            if not self.simulation.advance(end, lambda: requests.interrupt(since)):
                return False
            if end == instant:
                break
            self._inputs.act()
            if requests.interrupt(since):
                return False
        self._begun, self._inputs.acted = None, 0
        return True
