# SPDX-License-Identifier: Apache-2.0
"""Analyses a run: speed, kinematic numbers, power and efficiency over whole periods of the gait.

    analysis = run.analysis()          # the later half of the run, in whole periods
    analysis.mean_speed, analysis.strouhal, analysis.propulsive_efficiency

A ratio with a zero denominator is None: a swimmer at rest has no Strouhal number. Figures that need data which the run
lacks (ledger, internal wrench) raise `ValueError`.
"""

from functools import cached_property

import numpy as np

from eel_dynamics.analysis.averaging_window import AveragingWindow
from eel_dynamics.analysis.friction_power import drag_powers
from eel_dynamics.model.section_data import GRAVITY

SETTLED = 0.01  # change of the speed within the window, relative
AT_REST = 1e-9  # of the body's length in a period: slower is round-off, and no motion


class Analysis:
    """Figures of `run` over its last `periods` whole periods (None: the later half). Each is a property with its
    definition; None: undefined. Speeds and paths are over the water, powers into body and water. SI units."""

    def __init__(self, run, periods: int | None = None):
        self.run, self.window = run, AveragingWindow(run, periods)

    # -- motion

    @cached_property
    def mean_speed(self) -> float:
        """U [m/s]: arc length of the path of the centre of mass, averaged over one period, by the time.

        The averaged centre moves with |c(t + T) - c(t)| / T; its mean over the window (Kern and Koumoutsakos, J. Exp.
        Biol. 209 (2006), average over a cycle likewise). A window of one period holds one such value.
        """
        window, period = self.window, self.window.period
        if window.periods == 1:
            return (
                float(np.linalg.norm(window.center_of_mass(window.end) - window.center_of_mass(window.start))) / period
            )
        time = window.instants(window.start, window.end - period)
        way = window.center_of_mass(time + period) - window.center_of_mass(time)
        return float(area(np.linalg.norm(way, axis=1), time)) / period / (time[-1] - time[0])

    @cached_property
    def speed_change(self) -> float | None:
        """Change of the speed over one period, from the first period of the window to its last, relative to U.

        A window of one period is compared with the period before it. Undefined where there is none, and at rest.
        """
        window, period = self.window, self.window.period
        first = window.start if window.periods > 1 else window.start - period
        if first < self.run.time[0] - 1e-9 * period or not self.moves:
            return None
        start = np.array([first, window.end - period])
        before, after = np.linalg.norm(window.center_of_mass(start + period) - window.center_of_mass(start), axis=1)
        return float(abs(after - before) / period / self.mean_speed)

    @property
    def settled(self) -> bool:
        """Whether the gait has settled: a `speed_change` of at most 1 %."""
        return self.speed_change is not None and self.speed_change <= SETTLED

    @property
    def moves(self) -> bool:
        """Whether the swimmer moves by more than round-off."""
        return self.mean_speed > AT_REST * self.run.body.length / self.window.period

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
        """U T / |lambda|: speed of the swimmer by that of the strongest yaw wave along the body (Gray 1933; Lighthill,
        J. Fluid Mech. 9 (1960)). Undefined without a travelling yaw wave, and at rest."""
        wave = self.window.travelling_wave
        if wave is None or not self.moves:
            return None
        return self.mean_speed * wave.period / abs(wave.wavelength)

    @cached_property
    def tail_excursion(self) -> float:
        """A [m]: peak-to-peak excursion of the tail across the mean path, mean over the periods.

        The tail less its average over the period around each instant (which takes out way and turn), less what lies
        along the path of the averaged centre of mass; then the greatest distance between two points of a period. In a
        window of a single period the mean path is the chord from its start to its end.
        """
        window, period = self.window, self.window.period
        if window.periods == 1:
            time = window.instants(window.start, window.end)
            chord = window.tail(window.end) - window.tail(window.start)
            apart = window.tail(time) - np.outer((time - time[0]) / period, chord)
            way = window.center_of_mass(window.end) - window.center_of_mass(window.start)
            return _width(_across(apart, np.broadcast_to(way, apart.shape), self.moves))
        total, half = window.tail.antiderivative(), 0.5 * period
        widths = []
        for beat in range(window.periods - 1):
            start = window.start + half + beat * period
            time = window.instants(start, start + period)
            apart = window.tail(time) - (total(time + half) - total(time - half)) / period
            way = window.center_of_mass(time + half) - window.center_of_mass(time - half)
            widths.append(_width(_across(apart, way, self.moves)))
        return float(np.mean(widths))

    @property
    def strouhal(self) -> float | None:
        """St = f A / U (Triantafyllou, Triantafyllou and Grosenbaugh, J. Fluids Struct. 7 (1993)); undefined at
        rest."""
        return self.frequency * self.tail_excursion / self.mean_speed if self.moves else None

    @property
    def swimming_number(self) -> float | None:
        """Sw = 2 pi f (A/2) l / nu (Gazzola, Argentina and Mahadevan, Nature Phys. 10 (2014)); undefined in water
        without viscosity."""
        size = np.pi * self.frequency * self.tail_excursion * self.run.body.length
        return size / self.run.scene.viscosity if self.run.scene.viscosity else None

    @property
    def reynolds(self) -> float | None:
        """Re = U l / nu; undefined in water without viscosity."""
        return self.mean_speed * self.run.body.length / self.run.scene.viscosity if self.run.scene.viscosity else None

    # -- power

    @property
    def actuator_power(self) -> float:
        """<P> [W]: mean power of the actuators, -integral of C . dK/dt over the body, braking counted against driving
        (the net power; eq. 26 of Boyer, Porez and Leroyer 2010 for C). From the ledger."""
        return self.window.rate(self._ledger.actuator_work, self._ledger.actuator_power)

    @property
    def peak_actuator_power(self) -> float:
        """Greatest power [W] of all actuators together at a sample."""
        return float(np.max(self._ledger.actuator_power[self.window.inside]))

    @property
    def positive_actuator_power(self) -> float:
        """Mean [W] of the integral of max(-C . dK/dt, 0) over the body: what actuators cost that cannot take energy
        back. By the trapezoidal rule over the stations and 64 instants in a period; between samples the power per
        length, which is smooth, is a spline, and its positive part, which has kinks, is taken after that."""
        window = self.window
        time = window.instants(window.start, window.end)
        density = window.spline(power_density(self.run))(time)
        return float(area(area(np.maximum(density, 0.0), self.run.x), time)) / window.duration

    @property
    def peak_positive_actuator_power(self) -> float:
        """Greatest integral [W] of max(-C . dK/dt, 0) over the body at a sample."""
        return float(np.max(positive_power(self.run)[self.window.inside]))

    @property
    def wake_power(self) -> float:
        """Mean power [W] of the wake, V1(l) T_f(l) of eq. (60): negative where energy is shed."""
        return self.window.rate(self._ledger.wake_work, self._ledger.wake_power)

    @property
    def nose_power(self) -> float:
        """Mean power [W] of the load on the nose, its added mass included (section 7.2.1)."""
        return self.window.rate(self._ledger.nose_work, self._ledger.nose_power)

    @cached_property
    def friction_power(self) -> float:
        """Mean power [W] of the axial friction k1 along the body (section 7.2.1)."""
        return float(self.window.mean(drag_powers(self.run)[:, 0]))

    @property
    def cost_of_transport(self) -> float | None:
        """<P> / (m U) [J/(kg m)]: energy per mass and way; undefined at rest."""
        return self.actuator_power / (self.run.body_mass * self.mean_speed) if self.moves else None

    @property
    def specific_cost_of_transport(self) -> float | None:
        """<P> / (m g U): the same by the weight, without unit (Gabrielli and von Karman 1950); undefined at rest."""
        cost = self.cost_of_transport
        return None if cost is None else cost / GRAVITY

    @property
    def hydromechanical_efficiency(self) -> float | None:
        """1 + <wake> / <actuators>: part of the work that is not shed into the wake (Lighthill 1960, whose power of
        the wake this is). Undefined where the actuators do no work, and where the tail leads in the window."""
        return self._part(lambda: self.actuator_power + self.wake_power)

    @property
    def propulsive_efficiency(self) -> float | None:
        """-<axial friction + nose> / <actuators>: part of the work that overcomes the drag of going ahead, cross flow
        counted as loss. Undefined as the hydromechanical efficiency is."""
        return self._part(lambda: -(self.friction_power + self.nose_power))

    @property
    def tail_leads(self) -> bool:
        """Whether V1(l) > 0 at a sample of the window: the theory then lets the wake feed energy in."""
        return bool(np.any(self._ledger.wake_power[self.window.inside] > 0.0))

    # -- torque along the body

    @property
    def peak_torque(self) -> np.ndarray:
        """Greatest magnitude [N m] of the internal torque in the window at each station, (M,)."""
        return np.max(np.linalg.norm(_torque(self.run)[self.window.inside], axis=2), axis=0)

    @property
    def rms_torque(self) -> np.ndarray:
        """Root of the mean square [N m] of the internal torque in the window at each station, (M,)."""
        return np.sqrt(np.maximum(0.0, self.window.mean(np.sum(_torque(self.run) ** 2, axis=2))))

    @property
    def _ledger(self):
        if self.run.energy is None:
            raise ValueError("power needs a run with scene ledger on")
        return self.run.energy

    def _part(self, useful) -> float | None:
        if not self.actuator_power > 0.0 or self.tail_leads:
            return None
        return useful() / self.actuator_power


def positive_power(run) -> np.ndarray:
    """Integral of max(-C . dK/dt, 0) over the body (T,) [W] at each sample of `run`."""
    return area(np.maximum(power_density(run), 0.0), run.x)


def power_density(run) -> np.ndarray:
    """Power of the actuators per length, -C . dK/dt (T, M) [W/m], at the stations of `run`. `ValueError` where these do
    not reach from nose to tail."""
    length = run.body.length
    if len(run.x) < 2 or run.x[0] > 1e-9 * length or run.x[-1] < (1.0 - 1e-9) * length:
        raise ValueError(f"run must have stations from 0 to {length:g} m, got {run.x[0]:g} to {run.x[-1]:g} m")
    return -np.sum(_torque(run) * run.curvature_rate, axis=2)


def area(values: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Integral of `values` (..., n) by `x` (n,), by the trapezoidal rule."""
    return np.sum(0.5 * (values[..., 1:] + values[..., :-1]) * np.diff(x), axis=-1)


def _torque(run) -> np.ndarray:
    if run.torque is None:
        raise ValueError("torque needs a run with scene internal_wrench on")
    return run.torque


def _across(apart: np.ndarray, way: np.ndarray, moves: bool) -> np.ndarray:
    """`apart` (n, 3) [m] less its part along `way` (n, 3)."""
    if not moves:
        return apart
    along = way / np.linalg.norm(way, axis=1, keepdims=True)
    return apart - np.sum(apart * along, axis=1, keepdims=True) * along


def _width(points: np.ndarray) -> float:
    """Greatest distance [m] between two of the `points` (n, 3)."""
    return float(np.max(np.linalg.norm(points[:, None] - points[None], axis=2)))
