"""Runs of the simulation, each a recording of its own: a stamp that goes back begins the next one.

Topics reach a reset one by one, in any order; so each topic has its own place in the row of runs, and a run is closed
once every topic that was in it has gone on. What is valid at all times (the body, the law) is given to each new one.
"""

import threading
import time
from collections import deque
from collections.abc import Callable

from eel_viz.messages import Body, Status
from eel_viz.recording.delivery import Flow
from eel_viz.recording.destination import Destination, Say
from eel_viz.recording.loggers import Loggers

RETRY = 2.0  # s of wall time between two attempts at an absent viewer
WALL_TIME = 10**17  # ns: later stamps are no simulation time
MOST_RUNS, MINUTE = 10, 60.0  # recordings that may begin within so many seconds; each takes memory and time to end
RESETS, SPAN = 3, 10.0  # so many resets within so many seconds, with several publishers: not a reset


class Run:
    """One run: the loggers of each destination that is there."""

    def __init__(self, number: int) -> None:
        self.number = number
        self.loggers: dict[int, Loggers] = {}  # by the destination's place in the list
        self.flows: dict[int, Flow] = {}
        self.latest = 0  # ns

    def give_up(self, place: int) -> None:
        """Leave the stream of the destination at `place`, whose other end has gone: to end it can take seconds."""
        self.loggers.pop(place, None)
        flow = self.flows.pop(place, None)
        if flow is not None:
            threading.Thread(target=flow.close, daemon=True).start()

    def attend(self) -> bool:
        """Send what has waited, and see whether it arrives. A viewer that has gone is forgotten, and may come back.

        Whether a file was lost.
        """
        for place, flow in list(self.flows.items()):
            if flow.runs:
                self.loggers[place].attend()
            flow.attend()
            if flow.gone:
                self.give_up(place)
        return any(flow.lost for flow in self.flows.values())

    def close(self) -> None:
        """Complete the recordings."""
        for place, flow in self.flows.items():
            if flow.runs:
                self.loggers[place].send()
            flow.close()
        self.loggers.clear()


class Runs:
    """Hands each message to the loggers of its run.

    `crowded(topic)` says whether more than one publisher is there, whose stamps would go back and forth.
    """

    def __init__(
        self,
        destinations: list[Destination],
        name: str,
        warn: Say,
        crowded: Callable[[str], bool] = lambda topic: False,
    ) -> None:
        self._destinations, self._name, self._warn, self._crowded = destinations, name, warn, crowded
        self._place: dict[str, tuple[int, int]] = {}  # topic: number of its run, last stamp
        self._body: Body | None = None
        self._law: str | None = None
        self._told_other: dict[str, tuple] = {}  # method: its arguments
        self._statuses: tuple[int, list[Status]] = (0, [])
        self._resets: deque[float] = deque(maxlen=RESETS)
        self._begun: deque[float] = deque(maxlen=MOST_RUNS)  # s, when each of the last runs began
        self._told_many = False
        self._tried = time.monotonic()
        self._warned = False
        self.lost = False  # a file that lacks a part of its run
        self._runs: dict[int, Run] = {}
        self._begin(1)

    @property
    def latest(self) -> int:
        """Newest stamp of the newest run [ns]."""
        return self._newest.latest

    def at(self, topic: str, stamp: int, *, successor: bool = False) -> list[Loggers]:
        """The loggers that a message of `topic` with `stamp` [ns] goes to; `successor`: it is the first one of another
        publisher."""
        number, last = self._place.get(topic, (self._newest.number, stamp))
        goes_on = stamp >= last and not successor
        if not goes_on:
            if self._disorder(topic):
                return []
            if number + 1 in self._runs or self._may_begin(_reason(topic, last, stamp)):
                number += 1
            else:
                goes_on = True
        self._place[topic] = (number, stamp)
        if not goes_on:
            self._close_before(min(place for place, _ in self._place.values()))
        run = self._runs[number]
        run.latest = max(run.latest, stamp)
        return [loggers for place, loggers in run.loggers.items() if run.flows[place].runs]

    def body(self, body: Body) -> None:
        """The body, for this run and those to come."""
        self._body = body
        for loggers in self._newest.loggers.values():
            loggers.body(body)

    def law(self, name: str) -> None:
        """The law that was published last."""
        self._law = name
        for loggers in self._newest.loggers.values():
            loggers.law(self.latest, name)

    def diagnostics(self, stamp: int, statuses: list[Status]) -> None:
        """Statuses at `stamp` [ns]; if that is wall time, at the newest time there is."""
        self._statuses = (stamp if stamp < WALL_TIME else self.latest, statuses)
        for loggers in self._newest.loggers.values():
            loggers.diagnostics(*self._statuses)

    def tell_other(self, method: str, *values) -> None:
        """What is valid at all times of the other swimmer: `method` of `Comparison.other` and its arguments."""
        self._told_other[method] = values
        for loggers in self._newest.loggers.values():
            getattr(loggers.other, method)(*values)

    def attend(self) -> None:
        """Now and then: send what has waited, see whether all arrives, and try the destinations that were not there."""
        for run in self._runs.values():
            self.lost |= run.attend()
        if time.monotonic() - self._tried > RETRY:
            self._tried = time.monotonic()
            for place, destination in enumerate(self._destinations):
                if destination.lost():
                    for run in self._runs.values():
                        run.give_up(place)
            self._open_missing(self._newest)

    def close(self) -> None:
        """End all runs, and then the servers."""
        for run in self._runs.values():
            run.close()
            self.lost |= any(flow.lost for flow in run.flows.values())
        self._runs.clear()
        for destination in self._destinations:
            self.lost |= destination.incomplete
            destination.close()

    @property
    def _newest(self) -> Run:
        return self._runs[max(self._runs)]

    def _may_begin(self, reason: str) -> bool:
        """Begin the next recording, unless too many have begun of late."""
        now = time.monotonic()
        if len(self._begun) == MOST_RUNS and now - self._begun[0] < MINUTE:
            if not self._told_many:
                self._told_many = True
                self._warn(
                    f"{reason}, after {MOST_RUNS} recordings within {MINUTE:g} s: what comes goes into the present one "
                    "until that is over"
                )
            return False
        self._told_many = False
        self._warn(f"{reason}: a new recording begins")
        self._begin(self._newest.number + 1)
        return True

    def _begin(self, number: int) -> None:
        self._begun.append(time.monotonic())
        run = Run(number)
        self._open_missing(run)
        self._runs[number] = run

    def _open_missing(self, run: Run) -> None:
        for place, destination in enumerate(self._destinations):
            if place in run.loggers:
                continue
            stream = destination.open(run.number, self._name if run.number == 1 else f"{self._name} {run.number}")
            if stream is None:
                continue
            loggers = Loggers(stream, destination.settings, destination.rates, self._name)
            run.flows[place] = Flow(stream, destination, destination.file(run.number))
            run.loggers[place] = loggers
            if self._body is not None:
                loggers.body(self._body)
            if self._law is not None:
                loggers.law(run.latest, self._law)
            loggers.diagnostics(run.latest, self._statuses[1])
            for method, values in self._told_other.items():
                getattr(loggers.other, method)(*values)

    def _close_before(self, number: int) -> None:
        for each in [each for each in self._runs if each < number]:
            self._runs.pop(each).close()

    def _disorder(self, topic: str) -> bool:
        """Whether stamps go back because several publishers send on `topic`, rather than by a reset."""
        now = time.monotonic()
        place = self._place[topic][0]
        if place < self._newest.number:
            return False  # catching up with a reset that another topic has seen
        often = len(self._resets) == RESETS and now - self._resets[0] < SPAN
        if often and self._crowded(topic):
            if not self._warned:
                self._warn(
                    f"stamps of {topic} go back and forth, it has more than one publisher: older ones are left out"
                )
                self._warned = True
            return True
        self._resets.append(now)
        return False


def _reason(topic: str, last: int, stamp: int) -> str:
    """Why a message does not belong to the run of the one before, whose stamp was `last` [ns]."""
    if stamp < last:
        return f"stamps of {topic} went back from {last / 1e9:g} s to {stamp / 1e9:g} s"
    return f"another node publishes {topic} from {stamp / 1e9:g} s on"


class OtherRuns:
    """The same runs, for the messages of the swimmer in the namespace `space` that they are compared with."""

    def __init__(self, runs: Runs, space: str) -> None:
        self._runs, self._space = runs, space

    def at(self, topic: str, stamp: int, *, successor: bool = False) -> list:
        """As `Runs.at`."""
        return [loggers.other for loggers in self._runs.at(f"{self._space}/{topic}", stamp, successor=successor)]

    def body(self, body: Body) -> None:
        """As `Runs.body`."""
        self._runs.tell_other("body", body)

    def law(self, name: str) -> None:
        """As `Runs.law`."""
        self._runs.tell_other("law", 0, name)

    def diagnostics(self, stamp: int, statuses: list[Status]) -> None:
        """As `Runs.diagnostics`."""
        self._runs.tell_other("diagnostics", stamp if stamp < WALL_TIME else self._runs.latest, statuses)

    def attend(self) -> None:
        """Nothing: `Runs` does it."""

    def close(self) -> None:
        """Nothing: `Runs` does it."""
