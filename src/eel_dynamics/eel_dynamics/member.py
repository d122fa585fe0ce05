"""One swimmer of a batch: a `Simulation` that is marched straight into the batch's arrays."""

from eel_gaits.law import Law

from .profiles import Profiles
from .simulation import Simulation, SimulationStopped


class Member(Simulation):
    """As `Simulation` with `law` adopted. `ValueError` names what does not fit."""

    def __init__(self, law: Law, **arguments):
        super().__init__(law=law, **arguments)

    def swim_into(
        self, times, out: Profiles, works, *, wrench: bool, load: bool
    ) -> tuple[int, SimulationStopped | None]:
        """March through `times` (T,) [s] and fill `out` and `works` (T, 4) [J]. Returns how many instants were reached,
        and what stopped it."""
        self._started = True
        return self._swim_through(times, works, out, wrench, load)
