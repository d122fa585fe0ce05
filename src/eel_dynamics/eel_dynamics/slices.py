"""A march in slices: between two of them it can be interrupted, and what it costs is held against what it may cost.

The compiled loops come back after some steps at the latest. What they have computed stays, and the next slice goes on
from there: how a march is cut does not change a digit of it.
"""

from .integrator import Control

SLICE = 40_000  # evaluations at one point of the body: some 5 ms
LEAST_SLICE = 4  # steps
WITH_LEDGER = 4  # evaluations of the energy ledger in a step


def sliced(control: Control, points: int, evaluations: int) -> Control:
    """`control` for a slice, of a body with so many `points` and a method of so many `evaluations` in a step."""
    steps = max(LEAST_SLICE, SLICE // (points * (evaluations + WITH_LEDGER * control.ledger)))
    return control._replace(most_steps=0.0, spare_steps=float(min(steps, control.spare_steps)))


class Allowance:
    """The steps that a march may still try: some to spare, and those that are earned by simulated time."""

    def __init__(self):
        self._left = None
        self._time = self._tried = 0.0

    def covers(self, control: Control, time: float, tried: float) -> bool:
        """Whether the steps `tried` until `time` [s] are within what `control` allows."""
        if self._left is None:
            self._left = control.spare_steps
        earned = control.most_steps * (time - self._time)
        self._left = min(control.spare_steps, self._left + earned) - (tried - self._tried)
        self._time, self._tried = time, tried
        return self._left > 0.0
