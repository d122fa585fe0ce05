# SPDX-License-Identifier: Apache-2.0
"""Coefficients of the model from measured motions, with their intervals: `identify`.

    path = MeasuredPath(time, position, numbers={"period": 0.8})
    found = identify({"body.lateral_drag": 1.0, "body.nose_drag": 0.1}, path, gait="straight")
    found["body.lateral_drag"]        # (1.93, 1.88, 1.98): value, and its 95 % interval
    print(found.table())

Nonlinear least squares with the derivatives of `gradient`. The intervals come from the linearised problem
(Gauss-Newton); the errors' size and correlation in time come from the residuals. The intervals hold if the model is
right and the errors are small. They do not include errors of the model.
"""

import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np
from eel_common.command.progress import progress_of
from eel_common.quantity import number, positive
from eel_common.wording import shown

from eel_dynamics import Body, Robot, Scene
from eel_studies.gradients.fixed_discretisation import fixed_steps
from eel_studies.identification.fit import Fit, Identified
from eel_studies.identification.measurements import (
    MeasuredAngles,
    MeasuredPath,
    MeasuredSpeed,
    Measurement,
    Measurements,
)
from eel_studies.identification.prediction import Swims
from eel_studies.points import AccuracyLike, Gait, Numbers, Progress, base_of, point_at


def identify(
    parameters: dict[str, float],
    measured: Measurement | Measurements,
    *,
    gait: Gait = "straight",
    numbers: Numbers | None = None,
    body: Body | None = None,
    scene: Scene | None = None,
    robot: Robot | str | None = None,
    accuracy: AccuracyLike = 1e-4,
    noise: float | None = None,
    level: float = 0.95,
    threads: int | None = None,
    progress: Progress = False,
) -> Identified:
    """The `parameters` with which the model fits the measurements best, and their intervals.

    parameters: first guesses by name, with the names of `studies.points`: "body.lateral_drag", "scene.density",
    "initial.v_x", "robot.kp" and the like. Those of body, scene and robot stay above 0. measured: one or several paths,
    joint angles of a robot, or steady speeds; each may have its own `numbers`. For each path a displacement and a turn
    about the vertical are also fitted, as the laboratory's axes are arbitrary. gait, numbers, body, robot, accuracy,
    threads: as in `optimise`. scene: by default the library's with blended friction. noise: standard deviation of the
    errors [m], [rad] or [m/s], if known; None: from the residuals. level: of the intervals. progress: as in `sweep`, by
    evaluations.

    `ValueError` names a bad argument, and parameters that the measurements do not determine; `SimulationStopped`: a
    swim stopped.
    """
    if not isinstance(parameters, dict) or not parameters:
        raise ValueError(f"parameters must be a dict of names and first guesses, got {shown(parameters)}")
    first = {name: number(f"parameter {name}", value) for name, value in parameters.items()}
    measurements = _checked_measurements(measured)
    noise = None if noise is None else positive("noise", noise, "m or m/s")
    level = positive("level", level)
    if level >= 1.0:
        raise ValueError(f"level must be below 1, got {level:g}")
    base = base_of(gait, friction="blended", body=body, scene=scene, robot=robot, accuracy=fixed_steps(accuracy))
    if not (numbers is None or isinstance(numbers, Mapping)):
        raise ValueError(f"numbers must be a dict, got {shown(numbers)}")
    swims = Swims(gait, dict(numbers or {}), base, threads)
    for each in measurements:
        try:
            point_at(first, gait, {**swims.numbers, **each.numbers}, base)
        except ValueError as error:
            raise ValueError(f"parameters {error}") from None
        if isinstance(each, MeasuredAngles):
            _check_angles(each, base.robot)
        if isinstance(each, MeasuredPath) and each.station > base.body.length:
            raise ValueError(f"path station must be at most the body's {base.body.length:g} m, got {each.station:g}")
    fit = Fit(swims, measurements, first, progress_of(progress, "evaluations"))
    fit.solve(noise)
    found = fit.result(noise, level)
    for line in found.warnings:
        warnings.warn(line, stacklevel=2)
    return found


KINDS = MeasuredPath, MeasuredAngles, MeasuredSpeed


def _checked_measurements(measured: Any) -> list[Measurement]:
    rows = list(measured) if np.iterable(measured) else [measured]
    kinds = {type(each) for each in rows}
    if len(kinds) != 1 or not kinds <= {*KINDS}:
        given = ", ".join(sorted(kind.__name__ for kind in kinds)) or "none"
        known = ", ".join(kind.__name__ for kind in KINDS)
        raise ValueError(f"measured must be of one kind of {known}, got {given}")
    return rows


def _check_angles(measured: MeasuredAngles, robot: Robot | None) -> None:
    count = 0 if robot is None else len(robot.joints)
    if robot is None or measured.angles.shape[1] != count:
        raise ValueError(
            f"angles must have a column for each of the robot's {count} joints, got {measured.angles.shape[1]}"
        )
