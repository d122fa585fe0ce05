# SPDX-License-Identifier: Apache-2.0
"""The read-only part of a simulation: the present instant, its law, its cost and its error."""

import numpy as np
from eel_gaits.laws.law import Law
from eel_gaits.sources.sampled_law import SampledLaw
from numpy.typing import ArrayLike

import eel_core
from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.accuracy.error_estimate import ErrorEstimate, HeadErrors
from eel_dynamics.model.body.grid import Grid
from eel_dynamics.model.fins.fins import Fin
from eel_dynamics.model.flow.flow import Flow
from eel_dynamics.model.initial_state import InitialState
from eel_dynamics.model.wrenches.external_wrench import ExternalWrench
from eel_dynamics.simulation.bending.joint_motion import JointMotion
from eel_dynamics.simulation.discretisation import Discretisation
from eel_dynamics.simulation.error_meter import ErrorMeter
from eel_dynamics.simulation.march import March
from eel_dynamics.simulation.observations import Snapshot
from eel_dynamics.simulation.swimmer import Swimmer


class Present:
    """The read-only part of a `Simulation`."""

    _swimmer: Swimmer
    _march: March
    _meter: ErrorMeter

    @property
    def time(self) -> float:
        """Present time [s]."""
        return self._march.time

    @property
    def state(self) -> np.ndarray:
        """(13,) position, orientation, momentum about the head, in the world's axes."""
        return np.array(self._march.core.state)

    @property
    def swimmer(self) -> Swimmer:
        """The swimmer at the start. Laws, currents and wrenches that came later are not in it."""
        return self._swimmer

    @property
    def accuracy(self) -> Accuracy:
        """The settings in force."""
        return self._swimmer.settings

    @property
    def fins(self) -> tuple[Fin, ...]:
        """The fins, with pairs separated."""
        return self._swimmer.fins

    @property
    def wrenches(self) -> tuple[ExternalWrench, ...]:
        """The external wrenches given at the start, without those applied later."""
        return self._swimmer.wrenches

    @property
    def grid(self) -> Grid:
        """The nodes along the body."""
        return self.discretisation.grid

    @property
    def discretisation(self) -> Discretisation:
        """Body and scene on the grid."""
        return self._march.discretisation

    @property
    def law(self) -> Law | SampledLaw | None:
        """The law in force, or the last one before a controller took over."""
        return self._march.follower.law

    @property
    def law_on_grid(self) -> eel_core.LawOnGrid:
        """The law or the samples that drive the body, on the grid."""
        return self._march.law_on_grid

    @property
    def samples_until(self) -> float | None:
        """Last instant [s] of a controller's samples, or None without samples."""
        return self._march.follower.samples.end

    @property
    def sampled(self) -> bool:
        """Whether a controller's samples drive the shape at present."""
        return self._march.follower.sampled

    @property
    def resting(self) -> bool:
        """Whether a controller's samples have run out, so that the shape comes to rest."""
        return self._march.follower.resting

    def water_at(self, place: ArrayLike) -> np.ndarray:
        """Velocity (3,) [m/s], world, that the water has at a `place` (3,) [m] at present, without the swimmer."""
        u = None if self.flow is None else self.flow.sample(place, self.time).velocity
        return self._swimmer.current if u is None else self._swimmer.current + u

    @property
    def flow(self) -> Flow | None:
        """The flow of the water at present, besides the scene's current."""
        return self._march.swimmer.flow

    def observe(self, wrench: bool = True, load: bool = True) -> Snapshot:
        """The snapshot of the present instant.

        wrench, load: whether it holds the internal wrench, and the water's load along the body.
        """
        return self._march.observe(wrench, load)

    @property
    def head(self) -> InitialState:
        """Position (3,) [m], orientation (4,) and twist (6,) of the head at present, as `set_state` takes them.

        It costs a tenth of `observe`.
        """
        return self._march.head

    @property
    def joints(self) -> JointMotion | None:
        """The motion of a robot's joints at the samples of the last `record`; None without one."""
        return self._march.joints

    @property
    def energy_at_start(self) -> float:
        """Kinetic and potential energy [J] in the initial state."""
        return self._march.energy_at_start

    @property
    def works(self) -> np.ndarray:
        """(8,) J of `energy.WORKS` since the start."""
        return np.array(self._march.core.works)

    @property
    def evaluations(self) -> tuple[int, int, int]:
        """Numbers of steps, rejected steps and evaluations of the head's dynamics so far."""
        return self._march.core.counts

    # -- error, if it is measured (`measure_error`); else None

    @property
    def error_estimate(self) -> ErrorEstimate | None:
        """The errors of the motion since `measured_since`, at the last comparison.

        They are relative to the path and to the greatest torque since then, and infinite if the companion stopped.
        """
        return self._meter.estimate(self._march) if self._meter.wanted else None

    @property
    def head_errors(self) -> HeadErrors | None:
        """The errors of the head's motion since `measured_since`, at the last comparison.

        All are infinite if the companion stopped. The absolute ones are also infinite before the first comparison,
        and once the position was lost.
        """
        return self._meter.head_errors if self._meter.wanted else None

    @property
    def measured_since(self) -> float | None:
        """[s], start of the estimate. It restarts once the errors are saturated: so large that they no longer grow."""
        return self._meter.measured_since if self._meter.wanted else None

    @property
    def lost_at(self) -> float | None:
        """[s], first such restart of the estimate; None without one."""
        return self._meter.lost_at if self._meter.wanted else None
