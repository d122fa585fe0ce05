# SPDX-License-Identifier: Apache-2.0
"""Random robots: joints with springs, stops, servos and series springs, passive tails, on bodies of any density."""

from dataclasses import dataclass

import numpy as np
from eel_dynamics.model.robot.actuators import Servo
from eel_dynamics.model.robot.continuous import PassiveTail
from eel_dynamics.model.robot.joint import Joint
from eel_dynamics.model.robot.robot import Robot

from eel_dynamics import Scene
from eel_gaits import Law, Term


@dataclass(frozen=True)
class Draw:
    """A robot in a scene, and the law that it is asked to follow."""

    robot: Robot
    scene: Scene
    law: Law


def drawn(seed: int) -> Draw:
    """Number `seed` of the random robots."""
    draw = np.random.default_rng(seed)
    tail = draw.random() < 0.25
    end = draw.uniform(0.5, 0.8) if tail else 0.97
    count = int(draw.integers(1, 21))
    positions = np.sort(draw.uniform(0.09, end - 0.03, count))
    spacing = (end - 0.12) / count
    positions = 0.09 + spacing * (np.arange(count) + draw.uniform(0.2, 0.8, count))
    planar = draw.random() < 0.5
    joints = [_joint(draw, float(x), 0.5 * spacing, planar) for x in positions]
    parts = [*joints]
    if tail:
        stiffness = 10.0 ** draw.uniform(-2.0, 1.0)
        parts.append(PassiveTail(float(end), stiffness, stiffness * 10.0 ** draw.uniform(-3.0, -1.0)))
    scene = Scene(planar=planar, density=float(10.0 ** draw.uniform(np.log10(200.0), np.log10(8000.0))))
    amplitude, period = draw.uniform(0.2, 2.0, 2)
    term = Term(axis="yaw", amplitude=(0.5 * amplitude, amplitude), wavelength=1.0, period=0.5 + period)
    return Draw(Robot(parts, name=f"random {seed}"), scene, Law(term, name=f"wave {seed}"))


def drawn_at_stops(seed: int) -> Draw:
    """Number `seed` of the robots of one to four joints that swing into their stops."""
    draw = np.random.default_rng([seed, 77])
    count = int(draw.integers(1, 5))
    planar, spacing = bool(draw.random() < 0.5), 0.8 / count
    places = 0.1 + spacing * (np.arange(count) + draw.uniform(0.2, 0.8, count))
    robot = Robot([_joint_at_stops(draw, float(x), 0.5 * spacing, planar) for x in places], name=f"at stops {seed}")
    amplitude, period = float(draw.uniform(1.0, 6.0)), float(draw.uniform(0.3, 1.0))
    scene = Scene(planar=planar, density=float(10.0 ** draw.uniform(2.3, 3.9)))
    term = Term(axis="yaw", amplitude=(0.5 * amplitude, amplitude), wavelength=1.0, period=period)
    return Draw(robot, scene, Law(term, name=f"wave {seed}"))


def _joint_at_stops(draw: np.random.Generator, x: float, width: float, planar: bool) -> Joint:
    limits, servo = (-float(draw.uniform(0.02, 0.3)), float(draw.uniform(0.02, 0.3))), None
    if draw.random() < 0.6:
        limit = draw.random() < 0.5
        servo = Servo(
            kp=float(10.0 ** draw.uniform(-0.5, 1.5)),
            kd=float(10.0 ** draw.uniform(-3.0, -0.5)),
            torque_limit=float(10.0 ** draw.uniform(-1.0, 1.0)) if limit else None,
        )
    return Joint(
        x,
        axis="yaw" if planar or draw.random() < 0.7 else "pitch",
        width=width * float(draw.uniform(0.3, 1.0)),
        stiffness=0.0 if draw.random() < 0.5 else float(10.0 ** draw.uniform(-2.0, 1.0)),
        damping=0.0 if draw.random() < 0.5 else float(10.0 ** draw.uniform(-4.0, -1.0)),
        rest_angle=float(draw.uniform(-0.8, 0.8)),
        initial_angle=float(draw.uniform(*limits)),
        limits=limits,
        actuator=servo,
        stop_stiffness=float(10.0 ** draw.uniform(1.0, 4.0)) if draw.random() < 0.5 else 100.0,
        stop_damping=float(10.0 ** draw.uniform(-2.0, 0.5)) if draw.random() < 0.5 else 0.1,
    )


def _joint(draw: np.random.Generator, x: float, width: float, planar: bool) -> Joint:
    stiffness = 0.0 if draw.random() < 0.3 else float(10.0 ** draw.uniform(-3.0, 4.0))
    damping = 0.0 if draw.random() < 0.3 else float(10.0 ** draw.uniform(-4.0, 1.0))
    limits = (-float(draw.uniform(0.05, 0.6)), float(draw.uniform(0.05, 0.6))) if draw.random() < 0.2 else None
    return Joint(
        x,
        axis="yaw" if planar or draw.random() < 0.7 else "pitch",
        width=width * float(draw.uniform(0.3, 1.0)),
        stiffness=stiffness,
        damping=damping,
        limits=limits,
        actuator=_servo(draw) if draw.random() < 0.7 else None,
    )


def _servo(draw: np.random.Generator) -> Servo:
    limited, series = draw.random() < 0.5, draw.random() < 0.3
    return Servo(
        kp=float(10.0 ** draw.uniform(-1.0, 2.5)),
        kd=float(10.0 ** draw.uniform(-3.0, 0.5)),
        torque_limit=float(10.0 ** draw.uniform(-1.5, 1.0)) if limited else None,
        speed_limit=float(10.0 ** draw.uniform(0.3, 1.5)) if limited else None,
        gear=float(draw.uniform(1.0, 300.0)) if series or draw.random() < 0.5 else 1.0,
        rotor_inertia=1e-7 if series or draw.random() < 0.5 else 0.0,
        series_stiffness=float(10.0 ** draw.uniform(0.0, 3.0)) if series else None,
    )
