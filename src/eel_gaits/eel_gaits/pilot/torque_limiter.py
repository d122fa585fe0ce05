# SPDX-License-Identifier: Apache-2.0
"""Slows the beat where the internal torque is too great. Its torque goes with the square of its tempo."""

import math

RECOVERY = 0.02  # 1/s, by which the greatest tempo grows again
LONGEST_STEP = 1.0  # s, that count of a longer gap between two torques
AT_SLOWEST = 1.05  # times the slowest tempo: a beat that is no faster has no room left


class TorqueLimiter:
    """The greatest tempo, between `slowest` and `fastest`, that keeps the torque below a limit."""

    def __init__(self, slowest: float, fastest: float) -> None:
        self._slowest, self._fastest = slowest, fastest
        self._time, self._said = -math.inf, False
        self.tempo = fastest

    def restart(self) -> None:
        """Begin a run."""
        self.tempo, self._time, self._said = self._fastest, -math.inf, False

    def exceeded(self, torque: float, limit: float, time: float, tempo: float) -> bool:
        """Take in the `torque` [N m] at `time` [s] of a beat of this `tempo`; 0: there is no `limit`.

        Returns whether the torque exceeds the limit at the slowest tempo; it is said once in a run.
        """
        if limit <= 0.0:
            self.tempo = self._fastest
            return False
        step = min(LONGEST_STEP, max(0.0, time - self._time))
        self._time = time
        if not torque > limit:  # nor NaN
            self.tempo = min(self._fastest, self.tempo * (1.0 + RECOVERY * step))
            return False
        self.tempo = max(self._slowest, min(self.tempo, tempo * math.sqrt(limit / torque)))
        if self._said or tempo > AT_SLOWEST * self._slowest:
            return False
        self._said = True
        return True
