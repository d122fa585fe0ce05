"""Those who swim one after the other in what was made for the first of them: in `simulate`, and in a batch."""

import threading

import numpy as np

from .abreast import can_abreast, swim_abreast
from .broadcast import Swimmer
from .leg import CURRENT, ENERGY, FIRST, PLACE, TWIST, ReadyLeg, swim
from .profiles import Profiles, profiles_of
from .simulation import Simulation
from .stopping import SimulationStopped, not_begun

MOST_MEMBERS = 100  # that a thread keeps for a batch
LEAST_ABREAST = 5  # swimmers; fewer are quicker one by one


class Member(Simulation):
    """A body in a scene, at an accuracy and with stations, in which one swimmer after the other swims."""

    def __init__(self, swimmer: Swimmer, x: np.ndarray):
        super().__init__(stations=x, **swimmer._asdict())
        self._at_start = swimmer

    def leg_of(self, swimmer: Swimmer, place, times, works, out, **wanted) -> ReadyLeg:
        """The whole way of `swimmer`, of the same body, scene and accuracy, through `times` (T,) [s] into `works`
        (T, 4) [J] and the profiles of the row `out`; `place` (28,) as in `leg`."""
        self._take_place(swimmer, place)
        return self._leg(place, times, works, out, control=self._control, begin=FIRST, **wanted)

    def _take_place(self, swimmer: Swimmer, place: np.ndarray):
        """Have `swimmer` at its start, in `place` (28,)."""
        if swimmer is not self._at_start:
            self._horizon, self._most_evaluations = swimmer.horizon, swimmer.most_evaluations
            self._prepare(swimmer.law, swimmer.start)
        self._at_start = None
        place[:ENERGY] = self._place[:ENERGY]
        place[TWIST:CURRENT] = self._relative

    def record_of(
        self, swimmer: Swimmer, times, wrench: bool, load: bool, look=None
    ) -> tuple[Profiles, np.ndarray, int, SimulationStopped | None]:
        """The whole way of `swimmer`, as `leg_of` has it, and what it gives as `record` does; look(time [s]) is called
        between two slices. `ValueError` where it cannot be begun."""
        out, works = profiles_of(len(times), len(self.x), wrench, load), np.zeros((len(times), 4))
        place = np.zeros(PLACE)
        with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is reported
            self._take_place(swimmer, place)
        self._place = place
        self._swim_slices(times, works, out, FIRST, wrench, load, look)
        self.kinetic_at_start = float(place[ENERGY])
        if not np.isfinite(self.kinetic_at_start):
            raise not_begun(swimmer.law, SimulationStopped(0.0, "kinetic energy", self.kinetic_at_start, ""))
        return out, works, *self._outcome(times, works, out)

    def swim_into(self, times, out, works, *, wrench: bool, load: bool) -> tuple[int, SimulationStopped | None]:
        """March through `times` (T,) [s] and fill `out` (profiles) and `works` (T, 4) [J]. Returns how many instants
        were reached, and what stopped it."""
        self._started = True
        return self._swim_through(times, works, out, wrench, load)


class Crew(threading.local):
    """The members that a thread has, up to `most`, by body, scene, accuracy and stations: they swim again and again."""

    def __init__(self, most: int = MOST_MEMBERS):
        self._members, self._most = {}, most

    def member(self, swimmer: Swimmer, x: np.ndarray) -> Member:
        """One of the body, scene and accuracy of `swimmer`, with the stations `x` (M,) [m]."""
        key = self._key(swimmer, x)
        member = self._members.get(key)
        if member is None:
            member = Member(swimmer, x)
            if len(self._members) >= self._most:
                self._members.clear()
            self._members[key] = member
        return member

    def dismiss(self, swimmer: Swimmer, x: np.ndarray):
        """Let go of the one of the body, scene and accuracy of `swimmer` with the stations `x`."""
        self._members.pop(self._key(swimmer, x), None)

    @staticmethod
    def _key(swimmer: Swimmer, x: np.ndarray) -> tuple:
        return *swimmer[1:4], x.tobytes()


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
