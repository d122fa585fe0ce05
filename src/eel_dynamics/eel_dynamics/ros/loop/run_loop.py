# SPDX-License-Identifier: Apache-2.0
"""The run loop, in a thread of its own: waits, paces, advances the simulation, and publishes each sample.

Only this thread uses the simulation. Callbacks put requests into `requests`, which are executed between two samples. An
urgent request interrupts the computation of a sample. Once that computation has taken long, any request does.

An executor of rclpy would be too slow: one of its turns takes 140 us of CPU time, as it builds its wait set anew. A
sample with its messages takes 60 us, and the wait in CurvatureInbox 18 us. Besides, a law may need seconds for a
sample, while services must answer, and a publisher whose history is full must wait. A callback group or a timer would
wait in a thread of the executor's pool, and could not be interrupted.
"""

import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from eel_common.ros.loop.clock_ticks import TICK
from eel_common.ros.loop.diagnostics import ERROR, Report
from eel_common.ros.loop.followed_clock import FollowedClock
from eel_common.ros.loop.lateness import Lateness
from eel_common.ros.loop.pacing import Pace
from eel_common.ros.loop.requests import Answer, RequestQueue
from eel_common.ros.serving import reason_of
from eel_gaits.laws.law import Law

from eel_dynamics.ros.curvature_inbox import CurvatureInbox
from eel_dynamics.ros.declaration import Declaration, Sensors
from eel_dynamics.ros.inputs.awaited import MESSAGES
from eel_dynamics.ros.inputs.command_queue import STAND_IN, CommandQueue
from eel_dynamics.ros.inputs.inputs import Inputs
from eel_dynamics.ros.inputs.stamps import on_sample
from eel_dynamics.ros.loop.law_adopter import LawAdopter
from eel_dynamics.ros.loop.next_sample import NextSample
from eel_dynamics.ros.loop.run_gate import RunGate, parts_of_reason
from eel_dynamics.ros.loop.sample_output import SampleOutput, nanoseconds
from eel_dynamics.ros.loop.servo_limit import ServoLimit
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.ros.publishers import Publishers
from eel_dynamics.simulation.simulation import Simulation
from eel_dynamics.simulation.stopping import SimulationStopped


class RunLoop:
    """Publishes samples k = 0 ... `last_sample` of the `simulation`, at times k/rate, paced by the `parameters`.

    While the run waits at its start, it repeats sample 0 ten times a second, so that a controller that answers samples
    begins. It then continues with sample 1, unless a law has changed sample 0 or a subscriber has not received it.

    `run` is the thread's function: it returns after the last sample, or after `requests.stop`. A simulation that has
    stopped waits for a reset; an unattended one (with a duration, as fast as possible) returns and has `given_up`.

    Attributes:
        time: simulation time of the last sample [s].
        samples_published: number of samples, and index of the next one.
        standing: what the simulation waits for, as text; empty while it runs.
        requests: RequestQueue, into which other threads put requests.
        wall_time: [s] spent on samples.
        gate: RunGate. laws: LawAdopter. inputs: Inputs. servo_limit: ServoLimit.
        output: SampleOutput. pace: Pace.
    """

    def __init__(
        self,
        simulation: Simulation,
        parameters: Declaration,
        publishers: Publishers,
        inbox: CurvatureInbox,
        report: Report,
    ) -> None:
        self._simulation, self._parameters, self._publishers = simulation, parameters, publishers
        self._inbox, self._report = inbox, report
        values = parameters.values
        self.requests = RequestQueue(inbox)
        self.gate = RunGate(simulation, publishers, values.wait_for_subscribers)
        self.pace = (FollowedClock if values.follow_clock else Pace)(1.0 / values.rate, values.real_time_factor)
        self._lateness = Lateness(report)
        self.inputs = Inputs(simulation, values, report)
        self.laws = LawAdopter(simulation, self.inputs.awaited, report)
        self.servo_limit = ServoLimit(simulation, report)
        self.output = SampleOutput(simulation, parameters, publishers, report)
        self._next_sample = NextSample(simulation, self.inputs, self.requests)
        self.time, self.samples_published, self.standing = 0.0, 0, ""
        self.wall_time, self._lap = 0.0, time.monotonic()  # _lap: s, steady clock: up to when wall_time counts

    @property
    def overdue(self) -> float:
        """Wall time [s] that the computation of the next sample has taken so far; 0 in a run as fast as possible."""
        return self._next_sample.lasted if self.pace.factor > 0.0 else 0.0

    @property
    def given_up(self) -> bool:
        """The simulation has stopped, and it is unattended: no reset is expected."""
        return self.gate.failed and self.pace.factor == 0.0 and self._parameters.values.duration > 0.0

    # In the run loop's thread.

    def run(self) -> None:
        """Run the loop: the thread's function."""
        self.pace.restart(0, time.monotonic())
        while not self.requests.stopped and self.samples_published <= self._last_sample and not self.given_up:
            try:
                self._turn()
            except SimulationStopped as error:
                self._fail(f"simulation {error}")
            except Exception as error:  # unforeseen: the last good state is kept, and the node continues
                self._fail(f"the run stopped at t = {self.time:g} s: {reason_of(error)}")
                self.requests.wait(TICK)
        self.output.end()
        self._lateness.end(self.time)
        if self.samples_published > self._last_sample:
            self._report.info(f"finished at t = {self.time:g} s")
        self.gate.end_steps(self.time, "the run has ended")

    def _turn(self) -> None:
        """Take samples and requests that have arrived, then wait, or continue with the next sample."""
        for samples in self._inbox.take(self.time):
            samples["time"] = on_sample(samples["time"], self._parameters.values.rate)
            self._execute(self.laws.add_samples, samples, self.pace.period)
        for request in self.requests.take():
            request.answer.give(*self._execute(request.action, *request.arguments))
        if self._parameters.values.servo_torque_limit != self.servo_limit.present:
            self._execute(self._limit_servos, self._parameters.values.servo_torque_limit)
        reason = self._held_by() or self.pace.held_by(self.samples_published)
        if reason:
            self._idle(reason)
        elif self._wait_for_turn():
            self._publish_next()

    def _execute(self, action: Callable[..., None], *arguments: Any) -> tuple[float, str]:
        """Execute `action(*arguments)`; returns the simulation time [s] afterwards, and why it was refused."""
        failure = ""
        try:
            action(*arguments)
        except SimulationStopped as error:
            self._fail(f"simulation {error}")
        except ValueError as error:
            failure = str(error)
        except Exception as error:  # unforeseen: the caller gets the text, and the run continues
            failure = reason_of(error)
            self._report.event("request", f"a request is refused: {failure}", ERROR)
        return self.time, failure

    def _idle(self, reason: str) -> None:
        """Wait for one tick while something holds the run; /clock continues."""
        self._next_sample.forget()
        if reason != self.standing:
            before, self.standing = self.standing, reason
            if not parts_of_reason(reason) <= parts_of_reason(before):  # a shorter list of the same needs no line
                self._report.info(reason)
        now = time.monotonic()
        self.output.clock.repeat(self._stamp, now)
        if self.samples_published == 0 and self.output.start_is_due(now) and self.gate.start_may_be_shown(now):
            self.output.show_start(now)
        self.requests.wait(TICK)

    def _held_by(self) -> str:
        """What holds the run, as text. At the start of a run as fast as possible that includes its awaited inputs."""
        if self.samples_published or self.pace.factor > 0.0:
            return self.gate.held_by(self.time, [], list)
        return self.gate.held_by(self.time, self.inputs.awaited.late(0.0), self._missing)

    def _missing(self) -> list[str]:
        """The inputs that a run as fast as possible waits for before its next sample."""
        timeout = self._parameters.values.subscriber_timeout
        return self.inputs.awaited.missing(self._next_time, time.monotonic(), timeout)

    def _wait_for_turn(self) -> bool:
        """Wait until the next sample is due; False if a request or a tick comes first."""
        now, values = time.monotonic(), self._parameters.values
        if self.standing:
            self._lap = now
        if self.standing or values.real_time_factor != self.pace.factor:
            self.standing = ""
            self.pace.restart(self.samples_published, now, values.real_time_factor)
        next_time = self._next_time
        if self.pace.factor == 0.0 and self.samples_published and self._missing():
            self.output.clock.repeat(self._stamp, now)
            self.requests.wait(TICK)
            return False
        delay = self.pace.due(self.samples_published) - now
        if delay == math.inf:
            self.requests.wait(TICK)
            return False
        if delay > 0.0:
            clock, present = self.output.clock, next_time - delay * self.pace.factor
            clock.go_on(round(present * 1e9), self._stamp, now)
            pause = min(delay, TICK, (clock.next - present) / self.pace.factor)
            return not self.requests.wait(pause) and pause == delay
        return True

    def _publish_next(self) -> None:
        """Advance to the next sample and publish it."""
        if self._next_time > self._simulation.time and not self._next_sample.advance(self._next_time):
            return
        if self.samples_published > 0 or not self.output.start_is_known:
            self.output.publish(self.samples_published, last=self.samples_published == self._last_sample)
        self.time, now = self._next_time, time.monotonic()
        self.wall_time, self._lap = self.wall_time + now - self._lap, now
        self.laws.report_samples(self.time)
        self.inputs.joints.check(self._parameters.values.command_timeout)
        self.inputs.current.look()
        self._lateness.check(self.pace, self.samples_published, self.time, now)
        if self.samples_published > 0:
            self.gate.count_step(self.time)
        self.samples_published += 1

    def _fail(self, reason: str) -> None:
        self.gate.failed = True
        self._next_sample.forget()
        self.gate.end_steps(self.time, reason)
        then = "this run ends here, with status 1" if self.given_up else "reset starts it again"
        self._report.begin("stopped", f"{reason}; {then}", ERROR)

    @property
    def _last_sample(self) -> float:
        return self._parameters.values.last_sample

    @property
    def _next_time(self) -> float:
        return self.samples_published / self._parameters.values.rate

    @property
    def _stamp(self) -> int:
        """Simulation time [ns] of the last sample; before the first one, its own."""
        return nanoseconds(max(0, self.samples_published - 1), self._parameters.values.rate)

    # Requests, executed between two samples.

    def take_law(self, law: Law, origin: float) -> None:
        """Adopt a law whose own t = 0 lies at simulation time `origin` [s]."""
        self.laws.try_law(law, origin)
        self.output.forget_start()

    def take_command(self, queue: CommandQueue, message: Any) -> None:
        """Put the command in a `message` into a `queue`; log a refusal."""
        try:
            stamp, values = queue.read(message)
            queue.add(on_sample(stamp, self._parameters.values.rate), values)
        except ValueError as error:
            self._report.event(queue.topic, f"{MESSAGES[queue.topic]} refused: {error}", ERROR, differing=True)

    def _limit_servos(self, torque: float) -> None:
        self.servo_limit.change(torque)
        self.output.forget_start()

    def pause(self, paused: bool) -> None:
        """Pause the run, or continue it."""
        self.gate.pause(paused, self.time)

    def hold(self, reason: str) -> None:
        """Hold the run for a `reason`, before its next sample; continue it with an empty one."""
        self.gate.held = reason

    def step(self, samples: int, steps: Answer) -> None:
        """Publish this number of `samples` of a paused run, besides sample 0. `steps` is answered with the last."""
        self.gate.begin_steps(samples, steps, self.time)

    def set_state(self, position: np.ndarray, orientation: np.ndarray, twist: np.ndarray) -> None:
        """Set the state of the head, as `Simulation.set_state` does."""
        self._simulation.set_state(position, orientation, twist)
        self.output.change_state()

    def reset(
        self,
        simulation: Simulation | None = None,
        values: DynamicsParameters | None = None,
        sensors: Sensors = (),
    ) -> None:
        """Reset state and time to the start, and keep the law. `ValueError` if the law cannot begin there.

        simulation, values, sensors: of a run with changed parameters.
        """
        law = self._simulation.law
        try:
            if simulation is None:
                self._simulation.reset(keep_law=law != STAND_IN)
            elif law is not None and law != STAND_IN:
                simulation.adopt(law)
        except ValueError as error:  # a law that could be blended into may not begin from the initial state
            self._report.event("reset", f"reset refused: {error}", ERROR)
            raise
        self.gate.end_steps(self.time, "the run was reset")
        if simulation is not None and values is not None:
            self._parameters.begin(values, simulation.scene, sensors)
            self._publishers.begin(simulation)
            self._simulation = self._next_sample.simulation = self.gate.simulation = self.laws.simulation = simulation
            self.servo_limit.begin(simulation)
            self.pace.period = 1.0 / values.rate
        self._lateness.end(self.time)
        now = time.monotonic()
        self.time, self.samples_published = 0.0, 0
        self.gate.failed = False
        self._next_sample.forget()
        self.output.restart(self._simulation)
        self.wall_time, self._lap = 0.0, now
        self._report.end("stopped")
        self.pace.restart(0, now)
        self.laws.reset()
        self.inputs.begin(self._simulation, self._parameters.values)
        self._report.info("reset to t = 0 s")
