# SPDX-License-Identifier: Apache-2.0
"""A pilot and a simulation in a closed loop, in one process, as the nodes are over topics in lockstep."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from eel_dynamics.simulation.simulation import Simulation
from eel_gaits.pilot.pilot import Pilot
from eel_model.initial_state import head_motion_of
from eel_model.scene import Scene

from eel_studies.points import AccuracyLike

STEP = 0.02  # s, from one sample of the head's motion to the next


@dataclass(frozen=True)
class Voyage:
    """A swim with a pilot; T samples."""

    time: np.ndarray  # (T,) s
    head: np.ndarray  # (T, 3) m, position
    position: np.ndarray  # (T, 3) m, without the swing of the head, as the pilot estimates it
    heading: np.ndarray  # (T,) rad, mean over a period
    roll: np.ndarray  # (T,) rad, of the plane of the beat
    wanted_heading: np.ndarray  # (T,) rad
    wanted_height: np.ndarray  # (T,) m
    misses: tuple[float, ...]  # m, least distance of the head to each way point that was passed
    news: tuple[str, ...]  # what the pilot reported


def swim_with(
    pilot: Pilot,
    duration: float,
    *,
    scene: Scene | None = None,
    accuracy: AccuracyLike = "draft",
    until: Callable[[Pilot], bool] = lambda pilot: False,
    each: Callable[[Simulation], None] = lambda simulation: None,
    **start: Any,
) -> Voyage:
    """Let the `pilot` swim for `duration` [s] at most, or `until(pilot)`.

    scene: by default the motion alone. start: keywords of `Simulation`, such as position and twist. each(simulation) is
    called at each step.
    """
    scene = scene or Scene(internal_wrench=False, ledger=False)
    simulation = Simulation(**{"scene": scene, "accuracy": accuracy, "stations": 2, **start})
    x, found = pilot.law.x, []
    simulation.add_samples(0.0, x, *pilot.begin())
    for step in range(round(duration / STEP)):
        each(simulation)
        head = head_motion_of(simulation.head)
        rows = pilot.step(step * STEP, head, STEP)
        estimate, demand = pilot.estimate, pilot.demand
        assert estimate is not None and demand is not None
        found.append(
            (
                *(step * STEP, *head.position, *estimate.position, estimate.heading, estimate.roll),
                *(demand.heading, demand.height),
            )
        )
        if until(pilot):
            break
        simulation.add_samples((step + 1) * STEP, x, *rows)
        simulation.advance((step + 1) * STEP)
    table = np.array(found)
    parts = np.split(table, [1, 4, 7, 8, 9, 10], axis=1)
    flat: list[Any] = [part[:, 0] if part.shape[1] == 1 else part for part in parts]
    return Voyage(*(*flat, tuple(pilot.misses), tuple(news.text for news in pilot.news)))
