# SPDX-License-Identifier: Apache-2.0
"""A run: what `simulate` returns."""

import math
import os
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import chain
from typing import Any

import numpy as np
from eel_common.cached import cached_property
from eel_common.cell import cell_of
from eel_common.quantity import number

from eel_dynamics.analysis.analysis import Analysis
from eel_dynamics.analysis.joint_demand import Actuators, actuators_of
from eel_dynamics.analysis.model_limits import warnings_of
from eel_dynamics.analysis.peaks import FINER, MOST_SAMPLES, greatest_torque_of
from eel_dynamics.analysis.run_summary import describe
from eel_dynamics.analysis.settling import Unsettled
from eel_dynamics.model.body.body import Body
from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.model.scene import Scene
from eel_dynamics.runs.exchange.eel_viz_functions import function_of_eel_viz
from eel_dynamics.runs.exchange.messages_of_run import goal_message, messages_of_run
from eel_dynamics.runs.exchange.properties_of_run import properties_of_run
from eel_dynamics.runs.exchange.recorded_run import fields_of_bag
from eel_dynamics.runs.motions import SmoothingEffect, effect_of_smoothing
from eel_dynamics.runs.observed_swim import simulated_again
from eel_dynamics.runs.run_picture import picture_of_run
from eel_dynamics.runs.sensed import SensedRun
from eel_dynamics.runs.storage.netcdf import loaded, write
from eel_dynamics.runs.storage.run_contents import contents_of_run, fields_of_run
from eel_dynamics.runs.storage.tables import dataset_of, frame_of
from eel_dynamics.runs.storage.variables import documented_arrays
from eel_dynamics.simulation.observations import LOAD
from eel_dynamics.simulation.stopping import SimulationStopped

MOST_UNSMOOTHED = 5_000.0  # evaluations per simulated second of a motion without smoothing


@documented_arrays("run")
@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Run(SensedRun):
    """A run: T samples at M stations, in SI units. At rest the body lies along -x from the head; it swims towards +x.

    Two runs are equal where all their fields are, to the last bit. `energy` has one (T,) array per field; it is None
    without a ledger. `torque`, `force` and the closures are None without the internal wrench. `fluid_force` to
    `wake_momentum_rate` are None without `load=True`. Arrays:
    """

    def plot(self) -> Any:
        """A matplotlib figure: body and path from above, speed, yaw torque. `ImportError` without matplotlib."""
        return picture_of_run(self)

    def _repr_html_(self) -> str:
        return cell_of(self.plot, self.summary())

    @property
    def mean_speed(self) -> float:
        """`analysis().mean_speed` [m/s]: of the period-averaged centre of mass over the water, in the later half.

        `ValueError` where the gait has no period, or the run does not hold one. It warns as `analysis` does.
        """
        return self._warned(Analysis(self)).mean_speed

    def greatest_torque(self) -> tuple[float, float, float]:
        """Greatest magnitude [N m] of the internal torque over the run, with its X [m] and its time [s].

        It is the peak between samples and stations, to the error of the run: the swim around it is simulated anew
        (`analysis.peaks`). The peak of a run from a bag is that of splines through its samples.
        """
        if self.torque is None:
            raise ValueError("greatest_torque needs a run with scene internal_wrench on")
        return self._greatest_torque

    @cached_property
    def _greatest_torque(self) -> tuple[float, float, float]:
        return greatest_torque_of(self)

    def analysis(self, periods: int | None = None) -> Analysis:
        """Speed, Strouhal number, power, efficiency and more over the last `periods` whole periods of the gait.

        None: those of the run's later half. `ValueError` if the run is shorter than one period. The first analysis of
        a run over periods in which its gait had not settled gives an `Unsettled` warning.
        """
        return self._warned(Analysis(self, periods))

    def _warned(self, found: Analysis) -> Analysis:
        """The analysis; the first one of a gait that has not settled gives a warning."""
        if not found.settled and self.__dict__.setdefault("_told_unsettled", found) is found:
            line = f"{self.law.name}: the gait has not settled: {found.settling}"
            warnings.warn(f"{line}; swim longer, or with duration='settled'", Unsettled, stacklevel=3)
        return found

    def actuators(self, joints: int) -> Actuators:
        """Angles, speeds, torques and powers of a robot with `joints` motors in pitch and as many in yaw."""
        return actuators_of(self, joints)

    def summary(self, periods: int | None = None) -> str:
        """A text of the run's figures with units: of the whole run, then of its last `periods` whole periods."""
        return describe(self, periods)

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """One line each: an error above the target, and the model's limits that were exceeded (`model_limits.py`)."""
        missed = self.error_estimate and self.error_estimate.over_target(self.accuracy.target, float(self.time[-1]))
        return (missed, *warnings_of(self)) if missed else warnings_of(self)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the whole run to a netCDF file (.nc), which `load` reads, as do xarray and others.

        It holds all fields, the warnings and the software's version. A body given by functions of your own is kept as
        polynomials through the squares of its half-axes. `ValueError` for a path that does not fit.
        """
        write(contents_of_run(self), path)

    @staticmethod
    def load(path: str | os.PathLike[str]) -> "Run":
        """The run that `save` wrote, in REP-103 axes. `ValueError` in one line for a file that is none.

        A file in the paper's axes, as all were that do not name theirs, is converted, with a warning of one line.
        """
        run: Run = loaded(path, "run", lambda contents: Run(**fields_of_run(contents)))
        return run

    @staticmethod
    def from_bag(
        path: str | os.PathLike[str],
        namespace: str | None = None,
        *,
        body: Body | None = None,
        scene: Scene | None = None,
        robot: Robot | str | None = None,
    ) -> "Run":
        """The run of the swimmer that a bag holds, from the topics of the dynamics node.

        namespace: the swimmer's; None: that of the only one. body, scene: those of the node; by default the body of the
        topic `body`, and `Scene()`, as no topic tells scene, flow, fins and wrenches. robot: that of the node, or its
        name or file; the run then has the motion of its joints. Topics that the bag lacks leave their fields None; the
        head's acceleration and the centre of mass come from splines. `steps`, `evaluations` and `nodes` are 0.
        `ValueError` in one line where the bag holds no run; `ImportError` without the package eel_viz.
        """
        return Run(**fields_of_bag(path, namespace, body, scene, robot))

    def to_xarray(self) -> Any:
        """An `xarray.Dataset` of all arrays with dimensions and units. Its attributes are those of a file of `save`.

        `ImportError` without xarray.
        """
        return dataset_of(contents_of_run(self))

    def to_dataframe(self) -> Any:
        """A `pandas.DataFrame` by time: head, centre of mass, twist, and energies where there is a ledger.

        `ImportError` without pandas.
        """
        return frame_of(self)

    def to_rerun(
        self,
        target: Any,
        compare: "Run | None" = None,
        *,
        load: bool = True,
        rate: float = 50.0,
        numbers: dict[str, Any] | None = None,
        goal: Any = None,
        **settings: Any,
    ) -> None:
        """Record the run to Rerun, as the visualiser shows a swimmer, with its figures as properties.

        target: a file (.rrd) or a `rerun.RecordingStream`. compare: another run, drawn over this one. load: show the
        water's force and the wake; rate: samples per second [Hz], so that the film is smooth. A run without that load,
        or with fewer samples, is simulated again for them; 0 keeps the run's own samples. numbers: numbers and texts of
        your own, by name, as the properties `numbers`. goal: way points to draw, (n, 3) [m]. settings: of the
        visualiser, such as blueprint="torques", skin_rate=50. `ImportError` without the package eel_viz and rerun-sdk.
        """
        record, runs = function_of_eel_viz("rerun"), [self] if compare is None else [self, compare]
        rate = number("rate", rate, "Hz", minimum=0.0)
        runs = [run._with_samples(rate, load) for run in runs]
        names = [f"{run.law.name} {run.accuracy.name}" for run in runs]
        properties = properties_of_run(self) | ({"numbers": numbers} if numbers else {})
        messages: list[Iterator[Any]] = [messages_of_run(run) for run in runs]
        if goal is not None:
            messages[0] = chain([goal_message(goal)], messages[0])
        record(target, messages, names, properties, **settings)

    @cached_property
    def refined(self) -> "Run":
        """The same run with a tenth of the error, simulated on first access. `ValueError` if it begins after t = 0."""
        return simulated_again(self, self.law, self.accuracy.tightened(0.1))

    def with_load(self) -> "Run":
        """The run with the water's load along the body, for which it is simulated again if need be.

        The run itself where that cannot be: it was recorded elsewhere, is another swim when simulated again, begins
        after t = 0, or has no internal wrench.
        """
        if self.fluid_force is not None or not self.scene.internal_wrench or (again := self._again(load=True)) is None:
            return self
        alike = again.position.shape == self.position.shape and np.allclose(again.position, self.position, atol=1e-9)
        return replace(self, **{name: getattr(again, name) for name in LOAD}) if alike else self

    def _with_samples(self, rate: float, load: bool) -> "Run":
        """The run with `rate` samples per second [Hz] at least, and its `load`, simulated again if need be and
        possible."""
        finer = math.ceil(rate * float(np.max(np.diff(self.time), initial=0.0)) - 1e-9)
        again = self._again(finer=finer, load=load and self.scene.internal_wrench) if finer > 1 else None
        whole = again is not None and len(again.time) == finer * (len(self.time) - 1) + 1
        if again is not None and whole and np.allclose(again.position[::finer], self.position, atol=1e-9):
            return again
        return self.with_load() if load else self

    def finely_sampled(self) -> "Run":
        """The same run, simulated anew with `FINER` samples in each sample period, for peaks (`analysis.peaks`).

        There are fewer where they would be more than `MOST_SAMPLES`. The run itself where it was recorded elsewhere or
        begins after t = 0.
        """
        finer = min(FINER, MOST_SAMPLES // max(1, len(self.time)))
        return (self._again(finer=finer) if finer > 1 and len(self.time) > 1 else None) or self

    def _again(self, **how: Any) -> "Run | None":
        """The run, simulated anew as `simulated_again` has it; None where that cannot be."""
        try:
            return simulated_again(self, self.law, self.accuracy.as_it_is(), **how) if self.steps else None
        except (SimulationStopped, ValueError):
            return None

    @cached_property
    def smoothing(self) -> SmoothingEffect | None:
        """What the run would be without the smoothing of its measured motion; None where nothing was smoothed.

        Simulated on first access. `ValueError` or `SimulationStopped` where it cannot be swum without smoothing.
        """
        law = getattr(self.law, "unsmoothed", None)
        if law is None:
            return None
        return effect_of_smoothing(self, simulated_again(self, law, self.accuracy.as_it_is(), MOST_UNSMOOTHED))
