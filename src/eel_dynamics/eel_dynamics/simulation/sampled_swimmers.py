# SPDX-License-Identifier: Apache-2.0
"""Many swimmers of one body in one scene, each driven by a controller's samples, marched in one call."""

from typing import Any

import numpy as np
from eel_common.wording import shown
from numpy.typing import NDArray

import eel_core
from eel_dynamics.accuracy.grid_settings import ShapeNeeds
from eel_dynamics.accuracy.step_bounds import step_bounds_of
from eel_dynamics.curvature.curvature_samples import CurvatureSample, check_points
from eel_dynamics.model.flow.flow import Flow, parts_of
from eel_dynamics.model.flow.functions import FlowField
from eel_dynamics.model.initial_state import InitialState
from eel_dynamics.simulation.discretisation import discretise
from eel_dynamics.simulation.march import MARCHED, SINGULAR, UNFINISHED
from eel_dynamics.simulation.observations import Snapshot
from eel_dynamics.simulation.stopping import SimulationStopped, stopped_by
from eel_dynamics.simulation.swimmer import Swimmer

LEFT_OUT = -1
MOST_WAVES = 2.0  # of a flow on the body: the nodes resolve at least this number

Array = NDArray[np.float64]


class SampledSwimmers:
    """N swimmers. Each equals a `Simulation` with the same samples and the settings `accuracy`, to the last bit,
    for any number of threads.

    A sample is the curvature at the points `points` at the end of a control step: rows (6, n), pitch, its rate and its
    acceleration, then yaw. `advance` does not check samples, see `check`.

    Args:
        count: N.
        points: (n,) [m], X of the samples.
        waves: on the body, which the grid must resolve; None: the most that the points can carry.
        swimmer: shared by all; `Accuracy.for_control_steps` adapts its accuracy.
        threads: their number.

    Attributes:
        accuracy: the settings in force.
        heads: (13, N) position [m], orientation x y z w, angular velocity [rad/s] and velocity [m/s] of each, as in
            `Simulation.head`.
    """

    def __init__(self, count: int, points: Array, waves: float | None, swimmer: Swimmer, threads: int = 1):
        self.accuracy = swimmer.settings.for_control_steps()
        swimmer = self.swimmer = swimmer.unchecked(accuracy=self.accuracy)
        self._points, self._waves, self._threads = points, waves, threads
        self._starts = [swimmer] * count  # each as it started
        self._make_marches()
        self.heads: Array = np.zeros((13, count))
        self._energy_at_start = np.zeros(count)

    def _make_marches(self) -> None:
        swimmer, sample = self.swimmer, self.check(np.zeros((6, len(self._points))))
        self._discretisation = discretise(swimmer, swimmer.grid_for(ShapeNeeds(sample.waves)))
        self.grid = self._discretisation.grid
        self._marches = eel_core.SampledMarches(
            self._discretisation.swimmer,
            method=self.accuracy.method,
            order=self.accuracy.order,
            planar=bool(swimmer.scene.planar),
            ledger=bool(swimmer.scene.ledger),
            current=swimmer.current,
            weights=self._discretisation.tabulation.weights_of(self._points),
            transition=swimmer.default_transition,
            count=len(self._starts),
            threads=self._threads,
        )

    def __getstate__(self) -> dict[str, Any]:
        """Without derived data; the core's state as bytes."""
        left_out = "_discretisation", "grid"
        kept = {name: value for name, value in self.__dict__.items() if name not in left_out}
        return kept | {"_marches": self._marches.state_as_bytes()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._make_marches()
        self._marches.set_state_from_bytes(state["_marches"], [each.core_flow for each in self._starts])

    def check(self, rows: Array) -> CurvatureSample:
        """A sample with these `rows` (6, n); `ValueError` if `Simulation.add_samples` would refuse it."""
        check_points(len(self._points))
        length, planar = self.swimmer.body.length, self.swimmer.scene.planar
        return CurvatureSample.checked(
            0.0, self._points, tuple(rows), waves=self._waves, length=length, planar=planar, now=0.0, begun=False
        )

    def start(self, index: int, position, orientation, twist, rows: Array, flow: Flow | None = None) -> None:
        """Put a swimmer at the start, straight, at time 0, where its sample has the `rows` (6, n).

        position, orientation, twist, flow: as in `Simulation`; a `FlowField` is refused, as Python runs in one thread.
        The grid stays that of the samples: `ValueError` for a flow that needs a finer one.
        """
        self.check(rows)
        swimmer = self.swimmer.starting(InitialState(position, orientation, twist), flow)
        if flow is not None:
            self._check_flow(flow)
        self._starts[index], bounds = swimmer, self._bounds_of(swimmer)
        place, turn, _ = swimmer.start
        energy = self._marches.start(index, bounds, place, turn, swimmer.initial_twist, rows, swimmer.core_flow)
        if not (np.isfinite(energy) and self._marches.put_head(index, self.heads)):
            raise SimulationStopped(0.0, "kinetic energy", energy, "start slower")
        self._energy_at_start[index] = energy

    def _bounds_of(self, swimmer: Swimmer) -> eel_core.StepBounds:
        return step_bounds_of(swimmer, self._discretisation, True, swimmer.time_scale)

    def _check_flow(self, flow: Flow) -> None:
        if any(isinstance(part, FlowField) for part in parts_of(flow)):
            raise ValueError(f"flow must have no functions where many swim side by side, got {shown(flow)}")
        waves = self.swimmer.body.length / flow.traits.shortest_wave
        if waves > MOST_WAVES:
            raise ValueError(f"flow must have at most {MOST_WAVES:g} waves on the body, got {waves:.3g}: {shown(flow)}")

    def wake(self) -> None:
        """Wake the threads, as `advance` will be called soon."""
        self._marches.wake()

    def advance(self, times: Array, rows: Array, status: NDArray[np.int64]) -> dict[int, SimulationStopped]:
        """March each swimmer to its own time in `times` (N,) [s], where its sample has the `rows` (N, 6, n).

        status (N,): `LEFT_OUT` for swimmers that stay, 0 for the others; unchanged. Returns why swimmers stopped, by
        their index.
        """
        stopped: dict[int, SimulationStopped] = {}
        if self._marches.advance(times, rows, status, self.heads):
            return stopped
        found = status.copy()
        status[status > MARCHED] = MARCHED
        while True:
            for index in np.flatnonzero((found > MARCHED) & (found != UNFINISHED)).tolist():
                stopped[index] = self._stopped(index, int(found[index]))
            found[found != UNFINISHED] = LEFT_OUT
            if (found == LEFT_OUT).all():
                return stopped
            self._marches.advance(times, rows, found, self.heads)

    def observe(self, index: int, *, wrench: bool = True, load: bool = True) -> Snapshot:
        """The present snapshot of a swimmer, as from `Simulation.observe`."""
        wrench, load = bool(wrench and self.swimmer.scene.internal_wrench), bool(load)
        time, works, _ = self._marches.present(index)
        ledger = (np.array(works), float(self._energy_at_start[index])) if self.swimmer.scene.ledger else None
        snapshot = Snapshot(time, self.swimmer.x, wrench, load, ledger=ledger, sensors=len(self.swimmer.sensors))
        if not self._marches.observe(index, snapshot.whole, wrench, load):
            raise self._stopped(index, SINGULAR)
        return snapshot

    def evaluations(self, index: int) -> tuple[int, int, int]:
        """Numbers of steps, rejected steps and evaluations of a swimmer since its start."""
        return self._marches.present(index)[2]

    def _stopped(self, index: int, status: int) -> SimulationStopped:
        bounds = self._bounds_of(self._starts[index])
        return stopped_by(status, self._marches.present(index)[0], bounds, self.accuracy)
