# SPDX-License-Identifier: Apache-2.0
"""Errors against nodes along the body and against the step in time, with and without cross-flow drag.

Cross-flow drag is proportional to V|V|, and roll drag to Omega|Omega|. Their second derivatives jump where V or Omega
changes sign. Such a place lies inside a panel and moves. It would limit the order of rules for smooth functions, and is
therefore located (`drag.py`). Laminar friction stays on. It is smooth for a swimmer with an initial velocity.
"""

from dataclasses import dataclass

import numpy as np
from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.runs.simulate import simulate
from eel_dynamics.simulation.simulation import Simulation
from eel_model.body.body import Body
from eel_model.scene import Scene

from eel_gaits import falling

NODES = (8.0, 12.0, 16.0, 24.0, 36.0, 54.0, 80.0, 120.0, 180.0)  # points per body length
FINEST_NODES = 400.0
STEPS = (0.05, 0.04, 0.025, 0.02, 0.0125, 0.01, 0.005)  # s, of the classical Runge-Kutta method
FINEST_STEP = 0.001
TWIST = (-0.4, -0.1, -0.15, 0.5, -0.1, 0.05)  # rad/s, m/s: head twist of a swimmer at speed
VELOCITY_AHEAD = (0.0, 0.0, 0.0, 0.3, 0.0, 0.0)  # m/s: initial velocity ahead
INSTANT = 7.3  # s, both waves and bend are on
STATIONS = (0.1, 0.3, 0.5, 0.75, 0.9)
ROUND_OFF = 1e-12  # error below which round-off dominates: its value then depends on the processor

Values = tuple[np.ndarray, np.ndarray]  # of the motion, and of the torque


@dataclass(frozen=True)
class ConvergenceErrors:
    """Relative errors against points per body length, or against the step [s]."""

    against: np.ndarray  # (n,)
    motion: np.ndarray  # (n,) error of the head's acceleration, or of its position at the end
    torque: np.ndarray  # (n,) error of the internal torque at five stations

    def order(self, name: str, part: slice = slice(None)) -> float:
        """Order of the error `name`: slope in logarithms over `part` of the points, where it is not round-off."""
        against, error = self.against[part], getattr(self, name)[part]
        good = error > ROUND_OFF
        return float(np.polyfit(np.log(against[good]), np.log(error[good]), 1)[0])


Errors = dict[str, dict[bool, ConvergenceErrors]]  # by the rule, `in_space` or `in_time`; with and without drag


def body_of(cross_flow: bool) -> Body:
    """The paper's robot, with or without its drag of cross flow and roll."""
    robot = Body.boyer2010()
    return robot if cross_flow else robot.changed(lateral_drag=0.0, vertical_drag=0.0, roll_drag=0.0)


def in_space(cross_flow: bool) -> ConvergenceErrors:
    """Errors of one evaluation of the falling gait at t = 7.3 s, against one with 400 points per body length."""
    body = body_of(cross_flow)

    def evaluated(resolution: float) -> Values:
        swimmer = Simulation(
            body=body,
            scene=Scene(friction="laminar"),
            accuracy=Accuracy(name="trial", resolution=resolution),
            stations=STATIONS,
            twist=TWIST,
        )
        swimmer.adopt(falling(), origin=-INSTANT)
        snapshot = swimmer.observe(load=False)
        assert snapshot.torque is not None
        return snapshot.head_acceleration.copy(), snapshot.torque.copy()

    exact = evaluated(FINEST_NODES)
    return _errors(NODES, [evaluated(resolution) for resolution in NODES], exact)


def in_time(cross_flow: bool, duration: float = 2.5) -> ConvergenceErrors:
    """Errors of the falling gait with equal steps of the classical Runge-Kutta method, against steps of 1 ms.

    duration: [s].
    """
    body = body_of(cross_flow)

    def swum(step: float) -> Values:
        run = simulate(
            falling(),
            duration,
            body=body,
            scene=Scene(friction="laminar", ledger=False),
            accuracy=Accuracy(name="trial", resolution=60.0, step=step),
            sample_period=duration,
            stations=STATIONS,
            twist=VELOCITY_AHEAD,
        )
        assert run.torque is not None
        return run.position[-1], run.torque[-1]

    exact = swum(FINEST_STEP)
    return _errors(STEPS, [swum(step) for step in STEPS], exact)


def _errors(against: tuple[float, ...], values: list[Values], exact: Values) -> ConvergenceErrors:
    def relative(index: int) -> np.ndarray:
        return np.array(
            [np.max(np.abs(value[index] - exact[index])) / np.max(np.abs(exact[index])) for value in values]
        )

    return ConvergenceErrors(np.array(against), relative(0), relative(1))
