"""One swimmer of a batch: a `Simulation` that is marched straight into the batch's arrays."""

from eel_gaits.law import Law

from .profiles import Profiles
from .simulation import Simulation, SimulationStopped


class Member(Simulation):
    """As `Simulation` with `law` adopted, for one swimmer after the other. `ValueError` names what does not fit."""

    def __init__(self, law: Law, **arguments):
        super().__init__(law=law, **arguments)

    def begin_anew(self, law: Law, position, orientation, twist):
        """Be the swimmer of the same body, scene, accuracy and stations that starts there: (3,) [m], unit quaternion
        (4,) and (6,) [rad/s, m/s], checked."""
        self._begin(law, (position, orientation, twist))

    def swim_into(
        self, times, out: Profiles, works, *, wrench: bool, load: bool
    ) -> tuple[int, SimulationStopped | None]:
        """March through `times` (T,) [s] and fill `out` and `works` (T, 4) [J]. Returns how many instants were reached,
        and what stopped it."""
        self._started = True
        return self._swim_through(times, works, out, wrench, load)
