# SPDX-License-Identifier: Apache-2.0
"""Stiffness, damping and gains of a robot from the measured angles of its joints.

Least squares over the angles at the measured instants. The fields are positive and may differ by powers of ten, so
their logarithms are fitted.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from eel_base.quantity import numbers, positive
from eel_base.wording import shown
from eel_dynamics.runs.simulate import simulate
from eel_model.body.body import Body
from eel_model.robot.robot import Robot
from eel_model.scene import Scene
from numpy.typing import ArrayLike

STEP = 1e-2  # of a logarithm, for the differences
ACCURACY = 1e-5  # of the swims: their errors stay below the differences


@dataclass(frozen=True)
class FittedRobot:
    """A `robot` that moves as measured, as far as it can.

    Attributes:
        values: of the fields. errors: their standard errors, from the misfit and how the angles depend on them.
        misfit: [rad] root mean square of simulated less measured angles.
    """

    robot: Robot
    values: dict[str, float]
    errors: dict[str, float]
    misfit: float


def fit_robot(
    robot: Robot,
    law: Any,
    time: ArrayLike,
    angles: ArrayLike,
    fields: Mapping[str, float] | Sequence[str],
    *,
    body: Body | None = None,
    scene: Scene | None = None,
) -> FittedRobot:
    """Fit `fields` of all joints, servos or tails of a `robot` that follows a `law`, to measured joint angles.

    time: (T,) [s], rising from 0. angles: (T, J) [rad], of its joints in their order and sign; NaN where unknown.
    fields: names, which begin at the robot's own values, or names with values to begin at; all > 0. A name is that of a
    field, of all parts that have it, or of one part's, as joint_4.stiffness. `ValueError` names what does not fit.
    """
    from scipy.optimize import least_squares

    instants, measured = numbers("time", time), numbers("angles", angles)
    if instants.ndim != 1 or len(instants) < 2 or instants[0] != 0.0 or not (np.diff(instants) > 0.0).all():
        raise ValueError(f"time must rise from 0 over 2 instants or more, got {shown(instants.tolist())}")
    if measured.shape != (len(instants), len(robot.joints)):
        rule = f"angles must have a row for each of {len(instants)} instants and {len(robot.joints)} joints"
        raise ValueError(f"{rule}, got {measured.shape}")
    start = _start(robot, fields)
    known = np.isfinite(measured)

    def misfits(logarithms: np.ndarray) -> np.ndarray:
        here = _changed(robot, dict(zip(start, np.exp(logarithms).tolist(), strict=True)))
        run = simulate(
            law, instants[-1], body=body, scene=scene, robot=here, accuracy=ACCURACY,
            sample_period=float(np.diff(instants).min()), stations=2, estimate=False,
        )  # fmt: skip
        assert run.joint_angle is not None
        found = [np.interp(instants, run.time, angle) for angle in run.joint_angle.T]
        return np.asarray((np.array(found).T - measured)[known])

    fitted = least_squares(misfits, np.log(list(start.values())), diff_step=STEP, x_scale=1.0)
    values = dict(zip(start, np.exp(fitted.x).tolist(), strict=True))
    spare = max(1, len(fitted.fun) - len(start))
    spread = np.sqrt(np.diag(np.linalg.pinv(fitted.jac.T @ fitted.jac)) * np.sum(fitted.fun**2) / spare)
    errors = {name: value * float(part) for (name, value), part in zip(values.items(), spread, strict=True)}
    return FittedRobot(_changed(robot, values), values, errors, float(np.sqrt(np.mean(fitted.fun**2))))


def _changed(robot: Robot, values: Mapping[str, float]) -> Robot:
    for name, value in values.items():
        part, _, field = name.rpartition(".")
        changes: dict[str, Any] = {field: value}
        robot = robot.changed(part or None, **changes)
    return robot


def _start(robot: Robot, fields: Mapping[str, float] | Sequence[str]) -> dict[str, float]:
    """Names of the fields, and where they begin."""
    given: dict[str, Any] = dict(fields) if isinstance(fields, Mapping) else dict.fromkeys(fields)
    found = {}
    for name, value in given.items():
        part, _, field = name.rpartition(".")
        parts = [each for each in robot.parts if part in ("", each.name)]
        owners = [each for one in parts for each in (one, getattr(one, "actuator", None)) if hasattr(each, field)]
        if not owners:
            raise ValueError(f"no part of the robot has {shown(name)}")
        found[name] = positive(name, getattr(owners[0], field) if value is None else value)
    return found
