# SPDX-License-Identifier: Apache-2.0
"""A swimmer that is to swim, as a value: `simulate`, batches, companions and repetitions of a run all make one."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np
from eel_gaits.laws.law import Law
from eel_gaits.sources.sampled_law import SampledLaw
from eel_model.axes import REP103
from eel_model.flow.flow import check_covers

from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.accuracy.step_bounds import MOST_EVALUATIONS
from eel_dynamics.runs.companion import stable_step
from eel_dynamics.runs.run_data import RunData
from eel_dynamics.runs.sampling import check_memory, checked_times, default_sample_period
from eel_dynamics.runs.storage.variables import arrays_of
from eel_dynamics.simulation.bending.joint_motion import JointMotion
from eel_dynamics.simulation.observations import Observations
from eel_dynamics.simulation.simulation import Simulation
from eel_dynamics.simulation.simulation_setup import SimulationSetup, check_planar_law
from eel_dynamics.simulation.stopping import SimulationStopped

LEAST_COMPARED = 40  # gaps between the instants at which a robot's torque is compared

Kind = TypeVar("Kind", bound=RunData)


class SwimResult(NamedTuple, Generic[Kind]):
    """A run, what it was made from, and why it stopped before its end, if it did."""

    run: Kind
    out: Observations
    works: np.ndarray  # (T, 6) J
    energy_at_start: float  # J
    stopped: SimulationStopped | None
    joints: JointMotion | None = None  # of a robot
    compared: Any = None  # the run at all instants of the request, for the estimate of its error
    every: int = 1  # so many instants of `out`, `works` and `joints` for each sample of the run


class SwimRequest(NamedTuple, Generic[Kind]):
    """A swimmer that swims by `law`, the times (T,) [s] of its samples, and whether to record wrench and load.

    kind: class of the run. every: so many instants are observed for each sample, for the estimate of the error.
    """

    kind: type[Kind]
    law: Law | SampledLaw
    setup: SimulationSetup
    times: np.ndarray
    wrench: bool
    load: bool
    every: int = 1

    @staticmethod
    def of(
        kind: type[Kind],
        law: Law | SampledLaw,
        setup: SimulationSetup,
        duration: float,
        sample_period: float | None,
        load: bool,
        runs: int = 1,
    ) -> "SwimRequest[Kind]":
        """The request of these arguments of `simulate`, of which `runs` are kept at once. `ValueError` as there."""
        check_planar_law(law, setup.scene)
        period = default_sample_period([law], duration) if sample_period is None else sample_period
        times, wrench = checked_times(duration, period), setup.scene.internal_wrench
        check_covers(setup.flow, float(times[-1]))
        check_memory(1, len(times), len(setup.x), wrench, bool(load), runs)
        return SwimRequest(kind, law, setup, times, wrench, bool(load))

    def changed(self, **changes: Any) -> "SwimRequest[Kind]":
        """The same with other fields of its `setup`."""
        return self._replace(setup=replace(self.setup, **changes))

    def to_refine(self) -> "SwimRequest[Kind]":
        """The same for a run whose error is measured, and that is made finer where it misses its target.

        The torque of a robot jumps where motors and stops reach their limits: an error there is seen only by instants
        that lie close together.
        """
        gaps = len(self.times) - 1
        every = -(-LEAST_COMPARED // gaps) if self.setup.robot is not None and self.wrench and gaps else 1
        return self.changed(accuracy=Accuracy.to_refine(self.setup.accuracy))._replace(every=every)

    @property
    def instants(self) -> np.ndarray:
        """(N,) [s], at which the swimmer is observed: the samples, and those between them."""
        between = np.arange(self.every) / self.every
        return np.append(self.times[:-1, None] + np.diff(self.times)[:, None] * between, self.times[-1])

    def simulation(self, accuracy: Accuracy | None = None) -> Simulation:
        """A simulation at its start, with other settings if `accuracy` is given."""
        setup = self.setup if accuracy is None else replace(self.setup, accuracy=accuracy)
        return Simulation(**setup.arguments, law=self.law)

    def swim(
        self, simulation: Simulation, look: Callable[[float], None] | None = None, out: Observations | None = None
    ) -> SwimResult[Kind]:
        """Swim it with a `simulation` of its own, at its start. look, out: as in `Simulation.record`."""
        instants, setup = self.instants, self.setup
        out, works, done, stopped = simulation.record(instants, self.wrench, self.load, look, out)
        start, (steps, _, evaluations) = simulation.energy_at_start, simulation.evaluations
        arrays = arrays_of(out, works, start, simulation.joints, done, bool(setup.scene.ledger))
        others = {"law": self.law, "accuracy": simulation.accuracy, "nodes": len(simulation.grid.x)}
        others |= {"steps": steps, "evaluations": evaluations}
        run = compared = self.kind.of(setup, instants[:done], arrays, **others)
        if self.every > 1:
            sampled = {name: np.ascontiguousarray(each[:: self.every]) for name, each in arrays.items()}
            run = self.kind.of(setup, compared.time[:: self.every], sampled, **others)
        return SwimResult(run, out, works, start, stopped, simulation.joints, compared, self.every)

    def swim_to_end(self, look: Callable[[float], None] | None = None) -> SwimResult[Kind]:
        """Swim it. `SimulationStopped`, with the samples so far as its `run`, where it does not come to its end."""
        swim = self.swim(self.simulation(), look)
        if (stopped := swim.stopped) is None:
            return swim
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
    """The swim of `run` with another law or accuracy, `finer` samples, or its `load`; its error is not estimated.

    `ValueError` if it began later.
    """
    if run.time[0] != 0.0:
        raise ValueError(f"run must begin at t = 0 to be simulated again, got {run.time[0]:g} s")
    axes, run = run.axes, run.in_axes(REP103)
    orientation = run.orientation[0] / np.linalg.norm(run.orientation[0])
    start = {"position": run.position[0], "orientation": orientation, "twist": run.twist[0]}
    how = {"accuracy": accuracy, "stations": run.x, "most_evaluations": most_evaluations}
    setup = SimulationSetup.of(**run.swimmer, **start, **how)
    sample_period = float(run.time[1] - run.time[0]) / finer if len(run.time) > 1 else 1.0
    load = load or run.fluid_force is not None
    request = SwimRequest.of(type(run), law, setup, float(run.time[-1]), sample_period, load)
    return request.swim_to_end().run.in_axes(axes)
