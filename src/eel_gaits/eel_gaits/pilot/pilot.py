# SPDX-License-Identifier: Apache-2.0
"""The pilot: turns the motion of the head, sample by sample, into the curvature of the body that leads it to a goal.

Each step estimates the swimmer (estimate.py), guides it (guidance.py) and regulates it (regulator.py). The result are
targets of a steered law (laws/steered_law.py), whose curvature is twice differentiable in time. A pilot sends samples
rather than laws: it decides at each step, and a law in closed form would need a blend each time.
"""

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from eel_common.head_motion import HeadMotion, wrapped

from eel_gaits.gaits.swimming import straight
from eel_gaits.laws.law import Law
from eel_gaits.laws.steered_law import SteeredLaw
from eel_gaits.pilot.estimate import Estimate, Estimator
from eel_gaits.pilot.goals import Course, Path, Station
from eel_gaits.pilot.guidance import GUIDANCE, Demand, PathGuidance
from eel_gaits.pilot.regulator import Gains, Regulator
from eel_gaits.pilot.settings import PilotSettings

RESPONSE = 0.2  # periods of the gait: time constant of the law's numbers
NEARER = 0.98  # a smaller error than this part of the least one is progress
ON_COURSE = 0.1  # error of the heading [rad] plus that of the depth [m]: below it a course is held


class News(NamedTuple):
    """A report of the pilot."""

    text: str
    good: bool = False  # False: a warning


class Pilot:
    """Steers one swimmer. Call `begin` at the start of a run, then `step` for each sample of the head's motion.

    `see` and `steer` are the two parts of `step`, for use where motion and curvature have different times.

    Args:
        settings: numbers of swimmer and pilot.
        law: the gait; by default straight().
        gains: of the regulator.

    Attributes:
        goal: the present goal.
        estimate: the last estimate; None before the first step.
        demand: the last demand.
        misses: [m], least distance of the head from each passed point of the present path.
        news: reports, the oldest first. The caller empties the list.
    """

    def __init__(
        self, settings: PilotSettings | None = None, law: Law | None = None, gains: Gains | None = None
    ) -> None:
        self.settings = settings or PilotSettings()
        gait = law or straight()
        self.law = SteeredLaw(gait, response=RESPONSE, length=self.settings.length)
        self._estimator = Estimator(
            period=self.law.period, speed_time=self.settings.speed_time, water_time=self.settings.water_time
        )
        self._regulator = Regulator(self.settings, gains)
        self._progress = Progress(self.settings.patience)
        self.goal: Course | Path | Station = Course(0.0, 0.0, 0.0)
        self._guidance: Any = None  # the guidance to the goal, from `GUIDANCE`
        self.estimate: Estimate | None = None
        self.demand: Demand | None = None
        self.misses: list[float] = []
        self.news: list[News] = []

    def begin(self) -> np.ndarray:
        """Begin a run with the straight body at rest. Returns the curvature (6, points), as `SteeredLaw.advance`."""
        self._estimator.restart()
        self._regulator.restart()
        self._guidance, self.estimate = None, None
        return self.law.begin(0.0, amplitude=0.0, tempo=self.settings.slowest_tempo)

    def follow(self, goal: Course | Path | Station) -> None:
        """Change the goal, from the next step on."""
        self.goal, self._guidance = goal, None

    def checked_path(self, goal: Path) -> Path:
        """The path, if its first point can be reached from the present position. `ValueError` otherwise."""
        if self.estimate is not None:
            forward = math.cos(self.estimate.heading), math.sin(self.estimate.heading)
            self.settings.limits.check_turn(1, "of the swimmer", goal.points[0] - self.estimate.position, forward)
        return goal

    def change_speed(self, speed: float) -> None:
        """Swim to the same goal with another `speed` [m/s]."""
        self.goal = replace(self.goal, speed=speed)
        if self._guidance is not None:
            self._guidance.goal = self.goal

    @property
    def target(self) -> int:
        """Index of the next way point; 0 without a path."""
        return self._guidance.target if isinstance(self._guidance, PathGuidance) else 0

    def limit_torque(self, torque: float, limit: float, time: float) -> None:
        """Slow down if the internal `torque` [N m] at `time` [s] exceeds the `limit` [N m]; 0: no limit."""
        if self._regulator.torque.exceeded(torque, limit, time, self.law.values["tempo"][0]):
            text = f"the torque of {torque:.3g} N m exceeds the limit of {limit:.3g} N m at the slowest beat too"
            self.news.append(News(text))

    def step(self, time: float, head: HeadMotion, step: float) -> np.ndarray:
        """Take the `head` at `time` [s] and steer for a `step` [s]. Returns the curvature (6, points) at its end."""
        self.see(time, head)
        return self.steer(step)

    def see(self, time: float, head: HeadMotion) -> None:
        """Take the motion of the `head` at `time` [s], and guide the swimmer. Times must rise."""
        values = self.law.values
        through = self.settings.cruise_speed * values["tempo"][0] * min(1.0, values["amplitude"][0])
        self.estimate = estimate = self._estimator.add(time, head, self.law.own_time, through)
        self._guide(estimate, head)
        self.demand = demand = self._guidance.demand(estimate, self._regulator.greatest_speed)
        self._watch(time, head, estimate, demand)

    def steer(self, step: float) -> np.ndarray:
        """The curvature (6, points) `step` [s] after the last call, or after `begin`."""
        assert self.demand is not None and self.estimate is not None, "`see` comes first"
        targets = self._regulator.targets(self.demand, self.estimate, self.law, step)
        tempo = max(self.law.values["tempo"][0], self.settings.slowest_tempo)
        return self.law.advance(targets, step, RESPONSE * self.law.period / tempo)

    def _guide(self, estimate: Estimate, head: HeadMotion) -> None:
        """Find the guidance to the present goal. After a path, its last point becomes the station."""
        if self._guidance is None:
            self.misses = [] if isinstance(self.goal, Path) else self.misses
            self._guidance = GUIDANCE[type(self.goal)](self.goal, self.settings, estimate.position)
            self._progress.restart(estimate.time)
        path = self._guidance
        if isinstance(path, PathGuidance) and path.pass_points(estimate, head.position):
            miss, reached = path.last_miss, path.last_miss <= self.settings.limits.reach
            self.misses.append(miss)
            passed = "reached" if reached else "missed"
            text = f"way point {path.target} of {len(path.goal.points)} {passed}: {miss:.3g} m from it"
            self.news.append(News(text, good=reached))
            self._progress.restart(estimate.time)
            if path.done:
                self.follow(Station(path.goal.points[-1], path.goal.speed))
                self._guide(estimate, head)

    def _watch(self, time: float, head: HeadMotion, estimate: Estimate, demand: Demand) -> None:
        """Report a goal that does not come nearer."""
        goal = self.goal
        if isinstance(goal, Course):
            error = abs(wrapped(goal.heading - estimate.heading)) + abs(-goal.depth - estimate.position[2])
            close, where = ON_COURSE, f"heading {goal.heading:.3g} rad, depth {goal.depth:.3g} m"
        else:
            point = goal.point if isinstance(goal, Station) else goal.points[self.target]
            error = float(np.linalg.norm(point - head.position))
            close = self.settings.limits.reach if isinstance(goal, Path) else self.settings.length
            where = f"({point[0]:.3g}, {point[1]:.3g}, {point[2]:.3g}) m"
        if self._progress.stalled(time, error, close):
            why = "" if demand.possible else ": the water is faster than the swimmer may swim"
            least, patience = self._progress.least, self.settings.patience
            text = f"the goal {where} cannot be reached: no nearer than {least:.3g} for {patience:g} s{why}"
            self.news.append(News(text))


class Progress:
    """Watches the error of a goal. patience: [s] without progress; then the goal counts as out of reach."""

    def __init__(self, patience: float) -> None:
        self._patience = patience
        self.least = math.inf  # least error so far
        self._since, self._said = 0.0, False

    def restart(self, time: float) -> None:
        """Watch a new goal from `time` [s] on."""
        self.least, self._since, self._said = math.inf, time, False

    def stalled(self, time: float, error: float, close: float) -> bool:
        """Whether it has just become clear that the error stays above `close`. True at most once for each goal."""
        if error < NEARER * self.least or error <= close:
            self.least, self._since = min(error, self.least), time
        if self._said or time - self._since <= self._patience:
            return False
        self._said = True
        return True
