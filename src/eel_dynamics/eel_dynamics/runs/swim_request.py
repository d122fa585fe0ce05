# SPDX-License-Identifier: Apache-2.0
"""A requested swim as a value: `simulate`, batches, companions and repetitions of a run all make one."""

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
from eel_dynamics.runs.motions import Motion, law_from
from eel_dynamics.runs.run_data import RunData
from eel_dynamics.runs.sampling import check_memory, checked_times, default_sample_period
from eel_dynamics.runs.settled_duration import duration_of
from eel_dynamics.runs.storage.variables import arrays_of
from eel_dynamics.simulation.bending.slow_motors import SlowMotors, slow_motors
from eel_dynamics.simulation.march import March
from eel_dynamics.simulation.simulation_setup import SimulationSetup
from eel_dynamics.simulation.stopping import SimulationStopped

LEAST_COMPARED = 40  # least number of intervals between instants at which a robot's torque is compared

Kind = TypeVar("Kind", bound=RunData)


class SwimResult(NamedTuple, Generic[Kind]):
    """A run, and the reason if it stopped before its end."""

    run: Kind
    compared: Kind  # the run at all instants of the request, for the estimate of its error
    energy_at_start: float  # J
    stopped: SimulationStopped | None


class SwimRequest(NamedTuple, Generic[Kind]):
    """A swimmer with its `law`, the times (T,) [s] of its samples, and whether to record wrench and load.

    kind: class of the run. estimate: whether to estimate its error, and to refine it if that exceeds its target. every:
    number of instants observed per sample in that case.
    """

    kind: type[Kind]
    law: Law | SampledLaw
    setup: SimulationSetup
    times: np.ndarray
    wrench: bool
    load: bool
    estimate: bool = False
    every: int = 1

    @staticmethod
    def of(
        kind: type[Kind],
        motion: Motion,
        setup: SimulationSetup,
        duration: float | str,
        sample_period: float | None,
        load: bool = False,
        estimate: bool = False,
    ) -> "SwimRequest[Kind]":
        """The request from these arguments of `simulate`. `ValueError` as there."""
        seconds: Any = duration_of(duration, [(motion, setup)])  # a text is refused below
        law = law_from(motion, seconds, setup.body.length)
        period = default_sample_period([law], seconds) if sample_period is None else sample_period
        times, wrench = checked_times(seconds, period), setup.scene.internal_wrench
        check_covers(setup.flow, float(times[-1]))
        check_memory(1, len(times), len(setup.x), wrench, bool(load), 2 if estimate else 1)
        request = SwimRequest(kind, law, setup, times, wrench, bool(load))
        return request.to_refine() if estimate else request

    def changed(self, **changes: Any) -> "SwimRequest[Kind]":
        """The same with changed fields of its `setup`."""
        return self._replace(setup=replace(self.setup, **changes))

    def to_refine(self) -> "SwimRequest[Kind]":
        """The same for a run whose error is estimated.

        The torque of a robot jumps when motors and stops reach their limits. Only instants that are close together show
        an error there.
        """
        gaps, accuracy = len(self.times) - 1, self.setup.accuracy
        every = -(-LEAST_COMPARED // gaps) if self.setup.robot is not None and self.wrench and gaps else 1
        if isinstance(accuracy, Accuracy) and accuracy.target:
            accuracy = replace(accuracy, refinable=True)
        return self.changed(accuracy=accuracy)._replace(estimate=True, every=every)

    @property
    def slow_motors(self) -> SlowMotors | None:
        """Motors that cannot follow the law, if any."""
        return slow_motors(self.setup.modes, self.law, float(self.times[-1]))

    @property
    def instants(self) -> np.ndarray:
        """(N,) [s], at which the swimmer is observed: the samples, and instants between them."""
        if self.every == 1:
            return self.times
        between = np.arange(self.every) / self.every
        return np.append(self.times[:-1, None] + np.diff(self.times)[:, None] * between, self.times[-1])

    def march(self, accuracy: Accuracy | None = None) -> March:
        """Its march at the start, with the settings `accuracy` if given."""
        setup = self.setup if accuracy is None else replace(self.setup, accuracy=accuracy)
        return March(replace(setup, until=float(self.times[-1])), self.law)

    def swim(self, march: March, look: Callable[[float], None] | None = None) -> SwimResult[Kind]:
        """Swim with this `march`, which must be at its start. look: as in `Simulation.record`."""
        instants, setup, start = self.instants, self.setup, march.energy_at_start
        out, works, done, stopped = march.record(instants, self.wrench, self.load, look)
        steps, _, evaluations = march.core.counts
        arrays = arrays_of(out, works, start, march.joints, done, bool(setup.scene.ledger))
        others = {"law": self.law, "accuracy": march.setup.settings, "nodes": len(march.discretisation.grid.x)}
        others |= {"steps": steps, "evaluations": evaluations}
        run = compared = self.kind.of(setup, instants[:done], arrays, **others)
        if self.every > 1:
            sampled = {name: np.ascontiguousarray(each[:: self.every]) for name, each in arrays.items()}
            run = self.kind.of(setup, compared.time[:: self.every], sampled, **others)
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


def simulated_again(
    run: Kind,
    law: Law | SampledLaw,
    accuracy: Accuracy,
    most_evaluations: float = MOST_EVALUATIONS,
    finer: int = 1,
    load: bool = False,
) -> Kind:
    """The swim of `run` with another law or accuracy, `finer` samples, or its `load`; without an error estimate.

    `ValueError` if the run begins after t = 0.
    """
    request = request_again(run, law, accuracy, most_evaluations, finer, load)
    return request.swim_to_end().in_axes(run.axes)


def request_again(
    run: Kind,
    law: Law | SampledLaw,
    accuracy: Accuracy,
    most_evaluations: float = MOST_EVALUATIONS,
    finer: int = 1,
    load: bool = False,
) -> SwimRequest[Kind]:
    """The request of `simulated_again`."""
    if run.time[0] != 0.0:
        raise ValueError(f"run must begin at t = 0 to be simulated again, got {run.time[0]:g} s")
    setup = run.setup_at(0, run.x, accuracy, most_evaluations)
    sample_period = float(run.time[1] - run.time[0]) / finer if len(run.time) > 1 else 1.0
    load = load or run.fluid_force is not None
    return SwimRequest.of(type(run), law, setup, float(run.time[-1]), sample_period, load)
