# SPDX-License-Identifier: Apache-2.0
"""The march of the compiled mechanics: under one tabulated law after another, with errors that say what to change."""

from collections.abc import Callable
from typing import Any

import numpy as np

import eel_core
from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.model.scene import Scene
from eel_dynamics.simulation.discretisation import Discretisation
from eel_dynamics.simulation.observations import Observations
from eel_dynamics.simulation.sample_check import first_bad_sample
from eel_dynamics.simulation.stopping import SimulationStopped, remedy, stopped_by

MARCHED, SINGULAR, UNFINISHED = (eel_core.STATUSES.index(name) for name in ("marched", "singular", "unfinished"))


class CompiledMarch:
    """The march of a swimmer's head, on a `discretisation` of a body in a `scene`, with the settings `accuracy`.

    Call `follow` and `start` first. Positions [m] and orientations x y z w are of the head in the world frame; a twist
    (6,) [rad/s, m/s] is relative to the water, in the head's axes. `SimulationStopped` where the march cannot continue.

    Attributes:
        time: [s], the present.
        tabulated_law: the law in force, on the grid.
    """

    def __init__(self, discretisation: Discretisation, scene: Scene, accuracy: Accuracy):
        self.discretisation, self.accuracy, self.time = discretisation, accuracy, 0.0
        self.tabulated_law: Any = None  # an eel_core.Law and its StepBounds, from `follow` on
        self._bounds: Any = None
        self._planar, self._ledger, self._current = bool(scene.planar), bool(scene.ledger), np.array(scene.current)
        self._march = eel_core.March(discretisation.swimmer, accuracy.method, accuracy.order, self._planar)

    def follow(self, law: eel_core.Law, breakpoints: list[float], bounds: eel_core.StepBounds, smoothly: bool = False):
        """Continue under `law` with these `bounds` of the steps.

        breakpoints [s]: where a derivative of the curvature jumps. The next step begins anew, unless the motion goes on
        `smoothly`.
        """
        self.tabulated_law, self._bounds = law, bounds
        self._march.follow(law, breakpoints, bounds, self._ledger, self._current, smoothly)

    def start(self, position, orientation, twist) -> float:
        """Put the head into its initial state; the energy [J] there, which must be finite."""
        energy = self._march.start(position, orientation, twist)
        if not np.isfinite(energy):
            raise SimulationStopped(0.0, "kinetic energy", energy, "start slower")
        return energy

    def change(self, discretisation: Discretisation, accuracy: Accuracy):
        """Continue on another discretisation, with other settings. `follow` and `set_twist` must come next."""
        self._march.change(discretisation.swimmer, accuracy.method, accuracy.order, self._planar)
        self.discretisation, self.accuracy = discretisation, accuracy

    # -- march

    def advance(self, time: float, interrupted: Callable[[], bool] | None) -> bool:
        """March to `time` [s]; False where `interrupted()`, which is called every few milliseconds, ends it before."""
        while (status := self._march.advance(time)) == UNFINISHED:
            if interrupted is not None and interrupted():
                self.time = self._march.time
                return False
        self.time = self._march.time
        if status != MARCHED:
            raise self._stopped(status)
        return True

    def record(self, event, times, done: int, out: Observations, works, wrench: bool, load: bool, look) -> tuple:
        """March through `times` (T,) [s] from number `done` on, but no farther than `event` [s], and observe each.

        out, works (T, 4) [J]: where to. look(time [s]), unless None, is called every few milliseconds. Returns how many
        are done, and the status: `MARCHED` as long as nothing stopped the march.
        """
        status = UNFINISHED
        while status == UNFINISHED:
            done, status = self._march.record(times, done, out.whole, works, bool(wrench), bool(load), event)
            if status == MARCHED and done < len(times):
                status = self._march.advance(event)
            if look is not None and status == UNFINISHED:
                look(self._march.time)
        self.time = self._march.time
        return done, status

    def checked_record(self, times, done: int, status: int, out: Observations, works, energy_at_start: float) -> tuple:
        """How many of the `done` samples are good, and what stopped the march after them, or None.

        status: as of `record`. The present becomes the time of the last good sample. energy_at_start [J].
        """
        failure = first_bad_sample(out, works, done, energy_at_start, self._energy_floor)
        if failure:
            done, quantity, value = failure
        if done:
            self.time = float(times[done - 1])
        if failure:
            return done, SimulationStopped(self.time, quantity, value, remedy(self.accuracy))
        return done, None if status == MARCHED else self._stopped(status)

    @property
    def _energy_floor(self) -> float:
        """The floor [J] for `first_bad_sample`; infinite where the steps follow from their error, a check by itself."""
        checked = self._ledger and self.accuracy.method == "classical"
        return self._bounds.momentum_floor**2 / self.discretisation.mass if checked else np.inf

    def _stopped(self, status: int) -> SimulationStopped:
        return stopped_by(status, self.time, self._bounds, self.accuracy)

    # -- the present

    def observe(self, whole: np.ndarray, wrench: bool, load: bool):
        """Write the observations of the present instant into `whole`."""
        if not self._march.observe(whole, wrench, load):
            raise self._stopped(SINGULAR)

    @property
    def twist(self) -> np.ndarray:
        """(6,) of the present state."""
        try:
            return np.array(self._march.twist())
        except ValueError:
            raise self._stopped(SINGULAR) from None

    def set_twist(self, twist: np.ndarray):
        """Have this twist in the present place."""
        self._march.set_twist(twist)

    def set_state(self, position, orientation, twist) -> float:
        """Put the head there with this twist, at the present time; the energy [J], which may be infinite."""
        return self._march.set_state(position, orientation, twist)

    @property
    def state(self) -> np.ndarray:
        """(13,) position, orientation, momentum about the head, in the world's axes."""
        return np.array(self._march.state)

    @property
    def works(self) -> np.ndarray:
        """(4,) J of actuators, wake, nose and drag since the start."""
        return np.array(self._march.works)

    @property
    def counts(self) -> tuple[int, int, int]:
        """Numbers of steps, rejected steps and evaluations of the head's dynamics so far."""
        return self._march.counts

    @property
    def memory(self) -> int:
        """Bytes that an evaluation reads and writes."""
        return self._march.memory
