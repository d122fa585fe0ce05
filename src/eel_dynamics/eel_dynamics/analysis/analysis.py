# SPDX-License-Identifier: Apache-2.0
"""Analyses a run: speed, kinematic numbers, power and efficiency over whole periods of the gait.

    analysis = run.analysis()          # the later half of the run, in whole periods
    analysis.mean_speed, analysis.strouhal, analysis.propulsive_efficiency

A ratio with a zero denominator is None: a swimmer at rest has no Strouhal number. Figures whose data the run lacks
(ledger, internal wrench) raise `ValueError`.
"""

import numpy as np
from eel_common.cached import cached_property

from eel_dynamics.analysis.averaged_path import AveragedPath
from eel_dynamics.analysis.averaging_window import AveragingWindow
from eel_dynamics.analysis.peaks import peaks, torque_size
from eel_dynamics.analysis.powers import area, drag_powers, power_density, torque_of
from eel_dynamics.analysis.settling import FEWEST, Settling, settling_of
from eel_dynamics.model.section_data import GRAVITY

STILL = 1e-9  # of the body's length per period: a smaller displacement is round-off


class Analysis:
    """Figures of `run` over its last `periods` whole periods (None: the later half). Each is a property with its
    definition; None: undefined. Speeds and paths are over the water, powers into body and water. SI units."""

    def __init__(self, run, periods: int | None = None):
        self.run, self.window = run, AveragingWindow(run, periods)
        self._path = AveragedPath(self.window)

    def __repr__(self) -> str:
        settled = "settled" if self.settled else f"NOT settled, {self.settling}"
        figures = f"mean speed {self.mean_speed:.4g} m/s, {settled if self.moves else 'at rest'}"
        return f"Analysis({self.run.law.name!r}, {self.window.told}: {figures})"

    # -- motion

    @cached_property
    def mean_speed(self) -> float:
        """U [m/s]: arc length of the path of the centre of mass, averaged over one period, divided by the time.

        The averaged centre moves with |c(t + T) - c(t)| / T; U is the mean of that over the window. Kern and
        Koumoutsakos, J. Exp. Biol. 209 (2006), average over a cycle in the same way. A window of one period holds one
        such value.
        """
        return self._path.mean_speed()

    @cached_property
    def speed_change(self) -> float | None:
        """Change of the speed over one period, from the first period of the window to its last, relative to U.

        A window of one period is compared with the period before it. Undefined without one, and at rest.
        """
        change = self._path.speed_change()
        return change / self.mean_speed if change is not None and self.moves else None

    @cached_property
    def settling(self) -> Settling:
        """The change of the period's mean speed in the window, which is extended to three periods if possible."""
        return settling_of(self._path.speeds(self.window.edges(FEWEST)))

    @property
    def settled(self) -> bool:
        """Whether the gait has settled: the mean speed of a period changes by at most 1 % within the window, and by at
        most 1 % afterwards (`settling`). True at rest."""
        return not self.moves or self.settling.settled

    @property
    def moves(self) -> bool:
        """Whether the swimmer moves by more than round-off."""
        return self.mean_speed > STILL * self.run.body.length / self.window.period

    @property
    def frequency(self) -> float:
        """f [1/s] of the strongest wave (yaw, else pitch)."""
        return 1.0 / self.window.wave.period

    @property
    def stride(self) -> float:
        """U T / l: body lengths per beat (Videler and Wardle, Rev. Fish Biol. Fish. 1 (1991))."""
        return self.mean_speed / self.frequency / self.run.body.length

    @property
    def slip(self) -> float | None:
        """U T / |lambda|: speed of the swimmer / speed of the strongest yaw wave along the body (Gray 1933; Lighthill,
        J. Fluid Mech. 9 (1960)). Undefined without a travelling yaw wave, and at rest."""
        wave = self.window.travelling_wave
        if wave is None or not self.moves:
            return None
        return self.mean_speed * wave.period / abs(wave.wavelength)

    @cached_property
    def tail_excursion(self) -> float:
        """A [m]: peak-to-peak excursion of the tail across the mean path, mean over the periods.

        From the tail's path its average over the period around each instant is subtracted (this removes the mean motion
        and turn), then the component along the path of the averaged centre of mass. A is the greatest distance between
        two points of a period. In a window of a single period the mean path is the chord from its start to its end.
        """
        return self._path.tail_excursion(self.moves)

    @property
    def strouhal(self) -> float | None:
        """St = f A / U (Triantafyllou, Triantafyllou and Grosenbaugh, J. Fluids Struct. 7 (1993)); undefined at
        rest."""
        return self.frequency * self.tail_excursion / self.mean_speed if self.moves else None

    @property
    def swimming_number(self) -> float | None:
        """Sw = 2 pi f A l / nu, with the tail's peak-to-peak excursion A; undefined in water without viscosity.

        Gazzola, Argentina and Mahadevan, Nature Phys. 10 (2014), call A the tail beat amplitude. Their fit of animals
        in turbulent flow, Re = 0.4 Sw, is f A / U = 1 / (0.8 pi) = 0.40: a Strouhal number with a peak-to-peak A. With
        half of that A it would be twice the Strouhal number of animals.
        """
        size = 2.0 * np.pi * self.frequency * self.tail_excursion * self.run.body.length
        return size / self.run.scene.viscosity if self.run.scene.viscosity else None

    @property
    def reynolds(self) -> float | None:
        """Re = U l / nu; undefined in water without viscosity."""
        return self.mean_speed * self.run.body.length / self.run.scene.viscosity if self.run.scene.viscosity else None

    # -- power

    @cached_property
    def actuator_power(self) -> float:
        """<P> [W]: mean power of the actuators, -integral of C . dK/dt over the body, net of braking (eq. 26 of Boyer,
        Porez and Leroyer 2010 for C). From the ledger."""
        return self.window.rate(self._ledger.actuator_work, self._ledger.actuator_power)

    @property
    def peak_actuator_power(self) -> float:
        """Greatest power [W] of all actuators together, between samples too (`analysis.peaks`)."""
        _ = self._ledger
        return float(self._peaks(lambda run: run.energy.actuator_power, np.positive))

    @property
    def positive_actuator_power(self) -> float:
        """Mean [W] of the integral of max(-C . dK/dt, 0) over the body: the cost of actuators that cannot take energy
        back. By the trapezoidal rule over the stations and 64 instants per period. Between samples the power per
        length, which is smooth, is a spline; its positive part, which has kinks, is taken afterwards."""
        time = self.window.instants
        density = self.window.spline(power_density(self.run))(time)
        return float(area(area(np.maximum(density, 0.0), self.run.x), time)) / (time[-1] - time[0])

    @property
    def peak_positive_actuator_power(self) -> float:
        """Greatest integral [W] of max(-C . dK/dt, 0) over the body, between samples too (`analysis.peaks`)."""
        x = self.run.x
        return float(self._peaks(power_density, lambda density: area(np.maximum(density, 0.0), x)))

    @cached_property
    def wake_power(self) -> float:
        """Mean power [W] of the wake, V1(l) T_f(l) of eq. (60): negative where energy is shed."""
        return self.window.rate(self._ledger.wake_work, self._ledger.wake_power)

    @cached_property
    def nose_power(self) -> float:
        """Mean power [W] of the load on the nose, its added mass included (section 7.2.1)."""
        return self.window.rate(self._ledger.nose_work, self._ledger.nose_power)

    @cached_property
    def friction_power(self) -> float:
        """Mean power [W] of the axial friction k1 along the body (section 7.2.1)."""
        return float(self.window.mean(drag_powers(self.run)[:, 0]))

    @property
    def cost_of_transport(self) -> float | None:
        """<P> / (m U) [J/(kg m)]: energy per mass and distance; undefined at rest."""
        return self.actuator_power / (self.run.body_mass * self.mean_speed) if self.moves else None

    @property
    def specific_cost_of_transport(self) -> float | None:
        """<P> / (m g U): the same per weight, dimensionless (Gabrielli and von Karman 1950); undefined at rest."""
        cost = self.cost_of_transport
        return None if cost is None else cost / GRAVITY

    @property
    def hydromechanical_efficiency(self) -> float | None:
        """1 + <wake> / <actuators>: part of the work that is not shed into the wake (with the wake power of Lighthill
        1960). Undefined if the actuators do no work, and if the tail leads in the window."""
        return self._part(lambda: self.actuator_power + self.wake_power)

    @property
    def propulsive_efficiency(self) -> float | None:
        """-<axial friction + nose> / <actuators>: part of the work that overcomes the drag of swimming ahead, with
        cross flow counted as loss. Undefined when the hydromechanical efficiency is."""
        return self._part(lambda: -(self.friction_power + self.nose_power))

    @property
    def tail_leads(self) -> bool:
        """Whether V1(l) > 0 at a sample of the window: in the theory the wake then supplies energy."""
        return bool(np.any(self._ledger.wake_power[self.window.inside] > 0.0))

    # -- torque along the body

    @property
    def peak_torque(self) -> np.ndarray:
        """Greatest magnitude [N m] of the internal torque in the window at each station, (M,), between samples too
        (`analysis.peaks`)."""
        return self._peaks(torque_of, torque_size)

    @property
    def rms_torque(self) -> np.ndarray:
        """Root of the mean square [N m] of the internal torque in the window at each station, (M,)."""
        return np.sqrt(np.maximum(0.0, self.window.mean(np.sum(torque_of(self.run) ** 2, axis=2))))

    def _peaks(self, values_of, size) -> np.ndarray:
        """The greatest `size` in the window of the values (T, ...) of a run."""
        return peaks(self._fine.time, values_of(self._fine), size, self.window.start, self.window.end)[0]

    @cached_property
    def _fine(self):
        return self.run.finely_sampled()

    @property
    def _ledger(self):
        if self.run.energy is None:
            raise ValueError("power needs a run with scene ledger on")
        return self.run.energy

    def _part(self, useful) -> float | None:
        if not self.actuator_power > 0.0 or self.tail_leads:
            return None
        return useful() / self.actuator_power
