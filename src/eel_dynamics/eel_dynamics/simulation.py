"""A swimmer in water, marched in time and observed: the algorithm of section 7.1 of Boyer, Porez and Leroyer (2010)."""

import math
from collections.abc import Callable
from copy import copy

import numpy as np
from eel_gaits.law import Law
from eel_gaits.quantity import is_finite
from eel_gaits.wording import shown

import eel_core

from .accuracy import Accuracy
from .arguments import (
    check_planar,
    check_planar_law,
    checked_instance,
    checked_number,
    checked_quaternion,
    checked_row,
    checked_stations,
)
from .body import Body
from .difficulty import NOMINAL, Difficulty, difficulty_of
from .discretisation import GridSettings, discretise
from .energy import EnergyLedger
from .initial_state import InitialState, starts_fast, stays_in_plane, time_scale
from .law_follower import Instant, LawFollower
from .law_waves import MOST_WAVES, check_law, knots_of_law
from .observations import Observations, empty_observations
from .sample_check import first_bad_sample
from .scene import Scene
from .snapshot import Snapshot
from .step_bounds import MOST_EVALUATIONS, check_cost, step_bounds_of
from .stopping import SimulationStopped, not_begun, remedy, stopped_by

POINTS_PER_WAVE = 8  # of a controller's samples
MOST_POINTS = int(POINTS_PER_WAVE * MOST_WAVES) + 1  # of one
MOST_AHEAD, MOST_POINTS_AHEAD = 10_000, 1_000_000  # of the simulation: 50 MB of samples
MUCH_FINER = 1.5  # times the resolution that is needed: a grid that is changed for a coarser one
SLICE = 40_000  # nodes evaluated, after which a march comes back to be asked to go on: some 2 ms
MARCHED, SINGULAR, UNFINISHED = (eel_core.STATUSES.index(name) for name in ("marched", "singular", "unfinished"))


def check_points(count: int):
    """`ValueError` for an instant of a controller with more points along the body than any grid carries."""
    if count > MOST_POINTS:
        raise ValueError(f"curvature samples x must have at most {MOST_POINTS} points, got {count}")


class Simulation:
    """One swimmer, from its initial state on. Adopt a law (or add samples), advance, observe.

    body, scene: what swims in what. accuracy: preset, target relative error, or `Accuracy`. stations: how many, or
    their X (M,) [m]. position [m], orientation (x y z w, world from head), twist ((Omega, V) [rad/s, m/s], head's
    axes): the initial state, in the library's axes. default_transition [s]: of blends where a law gives none. law: the
    first to adopt. horizon [s]: how long a swim a target of accuracy is for, by default however long.
    most_evaluations: of the head's dynamics by simulated second; what takes more is refused, or stopped.
    `ValueError` names the argument that does not fit.
    """

    def __init__(
        self,
        body: Body | None = None,
        scene: Scene | None = None,
        accuracy: "str | float | Accuracy" = "standard",
        stations=51,
        position=(0.0, 0.0, 0.0),
        orientation=(0.0, 0.0, 0.0, 1.0),
        twist=(0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        default_transition: float = 1.0,
        law: Law | None = None,
        horizon: float = math.inf,
        most_evaluations: float = MOST_EVALUATIONS,
    ):
        self.body = Body.boyer2010() if body is None else checked_instance("body", body, Body)
        self.scene = Scene() if scene is None else checked_instance("scene", scene, Scene)
        self._wanted = Accuracy.of(accuracy)
        self.x = checked_stations(stations, self.body.length)
        self._current = np.array(self.scene.current)
        self._march = self.accuracy = None
        self._marches_anew = False  # other settings are to be taken
        start = InitialState(
            checked_row("position", position, 3),
            checked_quaternion("orientation", orientation),
            checked_row("twist", twist, 6),
        )
        if self.scene.planar:
            check_planar(*start)
        if not (is_finite(default_transition) and default_transition > 0.0):
            raise ValueError(f"default_transition must be finite and > 0 s, got {shown(default_transition)}")
        if not (horizon == math.inf or is_finite(horizon)) or horizon < 0.0:
            raise ValueError(f"horizon must be >= 0 s, got {shown(horizon)}")
        self._default_transition, self._horizon, self._built = float(default_transition), float(horizon), None
        self._most_evaluations = checked_number("most_evaluations", most_evaluations, "per simulated second")
        self._begin(law, start)

    def _begin(self, law: Law | None, start: InitialState):
        """Stand at the `start`, and follow `law`, if there is one."""
        with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is reported
            self._prepare(law, start)
            try:
                self._set_off()
            except SimulationStopped as stopped:
                raise stopped if law is None else not_begun(law, stopped) from None

    def _prepare(self, law: Law | None, start: InitialState):
        """All of `_begin` but the momentum that the motion starts with."""
        self._start, self._relative = start, start.in_water(self._current)
        self._motion_scale = time_scale(self._relative, self.body.length)
        self._thrown = starts_fast(law, self._motion_scale)
        waves, knots = (1.0, ()) if law is None else self._needs(law)
        self._moving = bool(self._relative.any())
        self._use_accuracy(stays_in_plane(law, self._relative) and not self._thrown, waves, self._effort_of(law))
        wanted = GridSettings(self.accuracy.points_per_length(waves), self.accuracy.kinks, knots)
        if wanted != self._built:
            self._build(wanted)
        self.shape = LawFollower(self._table.tabulation, self._default_transition, law)
        self.ready, self._started, self.time = law is not None, False, 0.0
        self._stand()

    def _build(self, wanted: GridSettings):
        """Have body and scene tabulated on the grid that is `wanted`."""
        self._table, self._built = discretise(self.body, self.scene, wanted, self.x.tobytes()), wanted
        self._marches_anew = True

    @property
    def state(self) -> np.ndarray:
        """(13,) position, orientation, momentum about the head, in the world's axes."""
        return np.array(self._march.state)

    @property
    def grid(self):
        """The nodes along the body (`quadrature.Grid`)."""
        return self._table.grid

    @property
    def discretisation(self):
        """Body and scene on the grid (`discretisation.Discretisation`)."""
        return self._table

    # -- what drives the body

    @property
    def law(self) -> Law | None:
        """The law in force, or the last one before a controller took over."""
        return self.shape.law

    @property
    def samples_until(self) -> float | None:
        """Last instant [s] of a controller's samples, or None where there are none."""
        return self.shape.until

    @property
    def sampled(self) -> bool:
        """A controller's samples drive the shape at present."""
        return self.shape.sampled

    @property
    def resting(self) -> bool:
        """A controller's samples have run out: the shape comes to rest."""
        return self.shape.resting

    def adopt(self, law: Law, origin: float = 0.0, transition: float | None = None):
        """Follow `law` from the present time on; `origin` [s] is the simulation time of its own t = 0.

        The first law, before the start, needs no blend; a later one takes over during `transition` [s], or the law's
        own, or the default. `ValueError` for a law that the scene does not allow.
        """
        needs = self._needs(law)
        if not is_finite(origin):
            raise ValueError(f"law origin must be finite, got {shown(origin)} s")
        blend = transition or law.transition or self.shape.default_transition
        if not (is_finite(blend) and blend > 0.0):
            raise ValueError(f"transition must be finite and > 0 s, got {shown(transition)}")
        first = not self._started
        plane, waves, difficulty, further = self._plane, self._waves, self._effort, self._effort_of(law)
        before = copy(self.shape), self._table, self._built
        both = (needs[0], further) if first else (max(waves, needs[0]), difficulty.at_least(further))
        self._use_accuracy(plane and law.in_plane, *both)
        self._waves, self._effort = needs[0], further  # a law after the next needs no care for the present one
        self._refine(*needs)
        self.shape.adopt(law, origin=float(origin), time=self.time, transition=0.0 if first else float(blend))
        if first:
            try:
                with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is reported below
                    self._take_initial_state()
            except SimulationStopped as stopped:
                self.shape, self._table, self._built = before
                self._use_accuracy(plane, waves, difficulty)
                self._take_initial_state()
                raise not_begun(law, stopped) from None
        else:
            self._follow_shape()
        self.ready = True

    def _effort_of(self, law: Law | None) -> Difficulty:
        """What `law` has the body do until the horizon; the usual where it is not known, or the body moves already."""
        if law is None:
            return NOMINAL
        difficulty = difficulty_of(law, self.body.length, self._horizon)
        return difficulty.at_least(NOMINAL) if self._moving else difficulty

    def _use_accuracy(self, plane: bool, waves: float, difficulty: Difficulty):
        """Take the settings for a motion that stays in a `plane`, or for any, of a shape of up to so many `waves`, and
        for such `difficulty`; the march so far counts on."""
        accuracy = self._wanted.in_scene(self.scene, plane, difficulty)
        self._plane, self._waves, self._effort = plane, waves, difficulty
        if self._thrown:
            accuracy = accuracy.for_fast_start()
        accuracy = accuracy.for_waves(waves)
        if accuracy != self.accuracy:
            self.accuracy, self._marches_anew = accuracy, True

    def _needs(self, law: Law) -> tuple[float, tuple[float, ...]]:
        """Waves on the body, and knots [m] of the splines of `law`, that the grid has to carry. `ValueError` for one
        that the scene does not allow."""
        checked_instance("law", law, Law)
        if self.scene.planar:
            check_planar_law(law)
        check_cost(law, self._most_evaluations)
        return check_law(law, self.body.length), knots_of_law(law)

    def add_samples(self, time, x, pitch, pitch_rate, pitch_accel, yaw, yaw_rate, yaw_accel):
        """One instant of a controller: curvature [rad/m], its rate and acceleration at the points `x` [m], `time` [s]
        ahead.

        Natural cubic splines in X; between instants the quintic that meets value, rate and acceleration at both. It
        takes over as soon as two instants bracket the present. `ValueError` names what does not fit.
        """
        check_points(len(x))
        if len(self.shape.samples) >= MOST_AHEAD or self.shape.points_ahead + len(x) > MOST_POINTS_AHEAD:
            raise ValueError(
                f"curvature samples ahead of the simulation must be at most {MOST_AHEAD}, of {MOST_POINTS_AHEAD} "
                f"points, got {len(self.shape.samples) + 1} of {self.shape.points_ahead + len(x)}"
            )
        x = checked_row("curvature samples x", x, None)
        if len(x) < 2 or np.any(np.diff(x) <= 0.0):
            raise ValueError(f"curvature samples x must rise over 2 points or more, got {len(x)} points")
        if x[0] < -1e-9 * self.body.length or x[-1] > self.body.length * (1.0 + 1e-9):
            raise ValueError(f"curvature samples x must lie within 0 to {self.body.length} m, got {x[0]} to {x[-1]}")
        names = "pitch", "pitch_rate", "pitch_accel", "yaw", "yaw_rate", "yaw_accel"
        values = [
            checked_row(f"curvature samples {name}", row, len(x))
            for name, row in zip(names, (pitch, pitch_rate, pitch_accel, yaw, yaw_rate, yaw_accel), strict=True)
        ]
        if self.scene.planar and any(np.any(row) for row in values[:3]):
            raise ValueError("curvature samples pitch must be 0 in a planar scene")
        if not is_finite(time) or time <= self.time:
            raise ValueError(
                f"curvature samples time must lie ahead of the simulation ({self.time:.6f} s), got {shown(time)} s"
            )
        before = self.accuracy
        self._use_accuracy(False, self._waves, self._effort.at_least(NOMINAL))
        if self.accuracy is not before:  # and so is the step
            self._refine(self._waves, self._built.knots)
            self._follow_shape()
        self.shape.add(Instant(float(time), x, np.reshape(values, (2, 3, len(x)))))
        self.ready = True

    def _prepare_for(self, instants: list[Instant]):
        """Have a grid for `instants` of a controller, which is no finer than they need; in few sizes, for each is
        kept."""
        waves = max((len(each.x) - 1) / POINTS_PER_WAVE for each in instants)
        self._fit(2.0 ** math.ceil(math.log2(max(1.0, waves))))

    def _fit(self, waves: float, knots: tuple[float, ...] = ()):
        """Have a grid that is fine enough for `waves`, and, once nothing finer is left, not much finer than that."""
        wanted = GridSettings(self.accuracy.points_per_length(waves), self.accuracy.kinks, knots)
        if self._built.resolution > MUCH_FINER * wanted.resolution and not self.shape.blending:
            self._change_grid(wanted)
        else:
            self._refine(waves, knots)

    def _refine(self, waves: float, knots: tuple[float, ...] = ()):
        """Have a grid that is fine enough for a shape of `waves` waves on the body, cut at its `knots` [m]; the head's
        motion goes on as it is."""
        built = self._built
        resolution = max(built.resolution, self.accuracy.points_per_length(waves))
        fine_enough = resolution <= built.resolution * (1.0 + 1e-9) and set(knots) <= set(built.knots)
        if fine_enough and self.accuracy.kinks == built.kinks:
            return
        self._change_grid(GridSettings(resolution, self.accuracy.kinks, knots))

    def _change_grid(self, wanted: GridSettings):
        """Go on with the grid that is `wanted`; the head's motion stays as it is."""
        old, twist = self._table.grid, self._twist()
        self._build(wanted)
        rows, first, _ = old.rows_at(self._table.tabulation.x, "value")

        def values(fields):
            return sum(
                rows[:, j] * fields[..., np.minimum(first + j, len(old.x) - 1).astype(np.int64)]
                for j in range(rows.shape[1])
            )

        self.shape.move(self._table.tabulation, values)
        self._follow_shape()
        self._march.set_twist(twist)

    # -- march

    def advance(self, time: float, interrupted: Callable[[], bool] | None = None) -> bool:
        """March to `time` [s]; whether it was reached. Raises `SimulationStopped` where it cannot; the state stays the
        last good one.

        interrupted(): asked every few milliseconds. Once it is true the march ends where it has come to, and another
        `advance` goes on as if nothing had been.
        """
        if not self.ready:
            raise RuntimeError("no law has been adopted")
        if not is_finite(time) or time < self.time:
            raise ValueError(f"time must be finite and >= the present {self.time} s, got {shown(time)}")
        self._started, time = True, float(time)
        while True:
            self.shape.pass_event(self.time, self._prepare_for)
            if self._marches_anew or self.shape.tabulated_law is not self.tabulated_law:
                self._follow_shape()
            event = self.shape.next_event(self.time)
            if not self._march_to(min(time, event), interrupted):
                return False
            if time <= event:
                break
        self.shape.end_blend(self.time)
        if self.shape.tabulated_law is not self.tabulated_law:
            self._follow_shape(smoothly=True)
            if not self.shape.sampled and self.shape.law is not None:
                self._fit(*self._needs(self.shape.law))
        return True

    def _march_to(self, time: float, interrupted) -> bool:
        while (status := self._march.advance(time)) == UNFINISHED:
            if interrupted is not None and interrupted():
                self.time = self._march.time
                return False
        self.time = self._march.time
        if status != MARCHED:
            raise self._stopped(status)
        return True

    def _stopped(self, status: int) -> SimulationStopped:
        return stopped_by(status, self.time, self._bounds, self.accuracy)

    # -- observe

    def observe(self, wrench: bool = True, load: bool = True) -> Snapshot:
        """What the present instant shows; `wrench` and `load` ask for the internal wrench and the water's load along
        the body."""
        wrench, load = bool(wrench and self.scene.internal_wrench), bool(load)
        out, ledger, works = empty_observations(1, len(self.x), wrench, load), self.scene.ledger, self.works
        if not self._march.observe(out.whole, wrench, load):
            raise self._stopped(SINGULAR)
        return Snapshot(
            time=self.time,
            position=out.position[0],
            orientation=out.orientation[0],
            twist=out.twist[0],
            head_acceleration=out.head_acceleration[0],
            center_of_mass=out.center_of_mass[0],
            x=self.x,
            backbone=out.backbone[0],
            section_orientation=out.section_orientation[0],
            curvature=out.curvature[0],
            curvature_rate=out.curvature_rate[0],
            torque=out.torque[0] if wrench else None,
            force=out.force[0] if wrench else None,
            fluid_force=out.fluid_force[0] if load else None,
            resistive_force=out.resistive_force[0] if load else None,
            tail_force=out.tail_force[0] if load else None,
            nose_force=out.nose_force[0] if load else None,
            energy=EnergyLedger.of(out.kinetic[0], out.powers[0], works, self.kinetic_at_start) if ledger else None,
            closure_torque=float(out.closure[0, 0]) if wrench else None,
            closure_force=float(out.closure[0, 1]) if wrench else None,
            actuator_work=float(works[0]) if ledger else None,
            whole=out.whole,
        )

    @property
    def works(self) -> np.ndarray:
        """(4,) J of actuators, wake, nose and drag since the start."""
        return np.array(self._march.works)

    def record(
        self, times: np.ndarray, wrench: bool, load: bool, look: Callable[[float], None] | None = None
    ) -> tuple[Observations, np.ndarray, int, SimulationStopped | None]:
        """March through `times` (T,) [s] under the law in force, observing each: the profiles, the works (T, 4) [J] of
        actuators, wake, nose and drag, how many instants are good, and what stopped it, if anything did; look(time
        [s]) is called every few milliseconds. Behind a bad instant it must be reset."""
        out, works = empty_observations(len(times), len(self.x), wrench, load), np.zeros((len(times), 4))
        return out, works, *self.record_into(np.array(times, dtype=float), out, works, wrench, load, look)

    def record_into(
        self, times, out: Observations, works, wrench: bool, load: bool, look=None
    ) -> tuple[int, SimulationStopped | None]:
        """As `record`, into the space of `out` and `works`."""
        self._started, done, status = True, 0, UNFINISHED
        while status == UNFINISHED:
            done, status = self._march.record(times, done, out.whole, works, bool(wrench), bool(load))
            if look is not None and status == UNFINISHED:
                look(self._march.time)
        failure = first_bad_sample(out, works, done, self.kinetic_at_start, self.energy_floor)
        if failure:
            done, quantity, value = failure
        if done:
            self.time = float(times[done - 1])
        if failure:
            return done, SimulationStopped(self.time, quantity, value, remedy(self.accuracy))
        return done, None if status == MARCHED else self._stopped(status)

    @property
    def energy_floor(self) -> float:
        """As `first_bad_sample` has it: where steps are chosen by their error, that is what watches."""
        watched = self.scene.ledger and self.accuracy.method == "classical"
        return self._bounds.momentum_floor**2 / self._table.mass if watched else np.inf

    @property
    def evaluations(self) -> tuple[int, int, int]:
        """Steps, rejected steps and evaluations of the head's dynamics so far."""
        return self._march.counts

    @property
    def memory(self) -> int:
        """Bytes that an evaluation reads and writes."""
        return self._march.memory

    # -- states

    def reset(self):
        """State and time to the start; the last law kept, with its own t = 0 at 0."""
        law = self.shape.law
        waves, knots = (1.0, ()) if law is None else self._needs(law)
        wanted = GridSettings(self.accuracy.points_per_length(waves), self.accuracy.kinks, knots)
        if wanted != self._built:  # finer for what is gone
            self._build(wanted)
        self.shape = LawFollower(self._table.tabulation, self.shape.default_transition)
        self.time, self.ready, self._started = 0.0, False, False
        if law is None:
            self._take_initial_state()
        else:
            self.adopt(law)

    def _follow_shape(self, smoothly: bool = False):
        """March on with the shape, grid and settings of the present; the next step begins anew, unless the motion goes
        on `smoothly`."""
        self.tabulated_law, accuracy = self.shape.tabulated_law, self.accuracy
        if self._marches_anew:
            self._march.change(self._table.swimmer, accuracy.method, accuracy.order, bool(self.scene.planar))
            self._marches_anew = False
        self._bounds = step_bounds_of(
            accuracy=accuracy,
            scene=self.scene,
            shape=self.shape,
            table=self._table,
            length=self.body.length,
            scale=self._motion_scale,
            most_evaluations=self._most_evaluations,
        )
        breakpoints, ledger = self.shape.breakpoints().tolist(), bool(self.scene.ledger)
        self._march.follow(self.tabulated_law, breakpoints, self._bounds, ledger, self._current, smoothly)

    def _twist(self) -> np.ndarray:
        """Twist (6,) of the head relative to the water, in its axes, of the present state."""
        try:
            return np.array(self._march.twist())
        except ValueError:
            raise self._stopped(SINGULAR) from None

    def _take_initial_state(self):
        self._stand()
        self._set_off()

    def _stand(self):
        """A march of its own from the start on, but for the momentum."""
        accuracy = self.accuracy
        self._march = eel_core.March(self._table.swimmer, accuracy.method, accuracy.order, bool(self.scene.planar))
        self._march.set_slice(SLICE)
        self._marches_anew = False
        self._follow_shape()

    def _set_off(self):
        position, orientation, _ = self._start
        self.kinetic_at_start = self._march.start(position, orientation, self._relative)
        if not np.isfinite(self.kinetic_at_start):
            raise SimulationStopped(self.time, "kinetic energy", self.kinetic_at_start, "start slower")
