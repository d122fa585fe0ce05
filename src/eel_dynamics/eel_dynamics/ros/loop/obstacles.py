# SPDX-License-Identifier: Apache-2.0
"""Finds what keeps a run from its next sample: another node, a failure, no law, missing subscribers, or a pause."""

import time
from collections.abc import Callable

from eel_dynamics.ros.loop.request_queue import Request

WAITING = "waiting for curvature_law or curvature_samples"


class Obstacles:
    """Finds the obstacles of a `simulation`.

    publishers: subscribers_complete(wanted, now). wanted: subscribers to wait for before the first sample.
    on_subscribers_complete: called once, when they are there.

    Attributes:
        simulation: may be replaced at a reset.
        failed: the simulation has stopped and waits for a reset.
        paused: the user has paused the run.
        held: why another node has the topics; empty if none has.
    """

    def __init__(self, simulation, publishers, wanted: int, on_subscribers_complete: Callable[[], None]):
        self.simulation, self._publishers = simulation, publishers
        self._wanted, self._on_subscribers_complete = wanted, on_subscribers_complete
        self._subscribers_complete = wanted == 0 and not publishers.lossless
        self.failed = self.paused = False
        self.held = ""
        self._steps: Request | None = None
        self._steps_left = 0

    def find(self, simulation_time: float) -> str:
        """The first obstacle as text, at `simulation_time` [s]; empty if there is none."""
        if self.held:
            return self.held
        if self.failed:
            return f"stopped at t = {simulation_time:g} s until it is reset"
        if not self.simulation.ready:
            return WAITING
        if not self._subscribers_complete:
            self._subscribers_complete = self._publishers.subscribers_complete(self._wanted, time.monotonic())
            if not self._subscribers_complete:
                plural = "" if self._wanted == 1 else "s"
                return f"waiting for {self._wanted or 'the present'} subscriber{plural}"
            self._on_subscribers_complete()
        return f"paused at t = {simulation_time:g} s" if self.paused and self._steps is None else ""

    def start_may_be_shown(self, now: float) -> bool:
        """Whether sample 0 may be published at `now` [s, steady clock] while the run stands at its start."""
        if self.held or self.failed:
            return False
        return self._wanted == 0 or self._publishers.subscribers_complete(self._wanted, now)

    def pause(self, paused: bool, simulation_time: float):
        """Pause the run, or continue it, at `simulation_time` [s]."""
        self.paused = paused
        self.end_steps(simulation_time, "paused again" if paused else "the run was continued")

    def begin_steps(self, samples: int, request: Request, simulation_time: float):
        """Let so many `samples` of a paused run through; `request` is finished with the last of them."""
        if not self.paused or self.failed or self._steps is not None:
            left = f"{self._steps_left} samples of another step are left"
            reason = "the simulation has stopped" if self.failed else left if self.paused else "the run is not paused"
            request.finish(simulation_time, f"step refused at t = {simulation_time:g} s: {reason}")
        else:
            self._steps, self._steps_left = request, samples

    def end_steps(self, simulation_time: float, failure: str = ""):
        """End the steps that are left, because of `failure`."""
        if self._steps is not None:
            left = f"step ended at t = {simulation_time:g} s, {self._steps_left} samples before its end: {failure}"
            self._steps.finish(simulation_time, left if failure else "")
            self._steps = None

    def count_step(self, simulation_time: float):
        """Count one sample, at `simulation_time` [s]."""
        self._steps_left -= 1
        if self._steps is not None and self._steps_left == 0:
            self.end_steps(simulation_time)

    def hold(self, reason: str):
        """Hold the run for a `reason`; continue it with an empty one."""
        self.held = reason
