# SPDX-License-Identifier: Apache-2.0
"""Many robots of one kind with commanded joints, side by side: like `SampledSwimmers`, but with dynamic bending."""

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
from eel_gaits.laws.law import Law
from numpy.typing import NDArray

from eel_dynamics.model.flow.flow import Flow
from eel_dynamics.model.initial_state import InitialState
from eel_dynamics.simulation.march import March
from eel_dynamics.simulation.observations import Snapshot
from eel_dynamics.simulation.sampled_swimmers import LEFT_OUT, Array
from eel_dynamics.simulation.stopping import SimulationStopped
from eel_dynamics.simulation.swimmer import Swimmer

MODES = {"position": "position", "velocity": "velocity", "torque": "effort"}  # arguments of `March.command`

NO_LAW = Law(name="commands")


class CommandedRobots:
    """N robots. Each equals a `Simulation` with the same commands to the last bit, for any number of threads.

    Args:
        count: N. names: of the commanded joints. kind: "position", "velocity" or "torque".
        swimmer: shared by all, with a robot. threads: their number.

    Attributes:
        heads: (13, N) position [m], orientation x y z w, angular velocity [rad/s] and velocity [m/s] of each.
        joints: (2, J, N) angle [rad] and rate [rad/s] of all joints of each.
    """

    def __init__(self, count: int, names: Sequence[str], kind: str, swimmer: Swimmer, threads: int = 1):
        assert swimmer.robot is not None
        self._names, self._mode, self.accuracy = tuple(names), MODES[kind], swimmer.settings
        self.swimmer = swimmer.unchecked(accuracy=self.accuracy, law=NO_LAW)
        self._swims = [March(self.swimmer)] * count
        self.grid = self._swims[0].discretisation.grid
        self.heads: Array = np.zeros((13, count))
        self.joints: Array = np.zeros((2, len(swimmer.robot.joints), count))
        self._threads, self._process = threads, 0
        self._pool: ThreadPoolExecutor | None = None  # belongs to one process: a fork has none of its threads

    def __getstate__(self) -> dict[str, Any]:
        return self.__dict__ | {"_pool": None, "_process": 0}

    def start(self, index: int, position, orientation, twist, commands: Array, flow: Flow | None = None) -> None:
        """Put a robot at the start, at time 0, with springs at rest and these `commands` (n,) in force.

        position, orientation, twist, flow: as in `Simulation`.
        """
        start = InitialState(position, orientation, twist)
        self._swims[index] = March(self.swimmer.starting(start, flow))
        self._command(index, commands)
        self._look(index)

    def wake(self) -> None:
        """As in `SampledSwimmers`; nothing to do here."""

    def advance(self, times: Array, commands: Array, status: NDArray[np.int64]) -> dict[int, SimulationStopped]:
        """March each robot to its own time of `times` (N,) [s] under its `commands` (N, n).

        status (N,): robots with `LEFT_OUT` stay. Returns why robots stopped, by their index.
        """
        stopped: dict[int, SimulationStopped] = {}

        def march(index: int) -> None:
            try:
                self._command(index, commands[index])
                self._swims[index].advance(float(times[index]), None)
                self._look(index)
            except SimulationStopped as error:
                stopped[index] = error

        marched = np.flatnonzero(status != LEFT_OUT).tolist()
        if self._threads > 1 and self._process != os.getpid():
            self._pool, self._process = ThreadPoolExecutor(self._threads, thread_name_prefix="robot"), os.getpid()
        list((map if self._pool is None else self._pool.map)(march, marched))
        return dict(sorted(stopped.items()))

    def observe(self, index: int, *, wrench: bool = True, load: bool = True) -> Snapshot:
        """The present snapshot of a robot, as from `Simulation.observe`."""
        return self._swims[index].observe(wrench=wrench, load=load)

    def evaluations(self, index: int) -> tuple[int, int, int]:
        """Numbers of steps, rejected steps and evaluations of a robot since its start."""
        return self._swims[index].core.counts

    def _command(self, index: int, commands: Array) -> None:
        for name, value in zip(self._names, commands.tolist(), strict=True):
            self._swims[index].command(name, **{self._mode: value})

    def _look(self, index: int) -> None:
        swim = self._swims[index]
        head, found = swim.head, swim.observe(wrench=False, load=False).joints
        self.heads[:, index] = np.concatenate((head.position, head.orientation, head.twist))
        self.joints[:, :, index] = found["joint_angle"], found["joint_rate"]
