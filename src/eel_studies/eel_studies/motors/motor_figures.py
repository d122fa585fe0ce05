# SPDX-License-Identifier: Apache-2.0
"""Can the motors follow the gait? Each joint of a robot in the steady part of a swim, as numbers and as a table.

The steady part is the second half of the swim, in whole periods of the law. A servo's error is its angle minus its
reference, which is the integral of the law's curvature over the joint's part of the body.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from eel_common.wording import shown
from eel_dynamics.batches.simulate_batch import in_threads
from eel_dynamics.model.robot.actuators import at_limit
from eel_dynamics.model.robot.compiled import mode_table

from eel_dynamics import Robot, Run, Swim
from eel_gaits import Law
from eel_studies.outputs import Table
from eel_studies.points import ROBOT
from eel_studies.varied import varied

SAMPLES = 100  # per period
STATIONS = 5  # enough for the figures


class JointFigures(NamedTuple):
    """One joint in the steady part. The numbers are greatest magnitudes, or root mean squares (rms), except the share
    and the mean power."""

    name: str
    position: float  # m
    reference: float  # rad
    angle: float  # rad
    error_rms: float  # rad
    rate: float  # rad/s
    torque: float  # N m, motor torque
    torque_rms: float  # N m
    torque_limit: float  # N m; infinite without one
    at_limit: float  # share of the time
    power: float  # W, mean; negative: it brakes


@dataclass(frozen=True)
class MotorFigures:
    """The steady part of a `run`.

    Attributes:
        speed: [m/s] of the centre of mass, along the line from the part's start to its end.
        power: [W] of the actuators: motors, or whatever imposes the law; net of the power they take back.
        drawn_power: [W] of the motors if they take no power back; NaN without motors.
        tracking_error: RMS of the servos' errors, divided by the RMS of their references; NaN without a reference.
    """

    run: Run
    joints: tuple[JointFigures, ...]
    speed: float
    power: float
    drawn_power: float
    tracking_error: float

    @property
    def energy_per_metre(self) -> float:
        """Drawn energy [J/m]; without motors, the energy from `power`."""
        power = self.power if np.isnan(self.drawn_power) else self.drawn_power
        return power / self.speed if self.speed > 0.0 else np.inf

    def table(self) -> Table:
        """A row for each joint."""
        head = ("joint", "X [m]", "asked [rad]", "angle [rad]", "error rms", "rate [rad/s]", "torque [N m]", "rms")
        rows = []
        for each in self.joints:
            figures = (f"{value:.3g}" for value in (each.reference, each.angle, each.error_rms, each.rate))
            limit = f" of {each.torque_limit:.3g}" if np.isfinite(each.torque_limit) else ""
            torque = f"{each.torque:.3g}{limit}", f"{each.torque_rms:.3g}", f"{100.0 * each.at_limit:.0f} %"
            rows.append((each.name, f"{each.position:.3f}", *figures, *torque, f"{each.power:.3g}"))
        return Table((*head, "at limit", "mean power [W]"), rows)

    def about(self) -> str:
        """The sentence below the table."""
        busy = [each.name for each in self.joints if each.at_limit > 0.0]
        limits = f"at the torque limit: {', '.join(busy)}" if busy else "no motor comes to its torque limit"
        return (
            f"speed {self.speed:.4g} m/s, actuators {self.power:.3g} W (motors draw {self.drawn_power:.3g} W, "
            f"{self.energy_per_metre:.3g} J/m), tracking error {100.0 * self.tracking_error:.3g} %; {limits}"
        )


def motor_figures(run: Run) -> MotorFigures:
    """The figures of a `run` of a robot. `ValueError` without one."""
    robot = run.robot
    if robot is None:
        raise ValueError("motor figures need a run of a robot")
    steady = steady_part(run.law, run.time)
    joints, servos, time = robot.joints, robot.servos, run.time[steady]
    names = "motor_torque", "motor_power", "joint_angle", "joint_rate"
    torque, power, angle, rate = (getattr(run, name)[steady] for name in names)
    asked = references(run, time)
    followed = np.array([servo is not None for servo in servos])
    error = np.where(followed, angle - asked, np.nan)
    columns = (
        (joint.name for joint in joints),
        (joint.position for joint in joints),
        *(np.abs(each).max(axis=0).tolist() for each in (asked, angle)),
        _rms(error, axis=0).tolist(),
        *(np.abs(each).max(axis=0).tolist() for each in (rate, torque)),
        _rms(torque, axis=0).tolist(),
        (getattr(servo, "torque_limit", None) or np.inf for servo in servos),
        at_limit(servos, torque, power).mean(axis=0).tolist(),
        power.mean(axis=0).tolist(),
    )
    scale = _rms(asked[:, followed]) if followed.any() else 0.0
    centre = run.center_of_mass[steady]
    drawn = float(np.maximum(power, 0.0).sum(axis=1).mean())
    actuators = power.sum(axis=1) if run.energy is None else run.energy.actuator_power[steady]
    return MotorFigures(
        run,
        tuple(JointFigures(*row) for row in zip(*columns, strict=True)),
        speed=float(np.linalg.norm(centre[-1] - centre[0]) / (time[-1] - time[0])),
        power=float(actuators.mean()),
        drawn_power=drawn if any(each.actuator for each in joints) else np.nan,
        tracking_error=float(_rms(error[:, followed]) / scale) if scale > 0.0 else np.nan,
    )


def references(run: Run, time: np.ndarray) -> np.ndarray:
    """The references (T, J) [rad] of the joints of a run's robot at `time` (T,) [s], in the joints' signs."""
    assert run.robot is not None
    table = mode_table(run.robot, run.body, bool(run.scene.planar))
    hinges = np.flatnonzero(table.joints)
    bends = np.array([run.law.curvature(float(each), table.points)[0] for each in time])  # (T, P, 3)
    asked = np.einsum("mp,tpm->tm", table.projection[hinges], bends[:, :, table.axis[hinges]])
    return np.asarray(asked * table.sign[hinges])


def _rms(values: np.ndarray, axis: int | None = None) -> Any:
    return np.sqrt(np.mean(values**2, axis=axis))


def steady_part(law: Any, time: np.ndarray) -> slice:
    """The samples of the second half, limited to whole periods of the `law`."""
    period = max((term.period for term in getattr(law, "terms", ())), default=0.0)
    span = 0.5 * (time[-1] - time[0])
    if 0.0 < period <= span:
        span = period * np.floor(span / period * (1.0 + 1e-9))
    return slice(int(np.searchsorted(time, time[-1] - span - 1e-9)), len(time))


def motor_swim(robot: Robot, swim: Swim) -> MotorFigures:
    """The figures of a `robot` in a `swim`."""
    period = max((term.period for term in swim.law.terms), default=0.0) if isinstance(swim.law, Law) else 0.0
    body = robot.body or swim.body
    return motor_figures(swim.run(robot=robot, body=body, sample_period=(period or 1.0) / SAMPLES, stations=STATIONS))


def with_number(robot: Robot, swim: Swim, name: str, value: float | None) -> tuple[Robot, Swim]:
    """The robot and the swim with one number changed: a field of the robot if it has it (`Robot.with_numbers`), else of
    the swim (`studies.varied`)."""
    own = name.removeprefix(ROBOT)
    if name.startswith(ROBOT) or robot.has(own):
        return robot.with_numbers({own: value}), swim
    if value is None:
        raise ValueError(f"{name} must be a number, got none")
    try:
        return robot, varied(swim, {name: value})
    except (ValueError, TypeError) as error:
        raise ValueError(f"no part of the robot has {shown(name)}, nor has the swim: {error}") from None


def comparison(robot: Robot, swim: Swim, field: str, values: Sequence[float | None]) -> "Comparison":
    """The figures of a `robot` in a `swim`, for each of the `values` of a `field` of either."""
    changed = [with_number(robot, swim, field, value) for value in values]
    return Comparison(field, tuple(values), tuple(in_threads(lambda each: motor_swim(*each), changed)))


@dataclass(frozen=True)
class Comparison:
    """Figures over the `values` of a `field` of a robot or its swim. named: other changes, in words."""

    field: str
    values: tuple[float | None, ...]
    figures: tuple[MotorFigures, ...]
    named: str = ""

    def __iter__(self) -> Iterator[tuple[float | None, MotorFigures]]:
        return zip(self.values, self.figures, strict=True)

    def table(self) -> Table:
        """A row for each value."""
        name, _, beside = self.named.partition("=")
        head = self.field, "speed [m/s]", "tracking error", "at limit", "torque [N m]", "power [W]", "drawn [W]", "J/m"
        rows = [(word_of(value), *self._cells(figures)) for value, figures in self]
        return Table((name, *head), [(beside, *row) for row in rows], ()) if name else Table(head, rows, ())

    def _cells(self, figures: MotorFigures) -> tuple[str, ...]:
        joints = figures.joints
        return (
            f"{figures.speed:.4g}",
            "" if np.isnan(figures.tracking_error) else f"{100.0 * figures.tracking_error:.3g} %",
            f"{100.0 * max((each.at_limit for each in joints), default=0.0):.0f} %",
            f"{max((each.torque for each in joints), default=0.0):.3g}",
            f"{figures.power:.3g}",
            "" if np.isnan(figures.drawn_power) else f"{figures.drawn_power:.3g}",
            f"{figures.energy_per_metre:.3g}",
        )


def word_of(value: float | None) -> str:
    """The value of a field in a table."""
    return "none" if value is None else f"{value:g}"
