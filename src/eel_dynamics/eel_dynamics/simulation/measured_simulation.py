# SPDX-License-Identifier: Apache-2.0
"""A simulation that measures its own error as it goes: a companion with coarser settings follows it.

Both get the same laws and samples. Their distance is the estimate of the error (accuracy/error_estimate.py). A motion
that is already known to others cannot be refined, so a missed target can only be told.
"""

from collections import deque
from collections.abc import Callable

import numpy as np
from eel_gaits.laws.law import Law
from eel_gaits.sources.sampled_law import SampledLaw

from eel_dynamics.accuracy.error_estimate import (
    LEAST_SAMPLES,
    SMALL,
    ErrorEstimate,
    HeadErrors,
    growth_rate_of,
    least_torque,
)
from eel_dynamics.simulation.simulation import Simulation
from eel_dynamics.simulation.stopping import SimulationStopped

COMPARED_EVERY = 0.1  # s of simulated time between two comparisons
REMEMBERED = 300  # comparisons from which the growth rate is taken: those of the last 30 s
FAILURES = SimulationStopped, ValueError, ArithmeticError, MemoryError


class MeasuredSimulation(Simulation):
    """A `Simulation`, with the same arguments, and an estimate of its error.

    With a controller in the loop, the estimate is the error for the same curvature. It does not contain what the
    controller would have done with a more accurate observation.

    Attributes:
        measured_since: [s], start of the estimate. The companion begins again from the present state when the
            difference has become so great that it no longer grows, and so is no estimate any more.
        lost_at: [s], the first such time; None if there was none.
    """

    def __init__(self, *arguments, **settings):
        super().__init__(*arguments, **settings)
        self._companion: Simulation | None = None
        self._distances: deque = deque(maxlen=REMEMBERED)  # (time [s], distance of the heads [m])
        self._start_again()

    @property
    def error_estimate(self) -> ErrorEstimate:
        """The errors of the motion since `measured_since`, at the last comparison.

        They are relative to the path and to the greatest torque since then, and infinite where the companion stopped.
        """
        if self._companion is None:
            return ErrorEstimate(np.inf, None)
        torque = None
        if self._torque is not None:
            duration = self._compared_at - self.measured_since
            least = least_torque(self.law, self.discretisation.mass, self.body.length, duration)
            torque = self._torque_distance / max(self._torque, least)
        rate = self._rate_before
        if len(self._distances) >= LEAST_SAMPLES:
            time, distances = np.array(self._distances).T
            rate = growth_rate_of(time - self.measured_since, distances, SMALL * self._scale)
        return ErrorEstimate(self.head_errors.relative, torque, rate)

    @property
    def head_errors(self) -> HeadErrors:
        """The errors of the head's motion since `measured_since`, at the last comparison.

        All are infinite where the companion stopped. The absolute ones are also infinite before the first comparison,
        and once the position was lost.
        """
        if self._companion is None:
            return HeadErrors(*[np.inf] * 5)
        unknown = self.lost_at is not None or self._last_position is None
        return HeadErrors(self._apart[0] / self._scale, *([np.inf] * 4 if unknown else self._apart.tolist()))

    def adopt(self, law: Law | SampledLaw, origin: float = 0.0, transition: float | None = None):
        """As `Simulation.adopt`."""
        self._bring_up()
        super().adopt(law, origin, transition)
        self._do_alike(lambda companion: companion.adopt(law, origin, transition))
        if self._companion is not None and len(self._companion.grid.x) == len(self.grid.x):
            self._seat()

    def add_samples(self, time, x, pitch, pitch_rate, pitch_accel, yaw, yaw_rate, yaw_accel, waves=None):
        """As `Simulation.add_samples`."""
        self._bring_up()
        rows = x, pitch, pitch_rate, pitch_accel, yaw, yaw_rate, yaw_accel, waves
        super().add_samples(time, *rows)
        self._do_alike(lambda companion: companion.add_samples(time, *rows))

    def advance(self, time: float, interrupted: Callable[[], bool] | None = None) -> bool:
        """As `Simulation.advance`."""
        reached = super().advance(time, interrupted)
        if reached and self.time - self._compared_at >= COMPARED_EVERY * (1.0 - 1e-9):
            self._compare(interrupted)
        return reached

    def record(self, *arguments):
        """As `Simulation.record`. The error is estimated once, at its end."""
        recorded = super().record(*arguments)
        self._compare(None)
        return recorded

    def set_state(self, position, orientation, twist):
        """As `Simulation.set_state`. The estimate begins again."""
        super().set_state(position, orientation, twist)
        self._seat()

    def reset(self):
        """As `Simulation.reset`. The estimate begins again."""
        super().reset()
        self._start_again()

    def _start_again(self):
        self.lost_at: float | None = None
        self._seat()

    def _seat(self, growth_rate: float = 0.0):
        """Let the companion begin from the present state. `growth_rate` [1/s]: until a new one is measured."""
        self.measured_since = self._compared_at = self.time
        self._last_position, self._rate_before = None, growth_rate
        self._path = self._torque_distance = 0.0  # m, N m: since then
        self._apart = np.zeros(4)  # as in `HeadErrors`: m, rad, m/s, rad/s
        self._torque: float | None = None  # N m, the greatest since then
        self._distances.clear()
        try:
            self._companion = self._coarser()
        except FAILURES:
            self._companion = None

    def _coarser(self) -> Simulation:
        settings = self.accuracy.coarser()
        companion = self.copy_with(settings)
        if len(companion.grid.x) == len(self.grid.x):
            companion = self.copy_with(settings.with_other_points())
        return companion

    def _do_alike(self, action: Callable[[Simulation], object]):
        if self._companion is None:
            return
        try:
            action(self._companion)
        except FAILURES:
            self._companion = None

    def _bring_up(self, interrupted: Callable[[], bool] | None = None):
        """Have the companion at the present time, so that what happens next happens to both at once."""
        if self._companion is not None and self._companion.time < self.time:
            self._do_alike(lambda companion: companion.advance(self.time, interrupted))

    def _compare(self, interrupted: Callable[[], bool] | None):
        self._bring_up(interrupted)
        if self._companion is None or self._companion.time < self.time:
            return
        self._compared_at = self.time
        try:
            this, other = self.observe(load=False), self._companion.observe(load=False)
        except SimulationStopped:
            self._companion = None
            return
        self._include(this, other)
        if not self._apart[0] <= SMALL * self._scale:
            self.lost_at = self.time if self.lost_at is None else self.lost_at
            self._seat(self.error_estimate.growth_rate)

    def _include(self, this, other):
        """Add a comparison of two snapshots of one time."""
        apart = _apart(this, other)
        if self._last_position is not None:
            self._path += float(np.linalg.norm(this.position - self._last_position))
        self._last_position, self._apart = this.position, np.maximum(self._apart, apart)
        self._distances.append((self.time, float(apart[0])))
        if this.torque is not None:
            size, differs = np.linalg.norm((this.torque, this.torque - other.torque), axis=2).max(axis=1)
            self._torque, self._torque_distance = max(self._torque or 0.0, size), max(self._torque_distance, differs)

    @property
    def _scale(self) -> float:
        """Length [m] by which the position's error is relative."""
        return max(self._path, self.body.length)


def _apart(this, other) -> np.ndarray:
    """(4,) m, rad, m/s, rad/s: how far the heads are apart in two snapshots of one time."""
    position, twist = this.position - other.position, this.twist - other.twist
    same, opposite = (np.linalg.norm(this.orientation + sign * other.orientation) for sign in (-1.0, 1.0))
    angle = 4.0 * np.arcsin(min(same, opposite) / 2.0)  # q and -q are one orientation
    return np.array((np.linalg.norm(position), angle, np.linalg.norm(twist[3:]), np.linalg.norm(twist[:3])))
