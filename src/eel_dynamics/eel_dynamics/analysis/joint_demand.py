# SPDX-License-Identifier: Apache-2.0
"""The demand of a run on a robot with n joints: a chain of n + 1 rigid links instead of the continuous backbone.

Joint j represents the segment (j - 1) l/n to j l/n, and lies in its middle, X = (j - 1/2) l/n. Its angles are the
integrals of K2 (pitch) and K3 (yaw) over the segment. Its torques are -C2, -C3 there: the motor turns the part ahead
relative to the part behind, with the power per length -C . dK/dt, C of eq. 26 of Boyer, Porez and Leroyer 2010.
"""

from dataclasses import dataclass

import numpy as np
from eel_common.wording import shown

from eel_dynamics.analysis.peaks import peaks
from eel_dynamics.analysis.powers import area, power_density


@dataclass(frozen=True)
class Motors:
    """One axis (pitch or yaw) of the n joints over T samples."""

    time: np.ndarray  # (T,) s
    angle: np.ndarray  # (T, n) rad
    speed: np.ndarray  # (T, n) rad/s
    torque: np.ndarray  # (T, n) N m, motor torque
    peak: dict[str, np.ndarray]  # (n,) greatest magnitudes of the `QUANTITIES`, between samples too (`analysis.peaks`)

    @property
    def power(self) -> np.ndarray:
        """(T, n) W, mechanical; negative while the motor brakes."""
        return self.torque * self.speed

    @property
    def rms(self) -> dict[str, np.ndarray]:
        """Roots of the mean squares over the samples (n,), of the `QUANTITIES`."""
        return {name: np.sqrt(np.mean(getattr(self, name) ** 2, axis=0)) for name in QUANTITIES}


MOST_JOINTS = 1000  # per axis
QUANTITIES = ("angle", "speed", "torque", "power")  # rad, rad/s, N m, W


class Joints:
    """`count` joints of a body of `length` [m], from values at the stations x (M,) [m]: at least 4, from nose to tail.

    Between the stations, values are those of a cubic spline, which is linear in them: each result is one matrix
    times the values.

    Attributes:
        x: positions of the joints (count,) [m].
    """

    def __init__(self, x: np.ndarray, length: float, count: int):
        from scipy.interpolate import CubicSpline

        ends = np.linspace(0.0, length, count + 1)
        self.x = 0.5 * (ends[1:] + ends[:-1])
        spline = CubicSpline(x, np.eye(len(x)))
        self._integral = np.diff(spline.antiderivative()(ends), axis=0)  # (count, M)
        self._value = spline(self.x)  # (count, M)

    def angle(self, curvature: np.ndarray) -> np.ndarray:
        """Angles (..., count, 3) [rad] from a curvature (..., M, 3) [rad/m], or speeds [rad/s] from its rate."""
        return self._integral @ curvature

    def motor_torque(self, torque: np.ndarray) -> np.ndarray:
        """Torques of the motors (..., count, 3) [N m] from the internal torque (..., M, 3) [N m]."""
        return -(self._value @ torque)


@dataclass(frozen=True, repr=False)
class Actuators:
    """The demand on n joints in pitch and yaw, and the difference of their power from the continuous body's power."""

    time: np.ndarray  # (T,) s
    x: np.ndarray  # (n,) m, positions of the joints
    pitch: Motors
    yaw: Motors
    continuous_power: np.ndarray  # (T,) W, -integral of C . dK/dt over the body

    def __repr__(self) -> str:
        return f"Actuators({len(self.x)} joints, {len(self.time)} samples, {self._span})"

    @property
    def _span(self) -> str:
        return f"{self.time[0]:g} to {self.time[-1]:g} s" if len(self.time) else "no time"

    @property
    def power(self) -> np.ndarray:
        """(T,) W, of all joints together."""
        return np.sum(self.pitch.power + self.yaw.power, axis=1)

    @property
    def power_difference(self) -> np.ndarray:
        """(T,) W: power of the joints minus power of the continuous body; it falls like 1/n^2."""
        return self.power - self.continuous_power

    @property
    def relative_difference(self) -> float | None:
        """RMS of the difference relative to the RMS of the continuous power; None if that is zero."""
        scale = np.sqrt(np.mean(self.continuous_power**2))
        return float(np.sqrt(np.mean(self.power_difference**2)) / scale) if scale > 0.0 else None

    def table(self) -> str:
        """A text table of each joint's peak and RMS values over the whole run, and the difference of the powers."""
        lines = [
            "joint  X [m]   axis   angle [rad]     speed [rad/s]   torque [N m]    power [W]      "
            f"(peak, RMS over the whole run, {self._span})"
        ]
        for joint, x in enumerate(self.x):
            for name, motors in (("pitch", self.pitch), ("yaw", self.yaw)):
                peak, rms = motors.peak, motors.rms
                cells = [f"{peak[key][joint]:7.3g} {rms[key][joint]:7.3g}" for key in QUANTITIES]
                lines.append(f"{joint + 1:5d}  {x:.3f}   {name:5s}  " + " ".join(cells))
        part = self.relative_difference
        said = "undefined" if part is None else f"{part:.2%} of it, RMS"
        lines.append(f"power of the joints less that of the continuous body: {said}")
        return "\n".join(lines)


def actuators_of(run, joints: int) -> Actuators:
    """The demand of `run` on a robot of `joints` motors per axis.

    `ValueError` for a number below 1, for a run without internal wrench, or with fewer than 4 stations, or with
    stations that do not reach from nose to tail.
    """
    if isinstance(joints, bool) or not isinstance(joints, (int, np.integer)) or not 1 <= joints <= MOST_JOINTS:
        raise ValueError(f"joints must be a whole number from 1 to {MOST_JOINTS}, got {shown(joints)}")
    if run.torque is None:
        raise ValueError("actuators needs a run with scene internal_wrench on")
    density = power_density(run)
    if len(run.x) < 4:
        raise ValueError(f"actuators needs a run of 4 stations or more, got {len(run.x)}")
    robot = Joints(run.x, run.body.length, int(joints))
    pitch, yaw = _motors(run, robot)
    return Actuators(time=run.time, x=robot.x, pitch=pitch, yaw=yaw, continuous_power=area(density, run.x))


def _motors(run, robot: Joints) -> list[Motors]:
    """The motors in pitch and yaw of `robot`, with peaks from a run with finer samples."""
    finer = run.finely_sampled()
    here, fine = (
        (robot.angle(each.curvature), robot.angle(each.curvature_rate), robot.motor_torque(each.torque))
        for each in (run, finer)
    )
    found = []
    for axis in (1, 2):
        angle, speed, torque = (values[..., axis] for values in fine)
        sizes = zip(QUANTITIES, (angle, speed, torque, speed * torque), strict=True)
        peak = {name: peaks(finer.time, values)[0] for name, values in sizes}
        angle, speed, torque = (values[..., axis] for values in here)
        found.append(Motors(run.time, angle, speed, torque, peak))
    return found
