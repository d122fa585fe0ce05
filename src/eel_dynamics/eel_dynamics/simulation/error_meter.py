# SPDX-License-Identifier: Apache-2.0
"""Measures the error of a march while it runs: a companion with coarser settings follows it.

Both get the same laws and samples. Their distance is the estimate of the error (accuracy/error_estimate.py). Samples
already published cannot be refined, so a missed target can only be reported. With a controller in the
loop, the estimate is the error for the same curvature. It leaves out how the controller would have responded to a
more accurate observation.
"""

from collections import deque
from collections.abc import Callable
from typing import Any

import numpy as np

from eel_dynamics.accuracy.accuracy import OTHER_GRIDS, Accuracy
from eel_dynamics.accuracy.error_estimate import (
    LEAST_SAMPLES,
    SMALL,
    ErrorEstimate,
    HeadErrors,
    angle_between,
    floors_of,
    growth_rate_of,
    twist_size,
)
from eel_dynamics.simulation.bending.joint_motion import bends, stops_met, torque_at_stops
from eel_dynamics.simulation.march import March
from eel_dynamics.simulation.observations import Snapshot
from eel_dynamics.simulation.stopping import SimulationStopped
from eel_dynamics.simulation.swimmer import Swimmer

COMPARED_EVERY = 0.1  # s of simulated time between two comparisons
ROUND_OFF = 1e-9  # relative
REMEMBERED = 300  # comparisons that give the growth rate: the last 30 s
FAILURES = SimulationStopped, ValueError, ArithmeticError, MemoryError


def on_another_grid(begun: Callable[[Accuracy], March], settings: Accuracy, nodes: int | None) -> March:
    """The march `begun(settings)`; with more points along the body if its grid would have exactly `nodes`.

    nodes: of another march's grid. Nodes fill blocks, so a few more points may give the same grid.
    """
    march = begun(settings)
    for _ in range(OTHER_GRIDS):
        if len(march.discretisation.grid.x) != nodes:
            break
        settings = settings.with_other_points()
        march = begun(settings)
    return march


class ErrorMeter:
    """The estimate of the error of a `march`, if it is `wanted`; else it does nothing.

    Attributes:
        measured_since: [s], start of the estimate. The companion begins again from the present state when the
            difference is so great that it no longer grows, and so no longer estimates the error.
        lost_at: [s], the first such time; None if there was none.
    """

    def __init__(self, march: March, wanted: bool):
        self.wanted = wanted
        self._companion: March | None = None
        self._length = march.swimmer.body.length  # m
        self.lost_at: float | None = None
        self.measured_since = self._compared_at = march.time
        self._last_position: np.ndarray | None = None
        self._growth_rate = 0.0  # 1/s, until a new one is measured
        self._path = self._torque_distance = 0.0  # m, N m: since `measured_since`
        self._apart = np.zeros(4)  # as in `HeadErrors`: m, rad, m/s, rad/s
        self._torque: float | None = None  # N m, the greatest since then
        self._speeds = np.zeros(2)  # m/s, rad/s: the greatest since then
        # rad, rad/s, rad/s: distances of angles and rates of joints, and the greatest rate; None without a robot
        self._bends: np.ndarray | None = None
        self._stops_met, self._joints_apart = np.zeros(0, bool), np.zeros(0)  # of each joint, since then; [rad]
        self._distances: deque = deque(maxlen=REMEMBERED)  # (time [s], distance of the heads [m])
        self.due = False  # whether to compare the next instant, after a jump of torques
        self.begin_again(march)

    def begin_again(self, march: March, growth_rate: float = 0.0):
        """Let the companion begin from the present state. `growth_rate` [1/s]: until a new one is measured."""
        self.measured_since = self._compared_at = march.time
        self._last_position, self._growth_rate, self._torque = None, growth_rate, None
        self._path, self._torque_distance, self._apart = 0.0, 0.0, np.zeros(4)
        self._speeds, self._bends = np.zeros(2), None
        joints = 0 if march.swimmer.robot is None else len(march.swimmer.robot.joints)
        self._stops_met, self._joints_apart = np.zeros(joints, bool), np.zeros(joints)
        self._distances.clear()
        if not self.wanted:
            return
        try:
            self._companion = on_another_grid(
                lambda settings: march.copy_with(march.swimmer.unchecked(accuracy=settings)),
                march.swimmer.settings.coarser(),
                len(march.discretisation.grid.x),
            )
        except FAILURES:
            self._companion = None

    # -- the companion does what the march does

    def catch_up(self, march: March, interrupted: Callable[[], bool] | None = None):
        """March the companion to the present time, so that the next change acts on both at once."""

        def advance(companion: March) -> None:
            companion.advance(march.time, interrupted)

        if self._companion is not None and self._companion.time < march.time:
            self.repeat(advance)

    def repeat(self, action: Callable[[March], March | None]):
        """Repeat on the companion an action done on the march; it may return another march in its place."""
        if self._companion is not None:
            try:
                self._companion = action(self._companion) or self._companion
            except FAILURES:
                self._companion = None

    def keep_apart(self, march: March):
        """After a change of the law: the companion begins again if it has the grid of the `march`."""
        there = self._companion
        if there is not None and len(there.discretisation.grid.x) == len(march.discretisation.grid.x):
            self.begin_again(march)

    # -- comparisons

    def advanced(self, march: March, interrupted: Callable[[], bool] | None):
        """Compare the two if that is due; with limited joints at each call, as the torque of a stop is short."""
        robot = march.swimmer.robot
        self.due |= robot is not None and any(joint.limits is not None for joint in robot.joints)
        if self.due or march.time - self._compared_at >= COMPARED_EVERY * (1.0 - ROUND_OFF):
            self.compare(march, interrupted)

    def compare(self, march: March, interrupted: Callable[[], bool] | None = None):
        """Compare the two now."""
        self.catch_up(march, interrupted)
        if self._companion is None or self._companion.time < march.time:
            return
        self._compared_at, self.due = march.time, False
        try:
            this, other = march.observe(load=False), self._companion.observe(load=False)
        except SimulationStopped:
            self._companion = None
            return
        self._include(this, other, march.swimmer)
        if not self._apart[0] <= SMALL * self._scale:
            self.lost_at = march.time if self.lost_at is None else self.lost_at
            self.begin_again(march, self.estimate(march).growth_rate)

    def _include(self, this: Snapshot, other: Snapshot, swimmer: Swimmer):
        """Add a comparison of two snapshots of one time, of the `swimmer`."""
        apart = _distances(this, other)
        if self._last_position is not None:
            self._path += float(np.linalg.norm(this.position - self._last_position))
        self._last_position, self._apart = this.position, np.maximum(self._apart, apart)
        if not self._distances or this.time - self._distances[-1][0] >= COMPARED_EVERY * (1.0 - ROUND_OFF):
            self._distances.append((this.time, float(apart[0])))
        if this.torque is not None:
            size, differs = np.linalg.norm((this.torque, this.torque - other.torque), axis=2).max(axis=1)
            self._torque, self._torque_distance = max(self._torque or 0.0, size), max(self._torque_distance, differs)
        self._speeds = np.maximum(self._speeds, twist_size(this.twist))
        own, others = bends(swimmer, this.joints), bends(swimmer, other.joints)
        if own.size:
            sizes = *np.abs(own - others).max(axis=1), np.abs(own[1]).max()
            self._bends = np.maximum(0.0 if self._bends is None else self._bends, sizes)
            joints = len(self._joints_apart)
            self._joints_apart = np.maximum(self._joints_apart, np.abs(own - others)[0, :joints])
            self._stops_met |= stops_met(swimmer.robot, own[:1, :joints])

    @property
    def _scale(self) -> float:
        """Length [m] that the position's error is relative to."""
        return max(self._path, self._length)

    # -- the estimate

    def estimate(self, march: March) -> ErrorEstimate:
        """As `Simulation.error_estimate`."""
        if self._companion is None:
            return ErrorEstimate(np.inf, None)
        law, mass = march.follower.law, march.discretisation.mass
        least = floors_of(law, mass, self._length, self._compared_at - self.measured_since)
        found: dict[str, Any] = {"torque": None, "orientation": self._apart[1]}
        found["twist"] = (self._apart[2:] / np.maximum(self._speeds, (least.speed, least.rate))).max()
        if self._torque is not None:
            apart = self._torque_distance
            if len(self._stops_met):
                apart = max(apart, torque_at_stops(march.swimmer.robot, self._stops_met, self._joints_apart))
            found["torque"] = apart / max(self._torque, least.torque)
        if self._bends is not None:
            found["joint_angle"] = self._bends[0]
            found["joint_rate"] = self._bends[1] / max(self._bends[2], least.rate)
        rate = self._growth_rate
        if len(self._distances) >= LEAST_SAMPLES:
            time, distances = np.array(self._distances).T
            rate = growth_rate_of(time - self.measured_since, distances, SMALL * self._scale)
        return ErrorEstimate(self.head_errors.relative, growth_rate=rate, **found)

    @property
    def head_errors(self) -> HeadErrors:
        """As `Simulation.head_errors`."""
        if self._companion is None:
            return HeadErrors(*[np.inf] * 5)
        unknown = self.lost_at is not None or self._last_position is None
        return HeadErrors(self._apart[0] / self._scale, *([np.inf] * 4 if unknown else self._apart.tolist()))


def _distances(this: Snapshot, other: Snapshot) -> np.ndarray:
    """(4,) m, rad, m/s, rad/s: distances of the heads in two snapshots of one time."""
    position, angle = this.position - other.position, angle_between(this.orientation, other.orientation)
    return np.array((np.linalg.norm(position), angle, *twist_size(this.twist - other.twist)))
