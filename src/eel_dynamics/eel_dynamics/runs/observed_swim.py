# SPDX-License-Identifier: Apache-2.0
"""A swim with its samples: marched to its end, with the estimate of its error. Runs, batches and repetitions use it."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np
from eel_gaits.laws.law import Law
from eel_gaits.sources.sampled_law import SampledLaw

from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.accuracy.step_bounds import MOST_EVALUATIONS
from eel_dynamics.model.flow.flow import check_covers
from eel_dynamics.runs.companion import stable_step, with_error_estimate
from eel_dynamics.runs.motions import check_duration
from eel_dynamics.runs.run_data import RunData
from eel_dynamics.runs.sampling import check_memory, checked_times, default_sample_period
from eel_dynamics.runs.storage.variables import arrays_of
from eel_dynamics.simulation.bending.slow_motors import SlowMotors, slow_motors
from eel_dynamics.simulation.march import March
from eel_dynamics.simulation.stopping import SimulationStopped
from eel_dynamics.simulation.swimmer import Swimmer

LEAST_COMPARED = 40  # least number of intervals between instants at which a robot's torque is compared

Kind = TypeVar("Kind", bound=RunData)


class SwimResult(NamedTuple, Generic[Kind]):
    """A run, and the reason if it stopped before its end."""

    run: Kind
    compared: Kind  # the run at all instants, for the estimate of its error
    energy_at_start: float  # J
    stopped: SimulationStopped | None


class ObservedSwim(NamedTuple, Generic[Kind]):
    """The samples to record of a `swimmer`, at `times` (T,) [s] from 0 on.

    kind: class of the run. load: whether to record the water's load. estimate: whether to estimate the run's error, and
    to refine it if that exceeds its target. every: number of instants observed per sample in that case.
    """

    kind: type[Kind]
    swimmer: Swimmer
    times: np.ndarray
    load: bool = False
    estimate: bool = False
    every: int = 1

    def of_swimmer(self, **changes: Any) -> "ObservedSwim[Kind]":
        """The same with other fields of the `swimmer`, which fit."""
        return self._replace(swimmer=self.swimmer.unchecked(**changes))

    def to_refine(self) -> "ObservedSwim[Kind]":
        """The same for a run whose error is estimated.

        The torque of a robot jumps when motors and stops reach their limits. Only instants that are close together show
        an error there.
        """
        gaps, swimmer = len(self.times) - 1, self.swimmer
        every = -(-LEAST_COMPARED // gaps) if swimmer.robot is not None and swimmer.has_internal_wrench and gaps else 1
        observed = self._replace(estimate=True, every=every)
        if not swimmer.accuracy.target:
            return observed
        return observed.of_swimmer(accuracy=replace(swimmer.accuracy, refinable=True))

    @property
    def slow_motors(self) -> SlowMotors | None:
        """Motors that cannot follow the law, if any."""
        return slow_motors(self.swimmer.modes, self.swimmer.law, float(self.times[-1]))

    @property
    def instants(self) -> np.ndarray:
        """(N,) [s], at which the swimmer is observed: the samples, and instants between them."""
        if self.every == 1:
            return self.times
        between = np.arange(self.every) / self.every
        return np.append(self.times[:-1, None] + np.diff(self.times)[:, None] * between, self.times[-1])

    def march(self, accuracy: Accuracy | None = None) -> March:
        """Its march at the start, with the settings `accuracy` if given."""
        accuracy = self.swimmer.accuracy if accuracy is None else accuracy
        return March(self.swimmer.unchecked(accuracy=accuracy, until=float(self.times[-1])))

    def swim(self, march: March, look: Callable[[float], None] | None = None) -> SwimResult[Kind]:
        """Swim with this `march`, which must be at its start. look: as in `Simulation.record`."""
        instants, swimmer, start = self.instants, self.swimmer, march.energy_at_start
        out, works, done, stopped = march.record(instants, swimmer.has_internal_wrench, self.load, look)
        steps, _, evaluations = march.core.counts
        arrays = arrays_of(out, works, start, march.joints, done, bool(swimmer.scene.ledger))
        others: dict[str, Any] = {
            "law": swimmer.law,
            "accuracy": march.swimmer.settings,
            "nodes": len(march.discretisation.grid.x),
        }
        others |= {"steps": steps, "evaluations": evaluations}
        run = compared = self.kind.of(swimmer, instants[:done], arrays, **others)
        if self.every > 1:
            sampled = {name: np.ascontiguousarray(each[:: self.every]) for name, each in arrays.items()}
            run = self.kind.of(swimmer, compared.time[:: self.every], sampled, **others)
        return SwimResult(run, compared, start, stopped)

    def outcome(self, look: Callable[[float], None] | None = None) -> SwimResult[Kind]:
        """Swim, and swim again for the error estimate if that is wanted."""
        swim = self.swim(self.march(), look)
        found: SwimResult[Kind] = with_error_estimate(swim, self) if self.estimate else swim
        return found

    def swim_to_end(self, look: Callable[[float], None] | None = None) -> Kind:
        """The run. `SimulationStopped`, with the samples so far as its `run`, if it stops early."""
        swim = self.outcome(look)
        if (stopped := swim.stopped) is None:
            return swim.run
        settings = swim.run.accuracy
        if settings.step is not None:
            step = stable_step(self, settings)
            hint = f"a step of {step:.3g} s is stable" if step else "no shorter step that was tried is stable"
            hint = f"{hint}; it was {settings.step:.3g} s"
            stopped = SimulationStopped(stopped.time, stopped.quantity, stopped.value, hint)
            stopped.diverged = True
        stopped.run = swim.run
        raise stopped


def observed_again(
    run: Kind,
    law: Law | SampledLaw,
    accuracy: Accuracy,
    most_evaluations: float = MOST_EVALUATIONS,
    finer: int = 1,
    load: bool = False,
) -> ObservedSwim[Kind]:
    """The swim of `run` with another law or accuracy, `finer` samples, or its `load`; without an error estimate.

    `ValueError` if the run begins after t = 0.
    """
    if run.time[0] != 0.0:
        raise ValueError(f"run must begin at t = 0 to be simulated again, got {run.time[0]:g} s")
    swimmer = run.swimmer_at(0, run.x, accuracy, most_evaluations).unchecked(law=law)
    sample_period = float(run.time[1] - run.time[0]) / finer if len(run.time) > 1 else 1.0
    times, load = times_of(swimmer, float(run.time[-1]), sample_period), load or run.fluid_force is not None
    check_memory(1, len(times), len(swimmer.x), swimmer.has_internal_wrench, load)
    return ObservedSwim(type(run), swimmer, times, load)


def simulated_again(run: Kind, *changes: Any, **others: Any) -> Kind:
    """The run of `observed_again`, which has these arguments, in the axes of `run`."""
    return observed_again(run, *changes, **others).swim_to_end().in_axes(run.axes)


def times_of(swimmer: Swimmer, duration: float, sample_period: float | None) -> np.ndarray:
    """Times (T,) [s] of the samples of a swim of `duration` [s]. `ValueError` where its law or flow is shorter."""
    period = default_sample_period([swimmer.law], duration) if sample_period is None else sample_period
    times = checked_times(duration, period)
    check_times(swimmer, duration, times)
    return times


def check_times(swimmer: Swimmer, duration: float, times: np.ndarray) -> None:
    """`ValueError` where the law of a `swimmer` is shorter than `duration` [s], or its flow than `times` (T,) [s]."""
    check_duration(swimmer.law, duration)
    check_covers(swimmer.flow, float(times[-1]))
