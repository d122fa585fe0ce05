# SPDX-License-Identifier: Apache-2.0
"""Simulates one run of a law: `simulate`, and the `Run` that it returns."""

import os
import warnings
from collections.abc import Callable, Iterable
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from eel_base.attitude import world_from_section
from eel_base.cell import cell_of
from eel_base.wording import shown
from eel_gaits.laws.law import Law
from eel_gaits.sources.sampled_law import SampledLaw
from eel_model.axes import CONVENTIONS, REP103, SIGNS, turn_vector, turned
from eel_model.body.body import Body
from eel_model.equality import same_fields
from eel_model.fins.fins import Fin
from eel_model.flow.flow import Flow, check_covers
from eel_model.robot.robot import Robot
from eel_model.scene import Scene
from numpy.typing import ArrayLike

from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.accuracy.error_estimate import ErrorEstimate
from eel_dynamics.accuracy.step_bounds import MOST_EVALUATIONS
from eel_dynamics.analysis.actuators import Actuators, actuators_of
from eel_dynamics.analysis.analysis import Analysis
from eel_dynamics.analysis.model_limits import warnings_of
from eel_dynamics.analysis.peaks import FINER, MOST_SAMPLES, greatest_torque_of
from eel_dynamics.analysis.run_summary import describe
from eel_dynamics.analysis.settling import Unsettled
from eel_dynamics.runs.companion import stable_step, with_error_estimate
from eel_dynamics.runs.exchange.eel_viz_functions import recorder_of_runs
from eel_dynamics.runs.exchange.messages_of_run import messages_of_run
from eel_dynamics.runs.exchange.properties_of_run import properties_of_run
from eel_dynamics.runs.exchange.recorded_run import fields_of_bag
from eel_dynamics.runs.motions import Motion, SmoothingEffect, effect_of_smoothing, law_from
from eel_dynamics.runs.progress_monitor import ProgressMonitor
from eel_dynamics.runs.run_picture import picture_of_run
from eel_dynamics.runs.sampling import check_memory, checked_times, default_sample_period
from eel_dynamics.runs.settled_duration import period_of, settling_time, until_settled
from eel_dynamics.runs.storage.netcdf import loaded, write
from eel_dynamics.runs.storage.run_contents import contents_of_run, fields_of_run
from eel_dynamics.runs.storage.tables import dataset_of, frame_of
from eel_dynamics.runs.variables import documented_arrays
from eel_dynamics.simulation.bending.joint_motion import JointMotion
from eel_dynamics.simulation.energy import EnergyLedger
from eel_dynamics.simulation.observations import FINS, LOAD, WRENCH, Observations
from eel_dynamics.simulation.simulation import Simulation
from eel_dynamics.simulation.simulation_setup import SimulationSetup, check_planar_law
from eel_dynamics.simulation.stopping import SimulationStopped

MOST_UNSMOOTHED = 5_000.0  # evaluations per simulated second of a motion without smoothing


@documented_arrays("run")
@dataclass(frozen=True, eq=False, repr=False)
class Run:
    """A run: T samples at M stations, in SI units. At rest the body lies along -x from the head; it swims towards +x.

    Two runs are equal where all their fields are, to the last bit. `energy` has one (T,) array per field; it is None
    without a ledger. `torque`, `force` and the closures are None without the internal wrench. `fluid_force` to
    `wake_momentum_rate` are None without `load=True`. Arrays:
    """

    law: Law | SampledLaw
    body: Body
    scene: Scene
    accuracy: Accuracy
    time: np.ndarray
    position: np.ndarray
    orientation: np.ndarray
    twist: np.ndarray
    head_acceleration: np.ndarray
    center_of_mass: np.ndarray
    x: np.ndarray
    backbone: np.ndarray
    section_orientation: np.ndarray
    curvature: np.ndarray
    curvature_rate: np.ndarray
    torque: np.ndarray | None
    force: np.ndarray | None
    fluid_force: np.ndarray | None
    resistive_force: np.ndarray | None
    tail_force: np.ndarray | None
    nose_force: np.ndarray | None
    wake_momentum_rate: np.ndarray | None
    energy: EnergyLedger | None
    closure_torque: np.ndarray | None
    closure_force: np.ndarray | None
    steps: int
    evaluations: int
    nodes: int
    error_estimate: ErrorEstimate | None = None  #: None where none was wanted, or for fewer than two samples
    flow: Flow | None = None  #: of the water; its own numbers are in REP-103 axes always
    fins: tuple[Fin, ...] = ()
    fin_angle: np.ndarray | None = None
    fin_force: np.ndarray | None = None
    robot: Robot | None = None  #: what bends by itself; the joints' arrays are None without one
    joint_angle: np.ndarray | None = None
    joint_rate: np.ndarray | None = None
    joint_torque: np.ndarray | None = None
    motor_angle: np.ndarray | None = None
    motor_torque: np.ndarray | None = None
    motor_power: np.ndarray | None = None
    mode_amplitude: np.ndarray | None = None
    mode_rate: np.ndarray | None = None
    axes: str = REP103  #: of world and head: "rep103" (x forward, y left, z up), or "paper"

    def __eq__(self, other: object) -> bool:
        return self is other or same_fields(self, other)

    def __hash__(self) -> int:
        return hash((self.law, self.body, self.scene, self.steps, self.evaluations, self.nodes))

    def __getstate__(self) -> dict[str, Any]:  # without what can be computed again
        return {item.name: getattr(self, item.name) for item in fields(self)}

    def __repr__(self) -> str:
        end = f"{self.time[-1]:g} s" if len(self.time) else "no time"
        return (
            f"Run({self.law.name!r}, {self.body.name!r}, {end}, {len(self.time)} samples, {len(self.x)} stations, "
            f"accuracy {self.accuracy.name!r})"
        )

    def plot(self) -> Any:
        """A matplotlib figure: body and path from above, speed, yaw torque. `ImportError` without matplotlib."""
        return picture_of_run(self)

    def _repr_html_(self) -> str:
        return cell_of(self.plot, self.summary())

    def __post_init__(self) -> None:
        if not (self.time[1:] > self.time[:-1]).all():
            falls = np.flatnonzero(np.diff(self.time) <= 0.0)
            before, after = self.time[falls[0]], self.time[falls[0] + 1]
            raise ValueError(
                f"run time must rise, got {after:g} s after {before:g} s: a reset? Make a run of the samples after it"
            )

    @property
    def twist_rate(self) -> np.ndarray:
        """(T, 6) (Omegadot, Vdot): rate of the components of the twist, rad/s^2, m/s^2, head's axes."""
        rate = self.head_acceleration.copy()
        rate[:, 3:] -= np.cross(self.twist[:, :3], self.twist[:, 3:])
        return rate

    @property
    def torque_world(self) -> np.ndarray:
        """(T, M, 3) N m: the internal torque in the axes of the world. `ValueError` where there is none."""
        return self._in_world("torque")

    @property
    def force_world(self) -> np.ndarray:
        """(T, M, 3) N: the internal force in the axes of the world. `ValueError` where there is none."""
        return self._in_world("force")

    def in_axes(self, axes: str) -> "Run":
        """This run with world and head in these `axes`: "rep103" (x forward, y left, z up), or "paper".

        In the paper's axes the eel swims towards -x. What has section axes is the same in both. `ValueError` for other
        axes.
        """
        if axes not in CONVENTIONS:
            raise ValueError(f"axes must be {' or '.join(CONVENTIONS)}, got {shown(axes)}")
        if axes == self.axes:
            return self
        scene = replace(self.scene, current=tuple(turn_vector(self.scene.current).tolist()))
        changes: dict[str, Any] = turned({name: getattr(self, name) for name in SIGNS})
        return replace(self, axes=axes, scene=scene, **changes)

    def _in_world(self, name: str) -> np.ndarray:
        if getattr(self, name) is None:
            raise ValueError(f"{name}_world needs a run with scene internal_wrench on")
        own = self.in_axes(REP103)
        found = world_from_section(own.section_orientation, getattr(own, name))
        return found if self.axes == REP103 else turn_vector(found)

    @property
    def path_length(self) -> float:
        """Length [m] of the head's path through the samples."""
        return float(np.sum(np.linalg.norm(np.diff(self.position, axis=0), axis=1)))

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
        if not found.settled:
            _ = self._warned_unsettled
        return found

    @cached_property
    def _warned_unsettled(self) -> bool:
        """Whether a warning was given that the means are of a gait that has not settled: from the first access."""
        change = Analysis(self).change_per_period
        by = "one period does not tell its change" if change is None else f"it changes by {change:.1%} a period"
        line = f"{self.law.name}: the mean speed has not settled ({by}); swim longer, or with duration='settled'"
        warnings.warn(line, Unsettled, stacklevel=5)
        return True

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
    ) -> "Run":
        """The run of the swimmer that a bag holds, from the topics of the dynamics node.

        namespace: the swimmer's; None: that of the only one. body, scene: those of the node; by default the body of the
        topic `body`, and `Scene()`, as no topic tells the scene. Topics that the bag lacks leave their fields None; the
        head's acceleration, the works and the centre of mass come from splines. `steps`, `evaluations` and `nodes` are
        0. `ValueError` in one line where the bag holds no run; `ImportError` without the package eel_viz.
        """
        return Run(**fields_of_bag(path, namespace, body, scene))

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
        numbers: dict[str, Any] | None = None,
        **settings: Any,
    ) -> None:
        """Record the run to Rerun, as the visualiser shows a swimmer, with its figures as properties.

        target: a file (.rrd) or a `rerun.RecordingStream`. compare: another run, drawn over this one. load: show the
        water's force and the wake; a run without them is simulated again for them. numbers: numbers and texts of your
        own, by name, as the properties `numbers`. settings: of the visualiser, such as blueprint="torques",
        skin_rate=50. `ImportError` without the package eel_viz and rerun-sdk.
        """
        record, runs = recorder_of_runs(), [self] if compare is None else [self, compare]
        runs = [run.with_load() if load else run for run in runs]
        names = [f"{run.law.name} {run.accuracy.name}" for run in runs]
        properties = properties_of_run(runs[0]) | ({"numbers": numbers} if numbers else {})
        record(target, [messages_of_run(run) for run in runs], names, properties, **settings)

    @cached_property
    def refined(self) -> "Run":
        """The same run with a tenth of the error, simulated on first access. `ValueError` if it begins after t = 0."""
        return _simulated_again(self, self.law, self.accuracy.tightened(0.1))

    def with_load(self) -> "Run":
        """The run with the water's load along the body, for which it is simulated again if need be.

        The run itself where that cannot be: it was recorded elsewhere, is another swim when simulated again, begins
        after t = 0, or has no internal wrench.
        """
        if self.fluid_force is not None or not self.steps or not self.scene.internal_wrench:
            return self
        try:
            again = _simulated_again(self, self.law, self.accuracy.as_it_is(), load=True)
        except (SimulationStopped, ValueError):
            return self
        alike = again.position.shape == self.position.shape and np.allclose(again.position, self.position, atol=1e-9)
        return replace(self, **{name: getattr(again, name) for name in LOAD}) if alike else self

    def finely_sampled(self) -> "Run":
        """The same run, simulated anew with `FINER` samples in each sample period, for peaks (`analysis.peaks`).

        There are fewer where they would be more than `MOST_SAMPLES`. The run itself where it was recorded elsewhere or
        begins after t = 0.
        """
        finer = min(FINER, MOST_SAMPLES // max(1, len(self.time)))
        if not self.steps or finer < 2 or len(self.time) < 2:
            return self
        try:
            return _simulated_again(self, self.law, self.accuracy.as_it_is(), finer=finer)
        except (SimulationStopped, ValueError):
            return self

    @cached_property
    def smoothing(self) -> SmoothingEffect | None:
        """What the run would be without the smoothing of its measured motion; None where nothing was smoothed.

        Simulated on first access. `ValueError` or `SimulationStopped` where it cannot be swum without smoothing.
        """
        law = getattr(self.law, "unsmoothed", None)
        if law is None:
            return None
        return effect_of_smoothing(self, _simulated_again(self, law, self.accuracy.as_it_is(), MOST_UNSMOOTHED))

    @property
    def swimmer(self) -> dict[str, Any]:
        """What `Simulation` and `simulate` take of the run: body, scene, flow, robot and fins."""
        return {name: getattr(self, name) for name in ("body", "scene", "flow", "robot", "fins")}

    @property
    def body_mass(self) -> float:
        """Mass of the body in this scene [kg]."""
        return self.body.mass_in(self.scene.density)


def simulate(
    law: Motion,
    duration: float | str = 10.0,
    *,
    body: Body | None = None,
    scene: Scene | None = None,
    accuracy: "str | float | Accuracy" = "standard",
    sample_period: float | None = None,
    stations: int | ArrayLike = 51,
    position: ArrayLike = (0.0, 0.0, 0.0),
    orientation: ArrayLike = (0.0, 0.0, 0.0, 1.0),
    twist: ArrayLike = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    load: bool = False,
    estimate: bool = True,
    most_evaluations: float = MOST_EVALUATIONS,
    progress: Callable[[float, float], None] | None = None,
    flow: Flow | None = None,
    robot: Robot | None = None,
    fins: Iterable[Any] | None = None,
) -> Run:
    """Simulate `law` for `duration` [s], with samples every `sample_period` [s] from t = 0 on.

    The steps in time do not depend on the sampling. `ValueError` names what does not fit. `SimulationStopped` carries
    the samples so far as `run`.

    Args:
        law: a `Law`, a `SampledLaw`, a function K(t, X) (`eel_gaits.sampled`), or a file (`eel_gaits.read_motion`).
        duration: [s], or "settled": a whole number of periods until the gait has settled (`runs.settled_duration`), at
            most 100.
        body, scene, accuracy: as in `Simulation`.
        sample_period: [s]; None for 0.05 s, or a 20th of the law's shortest period where that is less. The last sample
            is at the last whole multiple of it: at 0.9 s for a duration of 1 s and a sample period of 0.3 s.
        stations: number of equidistant stations, or their X (M,) [m].
        position: (3,) [m], of the head at the start.
        orientation: (4,) x y z w, at the start.
        twist: (6,) (Omega, V) [rad/s, m/s], in the head's axes, at the start.
        load: whether to compute the water's load along the body too.
        estimate: whether to measure the error (`Run.error_estimate`). Where it exceeds the target, a finer run is
            returned, or a warning given if none is fine enough.
        most_evaluations: of the head's dynamics per simulated second. A law that needs more is refused, or stopped.
        progress: progress(time, left) is called once a second with the simulation time reached [s] and the remaining
            wall time [s]. Without it, a run longer than a minute gives a warning.
        flow: how the water moves by itself, beside the scene's current (`Gust`, `Wave` ...); None: not at all.
        robot: joints, tails or muscles that bend by themselves. The law then is what its servos are asked to follow,
            and `Run.joint_angle` and the like are what they do; None: the law is imposed.
        fins: a list of `Fin`, and of pairs of them (`Fin.pair`); None: none.
    """
    setup = SimulationSetup.of(
        body=body,
        scene=scene,
        accuracy=accuracy,
        stations=stations,
        initial_state=(position, orientation, twist),
        most_evaluations=most_evaluations,
        flow=flow,
        robot=robot,
        fins=fins,
    )
    length, wrench = setup.body.length, setup.scene.internal_wrench
    if until_settled(duration):
        period_of(law, length)
        duration = settling_time(law, setup)
    seconds: Any = duration  # a text is refused below
    law = law_from(law, seconds, length)
    if setup.scene.planar:
        check_planar_law(law)
    times = checked_times(duration, default_sample_period([law], duration) if sample_period is None else sample_period)
    check_covers(flow, float(times[-1]))
    check_memory(1, len(times), len(setup.x), wrench, bool(load), runs=2 if estimate else 1)
    if estimate:
        setup = replace(setup, accuracy=Accuracy.to_refine(setup.accuracy))
    request = SwimRequest(law, setup, times, wrench, bool(load))
    look = ProgressMonitor(float(duration), progress).update
    swim = request.swim(request.simulation(), look)
    if swim.stopped is not None:
        stopped, settings = swim.stopped, swim.run.accuracy
        stopped.run = swim.run
        raise stopped if settings.step is None else _with_stable_step(stopped, request, settings)
    run = (with_error_estimate(swim, request) if estimate else swim).run
    if run.error_estimate is not None and (missed := run.error_estimate.over_target(run.accuracy.target, seconds)):
        warnings.warn(missed, stacklevel=2)
    return run


def _simulated_again(
    run: Run,
    law: Law | SampledLaw,
    accuracy: Accuracy,
    most_evaluations: float = MOST_EVALUATIONS,
    finer: int = 1,
    load: bool = False,
) -> Run:
    """The swim of `run` with another law or accuracy, `finer` samples, or its `load`; its error is not estimated.

    `ValueError` if it began later.
    """
    if run.time[0] != 0.0:
        raise ValueError(f"run must begin at t = 0 to be simulated again, got {run.time[0]:g} s")
    axes, run = run.axes, run.in_axes(REP103)
    again = simulate(
        law,
        float(run.time[-1]),
        accuracy=accuracy,
        sample_period=float(run.time[1] - run.time[0]) / finer if len(run.time) > 1 else 1.0,
        stations=run.x,
        position=run.position[0],
        orientation=run.orientation[0] / np.linalg.norm(run.orientation[0]),
        twist=run.twist[0],
        load=load or run.fluid_force is not None,
        estimate=False,
        most_evaluations=most_evaluations,
        progress=lambda reached, left: None,
        **run.swimmer,
    )
    return again.in_axes(axes)


class SwimResult(NamedTuple):
    """A run, what it was made from, and why it stopped before its end, if it did."""

    run: Run
    out: Observations
    works: np.ndarray  # (T, 6) J
    energy_at_start: float  # J
    stopped: SimulationStopped | None
    joints: JointMotion | None = None  # of a robot


class SwimRequest(NamedTuple):
    """A swimmer that swims by `law`, the times (T,) [s] of its samples, and whether to record wrench and load."""

    law: Law | SampledLaw
    setup: SimulationSetup
    times: np.ndarray
    wrench: bool
    load: bool

    def changed(self, **changes: Any) -> "SwimRequest":
        """The same with other fields of its `setup`."""
        return self._replace(setup=replace(self.setup, **changes))

    def simulation(self, accuracy: Accuracy | None = None) -> Simulation:
        """A simulation at its start, with other settings if `accuracy` is given."""
        setup = self.setup if accuracy is None else replace(self.setup, accuracy=accuracy)
        return Simulation(**setup.arguments, law=self.law)

    def swim(
        self,
        simulation: Simulation,
        look: Callable[[float], None] | None = None,
        out: Observations | None = None,
    ) -> SwimResult:
        """Swim it with a `simulation` of its own, at its start. look, out: as in `Simulation.record`."""
        out, works, done, stopped = simulation.record(self.times, self.wrench, self.load, look, out)
        start, (steps, _, evaluations) = simulation.energy_at_start, simulation.evaluations
        run = run_of(
            self.setup,
            out,
            works=works[:done],
            start=start,
            time=self.times[:done],
            wrench=self.wrench,
            load=self.load,
            law=self.law,
            accuracy=simulation.accuracy,
            steps=steps,
            evaluations=evaluations,
            nodes=len(simulation.grid.x),
            joints=simulation.joints,
        )
        return SwimResult(run, out, works, start, stopped, simulation.joints)


def run_of(
    setup: Any,
    out: Observations,
    *,
    works: np.ndarray,
    start: float,
    time: np.ndarray,
    wrench: bool,
    load: bool,
    joints: JointMotion | None = None,
    **others: Any,
) -> Run:
    """The run of the samples in `out` that were reached.

    setup: has the body, the scene, the flow and the stations x. works (T, 6) [J], and time (T,) [s]: of those samples.
    start [J]: the energy at the start. wrench, load: whether the internal wrench and the water's load were observed.
    joints: the motion of a robot's joints at all samples. others: the other fields of the run.
    """
    absent = {*(() if wrench else WRENCH), *(() if load else LOAD), *(() if setup.fins else FINS)}
    observed: dict[str, Any] = {
        name: None if name in absent else array[: len(time)] for name, array in out.arrays().items()
    }
    for name in FINS if setup.fins else ():  # of a batch there may be places for more
        observed[name] = observed[name][:, : len(setup.fins)]
    robot = None
    if joints is not None:
        observed |= {name: array[: len(time)] for name, array in joints.arrays().items()}
        robot = joints.ledger()[: len(time)]
    energies, powers, closure = (observed.pop(name) for name in ("energies", "powers", "closure"))
    return Run(
        body=setup.body,
        scene=setup.scene,
        flow=setup.flow,
        x=setup.x,
        time=time,
        robot=setup.robot,
        fins=setup.fins,
        energy=EnergyLedger.of(energies, powers, works, start, robot) if setup.scene.ledger else None,
        closure_torque=None if closure is None else closure[:, 0],
        closure_force=None if closure is None else closure[:, 1],
        **observed,
        **others,
    )


def _with_stable_step(stopped: SimulationStopped, request: SwimRequest, accuracy: Accuracy) -> SimulationStopped:
    """The same error, with a stable step in its hint."""
    step = stable_step(request, accuracy)
    hint = f"a step of {step:.3g} s is stable" if step else "no shorter step that was tried is stable"
    better = SimulationStopped(stopped.time, stopped.quantity, stopped.value, f"{hint}; it was {accuracy.step:.3g} s")
    better.run, better.diverged = stopped.run, True
    return better


__all__ = ["Run", "SimulationStopped", "simulate"]
