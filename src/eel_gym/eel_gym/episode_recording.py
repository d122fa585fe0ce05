# SPDX-License-Identifier: Apache-2.0
"""An episode as a `Run`, and its Rerun recording."""

import contextlib
import os
from pathlib import Path
from typing import Any

from eel_dynamics.runs.run import Run
from eel_dynamics.simulation.commanded_robots import CommandedRobots
from eel_dynamics.simulation.observations import Snapshot
from eel_dynamics.simulation.sampled_swimmers import SampledSwimmers
from eel_gaits.laws.law import Law


class EpisodeRecording:
    """Collects the snapshots of an episode, and writes it to a folder: TASK-0.rrd, TASK-1.rrd and so on.

    An existing file stays: other environments may record to the same folder.
    """

    def __init__(self, folder: Any, name: str):
        self._folder, self._name, self._number = Path(os.fspath(folder)), name, 0
        self._snapshots: list[Snapshot] = []

    def add(self, snapshot: Snapshot) -> None:
        """Add the present instant."""
        self._snapshots.append(snapshot)

    def finish(self, swimmers: SampledSwimmers | CommandedRobots) -> None:
        """Write the episode, if it has more than its start. The next `add` begins a new one."""
        snapshots, self._snapshots = self._snapshots, []
        if len(snapshots) < 2:
            return
        self._folder.mkdir(parents=True, exist_ok=True)
        path = self._new_file()
        try:
            Run.of_snapshots(snapshots, swimmers.swimmer, Law(name=self._name)).to_rerun(path)  # a policy moved it
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
