# SPDX-License-Identifier: Apache-2.0
"""Whether a goal comes nearer, within a bounded time."""

import math

SHARE = 0.98  # of the least error: what counts as nearer


class Progress:
    """Watches the error of a goal. patience: [s] without progress after which it counts as out of reach."""

    def __init__(self, patience: float) -> None:
        self._patience = patience
        self.least = math.inf  # least error so far
        self._since, self._said = 0.0, False

    def restart(self, time: float) -> None:
        """Watch another goal from `time` [s] on."""
        self.least, self._since, self._said = math.inf, time, False

    def stalled(self, time: float, error: float, close: float) -> bool:
        """Whether it has just become clear that the error stays above `close`. It is said once for each goal."""
        if error < SHARE * self.least or error <= close:
            self.least, self._since = min(error, self.least), time
        if self._said or time - self._since <= self._patience:
            return False
        self._said = True
        return True
