# SPDX-License-Identifier: Apache-2.0
"""The heading averaged over the last control steps: the head swings with the gait."""

from collections import deque

from eel_gaits.pilot.head_motion import wrapped


class MeanHeading:
    """The mean of the last `count` headings [rad], also across the turn from pi to -pi."""

    def __init__(self, count: int):
        self._headings: deque = deque(maxlen=count)  # rad, each within half a turn of the one before

    def clear(self) -> None:
        """Forget all headings."""
        self._headings.clear()

    def add(self, heading: float) -> float:
        """The mean [rad], from -pi to pi, with this `heading` [rad]."""
        last = self._headings[-1] if self._headings else heading
        self._headings.append(last + wrapped(heading - last))
        return wrapped(sum(self._headings) / len(self._headings))
