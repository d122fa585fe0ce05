# SPDX-License-Identifier: Apache-2.0
"""Finds what holds back a run's next sample: another node, a failure, missing inputs or subscribers, or a pause."""

import time
from collections.abc import Callable

from eel_common.ros.loop.requests import Answer

from eel_dynamics.ros.inputs.awaited import JOINTS, LAW, SAMPLES
from eel_dynamics.ros.publishers import Publishers
from eel_dynamics.simulation.simulation import Simulation


class RunGate:
    """Lets the next sample of a `simulation` through, or tells why not.

    wanted: number of subscribers to wait for before the first sample.

    Attributes:
        simulation: Simulation, which a reset may replace.
        failed: whether the simulation has stopped and waits for a reset.
        held: text that names the other node with the same topics; empty without one.
    """

    def __init__(self, simulation: Simulation, publishers: Publishers, wanted: int) -> None:
        self.simulation, self._publishers, self._wanted = simulation, publishers, wanted
        self._subscribers_complete = wanted == 0 and not publishers.lossless
        self.failed = self._paused = False
        self.held = ""
        self._steps: Answer | None = None
        self._steps_left = 0

    def held_by(self, simulation_time: float, late: list[str], missing: Callable[[], list[str]]) -> str:
        """What holds the run, as text, at `simulation_time` [s]; empty if nothing does.

        late: inputs that must arrive before the next sample. missing: gives the inputs that are still awaited; it is
        called once nothing else is missing.
        """
        if self.held:
            return self.held
        if self.failed:
            return f"stopped at t = {simulation_time:g} s until it is reset"
        plural = "" if self._wanted == 1 else "s"
        audience = f"{self._wanted} subscriber{plural}" if self._wanted else "the present subscribers"
        if not self.simulation.ready:
            robot = self.simulation.robot
            drivers = (LAW, SAMPLES) if robot is None or not robot.driven_names else (LAW, SAMPLES, JOINTS)
            needed = [] if {*drivers} & {each.split(" ")[0] for each in late} else [" or ".join(drivers)]
            return f"waiting for {', '.join([*needed, *late, *([] if self._subscribers_complete else [audience])])}"
        if not self._subscribers_complete:
            self._subscribers_complete = self._publishers.subscribers_complete(self._wanted, time.monotonic())
            if not self._subscribers_complete:
                return f"waiting for {', '.join([*late, audience])}"
            self._publishers.wait_until_body_received()
        if late and (names := missing()):
            return f"waiting for {', '.join(names)}"
        return f"paused at t = {simulation_time:g} s" if self._paused and self._steps is None else ""

    def start_may_be_shown(self, now: float) -> bool:
        """Whether sample 0 may be published at `now` [s, steady clock] while the run stands at its start."""
        if self.held or self.failed:
            return False
        return self._wanted == 0 or self._publishers.subscribers_complete(self._wanted, now)

    def pause(self, paused: bool, simulation_time: float) -> None:
        """Pause the run, or continue it, at `simulation_time` [s]."""
        self._paused = paused
        self.end_steps(simulation_time, "paused again" if paused else "the run was continued")

    def begin_steps(self, samples: int, steps: Answer, simulation_time: float) -> None:
        """Let this number of `samples` of a paused run through; `steps` is answered with the last one."""
        if not self._paused or self.failed or self._steps is not None:
            left = f"{self._steps_left} samples of another step are left"
            reason = "the simulation has stopped" if self.failed else left if self._paused else "the run is not paused"
            steps.give(simulation_time, f"step refused at t = {simulation_time:g} s: {reason}")
        else:
            self._steps, self._steps_left = steps, samples

    def end_steps(self, simulation_time: float, failure: str = "") -> None:
        """End the steps that are left, because of `failure`."""
        if self._steps is not None:
            left = f"step ended at t = {simulation_time:g} s, {self._steps_left} samples before its end: {failure}"
            self._steps.give(simulation_time, left if failure else "")
            self._steps = None

    def count_step(self, simulation_time: float) -> None:
        """Count one sample, at `simulation_time` [s]."""
        self._steps_left -= 1
        if self._steps_left == 0:
            self.end_steps(simulation_time)


def parts_of_reason(reason: str) -> set[str]:
    """What the run waits for, part by part; or the whole `reason` to stand still, if it is another."""
    return {*reason.removeprefix("waiting for ").split(", ")}
