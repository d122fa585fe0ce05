# SPDX-License-Identifier: Apache-2.0
"""A swim as one value: swimmer, law, scene, water, and duration."""

from typing import Any, NamedTuple, Self

import numpy as np
from eel_common.wording import shown
from eel_gaits.gaits.settings import Settings

from eel_dynamics.model.body.body import Body
from eel_dynamics.model.fins.fins import Fin
from eel_dynamics.model.flow.flow import Flow
from eel_dynamics.model.initial_state import InitialState
from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.model.scene import Scene
from eel_dynamics.model.wrenches.external_wrench import ExternalWrench
from eel_dynamics.runs.run import Run
from eel_dynamics.runs.simulate import simulate
from eel_dynamics.simulation.simulation import Simulation

AT_REST = InitialState(np.zeros(3), np.array([0.0, 0.0, 0.0, 1.0]), np.zeros(6))
# Arguments of `Simulation`.
OF_SWIMMER = "body", "scene", "accuracy", "stations", "flow", "robot", "fins", "wrenches"


class Swim(NamedTuple):
    """The arguments of `simulate` as one value. Every field but the first four has a default."""

    law: Any  # Law or SampledLaw; None in settings shared by several swims
    body: Body
    scene: Scene
    accuracy: Any  # as in `simulate`
    start: InitialState = AT_REST
    flow: Flow | None = None
    robot: Robot | None = None
    fins: tuple[Fin, ...] = ()
    duration: float | str = 10.0  # s, or "settled"
    sample_period: float | None = None  # s
    stations: Any = 51  # number, or their X [m]
    gait: Settings | None = None  # the settings of the gait that gave the law, if one did
    body_file: str = ""  # the body's file, if any
    robot_file: str = ""  # the robot's file, if any
    wrenches: tuple[ExternalWrench, ...] = ()

    def run(self, **how: Any) -> Run:
        """The run. how: further or changed arguments of `simulate`. `SimulationStopped` if it cannot go on."""
        own = {"duration": self.duration, "sample_period": self.sample_period} | self.swimmer
        return simulate(self.law, **own | how)

    def simulation(self, **how: Any) -> Simulation:
        """The swimmer at its start. how: further or changed arguments of `Simulation`."""
        return Simulation(**self.swimmer | {"law": self.law} | how)

    def with_gait(self, **numbers: Any) -> Self:
        """The same with changed `numbers` of the gait. `ValueError` if no gait gave the law."""
        if self.gait is None:
            raise ValueError(f"law {shown(getattr(self.law, 'name', None))} has no numbers: no gait gave it")
        gait = self.gait.changed(numbers)
        return self._replace(law=gait.law(), gait=gait)

    @property
    def swimmer(self) -> dict[str, Any]:
        """The arguments of `Simulation`, without a law."""
        return {name: getattr(self, name) for name in OF_SWIMMER} | self.start._asdict()
