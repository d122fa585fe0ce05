# SPDX-License-Identifier: Apache-2.0
"""The run loop, in a thread of its own: waits, paces, advances the simulation, and publishes each sample.

Only this thread uses the simulation. Other threads make requests (run_requests.py), which are executed between two
samples. An urgent request interrupts the computation of a sample, and so does any request once that has taken long.
No ROS is imported: `publishers` and `report` come from the node.
"""

import math
import time

from eel_base.wording import one_line

from eel_dynamics.ros.diagnostics import ERROR
from eel_dynamics.ros.loop.clock_ticks import TICK
from eel_dynamics.ros.loop.law_feed import LawAdopter
from eel_dynamics.ros.loop.obstacles import Obstacles
from eel_dynamics.ros.loop.pacing import ControllerWait, Pace, Stopwatch
from eel_dynamics.ros.loop.request_queue import RequestQueue, WakeUp
from eel_dynamics.ros.loop.run_requests import NewRun, RunRequests
from eel_dynamics.ros.loop.sample_output import SampleOutput, nanoseconds
from eel_dynamics.simulation.stopping import SimulationStopped


class RunLoop:
    """Publishes samples k = 0 ... `last_sample` of the `simulation`, at times k/rate, paced by the `parameters`.

    While the run stands at its start, it repeats sample 0 ten times a second, so that a controller that answers samples
    begins. It goes on with sample 1, unless a law changes sample 0, or a subscriber has not had it.

    `run` is the thread's function: it returns after the last sample, or after `requests.stop`. A simulation that has
    stopped waits for a reset; an unattended one (with a duration, as fast as possible) returns and has `given_up`.
    on_subscribers_complete: called when the subscribers that the run waits for are there. inbox: has `poll()`, which
    passes samples that have come to `requests.take_samples`, and the methods of `WakeUp`. pace: the kind of `Pace`.

    Attributes:
        time: simulation time of the last sample [s].
        samples_published: number of samples, which is the index of the next one.
        standing: what the simulation waits for, as text; empty while it runs.
        requests: RunRequests, for other threads.
        obstacles: Obstacles. laws: LawAdopter. output: SampleOutput. pace: Pace. wall_time: Stopwatch.
    """

    def __init__(
        self,
        simulation,
        parameters,
        publishers,
        report,
        on_subscribers_complete=lambda: None,
        inbox=None,
        pace: type[Pace] = Pace,
    ):
        self._simulation, self._parameters, self._report = simulation, parameters, report
        self.obstacles = Obstacles(simulation, publishers, parameters.wait_for_subscribers, on_subscribers_complete)
        self._queue = RequestQueue(inbox or WakeUp())
        self.requests = RunRequests(self, self._queue, report)
        self._poll = inbox.poll if inbox is not None else lambda: None
        self.pace = pace(1.0 / parameters.rate, parameters.real_time_factor)
        self.laws, self.wall_time = LawAdopter(simulation, report), Stopwatch()
        self._controller = ControllerWait(lambda s: self.laws.report_missing(self._next_time, self.pace.period, s))
        self.output = SampleOutput(simulation, parameters.rate, parameters.clock_rate, publishers, report)
        self.output.torque_limit = parameters.torque_limit
        self._sample_begun: float | None = None  # s, steady clock: when the computation of the next sample began
        self.time, self.samples_published, self.standing = 0.0, 0, ""

    @property
    def overdue(self) -> float:
        """Wall time [s] that the computation of the next sample has taken so far; 0 in a run as fast as possible."""
        since = self._sample_begun
        return time.monotonic() - since if since is not None and self.pace.factor > 0.0 else 0.0

    @property
    def given_up(self) -> bool:
        """The simulation has stopped, and it is unattended: no reset is expected."""
        return self.obstacles.failed and self.pace.factor == 0.0 and self._parameters.duration > 0.0

    # In the run loop's thread.

    def run(self):
        """Run the loop: the thread's function."""
        self.pace.restart(0, time.monotonic())
        while not self._queue.stopped and self.samples_published <= self._parameters.last_sample and not self.given_up:
            self._poll()
            self._queue.carry_out(self._perform)
            obstacle = self.obstacles.find(self.time) or self.pace.obstacle(self.samples_published)
            if obstacle:
                self._idle(obstacle)
            elif self._wait_for_turn():
                self._next_sample()
        self.output.end()
        if self.samples_published > self._parameters.last_sample:
            self._report.info(f"finished at t = {self.time:g} s")
        self.obstacles.end_steps(self.time, "the run has ended")

    def _perform(self, action) -> tuple[float, str]:
        """Execute a request's action; returns the simulation time [s] afterwards, and why it was refused."""
        try:
            action()
        except SimulationStopped as error:
            self._fail(error)
        except ValueError as error:
            return self.time, str(error)
        except Exception as error:  # unforeseen: whoever asked is told, and the run goes on
            failure = f"{type(error).__name__}: {one_line(error)}"
            self._report.event("request", f"a request is refused: {failure}", ERROR)
            return self.time, failure
        return self.time, ""

    def _idle(self, obstacle: str):
        """Wait for one tick while there is an obstacle; /clock continues."""
        self._sample_begun = None
        if obstacle != self.standing:
            self.standing = obstacle
            self._report.info(obstacle)
        now = time.monotonic()
        self.output.clock.repeat(self._stamp, now)
        if self.samples_published == 0 and self.output.start_is_due(now) and self.obstacles.start_may_be_shown(now):
            try:
                self.output.show_start(now)
            except SimulationStopped as error:
                self._fail(error)
        self._queue.wait(TICK)

    def _wait_for_turn(self) -> bool:
        """Wait until the next sample is due; False if a request or a tick comes first."""
        now = time.monotonic()
        if self.standing:
            self.standing = ""
            self.pace.restart(self.samples_published, now)
            self.wall_time.resume(now)
        missing = self.pace.factor == 0.0 and self.laws.lacks_samples(self._next_time)
        if self._controller.waits(missing, now, self._parameters.subscriber_timeout):
            self.output.clock.repeat(self._stamp, now)
            self._queue.wait(TICK)
            return False
        delay = self.pace.due(self.samples_published) - now
        if delay == math.inf:
            self._queue.wait(TICK)
            return False
        if delay > 0.0:
            clock, present = self.output.clock, self._next_time - delay * self.pace.factor
            clock.go_on(round(present * 1e9), self._stamp, now)
            pause = min(delay, TICK, (clock.next - present) / self.pace.factor)
            return not self._queue.wait(pause) and pause == delay
        return True

    def _next_sample(self):
        """Advance to the next sample and publish it."""
        try:
            if self._next_time > self._simulation.time and not self._advance():
                return
            if self.samples_published > 0 or not self.output.start_is_known:
                last = self.samples_published == self._parameters.last_sample
                self.output.publish(self.samples_published, last)
        except SimulationStopped as error:
            self._fail(error)
            return
        self.time, now = self._next_time, time.monotonic()
        self.wall_time.lap(now)
        self.laws.report_samples(self.time)
        delay = self.pace.give_up_delay(self.samples_published, now)
        if delay > 0.0:
            lost, given_up = self.pace.lost(self.samples_published), self.pace.given_up
            more = f"; {given_up:.3g} s more are given up" if given_up > 0.0 else ""
            self._report.event(
                "late", f"late by {lost:.3g} s at t = {self.time:g} s: accuracy is kept, not the pace{more}"
            )
        if self.samples_published > 0:
            self.obstacles.count_step(self.time)
        self.samples_published += 1

    def _advance(self) -> bool:
        """Advance to the next sample; False if a request or the end of the run interrupts it."""
        if self._sample_begun is None:
            self._sample_begun = time.monotonic()
        since, queue = self._sample_begun, self._queue
        reached = self._simulation.advance(self._next_time, lambda: queue.interrupt(since))
        if reached:
            self._sample_begun = None
        return reached

    def _fail(self, error: SimulationStopped):
        self.obstacles.failed, self._sample_begun = True, None
        self.obstacles.end_steps(self.time, f"simulation {error}")
        then = "this run ends here, with status 1" if self.given_up else "reset starts it again"
        self._report.begin("stopped", f"simulation {error}; {then}", ERROR)

    @property
    def _next_time(self) -> float:
        return self.samples_published / self._parameters.rate

    @property
    def _stamp(self) -> int:
        """Simulation time [ns] of the last sample; before the first one, its own."""
        return nanoseconds(max(0, self.samples_published - 1), self._parameters.rate)

    # Requests, executed between two samples.

    def adopt(self, law, origin: float):
        """Adopt a law whose own t = 0 lies at simulation time `origin` [s]."""
        self.laws.adopt(law, origin)
        self.output.forget_start()

    def change(self, parameters):
        """Apply `parameters`; only the changeable ones may differ."""
        self._parameters = parameters
        self.output.torque_limit = parameters.torque_limit
        if parameters.real_time_factor != self.pace.factor:
            self.pace.restart(self.samples_published, time.monotonic(), parameters.real_time_factor)

    def set_state(self, position, orientation, twist):
        """Put the head elsewhere, as `Simulation.set_state` does."""
        self._simulation.set_state(position, orientation, twist)
        self.output.change_state()

    def reset(self, new: NewRun | None):
        """Reset state and time to the start, of a `new` run if it is given. `ValueError` if the law cannot begin."""
        try:
            if new is None:
                self._simulation.reset()
            elif self._simulation.law is not None:
                new.simulation.adopt(self._simulation.law)
        except ValueError as error:  # a law that could be blended into may not begin from the initial state
            self._report.event("reset", f"reset refused: {error}", ERROR)
            raise
        self.obstacles.end_steps(self.time, "the run was reset")
        if new is not None:
            self._begin(new)
        now = time.monotonic()
        self.time, self.samples_published = 0.0, 0
        self.obstacles.failed, self._sample_begun = False, None
        self.output.restart(self._simulation)
        self.wall_time.restart(now)
        self._report.end("stopped")
        self.pace.restart(0, now)
        self.laws.reset()
        self._report.info("reset to t = 0 s")

    def _begin(self, new: NewRun):
        """Change to a new run."""
        self._parameters = new.parameters
        self._simulation = self.obstacles.simulation = self.laws.simulation = new.simulation
        self.pace.period, self.output.rate = 1.0 / new.parameters.rate, new.parameters.rate
        self.output.clock.rate, self.output.torque_limit = new.parameters.clock_rate, new.parameters.torque_limit
        new.begin()
