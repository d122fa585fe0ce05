# SPDX-License-Identifier: Apache-2.0
"""Goals of the pilot: hold a course, follow a path of way points, or stay at a station. REP-103 axes, world frame.

`ValueError` if a goal is not finite, or out of reach of a swimmer with these `Limits`.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from eel_common.quantity import number
from eel_common.wording import shown

FARTHEST = 1e5  # m from the origin
MOST_POINTS = 10_000  # in a path


@dataclass(frozen=True, kw_only=True)
class Limits:
    """The swimmer's limits."""

    greatest_speed: float  # m/s, through the water
    turning_radius: float  # m, of the tightest turn
    greatest_climb: float  # rad, of the path to the horizontal
    reach: float  # m, within which a way point counts as reached

    def checked_speed(self, speed: float) -> float:
        """`speed` [m/s], if the swimmer can reach it."""
        return number("speed", speed, "m/s", minimum=0.0, maximum=self.greatest_speed, exclusive=True)

    def check_turn(self, point: int, where: str, leg: np.ndarray, forward: Sequence[float] | np.ndarray) -> None:
        """`ValueError` if the way point with this number lies within a turning circle.

        leg (3,) [m]: the vector to it. forward (2,): the swimmer's horizontal direction at the beginning of the leg.
        """
        ahead = leg[0] * forward[0] + leg[1] * forward[1]
        aside = abs(leg[1] * forward[0] - leg[0] * forward[1])
        if math.hypot(ahead, aside - self.turning_radius) < self.turning_radius - self.reach:
            raise ValueError(
                f"path point {point} must lie outside the turning circle of {self.turning_radius:.3g} m {where}, "
                f"got {ahead:.3g} m ahead and {aside:.3g} m aside"
            )


@dataclass(frozen=True)
class Course:
    """Hold this heading and this depth."""

    heading: float  # rad, positive: left
    depth: float  # m below z = 0
    speed: float  # m/s, over ground, forward


@dataclass(frozen=True)
class Path:
    """Swim through these points, one after the other, then stay at the last one."""

    points: np.ndarray  # (n, 3) m
    speed: float  # m/s, over ground


@dataclass(frozen=True)
class Station:
    """Stay at this point."""

    point: np.ndarray  # (3,) m
    speed: float  # m/s, over ground, on the way to it


def course(heading: float, depth: float, speed: float, limits: Limits) -> Course:
    """A course, checked against the limits."""
    depth = number("depth", depth, "m", minimum=-FARTHEST, maximum=FARTHEST)
    return Course(math.remainder(number("heading", heading), 2.0 * math.pi), depth, limits.checked_speed(speed))


def path(points: Any, speed: float, limits: Limits) -> Path:
    """A path, checked: the swimmer can follow its legs from the second point on. Any way to the first is allowed."""
    check_count(len(points))
    points = _points("path", points)
    if len(points) < 1:
        raise ValueError("path must have one point or more, got none")
    legs = np.diff(points, axis=0)
    for k, leg in enumerate(legs, 1):  # from point k to point k + 1
        flat = float(np.hypot(leg[0], leg[1]))
        if flat <= limits.reach:
            rule = f"more than {limits.reach:g} m ahead of point {k}"
            raise ValueError(f"path point {k + 1} must lie {rule}, got {flat:.3g}")
        slope, most = math.atan2(abs(leg[2]), flat), limits.greatest_climb
        if slope > most:
            rule = f"at most {math.degrees(most):.3g} degrees"
            raise ValueError(f"path to point {k + 1} must climb or dive by {rule}, got {math.degrees(slope):.3g}")
        if k > 1:
            x, y, _ = legs[k - 2]
            limits.check_turn(k + 1, f"at point {k}", leg, legs[k - 2, :2] / math.hypot(x, y))
    return Path(points, limits.checked_speed(speed))


def check_count(points: int) -> None:
    """`ValueError` if a path may not have so many `points`."""
    if points > MOST_POINTS:
        raise ValueError(f"path must have at most {MOST_POINTS} points, got {points}")


def station(point: Any, speed: float, limits: Limits) -> Station:
    """A station, checked against the limits."""
    return Station(_points("station", [point])[0], limits.checked_speed(speed))


def way_points(goal: Course | Path | Station) -> np.ndarray:
    """The points (n, 3) [m] of the goal; none for a course."""
    if isinstance(goal, Path):
        return goal.points
    return goal.point[None] if isinstance(goal, Station) else np.empty((0, 3))


def described(goal: Course | Path | Station) -> str:
    """The goal in words."""
    if isinstance(goal, Course):
        return f"hold heading {goal.heading:.3g} rad at depth {goal.depth:.3g} m with {goal.speed:.3g} m/s"
    point = goal.points[-1] if isinstance(goal, Path) else goal.point
    where = f"({', '.join(f'{value:.3g}' for value in point)}) m with {goal.speed:.3g} m/s"
    return f"swim through {len(goal.points)} points to {where}" if isinstance(goal, Path) else f"stay at {where}"


def _points(name: str, points: Any) -> np.ndarray:
    rows: np.ndarray = np.array(points, dtype=float).reshape(-1, 3)
    for k, point in enumerate(rows):
        if not np.isfinite(point).all() or np.abs(point).max() > FARTHEST:
            rule = f"finite and at most {FARTHEST:g} m from the origin"
            raise ValueError(f"{name} point {k + 1} must be {rule}, got {shown(point.tolist())}")
    return rows
