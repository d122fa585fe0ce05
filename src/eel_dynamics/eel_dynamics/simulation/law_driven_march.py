# SPDX-License-Identifier: Apache-2.0
"""The march in time of a swimmer under a law. The law's needs give the grid, its breakpoints the steps."""

from collections.abc import Callable
from copy import deepcopy

import numpy as np
from eel_gaits.laws.law import Law

import eel_core
from eel_dynamics.curvature.curvature_samples import CurvatureSample
from eel_dynamics.curvature.law_follower import LawFollower
from eel_dynamics.model.initial_state import InitialState, time_scale
from eel_dynamics.simulation.discretisation import Discretisation, GridSettings
from eel_dynamics.simulation.observations import Observations
from eel_dynamics.simulation.sample_check import first_bad_sample
from eel_dynamics.simulation.simulation_setup import ShapeNeeds, SimulationSetup
from eel_dynamics.simulation.step_bounds import step_bounds_of
from eel_dynamics.simulation.stopping import SimulationStopped, not_begun, remedy, stopped_by

MUCH_FINER = 1.5  # times the resolution that is needed: a coarser grid replaces such a grid
MARCHED, SINGULAR, UNFINISHED = (eel_core.STATUSES.index(name) for name in ("marched", "singular", "unfinished"))


class LawDrivenMarch:
    """A march from the initial state of a `setup`, on a grid of these `settings`.

    The `follower` follows `law`, whose own t = 0 lies at `origin` [s]. Without a law the body is straight.
    `SimulationStopped` where the initial state has no finite energy.
    """

    def __init__(self, setup: SimulationSetup, settings: GridSettings, law=None, origin=0.0):
        self._setup, self.settings = setup, settings
        self.accuracy, self.discretisation, self.time = setup.settings, setup.discretise(settings), 0.0
        self.follower = LawFollower(self.discretisation.tabulation, setup.default_transition, law, origin)
        self._time_scale = setup.time_scale
        self.tabulated_law, self._bounds = self.follower.tabulated_law, self._step_bounds()
        self._march = eel_core.March(self.discretisation.swimmer, *self._method)
        self._hand_over_law(smoothly=False)
        position, orientation, _ = setup.initial_state
        self.energy_at_start = self._march.start(position, orientation, setup.initial_twist)
        if not np.isfinite(self.energy_at_start):
            raise SimulationStopped(0.0, "kinetic energy", self.energy_at_start, "start slower")

    def copy_with(self, setup: SimulationSetup) -> "LawDrivenMarch":
        """A copy in the present state, on a grid for the accuracy of `setup`, which differs in that alone."""
        copied, finer = deepcopy(self), setup.settings.resolution / self.accuracy.resolution
        copied._setup, copied.accuracy = setup, setup.settings
        resolution = max(1.0, finer * self.settings.resolution)
        copied._change_grid(GridSettings(resolution, setup.settings.kinks, self.settings.knots))
        return copied

    # -- law, accuracy and grid

    def adopt(self, law: Law, origin: float, transition: float, needs: ShapeNeeds, last: ShapeNeeds):
        """Follow `law` from now on, with a blend over `transition` [s].

        origin [s]: the time of the law's own t = 0. The grid fits the `needs` of the law and of the `last` one.
        """
        self.refine(ShapeNeeds(max(last.waves, needs.waves), needs.knots))
        self.follower.adopt(law, origin=origin, time=self.time, transition=transition)
        self.follow()

    def add_sample(self, sample: CurvatureSample):
        """Add a controller's sample. `ValueError` for a sample that comes too late, or twice."""
        self.follower.add(sample)

    def follow(self, smoothly: bool = False):
        """Continue under the follower's present law.

        The next step begins anew, unless the motion goes on `smoothly`.
        """
        self._go_on(self.discretisation, smoothly)

    def set_state(self, state: InitialState):
        """Put the head into `state` at the present time; the next step begins anew.

        `ValueError` without a finite energy; the march then stays as it is.
        """
        before, twist, length = self.state, self._twist(), self._setup.body.length
        relative = state.in_water(self._setup.current)
        with np.errstate(over="ignore", invalid="ignore"):
            energy = self._march.set_state(state.position, state.orientation, relative)
            present = self._march.set_state(before[:3], before[3:7], twist)
        if not np.isfinite(energy):
            raise ValueError(f"twist must give a finite kinetic energy, got {energy} J")
        self._time_scale = min(self._setup.time_scale, time_scale(relative, length))
        self._bounds = self._step_bounds()
        self._hand_over_law(smoothly=False)
        self._march.set_state(state.position, state.orientation, relative)
        self.energy_at_start += energy - present

    def refine(self, needs: ShapeNeeds):
        """Make the grid fine enough for the `needs`. The head's motion does not change."""
        settings = self.settings.at_least(GridSettings.of(self.accuracy, *needs))
        if settings is not self.settings:
            self._change_grid(settings)

    def fit(self, needs: ShapeNeeds):
        """Make the grid fine enough for the `needs` and, once no finer motion is left, not much finer."""
        wanted = GridSettings.of(self.accuracy, *needs)
        if wanted == self.settings:
            return
        if self.settings.resolution > MUCH_FINER * wanted.resolution and not self.follower.blending:
            self._change_grid(wanted)
        else:
            self.refine(needs)

    def _fit_samples(self, samples: list[CurvatureSample]):
        """Have a grid for `samples`."""
        self.fit(ShapeNeeds(max(sample.waves for sample in samples)))

    def _change_grid(self, settings: GridSettings):
        old, twist = self.discretisation.grid, self._twist()
        self.settings, discretisation = settings, self._setup.discretise(settings)
        rows, first, _ = old.rows_at(discretisation.tabulation.x, "value")

        def values(fields):
            return sum(
                rows[:, j] * fields[..., np.minimum(first + j, len(old.x) - 1).astype(np.int64)]
                for j in range(rows.shape[1])
            )

        self.follower.move(discretisation.tabulation, values)
        self._go_on(discretisation)
        self._march.set_twist(twist)

    def _go_on(self, discretisation: Discretisation, smoothly: bool = False):
        if discretisation is not self.discretisation:
            self._march.change(discretisation.swimmer, *self._method)
        self.discretisation, self.tabulated_law = discretisation, self.follower.tabulated_law
        self._bounds = self._step_bounds()
        self._hand_over_law(smoothly)

    def _hand_over_law(self, smoothly: bool):
        ledger, current = bool(self._setup.scene.ledger), self._setup.current
        self._march.follow(self.tabulated_law, self.follower.breakpoints, self._bounds, ledger, current, smoothly)

    @property
    def _method(self) -> tuple[str, int, bool]:
        return self.accuracy.method, self.accuracy.order, bool(self._setup.scene.planar)

    def _step_bounds(self) -> eel_core.StepBounds:
        setup, follower, length = self._setup, self.follower, self._setup.body.length
        return step_bounds_of(
            accuracy=self.accuracy,
            ledger=bool(setup.scene.ledger),
            between_samples=follower.between_samples,
            nodes=len(self.discretisation.grid.x),
            mass=self.discretisation.mass,
            length=length,
            speed=follower.speed(length),
            scale=min(follower.time_scale, self._time_scale, self.discretisation.righting_time),
            most_evaluations=setup.most_evaluations,
        )

    # -- march

    def advance(self, time: float, interrupted: Callable[[], bool] | None) -> bool:
        """As `Simulation.advance`."""
        while True:
            event = self._pass_event()
            if not self._march_to(min(time, event), interrupted):
                return False
            if time <= event:
                break
        self.follower.end_blend(self.time)
        if self.follower.tabulated_law is not self.tabulated_law:
            self.follow(smoothly=True)
            if not self.follower.sampled and self.follower.law is not None:
                self.fit(self._setup.shape_needs(self.follower.law))
        return True

    def _pass_event(self) -> float:
        """Change the source of curvature where that is due at the present; the next time [s] of such a change.

        From one pair of samples to the next the curvature has two continuous derivatives, and the motion goes on
        smoothly: the rate of the momentum depends on the curvature and its rate.
        """
        before = self.follower.between_samples
        self.follower.pass_event(self.time, self._fit_samples)
        if self.follower.tabulated_law is not self.tabulated_law:
            self.follow(smoothly=before and self.follower.between_samples)
        return self.follower.next_event(self.time)

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

    def observe(self, out: Observations, wrench: bool, load: bool):
        """Write the observations of the present instant into `out`."""
        if not self._march.observe(out.whole, wrench, load):
            raise self._stopped(SINGULAR)

    def record(self, times, out: Observations, works, wrench: bool, load: bool, look) -> tuple:
        """As `Simulation.record`, into `out` and `works` (T, 4)."""
        done, status = 0, MARCHED
        while status == MARCHED and done < len(times):
            event, status = self._pass_event(), UNFINISHED
            while status == UNFINISHED:
                done, status = self._march.record(times, done, out.whole, works, bool(wrench), bool(load), event)
                if status == MARCHED and done < len(times):
                    status = self._march.advance(event)
                if look is not None and status == UNFINISHED:
                    look(self._march.time)
            self.time = self._march.time
        failure = first_bad_sample(out, works, done, self.energy_at_start, self._energy_floor)
        if failure:
            done, quantity, value = failure
        if done:
            self.time = float(times[done - 1])
        if failure:
            return done, SimulationStopped(self.time, quantity, value, remedy(self.accuracy))
        return done, None if status == MARCHED else self._stopped(status)

    @property
    def _energy_floor(self) -> float:
        """The floor [J] for `first_bad_sample`; infinite where the steps follow from their error, a check by itself."""
        checked = self._setup.scene.ledger and self.accuracy.method == "classical"
        return self._bounds.momentum_floor**2 / self.discretisation.mass if checked else np.inf

    @property
    def head(self) -> InitialState:
        """As `Simulation.head`."""
        state = self.state
        return InitialState(state[:3], state[3:7], self._twist()).against_water(self._setup.current)

    def _twist(self) -> np.ndarray:
        """Twist (6,) of the head relative to the water, in its axes, of the present state."""
        try:
            return np.array(self._march.twist())
        except ValueError:
            raise self._stopped(SINGULAR) from None

    @property
    def state(self) -> np.ndarray:
        """As `Simulation.state`."""
        return np.array(self._march.state)

    @property
    def works(self) -> np.ndarray:
        """As `Simulation.works`."""
        return np.array(self._march.works)

    @property
    def counts(self) -> tuple[int, int, int]:
        """As `Simulation.evaluations`."""
        return self._march.counts

    @property
    def memory(self) -> int:
        """As `Simulation.memory`."""
        return self._march.memory


def march_from_start(
    setup: SimulationSetup, needs: ShapeNeeds, law: Law | None, origin: float = 0.0, grid: GridSettings | None = None
) -> LawDrivenMarch:
    """A march from the initial state under `law`, on a grid for its `needs`: `grid`, or a finer one.

    origin [s]: the time of the law's own t = 0. `ValueError` where the law cannot be begun.
    """
    wanted = GridSettings.of(setup.settings, *needs)
    settings = wanted if grid is None else grid.at_least(wanted)
    try:
        with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is reported
            return LawDrivenMarch(setup, settings, law, origin)
    except SimulationStopped as stopped:
        raise stopped if law is None else not_begun(law, stopped) from None
