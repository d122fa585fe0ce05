"""The run, in a thread of its own: waits, paces, advances the simulation, has each sample published.

Everything that touches the simulation happens in this thread. What other threads want of it are orders, carried out
between two samples. An urgent order is carried out on the way to a sample too, and so is any other where that takes
long. No ROS here: `publishers` and `report` come from the node.
"""

import math
import threading
import time
from collections import deque

from eel_gaits.wording import shown

from .accounts import Accounts
from .pacing import Bell, Pace
from .report import ERROR
from .stopping import SimulationStopped
from .watch import Watch

TICK = 0.05  # s of wall time between two messages on /clock while the simulation stands
PATIENCE = 1.0  # s of wall time on the way to a sample, after which every order is urgent
UNFIT = ValueError, ArithmeticError, MemoryError  # what laws and samples are refused for
MOST_WAITING = 10_000  # orders


class Order:
    """What another thread wants of the march, which does it between two samples."""

    def __init__(self, action, replaces: str = ""):
        self.action, self.replaces = action, replaces
        self.done = threading.Event()
        self.time = math.nan  # s: simulation time when it had been done


class March:
    """Publishes samples k = 0 ... `last_sample` at k/rate of the `simulation`, at the pace asked for.

    `run` is the thread's work: it returns after the last sample, or once `stop` is called. A run that cannot go on
    waits for a reset; one with a duration and without a pace, which nobody attends, returns, and has `failed`.
    """

    def __init__(self, simulation, parameters, publishers, report, greet=lambda: None):
        self._simulation, self._parameters, self._publishers, self._report = simulation, parameters, publishers, report
        self._greet = greet  # those who were waited for, before the first sample
        self._pace = Pace(1.0 / parameters.rate, parameters.real_time_factor)
        self._guard, self._bell = threading.Lock(), Bell()
        self._orders = deque()
        self._sample = 0  # index of the next one
        self._paused = self.failed = False
        self.standing = ""  # what the simulation waits for, in words
        self._last_tick = -math.inf
        self._audience_complete = parameters.wait_for_subscribers == 0
        self._origin = 0.0
        self._silent_since = None  # s, steady clock: since when a controller's next samples are waited for
        self._account_due = True
        self.stopped = False
        self.accounts, self._watch = Accounts(), Watch(simulation, report)
        self.time = 0.0  # s: simulation time of the last sample
        self._urgent = False  # an order does not wait for the next sample
        self._set_out = None  # s, steady clock: since when the next sample is under way
        self.marched_for = 0.0  # s: wall time spent marching, so without standing
        self._marked = time.monotonic()

    # What other threads may call.

    def order(self, action, replaces: str = "", urgent: bool = False) -> Order:
        """Has `action()` done between two samples, or at once if it is `urgent`, after the orders before it.

        It takes the place of the order given just before if that `replaces` the same.
        """
        order = Order(action, replaces)
        with self._guard:
            if replaces and self._orders and self._orders[-1].replaces == replaces:
                self._orders.pop()
            self._orders.append(order)
            self._urgent |= urgent
            self._bell.ring()
        return order

    def take_law(self, law, origin: float):
        """Adopts a law whose own t = 0 lies at simulation time `origin` [s]; of several before a sample the last."""
        self.order(lambda: self._adopt(law, origin), "law")

    def take_samples(self, samples: dict):
        """Adds one instant of a law, the arguments of `Simulation.add_samples`; none while too much waits."""
        if len(self._orders) < MOST_WAITING:
            self.order(lambda: self._add_samples(samples))
        else:
            text = f"curvature samples refused: at most {MOST_WAITING} wait for the next sample"
            self._report.event("samples", text, ERROR)

    def reset(self) -> Order:
        """State and time to the start."""
        return self.order(self._reset, urgent=True)

    def pause(self, paused: bool) -> Order:
        """Stands still, or goes on."""
        return self.order(lambda: setattr(self, "_paused", paused), urgent=True)

    def change(self, parameters):
        """Other parameters, of those that may change during the run."""
        self.order(lambda: self._change(parameters))

    def account(self):
        """Asks for a snapshot with all that the accounts hold, whether or not someone hears it."""
        self._account_due = True

    def stop(self):
        """Ends the run."""
        with self._guard:
            self.stopped = True
            self._bell.ring()

    @property
    def law(self) -> str:
        """Name of what the swimmer follows."""
        simulation = self._simulation
        if simulation.sampled or simulation.resting:
            return "curvature_samples"
        return simulation.law.name if simulation.law is not None else ""

    @property
    def overdue(self) -> float:
        """Wall time [s] for which the next sample has been under way, of a run with a pace."""
        since = self._set_out
        return time.monotonic() - since if since is not None and self._pace.factor > 0.0 else 0.0

    @property
    def samples_published(self) -> int:
        return self._sample

    @property
    def lost_time(self) -> float:
        """Wall time [s] by which the run is behind its pace."""
        return self._pace.lost

    @property
    def given_up(self) -> bool:
        """The simulation has stopped, and nobody is expected to reset it."""
        return self.failed and self._pace.factor == 0.0 and self._parameters.duration > 0.0

    # The thread itself.

    def run(self):
        """The thread's work."""
        self._pace.restart(0, time.monotonic())
        while not self.stopped and self._sample <= self._parameters.last_sample and not self.given_up:
            self._carry_out_orders()
            obstacle = self._obstacle()
            if obstacle:
                self._stand(obstacle)
            elif self._wait_for_turn():
                self._next_sample()

    def _obstacle(self) -> str:
        """What keeps the simulation from its next sample, in words; empty if nothing does."""
        if self.failed:
            return f"stopped at t = {self.time:g} s until it is reset"
        if not self._simulation.ready:
            return "waiting for a law"
        wanted = self._parameters.wait_for_subscribers
        if not self._audience_complete:
            self._audience_complete = self._publishers.audience_complete(wanted, time.monotonic())
            if not self._audience_complete:
                return f"waiting for {wanted} subscriber{'s' if wanted > 1 else ''}"
            self._greet()
        return f"paused at t = {self.time:g} s" if self._paused else ""

    def _stand(self, obstacle: str):
        """Waits a little for the obstacle to go; /clock ticks on."""
        now, self._set_out = time.monotonic(), None
        if obstacle != self.standing:
            self.standing = obstacle
            self._report.info(obstacle)
        self._tick(now)
        self._wait(TICK)

    def _wait_for_turn(self) -> bool:
        """Waits until the next sample is due, or something comes in between: then False."""
        now = time.monotonic()
        if self.standing:
            self.standing = ""
            self._pace.restart(self._sample, now)
            self._marked = now
        if self._samples_missing(now):
            self._tick(now)
            self._wait(TICK)
            return False
        delay = self._pace.due(self._sample) - now
        if delay > 0.0:
            self._tick(now)
            return not self._wait(min(delay, TICK)) and delay <= TICK
        return True

    def _samples_missing(self, now: float) -> bool:
        """Whether to wait, without a pace, for the controller that drives: a while, then no more until it is back."""
        until = self._simulation.samples_until
        if self._pace.factor > 0.0 or until is None or until >= self._next_time or self._simulation.resting:
            self._silent_since = None
            return False
        if self._silent_since is None:
            self._silent_since = now
        return now - self._silent_since < self._parameters.subscriber_timeout

    def _next_sample(self):
        """Advances to the next sample and has it published."""
        simulation, publishers = self._simulation, self._publishers
        try:
            if self._next_time > simulation.time and not self._advance():
                return
            due, self._account_due = self._account_due or self._sample == self._parameters.last_sample, False
            parts = {part: wanted or due for part, wanted in publishers.wanted_parts().items()}
            snapshot = simulation.observe(**parts)
            self.accounts.add(snapshot)
            self._watch.add(snapshot, look=due)
        except SimulationStopped as error:
            self._fail(error)
            return
        self.time = self._next_time
        publishers.publish(snapshot, self._stamp(self._sample))
        now = self._last_tick = time.monotonic()
        self.marched_for, self._marked = self.marched_for + now - self._marked, now
        self._report_resting()
        self._report_delay(now)
        self._sample += 1

    def _advance(self) -> bool:
        """Marches to the next sample; False where an order comes in between, or the end of the run."""
        if self._set_out is None:
            self._set_out = time.monotonic()
        set_out = self._set_out

        def interrupted() -> bool:
            return self.stopped or self._urgent or (self._orders and time.monotonic() - set_out > PATIENCE)

        try:
            reached = self._simulation.advance(self._next_time, interrupted)
        except SimulationStopped:
            self._set_out = None
            raise
        if reached:
            self._set_out = None
        return reached

    def _fail(self, error: SimulationStopped):
        self.failed = True
        then = "this run ends here, with status 1" if self.given_up else "reset starts it again"
        self._report.begin("stopped", f"simulation {error}; {then}", ERROR)

    @property
    def _next_time(self) -> float:
        return self._sample / self._parameters.rate

    def _stamp(self, sample: int) -> int:
        return round(sample * 1e9 / self._parameters.rate)

    def _tick(self, now: float):
        if now - self._last_tick >= TICK:
            self._last_tick = now
            self._publishers.tick(self._stamp(max(0, self._sample - 1)))

    def _wait(self, seconds: float) -> bool:
        """Sleeps, unless an order comes or the run is stopped: then True."""
        with self._guard:
            if self._orders or self.stopped:
                return True
            self._bell.hush()
        return self._bell.wait(seconds)

    def _carry_out_orders(self):
        self._urgent = False  # before the orders are counted, so that none is missed
        for _ in range(len(self._orders)):  # those that come meanwhile wait for the next sample
            with self._guard:
                order = self._orders.popleft()
            order.action()
            order.time = self.time
            order.done.set()

    def _adopt(self, law, origin: float):
        simulation = self._simulation
        driven = simulation.law is not None and simulation.samples_until is None and not simulation.resting
        if driven and law == simulation.law and origin == self._origin:
            return  # published again: nothing to blend
        try:
            simulation.adopt(law, origin=origin)
        except UNFIT as error:
            self._report.event("law", f"law {shown(law.name)} refused: {error}", ERROR, differing=True)
        except SimulationStopped as error:
            self._fail(error)
        else:
            self._origin = origin
            self._report.end("resting")
            self._report.note("law taken on", f"law {shown(law.name)} taken on at t = {simulation.time:g} s")

    def _add_samples(self, samples: dict):
        simulation = self._simulation
        try:
            simulation.add_samples(**samples)
        except UNFIT as error:
            self._report.event("samples", f"curvature samples refused: {error}", ERROR)

    def _change(self, parameters):
        self._parameters = parameters
        self._pace.restart(self._sample, time.monotonic(), parameters.real_time_factor)

    def _reset(self):
        self._sample, self.time, self._origin, self._set_out = 0, 0.0, 0.0, None
        self.failed = False
        self.accounts = Accounts()
        self._watch.restart()
        self.marched_for, self._marked = 0.0, time.monotonic()
        self._report.end("stopped")
        self._report.end("resting")
        self._pace.restart(0, time.monotonic())
        try:
            self._simulation.reset()
        except SimulationStopped as error:
            self._fail(error)
        else:
            self._report.info("reset to t = 0 s")

    def _report_resting(self):
        if self._simulation.resting:
            self._report.begin("resting", f"curvature samples have run out at t = {self.time:g} s: coming to rest")
        elif self._report.lasts("resting"):
            self._report.end("resting", f"curvature samples are back at t = {self.time:g} s")

    def _report_delay(self, now: float):
        delay = self._pace.settle(self._sample, now)
        if delay > 0.0:
            self._report.event("late", f"late by {delay:.3g} s at t = {self.time:g} s: accuracy is kept, not the pace")
