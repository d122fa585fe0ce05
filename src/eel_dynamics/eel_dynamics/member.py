"""Those of a batch that swim one after the other in one call of the loops."""

import threading

import numpy as np

from .abreast import can_abreast, swim_abreast
from .broadcast import Swimmer
from .leg import CURRENT, ENERGY, FIRST, TWIST, ReadyLeg, swim
from .simulation import Simulation
from .stopping import SimulationStopped

MOST_MEMBERS = 100  # that a thread keeps
LEAST_ABREAST = 5  # swimmers; fewer are quicker one by one


class Member(Simulation):
    """A body in a scene, at an accuracy and with stations, in which one swimmer after the other swims."""

    def __init__(self, swimmer: Swimmer, x: np.ndarray):
        super().__init__(stations=x, **swimmer._asdict())
        self._at_start = swimmer

    def leg_of(self, swimmer: Swimmer, place, times, works, out, **wanted) -> ReadyLeg:
        """The whole way of `swimmer`, of the same body, scene and accuracy, through `times` (T,) [s] into `works`
        (T, 4) [J] and the profiles of the row `out`; `place` (28,) as in `leg`."""
        if swimmer is not self._at_start:
            self._prepare(swimmer.law, swimmer.start)
        self._at_start = None
        place[:ENERGY] = self._place[:ENERGY]
        place[TWIST:CURRENT] = self._relative
        return self._leg(place, times, works, out, begin=FIRST, **wanted)

    def swim_into(self, times, out, works, *, wrench: bool, load: bool) -> tuple[int, SimulationStopped | None]:
        """March through `times` (T,) [s] and fill `out` (profiles) and `works` (T, 4) [J]. Returns how many instants
        were reached, and what stopped it."""
        self._started = True
        return self._swim_through(times, works, out, wrench, load)


class Crew(threading.local):
    """The members that a thread has, by body, scene and accuracy: they swim again and again."""

    def __init__(self):
        self._members: dict = {}

    def member(self, swimmer: Swimmer, x: np.ndarray) -> Member:
        """One of the body, scene and accuracy of `swimmer`, with the stations `x` (M,) [m], the same for the same
        body."""
        member = self._members.get(swimmer[1:4])
        if member is None:
            member = Member(swimmer, x)
            if len(self._members) >= MOST_MEMBERS:
                self._members.clear()
            self._members[swimmer[1:4]] = member
        return member

    def dismiss(self, swimmer: Swimmer):
        """Let go of the one of the body, scene and accuracy of `swimmer`."""
        self._members.pop(swimmer[1:4], None)


def swim_together(legs: list[ReadyLeg]):
    """Swim all of them, in one call: Python's lock is let go once. Before it, where enough of one body and method can,
    they swim abreast."""
    if not legs:
        return
    rows, groups = np.array([leg.row for leg in legs]), {}
    for index, leg in enumerate(legs):
        if can_abreast(leg):
            groups.setdefault((leg.swimmer, leg.method), []).append(index)
    for group in groups.values():
        if len(group) >= LEAST_ABREAST:
            some = rows[group]
            swim_abreast([legs[index] for index in group], some)
            rows[group] = some
    swim(rows)


__all__ = ["Crew", "Member", "swim_together"]
