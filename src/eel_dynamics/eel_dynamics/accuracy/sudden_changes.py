# SPDX-License-Identifier: Apache-2.0
"""Sudden changes of torques, wrenches and flows given over time: steps end there, and are short in between.

A step's error is estimated at a few instants, so a change that begins and ends between them would be missed. Therefore
given functions are sampled beforehand, at one random instant in each `STEP`. A change is sudden if cubics through four
equidistant instants do not follow it: first with instants `GAPS[0]` apart, and where these fail, with closer ones.
"""

import math
from collections.abc import Callable, Iterable
from contextlib import suppress
from functools import lru_cache, partial

import numpy as np
from eel_common.attitude import world_from_body
from eel_gaits.sources.function_law import MOST_LOOKS, SEED, STEP

from eel_dynamics.model.flow.flow import Flow, parts_of
from eel_dynamics.model.flow.functions import FlowField
from eel_dynamics.model.robot.actuators import Torque
from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.model.wrenches.external_wrench import ExternalWrench

GAPS = 1.0 / 4.0, 1.0 / 16.0, 1.0 / 128.0  # s
LONGEST = 2.0  # s: no step passes over a longer change
SUDDEN = 1e-3  # error of a cubic, relative to the greatest value
FEWEST = 4  # least number of intervals
APART = 2.0  # gaps: closer sudden changes are one
UNSEEN = 0.02  # s: the longest step with a torque that is not sampled beforehand
PLACES = 5  # places along the body at its start where a flow is sampled
Values = Callable[[np.ndarray], np.ndarray]  # from instants (N,) [s] to values (N, n)


def given_torques(robot: Robot | None) -> list[Torque]:
    """The joint torques that are given over time."""
    return [] if robot is None else [each.actuator for each in robot.joints if isinstance(each.actuator, Torque)]


def given_flows(flow: Flow | None) -> list[FlowField]:
    """The flows that are functions of unknown period."""
    fields = () if flow is None else parts_of(flow)
    return [each for each in fields if isinstance(each, FlowField) and each.period is None]


@lru_cache(maxsize=64)
def sudden_changes(
    robot: Robot | None,
    flow: Flow | None,
    position: tuple[float, ...],
    orientation: tuple[float, ...],
    length: float,
    until: float,
    wrenches: tuple[ExternalWrench, ...] = (),
) -> frozenset[float]:
    """Times [s] before `until` [s] at which a sudden change of a torque, flow or wrench function begins or ends.

    until: 0 for all changes of tables. A flow is sampled along a straight body of this `length` [m], at its start.
    """
    found: set[float] = set()
    for torque in given_torques(robot):
        start, end = (0.0, until) if torque.time is None else (torque.time[0], torque.time[-1])
        end = min(end, until or end, start + MOST_LOOKS * STEP)
        found |= changes_of(partial(_torques, torque), start, end, torque.time or ())
    places = position - np.linspace(0.0, length, PLACES)[:, None] * world_from_body(np.array(orientation))[:, 0]
    for field in given_flows(flow):
        with suppress(ValueError):  # the run itself reports bad values
            found |= changes_of(partial(_velocities, field, places), 0.0, until)
    for wrench in wrenches:
        if wrench.is_function:
            with suppress(ValueError):
                found |= changes_of(partial(_wrenches, wrench), 0.0, min(until, MOST_LOOKS * STEP))
    return frozenset(found)


def _torques(torque: Torque, times: np.ndarray) -> np.ndarray:
    return torque.at(times)[:, None]


def _wrenches(wrench: ExternalWrench, times: np.ndarray) -> np.ndarray:
    return np.array([wrench.at(time) for time in times.tolist()])


def _velocities(field: FlowField, places: np.ndarray, times: np.ndarray) -> np.ndarray:
    return np.array([field.velocity(places, time).ravel() for time in times.tolist()])


def changes_of(value_at: Values, start: float, end: float, others: Iterable[float] = ()) -> set[float]:
    """Times between `start` and `end` [s] at which a sudden change of values begins or ends.

    others: [s], further instants at which they are sampled.
    """
    if not end > start:
        return set()
    count = min(MOST_LOOKS, math.ceil((end - start) / STEP))
    even = start + (end - start) / count * (np.arange(count) + np.random.default_rng(SEED).random(count))
    looks = np.union1d(even, [time for time in others if start < time < end])
    seen = value_at(looks)
    allowed = SUDDEN * np.max(np.abs(seen))
    found, spans = set(), [(start, end)]
    for gap in GAPS:
        spans = [part for span in spans for part in _sudden_parts(value_at, *span, gap, looks, seen, allowed)]
        short = [(a, b) for a, b in spans if b - a <= LONGEST and b - a < end - start]
        found |= {time for a, b in short for time in (a, 0.5 * (a + b), b) if start < time < end}
    return found


def _sudden_parts(
    value_at: Values, start: float, end: float, gap: float, looks: np.ndarray, seen: np.ndarray, allowed: float
) -> list[tuple[float, float]]:
    """The parts of the time from `start` to `end` [s] in which cubics through instants a `gap` [s] apart differ from
    the samples `seen` (N, n) by more than is `allowed`."""
    ends = np.linspace(start, end, 1 + max(FEWEST, math.ceil((end - start) / gap)))
    values, inside = value_at(ends), slice(*np.searchsorted(looks, (start, end)))
    home = np.clip(np.searchsorted(ends, looks[inside]) - 1, 0, len(ends) - 2)
    first = np.clip(home - 1, 0, len(ends) - 4)
    s = ((looks[inside] - ends[first]) / (ends[1] - ends[0]))[:, None]
    a, b, c, d = (values[first + place] for place in range(4))
    sides = -(s - 1) * (s - 2) * (s - 3) / 6 * a + s * (s - 1) * (s - 2) / 6 * d
    guessed = sides + s * (s - 2) * (s - 3) / 2 * b - s * (s - 1) * (s - 3) / 2 * c  # Lagrange
    bad = np.zeros(len(ends) + 1, dtype=bool)  # for the intervals, and beyond both ends
    bad[1 + home[np.any(np.abs(guessed - seen[inside]) > allowed, axis=1)]] = True
    turns = ends[np.flatnonzero(bad[1:] != bad[:-1])].tolist()
    parts: list[tuple[float, float]] = []
    for begin, stop in zip(turns[::2], turns[1::2], strict=True):
        near = bool(parts) and begin - parts[-1][1] <= APART * gap
        parts[-1:] = [(parts[-1][0], stop)] if near else [*parts[-1:], (begin, stop)]
    return parts
