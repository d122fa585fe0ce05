# SPDX-License-Identifier: Apache-2.0
"""The march in time of a swimmer under a law. The law's needs give the grid, its breakpoints the steps."""

from collections.abc import Callable
from copy import deepcopy

import numpy as np
from eel_gaits.laws.law import Law
from eel_gaits.sources.sampled_law import SampledLaw

import eel_core
from eel_dynamics.curvature.curvature_samples import CurvatureSample
from eel_dynamics.curvature.law_follower import LawFollower
from eel_dynamics.model.initial_state import InitialState, time_scale
from eel_dynamics.simulation.compiled_march import MARCHED, CompiledMarch
from eel_dynamics.simulation.discretisation import GridSettings
from eel_dynamics.simulation.observations import Observations
from eel_dynamics.simulation.simulation_setup import ShapeNeeds, SimulationSetup
from eel_dynamics.simulation.step_bounds import step_bounds_of
from eel_dynamics.simulation.stopping import SimulationStopped, not_begun

MUCH_FINER = 1.5  # times the resolution that is needed: a coarser grid replaces such a grid


class LawDrivenMarch:
    """A march from the initial state of a `setup`, on a grid of these `settings`.

    The `follower` follows `law`, which has these `needs` and whose own t = 0 lies at `origin` [s]. Without a law the
    body is straight. The `compiled` march is that of the head. `SimulationStopped` where the initial state has no
    finite energy.
    """

    def __init__(self, setup: SimulationSetup, settings: GridSettings, needs: ShapeNeeds, law=None, origin=0.0):
        self._setup, self.settings, self._needs, self._time_scale = setup, settings, needs, setup.time_scale
        discretisation = setup.discretise(settings)
        self.follower = LawFollower(discretisation.tabulation, setup.default_transition, law, origin)
        self.compiled = CompiledMarch(discretisation, setup.scene, setup.settings)
        self._hand_over_law()
        position, orientation, _ = setup.initial_state
        self.energy_at_start = self.compiled.start(position, orientation, setup.initial_twist)

    def copy_with(self, setup: SimulationSetup) -> "LawDrivenMarch":
        """A copy in the present state, on a grid for the accuracy of `setup`, which differs in that alone."""
        copied, finer = deepcopy(self), setup.settings.resolution / self._setup.settings.resolution
        copied._setup, resolution = setup, max(1.0, finer * self.settings.resolution)
        copied._change_grid(GridSettings(resolution, setup.settings.kinks, self.settings.knots))
        return copied

    # -- law and grid

    def adopt(self, law: Law | SampledLaw, origin: float, transition: float, needs: ShapeNeeds):
        """Follow `law` from now on, with a blend over `transition` [s].

        origin [s]: the time of the law's own t = 0. The grid fits the `needs` of the law and of the last one.
        """
        self._refine(ShapeNeeds(max(self._needs.waves, needs.waves), needs.knots))
        self.follower.adopt(law, origin=origin, time=self.compiled.time, transition=transition)
        self._hand_over_law()
        self._needs = needs

    def set_state(self, state: InitialState):
        """Put the head into `state` at the present time; the next step begins anew.

        `ValueError` without a finite energy; the march then stays as it is.
        """
        march, length = self.compiled, self._setup.body.length
        before, twist, relative = march.state, march.twist, state.in_water(self._setup.current)
        with np.errstate(over="ignore", invalid="ignore"):
            energy = march.set_state(state.position, state.orientation, relative)
            present = march.set_state(before[:3], before[3:7], twist)
        if not np.isfinite(energy):
            raise ValueError(f"twist must give a finite kinetic energy, got {energy} J")
        self._time_scale = min(self._setup.time_scale, time_scale(relative, length))
        self._hand_over_law()
        march.set_state(state.position, state.orientation, relative)
        self.energy_at_start += energy - present

    def _refine(self, needs: ShapeNeeds):
        """Make the grid fine enough for the `needs`. The head's motion does not change."""
        settings = self.settings.at_least(GridSettings.of(self._setup.settings, *needs))
        if settings is not self.settings:
            self._change_grid(settings)

    def _fit(self, needs: ShapeNeeds):
        """Make the grid fine enough for the `needs` and, once no finer motion is left, not much finer."""
        wanted = GridSettings.of(self._setup.settings, *needs)
        if wanted == self.settings:
            return
        if self.settings.resolution > MUCH_FINER * wanted.resolution and not self.follower.blending:
            self._change_grid(wanted)
        else:
            self._refine(needs)

    def _fit_samples(self, samples: list[CurvatureSample]):
        """Have a grid for `samples`."""
        self._fit(ShapeNeeds(max(sample.waves for sample in samples)))

    def _change_grid(self, settings: GridSettings):
        old, twist = self.compiled.discretisation.grid, self.compiled.twist
        discretisation = self._setup.discretise(settings)
        self.follower.move(discretisation.tabulation, old.interpolation_at(discretisation.tabulation.x))
        self.settings = settings
        self.compiled.change(discretisation, self._setup.settings)
        self._hand_over_law()
        self.compiled.set_twist(twist)

    def _hand_over_law(self, smoothly: bool = False):
        """Continue under the follower's law. The next step begins anew, unless the motion goes on `smoothly`."""
        self.compiled.follow(self.follower.tabulated_law, self.follower.breakpoints, self._step_bounds(), smoothly)

    def _step_bounds(self) -> eel_core.StepBounds:
        setup, follower, length = self._setup, self.follower, self._setup.body.length
        discretisation = self.compiled.discretisation
        return step_bounds_of(
            accuracy=setup.settings,
            ledger=bool(setup.scene.ledger),
            between_samples=follower.between_samples,
            nodes=len(discretisation.grid.x),
            mass=discretisation.mass,
            length=length,
            speed=follower.speed(length),
            scale=min(follower.time_scale, self._time_scale, discretisation.righting_time),
            most_evaluations=setup.most_evaluations,
        )

    # -- march

    def advance(self, time: float, interrupted: Callable[[], bool] | None) -> bool:
        """As `Simulation.advance`."""
        while True:
            event = self._pass_event()
            if not self.compiled.advance(min(time, event), interrupted):
                return False
            if time <= event:
                break
        self.follower.end_blend(self.compiled.time)
        if self.follower.tabulated_law is not self.compiled.tabulated_law:
            self._hand_over_law(smoothly=True)
            if not self.follower.sampled and self.follower.law is not None:
                self._fit(self._setup.shape_needs(self.follower.law))
        return True

    def _pass_event(self) -> float:
        """Change the source of curvature where that is due at the present; the next time [s] of such a change.

        From one pair of samples to the next the curvature has two continuous derivatives, and the motion goes on
        smoothly: the rate of the momentum depends on the curvature and its rate.
        """
        before, now = self.follower.between_samples, self.compiled.time
        self.follower.pass_event(now, self._fit_samples)
        if self.follower.tabulated_law is not self.compiled.tabulated_law:
            self._hand_over_law(smoothly=before and self.follower.between_samples)
        return self.follower.next_event(now)

    def record(self, times, out: Observations, works, wrench: bool, load: bool, look) -> tuple:
        """As `Simulation.record`, into `out` and `works` (T, 4)."""
        done, status = 0, MARCHED
        while status == MARCHED and done < len(times):
            done, status = self.compiled.record(self._pass_event(), times, done, out, works, wrench, load, look)
        return self.compiled.checked_record(times, done, status, out, works, self.energy_at_start)

    @property
    def head(self) -> InitialState:
        """As `Simulation.head`."""
        state = self.compiled.state
        return InitialState(state[:3], state[3:7], self.compiled.twist).against_water(self._setup.current)


def march_from_start(
    setup: SimulationSetup,
    needs: ShapeNeeds,
    law: Law | SampledLaw | None,
    origin: float = 0.0,
    grid: GridSettings | None = None,
) -> LawDrivenMarch:
    """A march from the initial state under `law`, on a grid for its `needs`: `grid`, or a finer one.

    origin [s]: the time of the law's own t = 0. `ValueError` where the law cannot be begun.
    """
    wanted = GridSettings.of(setup.settings, *needs)
    settings = wanted if grid is None else grid.at_least(wanted)
    try:
        with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is reported
            return LawDrivenMarch(setup, settings, needs, law, origin)
    except SimulationStopped as stopped:
        raise stopped if law is None else not_begun(law, stopped) from None
