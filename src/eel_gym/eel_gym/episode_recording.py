# SPDX-License-Identifier: Apache-2.0
"""An episode as a `Run`, and its Rerun recording."""

import contextlib
import os
from pathlib import Path
from typing import Any

import numpy as np
from eel_dynamics.runs.run import Run
from eel_dynamics.simulation.commanded_robots import CommandedRobots
from eel_dynamics.simulation.energy import EnergyLedger
from eel_dynamics.simulation.observations import Snapshot
from eel_dynamics.simulation.sampled_swimmers import SampledSwimmers
from eel_gaits.laws.law import Law

STACKED = (
    *("time", "position", "orientation", "twist", "head_acceleration", "center_of_mass", "backbone"),
    *("section_orientation", "curvature", "curvature_rate", "torque", "force", "fluid_force", "resistive_force"),
    *("tail_force", "nose_force", "wake_momentum_rate", "closure_torque", "closure_force"),
)


class EpisodeRecording:
    """Collects the snapshots of an episode, and writes it to a folder: TASK-0.rrd, TASK-1.rrd and so on.

    A file that is there already stays: other environments may record to the same folder.
    """

    def __init__(self, folder: Any, name: str):
        self._folder, self._name, self._number = Path(os.fspath(folder)), name, 0
        self._snapshots: list[Snapshot] = []

    def add(self, snapshot: Snapshot) -> None:
        """Add the present instant."""
        self._snapshots.append(snapshot)

    def finish(self, swimmers: SampledSwimmers | CommandedRobots, index: int) -> None:
        """Write the episode of swimmer `index`, if it has more than its start. The next `add` begins another."""
        snapshots, self._snapshots = self._snapshots, []
        if len(snapshots) < 2:
            return
        self._folder.mkdir(parents=True, exist_ok=True)
        path = self._new_file()
        try:
            run_of(snapshots, swimmers, index, self._name).to_rerun(path)
        except BaseException:
            path.unlink(missing_ok=True)
            raise

    def _new_file(self) -> Path:
        """The path of a new, empty file with the next number."""
        while True:
            path = self._folder / f"{self._name}-{self._number}.rrd"
            self._number += 1
            with contextlib.suppress(FileExistsError):
                path.open("xb").close()
                return path


def run_of(snapshots: list[Snapshot], swimmers: SampledSwimmers | CommandedRobots, index: int, name: str) -> Run:
    """The run of swimmer `index` from its `snapshots`. Its law has this `name` and no terms: a policy moved it."""
    columns: dict[str, Any] = {}
    for field in STACKED:
        values = [getattr(snapshot, field) for snapshot in snapshots]
        columns[field] = None if values[0] is None else np.array(values)
    energy = None
    if snapshots[0].energy is not None:
        names = EnergyLedger.keys()
        ledgers: list[Any] = [snapshot.energy for snapshot in snapshots]
        energy = EnergyLedger(*(np.array([ledger[each] for ledger in ledgers]) for each in names))
    for field in snapshots[0].joints:
        columns[field] = np.array([snapshot.joints[field] for snapshot in snapshots])
    steps, _, evaluations = swimmers.evaluations(index)
    return Run(
        robot=swimmers.robot if isinstance(swimmers, CommandedRobots) else None,
        law=Law(name=name),
        body=swimmers.body,
        scene=swimmers.scene,
        accuracy=swimmers.accuracy,
        x=swimmers.x,
        energy=energy,
        steps=steps,
        evaluations=evaluations,
        nodes=len(swimmers.grid.x),
        **columns,
    )
