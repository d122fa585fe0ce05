# SPDX-License-Identifier: Apache-2.0
"""The data of a run, and what follows from them alone. `Run` adds the analysis."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, Self

import numpy as np
from eel_common.attitude import world_from_section
from eel_common.wording import shown
from eel_gaits.laws.law import Law
from eel_gaits.sources.sampled_law import SampledLaw

from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.accuracy.error_estimate import ErrorEstimate
from eel_dynamics.model.axes import CONVENTIONS, REP103, SIGNS, turn_vector, turned
from eel_dynamics.model.body.body import Body
from eel_dynamics.model.equality import same_fields
from eel_dynamics.model.fins.fins import Fin
from eel_dynamics.model.flow.flow import Flow
from eel_dynamics.model.initial_state import InitialState
from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.model.scene import Scene
from eel_dynamics.model.wrenches.external_wrench import ExternalWrench
from eel_dynamics.runs.storage.variables import ENERGY, LEDGER, OWN, fields_of_arrays
from eel_dynamics.simulation.energy import EnergyLedger
from eel_dynamics.simulation.observations import Snapshot
from eel_dynamics.simulation.swimmer import Swimmer

ANY = 1e30  # evaluations per simulated second: no limit


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class ObservedArrays:
    """The arrays that a run and a batch have in common; None if not requested."""

    time: np.ndarray
    position: np.ndarray
    orientation: np.ndarray
    twist: np.ndarray
    head_acceleration: np.ndarray
    center_of_mass: np.ndarray
    x: np.ndarray
    torque: np.ndarray | None
    force: np.ndarray | None
    fluid_force: np.ndarray | None
    energy: EnergyLedger | None
    fin_angle: np.ndarray | None = None
    fin_force: np.ndarray | None = None
    joint_angle: np.ndarray | None = None
    joint_rate: np.ndarray | None = None
    joint_torque: np.ndarray | None = None
    motor_angle: np.ndarray | None = None
    motor_torque: np.ndarray | None = None
    motor_power: np.ndarray | None = None
    mode_amplitude: np.ndarray | None = None
    mode_rate: np.ndarray | None = None


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class RunData(ObservedArrays):
    """The data of a run; `Run` documents them."""

    law: Law | SampledLaw
    body: Body
    scene: Scene
    accuracy: Accuracy
    backbone: np.ndarray
    section_orientation: np.ndarray
    curvature: np.ndarray
    curvature_rate: np.ndarray
    resistive_force: np.ndarray | None
    tail_force: np.ndarray | None
    nose_force: np.ndarray | None
    wake_momentum_rate: np.ndarray | None
    closure_torque: np.ndarray | None
    closure_force: np.ndarray | None
    steps: int
    evaluations: int
    nodes: int
    error_estimate: ErrorEstimate | None = None  #: None if not requested, or for fewer than two samples
    flow: Flow | None = None  #: of the water; always in REP-103 axes
    fins: tuple[Fin, ...] = ()
    wrenches: tuple[ExternalWrench, ...] = ()  #: from outside
    robot: Robot | None = None  #: the joints' arrays are None without one
    axes: str = REP103  #: axes of world and head: "rep103" (x forward, y left, z up), or "paper"

    @classmethod
    def of(cls, swimmer: Any, time: np.ndarray, arrays: dict[str, np.ndarray], **others: Any) -> Self:
        """The run with these `arrays` (`storage.variables.arrays_of`) at `time` (T,) [s].

        swimmer: a `Swimmer`, or another object with the body, the scene and the stations x, and perhaps a flow, a
        robot, fins, wrenches. others: further fields.
        """
        own = {"body": swimmer.body, "scene": swimmer.scene, "flow": None, "robot": None, "fins": (), "wrenches": ()}
        own |= {name: getattr(swimmer, name, none) for name, none in own.items()}
        return cls(**own, **fields_of_arrays(arrays | {"time": time, "x": swimmer.x}, own["robot"]), **others)

    @classmethod
    def of_snapshots(cls, snapshots: Sequence[Snapshot], swimmer: Any, law: Law, **others: Any) -> Self:
        """The run in the `snapshots` of a `swimmer`: a `Simulation`, or another object with `observe`.

        law: the swimmer's. others: further fields of the run. Its numbers of steps are 0.
        """
        first = snapshots[0]
        names = [name for name in OWN if name != "x" and getattr(first, name, None) is not None]
        arrays = {name: np.array([getattr(each, name) for each in snapshots]) for name in names}
        arrays |= {name: np.array([each.joints[name] for each in snapshots]) for name in first.joints}
        if ledgers := [each.energy for each in snapshots if each.energy is not None]:
            arrays |= {ENERGY + name: np.array([each[name] for each in ledgers]) for name in LEDGER}
        others = {"accuracy": swimmer.accuracy, "steps": 0, "evaluations": 0, "nodes": 0} | others
        return cls.of(swimmer, arrays.pop("time"), arrays, law=law, **others)

    def __eq__(self, other: object) -> bool:
        return self is other or same_fields(self, other)

    def __hash__(self) -> int:
        return hash((self.law, self.body, self.scene, self.steps, self.evaluations, self.nodes))

    def __getstate__(self) -> dict[str, Any]:  # without cached properties
        return {item.name: getattr(self, item.name) for item in fields(self)}

    def __repr__(self) -> str:
        end = f"{self.time[-1]:g} s" if len(self.time) else "no time"
        return (
            f"{type(self).__name__}({self.law.name!r}, {self.body.name!r}, {end}, {len(self.time)} samples, "
            f"{len(self.x)} stations, accuracy {self.accuracy.name!r})"
        )

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
        """(T, M, 3) N m: the internal torque in the axes of the world. `ValueError` without one."""
        return self._in_world("torque")

    @property
    def force_world(self) -> np.ndarray:
        """(T, M, 3) N: the internal force in the axes of the world. `ValueError` without one."""
        return self._in_world("force")

    def in_axes(self, axes: str) -> Self:
        """This run with world and head in these `axes`: "rep103" (x forward, y left, z up), or "paper".

        In the paper's axes the eel swims towards -x. Quantities in section axes are the same in both. `ValueError` for
        other axes.
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

    def swimmer_at(self, sample: int, x: np.ndarray, accuracy: Accuracy, most_evaluations: float = ANY) -> Swimmer:
        """The swimmer, in REP-103 axes, with the head's motion at a `sample`, and stations at x (M,) [m]."""
        run = self.in_axes(REP103)
        orientation = run.orientation[sample] / np.linalg.norm(run.orientation[sample])
        return Swimmer(
            law=run.law,
            body=run.body,
            scene=run.scene,
            accuracy=accuracy,
            start=InitialState(run.position[sample], orientation, run.twist[sample]),
            flow=run.flow,
            robot=run.robot,
            fins=run.fins,
            stations=x,
            wrenches=run.wrenches,
            most_evaluations=most_evaluations,
        )

    @property
    def body_mass(self) -> float:
        """Mass of the body in this scene [kg]."""
        return self.body.mass_in(self.scene.density)
