# SPDX-License-Identifier: Apache-2.0
"""A pilot and a simulation in a closed loop, in one process: like the nodes in lockstep over topics."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from eel_dynamics.model.initial_state import head_motion_of
from eel_gaits.pilot.pilot import Pilot

from eel_dynamics import Run, Scene, Simulation
from eel_gaits import Law
from eel_studies.points import AccuracyLike

STEP = 0.02  # s, from one sample of the head's motion to the next
LAST_PART = 30.0  # s
STATIONS = 51  # of a run that is kept


@dataclass(frozen=True)
class Voyage:
    """A swim with a pilot; T samples."""

    time: np.ndarray  # (T,) s
    head: np.ndarray  # (T, 3) m, position
    position: np.ndarray  # (T, 3) m, the pilot's estimate, without the swing of the head
    heading: np.ndarray  # (T,) rad, mean over a period
    roll: np.ndarray  # (T,) rad, of the plane of the beat
    wanted_heading: np.ndarray  # (T,) rad
    wanted_height: np.ndarray  # (T,) m
    misses: tuple[float, ...]  # m, least distance of the head from each passed way point
    news: tuple[str, ...]  # the pilot's reports
    run: Run | None = None  # the swimmer, where it was asked for

    @property
    def heading_error(self) -> np.ndarray:
        """(T,) rad, magnitude."""
        off = self.heading - self.wanted_heading
        return np.asarray(np.abs(np.remainder(off + np.pi, 2.0 * np.pi) - np.pi))

    @property
    def last(self) -> np.ndarray:
        """(T,) bool: the last part, in which held quantities are judged."""
        return np.asarray(self.time >= self.time[-1] - LAST_PART)

    @property
    def depth_error(self) -> float:
        """The greatest error [m] in the last part."""
        return float(np.abs(self.position[:, 2] - self.wanted_height)[self.last].max())

    def distance_from(self, spot: np.ndarray) -> float:
        """The greatest distance [m] in the last part."""
        return float(np.linalg.norm(self.position - spot, axis=1)[self.last].max())


def swim_with(
    pilot: Pilot,
    duration: float,
    *,
    scene: Scene | None = None,
    accuracy: AccuracyLike = "draft",
    until: Callable[[Pilot], bool] = lambda pilot: False,
    each: Callable[[Simulation], None] = lambda simulation: None,
    kept_every: float = 0.0,
    **start: Any,
) -> Voyage:
    """Let the `pilot` swim for at most `duration` [s], or until `until(pilot)` is true.

    scene: by default with motion only, or without ledger where a run is kept. start: keywords of `Simulation`, such as
    position and twist. each(simulation): called at each step. kept_every: time between the samples of `Voyage.run` [s],
    a multiple of `STEP`; 0: no run.
    """
    kept = round(kept_every / STEP)
    scene = scene or Scene(internal_wrench=kept > 0, ledger=False)
    stations = STATIONS if kept else 2
    simulation = Simulation(**{"scene": scene, "accuracy": accuracy, "stations": stations, **start})
    x, rows, snapshots = pilot.law.x, [], []
    simulation.add_samples(0.0, x, *pilot.begin())
    for step in range(round(duration / STEP)):
        each(simulation)
        if kept and step % kept == 0:
            snapshots.append(simulation.observe())
        head = head_motion_of(simulation.head)
        samples = pilot.step(step * STEP, head, STEP)
        found, wanted = pilot.estimate, pilot.demand
        assert found is not None and wanted is not None
        positions = np.array(head.position), np.array(found.position)
        rows.append((step * STEP, *positions, found.heading, found.roll, wanted.heading, wanted.height))
        if until(pilot):
            break
        simulation.add_samples((step + 1) * STEP, x, *samples)
        simulation.advance((step + 1) * STEP)
    columns: list[Any] = [np.array(column) for column in zip(*rows, strict=True)]
    run = Run.of_snapshots(snapshots, simulation, Law(name="pilot")) if kept else None
    return Voyage(*(*columns, tuple(pilot.misses), tuple(news.text for news in pilot.news), run))
