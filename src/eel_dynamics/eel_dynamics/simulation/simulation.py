# SPDX-License-Identifier: Apache-2.0
"""The march in time of a swimmer in water: the algorithm of section 7.1 of Boyer, Porez and Leroyer (2010)."""

from collections.abc import Callable, Mapping, Sequence
from copy import deepcopy
from typing import Any

import numpy as np
from eel_common.quantity import LARGEST, checked_instance, checked_row, is_finite, number, positive
from eel_common.wording import shown
from eel_gaits.laws.law import Law
from eel_gaits.sources.sampled_law import SampledLaw
from numpy.typing import ArrayLike

from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.curvature.curvature_samples import CurvatureSample, check_points
from eel_dynamics.model.fins.fins import checked_commands
from eel_dynamics.model.flow.stream import FASTEST, LATEST, CurrentStream
from eel_dynamics.model.initial_state import checked_state
from eel_dynamics.model.robot.actuators import Servo
from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.model.wrenches.external_wrench import ExternalWrench, check_wrench
from eel_dynamics.simulation.error_meter import ErrorMeter
from eel_dynamics.simulation.march import March
from eel_dynamics.simulation.observations import Observations
from eel_dynamics.simulation.present import Present
from eel_dynamics.simulation.stopping import SimulationStopped
from eel_dynamics.simulation.swimmer import Swimmer

ROUNDING = 1e-12  # relative, or s: by how much the first time to record may lie before the present


class Simulation(Present):
    """The march of one swimmer, from its start on. Adopt a law (or add samples), advance, observe.

    `ValueError` names a bad argument. A copy, by `copy` or a pickle, continues independently, with the same results to
    the last bit.

        Simulation(law=straight(), scene=Scene(planar=True), twist=(0, 0, 0, 0.3, 0, 0))

    Args:
        swimmer: its body, water and start.
        measure_error: whether a companion with coarser settings follows, for `error_estimate` and `head_errors`.
        fields: of `Swimmer`, and position (3,) [m], orientation (4,) x y z w, twist (6,) (Omega, V) [rad/s, m/s] of the
            head at the start. They make a swimmer, or replace those of the given one.
    """

    def __init__(self, swimmer: Swimmer | None = None, *, measure_error: bool = False, **fields: Any) -> None:
        if swimmer is None:
            swimmer = Swimmer.of(**fields)
        elif checked_instance("swimmer", swimmer, Swimmer) and fields:
            swimmer = swimmer.changed(**fields)
        swimmer.check_stations()
        self._swimmer = swimmer
        self.body, self.scene, self.x, self.robot = swimmer.body, swimmer.scene, swimmer.x, swimmer.robot
        self._march = March(swimmer)
        self.ready, self._started = swimmer.law is not None, False
        self.currents = CurrentStream(swimmer.default_transition)
        self._meter = ErrorMeter(self._march, measure_error)

    # -- law and samples

    def adopt(self, law: Law | SampledLaw, origin: float = 0.0, transition: float | None = None) -> None:
        """Follow `law` from the present time on. `origin` [s] is the simulation time of its own t = 0.

        The first law, before the start, needs no blend. A later law takes over during `transition` [s], or during its
        own transition, or during the default one. After the last row of a `SampledLaw` the shape comes to rest.
        `ValueError` for a law that the scene does not allow.
        """
        needs = self._swimmer.shape_needs(checked_instance("law", law, (Law, SampledLaw)))
        if not is_finite(origin):
            raise ValueError(f"law origin must be finite, got {shown(origin)} s")
        origin, own = float(origin), law.transition or self._swimmer.default_transition
        blend = positive("transition", transition or own, "s")
        if self._started:
            self._on_both(lambda march: march.change_law(law, origin, blend, needs))
            self._meter.keep_apart(self._march)
        else:
            self._march = March(self._march.swimmer.unchecked(law=law), origin)
            self._meter = ErrorMeter(self._march, self._meter.wanted)
        self.ready = True

    def add_samples(
        self,
        time: float,
        x: np.ndarray | Sequence[float],
        pitch: ArrayLike,
        pitch_rate: ArrayLike,
        pitch_accel: ArrayLike,
        yaw: ArrayLike,
        yaw_rate: ArrayLike,
        yaw_accel: ArrayLike,
        *,
        waves: float | None = None,
    ) -> None:
        """Add a controller's curvature at the instant `time` [s], which lies ahead; before the start it may be 0.

        The rows hold the curvature [rad/m], its rate [rad/m/s] and its acceleration [rad/m/s^2] at the points `x` (n,)
        [m]. They are interpolated by natural cubic splines in X; beyond the first and the last point, where these do
        not lie at nose and tail, each row is extended linearly with its slope there. Between two
        instants they follow the quintic that meets value, rate and acceleration at both. The samples take over as soon
        as two instants bracket the present.
        waves: on the body, which the grid must resolve; None: as many as the points can carry, one for eight of them.
        `ValueError` names a bad argument.
        """
        if type(x) is not np.ndarray or x.ndim != 1:
            x = checked_row("curvature samples x", x, None)
        check_points(len(x))
        self._march.follower.samples.check_space(len(x))
        rows = pitch, pitch_rate, pitch_accel, yaw, yaw_rate, yaw_accel
        sample = CurvatureSample.checked(
            time,
            x,
            rows,
            waves=waves,
            length=self.body.length,
            planar=self.scene.planar,
            now=self.time,
            begun=self._started,
        )
        self._on_both(lambda march: march.follower.add(sample))
        self.ready = True

    def add_current(self, time: float, velocity: ArrayLike) -> None:
        """Add a sample of a current: the `velocity` (3,) [m/s], world, that it has at `time` [s], everywhere.

        The water then moves with the course through the samples (`CurrentStream`), besides the scene's current and the
        flow. A sample that is not newer than the last is ignored. A reset removes all. `ValueError` names a bad
        argument.
        """
        if not is_finite(time):
            raise ValueError(f"current time must be finite, got {shown(time)} s")
        if time > LATEST:
            raise ValueError(f"current time must be <= {LATEST:g} s, got {shown(time)} s")
        row = checked_row("current velocity", velocity, 3)
        if np.abs(row).max() > FASTEST:
            raise ValueError(f"current velocity must be at most {FASTEST:g} m/s in size, got {shown(row.tolist())}")
        if self.scene.planar and row[2] != 0.0:
            raise ValueError(f"current velocity must have no part along z in a planar scene, got {row[2]:g} m/s")
        if (course := self.currents.add(self.time, float(time), row)) is None:
            return
        flow = course if self._swimmer.flow is None else self._swimmer.flow + course
        self._on_both(lambda march: march.change_flow(flow))

    def command_fins(self, commands: Mapping[str, float]) -> None:
        """Command these angles [rad] of fins, by `Fin.name`, from the present time on.

        A reset removes them. `ValueError` for a fin that is not commanded, or an angle that is no number.
        """
        angles = checked_commands(self._swimmer.fins, commands)
        self._on_both(lambda march: march.command_fins(angles))

    def apply_wrench(
        self,
        station: float,
        force: ArrayLike = (0.0, 0.0, 0.0),
        torque: ArrayLike = (0.0, 0.0, 0.0),
        frame: str = "section",
    ) -> None:
        """Apply an external wrench to the section at `station` [m], from the present time on.

        It replaces the previous one applied there, and holds until the next one; a zero wrench ends it. `wrenches` act
        in addition. A reset removes it. The first one at a station inside the body changes the grid, unless one of
        `wrenches` has that station.

        Args:
            station: X [m], 0 at the head.
            force: (3,) [N], on the section's centre.
            torque: (3,) [N m], about it.
            frame: their axes, "section" (x forward, y left, z up, as the section is turned) or "world".

        `ValueError` names a bad argument.
        """
        wrench = self.check_wrench(station, force, torque, frame)
        self._on_both(lambda march: march.apply_wrench(wrench))
        self._meter.due = True

    def check_wrench(
        self, station: float, force: ArrayLike, torque: ArrayLike, frame: str = "section"
    ) -> ExternalWrench:
        """The wrench of these arguments of `apply_wrench`; `ValueError` as there."""
        wrench = ExternalWrench(station, force, torque, frame)
        if wrench.is_function:
            raise ValueError("applied force and torque must be three numbers, got a function: it goes with wrenches")
        check_wrench(wrench, self.body, bool(self.scene.planar))
        return wrench

    def command(
        self, joint: str, *, position: float | None = None, velocity: float | None = None, effort: float | None = None
    ) -> None:
        """Command the servo of a robot's `joint`, from now on: a position [rad], a velocity [rad/s] or an effort [N m].
        Without any of them it follows the law again.

        With a position, the velocity is the rate of the reference for the feedback's damping. Alone, it moves the
        reference, up to the joint's limits. With either of them, the effort is added to the torque of the feedback.
        The servo's limits always hold. The sign is the joint's.
        `ValueError` for an unknown joint, one without a servo, or a number that is not finite.
        """
        self.check_driven(joint)
        given = ("position", position), ("velocity", velocity), ("effort", effort)
        values = [
            value
            if value is None or (type(value) is float and -LARGEST <= value <= LARGEST)  # as from a message
            else number(f"{name} of joint {shown(joint)}", value)
            for name, value in given
        ]
        self._on_both(lambda march: march.command(joint, *values))
        self._meter.due = True

    def check_driven(self, joint: str) -> None:
        """`ValueError` for the name of a `joint` that cannot be commanded."""
        modes = self._swimmer.modes
        if modes is not None and isinstance(joint, str) and joint in modes.driven:
            return
        if self.robot is None:
            raise ValueError(f"joint {shown(joint)} cannot be commanded: there is no robot")
        if not isinstance(self.robot.joint(joint).actuator, Servo):
            raise ValueError(f"joint {shown(joint)} cannot be commanded: it has no servo")

    def _on_both(self, action: Callable[[March], March | None]) -> None:
        """Apply an action to the march and, if the error is measured, to its companion, at the same time.

        An action may return a march that replaces the one it got.
        """
        self._meter.catch_up(self._march)
        self._march = action(self._march) or self._march
        self._meter.repeat(action)

    def __copy__(self) -> "Simulation":
        """An independent copy, with the same results to the last bit; as by `copy.deepcopy` or a pickle."""
        return deepcopy(self)

    def copy_with(self, accuracy: Accuracy | None = None, robot: Robot | None = None) -> "Simulation":
        """A copy in the present state that continues with the settings `accuracy`, or with other numbers of the robot.

        robot: with the same parts at the same places; its gains, limits, springs and dampers may differ. None: as here.
        """
        other = object.__new__(type(self))
        other.__dict__.update(self.__dict__)
        swimmer = self._swimmer if robot is None else self._swimmer.with_robot(robot)
        if accuracy is not None:
            swimmer = swimmer.unchecked(accuracy=Accuracy.of(accuracy))
        other._swimmer, other.robot = swimmer, swimmer.robot
        own = self._march.swimmer
        other._march = self._march.copy_with(swimmer.unchecked(flow=own.flow, wrenches=own.wrenches))
        other._meter = ErrorMeter(other._march, False)
        other.currents = deepcopy(self.currents)
        return other

    def change_robot(self, robot: Robot) -> None:
        """Continue with other numbers of the robot, as in `copy_with`, from the present time on, and after a reset too.

        Commands hold. `ValueError` for other parts, or at other places.
        """
        swimmer = self._swimmer.with_robot(robot)
        self._on_both(lambda march: march.change_robot(swimmer.robot))
        self._swimmer, self.robot = swimmer, swimmer.robot
        self._meter.due = True

    # -- march

    def advance(self, time: float, interrupted: Callable[[], bool] | None = None) -> bool:
        """March to `time` [s]. Returns whether it was reached.

        Raises `SimulationStopped` if the march cannot continue; the state is then the last good one. interrupted() is
        called every few milliseconds. Once it returns true, the march ends at its present time. The next `advance`
        continues as if there had been no interruption.
        """
        if not self.ready:
            raise RuntimeError("no law has been adopted")
        if not is_finite(time) or time < self.time:
            raise ValueError(f"time must be finite and >= the present {self.time} s, got {shown(time)}")
        self._started = True
        reached = self._march.advance(float(time), interrupted)
        if reached and self._meter.wanted:
            self._meter.advanced(self._march, interrupted)
        return reached

    def set_state(self, position: ArrayLike, orientation: ArrayLike, twist: ArrayLike) -> None:
        """Set pose and twist of the head at the present time. The arguments are those of `Simulation`.

        The shape and its motion continue. The momentum becomes that of the twist. The ledger does not count the jump of
        the energy. `ValueError` for a state that the scene does not allow, or without a finite energy.
        """
        self._march.set_state(checked_state(self.scene.planar, position, orientation, twist))
        self._meter.begin_again(self._march)

    def reset(self, keep_law: bool = True) -> None:
        """Reset state and time to the start. The last law stays, with its own t = 0 at 0, unless `keep_law` is false.

        `ValueError` for a law that cannot begin from the initial state; the simulation is then unchanged.
        """
        self._march = March(self._swimmer.unchecked(law=self.law if keep_law else None))
        self.currents = CurrentStream(self._swimmer.default_transition)
        self.ready, self._started = self.law is not None, False
        self._meter = ErrorMeter(self._march, self._meter.wanted)

    def record(
        self, times: np.ndarray, wrench: bool, load: bool, look: Callable[[float], None] | None = None
    ) -> tuple[Observations, np.ndarray, int, SimulationStopped | None]:
        """March through `times` (T,) [s] under the law in force, and observe each.

        Returns the observations, the works (T, 8) [J] of `energy.WORKS`, the
        number of good instants, and what stopped the march, or None. look(time [s]) is called every few milliseconds.
        After a bad instant the simulation must be reset. `ValueError` for times that are not finite, or fall.
        """
        times = checked_row("times", times, None)
        if np.any(np.diff(times, prepend=self.time) < -ROUNDING * max(1.0, abs(self.time))):
            raise ValueError(f"times must not fall, from the present {self.time} s on, got {shown(times.tolist())}")
        self._started = True
        recorded = self._march.record(times, wrench, load, look)
        self._meter.compare(self._march)
        return recorded
