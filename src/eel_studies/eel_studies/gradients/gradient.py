# SPDX-License-Identifier: Apache-2.0
"""Derivatives of the measures of a run with respect to its parameters: `gradient`.

    found = gradient(["mean_speed", "cost_of_transport"], {"period": 1.0, "body.lateral_drag": 1.98}, gait="straight")
    found["mean_speed"]["period"]             # -0.6 m/s per s
    found.derivative, found.error             # (N, P) arrays: the Jacobian, and its estimated error

    def slowness(x):                          # for scipy.optimize.minimize(slowness, x0, jac=True)
        found = gradient("mean_speed", {"amplitude_0": x[0]}, gait="straight")
        return -found.value[0], -found.derivative[0]

The derivatives are central differences of two swims per parameter, all in one batch, on one grid and with one sequence
of fixed steps: step control adds no noise. Their error is measured as that of a run is: by companions with coarser
settings and twice the difference. For a robot, one swim first finds how many steps are needed, and whether motors reach
their limits. Limits are kinks, which need larger differences.
"""

import warnings
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from eel_common.attitude import world_from_body
from eel_common.command.progress import progress_of
from eel_common.quantity import checked_choice, checked_instance, number, positive
from eel_common.wording import shown
from eel_dynamics.accuracy.accuracy import STANDARD
from eel_dynamics.accuracy.step_bounds import MOST_EVALUATIONS
from eel_dynamics.analysis.analysis import Analysis
from eel_dynamics.analysis.measures import checked_measures
from eel_dynamics.batches.simulate_batch import swum
from eel_dynamics.model.equality import EqualByFields
from eel_dynamics.model.robot.actuators import at_limit
from eel_dynamics.model.section_data import CRITICAL_REYNOLDS
from eel_dynamics.runs.companion import relative_errors
from eel_dynamics.runs.sampling import default_sample_period

from eel_dynamics import Accuracy, Batch, Body, Robot, Run, Scene, Swim
from eel_studies.gradients.fixed_discretisation import fixed_steps, on_one_grid, step_of
from eel_studies.points import (
    AccuracyLike,
    Gait,
    Measure,
    Numbers,
    Progress,
    Stations,
    base_of,
    law_of_terms,
    measured,
    point_at,
    without_the_rest,
)

RELATIVE_STEP = 1e-5  # of a parameter's value, or of 1 unit if that is 0
ROBOT_STEP, KINKED_STEP = 1e-3, 1e-2  # the same for a robot, and for a robot whose motors reach their limits
PRINTED = "printed"  # the friction law that jumps
COMPANION_STEP = 2.0  # times the step: the companions' step


@dataclass(frozen=True, eq=False, repr=False)
class Gradient(EqualByFields):
    """Derivatives of N measures by P parameters."""

    of: tuple[str, ...]  #: names of the measures
    by: tuple[str, ...]  #: names of the parameters
    at: np.ndarray  #: (P,) values of the parameters
    value: np.ndarray  #: (N,) measures there
    derivative: np.ndarray  #: (N, P) the Jacobian: measure's unit / parameter's unit
    error: np.ndarray  #: (N, P) estimated errors of the derivatives; NaN without an estimate
    steps: np.ndarray  #: (P,) step of each parameter to either side
    warnings: tuple[str, ...]
    run: Run  #: the swim at these values

    def __getitem__(self, measure: str) -> dict[str, float]:
        """The derivatives of a `measure`, by the name of the parameter."""
        if measure not in self.of:
            raise KeyError(measure)
        return dict(zip(self.by, self.derivative[self.of.index(measure)].tolist(), strict=True))

    def __repr__(self) -> str:
        return f"Gradient(of {', '.join(self.of)}; by {', '.join(self.by)})"


def gradient(
    of: str | tuple[str, ...] | Measure,
    parameters: dict[str, float],
    *,
    gait: Gait = "straight",
    numbers: Numbers | None = None,
    duration: float = 10.0,
    body: Body | None = None,
    scene: Scene | None = None,
    robot: Robot | str | None = None,
    accuracy: AccuracyLike = STANDARD,
    sample_period: float | None = None,
    stations: Stations = 51,
    steps: dict[str, float] | None = None,
    estimate: bool = True,
    threads: int | None = None,
    progress: Progress = False,
    most_evaluations: float = MOST_EVALUATIONS,
) -> Gradient:
    """Derivatives of measures of a run with respect to its parameters, at the values given.

    of: names of `analysis.measures.MEASURES` ("head_x", "mean_speed", "actuator_work", "cost_of_transport",
    "greatest_torque", ...), or a smooth function run -> {name: number}. parameters: value by name, with the names of
    `studies.points`: numbers of the gait, "scene.density", "body.lateral_drag", "initial.v_x" and the like. gait: its
    name, or a function of `numbers` and the parameters that returns a law. duration [s], body, scene, sample_period
    [s], stations, threads, most_evaluations: as in `simulate_batch`. accuracy: a target, or settings with fixed steps.
    steps: differences by name; by default 1e-5 of the value (1e-3 for a robot, 1e-2 if its motors reach their limits;
    of 1 if the value is 0). estimate: also estimate the derivatives' errors; False: only two swims per parameter.
    progress: as in `sweep`, by swims.

    The other swims have the grid and step of the swim at the values. They have ledger, internal wrench and intermediate
    samples only if the measures, or a warning, need them. Measures over whole periods take the same number of periods
    from each swim, so that they do not jump with the period. Warnings name what may spoil a derivative; they are also
    in `Gradient.warnings`. `ValueError` names a bad argument; `SimulationStopped`: a swim stopped.
    """
    measure = of if callable(of) else checked_measures("of", of, estimate=False)
    if not isinstance(parameters, dict) or not parameters:
        raise ValueError(f"parameters must be a dict of names and values, got {shown(parameters)}")
    at = {name: number(f"parameter {name}", value) for name, value in parameters.items()}
    limit = positive("most_evaluations", most_evaluations, "per simulated second")
    base = base_of(gait, body=body, scene=scene, robot=robot, accuracy=fixed_steps(accuracy))
    point = _point(at, gait, numbers, base)
    settings = point.accuracy.in_scene(point.scene)
    if sample_period is None:
        sample_period = default_sample_period([point.law], duration)
    own = {"duration": duration, "sample_period": sample_period, "stations": stations, "most_evaluations": limit}
    base, point = base.unchecked(**own, estimate=False), point.changed(**own, estimate=False)
    tell, swims = progress_of(progress, "swims"), 1 + 2 * len(at)

    lines: tuple[str, ...] = ()
    relative, limit = RELATIVE_STEP, np.inf
    if point.robot is not None:
        relative, limit, lines = _of_robot(point, Accuracy.of(accuracy))
    apart = _steps_of(at, steps, relative)

    def taken(settings: Accuracy, apart: np.ndarray, before: int, limit: float) -> _Differences:
        moved = [at] + [at | {name: float(at[name] + h)} for name, h in zip([*at] * 2, [*apart, *-apart], strict=True)]
        points = [_point(values, gait, numbers, base.unchecked(accuracy=settings)) for values in moved]
        middle, *beside = on_one_grid(points, min(limit, step_of(points[0])))
        beside = [without_the_rest(each, measure, may_jump(each.scene)) for each in beside]
        runs: list[Run] = []

        def count(done: int, _: int) -> None:
            tell(before + len(runs) + done, swims * (1 + bool(estimate)))

        for part in ([middle], beside):
            batch = swum(part, threads, count)
            runs += [_run(batch, index) for index in range(len(part))]
        return _Differences.of(runs, measure, apart)

    fine = taken(settings, apart, 0, limit)
    error = np.full(fine.derivative.shape, np.nan)
    if estimate:
        error = fine.distance(taken(settings.coarser(), COMPANION_STEP * apart, swims, COMPANION_STEP * limit))
    lines += _jumps(fine.runs, tuple(at))
    for line in lines:
        warnings.warn(line, stacklevel=2)
    values = np.array(list(at.values()))
    return Gradient(fine.names, tuple(at), values, fine.value, fine.derivative, error, apart, lines, fine.runs[0])


class _Differences(NamedTuple):
    """Measures of a swim and their central differences, from the runs at the values, above them, and below them."""

    runs: list[Run]
    names: tuple[str, ...]
    value: np.ndarray  # (N,)
    derivative: np.ndarray  # (N, P)

    @staticmethod
    def of(runs: list[Run], measure: Measure | tuple[str, ...], apart: np.ndarray) -> "_Differences":
        """The differences of `runs` whose parameters are shifted by `apart` (P,) to either side."""
        periods = _periods(runs[0])
        found = [measured(run, measure, periods) for run in runs]
        names = tuple(found[0])
        table = np.array([[each[name] for name in names] for each in found], dtype=float)
        if not np.isfinite(table).all():
            name = names[np.argmax(~np.isfinite(table).all(axis=0))]
            raise ValueError(f"measure {name} is undefined at these values, or beside them: it has no derivative")
        above, below = np.split(table[1:], 2)
        return _Differences(runs, names, table[0], ((above - below) / (2.0 * apart[:, None])).T)

    def distance(self, coarser: "_Differences") -> np.ndarray:
        """The estimated errors (N, P) of the derivatives, from those with `coarser` settings.

        They are the distance of the derivatives, and the relative distance of the swims and the measure itself, in case
        two derivatives agree by chance.
        """
        least = np.finfo(float).tiny
        apart = np.abs(self.value - coarser.value) / np.maximum(np.abs(self.value), least)
        apart = np.minimum(apart, 1.0) + relative_errors(self.runs[0], coarser.runs[0]).worst
        error: np.ndarray = np.abs(self.derivative - coarser.derivative) + apart[:, None] * np.abs(self.derivative)
        return error


def _periods(run: Run) -> int | None:
    """Whole periods of the gait in the later half of `run`; None without."""
    try:
        return Analysis(run).window.periods
    except ValueError:
        return None


def _point(values: Numbers, gait: Gait, numbers: Numbers | None, base: Swim) -> Swim:
    try:
        point = point_at(values, gait, numbers or {}, base)
        law_of_terms(point.law)
    except ValueError as error:
        raise ValueError(f"gradient {error}") from None
    return point


def _run(batch: Batch, index: int) -> Run:
    error = batch.error[index]
    if error is not None:
        raise error
    return batch[index]


def _of_robot(point: Swim, accuracy: Accuracy) -> tuple[float, float, tuple[str, ...]]:
    """Relative differences for the robot of the `point`, the longest step [s], and a line on motors at their limits."""
    given = accuracy.target is None  # the settings give fixed steps
    run = _run(swum([point if given else point.changed(accuracy=accuracy)], threads=1), 0)
    longest = np.inf if given else 0.5 * float(run.time[-1]) / max(1, run.steps)
    assert run.robot is not None and run.motor_torque is not None and run.motor_power is not None
    limited = at_limit(run.robot.servos, run.motor_torque, run.motor_power)
    names = [joint.name for joint, yes in zip(run.robot.joints, limited.T, strict=True) if yes.any()]
    if not names:
        return ROBOT_STEP, longest, ()
    line = f"motors reach their limits, which are kinks ({', '.join(names)}): derivatives have the error that is told"
    return KINKED_STEP, longest, (line,)


def _steps_of(at: dict[str, float], steps: dict[str, float] | None, relative: float) -> np.ndarray:
    """Differences (P,) of the parameters to either side."""
    steps = {} if steps is None else checked_instance("steps", steps, dict)
    for name in steps:
        checked_choice("steps", name, at)
    own = {name: relative * (abs(value) or 1.0) for name, value in at.items()}
    return np.array([positive(f"steps {name}", steps.get(name, own[name])) for name in at])


def _jumps(runs: list[Run], names: tuple[str, ...]) -> tuple[str, ...]:
    """One line if the printed friction jumps between two swims, otherwise none."""
    pairs = zip(names, runs[1 : 1 + len(names)], runs[1 + len(names) :], strict=True)
    shares = {name: share_across_jump(above, below) for name, above, below in pairs}
    crossed = [name for name, share in shares.items() if share]
    if not crossed:
        return ()
    return (
        f"the printed friction jumps at Re = {CRITICAL_REYNOLDS:g} between the two swims for {', '.join(crossed)} (at "
        f"up to {max(shares.values()):.2g} of all sections and samples): a derivative may miss what the jump does; "
        "friction blended or laminar is smooth",
    )


def may_jump(scene: Scene) -> bool:
    """Whether the friction of a `scene` jumps at some speed."""
    return bool(scene.friction == PRINTED and scene.resistive and scene.viscosity)


def share_across_jump(one: Run, other: Run) -> float:
    """Share of samples and stations where two runs are on opposite sides of the printed friction's jump; 0 without it.

    The speed V1 is the backbone's velocity along itself through the water, from splines through the samples.
    """
    if not may_jump(one.scene) or len(one.time) < 4:
        return 0.0
    return float(np.mean(_is_turbulent(one) != _is_turbulent(other)))


def _is_turbulent(run: Run) -> np.ndarray:
    """Whether Re = abs(V1) X / nu exceeds the transition, (T, M)."""
    from scipy.interpolate import CubicSpline

    velocity = CubicSpline(run.time, run.backbone, axis=0)(run.time, 1) - run.scene.current
    along = world_from_body(run.section_orientation)[..., 0]  # forward, the opposite of axis 1 of each section
    speed = np.abs(np.sum(velocity * along, axis=-1))
    return np.asarray(speed * run.x > CRITICAL_REYNOLDS * run.scene.viscosity)
