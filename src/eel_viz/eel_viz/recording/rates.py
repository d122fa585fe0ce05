# SPDX-License-Identifier: Apache-2.0
"""How often each thing is logged: at most once in a slot of simulation time."""

from dataclasses import dataclass

ROUNDING = 1000  # ns: a stamp that is this little before a slot lies in it


@dataclass(frozen=True, kw_only=True)
class Rates:
    """How often numbers and drawings are logged [Hz of simulation time]; 0: with every message.

    `tick` [s of wall time]: how long rows may wait for a batch.
    """

    numbers: float = 0.0
    drawings: float = 25.0
    tick: float = 0.2


def period_of(rate: float) -> int:
    """The period [ns] of a `rate` [Hz]; 0 for 0, which means every message."""
    return round(1e9 / rate) if rate else 0


class Slots:
    """Remembers the last slot of time in which each thing was logged."""

    def __init__(self) -> None:
        self._last: dict[str, int] = {}

    def due(self, what: str, stamp: int, period: int) -> bool:
        """Whether `stamp` [ns] lies in another slot of `period` [ns] than the last one that was due; 0: always."""
        if period:
            slot = (stamp + ROUNDING) // period
            if self._last.get(what) == slot:
                return False
            self._last[what] = slot
        return True
